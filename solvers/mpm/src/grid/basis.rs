//! Basis functions of the grid along one axis. Functions in two and three dimensions are products of these functions.
//!
//! Lengths are in units of the cell length, so the position of node i is i.

use grainbench_lanes::Number;

/// Evaluates a call with the type of the selected basis functions.
macro_rules! with_basis {
    ($basis:expr, $B:ident => $call:expr) => {
        match $basis {
            $crate::options::Basis::Linear => {
                type $B = $crate::grid::basis::Linear;
                $call
            }
            $crate::options::Basis::Quadratic => {
                type $B = $crate::grid::basis::Quadratic;
                $call
            }
            $crate::options::Basis::Gimp => {
                type $B = $crate::grid::basis::Gimp;
                $call
            }
        }
    };
}

pub(crate) use with_basis;

/// Values of the basis functions at a point, or at four points, along one axis.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Axis<N> {
    /// Value at the point; for GIMP, mean over the point's extent.
    pub(crate) value: [N; 3],
    /// Derivative at the point (per cell); for GIMP, mean over the point's extent.
    pub(crate) slope: [N; 3],
    /// Weights for the affine part of a velocity field (per cell): w (i − x)/D with D = Σ w (i − x)² (Jiang, Schroeder
    /// & Teran 2017). The affine part is linear in the field and exact for affine fields.
    pub(crate) affine: [N; 3],
    /// D = Σ w (i − x)² (cells²).
    pub(crate) spread: N,
}

/// Rounds down to a whole number, without the library call that `floor` needs on old processors.
#[inline(always)]
fn floor(at: f64) -> i32 {
    let towards_zero = at as i32;
    towards_zero - i32::from(at < f64::from(towards_zero))
}

/// A family of basis functions.
pub(crate) trait Basis: Copy + Send + 'static {
    /// Number of nodes along an axis that influence a point.
    const WIDTH: usize;
    /// True if the functions depend on the extent of the point.
    const EXTENDED: bool = false;
    /// Smallest distance from the first node to the point (cells). The largest distance is greater by one cell.
    const START: f64;
    /// Returns the first node that influences the position `at`.
    #[inline(always)]
    fn first(at: f64) -> i32 {
        floor(at - Self::START)
    }
    /// Computes the functions for a point at a distance `at` from its first node, with half extent `half` (cells).
    fn axis<N: Number>(at: N, half: N) -> Axis<N>;
}

/// Hat functions.
#[derive(Clone, Copy)]
pub(crate) struct Linear;

impl Basis for Linear {
    const WIDTH: usize = 2;
    const START: f64 = 0.0;

    #[inline(always)]
    fn axis<N: Number>(at: N, _half: N) -> Axis<N> {
        let before = at.like(1.0) - at;
        let slope = [at.like(-1.0), at.like(1.0), at.like(0.0)];
        Axis { value: [before, at, at.like(0.0)], slope, affine: slope, spread: at * before }
    }
}

/// Quadratic B-splines.
#[derive(Clone, Copy)]
pub(crate) struct Quadratic;

impl Basis for Quadratic {
    const WIDTH: usize = 3;
    const START: f64 = 0.5;

    #[inline(always)]
    fn axis<N: Number>(at: N, _half: N) -> Axis<N> {
        let [before, middle, after] = [at - 1.5, at - 1.0, at - 0.5];
        let value = [before * before * 0.5, at.like(0.75) - middle * middle, after * after * 0.5];
        // D = 1/4 at every position.
        let affine = [value[0] * at * -4.0, value[1] * middle * -4.0, value[2] * (at - 2.0) * -4.0];
        Axis { value, slope: [before, middle * -2.0, after], affine, spread: at.like(0.25) }
    }
}

/// Hat functions averaged over the extent of a point (Bardenhagen & Kober 2004; Wallstedt & Guilkey 2008).
#[derive(Clone, Copy)]
pub(crate) struct Gimp;

impl Basis for Gimp {
    const WIDTH: usize = 3;
    const START: f64 = 0.5;
    const EXTENDED: bool = true;

    #[inline(always)]
    fn axis<N: Number>(at: N, half: N) -> Axis<N> {
        let [zero, one] = [at.like(0.0), at.like(1.0)];
        let [mut value, mut slope, mut affine] = [[zero; 3]; 3];
        let mut spread = zero;
        for node in 0..3 {
            let away = at - node as f64;
            let sign = away.pick_below(zero, one, -one);
            let distance = away * -sign;
            let reach = half + 1.0 - distance;
            let on = one - (distance * distance + half * half) / (half * 2.0);
            let beyond = distance.pick_below(half + 1.0, reach * reach / (half * 4.0), zero);
            value[node] = distance.pick_below(half, on, distance.pick_below(one - half, one - distance, beyond));
            let beyond = distance.pick_below(half + 1.0, reach / (half * 2.0), zero);
            slope[node] =
                sign * distance.pick_below(half, distance / half, distance.pick_below(one - half, one, beyond));
            affine[node] = value[node] * -away;
            spread = spread + value[node] * away * away;
        }
        Axis { value, slope, affine: [affine[0] / spread, affine[1] / spread, affine[2] / spread], spread }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks that the functions reproduce affine fields: Σw = 1, Σw i = x, Σ∇w = 0, Σ∇w i = 1, and the affine part is
    /// exact.
    fn is_consistent<B: Basis>() {
        for step in 0..1000 {
            let at = -1.3 + 0.0037 * f64::from(step);
            let first = B::first(at);
            let axis = B::axis(at - f64::from(first), 0.21);
            let sum = |weights: [f64; 3], power: i32| -> f64 {
                (0..B::WIDTH).map(|node| weights[node] * f64::from(first + node as i32).powi(power)).sum()
            };
            assert!((sum(axis.value, 0) - 1.0).abs() < 1e-14 && (sum(axis.value, 1) - at).abs() < 1e-14);
            assert!(sum(axis.slope, 0).abs() < 1e-14 && (sum(axis.slope, 1) - 1.0).abs() < 1e-13);
            assert!(sum(axis.affine, 0).abs() < 1e-13 && (sum(axis.affine, 1) - 1.0).abs() < 1e-13);
        }
    }

    #[test]
    fn families_are_consistent() {
        is_consistent::<Linear>();
        is_consistent::<Quadratic>();
        is_consistent::<Gimp>();
    }
}
