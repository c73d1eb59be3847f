//! A disc released from rest on an inclined plane (Bardenhagen, Brackbill & Sulsky 2000).

mod elastic;

use crate::exact::one_grain::OneGrain;
use crate::rows::incline::{Incline, LEVELS};
use crate::rows::on_plane::Plane;
use crate::rows::one_grain_cost::displacement;
use crate::rows::set_down::Dashpots;
use grainbench_harness::prelude::*;

pub(crate) static CASE: Case = crate::heads::INCLINE_DISC
    .with(LEVELS, 2, &|| INCLINE.claims())
    .drawn_by(|runner| INCLINE.figures(runner))
    .priced_by(|case| {
        displacement(case, &["60deg-mu.9", "60deg-mu.3"], 0.3, OneGrain::rigid_incline, "MPM 2000 eq. 25")
    });

static INCLINE: Incline = Incline {
    case: &CASE,
    slopes: &[
        Plane { variant: "60deg-mu.3", rolls: false, lifts: None },
        Plane { variant: "60deg-mu.9", rolls: true, lifts: Some([4e-4, 8e-4]) },
        Plane { variant: "60deg-mu.5", rolls: false, lifts: Some([4e-4, 8e-4]) },
        Plane { variant: "30deg-mu.5", rolls: true, lifts: None },
    ],
    set_down: ("30deg-mu.5", Dashpots::OfMass),
    elastic_claims: elastic::claims,
    elastic_figure: elastic::figure,
};
