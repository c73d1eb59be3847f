//! Grains in a table with one row per grain and sample. Each row contains the step or the time of the sample.

use crate::deck::Stepping;
use crate::observer::{DumpObserver, DumpRecord, Names};
use crate::read::number_table::quoted_names;
use crate::read::read_error::ReadError;
use crate::read::snapshot::DumpSnapshot;
use crate::read::table::{Table, read_table};
use grainbench_scene::scene::Scene;
use grainbench_solver::recorder::Recorder;
use std::path::Path;

/// Returns the quantities of a scene from the table at a path, and the snapshots that the scene requests. `name` is the
/// name of the table in error messages.
pub(super) fn observe(
    scene: &Scene,
    path: &Path,
    name: &str,
    names: &Names,
    stepping: &Stepping,
) -> Result<DumpRecord, ReadError> {
    let table = read_table(path)?;
    refuse_other_spins(&table, name, names)?;
    let time_step = stepping.time_step;
    let steps = steps(&table, name, names, time_step)?;
    let recorder = Recorder::new(scene, time_step, stepping.steps);
    let mut observer = DumpObserver::new(scene, recorder.snapshot_steps());
    let (mut row, mut last) = (0, None);
    while row < table.rows() {
        let step = steps[row];
        let rows = steps[row..].iter().take_while(|other| **other == step).count();
        if let Some(before) = last.filter(|before| step <= *before) {
            let expected = format!("a step after {before}");
            return Err(ReadError::at(name, row as u64 + 2, expected, step.to_string()));
        }
        let snapshot =
            DumpSnapshot { step, table: table.part(row, rows), first_line: row as u64 + 2, ..DumpSnapshot::default() };
        observer.take(name, &snapshot, names, step as f64 * time_step, None)?;
        (row, last) = (row + rows, Some(step));
    }
    Ok(observer.finish())
}

/// Refuses columns that have usual names of spins, if the columns of spins are absent. Otherwise the spins would count as
/// not written.
fn refuse_other_spins(table: &Table, name: &str, names: &Names) -> Result<(), ReadError> {
    for axis in ["x", "y", "z"] {
        let right = format!("omega{axis}");
        let usual = ["w", "omega_", "w_", "spin", "spin_"].map(|start| format!("{start}{axis}"));
        let found = usual.iter().find(|usual| table.column(usual).is_some());
        if let (None, Some(found)) = (table.column(names.in_file(&right)), found) {
            let expected = format!("the column `{right}`, or its name in `output.grains.map`");
            return Err(ReadError::at(name, 1, expected, format!("`{found}`")));
        }
    }
    Ok(())
}

/// Returns the step of every row, from a column `step` or from the times.
fn steps(table: &Table, name: &str, names: &Names, time_step: f64) -> Result<Vec<u64>, ReadError> {
    if let Some(column) = table.column(names.in_file("step")) {
        let whole = |step: f64| if step >= 0.0 && step.fract() == 0.0 { Ok(step as u64) } else { Err(step) };
        let steps: Result<Vec<u64>, f64> = table.values(column).map(whole).collect();
        return steps.map_err(|step| ReadError::at(name, 1, "whole numbers of steps, zero or more", step.to_string()));
    }
    let Some(column) = ["time", "t"].into_iter().find_map(|time| table.column(names.in_file(time))) else {
        return Err(ReadError::at(name, 1, "a column `step` or `time`", quoted_names(&table.columns)));
    };
    let step = |time: f64| {
        let step = (time / time_step).round();
        // If a program adds up its time steps, its times have a rounding error.
        if (time - step * time_step).abs() <= 1e-3 * time_step { Ok(step as u64) } else { Err(time) }
    };
    let steps: Result<Vec<u64>, f64> = table.values(column).map(step).collect();
    steps.map_err(|time| {
        ReadError::at(name, 1, format!("times that are multiples of the time step {time_step} s"), format!("{time} s"))
    })
}
