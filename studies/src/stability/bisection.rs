//! Bisection for the largest time step that passes, to a given precision.

/// Limit between time steps that pass and time steps that fail.
#[derive(Clone, Debug, PartialEq)]
pub struct Bracket<F> {
    /// Largest time step that passed.
    pub stable: f64,
    /// Smallest time step that failed, and its failure; `None` if no step failed.
    pub unstable: Option<(f64, F)>,
}

/// Bisects the range between a time step that passes and one that fails on a logarithmic scale, until they differ by a
/// relative `precision`.
///
/// If the upper end of the range passes, it is doubled up to `doublings` times.
///
/// # Errors
/// The failure at the lower end of the range.
pub fn largest<F>(
    [low, high]: [f64; 2],
    precision: f64,
    doublings: u32,
    mut test: impl FnMut(f64) -> Result<(), F>,
) -> Result<Bracket<F>, F> {
    test(low)?;
    let (mut stable, mut above) = (low, high);
    let mut failure = None;
    for _ in 0..=doublings {
        match test(above) {
            Err(how) => {
                failure = Some((above, how));
                break;
            }
            Ok(()) => (stable, above) = (above, 2.0 * above),
        }
    }
    let Some(mut unstable) = failure else { return Ok(Bracket { stable, unstable: None }) };
    while unstable.0 > stable * (1.0 + precision) {
        let middle = (stable * unstable.0).sqrt();
        match test(middle) {
            Ok(()) => stable = middle,
            Err(how) => unstable = (middle, how),
        }
    }
    Ok(Bracket { stable, unstable: Some(unstable) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_a_threshold_and_says_how_it_fails() {
        let mut tried = 0;
        let found = largest([0.1, 3.0], 1e-3, 0, |step| {
            tried += 1;
            if step <= 2.0_f64.sqrt() { Ok(()) } else { Err("too large") }
        });
        let found = found.unwrap();
        assert!((found.stable / 2.0_f64.sqrt() - 1.0).abs() < 1e-3 && tried < 20, "{found:?}");
        assert_eq!(found.unstable.unwrap().1, "too large");
    }

    #[test]
    fn what_always_passes_or_never_does_is_said() {
        let always = largest([1.0, 2.0], 0.01, 3, |_| Ok::<(), ()>(())).unwrap();
        assert_eq!(always, Bracket { stable: 16.0, unstable: None });
        assert_eq!(largest([1.0, 2.0], 0.01, 3, |_| Err("no")), Err("no"));
    }
}
