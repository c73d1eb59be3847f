//! Lines in a plane, on sheets side by side. Either both axes have the same scale, so that angles are preserved, or
//! each axis fills the available space.

use grainbench_harness::figure::{LinePlot, Lines, Sheet};
use maud::{Markup, html};

use super::scale::Scale;
use super::{View, WIDTH, document, px, text_width, wrap};

/// Width to the left of a sheet, for numbers and label (drawing units).
const LEFT: f64 = 62.0;
/// Width to the right of a sheet (drawing units).
const RIGHT: f64 = 14.0;
/// Height above the sheets for the title of the drawing (drawing units).
const TOP: f64 = 50.0;
/// Height of each line of a sheet title (drawing units).
const TITLE_LINE: f64 = 16.0;
/// Height below a sheet, for numbers and label (drawing units).
const FOOT: f64 = 54.0;
/// Height of a line of the legend (drawing units).
const LINE: f64 = 24.0;
const TALLEST: f64 = 620.0;
/// Height of sheets whose axes have different scales (drawing units).
const FREE: f64 = 420.0;
/// Width of the widest line (drawing units).
const WIDEST: f64 = 5.0;
/// Number of different line widths. Lines of equal width share one SVG path.
const WIDTHS: usize = 12;
/// Colours of the groups of lines: blue, purple, orange and black.
const COLOURS: [&str; 4] = ["#0072b2", "#8b2f8f", "#e08214", "#222"];
/// Dashes of each group of lines on sheets whose axes have different scales, so that the groups are distinct without colour
/// vision. On sheets whose axes have the same scale, all lines are solid.
const DASHES: [Option<&str>; 4] = [None, Some("6 4"), Some("1 3"), None];
/// Opacity of thin lines on sheets whose axes have different scales, where many lines cross.
const THIN: f64 = 0.6;

/// Draws lines as an SVG document. A note states the number of lines without finite coordinates.
pub(crate) fn draw(title: &str, plot: &LinePlot) -> String {
    let count = plot.sheets.len().max(1) as f64;
    let some = |length: f64| if length > 0.0 { length } else { 1.0 };
    let across = some(plot.sheets.iter().map(|sheet| size(sheet)[0]).sum());
    let up = some(plot.sheets.iter().map(|sheet| size(sheet)[1]).fold(0.0, f64::max));
    // All sheets share one scale. The width of a sheet is proportional to its extent.
    let widest = (WIDTH - count * (LEFT + RIGHT)) / across;
    let one = widest.min(TALLEST / up);
    let scale = if plot.to_scale { [one, one] } else { [widest, FREE / up] };
    let drawn = across * scale[0] + count * (LEFT + RIGHT);
    // The title of a single sheet may be wider than the sheet.
    let title_lines = |sheet: &Sheet| {
        let room = if plot.sheets.len() == 1 { WIDTH - 2.0 * LEFT } else { (size(sheet)[0] * scale[0]).max(120.0) };
        wrap(&sheet.title, 14.0, room)
    };
    let most = plot.sheets.iter().map(|sheet| title_lines(sheet).len()).max().unwrap_or(1);
    let bottom = TOP + TITLE_LINE * most as f64 + up * scale[1];
    let mut left = 0.5 * (WIDTH - drawn);
    let mut missing = 0;
    let mut sheets = Vec::new();
    for sheet in &plot.sheets {
        let view = View { scale, left: left + LEFT, bottom, low: sheet.seen[0] };
        sheets.push(draw_sheet(sheet, &title_lines(sheet), &view, plot, &mut missing));
        left += LEFT + size(sheet)[0] * scale[0] + RIGHT;
    }
    let (mut y, mut keys) = (bottom + FOOT + 6.0, Vec::new());
    for (place, label) in legend(&plot.sheets) {
        let lines = wrap(label, 15.0, WIDTH - LEFT - 56.0);
        keys.push(key(place, &lines, y, dash(plot.to_scale, place)));
        y += LINE * lines.len() as f64;
    }
    let height = y + if missing > 0 { LINE } else { 4.0 };
    let body = html! {
        @for sheet in &sheets { (sheet) }
        @for key in &keys { (key) }
        @if let Some(note) = super::missing(missing, "line") {
            text x=(px(WIDTH - 10.0)) y=(px(y + 8.0)) text-anchor="end" fill="#666" font-size="13" { (note) }
        }
    };
    document(title, [WIDTH, height], &body)
}

fn size(sheet: &Sheet) -> [f64; 2] {
    let [low, high] = sheet.seen;
    [0, 1].map(|axis| if (high[axis] - low[axis]).is_finite() { (high[axis] - low[axis]).max(0.0) } else { 0.0 })
}

/// Returns x and y of the upper left corner, width and height of a rectangle in the drawing.
fn rectangle(view: &View, [low, high]: [[f64; 2]; 2]) -> [String; 4] {
    let ([x, y], [right, foot]) = (view.at([low[0], high[1]]), view.at([high[0], low[1]]));
    [x, y, right - x, foot - y].map(px)
}

fn draw_sheet(sheet: &Sheet, title: &[String], view: &View, plot: &LinePlot, missing: &mut usize) -> Markup {
    let [across, up] = &plot.axes;
    let [x, y, width, height] = rectangle(view, sheet.seen);
    let marked = sheet.marked.map(|part| rectangle(view, part));
    let [low, high] = sheet.seen;
    let middle = view.at([0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1])]);
    let room = |axis: usize| (((high[axis] - low[axis]) * view.scale[axis] / 70.0) as u32).max(2);
    let ticks = |axis: usize| Scale::fit([low[axis], high[axis]].into_iter(), false, 0.0, room(axis)).ticks();
    let foot = view.bottom;
    html! {
        @for (number, line) in title.iter().rev().enumerate() {
            @let y = view.at(high)[1] - 9.0 - TITLE_LINE * number as f64;
            text x=(px(middle[0])) y=(px(y)) text-anchor="middle" font-size="14" fill="#222" { (line) }
        }
        // A nested SVG element clips the lines at the edges of the sheet.
        svg x=(x) y=(y) width=(width) height=(height) viewBox=(format!("{x} {y} {width} {height}")) {
            g fill="none" stroke-linecap="round" {
                @for (place, kind) in sheet.kinds.iter().enumerate() { (draw_lines(kind, place, view, plot.to_scale, missing)) }
            }
        }
        rect x=(x) y=(y) width=(width) height=(height) fill="none" stroke="#222" {}
        @if let Some([x, y, width, height]) = marked {
            rect x=(x) y=(y) width=(width) height=(height) fill="none" stroke="#222" stroke-width="2.5" {}
        }
        g font-size="13" fill="#222" {
            @for tick in ticks(0) {
                @let x = px(view.at([tick.value, low[1]])[0]);
                line x1=(x) y1=(px(foot)) x2=(x) y2=(px(foot + 5.0)) stroke="#222" {}
                text x=(x) y=(px(foot + 19.0)) text-anchor="middle" { (tick.label.unwrap_or_default()) }
            }
            @for tick in ticks(1) {
                @let y = view.at([low[0], tick.value])[1];
                line x1=(px(view.left - 5.0)) y1=(px(y)) x2=(px(view.left)) y2=(px(y)) stroke="#222" {}
                text x=(px(view.left - 8.0)) y=(px(y + 4.5)) text-anchor="end" { (tick.label.unwrap_or_default()) }
            }
            text x=(px(middle[0])) y=(px(foot + 39.0)) text-anchor="middle" font-size="14" { (across) }
            // The label is to the left of the widest number.
            @let widths = ticks(1).into_iter().filter_map(|tick| tick.label).map(|label| text_width(&label, 13.0));
            @let x = px(view.left - (16.0 + widths.fold(0.0, f64::max)).max(40.0));
            text x=(x) y=(px(middle[1])) text-anchor="middle" font-size="14"
                transform=(format!("rotate(-90 {x} {})", px(middle[1]))) { (up) }
        }
    }
}

fn draw_lines(kind: &Lines, place: usize, view: &View, to_scale: bool, missing: &mut usize) -> Markup {
    let mut paths = vec![String::new(); WIDTHS + 1];
    let mut before: Option<([f64; 2], usize)> = None;
    for (from, to, width) in &kind.lines {
        let is_finite = |point: &[f64; 2]| point.iter().all(|along| along.is_finite());
        if !(is_finite(from) && is_finite(to) && width.is_finite()) {
            *missing += 1;
            continue;
        }
        let ([x, y], [to_x, to_y]) = (view.at(*from), view.at(*to));
        let class = (width.clamp(0.0, 1.0) * WIDTHS as f64).round() as usize;
        // A line that continues the previous one is added to the same path, so that the dashes continue.
        if before != Some((*from, class)) {
            paths[class].push_str(&format!("M{x:.1} {y:.1}"));
        }
        paths[class].push_str(&format!("L{to_x:.1} {to_y:.1}"));
        before = Some((*to, class));
    }
    let colour = COLOURS[place % COLOURS.len()];
    html! {
        @for (class, path) in paths.iter().enumerate().filter(|(_, path)| !path.is_empty()) {
            path d=(path) stroke=(colour) stroke-width=(px(0.3 + WIDEST * class as f64 / WIDTHS as f64))
                stroke-dasharray=[dash(to_scale, place)] stroke-opacity=[(!to_scale && 2 * class < WIDTHS).then_some(THIN)] {}
        }
    }
}

/// Returns the index and the label of each group that has lines.
fn legend(sheets: &[Sheet]) -> Vec<(usize, &str)> {
    let most = sheets.iter().map(|sheet| sheet.kinds.len()).max().unwrap_or(0);
    let label = |place: usize| {
        let mut all = sheets.iter().filter_map(|sheet| sheet.kinds.get(place));
        all.find(|kind| !kind.lines.is_empty()).map(|kind| (place, kind.label.as_str()))
    };
    (0..most).filter_map(label).collect()
}

fn dash(to_scale: bool, place: usize) -> Option<&'static str> {
    if to_scale { None } else { DASHES[place % DASHES.len()] }
}

fn key(place: usize, lines: &[String], y: f64, dash: Option<&'static str>) -> Markup {
    html! {
        line x1=(px(LEFT)) y1=(px(y)) x2=(px(LEFT + 34.0)) y2=(px(y)) stroke=(COLOURS[place % COLOURS.len()])
            stroke-width="3" stroke-linecap="round" stroke-dasharray=[dash] {}
        @for (number, line) in lines.iter().enumerate() {
            text x=(px(LEFT + 46.0)) y=(px(y + 5.0 + LINE * number as f64)) font-size="15" fill="#222" { (line) }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sheet(lines: Vec<([f64; 2], [f64; 2], f64)>) -> Sheet {
        let kinds = vec![Lines { label: "axes <of> T".to_owned(), lines }];
        Sheet { title: "left".to_owned(), seen: [[0.0, 0.0], [10.0, 20.0]], marked: Some([[1.0; 2], [2.0; 2]]), kinds }
    }

    fn plot(sheets: Vec<Sheet>) -> LinePlot {
        LinePlot { axes: ["x (d)".to_owned(), "z (d)".to_owned()], to_scale: true, sheets }
    }

    #[test]
    fn both_axes_have_one_scale_and_what_is_not_finite_is_counted() {
        let lines = vec![([0.0, 0.0], [5.0, 5.0], 1.0), ([f64::NAN, 0.0], [1.0, 1.0], 0.5)];
        let svg = draw("lines", &plot(vec![sheet(lines), sheet(Vec::new())]));
        let path = svg.split("d=\"M").nth(1).and_then(|rest| rest.split('"').next()).unwrap_or_default();
        let ends: Vec<f64> = path.split(['L', ' ']).filter_map(|number| number.parse().ok()).collect();
        assert_eq!(ends.len(), 4, "{path}");
        let (across, up) = (ends[2] - ends[0], ends[1] - ends[3]);
        assert!((across - up).abs() < 0.15 && across > 100.0, "{path}");
        assert!(svg.contains("(1 line without a finite place not shown)") && !svg.contains("NaN"));
        assert!(svg.contains("axes &lt;of&gt; T") && svg.contains("z (d)"));
        assert_eq!(svg.matches("stroke-width=\"2.5\"").count(), 2, "a marked part in each sheet");
        let free = draw("lines", &LinePlot { to_scale: false, ..plot(vec![sheet(Vec::new())]) });
        assert!(free.contains("height=\"420\""), "{free}");
    }

    #[test]
    fn an_empty_plot_is_still_a_drawing() {
        for sheets in [Vec::new(), vec![Sheet { seen: [[0.0; 2]; 2], ..sheet(Vec::new()) }]] {
            let svg = draw("nothing", &plot(sheets));
            assert!(svg.starts_with("<svg") && !svg.contains("NaN") && !svg.contains("inf"), "{svg}");
        }
    }
}
