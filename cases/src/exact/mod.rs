//! Closed forms that several cases use. A closed form of one case is in the folder of the case.

pub(crate) mod dashpot;
pub(crate) mod manufactured;
pub(crate) mod one_grain;
pub(crate) mod turning;

/// Returns the ends of an interval after bisections. `is_below` returns true for a number below the wanted number.
pub(crate) fn bisection([mut low, mut high]: [f64; 2], steps: u32, is_below: impl Fn(f64) -> bool) -> [f64; 2] {
    for _ in 0..steps {
        let middle = 0.5 * (low + high);
        if is_below(middle) { low = middle } else { high = middle }
    }
    [low, high]
}
