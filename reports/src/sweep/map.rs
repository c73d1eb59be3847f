//! Maps over two factors. They show where each solver is within the tolerance, with one panel per solver and level.

use super::figures::levels;
use super::{Line, Point, Sweep, counts};
use crate::number;
use crate::plot::{WIDTH, document, px};
use maud::{Markup, html};
use serde_json::Value;

const ACROSS: usize = 3;
/// Space to the left of a panel for its numbers (drawing units).
const LEFT: f64 = 58.0;
/// Space below a panel for its numbers and label (drawing units).
const FOOT: f64 = 46.0;
/// Space above a panel for its title (drawing units).
const HEAD: f64 = 26.0;
/// Space above all panels for the title of the drawing (drawing units).
const TOP: f64 = 46.0;
/// Distance between panels (drawing units).
const GAP: f64 = 12.0;
/// Height of a panel (drawing units).
const HIGH: f64 = 210.0;
/// Largest number of distinct values of a factor. If a factor has more values, neighbouring values share a cell.
const MOST: usize = 40;
/// Smallest size of a cell that shows a sign (drawing units).
const SIGN: f64 = 13.0;
/// Smallest distance between numbers along each axis (drawing units).
const APART: [f64; 2] = [36.0, 15.0];

/// Colours of a cell: all points are within the tolerance, some are, none is, and no point is conclusive.
const COLOURS: [&str; 4] = ["#009e73", "#f0c36a", "#d55e00", "#e4e7eb"];
/// Signs of a cell. They distinguish cells without colour.
const SIGNS: [&str; 4] = ["", "·", "×", "–"];
const WORDS: [&str; 4] =
    ["within the tolerance for all values of the other factors", "at some", "at none", "not supported"];

/// Returns the caption and the SVG of the map; none without two factors or without an error.
pub(super) fn draw(sweep: &Sweep) -> Option<(String, String)> {
    let [x, y] = sweep.map.or_else(|| usual(sweep))?;
    sweep.points.iter().find_map(Point::error)?;
    let axes = [Marks::from_sweep(sweep, x), Marks::from_sweep(sweep, y)];
    let panels = levels(sweep);
    let columns = panels.len().clamp(1, ACROSS);
    let wide = (WIDTH - columns as f64 * (LEFT + GAP)) / columns as f64;
    let pitch = HEAD + HIGH + FOOT;
    let rows = panels.len().div_ceil(columns);
    let height = TOP + pitch * rows as f64 + if sweep.line.is_some() { 58.0 } else { 34.0 };
    let names: Vec<&str> = sweep.quantities.iter().map(|quantity| quantity.words.as_str()).collect();
    let title = format!("Solvers within the tolerance: {}", names.join("; "));
    let body = html! {
        @for (place, level) in panels.iter().enumerate() {
            @let left = LEFT + (place % columns) as f64 * (wide + LEFT + GAP);
            @let top = TOP + HEAD + (place / columns) as f64 * pitch;
            (panel(sweep, [x, y], &axes, level, [left, top, wide]))
        }
        (legend(TOP + pitch * rows as f64 + 12.0, sweep.line.as_ref()))
    };
    let [across, up] = [x, y].map(|place| sweep.factors[place].label.as_str());
    let caption = format!(
        "A cell is a pair of {across} and {up}: green if every point is within the tolerance for all values of the other \
         factors, yellow with a dot if some points are, red with a cross if none is. The number over a panel is the \
         fraction of its conclusive points within the tolerance.",
    );
    Some((caption, document(&title, [WIDTH, height], &body)))
}

/// Returns the first two factors that have several numeric values.
fn usual(sweep: &Sweep) -> Option<[usize; 2]> {
    let varies = |place: &usize| {
        let mut values = sweep.points.iter().map(|point| &point.factors[*place]);
        let first = values.next();
        first.is_some_and(Value::is_number) && values.any(|value| Some(value) != first && value.is_number())
    };
    let mut places = (0..sweep.factors.len()).filter(varies);
    Some([places.next()?, places.next()?])
}

/// Marks of an axis in ascending order: the values of a factor, or the middle values of slices of its range.
struct Marks {
    values: Vec<f64>,
    words: Vec<String>,
}

impl Marks {
    fn from_sweep(sweep: &Sweep, place: usize) -> Self {
        let mut values: Vec<f64> = sweep.points.iter().filter_map(|point| point.factors[place].as_f64()).collect();
        values.sort_by(f64::total_cmp);
        values.dedup();
        if values.len() > MOST {
            // Each slice contains equally many values, and its middle value represents it.
            let slices = MOST / 2;
            values = (0..slices).map(|slice| values[(2 * slice + 1) * values.len() / (2 * slices)]).collect();
        }
        let words = values.iter().map(|value| number::significant(*value, 3)).collect();
        Self { values, words }
    }

    /// Returns the position of a value along the axis, in cells. A mark is at the middle of its cell, and values
    /// between marks are interpolated linearly. Returns none for a value outside the cells.
    fn along(&self, value: f64) -> Option<f64> {
        let last = self.values.len().checked_sub(2)?;
        let after = self.values.partition_point(|mark| *mark < value).clamp(1, last + 1);
        let (before, behind) = (self.values[after - 1], self.values[after]);
        let place = (after - 1) as f64 + (value - before) / (behind - before) + 0.5;
        (0.0..=self.values.len() as f64).contains(&place).then_some(place)
    }

    /// Returns the index of the cell of a value: the nearest mark.
    fn cell(&self, value: &Value) -> Option<usize> {
        let value = value.as_f64()?;
        let after = self.values.partition_point(|mark| *mark < value);
        let away = |at: usize| Some((at, (self.values.get(at)? - value).abs()));
        let near = [Some(after), after.checked_sub(1)].into_iter().flatten().filter_map(away);
        near.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(at, _)| at)
    }
}

fn panel(
    sweep: &Sweep,
    [x, y]: [usize; 2],
    axes: &[Marks; 2],
    (solver, level, points): &(&str, &str, Vec<&Point>),
    [left, top, wide]: [f64; 3],
) -> Markup {
    let [across, up] = [axes[0].values.len(), axes[1].values.len()];
    let mut cells = vec![Vec::new(); across * up];
    for point in points {
        if let (Some(column), Some(row)) = (axes[0].cell(&point.factors[x]), axes[1].cell(&point.factors[y])) {
            cells[row * across + column].push(*point);
        }
    }
    let [within, outside, ..] = counts(points.iter().copied());
    let conclusive = within + outside;
    let share = if conclusive > 0 { number::fraction(within as f64 / conclusive as f64) } else { "—".to_owned() };
    let size = [wide / across as f64, HIGH / up as f64];
    let has_room = size[0] >= SIGN && size[1] >= SIGN;
    let title = format!("{solver} {level}: {share}");
    html! {
        text x=(px(left + 0.5 * wide)) y=(px(top - 8.0)) text-anchor="middle" font-size="13" fill="#222" { (title) }
        @for (place, cell) in cells.iter().enumerate() {
            @if let Some(kind) = kind(counts(cell.iter().copied())) {
                @let corner = [
                    left + (place % across) as f64 * size[0],
                    top + HIGH - (place / across + 1) as f64 * size[1],
                ];
                rect x=(px(corner[0])) y=(px(corner[1])) width=(px(size[0])) height=(px(size[1])) fill=(COLOURS[kind])
                    stroke="#fff" stroke-width=".6" {}
                @if has_room && !SIGNS[kind].is_empty() {
                    text x=(px(corner[0] + 0.5 * size[0])) y=(px(corner[1] + 0.5 * size[1] + 4.0)) text-anchor="middle"
                        font-size="12" fill="#222" { (SIGNS[kind]) }
                }
            }
        }
        @for run in line(sweep, axes, [left, top], size) {
            polyline points=(run) fill="none" stroke="#222" stroke-width="2.2" stroke-dasharray="7 4" {}
        }
        rect x=(px(left)) y=(px(top)) width=(px(wide)) height=(px(HIGH)) fill="none" stroke="#666" {}
        @for (at, word) in thinned(&axes[0].words, size[0], APART[0]) {
            text x=(px(left + (at as f64 + 0.5) * size[0])) y=(px(top + HIGH + 15.0)) text-anchor="middle" font-size="11"
                fill="#222" { (word) }
        }
        @for (at, word) in thinned(&axes[1].words, size[1], APART[1]) {
            text x=(px(left - 6.0)) y=(px(top + HIGH - (at as f64 + 0.5) * size[1] + 4.0)) text-anchor="end" font-size="11"
                fill="#222" { (word) }
        }
        text x=(px(left + 0.5 * wide)) y=(px(top + HIGH + 32.0)) text-anchor="middle" font-size="12" fill="#666" {
            (sweep.factors[x].label)
        }
        @let middle = [left - 44.0, top + 0.5 * HIGH];
        text x=(px(middle[0])) y=(px(middle[1])) text-anchor="middle" font-size="12" fill="#666"
            transform=(format!("rotate(-90 {} {})", px(middle[0]), px(middle[1]))) { (sweep.factors[y].label) }
    }
}

/// Returns the line on a panel. It has several pieces if it leaves the panel and returns.
fn line(sweep: &Sweep, axes: &[Marks; 2], [left, top]: [f64; 2], size: [f64; 2]) -> Vec<String> {
    let place = |(x, y): &(f64, f64)| {
        let (column, row) = (axes[0].along(*x)?, axes[1].along(*y)?);
        Some(format!("{},{}", px(left + column * size[0]), px(top + HIGH - row * size[1])))
    };
    let places: Vec<_> = sweep.line.iter().flat_map(|line| &line.points).map(place).collect();
    let runs = places.rsplit(Option::is_none).filter(|run| run.len() > 1);
    runs.map(|run| run.iter().flatten().map(String::as_str).collect::<Vec<_>>().join(" ")).collect()
}

/// Returns the index of the colour of a cell, from its numbers of points within, outside, amber and not judged; none for a
/// cell without points. A cell with an amber point is never green.
fn kind([within, outside, amber, unjudged]: [usize; 4]) -> Option<usize> {
    match (within, outside, amber + unjudged) {
        (0, 0, 0) => None,
        (0, 0, _) => Some(3),
        (_, 0, 0) => Some(0),
        (0, ..) => Some(2),
        _ => Some(1),
    }
}

/// Returns every n-th label with its index. `size` is the distance of neighbouring labels, and n is so large that the
/// returned labels are at least `apart` away from each other.
fn thinned(words: &[String], size: f64, apart: f64) -> impl Iterator<Item = (usize, &String)> {
    let every = (apart / size).ceil().max(1.0) as usize;
    words.iter().enumerate().step_by(every)
}

fn legend(y: f64, line: Option<&Line>) -> Markup {
    let step = [0.0, 318.0, 420.0, 520.0];
    html! {
        @for (at, colour) in COLOURS.iter().enumerate() {
            @let x = LEFT + step[at];
            rect x=(px(x)) y=(px(y)) width="14" height="14" fill=(colour) {}
            text x=(px(x + 7.0)) y=(px(y + 11.0)) text-anchor="middle" font-size="12" fill="#222" { (SIGNS[at]) }
            text x=(px(x + 20.0)) y=(px(y + 12.0)) font-size="13" fill="#222" { (WORDS[at]) }
        }
        @if let Some(line) = line {
            line x1=(px(LEFT - 6.0)) x2=(px(LEFT + 26.0)) y1=(px(y + 31.0)) y2=(px(y + 31.0)) stroke="#222" stroke-width="2.2"
                stroke-dasharray="7 4" {}
            text x=(px(LEFT + 34.0)) y=(px(y + 36.0)) font-size="13" fill="#222" { (line.label) }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::kind;

    /// An amber point is not within the tolerance, so its cell is not green.
    #[test]
    fn amber_points_are_seen() {
        assert_eq!([[2, 0, 0, 0], [2, 0, 1, 0], [0, 1, 1, 0], [0, 0, 1, 0]].map(kind), [0, 1, 2, 3].map(Some));
        assert_eq!([[2, 0, 0, 1], [1, 1, 0, 0], [0, 0, 0, 1]].map(kind), [1, 1, 3].map(Some));
        assert_eq!(kind([0; 4]), None);
    }
}
