//! Comparison of output with stored runs of LAMMPS and LIGGGHTS of the same scene.

use super::covered::CheckedOutput;
use super::judgement::{Between, ErrorAllowance, judged_in_time};
use super::ours::{FLOOR, is_compared, truncated};
use super::start::continuous;
use super::subject::Candidate;
use grainbench_cases::stored;
use grainbench_harness::case::Case;
use grainbench_harness::compare::peers::{Peer, against};
use grainbench_harness::tolerance::ToleranceOrigin;
use grainbench_harness::verdict::Verdict;
use grainbench_reference::stored::{StoredRun, folder};
use grainbench_reports::number;
use grainbench_solver::record::Series;

/// Ratio of the uncertainty of a stored run to its change due to half the time step. It is the grid convergence index
/// F_s rᵖ/(rᵖ − 1) of the coarser step (Roache 1994). The factor of safety F_s = 3 applies to two steps, whose ratio is
/// r = 2. The order is p = 1, because contacts begin and end within steps.
const SAFETY: f64 = 6.0;

/// Compares each column with the stored run that is nearest to the output, at the sample times that both have. The
/// allowed error contains the difference between the stored runs and the uncertainty of the run with the longer time step,
/// which is the stored run or the output.
pub(super) fn compare(case: &Case, output: &CheckedOutput<'_>) -> Vec<Verdict> {
    let CheckedOutput { outputs, observed, .. } = output;
    let runs = runs(case, output.candidate);
    let scale = |extent: &dyn Fn(&str) -> f64, unit: &str| extent(unit);
    let compared = against(&observed.series, &observed.uncertainty, &runs, None, is_compared, scale);
    let Some((nearest, columns)) = compared else { return Vec::new() };
    // The discretisation error is of first order, so it is proportional to the time step.
    let step_of_stored = runs.iter().find(|run| run.name == nearest).and_then(|run| {
        let (time, step) = run.series.time.last().zip(run.series.step.last())?;
        (*step > 0).then(|| time / *step as f64)
    });
    let ratio = outputs.time_step().zip(step_of_stored).map_or(1.0, |(of_files, of_stored)| of_files / of_stored);
    let coarser = if ratio > 1.0 + 1e-6 { ratio } else { 1.0 };
    let rows = columns.into_iter().map(|compared| {
        let until = number::significant(compared.samples.last().map_or(0.0, |sample| sample.time), 6);
        let row = Verdict {
            source: nearest.to_owned(),
            tolerance: ToleranceOrigin::Estimated,
            ..output.row(
                format!("{}, worst of {} stored samples to t = {until} s", compared.name, compared.samples.len()),
                compared.unit,
            )
        };
        let times = SAFETY * coarser;
        let beside = ErrorAllowance { floor: FLOOR, times, between: Between::Allowed("stored runs") };
        let mut row = judged_in_time(row, &compared, &beside, outputs);
        if coarser > 1.0 {
            let steps = number::significant(coarser, 3);
            row.because.push_str(&format!("; the step of the files is {steps} times that of the stored run"));
        }
        output.covered.dense_in(compared.samples.iter().map(|sample| sample.time), row)
    });
    rows.collect()
}

/// Returns the valid stored runs of the scene. Outdated and damaged runs are skipped.
fn runs(case: &Case, candidate: &Candidate) -> Vec<Peer> {
    let of_case = stored::all().into_iter().filter(|stored_run| stored_run.case.name == case.name);
    of_case
        .filter_map(|stored_run| {
            let scene = stored_run.scene().ok().filter(|scene| *scene == candidate.scene)?;
            let stored = StoredRun::load(&folder(stored_run.program, &stored_run.id)).ok()?;
            let provenance = stored.is_of(&scene, &stored_run.run.resolution).then_some(&stored.provenance)?;
            let last = provenance.predictable_steps.unwrap_or(u64::MAX);
            let predictable = |series: Series| {
                let samples = series.step.partition_point(|&step| step <= last);
                truncated(series, samples)
            };
            Some(Peer {
                name: format!("{}, stored run of {}", provenance.version, provenance.date),
                series: continuous(&scene, predictable(stored.series(&scene))),
                half_step: Some(continuous(&scene, predictable(stored.half_step(&scene)))),
            })
        })
        .collect()
}
