//! Bessel functions of integer order, for the linear chain.

/// Returns J_0 … J_{orders−1} at x > 0 by Miller's downward recurrence, J_{n−1} = (2n/x) J_n − J_{n+1}, normalised by
/// J_0 + 2 Σ J_{2k} = 1.
pub(crate) fn bessel(x: f64, orders: usize) -> Vec<f64> {
    // The recurrence starts at an order far above x and `orders`, so its arbitrary start value has no effect.
    let top = 2 * (orders.max(x.ceil() as usize) / 2) + 60;
    let mut values = vec![0.0; top + 2];
    values[top] = 1e-300;
    for n in (1..=top).rev() {
        values[n - 1] = 2.0 * n as f64 / x * values[n] - values[n + 1];
        if values[n - 1].abs() > 1e200 {
            values[n - 1..].iter_mut().for_each(|value| *value *= 1e-200);
        }
    }
    let sum = values[0] + 2.0 * values.iter().skip(2).step_by(2).sum::<f64>();
    values.truncate(orders);
    values.iter_mut().for_each(|value| *value /= sum);
    values
}

/// Returns v_n/V of the driven chain at x = 2ω₀t: J_{2n} + 2 Σ_{k≥1} J_{2n+2k}.
pub(crate) fn velocity(n: usize, x: f64) -> f64 {
    if x <= 0.0 {
        return 0.0;
    }
    let values = bessel(x, 2 * n.max(x.ceil() as usize) + 60);
    values[2 * n] + 2.0 * values[2 * n + 2..].iter().step_by(2).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Compares the functions with tabulated values, and the velocities of the chain with values from quadrature.
    #[test]
    fn agrees_with_tables() {
        let values = bessel(1.0, 3);
        for (value, table) in
            values.iter().zip([0.765_197_686_557_966_6, 0.440_050_585_744_933_5, 0.114_903_484_931_900_5])
        {
            assert!((value - table).abs() < 1e-15);
        }
        assert!((bessel(40.0, 1)[0] - 0.007_366_890_584_237_513).abs() < 1e-14);
        for (n, value) in [
            (5, 0.986_709_59),
            (10, 1.021_730_73),
            (15, 0.887_729_86),
            (18, 1.033_669_93),
            (20, 0.344_146_32),
            (22, 0.052_856_30),
        ] {
            assert!((velocity(n, 40.0) - value).abs() < 1e-8, "v{n}");
        }
    }
}
