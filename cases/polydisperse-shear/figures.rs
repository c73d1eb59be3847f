//! Figures, of grains on springs: those of deformable grains take minutes a run.

use super::chains::{Chains, chains};
use super::{measures, springs::slab};
use crate::bench::Bench;
use crate::figure::{Axis, Curve, Drawing, Figure, Stroke};
use crate::force_plot::force_plot;
use crate::gate::Done;
use grainbench_scene::record::Snapshot;
use grainbench_scene::solver::RunError;

pub(super) fn figures(bench: &Bench) -> Result<Vec<Figure>, RunError> {
    let done = bench.run(&slab())?;
    let mut curves = vec![Curve::new("uniform shear", Stroke::Dashed, vec![(0.0, 0.0), (1.0, 1.0)])];
    for shear in [0.25, 0.5, 0.75] {
        if let Ok(snapshot) = measures::at(&done, shear) {
            let label = format!("{:.0} % shear", 100.0 * shear);
            curves.push(Curve::new(label, Stroke::MarkedLine, measures::profile(&done, snapshot)));
        }
    }
    let mut all = vec![Figure::graph(
        "displacement",
        "Displacement across the slab",
        "Displacement of grains averaged over columns, as a fraction of that of the moving side, at the right. Grains on springs; the \
         straight line is uniform shear.",
        [Axis::linear("x over the width (1)"), Axis::linear("displacement over that of the side (1)")],
        curves,
    )];
    let named = |name: &str| done.series().column(name).unwrap_or_default().to_vec();
    let shears: Vec<f64> = done.series().time.iter().map(|&time| measures::shear(&done, time)).collect();
    let area = measures::width(&done);
    let course = |name: &str, sign: f64| -> Vec<(f64, f64)> {
        shears.iter().copied().zip(named(name).into_iter().map(|force| sign * force / area * 1e-6)).collect()
    };
    all.push(Figure::graph(
        "stress",
        "Stress on the sides",
        "Shear force on the moving side and on the one that stands still, and normal force on the latter, over the length of the side. \
         The moving side feels the inertia of what it sets in motion; chains come and go.",
        [Axis::linear("mean shear (1)"), Axis::linear("stress (MPa)")],
        vec![
            Curve::new("shear, moving side", Stroke::Line, course("right.force_y", -1.0)),
            Curve::new("shear, standing side", Stroke::Line, course("left.force_y", 1.0)),
            Curve::new("normal, standing side", Stroke::Line, course("left.force_x", -1.0)),
        ],
    ));
    let entries = [
        ("work of the side", "work"),
        ("kinetic", "kinetic"),
        ("springs", "springs"),
        ("friction", "friction"),
    ];
    let curve = |(label, name): (&str, &str)| {
        let values = named(&format!("budget.{name}"));
        let start = values.first().copied().unwrap_or_default();
        Curve::new(label, Stroke::Line, shears.iter().copied().zip(values.iter().map(|value| value - start)).collect())
    };
    all.push(Figure::graph(
        "energy",
        "Where the work goes",
        "Work of the moving side, and what became of it: motion, springs of contacts, friction.",
        [Axis::linear("mean shear (1)"), Axis::linear("energy (J/m)")],
        entries.map(curve).into(),
    ));
    all.extend(of_chains(&done));
    if let Ok(snapshot) = measures::at(&done, 0.75) {
        all.push(Figure {
            name: "forces".to_owned(),
            title: "Force chains at 75 % shear".to_owned(),
            caption: "Bars along contact forces, as wide as these are large. Few grains carry most of the load.".to_owned(),
            drawing: Drawing::Forces(force_plot(snapshot)),
        });
    }
    Ok(all)
}

/// Force chains and voids over the shear.
fn of_chains(done: &Done) -> [Figure; 2] {
    let looked: Vec<(f64, &Snapshot, Chains)> = done.record.snapshots.iter().skip(1)
        .map(|snapshot| (measures::shear(done, snapshot.time), snapshot, chains(snapshot)))
        .collect();
    let points = |of: &dyn Fn(&Snapshot, &Chains) -> f64| -> Vec<(f64, f64)> {
        looked.iter().map(|(shear, snapshot, chains)| (*shear, of(snapshot, chains))).filter(|(_, value)| value.is_finite()).collect()
    };
    let surviving = looked.windows(2).map(|pair| (pair[1].0, pair[0].2.surviving(&pair[1].2)));
    let mean = |lengths: &[usize]| lengths.iter().sum::<usize>() as f64 / lengths.len() as f64;
    [
        Figure::graph(
            "chains",
            "Force chains come and go",
            "Part of the grains that carry more than the mean, part of the links of chains that outlive 5 % of shear, and void fraction \
             within the slab. Grains on springs.",
            [Axis::linear("mean shear (1)"), Axis::linear("part (1)")],
            vec![
                Curve::new("stressed grains", Stroke::MarkedLine, points(&|_, chains| chains.stressed)),
                Curve::new("links that outlived 5 % of shear", Stroke::MarkedLine, surviving.filter(|(_, part)| part.is_finite()).collect()),
                Curve::new("voids", Stroke::MarkedLine, points(&|snapshot, _| measures::void_fraction(done, snapshot))),
            ],
        ),
        Figure::graph(
            "chain-length",
            "Length and direction of force chains",
            "Mean number of grains of a chain, and mean direction of compression of its grains from the normal of the sides. Shear of the \
             right side upwards compresses along −45°.",
            [Axis::linear("mean shear (1)"), Axis::linear("grains; degrees over ten")],
            vec![
                Curve::new("grains of a chain", Stroke::MarkedLine, points(&|_, chains| mean(&chains.lengths))),
                Curve::new("direction over 10°", Stroke::MarkedLine, points(&|_, chains| 0.1 * chains.direction_deg)),
            ],
        ),
    ]
}
