//! Basis functions of the grid, one axis at a time: products of these are the functions in two and three dimensions.
//!
//! Lengths are in cells, so that node i stands at i.

/// Values of the functions that reach a point, along one axis.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Axis {
    /// The first node.
    pub(crate) base: i32,
    /// Value at the point; for GIMP, mean over the point's extent.
    pub(crate) value: [f64; 3],
    /// Derivative (per cell), or its mean.
    pub(crate) slope: [f64; 3],
    /// What a velocity field is multiplied by to get its affine part (per cell): w (i − x)/D with D = Σ w (i − x)²
    /// (Jiang, Schroeder & Teran 2017). Linear in the field, exact for affine ones.
    pub(crate) affine: [f64; 3],
    /// D = Σ w (i − x)² (cells²).
    pub(crate) spread: f64,
}

/// The whole number below, and what is left; without the call that rounding takes on old processors.
#[inline(always)]
fn floor(at: f64) -> (i32, f64) {
    let towards_zero = at as i32;
    let base = towards_zero - i32::from(at < f64::from(towards_zero));
    (base, at - f64::from(base))
}

/// A family of functions.
pub(crate) trait Basis: Copy + Send + 'static {
    /// Nodes along an axis that reach a point.
    const WIDTH: usize;
    /// Whether the extent of a point matters.
    const EXTENDED: bool = false;
    /// The functions at `at` for a point that reaches `half` to both sides.
    fn axis(at: f64, half: f64) -> Axis;
}

/// Hat functions.
#[derive(Clone, Copy)]
pub(crate) struct Linear;

impl Basis for Linear {
    const WIDTH: usize = 2;

    #[inline(always)]
    fn axis(at: f64, _half: f64) -> Axis {
        let (base, s) = floor(at);
        let slope = [-1.0, 1.0, 0.0];
        Axis { base, value: [1.0 - s, s, 0.0], slope, affine: slope, spread: s * (1.0 - s) }
    }
}

/// Quadratic B-splines.
#[derive(Clone, Copy)]
pub(crate) struct Quadratic;

impl Basis for Quadratic {
    const WIDTH: usize = 3;

    #[inline(always)]
    fn axis(at: f64, _half: f64) -> Axis {
        let (base, rest) = floor(at - 0.5);
        let s = rest + 0.5;
        let value = [0.5 * (1.5 - s) * (1.5 - s), 0.75 - (s - 1.0) * (s - 1.0), 0.5 * (s - 0.5) * (s - 0.5)];
        // D = 1/4 wherever the point is.
        let affine = [-4.0 * value[0] * s, 4.0 * value[1] * (1.0 - s), 4.0 * value[2] * (2.0 - s)];
        Axis { base, value, slope: [s - 1.5, 2.0 - 2.0 * s, s - 0.5], affine, spread: 0.25 }
    }
}

/// Hat functions averaged over the extent of a point (Bardenhagen & Kober 2004; Wallstedt & Guilkey 2008).
#[derive(Clone, Copy)]
pub(crate) struct Gimp;

impl Basis for Gimp {
    const WIDTH: usize = 3;
    const EXTENDED: bool = true;

    #[inline(always)]
    fn axis(at: f64, half: f64) -> Axis {
        let (base, rest) = floor(at - 0.5);
        let s = rest + 0.5;
        let mut axis = Axis { base, ..Axis::default() };
        for node in 0..3 {
            let away = s - node as f64;
            let (distance, sign) = (away.abs(), -away.signum());
            let (value, slope) = if distance < half {
                (1.0 - (distance * distance + half * half) / (2.0 * half), distance / half)
            } else if distance < 1.0 - half {
                (1.0 - distance, 1.0)
            } else if distance < 1.0 + half {
                let reach = 1.0 + half - distance;
                (reach * reach / (4.0 * half), reach / (2.0 * half))
            } else {
                (0.0, 0.0)
            };
            axis.value[node] = value;
            axis.slope[node] = sign * slope;
            axis.affine[node] = -value * away;
            axis.spread += value * away * away;
        }
        let spread = axis.spread;
        axis.affine.iter_mut().for_each(|affine| *affine /= spread);
        axis
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every family reproduces affine fields: Σw = 1, Σw i = x, Σ∇w = 0, Σ∇w i = 1, and the affine part is exact.
    fn is_consistent<B: Basis>() {
        for step in 0..1000 {
            let at = -1.3 + 0.0037 * f64::from(step);
            let axis = B::axis(at, 0.21);
            let sum = |weights: [f64; 3], power: i32| -> f64 {
                (0..B::WIDTH).map(|node| weights[node] * f64::from(axis.base + node as i32).powi(power)).sum()
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
