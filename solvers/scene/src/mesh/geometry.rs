//! Nearest points of triangles, and intersections of lines with triangles.

use nalgebra::Vector3;

/// Part of a triangle: the interior, a side or a corner. Side i leads from corner i to the next corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Part {
    Face,
    Side(usize),
    Corner(usize),
}

/// Returns the point of a triangle nearest to a position, and the part of the triangle that contains this point. The
/// Voronoi region of the position determines the part (Ericson, *Real-Time Collision Detection*, 2005, section 5.1.5).
pub(super) fn nearest(place: Vector3<f64>, [a, b, c]: &[Vector3<f64>; 3]) -> (Vector3<f64>, Part) {
    let (ab, ac, from_a) = (b - a, c - a, place - a);
    let (d1, d2) = (ab.dot(&from_a), ac.dot(&from_a));
    if d1 <= 0.0 && d2 <= 0.0 {
        return (*a, Part::Corner(0));
    }
    let from_b = place - b;
    let (d3, d4) = (ab.dot(&from_b), ac.dot(&from_b));
    if d3 >= 0.0 && d4 <= d3 {
        return (*b, Part::Corner(1));
    }
    let from_c = place - c;
    let (d5, d6) = (ab.dot(&from_c), ac.dot(&from_c));
    if d6 >= 0.0 && d5 <= d6 {
        return (*c, Part::Corner(2));
    }
    let of_c = d1 * d4 - d3 * d2;
    if of_c <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return (a + ab * (d1 / (d1 - d3)), Part::Side(0));
    }
    let of_b = d5 * d2 - d1 * d6;
    if of_b <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return (a + ac * (d2 / (d2 - d6)), Part::Side(2));
    }
    let of_a = d3 * d6 - d5 * d4;
    if of_a <= 0.0 && d4 >= d3 && d5 >= d6 {
        return (b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6))), Part::Side(1));
    }
    let sum = of_a + of_b + of_c;
    (a + ab * (of_b / sum) + ac * (of_c / sum), Part::Face)
}

/// Returns true if a triangle intersects the line segment between two positions, end points excluded (Möller &
/// Trumbore, *J. Graphics Tools* **2**, 1997).
pub(super) fn lies_across(from: Vector3<f64>, to: Vector3<f64>, [a, b, c]: &[Vector3<f64>; 3]) -> bool {
    const ROUNDING: f64 = 1e-9;
    let (line, u, v) = (to - from, b - a, c - a);
    let across = line.cross(&v);
    let volume = u.dot(&across);
    if volume.abs() <= 1e-12 * line.norm() * u.norm() * v.norm() {
        return false;
    }
    let away = from - a;
    let first = away.dot(&across) / volume;
    let turned = away.cross(&u);
    let second = line.dot(&turned) / volume;
    let part = v.dot(&turned) / volume;
    first >= -ROUNDING
        && second >= -ROUNDING
        && first + second <= 1.0 + ROUNDING
        && part > ROUNDING
        && part < 1.0 - ROUNDING
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Compares the result with sampled points of the triangle: none of them is nearer to the position.
    #[test]
    fn the_nearest_point_is_nearest() {
        let triangle = [Vector3::new(0.1, 0.2, -0.3), Vector3::new(1.3, 0.1, 0.4), Vector3::new(0.4, 1.1, 0.2)];
        let [a, b, c] = triangle;
        let mut parts = [0; 3];
        for number in 0..500 {
            let odd = |times: f64| (f64::from(number) * times).fract() * 4.0 - 1.5;
            let place = Vector3::new(odd(0.754_877), odd(0.569_840), odd(0.328_117));
            let (found, part) = nearest(place, &triangle);
            let distance = (found - place).norm();
            for i in 0..=40 {
                for j in 0..=40 - i {
                    let point = a + (b - a) * (f64::from(i) / 40.0) + (c - a) * (f64::from(j) / 40.0);
                    assert!((point - place).norm() > distance - 1e-12);
                }
            }
            parts[match part {
                Part::Face => 0,
                Part::Side(_) => 1,
                Part::Corner(_) => 2,
            }] += 1;
        }
        assert!(parts.iter().all(|&count| count > 20), "{parts:?}");
    }
}
