//! Curves of a graph as SVG paths.

use std::fmt::Write as _;

use grainbench_harness::figure::Stroke;
use maud::{Markup, html};

use super::{CurveStyle, Place, px};

/// Number of points above which a curve is reduced to the resolution of the drawing.
const DENSE: usize = 400;
/// Number of markers on a line. They distinguish it from exact curves and from all other lines.
const MARKS_ON_A_LINE: usize = 7;

/// Returns an SVG path in tenths of a drawing unit. All positions after the first are relative to the previous one.
fn path(places: &[Place]) -> String {
    let tenths = |(x, y): Place| ((10.0 * x).round() as i64, (10.0 * y).round() as i64);
    let mut text = String::new();
    let mut before = None;
    for place in places.iter().map(|place| tenths(*place)) {
        let _ = match before {
            None => write!(text, "M{} {}", place.0, place.1),
            Some((x, y)) if (x, y) == place => Ok(()),
            Some((x, y)) => {
                let (across, up) = (place.0 - x, place.1 - y);
                let letter = if text.contains('l') { if across < 0 { "" } else { " " } } else { "l" };
                write!(text, "{letter}{across}{}{up}", if up < 0 { "" } else { " " })
            }
        };
        before = Some(place);
    }
    text
}

/// Draws a curve that consists of several pieces.
pub(super) fn draw(stroke: Stroke, look: &CurveStyle, pieces: &[Vec<Place>]) -> Markup {
    let all = || pieces.iter().flatten().copied();
    let joined = matches!(stroke, Stroke::Line | Stroke::Dashed | Stroke::MarkedLine);
    let line: String = if joined {
        pieces.iter().filter(|piece| piece.len() > 1).map(|piece| path(piece)).collect()
    } else {
        String::new()
    };
    let dash = look.dash.map(|(dash, gap)| format!("{} {}", 10 * dash, 10 * gap));
    html! {
        @if !line.is_empty() {
            path transform="scale(.1)" d=(line) fill="none" stroke=(look.colour) stroke-width="20" stroke-dasharray=[dash] {}
        }
        @match stroke {
            Stroke::Markers | Stroke::MarkedLine => { (marks(all(), look, true, 4.2)) }
            Stroke::Line => {
                (marks(pieces.iter().filter(|piece| piece.len() == 1).flatten().copied(), look, true, 4.2))
                // Markers are evenly spaced along x. Each shape of marker has its own offset, so that markers of
                // coinciding curves do not overlap.
                @let shift = 0.15 + 0.7 * (f64::from(look.marker as u8) * 0.38).fract();
                (marks(pieces.iter().flat_map(|piece| along(piece, MARKS_ON_A_LINE, shift)), look, false, 4.2))
            }
            Stroke::Dashed => {}
            Stroke::Beside => { (marks(all(), look, false, 2.8)) }
            Stroke::Failed => { (crosses(all(), look)) }
            Stroke::Bars => { (bars(&all().collect::<Vec<_>>(), look)) }
        }
    }
}

/// Draws pale bars. Each pair of positions gives the two ends of a bar.
fn bars(ends: &[Place], look: &CurveStyle) -> Markup {
    let bars: String = ends.chunks_exact(2).map(path).collect();
    html! { path transform="scale(.1)" d=(bars) fill="none" stroke=(look.colour) stroke-opacity=".3" stroke-width="50" {} }
}

fn crosses(places: impl Iterator<Item = Place>, look: &CurveStyle) -> Markup {
    let crosses: String = places.map(|(x, y)| format!("M{} {}l8 8m0 -8l-8 8", px(x - 4.0), px(y - 4.0))).collect();
    html! { path d=(crosses) fill="none" stroke=(look.colour) stroke-width="1.8" {} }
}

/// Draws markers. They are filled for measured points, and hollow if they only distinguish lines. Crowded markers are
/// outlines without filling.
fn marks(places: impl Iterator<Item = Place>, look: &CurveStyle, filled: bool, radius: f64) -> Markup {
    let corners = look.marker.corners();
    if corners.is_empty() {
        return if filled && look.open { rings(places, look, radius) } else { dots(places, look, filled, radius) };
    }
    let inside = match (filled, look.open) {
        (true, true) => "none",
        (true, false) => look.colour,
        (false, _) => "#fff",
    };
    let polygon = |(x, y): Place| {
        let corner = |(across, down): &Place| format!("{} {}", px(x + radius * across), px(y + radius * down));
        format!("M{}z", corners.iter().map(corner).collect::<Vec<_>>().join("L"))
    };
    let outline: String = places.map(polygon).collect();
    html! {
        @if !outline.is_empty() {
            path d=(outline) fill=(inside) stroke=(look.colour) stroke-width="1.6" {}
        }
    }
}

/// Draws round markers as outlines.
fn rings(places: impl Iterator<Item = Place>, look: &CurveStyle, radius: f64) -> Markup {
    let arc = |way: f64| format!("a{radius} {radius} 0 1 0 {way} 0");
    let rings: String = places
        .map(|(x, y)| format!("M{} {}{}{}", px(x - radius), px(y), arc(2.0 * radius), arc(-2.0 * radius)))
        .collect();
    html! { path d=(rings) fill="none" stroke=(look.colour) stroke-width="1.6" {} }
}

/// Draws round markers as lines of zero length with round ends, which takes the fewest characters.
fn dots(places: impl Iterator<Item = Place>, look: &CurveStyle, filled: bool, radius: f64) -> Markup {
    let dots: String = places.map(|(x, y)| format!("M{} {}h0", px(x), px(y))).collect();
    html! {
        @if !dots.is_empty() {
            path d=(dots) fill="none" stroke=(look.colour) stroke-linecap="round" stroke-width=(px(2.0 * radius + 1.6)) {}
            @if !filled {
                path d=(dots) fill="none" stroke="#fff" stroke-linecap="round" stroke-width=(px(2.0 * radius - 1.6)) {}
            }
        }
    }
}

/// Draws a sample of a curve for a legend, between two positions.
pub(super) fn sample(stroke: Stroke, look: &CurveStyle, from: Place, to: Place) -> Markup {
    let middle = (0.5 * (from.0 + to.0), from.1);
    html! {
        @match stroke {
            Stroke::Markers => { (marks([middle].into_iter(), look, true, 4.2)) }
            Stroke::Beside | Stroke::Failed => { (draw(stroke, look, &[vec![middle]])) }
            Stroke::Bars | Stroke::Dashed => { (draw(stroke, look, &[vec![from, to]])) }
            Stroke::Line | Stroke::MarkedLine => {
                (draw(Stroke::Dashed, look, &[vec![from, to]]))
                (marks([middle].into_iter(), look, stroke == Stroke::MarkedLine, 4.2))
            }
        }
    }
}

/// Returns points on a polyline at equal distances along x.
fn along(piece: &[Place], count: usize, shift: f64) -> Vec<Place> {
    let (Some(first), Some(last)) = (piece.first(), piece.last()) else { return Vec::new() };
    let point = |index: usize| {
        let at = first.0 + (last.0 - first.0) * (index as f64 + shift) / count as f64;
        piece.windows(2).find_map(|pair| {
            let ((ax, ay), (bx, by)) = (pair[0], pair[1]);
            let is_outside = (ax - at) * (bx - at) > 0.0 || ax == bx;
            (!is_outside).then(|| (at, ay + (at - ax) / (bx - ax) * (by - ay)))
        })
    };
    (0..count).filter_map(point).collect()
}

/// Reduces a dense curve: keeps the first, lowest, highest and last point in each interval of two drawing units.
pub(super) fn thin(points: Vec<Place>) -> Vec<Place> {
    let forward = points.windows(2).all(|pair| pair[0].0 <= pair[1].0);
    if points.len() <= DENSE || !forward {
        return points;
    }
    let column = |point: &Place| (0.5 * point.0).floor() as i64;
    let extremes = |run: &[Place]| {
        let lowest = run.iter().enumerate().min_by(|a, b| a.1.1.total_cmp(&b.1.1));
        let highest = run.iter().enumerate().max_by(|a, b| a.1.1.total_cmp(&b.1.1));
        let mut picks = vec![0, run.len() - 1];
        picks.extend(lowest.map(|(place, _)| place));
        picks.extend(highest.map(|(place, _)| place));
        picks.sort_unstable();
        picks.dedup();
        picks.into_iter().map(|place| run[place]).collect::<Vec<_>>()
    };
    points.chunk_by(|a, b| column(a) == column(b)).flat_map(extremes).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dense_curves_are_thinned_but_keep_their_peaks() {
        let mut points: Vec<Place> = (0..20_000).map(|step| (f64::from(step / 25), 100.0)).collect();
        points[7_777].1 = 900.0;
        let kept = thin(points);
        assert!(kept.len() < 1_700, "{}", kept.len());
        assert!(kept.iter().any(|point| point.1 == 900.0));
    }

    #[test]
    fn paths_say_the_first_place_and_the_ways_from_there() {
        assert_eq!(path(&[(1.0, 2.0), (3.0, 2.5), (2.0, 0.0), (2.0, 0.0), (4.0, 1.0)]), "M10 20l20 5-10-25 20 10");
    }
}
