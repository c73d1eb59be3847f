//! Figures 6, 7 and 8 of the paper, each with three flows. The paper also shows all flows in one figure.

use super::collapse::ComparedFlow;
use super::ensemble::{self, STRAIN};
use super::figures::flowing;
use super::flow::INERTIA;
use grainbench_harness::prelude::*;

/// Largest inertial number in figure 6. Elements above the slit have larger inertial numbers and are not plotted.
const FASTEST: f64 = 0.15;
/// Number of successive frames in each mean along a tracer. Means are plotted because instantaneous stresses are noisy.
const SMOOTH: usize = 5;
/// Plotted ranges of packing fraction, sin φ and strain.
const SEEN: [[f64; 2]; 3] = [[0.5, 0.65], [0.0, 0.9], [0.0, 1.5]];

/// Finished runs of several flows with their labels.
type Flows = [(&'static str, FinishedRun)];

/// Returns the figures of a run and of the stored results of other flows.
pub(crate) fn figures(done: &FinishedRun, label: &'static str, others: &[ComparedFlow]) -> Vec<Figure> {
    let mut flows = vec![(label, done.clone())];
    flows.extend(others.iter().filter_map(|other| Some((other.label, other.done().ok()?))));
    vec![over_rate(&flows), along_tracers(&flows), over_strain(&flows)]
}

/// Returns the figure of φ against |I₀| on linear axes (figure 6).
fn over_rate(flows: &Flows) -> Figure {
    let mut curves = Vec::new();
    for (label, done) in flows {
        let middle = |bin: usize| (INERTIA[bin][0] * INERTIA[bin][1]).sqrt();
        let means = ensemble::over_inertia(done, f64::INFINITY).unwrap_or_default().into_iter().enumerate();
        let means = means.filter_map(|(bin, packing)| Some((middle(bin), packing?)));
        let means = means.filter(|(rate, _)| *rate <= FASTEST).collect();
        curves.push(Curve::new(*label, Stroke::MarkedLine, means));
        let cloud = flowing(done).into_iter().filter(|(rate, _)| *rate <= FASTEST).collect();
        curves.push(Curve::new(format!("{label}: elements"), Stroke::Beside, thinned(cloud, 250)));
    }
    let line = [0.0, 0.012].map(|rate: f64| (rate, 0.635 - rate / 0.123)).to_vec();
    curves.push(Curve::new("fit of the paper", Stroke::Dashed, line));
    let caption = "Small open points are elements at one time of the steady flow. Large filled points are means of \
                   bins. Figure 6 of the paper shows one curve and fits the dashed line. The draining silos lie on \
                   one curve, which is not straight. The pushed bed is looser at the same |I₀|, both in LAMMPS and \
                   in our solver, because it has not reached steady shear.";
    let axes = [Axis::linear("inertial number |I₀| (1)"), Axis::linear("packing fraction φ (1)")];
    Figure::graph("inertia-of-flows", "Packing fraction over the inertial number, three flows", caption, axes, curves)
}

/// Returns the paths of a flow's tracers in the plane of two quantities, as lines between means over [`SMOOTH`] frames.
fn courses(done: &FinishedRun, names: [&str; 2]) -> Vec<([f64; 2], [f64; 2], f64)> {
    let mean = |some: &[[f64; 2]]| [0, 1].map(|axis| some.iter().map(|at| at[axis]).sum::<f64>() / some.len() as f64);
    let mut lines = Vec::new();
    for course in ensemble::courses(done, names).unwrap_or_default() {
        let smooth: Vec<[f64; 2]> = course.chunks(SMOOTH).map(mean).collect();
        lines.extend(smooth.windows(2).map(|pair| (pair[0], pair[1], WIDTH)));
    }
    lines
}

/// Width of a path, as a fraction of the largest line width.
const WIDTH: f64 = 0.15;

/// Returns the plot of the tracer paths of all flows.
fn traces(flows: &Flows, names: [&str; 2], axes: [&str; 2], seen: [[f64; 2]; 2], means: Vec<Lines>) -> LinePlot {
    let kind = |(label, done): &(&str, FinishedRun)| Lines { label: (*label).to_owned(), lines: courses(done, names) };
    let kinds = flows.iter().map(kind).chain(means).collect();
    let sheet = Sheet { title: format!("tracers, means over {SMOOTH} frames"), seen, marked: None, kinds };
    LinePlot { axes: axes.map(str::to_owned), to_scale: false, sheets: vec![sheet] }
}

/// Returns the figure of sin φ against φ (figure 7).
fn along_tracers(flows: &Flows) -> Figure {
    let [packing, sine, _] = SEEN;
    let names = ["packing_fraction", "sine_of_friction"];
    let axes = ["packing fraction φ (1)", "sine of the friction angle (1)"];
    let plot = traces(flows, names, axes, [[packing[0], sine[0]], [packing[1], sine[1]]], Vec::new());
    let medians: Vec<String> = flows
        .iter()
        .filter_map(|(label, done)| Some(format!("{:.2} ({label})", ensemble::onset(done).ok()?)))
        .collect();
    let caption = format!(
        "Each line is the path of a tracer element (figure 7 of the paper). Paths start at the right. Elements that \
         fail first reach their largest sine of the friction angle and then dilate to the left. The paper finds about \
         0.6 before dilation. Here the median of the largest sine, before the packing fraction has dropped by 0.02, \
         is {}.",
        medians.join(", ")
    );
    let title = "Sine of the friction angle over the packing fraction of tracer elements, three flows";
    Figure::lines("tracers-of-flows", title, &caption, plot)
}

/// Returns the figure of φ against |E| (figure 8).
fn over_strain(flows: &Flows) -> Figure {
    let [packing, _, strain] = SEEN;
    let plateau =
        flows.iter().filter_map(|(label, done)| Some(format!("{:.3} ({label})", ensemble::plateau(done).ok()?)));
    let plateau: Vec<String> = plateau.collect();
    // Only the first flow has a curve of means, as a visual guide.
    let means = flows.first().and_then(|(label, done)| Some((label, ensemble::over_strain(done).ok()?)));
    let means = means.map(|(label, all)| {
        let middle = |bin: &[f64; 2]| 0.5 * (bin[0] + bin[1]);
        let points: Vec<[f64; 2]> =
            STRAIN.iter().zip(all).filter_map(|(bin, packing)| Some([middle(bin), packing?])).collect();
        let lines = points.windows(2).map(|pair| (pair[0], pair[1], 0.7)).collect();
        Lines { label: format!("{label}: means of bins"), lines }
    });
    let axes = ["Hencky strain |E| (1)", "packing fraction φ (1)"];
    let seen = [[strain[0], packing[0]], [strain[1], packing[1]]];
    let plot = traces(flows, ["strain", "packing_fraction"], axes, seen, means.into_iter().collect());
    let caption = format!(
        "Each line is the path of a tracer element (figure 8 of the paper, which shows a sharp collapse). Paths \
         start at the packing fraction of the deposit and reach a plateau. Its values beyond |E| = 0.4 are {}.",
        plateau.join(", ")
    );
    Figure::lines("strain-of-flows", "Packing fraction over strain, three flows", &caption, plot)
}
