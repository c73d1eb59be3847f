//! Rounds a state that a run left, as `grainbench simulate --state FILE --rounded` leaves it: for a run of hours that was asked
//! for the exact one.
//!
//! ```text
//! cargo run --release --example round_state exact.state rounded.state
//! ```

use grainbench::reports::write_file;
use grainbench::scene::end_state::EndState;
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let [exact, rounded] = &std::env::args().skip(1).collect::<Vec<_>>()[..] else {
        return Err("expected the state to round, and where the rounded one is to be left".into());
    };
    let state = EndState::from_bytes(&std::fs::read(exact)?)?;
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
