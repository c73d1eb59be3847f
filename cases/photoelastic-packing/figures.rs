//! Figures of the forces at both stages, and of F_H/F_V against the strain.

use super::{PAIRS, STEP, elastic, experiment, run, time_of_a, vertical_strain};
use grainbench_fields::picture::{Shot, fringe_constant, pictures};
use grainbench_fields::quantity::Quantity;
use grainbench_harness::figure::Field;
use grainbench_harness::prelude::*;

/// Pixels along the longer side of a picture.
const PIXELS: u32 = 900;
/// Fringe order at the 98th percentile of the stress difference over the pixels.
const FRINGES: f64 = 3.0;

/// Returns the curve of F_H/F_V against the vertical strain (%).
fn path(done: &FinishedRun) -> Vec<(f64, f64)> {
    let force = |name: &str| done.series().column(name).unwrap_or_default();
    let sides = force("left.force_x").iter().zip(force("right.force_x"));
    let ends = force("bottom.force_y").iter().zip(force("top.force_y"));
    let ratios = sides.zip(ends).map(|((left, right), (bottom, top))| (right - left) / (top - bottom));
    // At first, discs come into contact with the walls one by one, and the ratio is not meaningful.
    let bearing = force("top.force_y").last().map_or(0.0, |last| 0.02 * last);
    let times = done.series().time.iter().copied().zip(force("top.force_y"));
    let points = times.zip(ratios).filter(|((_, top), _)| **top > bearing);
    points.map(|((time, _), ratio)| (100.0 * vertical_strain(done, time), ratio)).collect()
}

fn side_by_side(springs: &FinishedRun, elastic: &FinishedRun) -> Figure {
    let mut shots = Vec::new();
    for (words, done) in [("on springs", springs), ("elastic", elastic)] {
        for (stage, snapshot) in ["A", "B"].into_iter().zip(done.record.snapshots.iter().skip(1)) {
            shots.push(Shot::new(format!("{words}, stage {stage}"), snapshot));
        }
    }
    let constant = fringe_constant(shots.iter().flat_map(|shot| shot.frames.iter().copied()), FRINGES);
    Figure::field(
        "fringes-elastic",
        "Fringes of fifty discs, on springs and elastic",
        &format!(
            "Both start from the same packing and have the same stages. The fringes show the stress from contact \
             forces of springs, and the stress of material points; f = {:.2} MPa.",
            constant / 1e6
        ),
        pictures(Quantity::Fringes(constant), &shots, PIXELS / 2, None),
    )
}

pub(super) fn figures(runner: &Runner) -> Result<Vec<Figure>, RunError> {
    let done = runner.run(&run(PLAIN))?;
    let mut figures = Vec::new();
    let stages = [("forces-a", "Contact forces at stage A"), ("forces-b", "Contact forces at stage B")];
    for (snapshot, (name, title)) in done.record.snapshots.iter().skip(1).zip(stages) {
        figures.push(Figure::forces(
            name,
            title,
            "Each bar is along the force of a contact, and its width is proportional to the force, as in Figs. 10 to \
             13 of the paper.",
            force_plot(snapshot),
        ));
    }
    if let [_, a, b, ..] = done.record.snapshots.as_slice() {
        let constant = fringe_constant([a, b], FRINGES);
        let shots = [Shot::new("stage A", a), Shot::new("stage B", b)];
        figures.push(Figure::field(
            "fringes",
            "Photoelastic fringes at stages A and B",
            &format!(
                "Fringes between crossed polarisers: cos((σ₁ − σ₂)/f) from the elastic stress of each disc under its \
                 contact forces. Regions without stress are bright. Both stages have f = {:.2} MPa, which gives \
                 three fringes at the stress difference that 2 % of the area exceeds. Lines mark the discs.",
                constant / 1e6
            ),
            // The paper's lengths have no unit, so there is no scale bar in metres.
            Field { pixel: 0.0, ..pictures(Quantity::Fringes(constant), &shots, PIXELS, None) },
        ));
    }
    if runner.is_thorough() {
        figures.push(side_by_side(&runner.run(&run("fifty"))?, &runner.run(&elastic::discs())?));
    }
    let course = path(&done);
    let far = course.last().map_or(0.0, |point| point.0);
    let at_a = vertical_strain(&done, time_of_a(&done));
    let point_at = |strain: f64| course.iter().copied().find(|point| point.0 >= strain).into_iter().collect::<Vec<_>>();
    let level = |label: &str, ratio: f64| Curve::new(label, Stroke::Dashed, vec![(0.0, ratio), (far, ratio)]);
    let stages = [point_at(100.0 * at_a), course.last().copied().into_iter().collect()].concat();
    let mut curves =
        vec![Curve::new("dem", Stroke::Line, course.clone()), Curve::new("stages A and B", Stroke::Markers, stages)];
    for [_, program] in PAIRS {
        // LAMMPS or LIGGGHTS has no curve if it is not installed and no run of it is stored.
        if let Ok(theirs) = runner.run(&Run::new("programs", program, STEP)) {
            let label = format!("{program}, dashpots at contacts only");
            curves.push(Curve::new(label, Stroke::Markers, path(&theirs).into_iter().step_by(10).collect()));
        }
    }
    curves.extend([
        level("experiment, stage A (imposed)", experiment::RATIO_A.value),
        level("experiment, stage B (loads imposed)", experiment::RATIO_B.value),
    ]);
    figures.push(Figure::graph(
        "path",
        "Ratio of the wall forces over the vertical strain",
        "Horizontal force F_H over vertical force F_V on the walls. Up to stage A, the ratio of the strains is \
         constant. Then the strains are equal and opposite until F_V has grown by 4.348 %. `dem` is compared with \
         external solvers and with the experiment (dashes).",
        [Axis::linear("vertical strain (%)"), Axis::linear("F_H/F_V (1)")],
        curves,
    ));
    Ok(figures)
}
