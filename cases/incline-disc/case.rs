//! A disc released from rest on an inclined plane (Bardenhagen, Brackbill & Sulsky 2000).

mod elastic;

use crate::rows::incline::{Incline, LEVELS, Slope};
use crate::rows::rigid::Row;
use crate::rows::set_down::Dashpots;
use grainbench_harness::prelude::*;

pub(crate) static CASE: Case =
    Case { levels: LEVELS, default_level: LEVELS[2], claims: &claims, figures, ..crate::heads::INCLINE_DISC };

static INCLINE: Incline = Incline {
    case: &CASE,
    slopes: &[
        Slope { variant: "60deg-mu.3", sticks: false },
        Slope { variant: "60deg-mu.9", sticks: true },
        Slope { variant: "60deg-mu.5", sticks: false },
        Slope { variant: "30deg-mu.5", sticks: true },
    ],
    rigid: &[
        Row { variant: "60deg-mu.3", rolls: false, lifts: None },
        Row { variant: "60deg-mu.9", rolls: true, lifts: Some([4e-4, 8e-4]) },
        Row { variant: "60deg-mu.5", rolls: false, lifts: Some([4e-4, 8e-4]) },
        Row { variant: "30deg-mu.5", rolls: true, lifts: None },
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
