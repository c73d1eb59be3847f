//! Comparison of our results with the published results of seven codes on ten beds.

use grainbench_harness::prelude::*;
use grainbench_reference::round_robin::{IMPACT, Spread};

/// Number of published beds.
pub(super) const PUBLISHED: usize = 10;

/// Rows of time (s), mean height of the ball, and standard deviations of this height between codes and beds (mm).
pub(super) static BEDS: std::sync::LazyLock<Vec<[f64; 4]>> = std::sync::LazyLock::new(|| {
    let mut table = csv::Reader::from_reader(IMPACT.as_bytes());
    let number = |row: &csv::StringRecord, place: usize| row.get(place)?.parse().ok();
    let row = |row: csv::StringRecord| Some([number(&row, 0)?, number(&row, 1)?, number(&row, 2)?, number(&row, 3)?]);
    table.records().flatten().filter_map(row).collect()
});

/// Returns time (ms) and difference between the mean height on our beds and that of the codes, in standard deviations.
/// Times at which codes or beds differ by at most 0.01 mm (standard deviation) are left out.
pub(super) fn scores(done: &[FinishedRun], published: &[[f64; 4]]) -> Result<Vec<(f64, f64)>, MissingData> {
    let last = done.first().and_then(|done| done.series().time.last().copied()).unwrap_or(0.0);
    let is_counted = |row: &&[f64; 4]| row[0] <= last + 1e-9 && row[2] > 0.01 && row[3] > 0.01;
    let score = |&[time, mean, code, bed]: &[f64; 4]| {
        let own: Vec<f64> = done.iter().map(|done| super::height(done, time)).collect::<Result<_, _>>()?;
        let spread = Spread { mean, code, bed };
        let off = own.iter().sum::<f64>() / own.len() as f64 - mean;
        Ok((time * 1e3, off / spread.deviation(own.len(), PUBLISHED)))
    };
    published.iter().filter(is_counted).map(score).collect()
}

pub(super) fn figures(done: &[FinishedRun], published: &[[f64; 4]]) -> Vec<Figure> {
    let last = done.first().and_then(|done| done.series().time.last().copied()).unwrap_or(0.0);
    let within: Vec<&[f64; 4]> = published.iter().filter(|row| row[0] <= last + 1e-9).collect();
    let band = within.iter().flat_map(|[time, mean, code, bed]| {
        let half = 2.0 * code.hypot(bed * (1.0 + 1.0 / PUBLISHED as f64).sqrt());
        [(time * 1e3, mean - half), (time * 1e3, mean + half)]
    });
    let mut curves = vec![Curve::new("2 standard deviations of one bed of another code", Stroke::Bars, band.collect())];
    curves.push(Curve::new(
        "mean of seven codes",
        Stroke::Dashed,
        within.iter().map(|[time, mean, ..]| (time * 1e3, *mean)).collect(),
    ));
    for (number, run) in done.iter().enumerate() {
        curves.push(Curve::new(format!("own bed {}", number + 1), Stroke::Line, super::course(run)));
    }
    let scores = scores(done, published).unwrap_or_default();
    let ends = [scores.first().map_or(0.0, |first| first.0), scores.last().map_or(1.0, |last| last.0)];
    let bound =
        |at: f64| Curve::new(format!("{at:+}").replace('-', "−"), Stroke::Dashed, ends.map(|end| (end, at)).to_vec());
    vec![
        Figure::graph(
            "heights",
            "Height of the ball",
            "Height of the ball's centre on our five beds, compared with the mean of seven codes on ten beds (Dosta \
             et al. 2024, derived). Grey bars are two standard deviations of a single bed of another code.",
            [Axis::linear("time (ms)"), Axis::linear("height (mm)")],
            curves,
        ),
        Figure::graph(
            "score",
            "Deviation of our height from the mean of seven codes",
            "Difference of the mean height on our five beds from the mean of seven codes, in standard deviations \
             √(s_code² + s_bed² (1/5 + 1/10)). The dashed lines are two standard deviations.",
            [Axis::linear("time (ms)"), Axis::linear("difference (standard deviations)")],
            vec![Curve::new("dem:liggghts", Stroke::MarkedLine, scores), bound(2.0), bound(-2.0)],
        ),
    ]
}
