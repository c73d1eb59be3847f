//! Computes the results of a silo case for deposits from other random seeds and prints them as the case's table
//! `packings.csv`. The spread in this table sets tolerances of the case.
//!
//! ```text
//! for seed in 1 2 3 4 5 6 7 8 9 10; do
//!     grainbench simulate cases/silo-tall/pour.toml --set grains.feed.poured.seed=$seed --solver dem --time-step 2e-4 \
//!         --write none --state states/$seed.state
//! done
//! cargo run --release --example silo_packings silo-tall states > cases/silo-tall/packings.csv
//! ```
//!
//! `silo-push` starts from the deposits of `silo-wide`.

use grainbench::cases::registry::{by_name, read_grains};
use grainbench::cases::solvers::by_name as solver;
use grainbench::harness::reading;
use grainbench::harness::run::{FinishedRun, Run};
use std::error::Error;
use std::path::{Path, PathBuf};
use std::sync::Arc;

fn main() -> Result<(), Box<dyn Error>> {
    let [case, folder] = &std::env::args().skip(1).collect::<Vec<_>>()[..] else {
        return Err("expected the name of a case and a folder with states".into());
    };
    let case = by_name(case).ok_or("there is no such case")?;
    let claims: Vec<_> = (case.claims)().into_iter().filter(|claim| claim.runs.len() == 1).collect();
    let run = claims.iter().map(|claim| &claim.runs[0]).find(|run| run.kept).ok_or("it keeps no run")?;
    let claims: Vec<_> = claims.iter().filter(|claim| claim.runs[0].key() == run.key()).collect();
    let mut states: Vec<PathBuf> =
        std::fs::read_dir(folder)?.map(|entry| Ok(entry?.path())).collect::<Result<_, std::io::Error>>()?;
    states.retain(|path| path.extension().is_some_and(|ending| ending == "state"));
    states.sort();
    let mut table = csv::Writer::from_writer(std::io::stdout());
    let names = claims.iter().map(|claim| claim.quantity.clone());
    table.write_record(std::iter::once("deposit".to_owned()).chain(names))?;
    for state in states {
        let done = done(case, run, &state)?;
        let mut row = vec![state.file_stem().unwrap_or_default().to_string_lossy().into_owned()];
        for claim in &claims {
            let value = (claim.measure)(std::slice::from_ref(&done)).map_err(|missing| missing.to_string())?.value;
            row.push(format!("{value:.6}"));
        }
        table.write_record(row)?;
        table.flush()?;
    }
    Ok(())
}

/// Repeats a run of the case with the deposit in the file `state`.
fn done(case: &grainbench::cases::Case, run: &Run, state: &Path) -> Result<FinishedRun, Box<dyn Error>> {
    let path = format!("{:?}", state.canonicalize()?);
    let source = case.source().variant(run.variant).set("grains.deposit.state.path", &path);
    let scene = source.scene(&read_grains)?;
    let solver = solver(run.solver).ok_or("there is no such solver")?;
    let (record, tables) = reading::run(&*solver, &scene, &run.resolution, 1, run.reading)?;
    Ok(FinishedRun { tables: Arc::new(tables), ..FinishedRun::new(Arc::new(scene), Arc::new(record)) })
}
