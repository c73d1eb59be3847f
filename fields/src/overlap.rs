//! Exact overlap of a disc or a sphere with a box.
//!
//! The volume in a box is a sum over the corners of the box by inclusion and exclusion. Each term is the volume of the
//! unit ball beyond one, two or three sides: Q₁ in x > a, Q₂ in x > a, y > b, and Q₃ in x > a, y > b, z > c. For a, b,
//! c ≥ 0, Gauss' theorem gives the volume as a third of the spherical area minus the terms of the cut faces:
//!
//! ```text
//! Q₁ = π(1−a)²(2+a)/3
//! Q₂ = ⅓[S − a A(a,b) − b A(b,a)]
//!      S = 2π − 2a acos(b/√(1−a²)) − 2b acos(a/√(1−b²)) − 2 acos(−ab/√((1−a²)(1−b²)))
//!      A(a,b) = r² acos(b/r) − b√(r²−b²),  r² = 1−a²
//! Q₃ = ⅓[S₃ − Σ a A₃]
//!      S₃ = 2π − Σ a φ_a − Σ_pairs acos(−ab/√((1−a²)(1−b²))),  φ_a = acos(c/r) − asin(b/r)
//!      A₃ = ½[r² φ_a − c(√(r²−c²) − b) − b(√(r²−b²) − c)]
//! ```
//!
//! The areas S follow from the theorem of Gauss and Bonnet. For a < 0, the volume beyond the side a is the volume
//! without this side less the volume beyond the side −a.

use std::f64::consts::PI;

/// Returns the exact area of a disc about the origin within the box from `low` to `high` (m²).
#[must_use]
pub fn disc_in_box(radius: f64, low: [f64; 2], high: [f64; 2]) -> f64 {
    if radius <= 0.0 {
        return 0.0;
    }
    let corner = |x: f64, y: f64| below_left((x / radius).clamp(-1.0, 1.0), (y / radius).clamp(-1.0, 1.0));
    let unit = corner(high[0], high[1]) - corner(low[0], high[1]) - corner(high[0], low[1]) + corner(low[0], low[1]);
    (unit * radius * radius).max(0.0)
}

/// Returns the area of the part of the unit disc with coordinates below x and y: the integral of the height of this
/// part.
fn below_left(x: f64, y: f64) -> f64 {
    // ∫√(1 − u²) du
    let half_disc = |u: f64| 0.5 * (u * (1.0 - u * u).max(0.0).sqrt() + u.asin());
    let whole = |from: f64, to: f64| if to > from { 2.0 * (half_disc(to) - half_disc(from)) } else { 0.0 };
    let cut = |from: f64, to: f64| {
        if to > from { y * (to - from) + half_disc(to) - half_disc(from) } else { 0.0 }
    };
    let reach = (1.0 - y * y).max(0.0).sqrt();
    let middle = cut(-reach, x.clamp(-reach, reach));
    if y < 0.0 {
        return middle;
    }
    // For y ≥ 0, the parts of the disc to the left and right of the chord at height y lie entirely below y.
    whole(-1.0, x.min(-reach)) + middle + whole(reach, x.max(reach))
}

/// Returns the exact volume of a sphere about the origin within the box from `low` to `high` (m³).
#[must_use]
pub fn sphere_in_box(radius: f64, low: [f64; 3], high: [f64; 3]) -> f64 {
    if radius <= 0.0 || (0..3).any(|axis| low[axis] >= high[axis]) {
        return 0.0;
    }
    let mut unit = 0.0;
    for corner in 0..8_u32 {
        let side = |axis: usize| if corner >> axis & 1 == 0 { low[axis] } else { high[axis] } / radius;
        let beyond = ball_beyond([0, 1, 2].map(|axis| Some(side(axis))));
        unit += if corner.count_ones().is_multiple_of(2) { beyond } else { -beyond };
    }
    (unit * radius.powi(3)).clamp(0.0, 4.0 / 3.0 * PI * radius.powi(3))
}

/// Returns the volume of the part of the unit ball with x, y and z above the given values; `None` means no condition
/// along an axis.
fn ball_beyond(sides: [Option<f64>; 3]) -> f64 {
    if sides.iter().flatten().any(|&side| side >= 1.0) {
        return 0.0;
    }
    for axis in 0..3 {
        let with = |side: Option<f64>| {
            let mut sides = sides;
            sides[axis] = side;
            ball_beyond(sides)
        };
        if let Some(side) = sides[axis].filter(|&side| side < 0.0) {
            return with(None) - with(Some(-side));
        }
    }
    let mut cuts = sides.into_iter().flatten();
    match [cuts.next(), cuts.next(), cuts.next()] {
        [Some(a), Some(b), Some(c)] => corner([a, b, c]),
        [Some(a), Some(b), None] => edge(a, b),
        [Some(a), ..] => PI * (1.0 - a).powi(2) * (2.0 + a) / 3.0,
        _ => 4.0 / 3.0 * PI,
    }
}

/// Returns acos of a cosine, which is clamped to [−1, 1] against rounding.
fn acos(cosine: f64) -> f64 {
    cosine.clamp(-1.0, 1.0).acos()
}

/// Returns the exterior angle (rad) at a corner of the spherical area beyond the sides a and b, as in the theorem of
/// Gauss and Bonnet.
fn between(a: f64, b: f64) -> f64 {
    acos(-a * b / ((1.0 - a * a) * (1.0 - b * b)).sqrt())
}

/// Returns Q₂(a, b), the volume of the unit ball beyond two sides, for a, b ≥ 0.
fn edge(a: f64, b: f64) -> f64 {
    if a * a + b * b >= 1.0 {
        return 0.0;
    }
    let arc = |a: f64, b: f64| acos(b / (1.0 - a * a).sqrt());
    let face = |a: f64, b: f64| {
        let square = 1.0 - a * a;
        square * arc(a, b) - b * (square - b * b).max(0.0).sqrt()
    };
    let sphere = 2.0 * PI - 2.0 * a * arc(a, b) - 2.0 * b * arc(b, a) - 2.0 * between(a, b);
    (sphere - a * face(a, b) - b * face(b, a)) / 3.0
}

/// Returns Q₃(a, b, c), the volume of the unit ball beyond three sides, for a, b, c ≥ 0.
fn corner([a, b, c]: [f64; 3]) -> f64 {
    if a * a + b * b + c * c >= 1.0 {
        return 0.0;
    }
    let mut third = 2.0 * PI - between(a, b) - between(b, c) - between(c, a);
    for [a, b, c] in [[a, b, c], [b, c, a], [c, a, b]] {
        let square = 1.0 - a * a;
        let radius = square.sqrt();
        let arc = acos(c / radius) - (b / radius).clamp(-1.0, 1.0).asin();
        let along = |side: f64| (square - side * side).max(0.0).sqrt();
        let face = 0.5 * (square * arc - c * (along(c) - b) - b * (along(b) - c));
        third -= a * (arc + face);
    }
    third / 3.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_disc_cut_by_a_box_has_the_area_of_geometry() {
        let far = 10.0;
        assert!((disc_in_box(2.0, [-far; 2], [far; 2]) / (4.0 * PI) - 1.0).abs() < 1e-14);
        assert!((disc_in_box(2.0, [0.0; 2], [far; 2]) / PI - 1.0).abs() < 1e-14);
        assert!((disc_in_box(2.0, [-0.1, 0.2], [0.3, 0.9]) - 0.4 * 0.7).abs() < 1e-14);
        // The circular segment of height R/2 has the area R² (π/3 − √3/4).
        let segment = PI / 3.0 - 3_f64.sqrt() / 4.0;
        assert!((disc_in_box(1.0, [0.5, -far], [far, far]) / segment - 1.0).abs() < 1e-14);
        // The corner at (½, ½) has the area ∫ (√(1−u²) − ½) du from ½ to √¾.
        let corner = PI / 12.0 + 0.25 - 0.5 * 0.75_f64.sqrt();
        assert!((disc_in_box(1.0, [0.5, 0.5], [far, far]) / corner - 1.0).abs() < 1e-13);
        assert_eq!(disc_in_box(1.0, [1.5, 0.0], [2.0, 1.0]), 0.0);
        assert_eq!(disc_in_box(0.0, [-1.0; 2], [1.0; 2]), 0.0);
    }

    /// Returns the volume of the part of the unit ball with x, y and z above the given values.
    fn beyond(sides: [f64; 3]) -> f64 {
        sphere_in_box(1.0, sides, [9.0; 3])
    }

    /// The reference volumes come from quadrature with thirty digits.
    #[test]
    fn caps_edges_and_corners_have_their_volumes() {
        let none = -9.0;
        let known = [
            ([0.5, none, none], 5.0 * PI / 24.0),
            ([0.0, 0.0, none], PI / 3.0),
            ([0.0, 0.0, 0.0], PI / 6.0),
            ([0.5, 0.5, none], 0.062_783_841_810_807_23),
            ([0.3, 0.4, none], 0.224_965_900_752_373_22),
            ([0.5, 0.5, 0.5], 0.001_900_686_191_105_431_1),
            ([0.1, 0.2, 0.3], 0.163_788_390_159_071_18),
            ([-0.4, -0.3, 0.5], 0.417_740_454_338_939_74),
        ];
        for (sides, volume) in known {
            // The result must not depend on the order of the axes.
            for turn in 0..3 {
                let mut sides = sides;
                sides.rotate_left(turn);
                assert!((beyond(sides) - volume).abs() < 1e-15, "{sides:?}: {} for {volume}", beyond(sides));
            }
        }
        assert_eq!((beyond([0.7, 0.8, none]), beyond([0.6, 0.6, 0.6]), beyond([1.0, none, none])), (0.0, 0.0, 0.0));
    }

    #[test]
    fn boxes_that_fill_space_share_a_sphere_out() {
        let (radius, sides) = (1.3, [-1.71, -1.2, -0.31, 0.004, 0.95, 1.8]);
        let volume = 4.0 / 3.0 * PI * radius * radius * radius;
        let mut sum = 0.0;
        for cell in 0..125 {
            let at = [cell % 5, cell / 5 % 5, cell / 25];
            sum += sphere_in_box(radius, at.map(|at| sides[at]), at.map(|at| sides[at + 1]));
        }
        assert!((sum / volume - 1.0).abs() < 1e-13, "{}", sum / volume - 1.0);
        // The first cube lies inside the sphere, and the second one far outside. The last sphere has no volume.
        assert!((sphere_in_box(1.0, [-0.2; 3], [0.3; 3]) / 0.125 - 1.0).abs() < 1e-13);
        assert_eq!((sphere_in_box(1.0, [2.0; 3], [3.0; 3]), sphere_in_box(0.0, [-1.0; 3], [1.0; 3])), (0.0, 0.0));
    }

    /// The reference is a sum over slices of the sphere. The area of each slice has a closed form.
    #[test]
    fn boxes_anywhere_agree_with_their_slices() {
        let mut odd = 0.5_f64;
        let mut next = || {
            odd = (odd * 9301.0 + 0.49297).fract();
            2.4 * odd - 1.2
        };
        for _ in 0..50 {
            let ends: [[f64; 2]; 3] = std::array::from_fn(|_| {
                let (a, b) = (next(), next());
                [a.min(b), a.max(b)]
            });
            let (low, high) = (ends.map(|ends| ends[0]), ends.map(|ends| ends[1]));
            let (from, to, slices) = (low[2].max(-1.0), high[2].min(1.0), 4000);
            let width = (to - from).max(0.0) / f64::from(slices);
            let area = |slice: i32| {
                let height = from + width * (f64::from(slice) + 0.5);
                disc_in_box((1.0 - height * height).max(0.0).sqrt(), [low[0], low[1]], [high[0], high[1]])
            };
            let sum: f64 = (0..slices).map(area).sum::<f64>() * width;
            let exact = sphere_in_box(1.0, low, high);
            assert!((sum - exact).abs() < 2e-5, "{low:?} {high:?}: {exact} for {sum}");
        }
    }
}
