//! A process that is killed at a random time. Afterwards its directory is unchanged, complete with the new files, or
//! marked as mixed. The next run removes temporary files beside it. The default is ten kills, and `GRAINBENCH_LONG`
//! gives 120 kills. The unit tests of `store/src/staged.rs` interrupt each disk operation of a commit in turn.

use crate::common::{Directory, files, temporary, untimed};
use grainbench::store::refuse_mixed;
use proptest::strategy::{Strategy, ValueTree};
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

/// Scene of discs in a row with many snapshots, so that a run writes many files.
const SCENE: &str = include_str!("../scenes/rows-of-discs.toml");

/// Two runs that write different files. Each run is given by its command line.
struct Pair {
    runs: [&'static str; 2],
    /// Function that identifies the run that wrote a file, whatever times the file contains.
    kind: fn(&Path, &str) -> String,
}

/// Returns the length and a hash of a file of a simulation, without its run time.
fn simulated(directory: &Path, name: &str) -> String {
    let text = untimed(&directory.read(name));
    format!("{} bytes, {:?}", text.len(), text.bytes().fold(0_u64, |sum, byte| sum.wrapping_mul(31) + u64::from(byte)))
}

/// Returns the names of the cases that a file of a report contains.
fn reported(directory: &Path, name: &str) -> String {
    let text = directory.read(name);
    let mut cases = vec!["rolling-resistance", "oblique-impact"];
    cases.retain(|case| text.contains(case));
    let named = cases.join(" ");
    // Figures contain the name of their case only in their file name.
    if name.starts_with("figures") || named.is_empty() { name.to_owned() } else { named }
}

const SIMULATE: Pair = Pair {
    runs: ["simulate s.toml --solver dem --out out", "simulate s.toml --solver dem --variant shorter --out out"],
    kind: simulated,
};
const RUN: Pair = Pair { runs: ["run rolling-resistance --out out", "run oblique-impact --out out"], kind: reported };

/// Returns the files of a directory with the runs that wrote them. Hidden files and the manifest are left out.
fn standing(directory: &Path, kind: fn(&Path, &str) -> String) -> BTreeMap<String, String> {
    if !directory.exists() {
        return BTreeMap::new();
    }
    let names = files(directory).into_iter().filter(|name| !name.starts_with('.') && name != "manifest.json");
    names.map(|name| (name.clone(), kind(directory, &name))).collect()
}

/// Starts runs in the same directory one after another, and kills each at a random time.
fn kill(pair: &Pair, times: usize, seed: u64) {
    let directory = temporary();
    let (path, out) = (&directory, directory.join("out"));
    path.write("s.toml", SCENE);
    let (mut whole, mut longest) = (Vec::new(), Duration::ZERO);
    for arguments in pair.runs {
        let begun = Instant::now();
        path.ok(arguments);
        longest = longest.max(begun.elapsed());
        whole.push(standing(&out, pair.kind));
    }
    assert_ne!(whole[0], whole[1], "the runs cannot be distinguished");
    let mut bytes = [0; 32];
    bytes[..8].copy_from_slice(&seed.to_le_bytes());
    let lot = TestRng::from_seed(RngAlgorithm::ChaCha, &bytes);
    let mut lot = TestRunner::new_with_rng(Config::default(), lot);
    let mut seen = [0; 4];
    let (mut number, mut killed) = (0, 0);
    // A process that has already ended does not count as killed.
    while killed < times {
        // Before every third run, the directory is removed.
        if number % 3 == 0 && out.exists() {
            fs::remove_dir_all(&out).unwrap();
        }
        let before = standing(&out, pair.kind);
        let was_mixed = refuse_mixed(&out).is_err();
        let mut child = path.start(pair.runs[number % 2]);
        // In every second run, the time is near the end, when files are moved to the directory.
        let part = (0.0..1.0_f64).new_tree(&mut lot).unwrap().current();
        let part = if number % 2 == 0 { part } else { 1.0 - 0.3 * part };
        std::thread::sleep(longest.mul_f64(part));
        let ended = child.try_wait().unwrap().is_some();
        // A process cannot catch SIGKILL.
        child.kill().unwrap();
        child.wait().unwrap();
        let after = standing(&out, pair.kind);
        let is_mixed = refuse_mixed(&out).is_err();
        let (as_before, is_new) = (after == before, after == whole[number % 2]);
        assert!(
            as_before && was_mixed == is_mixed || is_new || is_mixed,
            "kill {number} of seed {seed}, after {part} of {longest:?}: a mixed directory is taken for whole: {after:?}"
        );
        for (count, holds) in seen.iter_mut().zip([ended, as_before, is_new, is_mixed]) {
            *count += u32::from(holds);
        }
        (number, killed) = (number + 1, killed + usize::from(!ended));
        assert!(number < 20 * times, "too many end before they are killed");
    }
    let [ended, as_before, new, mixed] = seen;
    let command = pair.runs[0];
    eprintln!(
        "{killed} kills of {command}, of {number} runs: {ended} had ended, {as_before} as before, {new} new, {mixed} mixed"
    );
    path.ok(pair.runs[0]);
    assert_eq!(standing(&out, pair.kind), whole[0]);
    assert!(refuse_mixed(&out).is_ok());
    let is_hidden = |name: &String| name.contains("/.") || name.starts_with('.');
    assert!(!files(path).iter().any(is_hidden), "what killed runs left goes with the next: {:?}", files(path));
}

fn times(few: usize, many: usize) -> usize {
    if std::env::var_os("GRAINBENCH_LONG").is_some() { many } else { few }
}

#[test]
fn a_killed_simulation_leaves_no_mixed_directory() {
    kill(&SIMULATE, times(7, 80), 1);
}

#[test]
fn a_killed_run_leaves_no_mixed_report() {
    kill(&RUN, times(4, 40), 2);
}
