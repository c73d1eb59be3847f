//! Force plot of Cundall and Strack: discs, walls, and a bar on each contact. The width of a bar is proportional to the
//! force.

use grainbench_harness::figure::{ForceBar, ForcePlot};
use maud::{Markup, html};

use super::{View, WIDTH, document, fine as px};
use crate::number;

const MARGIN: f64 = 24.0;
const TOP: f64 = 48.0;
/// Height of the key below the plot (drawing units).
const KEY: f64 = 64.0;
const TALLEST: f64 = 620.0;
const STICKING: &str = "#0072b2";
const SLIPPING: &str = "#d55e00";

/// Draws a force plot as an SVG document. A note states the number of parts without finite coordinates.
pub(crate) fn draw(title: &str, plot: &ForcePlot) -> String {
    let finite = |point: &[f64; 2]| point[0].is_finite() && point[1].is_finite();
    let discs: Vec<_> = plot.discs.iter().filter(|(centre, radius, _)| finite(centre) && radius.is_finite()).collect();
    let has_angles = discs.iter().any(|(_, _, angle)| angle.is_finite());
    let walls: Vec<_> = plot.walls.iter().filter(|(a, b)| finite(a) && finite(b)).collect();
    let mut bars: Vec<_> =
        plot.bars.iter().filter(|bar| finite(&bar.from) && finite(&bar.to) && bar.force.is_finite()).collect();
    // Bars of small forces are drawn over bars of large forces, so that all are visible. Outlines are drawn last.
    bars.sort_by(|a, b| b.force.abs().total_cmp(&a.force.abs()));
    let missing = plot.discs.len() + plot.walls.len() + plot.bars.len() - discs.len() - walls.len() - bars.len();

    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    let mut include = |point: [f64; 2], reach: f64| {
        for axis in 0..2 {
            low[axis] = low[axis].min(point[axis] - reach);
            high[axis] = high[axis].max(point[axis] + reach);
        }
    };
    discs.iter().for_each(|(centre, radius, _)| include(*centre, *radius));
    let ends = walls.iter().flat_map(|(a, b)| [*a, *b]).chain(bars.iter().flat_map(|bar| [bar.from, bar.to]));
    ends.for_each(|point| include(point, 0.0));
    if low[0] > high[0] {
        (low, high) = ([0.0; 2], [1.0; 2]);
    }
    let size = [0, 1].map(|axis| (high[axis] - low[axis]).max(f64::MIN_POSITIVE));
    let room = WIDTH - 2.0 * MARGIN;
    let scale = (room / size[0]).min(TALLEST / size[1]);
    let drawn = [size[0] * scale, size[1] * scale];
    let view = View { scale: [scale; 2], left: MARGIN + 0.5 * (room - drawn[0]), bottom: TOP + drawn[1], low };
    let height = TOP + drawn[1] + KEY;

    let strongest = bars.iter().map(|bar| bar.force.abs()).fold(0.0, f64::max);
    let radius = if discs.is_empty() {
        0.05 * drawn[0]
    } else {
        scale * discs.iter().map(|(_, radius, _)| radius).sum::<f64>() / discs.len() as f64
    };
    let widest = (0.8 * radius).clamp(4.0, 40.0);
    let width_of = |force: f64| {
        if strongest > 0.0 { widest * force.abs() / strongest } else { 0.0 }
    };
    let hairline = (0.04 * radius).clamp(0.5, 1.1);

    let body = html! {
        @for contact in &bars { (bar_between(&view, contact, width_of(contact.force))) }
        g fill="none" stroke="#555" stroke-width=(format!("{hairline:.2}")) {
            @for (centre, radius, angle) in &discs { (disc(&view, *centre, *radius, *angle)) }
        }
        g stroke="#222" stroke-width="4" stroke-linecap="round" {
            @for (a, b) in &walls {
                @let ([x1, y1], [x2, y2]) = (view.at(*a).map(px), view.at(*b).map(px));
                line x1=(x1) y1=(y1) x2=(x2) y2=(y2) {}
            }
        }
        (key(view.bottom + 40.0, strongest, &width_of, &bars, has_angles))
        @if let Some(note) = super::missing(missing, "part") {
            text x=(px(WIDTH - MARGIN)) y=(px(height - 4.0)) text-anchor="end" fill="#666" font-size="13" { (note) }
        }
    };
    document(title, [WIDTH, height], &body)
}

/// Draws the outline of a disc and, if its angle is known, a radius that rotates with the disc.
fn disc(view: &View, centre: [f64; 2], radius: f64, angle: f64) -> Markup {
    let [x, y] = view.at(centre);
    let radius = radius * view.scale[0];
    let rim = (x + radius * angle.cos(), y - radius * angle.sin());
    html! {
        circle cx=(px(x)) cy=(px(y)) r=(px(radius)) {}
        @if angle.is_finite() { line x1=(px(x)) y1=(px(y)) x2=(px(rim.0)) y2=(px(rim.1)) {} }
    }
}

fn bar_between(view: &View, bar: &ForceBar, width: f64) -> Markup {
    let ([x, y], [to_x, to_y]) = (view.at(bar.from), view.at(bar.to));
    let turn = (to_y - y).atan2(to_x - x).to_degrees();
    let place = format!("translate({} {}) rotate({turn:.2})", px(x), px(y));
    html! { g transform=(place) { (bar_along((to_x - x).hypot(to_y - y), width, bar.slipping)) } }
}

/// Draws a bar along x from the origin. Stripes distinguish slipping contacts without colour.
fn bar_along(length: f64, width: f64, slipping: bool) -> Markup {
    let half = 0.5 * width;
    let colour = if slipping { SLIPPING } else { STICKING };
    // Stripes as narrow as a thin bar would look grey.
    let gap = width.clamp(4.0, 8.0);
    let count = if slipping { (length / gap).floor() as u32 } else { 0 };
    let lean = half.min(0.45 * gap);
    let stripe = |stripe: u32| {
        let x = (f64::from(stripe) + 0.5) * gap;
        format!("M{} {}L{} {}", px(x - lean), px(half), px(x + lean), px(-half))
    };
    let stripes: String = (0..count).map(stripe).collect();
    html! {
        rect x="0" y=(px(-half)) width=(px(length)) height=(px(width)) fill=(colour) {}
        @if !stripes.is_empty() { path d=(stripes) stroke="#fff" stroke-width="1.4" fill="none" {} }
    }
}

/// Draws the key: the force that corresponds to a width, the style of slipping contacts, and the mark of the rotation.
fn key(y: f64, strongest: f64, width_of: &impl Fn(f64) -> f64, bars: &[&ForceBar], has_angles: bool) -> Markup {
    let slipping = bars.iter().any(|bar| bar.slipping);
    let shown = round_below(strongest);
    html! {
        g font-size="17" fill="#222" {
            @if strongest > 0.0 {
                g transform=(format!("translate({MARGIN} {})", px(y))) {
                    (bar_along(56.0, width_of(shown), false))
                    text x="66" y="5" { "contact force " (number::with_unit(shown, "N")) " (width ∝ force)" }
                }
                @if slipping {
                    g transform=(format!("translate(450 {})", px(y))) {
                        (bar_along(56.0, width_of(shown), true))
                        text x="66" y="5" { "slipping" }
                    }
                }
            } @else {
                text x=(MARGIN) y=(px(y + 5.0)) { "no contact forces" }
            }
            @if has_angles {
                g transform=(format!("translate(650 {})", px(y))) {
                    path d="M-12 0a12 12 0 1 0 24 0a12 12 0 1 0-24 0M0 0H12" fill="none" stroke="#555" {}
                    text x="22" y="5" { "rotation of a disc" }
                }
            }
        }
    }
}

/// Returns the largest number of the form 1, 2 or 5 times a power of ten that is at most `value`.
fn round_below(value: f64) -> f64 {
    if value <= 0.0 {
        return 0.0;
    }
    let decade = 10_f64.powf(value.log10().floor());
    let rounds = [5.0, 2.0, 1.0].map(|multiple| multiple * decade);
    rounds.into_iter().find(|round| *round <= value * (1.0 + 1e-9)).unwrap_or(decade)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn width_is_proportional_to_force() {
        let bar = |force: f64, slipping: bool| ForceBar { from: [0.0, 0.0], to: [1.0, 0.0], force, slipping };
        let svg = draw(
            "forces <&>",
            &ForcePlot {
                discs: vec![([0.0, 0.0], 0.5, 0.0), ([1.0, 0.0], 0.5, f64::NAN), ([f64::NAN, 0.0], 0.5, 0.0)],
                walls: vec![([-0.5, -0.5], [1.5, -0.5])],
                bars: vec![bar(30.0, false), bar(15.0, true)],
            },
        );
        assert!(svg.contains("height=\"40\"") && svg.contains("height=\"20\""), "{svg}");
        assert!(svg.contains("20\u{202f}N") && svg.contains("slipping"));
        assert!(svg.contains("(1 part without a finite place not shown)"));
        assert!(svg.contains("forces &lt;&amp;&gt;") && !svg.contains("NaN"));
        assert_eq!(svg.matches("<circle").count(), 2, "a disc without angle is an outline");
    }

    #[test]
    fn an_empty_plot_is_still_a_drawing() {
        let svg = draw("nothing", &ForcePlot { discs: Vec::new(), walls: Vec::new(), bars: Vec::new() });
        assert!(svg.contains("no contact forces") && !svg.contains("NaN") && !svg.contains("inf"));
    }
}
