//! Test of throughput and memory of the dump reader, which are both printed. The dump has 64 MiB, or 1 GiB with
//! `GRAINBENCH_LONG=1`.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fmt::Write as _;
use std::io::{BufReader, PipeReader, Write, pipe};
use std::thread;
use std::time::Instant;

use grainbench_reference::{DumpReader, DumpSnapshot};

/// Returns a dump that repeats the same rows at the steps 0 to `steps` − 1. A thread writes it while it is read.
fn repeated(rows: String, atoms: usize, steps: u64) -> PipeReader {
    let (reader, mut writer) = pipe().unwrap();
    thread::spawn(move || {
        for step in 0..steps {
            let snapshot = format!(
                "ITEM: TIMESTEP\n{step}\nITEM: NUMBER OF ATOMS\n{atoms}\nITEM: BOX BOUNDS ff ff ff\n0 1\n0 1\n0 1\n\
                 ITEM: ATOMS id type x y z vx vy vz omegax omegay omegaz\n{rows}"
            );
            writer.write_all(snapshot.as_bytes()).unwrap();
        }
    });
    reader
}

/// Returns the peak memory of the process so far (MiB), if the system reports it.
fn peak() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM"))?;
    Some(line.split_whitespace().nth(1)?.parse::<f64>().ok()? / 1024.0)
}

#[test]
fn reads_snapshots_in_the_memory_of_one() {
    const ATOMS: usize = 10_000;
    let mut rows = String::new();
    for id in 1..=ATOMS {
        // The ids are not in order, so the reader must sort them.
        let id = id * 7919 % ATOMS + 1;
        let value = |k: usize| (id as f64 * 0.618_034 + k as f64 * 0.377).sin();
        write!(rows, "{id} 1").unwrap();
        (0..9).for_each(|k| write!(rows, " {:?}", value(k)).unwrap());
        rows.push('\n');
    }
    let bytes = if std::env::var_os("GRAINBENCH_LONG").is_some() { 1 << 30 } else { 1 << 26 };
    let snapshots = (bytes / rows.len()) as u64;
    let size = snapshots as f64 * rows.len() as f64 / 1e6;
    let mut reader = DumpReader::new(BufReader::new(repeated(rows, ATOMS, snapshots)), "repeated").unwrap();
    let mut snapshot = DumpSnapshot::default();
    // The first snapshots allocate the memory that later snapshots reuse.
    for _ in 0..3 {
        assert!(reader.read(&mut snapshot).unwrap());
    }
    let before = peak();
    let start = Instant::now();
    let (mut count, mut sum) = (3, 0.0);
    while reader.read(&mut snapshot).unwrap() {
        count += 1;
        sum += snapshot.row(ATOMS - 1)[2];
    }
    let seconds = start.elapsed().as_secs_f64();
    assert_eq!((count, snapshot.rows()), (snapshots, ATOMS));
    assert!(sum.is_finite());
    println!("{size:.0} MB in {seconds:.2} s: {:.0} MB/s", size / seconds);
    if let (Some(before), Some(after)) = (before, peak()) {
        println!("largest memory {before:.1} MB after three snapshots, {after:.1} MB after {count}");
        assert!(after - before < 8.0, "{before} {after}");
    }
}
