//! A sphere released from rest on an inclined plane (Bardenhagen et al. 2001).

mod elastic;

use crate::exact::one_grain::OneGrain;
use crate::rows::incline::{Incline, LEVELS};
use crate::rows::on_plane::Plane;
use crate::rows::one_grain_cost::displacement;
use crate::rows::set_down::Dashpots;
use grainbench_harness::prelude::*;

pub(crate) static CASE: Case =
    Case { derivation: include_str!("../incline-disc/derivation.md"), ..crate::heads::INCLINE_SPHERE }
        .with(LEVELS, 2, &|| INCLINE.claims())
        .drawn_by(|runner| INCLINE.figures(runner))
        .priced_by(|case| {
            let variants = &["45deg-mu.495", "60deg-mu2_7"];
            displacement(case, variants, 0.3, OneGrain::rigid_incline, "2001 paper, eqs. 23-26")
        });

static INCLINE: Incline = Incline {
    case: &CASE,
    slopes: &[
        Plane { variant: "45deg-mu.495", rolls: true, lifts: None },
        Plane { variant: "60deg-mu2_7", rolls: false, lifts: None },
    ],
    set_down: ("45deg-mu.495", Dashpots::OfStiffness),
    elastic_claims: elastic::claims,
    elastic_figure: elastic::figure,
};
