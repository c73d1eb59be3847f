//! Rounds a state file in the same way as `grainbench simulate --state FILE --rounded`, without repeating the run.
//!
//! ```text
//! cargo run --release --example round_state exact.state rounded.state [without-springs|at-rest]
//! ```
//!
//! `without-springs` removes the contact history, which a scene with `springs = false` does not read. The file is then
//! about half as large. `at-rest` also removes velocities and spins, and rounds positions more coarsely. The file is
//! then about a third as large as with `without-springs`.

use grainbench::scene::end_state::{EndState, Springs};
use grainbench::store::write_file;
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
