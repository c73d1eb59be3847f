//! Rounds a state that a run left, as `grainbench simulate --state FILE --rounded` leaves it: for a run of hours that was asked
//! for the exact one.
//!
//! ```text
//! cargo run --release --example round_state exact.state rounded.state [without-springs|at-rest]
//! ```
//!
//! Without springs it is what a scene with `springs = false` takes of it, in half the room again. At rest it keeps places alone,
//! in a quarter of that.

use grainbench::reports::write_file;
use grainbench::scene::end_state::{EndState, Springs};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (exact, rounded, how) = match &arguments[..] {
        [exact, rounded] => (exact, rounded, ""),
        [exact, rounded, how] if ["without-springs", "at-rest"].contains(&how.as_str()) => {
            (exact, rounded, how.as_str())
        }
        _ => return Err("expected the state to round, and where the rounded one is to be left".into()),
    };
    let mut state = EndState::from_bytes(&std::fs::read(exact)?)?;
    if how == "without-springs" {
        state.springs = Springs::default();
    }
    let bytes = if how == "at-rest" { state.to_bytes_at_rest()? } else { state.to_rounded_bytes()? };
    write_file(rounded, &bytes)?;
    println!(
        "{}, by {}: {} grains at {} s, {} bytes",
        state.of[0],
        state.of[1],
        state.grains.len(),
        state.time,
        bytes.len()
    );
    Ok(())
}
