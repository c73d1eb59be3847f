//! Axes of a graph with their ticks and labels.

use maud::{Markup, html};

use super::{LABEL, Panel, TICK, px};
use crate::plot::scale::Tick;
use crate::plot::{apart, text, text_width};

/// Draws the grid, and the axes with ticks and labels. Without `x_label`, the horizontal axis has no labels.
pub(super) fn draw(panel: &Panel, y_label: &str, x_label: Option<&str>) -> Markup {
    let frame = panel.frame;
    let (x_ticks, y_ticks) = (panel.x().ticks(), panel.y().ticks());
    let across =
        |tick: &Tick| tick.label.clone().map(|label| (panel.across(tick.value), text_width(&label, TICK), label));
    let up = |tick: &Tick| tick.label.clone().map(|label| (panel.up(tick.value), TICK, label));
    let (x_labels, y_labels) = (apart(x_ticks.iter().filter_map(across)), apart(y_ticks.iter().filter_map(up)));
    let path = |ticks: &mut dyn Iterator<Item = String>| ticks.collect::<String>();
    let grid = |labelled: bool| {
        let across = x_ticks
            .iter()
            .filter(|tick| tick.label.is_some() == labelled)
            .map(|tick| format!("M{} {}V{}", px(panel.across(tick.value)), px(frame.top), px(frame.bottom)));
        let up = y_ticks
            .iter()
            .filter(|tick| tick.label.is_some() == labelled)
            .map(|tick| format!("M{} {}H{}", px(frame.left), px(panel.up(tick.value)), px(frame.right)));
        path(&mut across.chain(up))
    };
    let length = |labelled: bool| if labelled { 6 } else { 3 };
    let marks = path(
        &mut x_ticks
            .iter()
            .map(|tick| {
                format!("M{} {}v{}", px(panel.across(tick.value)), px(frame.bottom), length(tick.label.is_some()))
            })
            .chain(y_ticks.iter().map(|tick| {
                format!("M{} {}h-{}", px(frame.left), px(panel.up(tick.value)), length(tick.label.is_some()))
            })),
    );
    let (left, right, top, bottom) = (px(frame.left), px(frame.right), px(frame.top), px(frame.bottom));
    let place = format!("translate(20 {}) rotate(-90)", px(0.5 * (frame.top + frame.bottom)));
    // The label of a low panel may be longer than the panel, but must not reach the next label.
    let y_size = (LABEL * (frame.bottom - frame.top + 40.0) / text_width(y_label, LABEL)).min(LABEL);
    html! {
        path d=(grid(false)) fill="none" stroke="#f0f0f0" stroke-width=".8" {}
        path d=(grid(true)) fill="none" stroke="#ddd" stroke-width=".8" {}
        path d=(format!("M{left} {top}V{bottom}H{right}")) fill="none" stroke="#222" stroke-width="1.2" {}
        path d=(marks) fill="none" stroke="#222" {}
        g font-size=(TICK) fill="#222" {
            g text-anchor="end" {
                @for (at, label) in &y_labels {
                    text x=(px(frame.left - 10.0)) y=(px(at + 0.35 * TICK)) { (label) }
                }
            }
            @if let Some(x_label) = x_label {
                g text-anchor="middle" {
                    @for (at, label) in &x_labels { text x=(px(*at)) y=(px(frame.bottom + 21.0)) { (label) } }
                    text x=(px(0.5 * (frame.left + frame.right))) y=(px(frame.bottom + 46.0)) font-size=(LABEL) {
                        (text::svg(x_label))
                    }
                }
            }
        }
        text transform=(place) text-anchor="middle" font-size=(px(y_size)) fill="#222" {
            (text::svg(y_label))
        }
    }
}
