//! `grainbench compare`: compares the outputs of two runs.

use super::exit::{Fault, Outcome, check_writable, refuse, refuse_inputs};
use super::provenance::provenance;
use super::publish::ReportArguments;
use super::value::{path_and_value, positive};
use grainbench::harness::compare::peers::WIDE;
use grainbench::harness::evidence::Evidence;
use grainbench::harness::expect::{Bound, ExpectedValue, Measurement};
use grainbench::harness::figure::{Axis, Curve, Figure, Stroke};
use grainbench::harness::tolerance::ToleranceOrigin;
use grainbench::harness::verdict::{self, Verdict};
use grainbench::reference::comparison::{self, Comparison, Difference, Key};
use grainbench::reference::observer::Names;
use grainbench::reports::{Report, Section, line, number};
use std::path::{Path, PathBuf};
use std::time::Instant;

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Reference output: grains in any format that `check` reads, or a CSV table. Plain or compressed by gzip or zstd.
    a: PathBuf,
    /// Second output, of the same kind.
    b: PathBuf,
    /// Largest accepted difference, as a fraction of the largest magnitude of the column (for coordinates: of the
    /// largest change).
    #[arg(long, value_name = "FRACTION", default_value_t = 1e-6, value_parser = positive, allow_hyphen_values = true)]
    tolerance: f64,
    /// Compare only these columns, named as in the first output.
    #[arg(long, value_name = "NAME,…", value_delimiter = ',')]
    columns: Vec<String>,
    /// Names in the second output of columns of the first, such as `x=xu,fx=f_x`.
    #[arg(long, value_name = "FIRST=SECOND,…", value_delimiter = ',', value_parser = path_and_value)]
    map: Vec<(String, String)>,
    /// Time step in seconds, for files without times. One number for both outputs, or one for each.
    #[arg(long, value_name = "SECONDS[,SECONDS]", value_delimiter = ',', value_parser = positive, allow_hyphen_values = true)]
    time_step: Vec<f64>,
    /// Report samples that exist in only one output as amber instead of red. Of a truncated file, the complete frames
    /// are compared.
    #[arg(long)]
    partial: bool,
    #[command(flatten)]
    report: ReportArguments,
}

/// Compares two outputs and writes the report.
pub(crate) fn compare(arguments: &Arguments) -> Outcome {
    let start = Instant::now();
    if arguments.time_step.len() > 2 {
        let found = arguments.time_step.len();
        refuse!("--time-step: expected one time step for both files or one for each, found {found}");
    }
    check_writable(&arguments.report.out)?;
    refuse_inputs(&arguments.report.out, [&arguments.a, &arguments.b])?;
    let options = comparison::Options {
        columns: arguments.columns.clone(),
        names: Names(arguments.map.clone()),
        time_steps: [arguments.time_step.first().copied(), arguments.time_step.last().copied()],
        partial: arguments.partial,
    };
    let comparison = comparison::compare(&arguments.a, &arguments.b, &options).map_err(Fault::reading)?;
    let section = section(arguments, &comparison);
    let [a, b] = names(arguments);
    let words = vec!["compare".to_owned(), a, b];
    let report = Report::new(provenance(words, start.elapsed().as_secs_f64()), vec![section]);
    let mut columns = report.sections.iter().flat_map(|section| section.verdicts.iter().skip(2));
    let is_label = |row: &Verdict| LABELS.iter().any(|label| row.quantity == quantity(label));
    let is_mute = !columns.any(|row| row.outcome.is_judged() && !is_label(row));
    let rows: Vec<_> = report.verdicts().collect();
    let text = format!("{}{}\n", line::results(&rows), counts(&comparison));
    arguments.report.publish(report, is_mute, Some(text))
}

/// Reason of the results about values that only one output has.
const ALONE: &str = "values in only one file are not compared";

/// Columns that identify or describe grains, not their motion. If only these columns agree, nothing counts as compared.
const LABELS: [&str; 8] = ["id", "type", "mol", "proc", "radius", "diameter", "mass", "density"];

/// Returns the name of the quantity of a column's result.
fn quantity(column: &str) -> String {
    format!("column {column}, worst")
}

/// Returns the names of the two outputs: the file names, or the paths if the file names are equal.
fn names(arguments: &Arguments) -> [String; 2] {
    let paths: [&Path; 2] = [&arguments.a, &arguments.b];
    let short = paths.map(|path| path.file_name().unwrap_or_default().to_string_lossy().into_owned());
    if short[0] == short[1] { paths.map(|path| path.to_string_lossy().into_owned()) } else { short }
}

fn section(arguments: &Arguments, comparison: &Comparison) -> Section {
    let [a, b] = names(arguments);
    let open = Verdict { solver: b.clone(), source: a.clone(), ..Verdict::open("compare", "", "1") };
    let rows =
        comparison.differences.iter().map(|difference| row(difference, comparison.key, arguments.tolerance, &open));
    Section {
        name: "compare".to_owned(),
        title: format!("{b} against {a}"),
        claim: format!("Claim: both outputs have the same values. {}.", counts(comparison)),
        derivation:
            "Rows are matched by id, and coordinates are unscaled. Each tolerance is widened by half a unit of the \
             last printed digit of each file. If the steps differ, the second file is interpolated linearly, and the \
             tolerance is widened by an eighth of its largest second difference."
                .to_owned(),
        weak: "Two outputs that agree may both be wrong. Two correct outputs of moving grains also differ as soon as \
               rounding differences have grown."
            .to_owned(),
        figures: figure(&comparison.differences, comparison.key).into_iter().collect(),
        verdicts: shared(comparison, arguments.partial, &open)
            .into_iter()
            .chain(rows)
            .chain(lonely(comparison, [&a, &b], &open))
            .collect(),
        ..Section::default()
    }
}

/// Returns the numbers of compared and of existing samples, in words.
fn counts(comparison: &Comparison) -> String {
    let Comparison { compared, interpolated, samples: [a, b], key, .. } = comparison;
    let between = if *interpolated > 0 { format!(", {interpolated} of them interpolated") } else { String::new() };
    let noun = if *key == Key::Row { "rows" } else { "samples" };
    format!("{compared} {noun} are compared by {}{between}, of {a} and {b}", key.word())
}

/// Returns two results about the coverage: the number of compared samples, and the time or step of the last compared sample.
fn shared(comparison: &Comparison, partial: bool, open: &Verdict) -> [Verdict; 2] {
    let unit = if comparison.key == Key::Time { "s" } else { "1" };
    let row = |quantity: String, unit: &str, value: f64, least: f64, slack: f64| {
        let scale = if least > 0.0 { least } else { 1.0 };
        let row = Verdict {
            quantity,
            unit: unit.to_owned(),
            allowed: slack / scale,
            because: ALONE.to_owned(),
            evidence: Evidence::Invariant,
            ..open.clone()
        };
        let row = row.judged(&Measurement::new(value, ExpectedValue::Bound(Bound::AtLeast(least)), scale));
        if row.outcome == verdict::Outcome::Fail && partial {
            return row.left(verdict::Outcome::Known, "missing samples are accepted because of --partial");
        }
        row
    };
    let fewest = comparison.samples[0].min(comparison.samples[1]) as f64;
    // The last compared sample may be earlier than the end of the longer output by less than one interval. If it is
    // earlier by a whole interval, a sample is missing.
    let (end, slack) = (comparison.last[0].max(comparison.last[1]), (1.0 - 1e-6) * comparison.interval);
    // If samples are matched by time, all samples of the first file must be compared.
    let least = if comparison.key == Key::Time { comparison.samples[0] as f64 } else { fewest };
    [
        cut(comparison, row("samples that were compared".to_owned(), "1", comparison.compared as f64, least, 0.0)),
        row(format!("last {} that was compared", comparison.key.word()), unit, comparison.last_compared, end, slack),
    ]
}

/// If a file is truncated, makes a passed result about the samples amber.
fn cut(comparison: &Comparison, row: Verdict) -> Verdict {
    match comparison.cuts.iter().flatten().next() {
        Some(cut) if row.outcome == verdict::Outcome::Pass => {
            row.left(verdict::Outcome::Known, format!("only the complete frames are compared (--partial): {cut}"))
        }
        _ => row,
    }
}

/// Returns one result for each column that exists in only one output.
fn lonely(comparison: &Comparison, files: [&str; 2], open: &Verdict) -> Vec<Verdict> {
    let names =
        comparison.lonely.iter().zip(files).flat_map(|(names, file)| names.iter().map(move |name| (name, file)));
    let row = |(name, file): (&String, &str)| {
        let row = Verdict { quantity: quantity(name), because: ALONE.to_owned(), ..open.clone() };
        row.left(verdict::Outcome::NoReference, format!("only {file} has this column"))
    };
    names.map(row).collect()
}

fn row(difference: &Difference, key: Key, tolerance: f64, row: &Verdict) -> Verdict {
    let open = difference.open / difference.scale;
    let row = Verdict {
        quantity: quantity(&difference.name),
        allowed: tolerance + open,
        tolerance: ToleranceOrigin::Required,
        because: format!(
            "required {}, plus {} for the printed digits of both files",
            number::fraction(tolerance),
            number::fraction(open)
        ),
        evidence: Evidence::OtherCode,
        ..row.clone()
    };
    let first = difference.course.iter().find(|sample| sample.beyond_digits / difference.scale > tolerance);
    let row = row.judged(&Measurement::new(difference.second, difference.first, difference.scale));
    match (row.outcome, first) {
        (verdict::Outcome::Fail, Some(sample)) => {
            Verdict { detail: Some(format!("first outside at {} {}", key.word(), sample.at)), ..row }
        }
        _ if open > tolerance => row.unless_wider_than(WIDE),
        _ => row,
    }
}

/// Plots the differences over time or step.
fn figure(differences: &[Difference], key: Key) -> Option<Figure> {
    const MOST: usize = 6;
    let curve = |difference: &Difference| {
        let samples = difference.course.iter().filter(|sample| sample.off > 0.0 && sample.off.is_finite());
        let points: Vec<(f64, f64)> = samples.map(|sample| (sample.at, sample.off / difference.scale)).collect();
        (!points.is_empty()).then(|| Curve::new(&difference.name, Stroke::Line, points))
    };
    let curves: Vec<Curve> = differences.iter().filter_map(curve).take(MOST).collect();
    (!curves.is_empty()).then(|| {
        Figure::graph(
            "differences",
            "Growth of the differences",
            "The largest difference of each column at each step, in units of its scale.",
            [Axis::linear(key.word()), Axis::log("difference / scale")],
            curves,
        )
    })
}
