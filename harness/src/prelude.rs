//! Names that the definition of a case needs.

pub use crate::case::{Case, Home, Level, PLAIN, Physics, cells, fraction, time_step};
pub use crate::claim::{
    Claim, ClaimFigure, ClaimWithExpectation, ClaimWithTolerance, Measure, Points, Quantity, RunsReader, claim,
};
pub use crate::compare::pointwise::{largest, together, worst};
pub use crate::control::Control;
pub use crate::course::{from_start, samples, thinned};
pub use crate::expect::{Bound, ExpectedValue, Measurement};
pub use crate::figure::{Axis, Curve, Figure, LinePlot, Lines, Sheet, Stroke};
pub use crate::force_plot::force_plot;
pub use crate::measure::{dominant_frequency, slope};
pub use crate::reading::{Reader, Reading, Table};
pub use crate::run::{Change, Data, FinishedRun, MissingData, Run, RunReader, SceneDataError, Set};
pub use crate::runner::Runner;
pub use crate::source::{CitedNumber, Source};
pub use crate::statistics::mean;
pub use crate::subject::{SolverSetup, TargetQuantity};
pub use crate::tolerance::{
    Tolerance, asymptotic, computed, estimated, exactly, judged, one_interval, required, rounding,
};
pub use grainbench_scene::body::BlockShape;
pub use grainbench_scene::effect::Effect;
pub use grainbench_scene::material::{Constitutive, Deformable};
pub use grainbench_scene::method::Method;
pub use grainbench_scene::motion::Moment;
pub use grainbench_scene::scene::{Duration, Grain, Probe, ProbeTarget, Sampling, Scene, WallShape};
pub use grainbench_scene::source::SceneSource;
pub use grainbench_solver::failure::RunError;
pub use grainbench_solver::record::{GrainState, Partner, Record, Snapshot};
pub use grainbench_solver::resolution::Resolution;
pub use nalgebra::Vector3;
pub use std::f64::consts::PI;
pub use std::sync::Arc;
