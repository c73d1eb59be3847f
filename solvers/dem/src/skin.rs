//! The skin of the neighbour list: how much farther than touch its pairs are looked for.
//!
//! The list holds until something has moved by half of the skin. A wider one is built anew less often and tests more pairs in
//! vain at every step. With `P` pairs in the list of `N` grains, which was good for `n` steps, a step costs
//!
//! ```text
//! w(s) = P(s)·test + (N·grain + P·pair)/n(s)        P ∝ (2R + s)^d        n ∝ s
//! ```
//!
//! whose least is where `P·test·d·s/(2R + s) = (N·grain + P·pair)/n`. The skin is never thinner than a tenth of a diameter: in a
//! bed at rest, where the list is hardly ever built, that costs nothing that could be measured.

/// Thinnest and widest skin, in mean radii R.
const RANGE: [f64; 2] = [0.2, 1.0];
/// What the list costs where it is built, for each grain and each pair, and what testing a pair costs (ns): measured with
/// skins of .1 to .9 R on a gas, sheared discs and a bed. Only their ratios matter.
const GRAIN: f64 = 45.0;
const PAIR: f64 = 60.0;
const TEST: f64 = 1.2;
/// By what the skin is changed at once, where one of the two sides is more than so much larger.
const CHANGE: f64 = 1.2;

/// The skin that a list begins with (m), of grains of a mean radius (m).
pub(crate) fn first(mean_radius: f64) -> f64 {
    RANGE[0] * mean_radius
}

/// The skin of the next list (m): of one with this skin (m) that held so many pairs of so many grains in `dimension` dimensions
/// for so many steps.
pub(crate) fn next(skin: f64, mean_radius: f64, [pairs, grains, steps]: [f64; 3], dimension: usize) -> f64 {
    let building = (grains * GRAIN + pairs * PAIR) / steps;
    let testing = pairs * TEST * dimension as f64 * skin / (2.0 * mean_radius + skin);
    let factor = match building / testing {
        ratio if ratio > CHANGE => CHANGE,
        ratio if ratio < 1.0 / CHANGE => 1.0 / CHANGE,
        _ => 1.0,
    };
    (skin * factor).clamp(RANGE[0] * mean_radius, RANGE[1] * mean_radius)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The skin to which lists of discs come whose steps are given by how fast grains move, in steps a skin of a radius lasts.
    fn settled(lasts: f64) -> f64 {
        let mut skin = first(1.0);
        for _ in 0..100 {
            let pairs = 100.0 * (2.0 + skin) * (2.0 + skin);
            skin = next(skin, 1.0, [pairs, 100.0, lasts * skin], 2);
        }
        skin
    }

    /// What a step costs (ns), as the head of the file has it.
    fn cost(skin: f64, lasts: f64) -> f64 {
        let pairs = 100.0 * (2.0 + skin) * (2.0 + skin);
        pairs * TEST + (100.0 * GRAIN + pairs * PAIR) / (lasts * skin)
    }

    #[test]
    fn a_list_that_lasts_keeps_the_thinnest_skin() {
        assert_eq!(settled(1e6), RANGE[0]);
    }

    #[test]
    fn a_list_that_does_not_last_gets_the_widest_skin() {
        assert_eq!(settled(1.0), RANGE[1]);
    }

    #[test]
    fn in_between_a_step_costs_as_little_as_can_be() {
        let lasts = 250.0;
        let skin = settled(lasts);
        let least = (20..=100).map(|part| cost(f64::from(part) * 0.01, lasts)).fold(f64::INFINITY, f64::min);
        assert!(skin > RANGE[0] && skin < RANGE[1], "{skin}");
        assert!(cost(skin, lasts) < 1.03 * least, "{skin}: {} for {least}", cost(skin, lasts));
    }
}
