//! Figures 4 and 5 of the paper on silos: principal axes of stress T and strain rate D in the blocks of the last frame,
//! and contact forces in a part of the silo.

use super::ensemble;
use super::flow::{Flow, rows};
use super::instant::part;
use grainbench_harness::prelude::*;

/// Plotted half-length of a principal axis of the strain rate D (grain diameters d).
const RATE: f64 = 1.6;
/// Plotted half-length of the 90th percentile of the minor and major axes of the stress T (d). Blocks are 5 d wide.
const STRESS: f64 = 2.4;
/// Labels of the axes of the plots.
const AXES: [&str; 2] = ["x (d)", "z (d)"];
/// Line widths of the three kinds of axes, as fractions of the largest width.
const WIDTHS: [f64; 3] = [0.2, 0.4, 0.2];

/// Returns the figures for which a run has the tables: figure 4 needs `axes`, figure 5 also `forces`.
pub(super) fn all(done: &FinishedRun) -> Vec<Figure> {
    let Some(kinds) = kinds(done) else { return Vec::new() };
    let seen = part(Flow::from_scene(&done.scene));
    let time = done.column_of("whole", "time").ok().and_then(|times| times.last().copied()).unwrap_or(f64::NAN);
    [whole(done, seen, time, &kinds), detail(done, seen, time, kinds)].into_iter().flatten().collect()
}

/// Returns the principal axes of each block as lines; `None` if the run has no table of axes.
fn kinds(done: &FinishedRun) -> Option<Vec<Lines>> {
    let along = |x: &'static str, z: &'static str| rows(done, "axes", ["x", "z", x, z]).ok();
    let [smallest, middle, largest] =
        [along("smallest_x", "smallest_z")?, along("middle_x", "middle_z")?, along("largest_x", "largest_z")?];
    let mut lengths: Vec<f64> = smallest.iter().chain(&largest).map(|row| row[2].hypot(row[3])).collect();
    lengths.sort_by(f64::total_cmp);
    let longest = *lengths.get(lengths.len().checked_sub(1)? * 9 / 10)?;
    let scale = if longest > 0.0 { STRESS / longest } else { 1.0 };
    let lines = |rows: &[[f64; 4]], scale: f64, width: f64| -> Vec<_> {
        let end = |&[x, z, a, b]: &[f64; 4], side: f64| [x + side * scale * a, z + side * scale * b];
        rows.iter().map(|row| (end(row, -1.0), end(row, 1.0), width)).collect()
    };
    let rates = [along("shortens_x", "shortens_z")?, along("lengthens_x", "lengthens_z")?];
    Some(vec![
        Lines {
            label: "stress T: minor and intermediate principal axes; length ∝ √|deviator|".to_owned(),
            lines: lines(&[smallest, middle].concat(), scale, WIDTHS[0]),
        },
        Lines { label: "stress T: major principal axis".to_owned(), lines: lines(&largest, scale, WIDTHS[1]) },
        Lines {
            label: "rate of deformation D: principal axes, if |D₀| exceeds 0.02/τ".to_owned(),
            lines: lines(&rates.concat(), RATE, WIDTHS[2]),
        },
    ])
}

/// Returns the figure of all blocks (figure 4).
fn whole(done: &FinishedRun, part: [[f64; 2]; 2], time: f64, kinds: &[Lines]) -> Option<Figure> {
    let domain = done.scene.domain.as_ref()?;
    let places = rows(done, "axes", ["x", "z"]).ok()?;
    let top = places.iter().map(|row| row[1]).fold(0.0, f64::max) + 2.5;
    let seen = [[domain.low.x, 0.0], [domain.high.x, top]];
    let apart = ensemble::angle(done, false);
    let apart = apart.map_or_else(|_| String::new(), |mean| format!("; major axes {mean:.1}° apart after 6 τ"));
    let title = format!("t = {time} τ, blocks of 5 d{apart}");
    let sheet = Sheet { title, seen, marked: Some(part), kinds: kinds.to_vec() };
    let caption = "Principal axes of the stress in blocks of 5 d by 8 d by 5 d at one time, projected on the plane, \
                   and of the rate of deformation in blocks that flow (figure 4 of the paper). The paper finds an \
                   angle of at most about 12° between them where the deformation is appreciable, smooth stresses, \
                   and no shocks of limit-state plasticity. The frame is the part shown in the next figure. The \
                   paper does not state the position of its own part.";
    Some(Figure::lines(
        "axes",
        "Principal axes of stress and of rate of deformation",
        caption,
        LinePlot { axes: AXES.map(str::to_owned), to_scale: true, sheets: vec![sheet] },
    ))
}

/// Returns the figure of a part of the silo: the axes of its blocks, and its contact forces (figure 5).
fn detail(done: &FinishedRun, seen: [[f64; 2]; 2], time: f64, kinds: Vec<Lines>) -> Option<Figure> {
    let forces = rows(done, "forces", ["from_x", "from_z", "to_x", "to_z", "force"]).ok()?;
    let largest = forces.iter().map(|row| row[4]).fold(0.0, f64::max);
    if largest <= 0.0 {
        return None;
    }
    let mean = forces.iter().map(|row| row[4]).sum::<f64>() / forces.len() as f64;
    let line = |row: &[f64; 5]| ([row[0], row[1]], [row[2], row[3]], row[4] / largest);
    let label = format!(
        "contact force, width ∝ force; {} contacts, mean {mean:.1} m g, largest {largest:.0} m g",
        forces.len()
    );
    let empty = |kind: &Lines| Lines { label: String::new(), lines: kind.lines[..0].to_vec() };
    let of_forces: Vec<Lines> = kinds.iter().map(empty).collect();
    let of_forces = [of_forces, vec![Lines { label, lines: forces.iter().map(line).collect() }]].concat();
    let sheets = vec![
        Sheet { title: format!("axes, t = {time} τ"), seen, marked: None, kinds },
        Sheet { title: "contact forces over the whole period of 8 d".to_owned(), seen, marked: None, kinds: of_forces },
    ];
    let caption = "Left: the part framed in the previous figure. Right: its contact forces, drawn between the \
                   centres of grains (figure 5 of the paper). Neighbouring forces differ by more than their mean, \
                   but the axes of the blocks change smoothly.";
    Some(Figure::lines(
        "forces",
        "Principal axes and single contact forces",
        caption,
        LinePlot { axes: AXES.map(str::to_owned), to_scale: true, sheets },
    ))
}
