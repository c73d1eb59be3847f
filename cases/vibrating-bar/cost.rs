//! Target quantity of the cost study: the period of the bar, compared with the exact period. The effect of the grid
//! counts as an error.

use super::{HELD, HELD_PERIOD, LEVELS, mode, period};
use grainbench_harness::prelude::*;

pub(super) fn targets(case: &'static Case) -> Vec<TargetQuantity> {
    let target = |variant, quantity: &str, source: &str, exact: fn(&Scene) -> f64| TargetQuantity {
        case,
        variant,
        quantity: quantity.to_owned(),
        unit: "s",
        source: source.to_owned(),
        measure: Arc::new(move |done| {
            let done = done.first().ok_or("run")?;
            let exact = exact(&done.scene);
            Ok(Measurement::relative(period(done)?, exact))
        }),
        lanes: vec![SolverSetup {
            method: Method::Grid,
            knobs: String::new(),
            prepare: None,
            about: LEVELS[1].resolution,
        }],
    };
    vec![
        target(PLAIN, "period", "2π/(β√(E/ρ)) (derivation)", |scene| 2.0 * PI / mode(scene).0),
        target(HELD, "period between smooth sides", "10 √(E/M) s (derivation)", |_| HELD_PERIOD),
    ]
}
