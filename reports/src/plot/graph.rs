//! Curves over two axes.

use std::error::Error;

use grainbench_harness::figure::{Curve, Graph, Stroke};
use plotters::coord::Shift;
use plotters::coord::cartesian::Cartesian2d;
use plotters::element::DashedPathElement;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::palette::{self, Marker};
use super::scale::{Scale, Tick};
use super::{FONTS, WIDTH, text_width, wrap};

const HEIGHT: f64 = 520.0;
/// The drawing library places everything on whole pixels; on a canvas ten times as fine nobody sees that.
const FINE: f64 = 10.0;
const TITLE: f64 = 17.0;
const LABEL: f64 = 15.0;
const TICK: f64 = 14.0;
const NOTE: f64 = 12.5;
const LEGEND_LINE: f64 = 18.0;
const LEGEND_SAMPLE: f64 = 30.0;
/// More points than this are thinned to what the width can show.
const DENSE: usize = 1500;
/// Markers that tell solid lines apart.
const MARKS_ON_A_LINE: usize = 7;

type Canvas<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Drawn = Result<(), Box<dyn Error + Send + Sync>>;
type Pixel = (i32, i32);

/// How one curve looks.
#[derive(Clone, Copy)]
struct Look {
    colour: RGBColor,
    marker: Marker,
    dash: Option<(u32, u32)>,
}

/// Where the axes stand on the canvas, in figure units.
struct Frame {
    left: f64,
    right: f64,
    top: f64,
    bottom: f64,
}

/// Draws a graph as a complete SVG document.
///
/// # Errors
/// When the drawing library refuses.
pub fn draw(title: &str, graph: &Graph) -> Result<String, Box<dyn Error + Send + Sync>> {
    let mut svg = String::new();
    {
        let size = (fine(WIDTH) as u32, fine(HEIGHT) as u32);
        let canvas = SVGBackend::with_string(&mut svg, size).into_drawing_area();
        draw_on(&canvas, title, graph)?;
        canvas.present()?;
    }
    // The library's own opening tag has a fixed size in pixels and no font.
    let body = svg.split_once('>').map_or("", |(_, body)| body);
    let name = maud::html! { (title) }.into_string();
    Ok(format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\" width=\"100%\" role=\"img\" \
         aria-label=\"{name}\" font-family=\"{FONTS}\" stroke-linejoin=\"round\" stroke-linecap=\"round\">\n\
         <title>{name}</title>{body}",
        fine(WIDTH),
        fine(HEIGHT),
    ))
}

fn draw_on(canvas: &Canvas, title: &str, graph: &Graph) -> Drawn {
    let looks = looks(&graph.curves);
    let notes = notes(graph);
    let only_lines = graph.curves.iter().all(|curve| matches!(curve.stroke, Stroke::Line | Stroke::Dashed));
    let points = || graph.curves.iter().flat_map(|curve| curve.points.iter());
    let (log_x, log_y) = (graph.x.logarithmic, graph.y.logarithmic);
    let seen = |point: &&(f64, f64)| {
        let on = |value: f64, logarithmic: bool| value.is_finite() && (value > 0.0 || !logarithmic);
        on(point.0, log_x) && on(point.1, log_y)
    };
    let x_margin = if only_lines && !log_x { 0.0 } else { 0.05 };
    let x = Scale::fit(points().filter(seen).map(|point| point.0), log_x, x_margin, 7);
    let y = Scale::fit(points().filter(seen).map(|point| point.1), log_y, 0.06, 6);
    let (x_ticks, y_ticks) = (x.ticks(), y.ticks());

    let legend = legend_lines(&graph.curves);
    let legend_width = legend.iter().flatten().map(|line| text_width(line, TICK)).fold(0.0, f64::max);
    let tick_width =
        y_ticks.iter().filter_map(|tick| tick.label.as_ref()).map(|label| text_width(label, TICK)).fold(0.0, f64::max);
    let frame = Frame {
        left: 44.0 + tick_width,
        right: if legend.is_empty() { WIDTH - 28.0 } else { WIDTH - legend_width - LEGEND_SAMPLE - 36.0 },
        top: 48.0,
        bottom: HEIGHT - 58.0 - 17.0 * notes.len() as f64,
    };

    text(canvas, title, (10.0, 24.0), TITLE, palette::INK, (HPos::Left, VPos::Center), true)?;
    draw_axes(canvas, graph, &frame, (&x, &x_ticks), (&y, &y_ticks))?;
    for (line, note) in notes.iter().rev().enumerate() {
        let at = (frame.left, HEIGHT - 12.0 - 17.0 * line as f64);
        text(canvas, note, at, NOTE, palette::FAINT, (HPos::Left, VPos::Center), false)?;
    }

    let coordinates = Cartesian2d::<Scale, Scale>::new(
        x.clone(),
        y.clone(),
        (
            fine(frame.left)..fine(frame.right),
            // Pixels run downwards.
            fine(frame.bottom)..fine(frame.top),
        ),
    );
    let plot = canvas.clone().apply_coord_spec(coordinates);
    let solid = graph.curves.iter().filter(|curve| curve.stroke == Stroke::Line).count();
    for (curve, look) in graph.curves.iter().zip(&looks) {
        // A line breaks where points are missing: joining over the gap would invent data.
        let pieces: Vec<Vec<Pixel>> = curve
            .points
            .split(|point| !(x.shows(point.0) && y.shows(point.1)))
            .filter(|piece| !piece.is_empty())
            .map(|piece| thin(piece.iter().map(|point| plot.map_coordinate(point)).collect()))
            .collect();
        draw_curve(canvas, curve.stroke, look, &pieces, solid > 1)?;
    }
    draw_legend(canvas, graph, &looks, &legend, &frame, solid > 1)
}

/// Colours go round among computed curves and shades among dashed ones.
fn looks(curves: &[Curve]) -> Vec<Look> {
    let (mut coloured, mut dashed) = (0, 0);
    let mut before = Look { colour: palette::colour(0), marker: palette::marker(0), dash: None };
    curves
        .iter()
        .map(|curve| {
            match curve.stroke {
                Stroke::Beside | Stroke::Failed => return before,
                Stroke::Bars => return Look { colour: palette::FAINT, ..before },
                _ => {}
            }
            let place = if curve.stroke == Stroke::Dashed { &mut dashed } else { &mut coloured };
            let here = *place;
            *place += 1;
            if curve.stroke == Stroke::Dashed {
                Look { colour: palette::shade(here), marker: palette::marker(here), dash: Some(palette::dash(here)) }
            } else {
                before = Look { colour: palette::colour(here), marker: palette::marker(here), dash: None };
                before
            }
        })
        .collect()
}

/// What the reader must know of points that have no place.
fn notes(graph: &Graph) -> Vec<String> {
    let points = || graph.curves.iter().flat_map(|curve| curve.points.iter());
    let finite = |point: &&(f64, f64)| point.0.is_finite() && point.1.is_finite();
    let infinite = points().count() - points().filter(finite).count();
    let low = points()
        .filter(finite)
        .filter(|point| (graph.x.logarithmic && point.0 <= 0.0) || (graph.y.logarithmic && point.1 <= 0.0))
        .count();
    let mut notes = Vec::new();
    for (count, what) in [(low, "at or below zero"), (infinite, "without a finite value")] {
        if count > 0 {
            let plural = if count == 1 { "" } else { "s" };
            notes.push(format!("({count} point{plural} {what} not shown)"));
        }
    }
    notes
}

fn draw_axes(
    canvas: &Canvas,
    graph: &Graph,
    frame: &Frame,
    (x, x_ticks): (&Scale, &[Tick]),
    (y, y_ticks): (&Scale, &[Tick]),
) -> Drawn {
    let across = |value: f64| frame.left + x.position(value) * (frame.right - frame.left);
    let up = |value: f64| frame.bottom - y.position(value) * (frame.bottom - frame.top);
    for labelled in [false, true] {
        let colour = if labelled { palette::GRID } else { palette::FINE_GRID };
        for tick in x_ticks.iter().filter(|tick| tick.label.is_some() == labelled) {
            let at = across(tick.value);
            line(canvas, &[(at, frame.top), (at, frame.bottom)], colour, 0.8)?;
        }
        for tick in y_ticks.iter().filter(|tick| tick.label.is_some() == labelled) {
            let at = up(tick.value);
            line(canvas, &[(frame.left, at), (frame.right, at)], colour, 0.8)?;
        }
    }
    let corner = [(frame.left, frame.top), (frame.left, frame.bottom), (frame.right, frame.bottom)];
    line(canvas, &corner, palette::INK, 1.2)?;
    let mut free_from = f64::NEG_INFINITY;
    for tick in x_ticks {
        let at = across(tick.value);
        let length = if tick.label.is_some() { 6.0 } else { 3.0 };
        line(canvas, &[(at, frame.bottom), (at, frame.bottom + length)], palette::INK, 1.0)?;
        if let Some(label) = &tick.label {
            let half = 0.5 * text_width(label, TICK);
            // Two labels never run into each other.
            if at - half > free_from {
                let place = (at, frame.bottom + 10.0);
                text(canvas, label, place, TICK, palette::INK, (HPos::Center, VPos::Top), false)?;
                free_from = at + half + 6.0;
            }
        }
    }
    for tick in y_ticks {
        let at = up(tick.value);
        let length = if tick.label.is_some() { 6.0 } else { 3.0 };
        line(canvas, &[(frame.left - length, at), (frame.left, at)], palette::INK, 1.0)?;
        if let Some(label) = &tick.label {
            let place = (frame.left - 10.0, at);
            text(canvas, label, place, TICK, palette::INK, (HPos::Right, VPos::Center), false)?;
        }
    }
    let middle = (0.5 * (frame.left + frame.right), frame.bottom + 34.0);
    text(canvas, &graph.x.label, middle, LABEL, palette::INK, (HPos::Center, VPos::Top), false)?;
    let style = style(LABEL, palette::INK, (HPos::Center, VPos::Top), false).transform(FontTransform::Rotate270);
    let side = (fine(8.0), fine(0.5 * (frame.top + frame.bottom)));
    canvas.draw(&Text::new(graph.y.label.clone(), side, style))?;
    Ok(())
}

fn draw_curve(canvas: &Canvas, stroke: Stroke, look: &Look, pieces: &[Vec<Pixel>], several_lines: bool) -> Drawn {
    if matches!(stroke, Stroke::Line | Stroke::Dashed | Stroke::MarkedLine) {
        for piece in pieces {
            let pen = look.colour.stroke_width(fine(2.0) as u32);
            match look.dash {
                Some((dash, gap)) => {
                    let (dash, gap) = (dash * FINE as u32, gap * FINE as u32);
                    canvas.draw(&DashedPathElement::new(piece.iter().copied(), dash, gap, pen))?;
                }
                None => canvas.draw(&PathElement::new(piece.clone(), pen))?,
            }
        }
    }
    match stroke {
        Stroke::Markers | Stroke::MarkedLine => {
            for point in pieces.iter().flatten() {
                mark(canvas, *point, look, true)?;
            }
        }
        Stroke::Line => {
            for piece in pieces {
                if piece.len() == 1 {
                    mark(canvas, piece[0], look, true)?;
                } else if several_lines {
                    // Evenly along x, and for each shape elsewhere, so that curves on top of each other show theirs.
                    let shift = 0.15 + 0.7 * fraction_of(look.marker);
                    for point in along(piece, MARKS_ON_A_LINE, shift) {
                        mark(canvas, point, look, false)?;
                    }
                }
            }
        }
        Stroke::Dashed => {}
        Stroke::Beside => {
            for point in pieces.iter().flatten() {
                mark_of(canvas, *point, look, false, 2.8)?;
            }
        }
        Stroke::Failed => {
            for point in pieces.iter().flatten() {
                cross(canvas, *point, look)?;
            }
        }
        Stroke::Bars => {
            let pen = look.colour.mix(0.3).stroke_width(fine(5.0) as u32);
            for ends in pieces.iter().flatten().copied().collect::<Vec<Pixel>>().chunks(2) {
                canvas.draw(&PathElement::new(ends.to_vec(), pen))?;
            }
        }
    }
    Ok(())
}

/// A cross where a run failed.
fn cross(canvas: &Canvas, at: Pixel, look: &Look) -> Drawn {
    let reach = fine(4.0);
    let pen = look.colour.stroke_width(fine(1.8) as u32);
    for side in [-1, 1] {
        let ends = vec![(at.0 - reach, at.1 - side * reach), (at.0 + reach, at.1 + side * reach)];
        canvas.draw(&PathElement::new(ends, pen))?;
    }
    Ok(())
}

/// A different fraction of one for every shape.
fn fraction_of(marker: Marker) -> f64 {
    let place = (0..7).find(|place| palette::marker(*place) == marker).unwrap_or(0);
    (place as f64 * 0.38).fract()
}

/// Points of a polyline at even steps of x, interpolated.
fn along(piece: &[Pixel], count: usize, shift: f64) -> Vec<Pixel> {
    let (Some(first), Some(last)) = (piece.first(), piece.last()) else {
        return Vec::new();
    };
    let (from, to) = (f64::from(first.0), f64::from(last.0));
    (0..count)
        .filter_map(|index| {
            let at = from + (to - from) * (index as f64 + shift) / count as f64;
            piece.windows(2).find_map(|pair| {
                let (a, b) = (pair[0], pair[1]);
                let (ax, bx) = (f64::from(a.0), f64::from(b.0));
                if (ax - at) * (bx - at) > 0.0 || a.0 == b.0 {
                    return None;
                }
                let part = (at - ax) / (bx - ax);
                let y = f64::from(a.1) + part * f64::from(b.1 - a.1);
                Some((at.round() as i32, y.round() as i32))
            })
        })
        .collect()
}

/// Keeps the first, lowest, highest and last point of every half pixel that a dense curve crosses.
fn thin(points: Vec<Pixel>) -> Vec<Pixel> {
    let forward = points.windows(2).all(|pair| pair[0].0 <= pair[1].0);
    if points.len() <= DENSE || !forward {
        return points;
    }
    let column = |point: &Pixel| point.0 / 5;
    let mut kept = Vec::new();
    for run in points.chunk_by(|a, b| column(a) == column(b)) {
        let lowest = run.iter().enumerate().min_by_key(|(_, point)| point.1);
        let highest = run.iter().enumerate().max_by_key(|(_, point)| point.1);
        let mut picks = vec![0, run.len() - 1];
        picks.extend(lowest.map(|(place, _)| place));
        picks.extend(highest.map(|(place, _)| place));
        picks.sort_unstable();
        picks.dedup();
        kept.extend(picks.into_iter().map(|place| run[place]));
    }
    kept
}

/// A marker: filled where a point was measured, hollow where it only tells lines apart.
fn mark(canvas: &Canvas, at: Pixel, look: &Look, filled: bool) -> Drawn {
    mark_of(canvas, at, look, filled, 4.2)
}

/// The same of a size of one's own.
fn mark_of(canvas: &Canvas, at: Pixel, look: &Look, filled: bool, radius: f64) -> Drawn {
    let radius = fine(radius);
    let edge = look.colour.stroke_width(fine(1.6) as u32);
    let inside = if filled { look.colour.filled() } else { WHITE.filled() };
    let corners: Vec<Pixel> = look
        .marker
        .corners()
        .into_iter()
        .map(|(x, y)| {
            let place = |centre: i32, offset: f64| centre + (offset * f64::from(radius)).round() as i32;
            (place(at.0, x), place(at.1, y))
        })
        .collect();
    if corners.is_empty() {
        canvas.draw(&Circle::new(at, radius, inside))?;
        canvas.draw(&Circle::new(at, radius, edge))?;
    } else {
        let outline: Vec<_> = corners.iter().chain(corners.first()).copied().collect();
        canvas.draw(&Polygon::new(corners, inside))?;
        canvas.draw(&PathElement::new(outline, edge))?;
    }
    Ok(())
}

/// Labels of the legend, broken into lines; empty when there is nothing to tell.
fn legend_lines(curves: &[Curve]) -> Vec<Vec<String>> {
    if curves.iter().all(|curve| curve.label.is_empty()) {
        return Vec::new();
    }
    curves.iter().map(|curve| wrap(&curve.label, TICK, 150.0)).collect()
}

fn draw_legend(
    canvas: &Canvas,
    graph: &Graph,
    looks: &[Look],
    legend: &[Vec<String>],
    frame: &Frame,
    several_lines: bool,
) -> Drawn {
    let left = frame.right + 18.0;
    let mut top = frame.top + 6.0;
    // A long legend moves closer together before it runs off the canvas.
    let lines = legend.iter().map(Vec::len).sum::<usize>() as f64;
    let spare = HEIGHT - top - 12.0 - lines * LEGEND_LINE;
    let gap = (spare / legend.len().max(1) as f64).clamp(0.0, 7.0);
    for ((curve, look), lines) in graph.curves.iter().zip(looks).zip(legend) {
        // What looks as the curve before it needs no word of its own.
        if curve.label.is_empty() && matches!(curve.stroke, Stroke::Beside | Stroke::Failed) {
            continue;
        }
        let from = (fine(left), fine(top + 3.0));
        let to = (fine(left + LEGEND_SAMPLE - 4.0), from.1);
        let middle = (i32::midpoint(from.0, to.0), from.1);
        match curve.stroke {
            Stroke::Markers => {}
            Stroke::Bars => draw_curve(canvas, Stroke::Bars, look, &[vec![from, to]], false)?,
            Stroke::Beside | Stroke::Failed => draw_curve(canvas, curve.stroke, look, &[vec![middle]], false)?,
            Stroke::Dashed => draw_curve(canvas, Stroke::Dashed, look, &[vec![from, to]], false)?,
            Stroke::Line | Stroke::MarkedLine => {
                draw_curve(canvas, Stroke::Line, look, &[vec![from, to]], false)?;
            }
        }
        match curve.stroke {
            Stroke::Markers | Stroke::MarkedLine => mark(canvas, middle, look, true)?,
            Stroke::Line if several_lines => mark(canvas, middle, look, false)?,
            Stroke::Line | Stroke::Dashed | Stroke::Beside | Stroke::Failed | Stroke::Bars => {}
        }
        for part in lines {
            let place = (left + LEGEND_SAMPLE + 4.0, top + 3.0);
            text(canvas, part, place, TICK, palette::INK, (HPos::Left, VPos::Center), false)?;
            top += LEGEND_LINE;
        }
        top += gap;
    }
    Ok(())
}

fn fine(length: f64) -> i32 {
    (length * FINE).round() as i32
}

fn line(canvas: &Canvas, points: &[(f64, f64)], colour: RGBColor, width: f64) -> Drawn {
    let points: Vec<Pixel> = points.iter().map(|(x, y)| (fine(*x), fine(*y))).collect();
    canvas.draw(&PathElement::new(points, colour.stroke_width(fine(width) as u32)))?;
    Ok(())
}

fn style(size: f64, colour: RGBColor, (h, v): (HPos, VPos), bold: bool) -> TextStyle<'static> {
    let weight = if bold { FontStyle::Bold } else { FontStyle::Normal };
    // The library divides sizes by 1.24; the font itself stands on the root element.
    FontDesc::new(FontFamily::Name("inherit"), size * FINE * 1.24, weight).color(&colour).pos(Pos::new(h, v))
}

fn text(
    canvas: &Canvas,
    words: &str,
    (x, y): (f64, f64),
    size: f64,
    colour: RGBColor,
    anchor: (HPos, VPos),
    bold: bool,
) -> Drawn {
    let style = style(size, colour, anchor, bold);
    canvas.draw(&Text::new(words.to_owned(), (fine(x), fine(y)), style))?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use grainbench_harness::figure::Axis;

    use super::*;

    fn graph(logarithmic: bool, points: Vec<(f64, f64)>) -> Graph {
        let axis = |label: &str| Axis { label: label.to_owned(), logarithmic };
        Graph {
            x: axis("time step Δt (s)"),
            y: axis("error <&>"),
            curves: vec![Curve { label: "dem".to_owned(), stroke: Stroke::MarkedLine, points }],
        }
    }

    #[test]
    fn counts_what_a_log_axis_cannot_show() {
        let points = vec![(1e-3, 1e-2), (1e-2, 0.0), (1e-1, -1.0), (1.0, f64::NAN)];
        let svg = draw("errors", &graph(true, points)).unwrap();
        assert!(svg.contains("(2 points at or below zero not shown)"));
        assert!(svg.contains("(1 point without a finite value not shown)"));
        assert!(svg.contains("10⁻²"));
        assert!(svg.contains("error &lt;&amp;&gt;"));
        assert!(!svg.contains("NaN") && !svg.contains("inf"));
    }

    #[test]
    fn draws_whatever_the_points_are() {
        for points in [vec![], vec![(f64::NAN, 1.0)], vec![(1.0, 1.0)], vec![(-1.0, f64::MAX), (1.0, f64::MIN)]] {
            for logarithmic in [false, true] {
                draw("any", &graph(logarithmic, points.clone())).unwrap();
            }
        }
    }

    #[test]
    fn dense_curves_are_thinned_but_keep_their_peaks() {
        let mut points: Vec<Pixel> = (0..20_000).map(|step| (step / 10, 100)).collect();
        points[7_777].1 = 900;
        let kept = thin(points);
        assert!(kept.len() < 2_000, "{}", kept.len());
        assert!(kept.iter().any(|point| point.1 == 900));
    }
}
