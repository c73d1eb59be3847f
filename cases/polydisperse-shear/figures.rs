//! Graphs of grains on springs and, in the long tier, of plastic grains.

use super::chains::{Chains, chains};
use super::measures;
use super::pictures::{self, PROFILES, Slab};
use grainbench_harness::prelude::*;

pub(super) fn figures(runner: &Runner) -> Result<Vec<Figure>, RunError> {
    let slabs = pictures::slabs(runner)?;
    let mut all = vec![displacement(&slabs)];
    all.extend(over_shear(&slabs));
    // Grains on springs are always the last slab.
    if let Some((_, done)) = slabs.last() {
        all.extend(of_springs(done));
    }
    all.extend(pictures::figures(&slabs));
    Ok(all)
}

fn displacement(slabs: &[Slab]) -> Figure {
    let mut curves = vec![Curve::new("uniform shear", Stroke::Dashed, vec![(0.0, 0.0), (1.0, 1.0)])];
    for (words, done) in slabs.iter().filter(|slab| pictures::has_friction(slab)) {
        for shear in PROFILES {
            if let Ok(snapshot) = measures::at(done, shear) {
                let label = format!("{words}, {:.0} %", 100.0 * shear);
                curves.push(Curve::new(label, Stroke::MarkedLine, measures::profile(done, snapshot)));
            }
        }
    }
    Figure::graph(
        "displacement",
        "Displacement across the slab",
        "Displacement of the grains, averaged over columns, over the displacement of the moving side on the right \
         (Fig. 8 of the paper), at three shears. The dashed line is uniform shear.",
        [Axis::linear("x / width (1)"), Axis::linear("displacement / displacement of the side (1)")],
        curves,
    )
}

fn over_shear(slabs: &[Slab]) -> Vec<Figure> {
    let graph =
        |name: &str, title: &str, caption: &str, label: &str, value: &dyn Fn(&FinishedRun, &Snapshot) -> f64| {
            let curve = |(words, done): &Slab| {
                let points =
                    done.record.snapshots.iter().map(|at| (measures::shear(done, at.time), value(done, at))).collect();
                Curve::new(*words, Stroke::Line, points)
            };
            let axes = [Axis::linear("mean shear (1)"), Axis::linear(label)];
            Figure::graph(name, title, caption, axes, slabs.iter().map(curve).collect())
        };
    let mut figures = vec![
        graph(
            "turned",
            "Rotation of grains",
            "Root mean square rotation of the grains that move freely.",
            "rotation (degrees)",
            &measures::rotation_deg,
        ),
        graph(
            "voids",
            "Large voids",
            "Number of empty squares of 40 µm among the positions of a grid of 150 × 150.",
            "empty squares (1)",
            &|done, snapshot| measures::large_voids(done, snapshot) as f64,
        ),
    ];
    if slabs.len() > 1 {
        figures.push(graph(
            "yielded",
            "Plastic strain",
            "Mean over the mass of the free grains. Grains on springs have no plastic strain.",
            "plastic strain (1)",
            &measures::plastic_strain,
        ));
    }
    figures
}

fn of_springs(done: &FinishedRun) -> Vec<Figure> {
    let mut all = Vec::new();
    let named = |name: &str| done.series().column(name).unwrap_or_default().to_vec();
    let shears: Vec<f64> = done.series().time.iter().map(|&time| measures::shear(done, time)).collect();
    let area = measures::width(done);
    let course = |name: &str, sign: f64| -> Vec<(f64, f64)> {
        shears.iter().copied().zip(named(name).into_iter().map(|force| sign * force / area * 1e-6)).collect()
    };
    all.push(Figure::graph(
        "stress",
        "Stress on the sides",
        "Shear force on the moving side and on the fixed side, and normal force on the fixed side, over the length \
         of a side. The moving side also feels the inertia of the grains that it accelerates. Fluctuations come from \
         force chains that form and break.",
        [Axis::linear("mean shear (1)"), Axis::linear("stress (MPa)")],
        vec![
            Curve::new("shear, moving side", Stroke::Line, course("right.force_y", -1.0)),
            Curve::new("shear, fixed side", Stroke::Line, course("left.force_y", 1.0)),
            Curve::new("normal, fixed side", Stroke::Line, course("left.force_x", -1.0)),
        ],
    ));
    let entries =
        [("work of the side", "work"), ("kinetic", "kinetic"), ("springs", "springs"), ("friction", "friction")];
    let curve = |(label, name): (&str, &str)| {
        let values = named(&format!("budget.{name}"));
        let start = values.first().copied().unwrap_or_default();
        Curve::new(label, Stroke::Line, shears.iter().copied().zip(values.iter().map(|value| value - start)).collect())
    };
    all.push(Figure::graph(
        "energy",
        "Energy budget",
        "Work of the moving side, and its parts: kinetic energy, energy in contact springs and frictional work.",
        [Axis::linear("mean shear (1)"), Axis::linear("energy (J/m)")],
        entries.map(curve).into(),
    ));
    all.extend(of_chains(done));
    all
}

fn of_chains(done: &FinishedRun) -> [Figure; 3] {
    let looked: Vec<(f64, Chains)> = done
        .record
        .snapshots
        .iter()
        .skip(1)
        .map(|snapshot| (measures::shear(done, snapshot.time), chains(snapshot)))
        .collect();
    let points = |value: &dyn Fn(&Chains) -> f64| -> Vec<(f64, f64)> {
        looked.iter().map(|(shear, chains)| (*shear, value(chains))).filter(|(_, value)| value.is_finite()).collect()
    };
    let surviving = looked.windows(2).map(|pair| (pair[1].0, pair[0].1.surviving(&pair[1].1)));
    let mean = |lengths: &[usize]| lengths.iter().sum::<usize>() as f64 / lengths.len() as f64;
    [
        Figure::graph(
            "chains",
            "Fraction of grains in force chains and lifetime of chain links",
            "Fraction of the grains that carry more than the mean stress, and fraction of the chain links that still \
             exist at the next snapshot, at most 2.5 % of shear later.",
            [Axis::linear("mean shear (1)"), Axis::linear("fraction (1)")],
            vec![
                Curve::new("stressed grains", Stroke::MarkedLine, points(&|chains| chains.stressed)),
                Curve::new(
                    "surviving links",
                    Stroke::MarkedLine,
                    surviving.filter(|(_, part)| part.is_finite()).collect(),
                ),
            ],
        ),
        Figure::graph(
            "chain-length",
            "Length of force chains",
            "Mean number of grains in a force chain.",
            [Axis::linear("mean shear (1)"), Axis::linear("grains per chain (1)")],
            vec![Curve::new("", Stroke::MarkedLine, points(&|chains| mean(&chains.lengths)))],
        ),
        Figure::graph(
            "chain-direction",
            "Direction of force chains",
            "Mean direction of compression of the grains in force chains, measured from the normal of the sides. \
             Uniform shear with the right side moving up compresses along −45°.",
            [Axis::linear("mean shear (1)"), Axis::linear("direction from the normal of the sides (°)")],
            vec![Curve::new("", Stroke::MarkedLine, points(&|chains| chains.direction_deg))],
        ),
    ]
}
