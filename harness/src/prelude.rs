//! Names that the definition of a case needs.

pub use crate::case::{Case, Home, Level, PLAIN, Physics, cells, fraction, time_step};
pub use crate::claim::{Claim, ClaimFigure, ClaimWithTolerance, Measure, Points, RunsReader, claim};
pub use crate::control::Control;
pub use crate::course::{from_start, samples, thinned};
pub use crate::expect::{Bound, ExpectedValue, Measurement};
pub use crate::figure::{Axis, Curve, Figure, LinePlot, Lines, Sheet, Stroke};
pub use crate::reading::{Reader, Reading, Table};
pub use crate::run::{Change, FinishedRun, MissingData, Run};
pub use crate::runner::Runner;
pub use crate::source::{CitedNumber, Source};
pub use crate::statistics::mean;
pub use crate::tolerance::{
    Tolerance, asymptotic, computed, estimated, exactly, judged, one_interval, required, rounding,
};
pub use grainbench_scene::body::BlockShape;
pub use grainbench_scene::effect::Effect;
pub use grainbench_scene::material::{Constitutive, Deformable};
pub use grainbench_scene::motion::Moment;
pub use grainbench_scene::scene::{Duration, Grain, Sampling, Scene};
pub use grainbench_solver::failure::RunError;
pub use grainbench_solver::record::{Partner, Snapshot};
pub use grainbench_solver::resolution::Resolution;
pub use nalgebra::Vector3;
pub use std::f64::consts::PI;
