//! Time series as CSV.

use std::io::{self, Write};

use grainbench_solver::record::Series;

/// Writes the columns `step,time (s),NAME (unit),…` with one line per sample. Each number is the shortest text that
/// reads back to the same bits.
///
/// # Errors
/// When `out` cannot be written.
pub fn write(series: &Series, out: impl Write) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    let columns = series.columns.iter().map(|column| harmless(format!("{} ({})", column.name, column.unit)));
    table.write_record(["step".into(), "time (s)".into()].into_iter().chain(columns))?;
    for (sample, (step, time)) in series.step.iter().zip(&series.time).enumerate() {
        let values = series
            .values
            .iter()
            // Cells after the end of a short column are empty.
            .map(|column| column.get(sample).map_or_else(String::new, |value| format!("{value:?}")));
        table.write_record([step.to_string(), format!("{time:?}")].into_iter().chain(values))?;
    }
    table.flush()
}

/// Returns a column heading that no spreadsheet interprets as a formula. Headings contain probe names from scene files.
pub(crate) fn harmless(head: String) -> String {
    if head.starts_with(['=', '+', '-', '@']) { format!("'{head}") } else { head }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::sample;

    #[test]
    fn keeps_every_digit() {
        let mut out = Vec::new();
        write(&sample::series(), &mut out).unwrap();
        assert_eq!(
            String::from_utf8(out).unwrap(),
            "step,time (s),disc.x (m),\"a,b (1)\"\n\
             0,0.0,1.0,-1e-300\n\
             5,0.30000000000000004,0.3333333333333333,2e20\n"
        );
    }
}
