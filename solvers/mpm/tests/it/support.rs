//! Scenes and helper functions of the tests.

use grainbench_mpm::options::Setting;
use grainbench_mpm::solver::Mpm;
use grainbench_scene::scene::Scene;
use grainbench_solver::Solver;
use grainbench_solver::failure::RunError;
use grainbench_solver::record::Record;
use grainbench_solver::resolution::Resolution;

/// Speed of each of two bodies that collide: .01 of the speed of sound (m/s).
pub(crate) const SPEED: f64 = 0.042_426_406_871_192_85;

pub(crate) fn scene(text: &str) -> Scene {
    Scene::from_text("test", &format!("title = 'test'\n{text}")).unwrap()
}

pub(crate) fn try_run(
    solver: &str,
    change: impl FnOnce(&mut Setting),
    text: &str,
    at: Resolution,
) -> Result<Record, RunError> {
    Mpm::named(solver).unwrap().with(change).run(&scene(text), &at, &mut ())
}

pub(crate) fn run(solver: &str, text: &str, cells: f64, points: u32) -> Record {
    try_run(solver, |_| (), text, Resolution::grid(cells, points)).unwrap()
}

pub(crate) fn column<'a>(record: &'a Record, name: &str) -> &'a [f64] {
    record.series.column(name).unwrap()
}

pub(crate) fn last(record: &Record, name: &str) -> f64 {
    *column(record, name).last().unwrap()
}

/// Returns the difference between the last and the first value of a column.
pub(crate) fn change(record: &Record, name: &str) -> f64 {
    last(record, name) - column(record, name)[0]
}

/// Returns the total energy at the end of a run, divided by its initial value.
pub(crate) fn energy(record: &Record) -> f64 {
    last(record, "all.total_energy") / column(record, "all.total_energy")[0]
}

/// Returns the disc on an incline of Bardenhagen, Brackbill & Sulsky (2000), released at t = 0 or after relaxation.
pub(crate) fn incline(slope_deg: f64, friction: f64, duration: f64, settled: bool) -> String {
    let start = if settled {
        let pull = -9.8 * slope_deg.to_radians().cos();
        format!("settle = {{ duration = 0.3, damping = 60.0, gravity = [0.0, {pull}] }}")
    } else {
        "initial_pressure = 'hydrostatic'".to_owned()
    };
    format!(
        "dimension = 2\nduration = {duration}\ngravity = {{ magnitude = 9.8, slope_deg = {slope_deg} }}\n{start}\n\
         materials.m = {{ density = 3000.0, bulk_modulus = 1.0e7, shear_modulus = 2.5e6 }}\n\
         contacts.m = {{ between = ['m', 'm'], law = 'coulomb', friction = {friction} }}\n\
         [grains.g]\nmaterial = 'm'\nradius = 0.5\nposition = [0.0, 0.5]\n\
         [walls.w]\nmaterial = 'm'\nplane = {{ point = [0.0, 0.0], normal = [0.0, 1.0] }}\n\
         [probes]\ng.grain = 'g'\nw.wall = 'w'\nall.system = true\n"
    )
}

/// Returns two equal elastic discs of radius 1 that approach at .01 c each from a gap (m).
pub(crate) fn collision(gap: f64, friction: f64, offset: f64) -> String {
    let speed = 0.01 * 18.0_f64.sqrt();
    let half = 0.5 * ((2.0 + gap).powi(2) - (2.0 * offset).powi(2)).sqrt();
    let duration = 0.5 * gap / speed + 40.0 / 18.0_f64.sqrt();
    format!(
        "dimension = 2\nduration = {duration}\n\
         materials.m = {{ density = 1.0, bulk_modulus = 10.0, shear_modulus = 6.0 }}\n\
         contacts.m = {{ between = ['m', 'm'], law = 'coulomb', friction = {friction} }}\n\
         [grains.a]\nmaterial = 'm'\nradius = 1.0\nposition = [{}, {}]\nvelocity = [{speed}, 0.0]\n\
         [grains.b]\nmaterial = 'm'\nradius = 1.0\nposition = [{half}, {offset}]\nvelocity = [{}, 0.0]\n\
         [probes]\na.grain = 'a'\nb.grain = 'b'\nall.system = true\n",
        -half, -offset, -speed
    )
}
