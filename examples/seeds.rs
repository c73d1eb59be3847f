//! Computes the results of a case for other random seeds and prints them as the case's table `packings.csv`. The spread
//! in this table sets tolerances of the case. The table has a column for each claim whose first run uses `dem` and has
//! a `reading`. If a claim has several runs, the first run is used for all of them.
//!
//! ```text
//! cargo run --release --example seeds plane-shear-pressure grains.disc.packed.seed 11 12 13 14 15 16 \
//!     > cases/plane-shear-pressure/packings.csv
//! ```
//!
//! Do not include the seed of the case's own scene.

use grainbench::cases::registry::{by_name, read_grains};
use grainbench::cases::solvers::by_name as solver;
use grainbench::harness::claim::Claim;
use grainbench::harness::reading;
use grainbench::harness::run::{FinishedRun, Run};
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::error::Error;
use std::sync::Arc;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [name, key, seeds @ ..] = &arguments[..] else {
        return Err("expected the name of a case, the key of its seed, and seeds".into());
    };
    let case = by_name(name).ok_or("there is no such case")?;
    let own = |claim: &Claim| claim.runs[0].solver == "dem" && claim.runs[0].reading.is_some();
    let claims: Vec<Claim> = (case.claims)().into_iter().filter(own).collect();
    let mut table = csv::Writer::from_writer(std::io::stdout());
    table.write_record(std::iter::once("seed").chain(claims.iter().map(|claim| claim.quantity.as_str())))?;
    for seed in seeds {
        let mut done: BTreeMap<String, FinishedRun> = BTreeMap::new();
        let mut row = vec![seed.clone()];
        for claim in &claims {
            let run = &claim.runs[0];
            if let Entry::Vacant(place) = done.entry(run.key()) {
                place.insert(of_seed(case, run, key, seed)?);
            }
            let all: Vec<FinishedRun> = claim.runs.iter().filter_map(|_| done.get(&run.key())).cloned().collect();
            let value = (claim.measure)(&all).map_err(|missing| missing.to_string())?.value;
            row.push(format!("{value:.6}"));
        }
        table.write_record(row)?;
        table.flush()?;
    }
    Ok(())
}

/// Repeats a run of the case with another random seed.
fn of_seed(case: &grainbench::cases::Case, run: &Run, key: &str, seed: &str) -> Result<FinishedRun, Box<dyn Error>> {
    let source = case.source().variant(run.variant).set(key, seed);
    let mut scene = source.scene(&read_grains)?;
    if let Some((_, change)) = &run.adjustment {
        change(&mut scene);
    }
    let solver = solver(run.solver).ok_or("there is no such solver")?;
    let (record, tables) = reading::run(&*solver, &scene, &run.resolution, 1, run.reading)?;
    Ok(FinishedRun { tables: Arc::new(tables), ..FinishedRun::new(Arc::new(scene), Arc::new(record)) })
}
