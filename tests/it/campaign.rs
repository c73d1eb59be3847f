//! Plans on the command line. The report of a plan equals the report of its command. After a kill, a truncated file or
//! a full disk, no result is lost and no task is repeated. Invalid plans are rejected.

mod edits;

use crate::common::{Answer, Directory, Folder, count, files, root, temporary, temporary_with};
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Duration;

/// Sweep of two factors with two solvers, a claim of the case, and a further quantity.
const SWEEP: &str = include_str!("../scenes/sweep.toml");
/// Number of points of the sweep, over all solvers and levels.
const POINTS: usize = 45;

/// Returns a folder that contains the sweep and its plan.
fn planned() -> Folder {
    let directory = temporary_with("sweep.toml", SWEEP);
    directory.ok("simulate sweep.toml --plan p");
    directory
}

/// Returns the rows of a table without the column of times.
fn rows(file: &Path) -> Vec<String> {
    let text = fs::read_to_string(file).unwrap();
    let mut table = text.lines();
    let head = table.next().unwrap();
    let times = head.split(',').position(|name| name == "wall_seconds").unwrap();
    // The times are the last column of these tables.
    assert_eq!(times + 1, head.split(',').count());
    table.map(|line| line.rsplit_once(',').unwrap().0.to_owned()).collect()
}

/// Returns the progress of a plan as JSON.
fn status(directory: &Path, plan: &str) -> Value {
    directory.ok(format!("report {plan} --progress --json")).json()
}

/// Returns the ids of all results of a plan, one for each complete line.
fn done(plan: &Path) -> Vec<String> {
    let mut found = Vec::new();
    for entry in fs::read_dir(plan.join("results")).unwrap() {
        let text = String::from_utf8_lossy(&fs::read(entry.unwrap().path()).unwrap()).into_owned();
        let whole = text.rsplit_once('\n').map_or("", |(whole, _)| whole).to_owned();
        found.extend(whole.lines().skip(1).filter_map(|line| Some(line.split_once(' ')?.0.to_owned())));
    }
    found
}

/// Removes all times and the provenance from a report.
fn without_times(mut value: Value) -> Value {
    fn strip(value: &mut Value) {
        match value {
            Value::Object(map) => {
                for key in
                    ["provenance", "seconds", "time", "wall_seconds", "wall_spread", "cpu_seconds", "start_up_seconds"]
                {
                    map.remove(key);
                }
                if let Some(Value::Array(repetitions)) = map.get("repetitions") {
                    let count = repetitions.len();
                    map.insert("repetitions".to_owned(), count.into());
                }
                map.values_mut().for_each(strip);
            }
            Value::Array(list) => list.iter_mut().for_each(strip),
            _ => {}
        }
    }
    strip(&mut value);
    value
}

/// The report of a plan equals the report of its command without `--plan`, except for times and provenance.
#[test]
fn a_collected_plan_is_the_report_of_its_command() {
    let here = temporary();
    for (command, shards, file) in [
        ("run squash collision", 3, "report.json"),
        ("stability two-discs mass-ratio-1e6 --solver=dem --solver=mpm", 2, "study.json"),
        ("cost collision --solver=dem --solver=rigid", 1, "study.json"),
        ("effects collision/gamma-zeta.1 squash", 2, "study.json"),
    ] {
        let direct = here.run(format!("{command} --out direct"));
        here.ok(format!("{command} --plan p"));
        for shard in 1..=shards {
            here.ok(format!("run --resume p --shard {shard}/{shards}"));
        }
        let collected = here.run("report p --out collected");
        assert_eq!(collected.code, direct.code, "{}", collected.err);
        let [direct, collected] = ["direct", "collected"].map(|out| without_times(here.join(out).json(file)));
        assert_eq!(collected, direct, "{command}");
        for folder in ["p", "direct", "collected"] {
            fs::remove_dir_all(here.join(folder)).unwrap();
        }
    }
}

/// A sweep that runs at once gives the same results as its plan. The old commands still work, and print a note.
#[test]
fn a_sweep_at_once_is_its_plan() {
    let here = temporary_with("sweep.toml", SWEEP);
    here.ok("simulate sweep.toml --out once");
    for (old, arguments) in [
        ("plan", "sweep.toml --out old --chunks 2"),
        ("work", "old --chunk 1/1"),
        ("status", "old"),
        ("collect", "old"),
    ] {
        let answer = here.ok(format!("{old} {arguments}"));
        assert!(answer.err.contains(&format!("note: `{old}` is now `grainbench ")), "{}", answer.err);
    }
    let [once, old] = ["once", "old"].map(|plan| rows(&here.join(plan).join("report/rows.csv")));
    assert_eq!(once, old);
}

#[test]
fn counts_want_no_times_and_are_those_of_the_command() {
    let here = temporary();
    let plan = here.ok("cost collision --solver=dem --counts --json --plan p").out.clone();
    assert_eq!(serde_json::from_str::<Value>(&plan).unwrap()["timed"], false);
    here.ok("run --resume p --jobs 2");
    here.ok("report p --out collected");
    here.ok("cost collision --solver=dem --out direct");
    let counts = |out: &str| -> Vec<Value> {
        let points = here.join(out).json("results.json")["points"].as_array().unwrap().clone();
        points.iter().map(|point| serde_json::json!([point["resolution"], point["error"], point["counts"]])).collect()
    };
    assert_eq!(counts("collected"), counts("direct"));
    assert!(!counts("direct").is_empty());
}

#[test]
fn a_sweep_is_the_same_in_one_piece_and_in_shards() {
    let here = planned();
    let shards: usize = (1..=4)
        .map(|shard| {
            let words = here.ok(format!("run --resume p --shard {shard}/4 -j 2")).out.clone();
            words.split_whitespace().next().unwrap().parse::<usize>().unwrap()
        })
        .sum();
    assert_eq!(shards, POINTS);
    assert_eq!(done(&here.join("p")).len(), POINTS);
    // With another number of shards, all tasks are already finished.
    assert!(here.ok("run --resume p --shard 1/1").out.contains("45 were finished, 0 done now"));
    here.ok("report p");
    fs::rename(here.join("p"), here.join("first")).unwrap();
    here.ok("simulate sweep.toml --plan p");
    here.ok("run --resume p");
    here.ok("report p");
    let report = here.join("first/report");
    assert_eq!(rows(&report.join("rows.csv")), rows(&here.join("p/report/rows.csv")));
    assert_eq!(rows(&report.join("rows.csv")).len(), 2 * POINTS);
    for name in ["index.html", "rows.parquet", "figures/map.svg", "figures/work.svg"] {
        assert!(report.join(name).is_file(), "{name}");
    }
    // The disc rolls or slips with both methods as expected, because the springs of the case are stiff enough.
    let results = report.json("results.json");
    let verdicts = results["verdicts"].as_array().unwrap();
    let [passed, failed] = ["pass", "fail"].map(|word| count(verdicts, word));
    assert!(passed > 35 && passed + failed == POINTS, "{passed} {failed}");
    // A quantity without an expectation is reported without an outcome. Without friction it is sin θ, at most 0.87.
    let unjudged: Vec<&Value> = verdicts.iter().filter(|row| row["verdict"].is_null()).collect();
    assert!(unjudged.len() == POINTS && unjudged.iter().all(|row| row["value"].as_f64() < Some(0.87)));
}

/// A report with unfinished tasks is red, also when its files are written again.
#[test]
fn a_report_of_some_tasks_is_red_everywhere() {
    let here = temporary();
    here.ok("run collision --solver dem --plan p --shards 4");
    here.ok("run --resume p --shard 1/4");
    assert_eq!(here.run("report p").code, Some(1));
    let again = here.run("report p/report");
    assert!(again.code == Some(1) && again.out.contains("✗ unfinished: "), "{}{}", again.out, again.err);
    let read = |name: &str| here.join("p/report").read(name);
    assert!(read("badge.svg").contains("grainbench: unfinished<") && read("junit.xml").contains("errors=\"1\""));
    here.ok("run --resume p");
    here.ok("report p");
    here.ok("report p/report");
    assert!(read("badge.svg").contains("pass"));
}

/// A sweep uses the cache of finished runs: cached runs are not repeated, and new runs are added.
#[test]
fn a_sweep_shares_the_cache_of_runs() {
    let here = planned();
    // The runs are long enough for the cache.
    here.write("sweep.toml", SWEEP.replace("dt=.05", "dt=.0001"));
    let work = |plan: &str, cache: &str| {
        here.ok(format!("simulate sweep.toml --plan {plan}"));
        Answer::of(here.program(format!("run --resume {plan}")).env("GRAINBENCH_CACHE", here.join(cache))).ok();
        here.ok(format!("report {plan}"));
        fs::read_dir(here.join(cache)).unwrap().count()
    };
    let kept = work("p1", "cache");
    assert!(kept >= 15, "{kept}");
    assert!(work("p2", "cache") >= kept);
    let times = |plan: &str| -> Vec<String> {
        let text = here.join(plan).read("report/rows.csv");
        let slow = text.lines().filter(|line| line.contains("dt=0.0001"));
        slow.map(|line| line.rsplit_once(',').unwrap().1.to_owned()).collect()
    };
    assert_eq!(times("p1"), times("p2"), "a reused run reports its original time");
}

/// A crash of a solver and an unsupported scene are results with their own outcome, which the report shows.
#[test]
fn failures_keep_their_type() {
    let here = temporary();
    let sweep =
        SWEEP.replace("'incline-disc/60deg-mu.3'", "'nine-discs/kappa-1'").replace("[[record]]", "[[recorded]]");
    let sweep = sweep.split("[factors]").next().unwrap().to_owned()
        + "[[record]]\nquantity = 'velocity'\nunit = 'm/s'\nvalue = 'corner.vy'\n\
           [[solvers]]\nsolver = 'dem'\nlevels = ['dt=.1', 'dt=40']\n\
           [[solvers]]\nsolver = 'mpm'\nlevels = ['cells=4']\n";
    here.write("sweep.toml", sweep);
    here.ok("simulate sweep.toml --plan p");
    here.ok("run --resume p");
    let progress = status(&here, "p");
    assert_eq!((progress["tasks"].as_u64(), progress["failed"].as_u64()), (Some(3), Some(2)), "{progress}");
    assert_eq!(here.run("report p").code, Some(1));
    let results = here.json("p/report/results.json");
    let words = |key| results["verdicts"].as_array().unwrap().iter().filter_map(move |row| row[key].as_str());
    assert!(words("verdict").eq(["broken", "unsupported"]), "{results}");
    assert!(words("severity").eq(["red", "amber"]), "{results}");
    // A failed task counts as finished, unless `--retry-failed` is given.
    assert!(here.ok("run --resume p").out.contains("3 were finished, 0 done now"));
    assert!(here.ok("run --resume p --retry-failed").out.contains("2 done now, 2 of them failed"));
}

/// Workers are killed at random times, and lines are truncated. All remaining tasks are then run, and none is run twice.
#[test]
fn killed_workers_lose_nothing_and_do_nothing_twice() {
    let here = temporary();
    // About two hundred tasks of a few milliseconds each.
    let sweep = SWEEP.replace("count = 5", "count = 22").replace("dt=.05", "dt=.002");
    here.write("sweep.toml", sweep);
    here.ok("simulate sweep.toml --plan whole");
    here.ok("run --resume whole");
    here.ok("report whole");
    here.ok("simulate sweep.toml --plan p");
    let mut state = 7_u64;
    let (mut killed, mut at_work) = (0, 0);
    let results = || if here.join("p/results").is_dir() { done(&here.join("p")).len() } else { 0 };
    for round in 0..40 {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        let start = |shard: &str| here.start(format!("run --resume p --shard {shard}"));
        let before = results();
        let mut workers = [start("1/2"), start("2/2")];
        let enough = before + (state >> 40) as usize % 5;
        while results() < enough && workers.iter_mut().any(|worker| worker.try_wait().unwrap().is_none()) {
            std::thread::sleep(Duration::from_millis(1));
        }
        std::thread::sleep(Duration::from_micros((state >> 50) % 4000));
        for mut worker in workers {
            killed += usize::from(worker.try_wait().unwrap().is_none());
            let _ = worker.kill();
            worker.wait().unwrap();
        }
        at_work += usize::from(results() > before);
        if round % 3 == 0 {
            // Truncates the last line of one result file.
            let cut = fs::read_dir(here.join("p/results")).unwrap().map(|entry| entry.unwrap().path()).max();
            if let Some(path) = cut {
                let bytes = fs::read(&path).unwrap();
                fs::write(&path, &bytes[..bytes.len().saturating_sub(40)]).unwrap();
            }
        }
    }
    assert!(killed > 10 && at_work > 10, "{killed} were killed, {at_work} rounds had results");
    here.ok("run --resume p");
    let ids = done(&here.join("p"));
    assert_eq!(ids.len(), ids.iter().collect::<BTreeSet<_>>().len(), "a task was done twice");
    let progress = status(&here, "p");
    assert_eq!(["twice", "waiting", "running"].map(|key| progress[key].as_u64()), [Some(0); 3]);
    here.ok("report p");
    assert_eq!(rows(&here.join("p/report/rows.csv")), rows(&here.join("whole/report/rows.csv")));
    assert!(!files(&here.join("p/running")).iter().any(|name| name.ends_with(".json")), "leases stay of nobody");
}

/// A full disk ends the run but keeps the finished results. When there is space again, the remaining tasks are run.
#[test]
fn a_full_disk_loses_nothing() {
    let here = planned();
    // The files of this process are limited to 4 kB, which is about ten results.
    let command = ["-c", "trap '' XFSZ; ulimit -f 8; exec \"$0\" work p", env!("CARGO_BIN_EXE_grainbench")];
    let full = Answer::of(Command::new("sh").args(command).env("GRAINBENCH_CACHE", "off").current_dir(&here));
    assert!(full.code != Some(0) && full.err.contains("cannot write"), "{}", full.err);
    let before = done(&here.join("p")).len();
    assert!((1..POINTS).contains(&before), "{before}");
    assert_eq!(status(&here, "p")["damaged"], 0, "what the disk did not take whole is not there");
    let rest = here.ok("run --resume p").out.clone();
    assert!(rest.contains(&format!("{before} were finished, {} done now", POINTS - before)), "{rest}");
}

/// If the disk is full, an earlier plan stays unchanged, and a new plan leaves no file.
#[test]
fn a_plan_that_cannot_be_written_leaves_the_earlier_one() {
    let here = planned();
    // The limit of 512 bytes per file is too small for the second plan.
    let plan = |out: &str, limit: &str| {
        let script = format!("trap '' XFSZ; {limit} exec \"$0\" run belt --plan {out}");
        let command = ["-c", &script, env!("CARGO_BIN_EXE_grainbench")];
        let ended = Answer::of(Command::new("sh").args(command).current_dir(&here));
        (ended.code, ended.err)
    };
    let kept = ["plan.toml", "tasks.jsonl"].map(|name| fs::read(here.join("p").join(name)).unwrap());
    for out in ["p", "new"] {
        let (code, message) = plan(out, "ulimit -f 1;");
        assert!(code == Some(1) || code == Some(2), "{message}");
        assert!(message.contains("cannot write"), "{message}");
    }
    assert_eq!(kept, ["plan.toml", "tasks.jsonl"].map(|name| fs::read(here.join("p").join(name)).unwrap()));
    assert!(!here.join("new").exists());
    fs::create_dir_all(here.join("new/.grainbench-1@elsewhere-x")).unwrap();
    for out in ["p", "new"] {
        assert_eq!(plan(out, ""), (Some(0), String::new()), "{out}");
        here.ok(format!("report {out} --progress"));
    }
}

/// Workers that run at the same time share a plan, and do each task once.
#[test]
fn two_at_once_do_each_task_once() {
    let here = planned();
    let start = || here.program("run --resume p").stdout(Stdio::null()).spawn().unwrap();
    for mut worker in [start(), start(), start()] {
        assert_eq!(worker.wait().unwrap().code(), Some(0));
    }
    let ids = done(&here.join("p"));
    assert_eq!((ids.len(), ids.iter().collect::<BTreeSet<_>>().len()), (POINTS, POINTS));
}

/// Rejects plans with each kind of error in their files.
#[test]
fn what_is_no_plan_is_refused() {
    let here = planned();
    let plan = here.join("p");
    let whole: Vec<(PathBuf, Vec<u8>)> =
        ["plan.toml", "tasks.jsonl"].map(|name| (plan.join(name), fs::read(plan.join(name)).unwrap())).into();
    let refused = |what: &str| {
        for command in ["run --resume p", "report p --progress", "report p", "run --resume p --on slurm"] {
            let answer = here.run(command);
            assert_eq!(answer.code, Some(2), "{what}: {command}: {}{}", answer.out, answer.err);
            assert!(answer.err.contains("expected") && !answer.err.contains("panicked"), "{what}: {}", answer.err);
        }
    };
    for (path, bytes) in &whole {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        let foreign: [&[u8]; 6] =
            [b"", &bytes[..bytes.len() / 2], b"{\"a\": 1}\n", b"\xff\xfe\0", b"format = 1\n", &bytes[1..]];
        for (at, text) in foreign.into_iter().enumerate() {
            fs::write(path, text).unwrap();
            refused(&format!("{name} {at}"));
        }
        fs::remove_file(path).unwrap();
        refused(&format!("no {name}"));
        fs::write(path, bytes).unwrap();
    }
    let head = String::from_utf8(whole[0].1.clone()).unwrap();
    for (from, to) in [
        ("format = 1", "format = 2"),
        ("format = 1", "format = 1\nnothing = 2"),
        ("shards = 1", "shards = 0"),
        ("lease_seconds = 60.0", "lease_seconds = nan"),
    ] {
        assert!(head.contains(from), "{from}");
        fs::write(&whole[0].0, head.replace(from, to)).unwrap();
        refused(to);
    }
    for (from, to, message) in [
        ("no_controls = false", "nothing = false", "arguments"),
        ("program = \"", "program = \"0", "the program that wrote the plan"),
    ] {
        assert!(head.contains(from), "{from}");
        fs::write(&whole[0].0, head.replace(from, to)).unwrap();
        here.run("run --resume p").refused(message);
    }
    // Plans of earlier versions list the words of the command. Their progress can be read.
    let mut earlier: toml::Table = head.parse().unwrap();
    earlier.insert("arguments".to_owned(), vec!["sweep.toml"].into());
    earlier.insert("kind".to_owned(), "sweep".into());
    fs::write(&whole[0].0, earlier.to_string()).unwrap();
    here.ok("report p --progress");
    fs::write(&whole[0].0, head).unwrap();
    // Other files in the folder of results are ignored.
    for (name, text) in
        [("a.log", &b""[..]), ("b.log", b"hello\n"), ("c.log", b"grainbench-results 1 {}\n\xff\n"), ("d.txt", b"x")]
    {
        plan.join("results").write(name, text);
    }
    plan.write("running/x.json", "{");
    here.ok("run --resume p");
    here.ok("report p");
    assert_eq!(status(&here, "p")["damaged"], 2);
    assert_eq!(rows(&plan.join("report/rows.csv")).len(), 2 * POINTS);
    // A plan is written only to an empty folder or over a plan.
    here.write("full/notes", "");
    here.run("simulate sweep.toml --plan full").refused("other files");
    for shard in ["0/0", "5/3", "1/0", "0/1", "1", "a/b", "1/99999999999"] {
        assert_eq!(here.run(format!("run --resume p --shard {shard}")).code, Some(2), "{shard}");
    }
}

/// An external solver with a manifest runs every point of a sweep.
#[test]
fn a_program_by_its_manifest_takes_part() {
    let here = temporary();
    let manifest = root("examples/python/SOLVER.toml");
    let sweep = SWEEP
        .replace(
            "solver = 'rigid'\nlevels = ['substeps=8']",
            &format!("solver = '{}'\nlevels = ['dt=.01']", manifest.display()),
        )
        .replace("count = 5", "count = 2");
    here.write("sweep.toml", sweep);
    here.ok("simulate sweep.toml --plan p");
    here.ok("run --resume p");
    here.ok("report p");
    let rows = rows(&here.join("p/report/rows.csv"));
    let theirs: Vec<&String> = rows.iter().filter(|row| row.contains(",one-grain,")).collect();
    assert_eq!(theirs.len(), 12);
    assert!(theirs.iter().filter(|row| row.contains("displacement")).all(|row| row.contains(",pass,")), "{theirs:?}");
}

#[test]
fn a_trend_lists_changed_rows_and_counts() {
    let here = planned();
    here.ok("run --resume p");
    here.ok("report p --out new");
    // Results of an earlier commit: one claim failed, and one run had one step less.
    let mut old = here.json("new/results.json");
    old["verdicts"][0]["verdict"] = "fail".into();
    let steps = old["points"][0]["steps"].as_u64().unwrap();
    old["points"][0]["steps"] = (steps - 1).into();
    here.write("old/results.json", old.to_string());
    here.ok("report p --out new --against old --against new");
    let page = here.read("new/trend.html");
    assert!(page.contains("The trend over 3 reports") && page.contains(&format!("{} → {steps}", steps - 1)), "{page}");
    assert_eq!(page.matches("scope=\"row\"").count(), 1, "one row changed");
    assert!(here.join("new/index.html").is_file() && here.join("new/figures/map.svg").is_file());
    for (wrong, text) in [("missing", None), ("empty", Some("")), ("other", Some("[1]"))] {
        if let Some(text) = text {
            here.write(wrong, text);
        }
        assert_eq!(here.run(format!("report p --out new --against {wrong}")).code, Some(2), "{wrong}");
    }
}

/// Replaces the commands of Slurm by scripts that write their arguments to a file. If the file `broken` exists, `squeue` fails.
fn fake_slurm(directory: &Path) -> String {
    for (name, text) in [
        ("bin/sbatch", "echo \"$@\" >>\"$FAKE/sbatch.txt\"; cat \"$FAKE/number\" 2>/dev/null || echo 7"),
        ("bin/squeue", "test -e \"$FAKE/broken\" && exit 1; cat \"$FAKE/queue\" 2>/dev/null; true"),
        ("bin/scontrol", "echo 'Configuration data as of now'; echo 'MaxArraySize            = 4'"),
    ] {
        directory.script(name, text);
    }
    format!("{}:{}", directory.join("bin").display(), std::env::var("PATH").unwrap_or_default())
}

/// The job array stays within the limit of the site. A resubmission contains only the missing shards that are neither
/// queued nor running.
#[test]
fn slurm_is_asked_for_what_is_missing() {
    let here = planned();
    let path = fake_slurm(&here);
    here.ok("simulate sweep.toml --plan p --shards 9");
    let ask = |line: &str| Answer::of(here.program(line).env("PATH", &path).env("FAKE", &*here));
    let asked = || fs::read_to_string(here.join("sbatch.txt")).unwrap_or_default().lines().count();
    let (submit, again) = ("run --resume p --on slurm", "run --resume p --on slurm --resubmit");
    for wrong in ["--array=1-2", "-a1", "--wrap=true"] {
        assert_eq!(ask(&format!("{submit} -- {wrong}")).code, Some(2), "{wrong}");
    }
    here.write("broken", "");
    let answer = ask(submit);
    assert!(answer.code == Some(1) && answer.err.contains("squeue failed") && asked() == 0, "{}", answer.err);
    fs::remove_file(here.join("broken")).unwrap();
    let answer = ask(&format!("{submit} -- --partition=short --time=5"));
    // Array indices must be below MaxArraySize.
    assert_eq!((answer.code, answer.out.as_str()), (Some(0), "job 7: shards 1-3 of 3\n"), "{}", answer.err);
    let submitted = here.read("sbatch.txt");
    let both = submitted.contains("--partition=short --time=5") && submitted.contains("p/slurm/submit-1.sh");
    assert!(both, "{submitted}");
    let script = here.read("p/slurm/submit-1.sh");
    assert!(script.contains("#SBATCH --array=1-3\n") && !script.contains("--exclusive"), "{script}");
    // Submitting a plan a second time needs `--resubmit`.
    assert!(ask(submit).code == Some(2) && asked() == 1);
    here.write("queue", "7 2\n7 3\n9 1\n");
    here.write("number", "8");
    assert_eq!(ask(again).out, "job 8: shards 1 of 3\n");
    assert!(ask("report p --progress").out.contains("queued    2 shards"), "the job of another is not ours");
    for shard in ["1/3", "3/3"] {
        ask(&format!("run --resume p --shard {shard}")).ok();
    }
    here.write("queue", "");
    assert_eq!(ask(again).out, "job 8: shards 2 of 3\n");
    here.write("broken", "");
    let before = asked();
    assert!(ask(again).code == Some(1) && asked() == before, "an unknown queue is no empty one");
    assert!(ask("report p --progress").out.contains("queued    not known: squeue failed"));
    let status = ask("report p --progress --json").json();
    assert!(status["queued"].is_null() && status["waiting"].as_u64() > Some(0), "{status}");
    fs::remove_file(here.join("broken")).unwrap();
    ask("run --resume p").ok();
    assert!(ask(again).out.starts_with("every missing task is queued or running"));
    // A plan that measures times requests its node exclusively.
    ask("cost collision --solver=dem --plan c").ok();
    ask("run --resume c --on slurm").ok();
    let script = here.read("c/slurm/submit-1.sh");
    assert!(script.contains("#SBATCH --exclusive\n") && script.contains("--jobs 1"), "{script}");
    assert_eq!(ask("run --resume c --jobs 2").code, Some(2), "times are measured one at a time");
    // If `sbatch` does not print a job number, this is an error.
    here.write("number", "Submitted");
    ask("simulate sweep.toml --plan q").ok();
    let answer = ask("run --resume q --on slurm");
    assert!(answer.code == Some(1) && answer.err.contains("expected the number of a job"), "{}", answer.err);
}
