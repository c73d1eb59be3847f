//! `grainbench compare`: two outputs against each other.

use super::check::rows;
use super::exit::{Fault, Outcome, check_writable, print};
use super::provenance::provenance;
use super::run::exit_code;
use super::simulate::positive;
use grainbench::harness::evidence::Evidence;
use grainbench::harness::expect::Measured;
use grainbench::harness::figure::{Axis, Curve, Drawing, Figure, Graph, Stroke};
use grainbench::harness::tolerance::Made;
use grainbench::harness::verdict::{self, Verdict};
use grainbench::reference::comparison::{Comparison, Difference, compare as differences};
use grainbench::reports::results::results_json;
use grainbench::reports::{Report, Section, number, write_report};
use std::path::{Path, PathBuf};
use std::time::Instant;

/// What the command takes.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The output that the other is compared with: a dump or a CSV table; plain, gzip or zstd.
    a: PathBuf,
    /// The other one, of the same kind.
    b: PathBuf,
    /// Largest difference that passes, as a part of the column's largest magnitude (of coordinates: largest change).
    #[arg(long, value_name = "FRACTION", default_value_t = 1e-6, value_parser = positive, allow_hyphen_values = true)]
    tolerance: f64,
    /// Everything that is not green is red.
    #[arg(long)]
    strict: bool,
    /// Directory for the report.
    #[arg(long, value_name = "DIR", default_value = "grainbench-out")]
    out: PathBuf,
    /// Print the results as JSON instead of a table.
    #[arg(long)]
    json: bool,
}

/// Compares and writes the report.
pub(crate) fn compare(arguments: &Arguments) -> Outcome {
    let start = Instant::now();
    let comparison = differences(&arguments.a, &arguments.b).map_err(Fault::input)?;
    check_writable(&arguments.out)?;
    let section = section(arguments, &comparison);
    let [a, b] = names(arguments);
    let words = vec!["compare".to_owned(), a, b];
    let report = Report { provenance: provenance(words, start.elapsed().as_secs_f64()), sections: vec![section] };
    write_report(&arguments.out, &report).map_err(Fault::input)?;
    if arguments.json {
        print(&results_json(&report).map_err(Fault::input)?)?;
    } else {
        let Comparison { compared, alone, .. } = comparison;
        let counts = format!("{compared} steps or rows compared, {alone} in one of them alone");
        print(&format!("{}{counts}\n{}\n", rows(&report), arguments.out.join("index.html").display()))?;
    }
    Ok(exit_code(&report, arguments.strict))
}

/// What the two outputs are called: as their files are, or with their folders where those are called alike.
fn names(arguments: &Arguments) -> [String; 2] {
    let paths: [&Path; 2] = [&arguments.a, &arguments.b];
    let short = paths.map(|path| path.file_name().unwrap_or_default().to_string_lossy().into_owned());
    if short[0] == short[1] { paths.map(|path| path.to_string_lossy().into_owned()) } else { short }
}

fn section(arguments: &Arguments, comparison: &Comparison) -> Section {
    let [a, b] = names(arguments);
    Section {
        name: "compare".to_owned(),
        title: format!("{b} against {a}"),
        claim: format!(
            "Both have the same values at the {} steps or rows that they share; {} are in one of them alone.",
            comparison.compared, comparison.alone
        ),
        derivation:
            "Rows are matched by id, coordinates are unscaled, and tolerances are widened by half a unit of the last \
                     printed place of each file."
                .to_owned(),
        weak: "Two outputs that agree may both be wrong; and grains in motion part, however right both are, once \
               differences of rounding have grown."
            .to_owned(),
        figures: figure(&comparison.differences).into_iter().collect(),
        verdicts: comparison.differences.iter().map(|of| row(of, arguments.tolerance, &a, &b)).collect(),
        controls: Vec::new(),
        runs: Vec::new(),
    }
}

fn row(of: &Difference, tolerance: f64, a: &str, b: &str) -> Verdict {
    let open = of.open / of.scale;
    let row = Verdict {
        solver: b.to_owned(),
        allowed: tolerance + open,
        tolerance: Made::Required,
        because: format!(
            "asked for {}, and {} for the printed digits of both",
            number::fraction(tolerance),
            number::fraction(open)
        ),
        evidence: Evidence::OtherCode,
        source: a.to_owned(),
        ..Verdict::open("compare", format!("column {}, worst", of.name), "1")
    };
    let first = of.course.iter().find(|(_, off)| off.is_nan() || off / of.scale > row.allowed);
    let row = row.judged(&Measured::new(of.second, of.first, of.scale));
    match first.filter(|_| row.outcome == verdict::Outcome::Fail) {
        Some((step, _)) => Verdict { detail: Some(format!("first outside at step or row {step}")), ..row },
        None => row,
    }
}

/// How the differences grow.
fn figure(differences: &[Difference]) -> Option<Figure> {
    const MOST: usize = 6;
    let mut curves = Vec::new();
    for of in differences {
        let points: Vec<(f64, f64)> = of
            .course
            .iter()
            .filter(|(_, off)| *off > 0.0 && off.is_finite())
            .map(|(step, off)| (*step, off / of.scale))
            .collect();
        if !points.is_empty() && curves.len() < MOST {
            curves.push(Curve { label: of.name.clone(), stroke: Stroke::Line, points });
        }
    }
    let axis = |label: &str, logarithmic| Axis { label: label.to_owned(), logarithmic };
    (!curves.is_empty()).then(|| Figure {
        name: "differences".to_owned(),
        title: "How the differences grow".to_owned(),
        caption: "The largest difference of each column at each step, in units of its scale.".to_owned(),
        drawing: Drawing::Graph(Graph { x: axis("step or row", false), y: axis("difference / scale", true), curves }),
    })
}
