//! Rounds a state that a run left, as `grainbench simulate --state FILE --rounded` leaves it: for a run of hours that was asked
//! for the exact one.
//!
//! ```text
//! cargo run --release --example round_state exact.state rounded.state [without-springs]
//! ```
//!
//! Without springs it is what a scene with `springs = false` takes of it, in half the room again.

use grainbench::reports::write_file;
use grainbench::scene::end_state::{EndState, Springs};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (exact, rounded, bare) = match &arguments[..] {
        [exact, rounded] => (exact, rounded, false),
        [exact, rounded, word] if word == "without-springs" => (exact, rounded, true),
        _ => return Err("expected the state to round, and where the rounded one is to be left".into()),
    };
    let mut state = EndState::from_bytes(&std::fs::read(exact)?)?;
    if bare {
        state.springs = Springs::default();
    }
    let bytes = state.to_rounded_bytes()?;
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
