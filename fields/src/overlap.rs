//! How much of a disc or a sphere lies in a box.

use std::f64::consts::FRAC_PI_2;

/// Area of a disc about the origin within the box from `low` to `high` (m²): exact.
#[must_use]
pub fn disc_in_box(radius: f64, low: [f64; 2], high: [f64; 2]) -> f64 {
    if radius <= 0.0 {
        return 0.0;
    }
    let corner = |x: f64, y: f64| below_left((x / radius).clamp(-1.0, 1.0), (y / radius).clamp(-1.0, 1.0));
    let unit = corner(high[0], high[1]) - corner(low[0], high[1]) - corner(high[0], low[1]) + corner(low[0], low[1]);
    (unit * radius * radius).max(0.0)
}

/// Area of the unit disc where both coordinates are below x and y: the integral over u < x of its height there.
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
    // Beside the chord at y > 0 the whole height of the disc is below it.
    whole(-1.0, x.min(-reach)) + middle + whole(reach, x.max(reach))
}

/// Volume of a sphere about the origin within a box (m³): its cross-sections, which are exact, summed by Gauss and
/// Legendre's rule between the heights at which the circle meets an edge or a corner of the box. Good to 1e-9 of the
/// sphere.
#[must_use]
pub fn sphere_in_box(radius: f64, low: [f64; 3], high: [f64; 3]) -> f64 {
    let (from, to) = (low[2].max(-radius), high[2].min(radius));
    if to <= from {
        return 0.0;
    }
    let mut breaks = vec![from, to];
    let sides = |axis: usize| [0.0, low[axis], high[axis]];
    for x in sides(0) {
        for y in sides(1) {
            let height = (radius * radius - x * x - y * y).max(0.0).sqrt();
            breaks.extend([-height, height].into_iter().filter(|height| (from..to).contains(height)));
        }
    }
    breaks.sort_by(f64::total_cmp);
    let section = |z: f64| {
        let radius = (radius * radius - z * z).max(0.0).sqrt();
        disc_in_box(radius, [low[0], low[1]], [high[0], high[1]])
    };
    breaks.windows(2).map(|ends| integral(section, ends[0], ends[1])).sum()
}

/// Of a function that may begin and end like a power of a root: in the angle of which the place is the sine, it is
/// smooth.
fn integral(function: impl Fn(f64) -> f64, from: f64, to: f64) -> f64 {
    // Ten points of Gauss and Legendre (Abramowitz and Stegun, table 25.4).
    const RULE: [(f64, f64); 5] = [
        (0.148_874_338_981_631_2, 0.295_524_224_714_752_9),
        (0.433_395_394_129_247_2, 0.269_266_719_309_996_4),
        (0.679_409_568_299_024_4, 0.219_086_362_515_982),
        (0.865_063_366_688_984_5, 0.149_451_349_150_580_6),
        (0.973_906_528_517_171_7, 0.066_671_344_308_688_1),
    ];
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let at = |part: f64| {
        let angle = FRAC_PI_2 * part;
        function(middle + half * angle.sin()) * half * angle.cos() * FRAC_PI_2
    };
    RULE.iter().map(|&(part, weight)| weight * (at(part) + at(-part))).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn a_disc_cut_by_a_box_has_the_area_of_geometry() {
        let far = 10.0;
        assert!((disc_in_box(2.0, [-far; 2], [far; 2]) / (4.0 * PI) - 1.0).abs() < 1e-14);
        assert!((disc_in_box(2.0, [0.0; 2], [far; 2]) / PI - 1.0).abs() < 1e-14);
        assert!((disc_in_box(2.0, [-0.1, 0.2], [0.3, 0.9]) - 0.4 * 0.7).abs() < 1e-14);
        // A segment of height R/2: R² (π/3 − √3/4).
        let segment = PI / 3.0 - 3_f64.sqrt() / 4.0;
        assert!((disc_in_box(1.0, [0.5, -far], [far, far]) / segment - 1.0).abs() < 1e-14);
        // A corner at (½, ½): ∫ (√(1−u²) − ½) du from ½ to √¾.
        let corner = PI / 12.0 + 0.25 - 0.5 * 0.75_f64.sqrt();
        assert!((disc_in_box(1.0, [0.5, 0.5], [far, far]) / corner - 1.0).abs() < 1e-13);
        assert_eq!(disc_in_box(1.0, [1.5, 0.0], [2.0, 1.0]), 0.0);
        assert_eq!(disc_in_box(0.0, [-1.0; 2], [1.0; 2]), 0.0);
    }

    #[test]
    fn boxes_that_fill_space_share_a_sphere_out() {
        let (radius, step) = (1.3, 0.7);
        let volume = 4.0 / 3.0 * PI * radius * radius * radius;
        let mut sum = 0.0;
        for cell in 0..125 {
            let place = [cell % 5, cell / 5 % 5, cell / 25].map(|at| f64::from(at) * step - 1.71);
            sum += sphere_in_box(radius, place, place.map(|low| low + step));
        }
        assert!((sum / volume - 1.0).abs() < 1e-9, "{}", sum / volume - 1.0);
        // A cap of height R/2, an octant, and a cube inside.
        let cap = sphere_in_box(1.0, [-9.0, -9.0, 0.5], [9.0; 3]);
        assert!((cap / (PI * 0.25 / 3.0 * 2.5) - 1.0).abs() < 1e-9, "{cap}");
        let sideways = sphere_in_box(1.0, [0.5, -9.0, -9.0], [9.0; 3]);
        assert!((sideways / cap - 1.0).abs() < 1e-8, "{sideways}");
        assert!((sphere_in_box(1.0, [0.0; 3], [9.0; 3]) / (PI / 6.0) - 1.0).abs() < 1e-9);
        assert!((sphere_in_box(1.0, [-0.2; 3], [0.3; 3]) / 0.125 - 1.0).abs() < 1e-12);
    }
}
