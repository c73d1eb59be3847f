//! `grainbench effects`: what each effect is worth.

use super::cost::Follower;
use super::exit::{Fault, Outcome, RED, check_writable, print};
use super::provenance::provenance;
use super::subject::Variant;
use grainbench::cases::registry::CASES;
use grainbench::cases::solvers::Registry;
use grainbench::harness::study::ledger::Worth;
use grainbench::reports::study::{Study, study_json, write_study};
use grainbench::studies::effects::ledger::{Ledger, Piece};
use grainbench::studies::result_cache::ResultCache;
use grainbench::studies::{Follow, identity};
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;
use std::time::Instant;

/// What the command takes.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Cases to look at; all when none is named.
    #[arg(value_name = "CASE|CASE/VARIANT")]
    cases: Vec<String>,
    /// Do everything anew, also what was finished before.
    #[arg(long)]
    fresh: bool,
    /// Directory for the report; finished pieces are kept in it too.
    #[arg(long, value_name = "DIR", default_value = "grainbench-effects")]
    out: PathBuf,
    /// Print the results as JSON instead of lines.
    #[arg(long)]
    json: bool,
}

/// Makes the ledger and writes the report, after every case as far as it is.
pub(crate) fn effects(arguments: &Arguments) -> Outcome {
    let mut ledgers = ledgers(&arguments.cases)?;
    check_writable(&arguments.out)?;
    let cache = ResultCache::open(&arguments.out.join("pieces"), arguments.fresh).map_err(Fault::writing)?;
    let program = identity::of_this_program();
    let start = Instant::now();
    let pieces: usize = ledgers.iter().map(|(_, pieces)| pieces.len()).sum();
    let mut follower = Follower::new(pieces as u64, "effects");
    let mut words = vec!["effects".to_owned()];
    words.extend(arguments.cases.iter().cloned());
    let mut study = Study::new(provenance(words.clone(), 0.0));
    let count = ledgers.len();
    for (at, (ledger, pieces)) in ledgers.iter_mut().enumerate() {
        for piece in pieces.iter() {
            follower.now(&format!("{} · {}", piece.variant, piece.effect.word()));
            let (entry, reused) = ledger.entry(&program, piece, &cache).map_err(Fault::writing)?;
            study.ledger.extend(entry);
            follower.done(reused);
        }
        let mut options = words.clone();
        if at + 1 < count {
            options.push(format!("unfinished: {} of {count} cases", at + 1));
        }
        study.provenance = provenance(options, start.elapsed().as_secs_f64());
        write_study(&arguments.out, &study).map_err(Fault::writing)?;
    }
    let reused = follower.end();
    if arguments.json {
        print(&study_json(&study).map_err(Fault::input)?)?;
    } else {
        let mut text = String::new();
        for entry in &study.ledger {
            let key = if entry.on { entry.key.clone() } else { entry.tried.join(", ") };
            let scene = format!("{}/{}", entry.case, entry.variant);
            text.push_str(&format!("{scene:<32} {}: {} ({key})\n", entry.effect, entry.worth.word()));
        }
        print(&format!(
            "{text}{reused} of {pieces} pieces were done before\n{}\n",
            arguments.out.join("index.html").display()
        ))?;
    }
    let red = study.ledger.iter().any(|entry| entry.worth == Worth::NotInert);
    Ok(if red { ExitCode::from(RED) } else { ExitCode::SUCCESS })
}

/// The ledgers of the cases named, with their pieces.
fn ledgers(names: &[String]) -> Result<Vec<(Ledger, Vec<Piece>)>, Fault> {
    let named = names.iter().map(|name| Variant::read(name)).collect::<Result<Vec<_>, _>>()?;
    let mut found = Vec::new();
    for case in CASES {
        let mine: Vec<_> = named.iter().filter(|named| named.case.name == case.name).collect();
        if mine.is_empty() && !named.is_empty() {
            continue;
        }
        let wanted = |variant: &str| {
            mine.is_empty() || mine.iter().any(|named| named.variant.is_none_or(|name| name == variant))
        };
        let ledger = Ledger::new(case, Arc::new(Registry));
        let pieces = ledger.pieces().into_iter().filter(|piece| wanted(piece.variant)).collect();
        found.push((ledger, pieces));
    }
    Ok(found)
}
