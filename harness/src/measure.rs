//! What several cases measure in the same way.

/// Slope of log|y| over log x by least squares: an order of accuracy, an exponent.
#[must_use]
pub fn slope(points: &[(f64, f64)]) -> f64 {
    let logs: Vec<(f64, f64)> = points.iter().map(|(x, y)| (x.ln(), y.abs().ln())).collect();
    let count = logs.len() as f64;
    let mean_x = logs.iter().map(|(x, _)| x).sum::<f64>() / count;
    let mean_y = logs.iter().map(|(_, y)| y).sum::<f64>() / count;
    let above: f64 = logs.iter().map(|(x, y)| (x - mean_x) * (y - mean_y)).sum();
    let below: f64 = logs.iter().map(|(x, _)| (x - mean_x).powi(2)).sum();
    above / below
}

/// The strongest frequency of a signal (rad/s), by the peak of its windowed spectrum between two bounds; none of a signal
/// that is not a number somewhere.
#[must_use]
pub fn dominant_frequency(time: &[f64], values: &[f64], low: f64, high: f64) -> f64 {
    const SAMPLES: usize = 4000;
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let (start, span) = (time[0], time[time.len() - 1] - time[0]);
    let power = |omega: f64| {
        let (mut cosine, mut sine) = (0.0, 0.0);
        for (t, value) in time.iter().zip(values) {
            // A Hann window keeps the other mode from leaking into the peak.
            let window = 0.5 - 0.5 * (std::f64::consts::TAU * (t - start) / span).cos();
            cosine += window * (value - mean) * (omega * t).cos();
            sine += window * (value - mean) * (omega * t).sin();
        }
        cosine * cosine + sine * sine
    };
    let omega = |at: usize| low + (high - low) * at as f64 / SAMPLES as f64;
    let best = (0..=SAMPLES).map(omega).map(|omega| (power(omega), omega)).max_by(|a, b| a.0.total_cmp(&b.0));
    best.filter(|(power, _)| power.is_finite()).map_or(f64::NAN, |(_, omega)| omega)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_an_exponent_and_a_frequency() {
        let points: Vec<(f64, f64)> = [0.1, 0.05, 0.025].iter().map(|&x: &f64| (x, -3.0 * x.powf(1.7))).collect();
        assert!((slope(&points) - 1.7).abs() < 1e-12);
        let time: Vec<f64> = (0..2000).map(|step| 0.01 * f64::from(step)).collect();
        let values: Vec<f64> = time.iter().map(|t| 5.0 + (7.3 * t).sin() + 0.3 * (11.0 * t).cos()).collect();
        assert!((dominant_frequency(&time, &values, 2.0, 20.0) - 7.3).abs() < 0.01);
        let mut broken = values;
        broken[7] = f64::NAN;
        assert!(dominant_frequency(&time, &broken, 2.0, 20.0).is_nan(), "it has no frequency");
        assert!(slope(&[(0.1, 1.0), (0.05, f64::NAN)]).is_nan());
    }
}
