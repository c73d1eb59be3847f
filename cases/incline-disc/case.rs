//! A disc released from rest on an inclined plane (2000 paper).

#[path = "elastic.rs"]
mod elastic;

use crate::rows::incline::{self, Incline, Slope};
use crate::rows::rigid::Row;
use crate::rows::set_down::Dashpots;
use grainbench_harness::prelude::*;

pub(crate) static CASE: Case = incline::case(
    ["incline-disc", "A disc on an inclined plane", include_str!("scene.toml"), include_str!("derivation.md")],
    &claims,
    figures,
);

static INCLINE: Incline = Incline {
    case: &CASE,
    slopes: &[
        Slope { variant: "60deg-mu.3", sticks: false, rigid_allowed: 1e-3 },
        Slope { variant: "60deg-mu.9", sticks: true, rigid_allowed: 3e-4 },
        Slope { variant: "60deg-mu.5", sticks: false, rigid_allowed: 2.5e-3 },
        Slope { variant: "30deg-mu.5", sticks: true, rigid_allowed: 3e-4 },
    ],
    rigid: &[
        Row { variant: "60deg-mu.3", rolls: false, x: 8e-4, v: 1e-12, omega: 5e-5 },
        Row { variant: "60deg-mu.9", rolls: true, x: 8e-4, v: 4e-4, omega: 8e-4 },
        Row { variant: "60deg-mu.5", rolls: false, x: 8e-4, v: 4e-4, omega: 8e-4 },
        Row { variant: "30deg-mu.5", rolls: true, x: 8e-4, v: 7e-5, omega: 5e-5 },
    ],
    set_down: ("30deg-mu.5", Dashpots::OfMass),
};

fn claims() -> Vec<Claim> {
    [INCLINE.claims(), elastic::claims()].concat()
}

fn figures(runner: &Runner) -> Result<Vec<Figure>, RunError> {
    let mut figures = INCLINE.figures(runner)?;
    figures.extend(elastic::figures(runner)?);
    Ok(figures)
}
