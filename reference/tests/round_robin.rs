//! Test of the script that derives the numbers of the round robin.

use std::path::Path;
use std::process::Command;

/// The Python test applies the script to synthetic tables. Changed tables are negative controls.
#[test]
fn the_script_derives_numbers_of_synthetic_tables() {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("literature/dosta-2024/derive_test.py");
    match Command::new("python3").arg("-B").arg(script).output() {
        Ok(output) => assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr)),
        Err(error) => assert!(std::env::var_os("CI").is_none(), "python3: {error}"),
    }
}
