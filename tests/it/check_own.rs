//! `check` with a scene file, with a case with other parameters, with VTK files, and with a folder of many outputs.

use crate::common::{Answer, Directory, data, entries, temporary, temporary_with};
use grainbench::cases::registry::read_grains;
use grainbench::scene::source::SceneSource;
use serde_json::Value;
use std::fs;
use std::path::Path;

/// Returns the path of a file of a LIGGGHTS run whose input was written by hand.
fn file(name: &str) -> String {
    data(&format!("liggghts-slope/{name}"))
}

/// Returns all VTK files of the run, including those of its box, in the order of a shell pattern.
fn vtk() -> String {
    let files = entries(data("liggghts-slope")).into_iter().map(|path| path.display().to_string());
    files.filter(|path| path.ends_with(".vtk")).collect::<Vec<_>>().join(" ")
}

/// Parameters of the run, as changes of the case of a sphere on a slope.
const NUMBERS: &str = "--set gravity={magnitude=9.81,slope_deg=30} --set duration=.5 \
     --set materials.rock={density=2500,young_modulus=5e6,poisson_ratio=.3} \
     --set materials.rock.bulk_modulus= --set materials.rock.shear_modulus= \
     --set 'contacts.plane={law=\"hertz\",friction=.5,restitution=.5}' \
     --set contacts.plane.normal_stiffness= --set contacts.plane.tangential_stiffness= \
     --set contacts.plane.normal_damping= --set contacts.plane.tangential_damping= \
     --set grains.sphere={radius=.005,position=[0,0,.005]}";

fn judged(words: &str) -> (Option<i32>, Vec<Value>) {
    let directory = temporary();
    directory.run(format!("check {words} --json")).judged()
}

/// Returns the exit code and the results at the parameters of the run, with further changes.
fn at_numbers(files: &str, others: &str) -> (Option<i32>, Vec<Value>) {
    judged(&format!("incline-sphere/45deg-mu.495 {NUMBERS} {others} --dump {files}"))
}

fn count(rows: &[Value], condition: impl Fn(&Value) -> bool) -> usize {
    rows.iter().filter(|row| condition(row)).count()
}

/// Checks the dump and the VTK files of a run whose input was written by hand. The time step is in its log.
#[test]
fn a_scene_of_ones_own_is_compared_with_our_solvers() {
    let dump = file("sphere.dump");
    let vtk = vtk();
    assert!(vtk.contains("boundingBox") || vtk.split(' ').count() == 11);
    for files in [dump, vtk] {
        let scene = file("slope.toml");
        let (code, rows) = judged(&format!("{scene} --dump {files}"));
        let nearest = |row: &Value| row["source"].as_str().is_some_and(|source| source.starts_with("dem:liggghts"));
        // LIGGGHTS adds a tangential dashpot to Hertz contacts, which the scene lacks. Its effect, below a thousandth, is
        // amber. All other compared quantities pass. Changes of the scene that the output does not reveal are amber.
        let is_told = |row: &Value| row["verdict"] == "pass" || row["quantity"].as_str().unwrap().contains("reveals");
        let is_dashpot = |row: &Value| {
            let detail = row["detail"].as_str().unwrap_or_default();
            row["verdict"] == "no-reference" && detail.contains("our conventions differ by")
        };
        assert_eq!((code, count(&rows, |row| is_told(row) || is_dashpot(row))), (Some(0), rows.len()), "{rows:#?}");
        assert_eq!(count(&rows, is_dashpot), 3, "{rows:#?}");
        assert!(count(&rows, nearest) >= 9, "{rows:#?}");
        assert_eq!(rows[0]["case"], "slope");
    }
}

/// Exact solutions and their tolerances follow the parameters of the scene. Another slope or grain shape is red.
#[test]
fn exact_answers_follow_other_numbers() {
    let dump = file("sphere.dump");
    let is_exact = |row: &Value| row["evidence"] == "analytic";
    for files in [&dump, &vtk()] {
        let (code, rows) = at_numbers(files, "");
        assert_eq!((code, count(&rows, is_exact)), (Some(0), 3), "{rows:#?}");
        // v = (5/7) g t sin θ at t = 0.5 s. The tolerance is the Hertz overlap divided by the radius, plus the
        // oscillation of the contact spring.
        let velocity = rows.iter().find(|row| row["quantity"] == "velocity at the end").unwrap();
        let expected = 5.0 / 7.0 * 9.81 * 0.5 * 0.5;
        assert!((velocity["expected"].as_f64().unwrap() - expected).abs() < 1e-12 * expected, "{velocity}");
        let overlap = (0.75 * 4.0 / 3.0 * std::f64::consts::PI * 0.005_f64.powi(3) * 2500.0 * 9.81 * 0.75_f64.sqrt()
            / (5e6 / (2.0 * (1.0 - 0.09)) * 0.005_f64.sqrt()))
        .powf(2.0 / 3.0);
        let allowed = velocity["allowed"].as_f64().unwrap();
        assert!(allowed > overlap / 0.005 && allowed < 1.3 * overlap / 0.005, "{allowed:e} {:e}", overlap / 0.005);
    }
    for wrong in ["gravity.slope_deg=30.5", "gravity.magnitude=9.7"] {
        let set = format!("--set {wrong} --set grains.sphere.position=[0,0,.005]");
        let (code, rows) = at_numbers(&dump, &set);
        let red = count(&rows, |row| is_exact(row) && row["verdict"] == "fail");
        assert!(code == Some(1) && red >= 1, "{wrong}: {rows:#?}");
    }
}

/// A folder with a subfolder for each case or variant is checked with one command. Other files in it are reported.
#[test]
fn a_folder_of_outputs_is_judged_together() {
    let directory = temporary();
    let into = |place: &str, name: &str| directory.write(format!("runs/{place}/{name}"), fs::read(data(name)).unwrap());
    into("incline-disc/60deg-mu.9", "lammps-incline.dump.gz");
    into("backspin/sphere", "liggghts-backspin.dump.gz");
    let log = "liggghts-backspin.log";
    into("backspin/sphere", log);
    let folder = directory.join("runs/backspin/sphere");
    fs::rename(folder.join(log), folder.join("log.liggghts")).unwrap();
    let runs = directory.join("runs").display().to_string();
    let (code, rows) = judged(&format!("--all {runs}"));
    let passes = |case: &str| count(&rows, |row| row["case"] == case && row["verdict"] == "pass");
    assert!(code == Some(0) && passes("incline-disc") == 11 && passes("backspin") > 5, "{rows:#?}");
    // The content of a file decides if it is output, not its name. A file that is not judged is red, unless its name is ignored.
    let place = directory.join("runs/incline-disc/60deg-mu.9");
    fs::rename(place.join("lammps-incline.dump.gz"), place.join("dump.grains")).unwrap();
    for input in ["in.lammps", "data.grains", "manifest.json"] {
        place.write(input, "units si\n");
    }
    let (code, rows) = judged(&format!("--all {runs}"));
    assert_eq!((code, count(&rows, |row| row["case"] == "incline-disc")), (Some(0), 11), "{rows:#?}");
    place.write("notes.txt", "a run of yesterday\n");
    directory.write("runs/stray.dump", "");
    let (code, rows) = judged(&format!("--all {runs}"));
    let files: Vec<&Value> = rows.iter().filter(|row| row["case"] == "files").map(|row| &row["quantity"]).collect();
    let names = ["incline-disc/60deg-mu.9/notes.txt, not judged", "stray.dump, not judged"];
    assert_eq!((code, &files[..]), (Some(1), &names.map(Value::from).iter().collect::<Vec<_>>()[..]), "{rows:#?}");
    let (code, rows) = judged(&format!("--all {runs} --ignore notes.txt --ignore *.dump"));
    assert_eq!((code, count(&rows, |row| row["case"] == "files")), (Some(0), 0));
    fs::remove_file(place.join("notes.txt")).unwrap();
    fs::remove_file(directory.join("runs/stray.dump")).unwrap();
    fs::rename(place.join("dump.grains"), place.join("lammps-incline.dump.gz")).unwrap();
    into("incline-disc/60deg-mu.9", "lammps-incline-half-friction.dump.gz");
    fs::remove_file(directory.join("runs/incline-disc/60deg-mu.9/lammps-incline.dump.gz")).unwrap();
    assert_eq!(judged(&format!("--all {runs}")).0, Some(1));
    let refused = |folder: &Path, message: &str| {
        directory.run(format!("check --all {}", folder.display())).refused(message);
    };
    refused(&directory.join("nowhere"), "expected a folder that can be read");
    // The folder of a case without output is red, also if it contains only a log, or if no case has its name.
    let partly = directory.join("partly");
    for place in ["incline-disc/60deg-mu.9", "oblique-impact", "backspin/sphere", "incline-dics", "nine-discs/kappa"] {
        fs::create_dir_all(partly.join(place)).unwrap();
    }
    partly.write("oblique-impact/log.lammps", "timestep 1\n");
    fs::copy(folder.join("liggghts-backspin.dump.gz"), partly.join("backspin/sphere/dump.gz")).unwrap();
    fs::copy(folder.join("log.liggghts"), partly.join("backspin/sphere/log.liggghts")).unwrap();
    let (code, rows) = judged(&format!("--all {}", partly.display()));
    let red = |name: &str, message: &str| {
        let is_it = |row: &Value| row["quantity"] == format!("{name}, not judged") && row["verdict"] == "fail";
        count(&rows, |row| is_it(row) && row["detail"].as_str().unwrap().contains(message)) == 1
    };
    assert!(code == Some(1) && count(&rows, |row| row["case"] == "files") == 4, "{rows:#?}");
    assert!(red("incline-disc/60deg-mu.9", "found none") && red("oblique-impact", "found none"), "{rows:#?}");
    assert!(red("incline-dics", "did you mean `incline-disc`?") && red("nine-discs/kappa", "`kappa`"), "{rows:#?}");
    let ignored = "--ignore incline-* --ignore oblique-impact --ignore nine-discs";
    assert_eq!(judged(&format!("--all {} {ignored}", partly.display())).0, Some(0));
    fs::create_dir(directory.join("empty")).unwrap();
    refused(&directory.join("empty"), "expected outputs in its folders `CASE` or `CASE/VARIANT`, found none");
    into("backspinn", "liggghts-backspin.dump.gz");
    refused(&directory.join("runs"), "did you mean `backspin`?");
}

/// Returns the path of a file about a ball that bounces along a floor.
fn of_ball(name: &str) -> String {
    data(&format!("ball/{name}"))
}

/// Returns the exit code, the results and the messages of `check` with files of the ball.
fn ball(files: &[&str], more: &str) -> (Option<i32>, Vec<Value>, String) {
    let directory = temporary();
    let scene = of_ball(if files[0].starts_with("same-ids") { "two-balls.toml" } else { "ball.toml" });
    let files: Vec<String> = files.iter().map(|file| of_ball(file)).collect();
    let answer = directory.run(format!("check {scene} --json --power off --dump {} {more}", files.join(" ")));
    let rows = if answer.out.is_empty() { Vec::new() } else { answer.rows() };
    (answer.code, rows, answer.err)
}

fn fails(rows: &[Value]) -> usize {
    count(rows, |row| row["verdict"] == "fail")
}

/// A log contains two runs with different time steps. `check` finds the time steps in the log, in the times of the
/// dump, or in both.
#[test]
fn each_run_of_a_log_has_its_own_time_step() {
    let log = of_ball("twosteps.log.gz");
    let log = format!("--log {log}");
    for (file, more) in [("twosteps.dump.gz", &*log), ("twosteps-time.dump.gz", &log), ("twosteps-time.dump.gz", "")] {
        let (code, rows, err) = ball(&[file], more);
        assert_eq!((code, fails(&rows), rows.len()), (Some(0), 0, 10), "{err}{rows:#?}");
        assert_eq!(rows[1]["resolution"], "dt=0.00001 s to 0.00002 s", "{}", rows[1]);
    }
    // With one time step for all steps, the output belongs to another motion.
    assert_eq!(ball(&["twosteps.dump.gz"], "--time-step 2e-5").0, Some(1));
}

#[test]
fn a_run_that_starts_late_counts_from_its_first_sample() {
    let (code, rows, err) = ball(&["late-start.dump.gz"], "--time-step 1e-5");
    assert_eq!((code, fails(&rows), rows.len()), (Some(0), 0, 10), "{err}{rows:#?}");
    assert!(rows[0]["because"].as_str().unwrap().contains("first sample, step 3000000000 (t = 30000"), "{}", rows[0]);
}

/// A difference between the times of log and table is accepted if it is within their printed digits.
#[test]
fn a_rounded_time_step_in_a_log_is_accepted() {
    let directory = temporary_with("log.lammps", "timestep 1.0001e-5\nStep KinEng\n0 0\n");
    directory.write("table.csv", "step,time,ball.x\n0,0,0\n400,0.004,0.0008\n");
    assert_ne!(directory.run(format!("check {} --power off --dump table.csv", of_ball("ball.toml"))).code, Some(2));
}

#[test]
fn whole_frames_of_a_cut_off_dump_are_judged_where_that_is_meant() {
    let (code, rows, _) = ball(&["cut-off.dump.gz"], "--time-step 1e-5 --partial");
    assert_eq!((code, fails(&rows), rows.len()), (Some(0), 0, 10), "{rows:#?}");
    assert_eq!(rows[0]["verdict"], "known");
    assert!(rows[0]["detail"].as_str().unwrap().contains("cut-off.dump.gz:361: expected a step"), "{}", rows[0]);
    let directory = temporary();
    let cut = of_ball("cut-off.dump.gz");
    for words in [format!("compare {cut} {cut}"), format!("fields {cut} --cell 0.02 --time-step 1e-5")] {
        let answer = directory.ok(format!("{words} --partial"));
        assert!((answer.out + &answer.err).contains("cut-off.dump.gz:361: expected a step"));
    }
}

/// In tables of ParaView, `TimeStep` is the number of a frame, and `Time` is in seconds. A table for one time contains no time.
#[test]
fn tables_of_grains_are_read_as_grains() {
    let (code, rows, err) = ball(&["paraview-all.csv.gz"], "--time-step 1e-5");
    assert_eq!((code, fails(&rows), rows.len()), (Some(0), 0, 10), "{err}{rows:#?}");
    let series =
        ["series/ball_0.csv", "series/ball_1.csv", "series/ball_2.csv", "series/ball_3.csv", "series/ball_4.csv"];
    let (code, rows, err) = ball(&series, "--time-step 1e-5 --frame-interval 0.002 --partial");
    assert_eq!((code, fails(&rows), rows.len()), (Some(0), 0, 10), "{err}{rows:#?}");
    let (code, rows, _) = ball(&series, "--time-step 1e-5 --frame-interval 0.003 --partial");
    assert!(code == Some(1) && fails(&rows) > 0);
}

/// Output in other units than SI is rejected. Two files in the same units can be compared.
#[test]
fn units_are_those_of_the_scene_or_of_the_other_file() {
    let lj = format!("ITEM: UNITS\nlj\n{}", flight(0, &|_, _| {}));
    checked_flight(&lj, "").refused("expected the units `si`");
    assert_eq!(checked_flight(&lj.replace("\nlj\n", "\nsi\n"), "").code, Some(0));
    let cgs = of_ball("cgs.dump.gz");
    temporary().ok(format!("compare {cgs} {cgs}"));
}

/// Rejects a time step at or above the critical one, because our solvers would be unstable and give no reference.
#[test]
fn a_time_step_above_the_critical_one_is_refused() {
    let text = "time,ball.x,ball.y,ball.z\n0,0,0,0.02\n0.004,0.0008,0,0.0179215\n";
    let directory = temporary_with("coarse.csv", text);
    let check = format!("check {} --dump coarse.csv --partial", of_ball("ball.toml"));
    assert_ne!(directory.run(format!("{check} --time-step 2e-3 --allow-unstable")).code, Some(2));
    // The critical time step itself is rejected too, as in `simulate`.
    let scene = SceneSource::read(Path::new(&of_ball("ball.toml"))).unwrap().scene(&read_grains).unwrap();
    let critical = format!("{:?}", scene.critical_time_step());
    directory.run(format!("{check} --time-step {critical}")).refused("expected a time step below the critical one");
}

/// The ball sticks to the floor during contact. Friction therefore has almost no effect, but dashpot and spring have.
#[test]
fn a_check_lists_the_changes_that_the_output_would_reveal() {
    let directory = temporary();
    let checked = |how: &str| {
        let (scene, dump, log) = (of_ball("ball.toml"), of_ball("twosteps.dump.gz"), of_ball("twosteps.log.gz"));
        directory.run(format!("check {scene} --dump {dump} --log {log} --power {how} --json")).judged()
    };
    for how in ["limited", "full"] {
        let (code, rows) = checked(how);
        let row_of =
            |effect: &str| rows.iter().find(|row| row["quantity"].as_str().unwrap().starts_with(effect)).unwrap();
        assert_eq!(code, Some(0), "{rows:#?}");
        assert_eq!(row_of("friction: ")["detail"], "friction: ±25\u{202f}% cannot be detected in this output");
        let damping = row_of("contact damping: ");
        assert_eq!((&damping["verdict"], &damping["value"]), (&"pass".into(), &0.1.into()), "{damping}");
        assert_eq!(row_of("stiffness: ")["verdict"], "pass");
    }
    assert_eq!(checked("off").1.len(), 10);
}

/// Three discs that fly apart, in a scene without a probe of a grain.
const FLIGHT: &str = include_str!("../scenes/flying-discs.toml");

/// Row of a dump: x, y, z, vx, vy, vz, omegax, omegay, omegaz.
type Row = [f64; 9];
/// Function that changes the three rows of a sample. The first argument is the number of the sample.
type Change<'a> = &'a dyn Fn(u32, &mut [Row; 3]);

/// Returns a dump of the discs with a time step of 1 ms. `from` is the first step; `change` changes the rows of each sample.
fn flight(from: u32, change: &dyn Fn(u32, &mut [Row; 3])) -> String {
    let mut text = String::new();
    for sample in 0..=10 {
        let time = f64::from(sample) * 0.01;
        let row = |x: f64, y: f64, vx: f64, vy: f64, spin: f64| {
            [x + vx * time, y + vy * time, 0.0, vx, vy, 0.0, 0.0, 0.0, spin]
        };
        let mut rows =
            [row(0.25, 0.5, 0.5, 0.25, 2.0), row(1.5, -0.25, -0.25, 1.0, 0.0), row(3.0, 1.0, 0.0, -0.5, -1.0)];
        change(sample, &mut rows);
        text.push_str(&format!(
            "ITEM: TIMESTEP\n{}\nITEM: NUMBER OF ATOMS\n3\nITEM: BOX BOUNDS pp ff pp\n0 4\n-2 2\n-0.5 0.5\n\
             ITEM: ATOMS id x y z vx vy vz omegax omegay omegaz\n",
            from + 10 * sample
        ));
        for (grain, row) in rows.iter().enumerate() {
            let numbers: Vec<String> = row.iter().map(|number| format!("{number:?}")).collect();
            text.push_str(&format!("{} {}\n", grain + 1, numbers.join(" ")));
        }
    }
    text
}

/// Checks a dump of the three discs, and returns the output of the command.
fn checked_flight(dump: &str, more: &str) -> Answer {
    checked_scene(FLIGHT, dump, more)
}

fn checked_scene(scene: &str, dump: &str, more: &str) -> Answer {
    let directory = temporary_with("flight.toml", scene);
    directory.write("flight.dump", dump);
    directory.run(format!("check flight.toml --dump flight.dump --time-step 1e-3 --power off {more}"))
}

/// The first sample is compared with the initial state of all grains, with or without probes.
#[test]
fn every_grain_starts_as_in_the_scene() {
    let right: [(u32, Change<'_>); 3] = [
        (0, &|_, _| {}),
        // A run whose steps do not begin at zero, and a grain that is shifted by one period.
        (700, &|_, _| {}),
        (0, &|_, rows| rows[1][0] += 4.0),
    ];
    for (from, change) in right {
        let answer = checked_flight(&flight(from, change), "");
        assert_eq!(answer.code, Some(0), "{}{}", answer.out, answer.err);
    }
    let wrong: [(Change<'_>, &str); 6] = [
        (&|_, rows| rows.iter_mut().for_each(|row| row.swap(0, 1)), "x of grain 1 = 0.25 m; found 0.5 m"),
        (&|_, rows| rows.iter_mut().for_each(|row| row.swap(3, 4)), "vx of grain 1 = 0.5 m/s; found 0.25 m/s"),
        (&|_, rows| rows[2][1] += 1e-6, "y of grain 3 = 1.0 m; found 1.000001 m"),
        (&|_, rows| rows[2][8] = 0.0, "omegaz of grain 3 = -1.0 rad/s; found 0.0 rad/s"),
        (&|_, rows| rows.iter_mut().for_each(|row| *row = [0.0; 9]), "x of grain 1 = 0.25 m; found 0.0 m"),
        (&|_, rows| rows.swap(0, 1), "x of grain 1 = 0.25 m; found 1.5 m"),
    ];
    for (change, message) in wrong {
        for (from, more) in [(0, ""), (0, "--partial"), (700, "")] {
            checked_flight(&flight(from, change), more).refused(message);
        }
    }
    // Six digits are enough if the numbers have no more digits.
    let six =
        flight(0, &|_, rows| rows.iter_mut().flatten().for_each(|number| *number = (*number * 1e5).round() / 1e5));
    assert_eq!(checked_flight(&six, "").code, Some(0));
}

/// Grains of a two-dimensional scene must stay in their plane.
#[test]
fn motion_out_of_the_plane_is_refused() {
    let wrong: [(Change<'_>, &str); 4] = [
        (
            &|sample, rows| rows[1][2] = 1e-3 * f64::from(sample),
            "grain 2 in the plane of the scene, with `z` = 0.0, found 0.001",
        ),
        (&|_, rows| rows[2][5] = 3.0, "grain 3 in the plane of the scene, with `vz` = 0.0, found 3.0"),
        (&|sample, rows| rows[0][6] = f64::from(sample), "`omegax` = 0.0, found 1.0"),
        (&|sample, rows| rows[0][7] = f64::from(sample / 5), "`omegay` = 0.0, found 1.0"),
    ];
    for (change, message) in wrong {
        checked_flight(&flight(0, change), "").refused(message);
    }
    // The plane may be at any height, and rounding errors do not count as motion out of the plane.
    let right = flight(0, &|sample, rows| (rows[1][2], rows[1][5]) = (0.25 + 1e-17 * f64::from(sample), 1e-15));
    assert_eq!(checked_flight(&right, "").code, Some(0));
}

/// The sampling interval in the scene file limits the interval between samples. No option replaces it.
#[test]
fn no_option_allows_samples_far_apart() {
    let whole = flight(0, &|_, _| {});
    let mut samples = whole.split_inclusive("ITEM: TIMESTEP\n");
    let head = samples.next().unwrap();
    let ends = [samples.next().unwrap(), samples.last().unwrap()].concat();
    let ends = format!("{head}{ends}");
    let set = "--set output.every=1";
    assert_eq!(checked_flight(&ends, "").code, Some(1));
    assert_eq!(checked_flight(&ends, set).code, Some(1));
    let own = FLIGHT.replace("every = 0.01", "every = 0.1");
    assert_eq!(checked_scene(&own, &ends, "").code, Some(0));
    assert_eq!(checked_scene(&own, &ends, set).code, Some(0));
}

/// A sample at a time between two steps counts as missing and is reported.
#[test]
fn a_sample_between_steps_is_missing() {
    let disc = include_str!("../scenes/disc.toml").replace("duration = 0.01", "duration = 0.04");
    let directory = temporary_with("s.toml", disc);
    let judged = |time: &str| {
        // 20 samples are 2000 steps apart. A further sample after one step makes our run sample every step.
        let row = |step: u32, time: &str| format!("{step},{time},{:.6},1.000000\n", f64::from(step) * 1e-6);
        let other = |step: u32| row(step, &format!("{:.6}", f64::from(step) * 1e-6));
        let rows: String =
            (0..=20)
                .map(|at| {
                    if at == 10 { row(20_000, time) } else { other(2000 * at) + &other(1).repeat(usize::from(at == 0)) }
                })
                .collect();
        let table = format!("step,time,a.x,a.vx\n{rows}");
        directory.write("t.csv", table);
        let rows = directory.run("check s.toml --dump t.csv --dt 1e-6 --power off --json").rows();
        rows.into_iter().find(|row| row["quantity"].as_str().unwrap().starts_with("a.x, worst of")).unwrap()
    };
    assert_eq!(judged("0.020000")["verdict"], "pass");
    let row = judged("0.02000002");
    assert!(row["verdict"] != "pass" && row["detail"].to_string().contains("1 samples are not compared"), "{row}");
}

/// A file agrees with itself, whatever its number of digits is.
#[test]
fn a_file_is_equal_to_itself() {
    let directory = temporary_with("a.csv", "time,x,q\n0.0,0.0,0.0\n1.0,2.0,0.3\n2.0,7.0,0.1\n");
    let rows = directory.run("compare a.csv a.csv --json").rows();
    assert!(rows.iter().all(|row| row["verdict"] == "pass"), "{rows:#?}");
    directory.write("b.csv", "time,x,q\n0.0,0.0,0.00\n1.0,2.0,0.30\n2.0,7.0,0.10\n");
    let answer = directory.run("compare a.csv b.csv --json");
    assert!(answer.out.contains("inconclusive"), "the second file has more digits: {}", answer.out);
}
