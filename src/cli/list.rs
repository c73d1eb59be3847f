//! `grainbench list`: lists the cases.

use super::exit::{Outcome, print_json, print_text};
use super::names;
use super::select;
use grainbench::cases::registry::CASES;
use grainbench::harness::case::Case;
use grainbench::reports::number;
use serde::Serialize;

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Cases whose claims are listed, as with `--rows`. Default: the cases themselves.
    #[arg(value_name = "CASE|CASE/VARIANT")]
    cases: Vec<String>,
    /// List the solver-independent claims with their controls instead of the cases.
    #[arg(long)]
    rows: bool,
    /// Print the list as JSON.
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Row {
    case: &'static str,
    variant: &'static str,
    quantity: String,
    unit: &'static str,
    /// Wrong physics of the negative control.
    control: &'static str,
    /// Solvers to which the claim applies: `any`, `continuum` or `springs`.
    solvers: &'static str,
}

#[derive(Serialize)]
struct Entry {
    name: &'static str,
    title: &'static str,
    claim: &'static str,
    variants: Vec<String>,
    gates: usize,
    default_level: &'static str,
    levels: Vec<String>,
    solvers: Vec<&'static str>,
}

pub(crate) fn list(arguments: &Arguments) -> Outcome {
    if arguments.rows || !arguments.cases.is_empty() {
        return list_rows(arguments);
    }
    let entries = CASES.iter().map(|case| entry(case)).collect::<Result<Vec<_>, _>>()?;
    if arguments.json { print_json(&entries) } else { print_text(&table(&entries)) }
}

/// Prints the claims by which `run --solver SOLVER.toml` judges an external solver.
fn list_rows(arguments: &Arguments) -> Outcome {
    let mut rows = Vec::new();
    for selected in select::select_fair(&arguments.cases, &[])? {
        for claim in &selected.claims {
            let variant = claim.runs.first().map_or("", |run| run.variant);
            let (quantity, control) = (claim.quantity.clone(), claim.control.name);
            let solvers = claim.scope.word();
            rows.push(Row { case: selected.case.name, variant, quantity, unit: claim.unit, control, solvers });
        }
    }
    if arguments.json {
        return print_json(&rows);
    }
    let line = |row: &Row| {
        let Row { case, variant, quantity, control, .. } = row;
        format!("{case}/{variant} · {quantity} [control: {control}]\n")
    };
    print_text(&rows.iter().map(line).collect::<String>())
}

fn entry(case: &Case) -> Result<Entry, super::exit::Fault> {
    let claims = (case.claims)();
    let levels = names::levels(case, &claims);
    Ok(Entry {
        name: case.name,
        title: case.title,
        claim: case.claim,
        variants: names::variants(case, &claims)?,
        gates: claims.len(),
        default_level: case.default_level.name,
        levels,
        solvers: names::solvers(&claims),
    })
}

fn table(entries: &[Entry]) -> String {
    let width = entries.iter().map(|entry| entry.name.chars().count()).max().unwrap_or(0);
    let mut text = String::new();
    for Entry { name, title, variants, gates, default_level, solvers, .. } in entries {
        let variants = variants.join(", ");
        let (claims, solvers) = (number::counted(*gates, "claim"), solvers.join(", "));
        text.push_str(&format!("{name:<width$}  {title}\n"));
        text.push_str(&format!("{:<width$}    variants  {variants}\n", ""));
        text.push_str(&format!("{:<width$}    {claims}, level {default_level}, solvers {solvers}\n", ""));
    }
    text
}
