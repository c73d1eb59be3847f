//! Runs numbered items in separate processes. A crash or hang of an item is then found and reported.

use std::env;
use std::fs;
use std::io::Write;
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};
use std::{ops, thread};

use proptest::strategy::{Strategy, ValueTree};
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};

/// Environment variable that selects the items to run: `scenes:SEED:FROM:COUNT`, or `files:…`.
const ASKED: &str = "GRAINBENCH_FUZZ";
/// Environment variable with the folder to which the process that runs the items writes its progress and findings.
const NOTES: &str = "GRAINBENCH_FUZZ_NOTES";
/// Number of items per process.
const CHUNK: u64 = 2500;
/// Memory limit of the process that runs the items (kB). A scene that needs more must be rejected before memory runs out.
const MEMORY: u64 = 4 << 20;
/// Time on one item after which a process counts as hanging.
const PATIENCE: Duration = Duration::from_secs(120);
/// Number of findings after which the search ends.
const ENOUGH: usize = 40;

/// Kind of items.
pub(crate) struct Kind {
    /// Name of the kind, equal to the name of its test.
    pub(crate) name: &'static str,
    /// Default number of items.
    pub(crate) few: u64,
    /// Number of items if `GRAINBENCH_LONG` is set.
    pub(crate) many: u64,
    /// Function that makes an item from random draws, runs it, and returns an error if the result is wrong.
    pub(crate) try_out: fn(&mut RandomSource) -> Result<(), String>,
}

/// Random draws for one item, and the description of the item.
pub(crate) struct RandomSource {
    runner: TestRunner,
    /// Description of the item, which a finding contains.
    shown: String,
    /// File to which the description is also written, because the item may end the process.
    beside: Option<PathBuf>,
}

impl RandomSource {
    /// Creates the draws of an item. They depend only on the seed and on the number of the item.
    fn new(seed: u64, number: u64, beside: Option<PathBuf>) -> Self {
        let mut bytes = [0; 32];
        bytes[..8].copy_from_slice(&seed.to_le_bytes());
        bytes[8..16].copy_from_slice(&number.to_le_bytes());
        let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &bytes);
        Self { runner: TestRunner::new_with_rng(Config::default(), rng), shown: String::new(), beside }
    }

    /// Adds text at the beginning of the description.
    pub(crate) fn show(&mut self, words: &str) {
        self.shown.insert_str(0, &format!("{words}\n"));
        if let Some(beside) = &self.beside {
            fs::write(beside, &self.shown).expect("notes");
        }
    }

    pub(crate) fn draw<S: Strategy>(&mut self, strategy: S) -> S::Value {
        strategy.new_tree(&mut self.runner).expect("nothing is filtered").current()
    }

    /// Draws one of several values.
    pub(crate) fn one<'a, T>(&mut self, choices: &'a [T]) -> &'a T {
        &choices[self.draw(0..choices.len())]
    }
}

/// Range of item numbers.
#[derive(Clone, Copy)]
struct Range {
    seed: u64,
    from: u64,
    count: u64,
}

impl Range {
    /// Returns the requested items of this kind, or the default items. `None` if items of another kind are requested.
    fn from_kind(kind: &Kind) -> Option<Self> {
        let Ok(asked) = env::var(ASKED) else {
            let count = if env::var_os("GRAINBENCH_LONG").is_some() { kind.many } else { kind.few };
            return Some(Self { seed: 1, from: 0, count });
        };
        let mut words = asked.split(':');
        let name = words.next().unwrap_or_default();
        let numbers: Vec<u64> = words.map_while(|word| word.parse().ok()).collect();
        let [seed, from, count] = numbers[..] else { panic!("{ASKED}: expected KIND:SEED:FROM:COUNT, found {asked}") };
        (name == kind.name).then_some(Self { seed, from, count })
    }
}

/// Runs the requested items of a kind in child processes. In a child process, where [`NOTES`] is set, runs the items itself.
pub(crate) fn go(kind: &Kind) {
    let Some(range) = Range::from_kind(kind) else { return };
    match env::var_os(NOTES) {
        Some(notes) => work(kind, range, Path::new(&notes)),
        None => watch(kind, range),
    }
}

/// Files of a process that runs items: the present item and the findings.
struct Notes {
    at: PathBuf,
    found: PathBuf,
    /// File with the description of the item.
    shown: PathBuf,
}

impl Notes {
    fn open(folder: &Path) -> Self {
        Self { at: folder.join("at"), found: folder.join("found"), shown: folder.join("shown") }
    }
}

/// Runs items one after another in this process.
fn work(kind: &Kind, range: Range, folder: &Path) {
    static PANIC: Mutex<String> = Mutex::new(String::new());
    set_hook(Box::new(|panic| {
        if let Ok(mut last) = PANIC.lock() {
            *last = panic.to_string();
        }
    }));
    let notes = Notes::open(folder);
    let mut at = fs::File::create(&notes.at).expect("notes");
    let mut found = fs::File::create(&notes.found).expect("notes");
    for number in range.from..range.from + range.count {
        // The number is written at a fixed position of the file, so that it replaces the previous number.
        std::io::Seek::rewind(&mut at).expect("notes");
        write!(at, "{number:020}").expect("notes");
        let mut lot = RandomSource::new(range.seed, number, (range.count == 1).then(|| notes.shown.clone()));
        let tried = catch_unwind(AssertUnwindSafe(|| (kind.try_out)(&mut lot)));
        let wrong = match tried {
            Ok(Ok(())) if range.count > 1 => continue,
            Ok(Ok(())) => "nothing is wrong".to_owned(),
            Ok(Err(wrong)) => wrong,
            Err(_) => PANIC.lock().map(|last| last.clone()).unwrap_or_default(),
        };
        let Range { seed, .. } = range;
        writeln!(found, "{}:{seed}:{number}:1: {wrong}\n{}\n\u{1e}", kind.name, lot.shown).expect("notes");
    }
}

/// Runs items in separate processes and reports the findings. Each process runs at most [`CHUNK`] items.
fn watch(kind: &Kind, range: Range) {
    let Range { seed, from, count } = range;
    let (done, begun) = (AtomicU64::new(0), Instant::now());
    // Each core runs its own part of the items.
    let cores = thread::available_parallelism().map_or(1, |cores| cores.get() as u64).min(count.max(1));
    let share = |core: u64| from + count * core / cores..from + count * (core + 1) / cores;
    let go_through = |share: ops::Range<u64>| {
        let (mut next, mut findings) = (share.start, Vec::new());
        while next < share.end && findings.len() < ENOUGH {
            let chunk = Range { seed, from: next, count: CHUNK.min(share.end - next) };
            let (found, after) = in_a_process(kind, chunk);
            for finding in &found {
                eprintln!("{finding}");
            }
            findings.extend(found);
            let done = done.fetch_add(after - next, Ordering::Relaxed) + after - next;
            next = after;
            eprintln!("{} of seed {seed}: {done} of {count}, {} s", kind.name, begun.elapsed().as_secs());
        }
        findings
    };
    let findings: Vec<String> = thread::scope(|scope| {
        let shares: Vec<_> = (0..cores).map(|core| scope.spawn(move || go_through(share(core)))).collect();
        shares.into_iter().flat_map(|core| core.join().unwrap()).collect()
    });
    let wrong: Vec<&String> = findings.iter().filter(|finding| !finding.contains(": nothing is wrong\n")).collect();
    assert!(wrong.is_empty(), "{} of {count} {}:\n{}", wrong.len(), kind.name, findings.join("\n"));
}

/// Runs items in a separate process. Returns the findings, and the first item that was not run.
fn in_a_process(kind: &Kind, range: Range) -> (Vec<String>, u64) {
    let Range { seed, from, count } = range;
    let folder = tempfile::tempdir().expect("a place for notes");
    let notes = Notes::open(folder.path());
    let output = folder.path().join("said");
    let mut child = Command::new("sh")
        // If the system does not support this limit, memory is not limited.
        .args(["-c", &format!("ulimit -v {MEMORY} 2>/dev/null; exec \"$@\""), "sh"])
        .arg(env::current_exe().expect("this program"))
        .args([kind.name, "--exact", "--nocapture", "--test-threads=1"])
        .env(ASKED, format!("{}:{seed}:{from}:{count}", kind.name))
        .env(NOTES, folder.path())
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(fs::File::create(&output).expect("notes"))
        .spawn()
        .expect("this program starts");
    let at = || fs::read_to_string(&notes.at).ok().and_then(|text| text.parse::<u64>().ok());
    let (mut last, mut since) = (None, Instant::now());
    let ended = loop {
        if let Some(status) = child.try_wait().expect("it is ours") {
            break (!status.success()).then(|| format!("ended the process: {status}"));
        }
        let now = at();
        if now != last {
            (last, since) = (now, Instant::now());
        }
        if since.elapsed() > PATIENCE {
            child.kill().expect("it is ours");
            child.wait().expect("it is ours");
            break Some(format!("not done after {} s", PATIENCE.as_secs()));
        }
        thread::sleep(Duration::from_millis(20));
    };
    let found = fs::read_to_string(&notes.found).unwrap_or_default();
    let mut found: Vec<String> =
        found.split('\u{1e}').map(str::trim_start).filter(|text| !text.is_empty()).map(str::to_owned).collect();
    let Some(ended) = ended else { return (found, from + count) };
    let number = at().unwrap_or(from);
    let words = fs::read_to_string(&output).unwrap_or_default();
    let tail: Vec<&str> = words.lines().rev().take(4).collect();
    let tail: Vec<&str> = tail.into_iter().rev().collect();
    let shown = fs::read_to_string(&notes.shown).unwrap_or_default();
    found.push(format!("{}:{seed}:{number}:1: {ended}: {}\n{shown}", kind.name, tail.join(" | ")));
    (found, number + 1)
}
