//! Runs of short scenes for the tests, and access to the recorded columns.
#![allow(dead_code, unreachable_pub, reason = "each test file takes what it needs")]

use grainbench_dem::convention::Convention;
use grainbench_dem::solver::Dem;
use grainbench_scene::error::SceneError;
use grainbench_scene::scene::Scene;
use grainbench_solver::Solver;
use grainbench_solver::record::Record;
use grainbench_solver::resolution::Resolution;

pub const MATERIAL: &str = r#"
title = "test"
materials.m.density = 1000.0
contacts.m = { between = ["m", "m"], normal_stiffness = 1.0e6 }
output.every_cycles = 1
"#;

pub fn run(text: &str) -> Record {
    run_as(text, Convention::CUNDALL_STRACK)
}

pub fn run_as(text: &str, convention: Convention) -> Record {
    run_at(text, convention, &Resolution::CriticalFraction(0.02))
}

/// Returns the scene of a text, without [`MATERIAL`].
pub fn scene(text: &str) -> Result<Scene, SceneError> {
    Scene::from_text("test", text)
}

pub fn run_at(text: &str, convention: Convention, resolution: &Resolution) -> Record {
    let scene = scene(&format!("{MATERIAL}{text}")).unwrap();
    Dem::new(convention).run(&scene, resolution, &mut ()).unwrap()
}

pub fn column<'a>(record: &'a Record, name: &str) -> &'a [f64] {
    record.series.column(name).unwrap()
}

pub fn last(record: &Record, name: &str) -> f64 {
    *column(record, name).last().unwrap()
}
