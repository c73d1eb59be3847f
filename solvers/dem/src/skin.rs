//! Skin of the neighbour list. The skin is the gap up to which pairs are listed.
//!
//! A list is valid until a grain or wall has moved by half of the skin. With a wider skin, the list is rebuilt less
//! often, but each step tests more pairs that are not in contact. A list of `P` pairs of `N` grains is used for `n`
//! steps. The cost w of a step is
//!
//! ```text
//! w(s) = P(s)·test + (N·grain + P·pair)/n(s)        P ∝ (2R + s)^d        n ∝ s
//! ```
//!
//! with the skin s, the mean radius R, the number of dimensions d and the costs `TEST`, `GRAIN` and `PAIR`. The skin is
//! adjusted towards `P·test·d·s/(2R + s) = (N·grain + P·pair)/n`, which is close to the minimum of w. The skin is at
//! least a tenth of a diameter. In a bed at rest, where the list is rarely rebuilt, this limit had no measurable cost.

/// Smallest and largest skin, in mean radii R.
const RANGE: [f64; 2] = [0.2, 1.0];
/// Cost per grain of building the list (ns). This cost, `PAIR` and `TEST` were measured with skins of 0.1 to 0.9 R on a
/// gas, sheared discs and a bed. Only their ratios matter.
const GRAIN: f64 = 45.0;
/// Cost per listed pair of building the list (ns).
const PAIR: f64 = 60.0;
/// Cost of testing one pair for contact (ns).
const TEST: f64 = 1.2;
/// Factor by which the skin changes from one list to the next. The skin does not change if the two sides of the condition
/// differ by less than this factor.
const CHANGE: f64 = 1.2;

/// Returns the first skin (m), from the mean radius of the grains (m).
pub(crate) fn first(mean_radius: f64) -> f64 {
    RANGE[0] * mean_radius
}

/// Returns the skin of the next list (m). The arguments are the skin of the previous list (m), the mean radius (m), the
/// numbers of pairs and of grains, the number of steps for which the previous list was used, and the number of
/// dimensions.
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

    /// Returns the skin (m) after 100 lists for 100 discs of radius 1 m. A list with a skin of one radius is used for
    /// `lasts` steps.
    fn settled(lasts: f64) -> f64 {
        let mut skin = first(1.0);
        for _ in 0..100 {
            let pairs = 100.0 * (2.0 + skin) * (2.0 + skin);
            skin = next(skin, 1.0, [pairs, 100.0, lasts * skin], 2);
        }
        skin
    }

    /// Returns the cost of a step (ns) for 100 discs of radius 1 m, by the formula for w(s).
    fn cost(skin: f64, lasts: f64) -> f64 {
        let pairs = 100.0 * (2.0 + skin) * (2.0 + skin);
        pairs * TEST + (100.0 * GRAIN + pairs * PAIR) / (lasts * skin)
    }

    #[test]
    fn a_list_that_lasts_keeps_the_thinnest_skin_and_another_gets_the_widest() {
        assert_eq!([1e6, 1.0].map(settled), RANGE);
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
