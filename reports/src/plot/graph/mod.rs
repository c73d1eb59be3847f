//! Graphs: curves over two axes. Measured curves have markers, and exact curves are dashed. If both coincide, their
//! difference is plotted below.

mod axes;
mod curves;
mod difference;
mod legend;

use grainbench_harness::figure::{Axis, Curve, Graph, Stroke};
use maud::{Markup, html};
use plotters::coord::CoordTranslate;
use plotters::coord::cartesian::Cartesian2d;

use super::palette::{self, Marker};
use super::scale::{Scale, is_round};
use super::{WIDTH, document, px, text_width};
use crate::number;

const HEIGHT: f64 = 520.0;
/// Additional height for the panel of differences (drawing units).
const BELOW: f64 = 150.0;
const LABEL: f64 = 15.0;
const TICK: f64 = 14.0;
const NOTE: f64 = 12.5;
const LEGEND_LINE: f64 = 18.0;
const LEGEND_SAMPLE: f64 = 30.0;

/// Position in the drawing (drawing units).
type Place = (f64, f64);

/// Colour, marker and dashes of a curve.
#[derive(Clone, Copy)]
struct CurveStyle {
    colour: &'static str,
    marker: Marker,
    dash: Option<(u32, u32)>,
    /// True if markers are outlines, so that curves behind them stay visible.
    open: bool,
}

/// Rectangle between the axes (drawing units).
#[derive(Clone, Copy)]
struct Frame {
    left: f64,
    right: f64,
    top: f64,
    bottom: f64,
}

/// Rectangle with two scales. Its plane is in tenths of drawing units, because plotters uses integer coordinates.
struct Panel {
    frame: Frame,
    plane: Cartesian2d<Scale, Scale>,
}

fn tenths(length: f64) -> i32 {
    (10.0 * length).round() as i32
}

impl Panel {
    fn new(frame: Frame, x: &Scale, y: &Scale) -> Self {
        // In SVG, y points downwards.
        let limits = (tenths(frame.left)..tenths(frame.right), tenths(frame.bottom)..tenths(frame.top));
        Self { frame, plane: Cartesian2d::new(x.clone(), y.clone(), limits) }
    }

    fn x(&self) -> &Scale {
        self.plane.x_spec()
    }

    fn y(&self) -> &Scale {
        self.plane.y_spec()
    }

    fn place(&self, point: &(f64, f64)) -> Place {
        let (across, up) = self.plane.translate(point);
        (0.1 * f64::from(across), 0.1 * f64::from(up))
    }

    fn across(&self, value: f64) -> f64 {
        self.place(&(value, self.plane.get_y_range().start)).0
    }

    fn up(&self, value: f64) -> f64 {
        self.place(&(self.plane.get_x_range().start, value)).1
    }

    /// Returns the pieces of a curve. A line across a missing point would show data that do not exist.
    fn pieces(&self, points: &[(f64, f64)]) -> Vec<Vec<Place>> {
        let pieces = points.split(|point| !(self.x().shows(point.0) && self.y().shows(point.1)));
        let places = |piece: &[(f64, f64)]| curves::thin(piece.iter().map(|point| self.place(point)).collect());
        pieces.filter(|piece| !piece.is_empty()).map(places).collect()
    }
}

/// Size of a drawing, and flag for its legend.
#[derive(Clone, Copy)]
pub(crate) struct Form {
    /// Width (drawing units).
    pub(crate) width: f64,
    /// Height (drawing units).
    pub(crate) height: f64,
    pub(crate) legend: bool,
}

impl Form {
    /// Form of the figures in files and on pages.
    pub(crate) const FIGURE: Self = Self { width: WIDTH, height: HEIGHT, legend: true };
}

/// Returns the label and a drawn sample of each labelled curve, for a legend outside the graph.
pub(crate) fn keys(graph: &Graph) -> Vec<(&str, Markup)> {
    let (x, y) = scales(graph);
    let labelled = graph.curves.iter().zip(looks(&graph.curves, &x, &y)).filter(|(curve, _)| !curve.label.is_empty());
    let keys = labelled.map(|(curve, look)| {
        let sample = html! {
            svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 26 12" width="26" height="12" aria-hidden="true" {
                (curves::sample(curve.stroke, &look, (2.0, 6.0), (24.0, 6.0)))
            }
        };
        (curve.label.as_str(), sample)
    });
    keys.collect()
}

/// Draws a graph as a complete SVG document.
pub(crate) fn draw(title: &str, graph: &Graph) -> String {
    draw_as(title, graph, Form::FIGURE)
}

/// Draws a graph as an SVG document with the given form.
pub(crate) fn draw_as(title: &str, graph: &Graph, form: Form) -> String {
    let (x, y) = scales(graph);
    let looks = looks(&graph.curves, &x, &y);
    let notes = notes(graph);
    let difference = difference::from_graph(graph, &y);
    let height = form.height + if difference.is_some() { BELOW } else { 0.0 };

    let legend = if form.legend { legend::lines(&graph.curves) } else { Vec::new() };
    let legend_width = legend.iter().flatten().map(|line| text_width(line, TICK)).fold(0.0, f64::max);
    let ticks = [Some(&y), difference.as_ref().map(|difference| &difference.scale)];
    let labels = ticks.iter().flatten().flat_map(|scale| scale.ticks()).filter_map(|tick| tick.label);
    let tick_width = labels.map(|label| text_width(&label, TICK)).fold(0.0, f64::max);
    let frame = Frame {
        left: 44.0 + tick_width,
        right: if legend.is_empty() { form.width - 28.0 } else { form.width - legend_width - LEGEND_SAMPLE - 36.0 },
        top: 48.0,
        bottom: form.height - 58.0 - 17.0 * notes.len() as f64,
    };
    let panel = Panel::new(frame, &x, &y);
    let below = difference.as_ref().map(|difference| {
        let frame = Frame { top: frame.bottom + 22.0, bottom: frame.bottom + BELOW, ..frame };
        (Panel::new(frame, &x, &difference.scale), difference)
    });
    let body = html! {
        g stroke-linejoin="round" stroke-linecap="round" {
            (axes::draw(&panel, &graph.y.label, below.is_none().then_some(graph.x.label.as_str())))
            @for (curve, look) in in_order(&graph.curves, &looks) {
                (curves::draw(curve.stroke, look, &panel.pieces(&curve.points)))
            }
            @if let Some((panel, difference)) = &below {
                (axes::draw(panel, &difference::label(&graph.y.label), Some(&graph.x.label)))
                @for (at, points) in &difference.curves { (curves::draw(Stroke::Line, &looks[*at], &panel.pieces(points))) }
            }
            (legend::draw(graph, &looks, &legend, &panel))
            @for (line, note) in notes.iter().rev().enumerate() {
                text x=(px(frame.left)) y=(px(height - 8.0 - 17.0 * line as f64)) font-size=(NOTE) fill="#666" { (note) }
            }
        }
    };
    document(title, [form.width, height], &body)
}

/// Returns the resolution levels of a graph if all curves share a few levels, so that ticks are only at these levels. The
/// list is empty otherwise.
fn levels(curves: &[Curve]) -> Vec<f64> {
    const MOST: usize = 8;
    let is_of_levels = |curve: &&Curve| matches!(curve.stroke, Stroke::MarkedLine | Stroke::Markers);
    let mut levels: Vec<f64> =
        curves.iter().filter(is_of_levels).flat_map(|curve| &curve.points).map(|point| point.0).collect();
    let count = levels.len();
    levels.sort_by(f64::total_cmp);
    levels.dedup_by(|a, b| (*a - *b).abs() <= 1e-6 * b.abs());
    let is_run_at_levels = curves.iter().any(|curve| curve.stroke == Stroke::MarkedLine)
        && curves.iter().all(|curve| curve.stroke != Stroke::Beside);
    // If every point has its own level, the levels are not shared. Measured values, such as times, are not round.
    let is_shared = (count > levels.len() || levels.len() <= 4)
        && levels.iter().all(|level| is_round(*level, 3) || is_round(1.0 / level, 3));
    if is_run_at_levels && is_shared && (2..=MOST).contains(&levels.len()) { levels } else { Vec::new() }
}

fn scales(graph: &Graph) -> (Scale, Scale) {
    let points = || graph.curves.iter().flat_map(|curve| curve.points.iter());
    let (log_x, log_y) = (graph.x.logarithmic, graph.y.logarithmic);
    let seen = |point: &&(f64, f64)| {
        let on = |value: f64, logarithmic: bool| value.is_finite() && (value > 0.0 || !logarithmic);
        on(point.0, log_x) && on(point.1, log_y)
    };
    let only_lines = graph.curves.iter().all(|curve| matches!(curve.stroke, Stroke::Line | Stroke::Dashed));
    let x_margin = if only_lines && !log_x { 0.0 } else { 0.05 };
    let x = Scale::fit(points().filter(seen).map(|point| point.0), log_x, x_margin, 7);
    let y = Scale::fit(points().filter(seen).map(|point| point.1), log_y, 0.06, 6);
    (x.at_levels(&levels(&graph.curves)), y)
}

/// Returns the curves in drawing order: clouds of points behind lines, and markers in front.
fn in_order<'a>(curves: &'a [Curve], looks: &'a [CurveStyle]) -> Vec<(&'a Curve, &'a CurveStyle)> {
    let mut order: Vec<_> = curves.iter().zip(looks).collect();
    order.sort_by_key(|(curve, _)| match curve.stroke {
        Stroke::Bars => 0,
        Stroke::Beside => 1,
        Stroke::Line | Stroke::MarkedLine => 2,
        Stroke::Dashed => 3,
        Stroke::Markers => 4,
        Stroke::Failed => 5,
    });
    order
}

/// Returns true if markers of a curve would hide each other or those of another curve. If the graph has clouds of
/// points, which are outlines, returns false, so that markers are filled.
fn is_crowded(curves: &[Curve], x: &Scale, y: &Scale) -> bool {
    // Approximate size of the plot (drawing units), distances at which markers overlap, and number of markers that
    // counts as many.
    const SIZE: (f64, f64) = (620.0, 410.0);
    const BESIDE: f64 = 11.0;
    const UPON: f64 = 4.0;
    const MANY: usize = 12;
    let places = |curve: &Curve| -> Vec<Place> {
        let shown = curve.points.iter().filter(|point| x.shows(point.0) && y.shows(point.1));
        shown.map(|point| (SIZE.0 * x.position(point.0), SIZE.1 * y.position(point.1))).collect()
    };
    let is_near = |a: &Place, b: &Place, distance: f64| (a.0 - b.0).hypot(a.1 - b.1) < distance;
    let is_most = |count: usize, of: usize| of > 0 && 2 * count > of;
    let marked: Vec<_> = curves.iter().filter(|curve| curve.stroke == Stroke::Markers).map(places).collect();
    let is_hidden = |(at, here): (usize, &Vec<Place>)| {
        let close = here.windows(2).filter(|pair| is_near(&pair[0], &pair[1], BESIDE)).count();
        let upon = |there: &Vec<Place>| here.iter().filter(|a| there.iter().any(|b| is_near(a, b, UPON))).count();
        let mut others = marked.iter().enumerate().filter(|(other, _)| *other != at);
        (here.len() >= MANY && is_most(close, here.len())) || others.any(|(_, there)| is_most(upon(there), here.len()))
    };
    curves.iter().all(|curve| curve.stroke != Stroke::Beside) && marked.iter().enumerate().any(is_hidden)
}

/// Returns the style of each curve. Dashed curves have grey shades; other curves have the colours of their solvers.
fn looks(curves: &[Curve], x: &Scale, y: &Scale) -> Vec<CurveStyle> {
    let is_coloured = |curve: &&Curve| matches!(curve.stroke, Stroke::Line | Stroke::Markers | Stroke::MarkedLine);
    let labels: Vec<&str> = curves.iter().filter(is_coloured).map(|curve| curve.label.as_str()).collect();
    let mut coloured = palette::places(&labels).into_iter();
    let is_open = is_crowded(curves, x, y);
    let mut dashed = 0..;
    let solid = |place: usize, open: bool| {
        let (colour, marker) = palette::solid(place);
        CurveStyle { colour, marker, dash: None, open }
    };
    let mut before = solid(0, false);
    let look = |curve: &Curve| match curve.stroke {
        Stroke::Beside | Stroke::Failed => before,
        Stroke::Bars => CurveStyle { colour: "#666", ..before },
        Stroke::Dashed => {
            let (colour, marker, dash) = palette::dashed(dashed.next().unwrap_or_default());
            CurveStyle { colour, marker, dash: Some(dash), open: false }
        }
        Stroke::Line | Stroke::Markers | Stroke::MarkedLine => {
            before = solid(coloured.next().unwrap_or_default(), is_open && curve.stroke == Stroke::Markers);
            before
        }
    };
    curves.iter().map(look).collect()
}

/// Returns notes about the points that cannot be plotted.
fn notes(graph: &Graph) -> Vec<String> {
    let points = || graph.curves.iter().flat_map(|curve| curve.points.iter());
    let finite = |point: &&(f64, f64)| point.0.is_finite() && point.1.is_finite();
    let infinite = points().count() - points().filter(finite).count();
    let is_low = |axis: &Axis, value: f64| axis.logarithmic && value <= 0.0;
    let low = points().filter(finite).filter(|point| is_low(&graph.x, point.0) || is_low(&graph.y, point.1)).count();
    let notes = [(low, "at or below zero"), (infinite, "without a finite value")].into_iter();
    let notes = notes.filter(|(count, _)| *count > 0);
    notes.map(|(count, what)| format!("({} {what} not shown)", number::counted(count, "point"))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn graph(logarithmic: bool, points: Vec<(f64, f64)>) -> Graph {
        let axis = |label: &str| Axis { label: label.to_owned(), logarithmic };
        let curves = vec![Curve::new("dem", Stroke::MarkedLine, points)];
        Graph { x: axis("time step Δt (s)"), y: axis("error <&>"), curves }
    }

    #[test]
    fn counts_what_a_log_axis_cannot_show() {
        let points = vec![(1e-3, 1e-2), (1e-2, 0.0), (1e-1, -1.0), (1.0, f64::NAN)];
        let svg = draw("errors", &graph(true, points));
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
                let svg = draw("any", &graph(logarithmic, points.clone()));
                assert!(!svg.contains("NaN") && !svg.contains("inf"), "{points:?}");
            }
        }
    }

    #[test]
    fn ticks_stand_at_the_levels_that_were_run() {
        let svg = draw("levels", &graph(true, vec![(2.0, 0.4), (4.0, 0.2), (8.0, 0.1)]));
        for level in [">2<", ">4<", ">8<"] {
            assert!(svg.contains(level), "{level}");
        }
        assert!(!svg.contains(">5<") && !svg.contains("5×10⁰"));
        let measured = draw("times", &graph(true, vec![(5.3817e-5, 0.4), (2.2214e-4, 0.2), (1.6913e-3, 0.1)]));
        assert!(measured.contains("10⁻⁴") && !measured.contains("5.38"));
    }

    #[test]
    fn markers_that_would_hide_each_other_are_outlines() {
        let points = |count: u32, by: f64| -> Vec<(f64, f64)> {
            (0..count).map(|at| f64::from(at) / f64::from(count)).map(|x| (x, x * x + by)).collect()
        };
        let is_open = |all: &[Vec<(f64, f64)>]| {
            let curve = |points: &Vec<(f64, f64)>| Curve::new("", Stroke::Markers, points.clone());
            let curves: Vec<Curve> = all.iter().map(curve).collect();
            let (x, y) = scales(&Graph { x: Axis::linear("x"), y: Axis::linear("y"), curves: curves.clone() });
            is_crowded(&curves, &x, &y)
        };
        assert!(!is_open(&[points(9, 0.0), points(9, 0.5)]));
        assert!(is_open(&[points(9, 0.0), points(9, 1e-3)]), "on the other curve");
        assert!(is_open(&[points(200, 0.0)]), "on each other");
    }

    #[test]
    fn what_lies_on_the_exact_curve_is_shown_by_its_difference() {
        let exact: Vec<(f64, f64)> = (0..100).map(|at| (f64::from(at), f64::from(at))).collect();
        let off = |by: f64| -> Vec<(f64, f64)> { exact.iter().map(|(x, y)| (*x, y + by)).collect() };
        let drawn = |by: f64| {
            let curves =
                vec![Curve::new("dem", Stroke::Line, off(by)), Curve::new("exact", Stroke::Dashed, exact.clone())];
            draw("both", &Graph { x: Axis::linear("t (s)"), y: Axis::linear("x (m)"), curves })
        };
        assert!(drawn(1e-3).contains("difference (m)") && !drawn(20.0).contains("difference"));
    }
}
