//! Cause of the flow of a silo, with the sizes and bins of its evaluation.

use grainbench_harness::prelude::*;

/// Cause of the flow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Flow {
    /// Grains leave through a slit in the middle of the floor.
    Drained,
    /// Half of the floor is pushed up.
    Pushed,
}

/// Smallest shear rate |D₀| of a flowing element (1/τ).
pub(crate) const FLOWING: f64 = 0.02;

impl Flow {
    /// Returns the cause of the flow in a scene: grains with prescribed motion push the others.
    pub(super) fn from_scene(scene: &Scene) -> Self {
        if scene.driven.is_empty() { Self::Drained } else { Self::Pushed }
    }

    /// Returns true if a place is far from the cause of the flow: at least `radius` (d) from the slit of a draining silo,
    /// or above `height` (d) in a pushed silo.
    pub(super) fn is_far(self, [x, z]: [f64; 2], [radius, height]: [f64; 2]) -> bool {
        match self {
            Self::Drained => x.hypot(z) >= radius,
            Self::Pushed => z > height,
        }
    }

    /// Describes the region far from the cause of the flow.
    pub(crate) const fn words(self) -> &'static str {
        match self {
            Self::Drained => "from 7.5 d off the slit on",
            Self::Pushed => "above 12.5 d",
        }
    }
}

/// Bounds of the bins of the inertial number |I₀|.
pub(crate) const INERTIA: [[f64; 2]; 10] = [
    [0.002, 0.005],
    [0.005, 0.01],
    [0.01, 0.02],
    [0.02, 0.04],
    [0.04, 0.07],
    [0.07, 0.1],
    [0.1, 0.15],
    [0.15, 0.2],
    [0.2, 0.3],
    [0.4, 0.6],
];

/// Edge of an element in x and z (d). In y, an element is as long as the period.
pub(super) const ELEMENT: f64 = 2.5;
/// Time from which the flow counts as steady (τ). The first window of frames begins at this time.
pub(super) const STEADY: f64 = 6.0;

/// Returns columns of a table as rows, without rows that contain NaN or infinite numbers.
pub(super) fn rows<const N: usize>(
    done: &FinishedRun,
    table: &str,
    names: [&str; N],
) -> Result<Vec<[f64; N]>, MissingData> {
    let mut columns: [&[f64]; N] = [&[]; N];
    for (column, name) in columns.iter_mut().zip(names) {
        *column = done.column_of(table, name)?;
    }
    let row = |at: usize| columns.map(|column| column[at]);
    let all = (0..done.table(table)?.rows()).map(row);
    Ok(all.filter(|row| row.iter().all(|number| number.is_finite())).collect())
}
