//! Impact on more grains: on our own beds of 100,000 grains, and on the published beds of the round robin if the user
//! provides their data.

use super::{DEEP, half_the_density, height};
use crate::registry::made_of;
use crate::rows::bulk::of_packings;
use crate::sources::literature::dosta_2024 as dosta;
use grainbench_harness::prelude::*;
use grainbench_reference::round_robin::{Spread, bed_in, bed_names, read_bed};
use std::path::Path;

/// Variants with our own beds of 100,000 grains, each with another random seed.
const OWN: [&str; 5] =
    ["hundred-thousand", "hundred-thousand-2", "hundred-thousand-3", "hundred-thousand-4", "hundred-thousand-5"];
/// Time at which the ball is at rest in a hundred thousand grains (s).
const REST: f64 = 0.06;

/// Impact on the shared bed of 50,000 grains.
static FIFTY: Data = Data {
    name: "shared-50k",
    needs: "it starts from the published bed of Dosta et al. 2024 (doi 10.5281/zenodo.8252892) with fifty thousand \
            grains, `50KParticles.txt`; `grainbench run impact-bed --levels all --data DIR` reads it from the folder \
            DIR",
    scene: |folder| shared(folder, 50, DEEP),
};
/// Impact on the shared bed of 100,000 grains.
static HUNDRED: Data = Data {
    name: "shared-100k",
    needs: "it starts from the published bed of Dosta et al. 2024 (doi 10.5281/zenodo.8252892) with a hundred thousand \
            grains, `100KParticles.txt`; `grainbench run impact-bed --levels all --data DIR` reads it from the folder \
            DIR",
    scene: |folder| shared(folder, 100, REST),
};

/// Returns the scene of the case with ball and bed from a published initial state, for a duration (s).
fn shared(folder: &Path, thousands: usize, duration: f64) -> Result<Scene, SceneDataError> {
    let path = bed_in(folder, thousands).ok_or_else(|| {
        let [name, other] = bed_names(thousands);
        SceneDataError::Absent(format!("{}: expected `{name}` or `{other}`, found neither", folder.display()))
    })?;
    let bed = read_bed(&path, thousands).map_err(|error| SceneDataError::Wrong(error.to_string()))?;
    let source = SceneSource::from_text("scene.toml", Path::new("."), super::CASE.scene)
        .set("duration", &duration.to_string())
        .set("grains.ball.position", &format!("{:?}", bed.ball))
        .set("grains.bed.state", "")
        .set("grains.bed.file", "{ path = \"bed.data\" }");
    made_of(&source, &[("bed.data", bed.data())]).map_err(SceneDataError::Wrong)
}

/// Returns the claim that our solver agrees with LIGGGHTS and MUSEN on the same bed. All codes use one bed, so there is
/// no spread between beds, and one more code may differ by 2 s_code.
fn row(quantity: &str, data: &'static Data, time: f64, (cited, half): (CitedNumber, CitedNumber)) -> Claim {
    let code = half.value * std::f64::consts::SQRT_2;
    let allowed = Spread { mean: cited.value, code, bed: 0.0 }.allowed(1, 1);
    claim(quantity, "mm")
        .run(Run::new(PLAIN, "dem:liggghts", super::STEP).from_data(data).long())
        .equals_cited(cited, 1.0, move |done| height(&done[0], time))
        .within(computed(allowed, "one more code on the same bed: 2 s_code, s_code = |a − b|/√2 of the two codes"))
        .refuses(half_the_density())
}

fn on_all() -> [Run; 5] {
    OWN.map(|variant| Run::new(variant, "dem:liggghts", super::STEP).paper_size().kept())
}

pub(super) fn claims() -> Vec<Claim> {
    let at_30_ms = (dosta::HEIGHT_30_100K, dosta::HEIGHT_30_100K_HALF);
    let at_rest = (dosta::HEIGHT_60_100K, dosta::HEIGHT_60_100K_HALF);
    let of_own = of_packings(
        ("height of the ball at 30 ms, 100,000 grains, mean of five beds".to_owned(), "mm"),
        on_all().to_vec(),
        at_30_ms,
        |done| height(done, DEEP),
        "in units of 2 √(s_code² + s_bed² (1/5 + 1)), with s_code from two codes on one bed and s_bed between our \
         beds; fixed before any run",
    );
    vec![
        of_own.refuses(half_the_density()),
        row(
            "height of the ball at 30 ms, 50,000 grains, the shared bed",
            &FIFTY,
            DEEP,
            (dosta::HEIGHT_30_50K, dosta::HEIGHT_30_50K_HALF),
        ),
        row("height of the ball at 30 ms, 100,000 grains, the shared bed", &HUNDRED, DEEP, at_30_ms),
        row("height of the ball at 60 ms, 100,000 grains, the shared bed", &HUNDRED, REST, at_rest),
    ]
}

pub(super) fn figure(runner: &Runner) -> Result<Figure, RunError> {
    let codes = vec![(DEEP * 1e3, dosta::HEIGHT_30_100K.value)];
    let mut curves = vec![Curve::new("LIGGGHTS and MUSEN, one bed", Stroke::Markers, codes)];
    for (number, run) in on_all().iter().enumerate() {
        let done = runner.run(run)?;
        curves.push(Curve::new(format!("own bed {}", number + 1), Stroke::Line, super::course(&done)));
    }
    Ok(Figure::graph(
        "hundred-thousand",
        "Height of the ball, 100,000 grains",
        "Height of the ball's centre on our five beds of 100,000 grains. The marker is the height of two codes at 30 \
         ms on one bed (Dosta et al. 2024, derived).",
        [Axis::linear("time (ms)"), Axis::linear("height (mm)")],
        curves,
    ))
}
