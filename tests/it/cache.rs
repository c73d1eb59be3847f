//! The cache of finished runs: a result from the cache equals the result of a run, and other results are never used.
use crate::common::{ABSENT, Answer, Directory, entries, interrupted, temporary};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Command with runs of 0.5 s in total, of material points and of grains.
const RUN: &str = "run column rolling-resistance --quiet";

/// Returns a command that uses a separate cache.
fn program(directory: &Path, out: &str) -> Command {
    let mut command = directory.program(format!("{RUN} --out {out}"));
    // LAMMPS and LIGGGHTS are hidden, because their runs are not cached and take time to start.
    command.env("GRAINBENCH_CACHE", directory.join("cache")).envs(ABSENT);
    command
}

/// Returns the exit code and the number of runs taken from the cache, as stated in the report and on its page.
fn taken(command: &mut Command, directory: &Path, out: &str) -> (Option<i32>, u64) {
    let code = command.stdout(Stdio::null()).stderr(Stdio::null()).status().unwrap().code();
    let results = directory.join(out).json("results.json");
    let options = results["provenance"]["options"].as_array().unwrap();
    let count_text = options.iter().find_map(|option| option.as_str()?.split_once(" runs taken from the cache"));
    let page = directory.join(out).read("index.html");
    assert_eq!(page.contains("runs taken from the cache"), count_text.is_some(), "the page shows it too");
    (code, count_text.map_or(0, |(number, _)| number.parse().unwrap()))
}

fn rows(directory: &Path, out: &str) -> String {
    directory.join(out).read("rows.csv")
}

/// Returns the files of finished runs in the cache.
fn kept(directory: &Path) -> Vec<PathBuf> {
    entries(directory.join("cache"))
}

#[test]
fn a_finished_run_is_reused_and_reported() {
    let here = temporary();
    assert_eq!(taken(&mut program(&here, "first"), &here, "first"), (Some(0), 0));
    // A run that was too short for the cache may take longer when it is repeated.
    let kept = kept(&here).len() as u64;
    let (code, again) = taken(&mut program(&here, "second"), &here, "second");
    assert_eq!((code, rows(&here, "second")), (Some(0), rows(&here, "first")));
    assert_eq!(again, kept, "each is taken once");
    assert!(again > 5, "{again}");
    // With `--no-cache`, or if the cache is off, no run is taken from the cache.
    assert_eq!(taken(program(&here, "fresh").arg("--no-cache"), &here, "fresh"), (Some(0), 0));
    assert_eq!(taken(program(&here, "off").env("GRAINBENCH_CACHE", "off"), &here, "off"), (Some(0), 0));
    assert_eq!(rows(&here, "fresh"), rows(&here, "off"));
    // Runs with another instruction set are not taken from the cache, but their results have the same bits.
    let portable = taken(program(&here, "portable").env("GRAINBENCH_PROCESSOR", "portable"), &here, "portable");
    assert_eq!((portable, rows(&here, "portable")), ((Some(0), 0), rows(&here, "first")));
}

/// A folder that every user can write is not used. In CI there is no cache, unless a folder is named.
#[cfg(unix)]
#[test]
fn a_folder_of_everybody_is_not_used() {
    use std::os::unix::fs::PermissionsExt;
    let here = temporary();
    assert_eq!(taken(&mut program(&here, "first"), &here, "first"), (Some(0), 0));
    let mode = |mode| fs::set_permissions(here.join("cache"), fs::Permissions::from_mode(mode)).unwrap();
    mode(0o777);
    let message = Answer::of(&mut program(&here, "open")).ok().err;
    assert!(message.contains("not used") && message.contains("mode 777"), "{message}");
    assert_eq!(taken(&mut program(&here, "open"), &here, "open"), (Some(0), 0));
    mode(0o775);
    assert!(taken(&mut program(&here, "group"), &here, "group").1 > 5);
    let results = here.read("group/results.json");
    assert!(results.contains("owned by user") && results.contains("writable by group"), "{results}");
    let in_ci = |out: &str| {
        let mut command = program(&here, out);
        command.env_remove("GRAINBENCH_CACHE").envs([("CI", "true"), ("XDG_CACHE_HOME", here.to_str().unwrap())]);
        taken(&mut command, &here, out)
    };
    assert_eq!((in_ci("once"), in_ci("twice")), ((Some(0), 0), (Some(0), 0)));
    assert!(!here.join("grainbench").exists());
}

#[test]
fn what_is_damaged_foreign_or_older_is_done_again() {
    let here = temporary();
    assert_eq!(taken(&mut program(&here, "first"), &here, "first").1, 0);
    let whole: Vec<(PathBuf, Vec<u8>)> =
        kept(&here).into_iter().map(|path| (path.clone(), fs::read(path).unwrap())).collect();
    let count = whole.len() as u64;
    let spoil = |how: &dyn Fn(usize, &[u8]) -> Vec<u8>| {
        kept(&here).iter().for_each(|path| fs::remove_file(path).unwrap());
        for (at, (path, bytes)) in whole.iter().enumerate() {
            fs::write(path, how(at, bytes)).unwrap();
        }
        let found = taken(&mut program(&here, "spoiled"), &here, "spoiled");
        assert_eq!(rows(&here, "spoiled"), rows(&here, "first"));
        found
    };
    let flipped = |at: usize, bytes: &[u8]| {
        let mut bytes = bytes.to_vec();
        let place = bytes.len() - 1 - at * 37 % (bytes.len() / 2);
        bytes[place] ^= 1;
        bytes
    };
    let older = |_: usize, bytes: &[u8]| [b"grainbench record 0\n", &bytes["grainbench record 1\n".len()..]].concat();
    assert_eq!(spoil(&flipped), (Some(0), 0), "a bit is wrong");
    assert_eq!(spoil(&|_, bytes| bytes[..bytes.len() / 2].to_vec()), (Some(0), 0), "cut off");
    assert_eq!(spoil(&|_, _| Vec::new()), (Some(0), 0), "empty");
    assert_eq!(spoil(&|_, _| b"{\"a\": 1}".to_vec()), (Some(0), 0), "another kind of file");
    assert_eq!(spoil(&older), (Some(0), 0), "an older format");
    let of_next = |at: usize, _: &[u8]| whole[(at + 1) % whole.len()].1.clone();
    assert_eq!(spoil(&of_next), (Some(0), 0), "the run of another name");
    // The repeated runs are in the cache again.
    let (code, again) = taken(&mut program(&here, "last"), &here, "last");
    assert!(code == Some(0) && 2 * again > count, "{again} of {count}");
}

#[test]
fn two_at_once_share_it() {
    let here = temporary();
    let start = |out: &str| program(&here, out).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    for mut child in [start("one"), start("two")] {
        assert_eq!(child.wait().unwrap().code(), Some(0));
    }
    assert_eq!(rows(&here, "one"), rows(&here, "two"));
    let kept = kept(&here).len() as u64;
    assert_eq!(taken(&mut program(&here, "three"), &here, "three"), (Some(0), kept));
}

/// Ctrl-C is sent at ten different times. Finished runs stay in the cache, and in the end no result is missing.
#[test]
#[cfg(target_os = "linux")]
fn an_interrupted_run_goes_on_from_what_was_finished() {
    let here = temporary();
    let begun = Instant::now();
    assert_eq!(taken(program(&here, "whole").env("GRAINBENCH_CACHE", "off"), &here, "whole"), (Some(0), 0));
    let long = begun.elapsed();
    let mut last = 0;
    for moment in 0..10 {
        let child = program(&here, "cut").stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
        std::thread::sleep(Duration::from_millis(20).max(long.mul_f64(f64::from(moment) / 10.0)));
        let (code, message) = interrupted(child);
        // Before the handler is installed, a signal ends the process without a message.
        let is_announced = message.contains("the next run continues with the finished runs");
        assert!(code != Some(1) || is_announced, "{message}");
        let now = if here.join("cache").exists() { kept(&here).len() } else { 0 };
        assert!(now >= last, "finished runs are lost: {now} after {last}");
        last = now;
    }
    let (code, again) = taken(&mut program(&here, "end"), &here, "end");
    assert_eq!((code, rows(&here, "end")), (Some(0), rows(&here, "whole")));
    assert!(last > 0 && again >= last as u64, "{again} of {last}");
}
