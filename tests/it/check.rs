//! `check` and `compare` with output of external solvers, and with output that cannot be judged.

use crate::common::{Directory, count, data, temporary, temporary_with, unpacked};
use serde_json::Value;

/// Returns the exit code and the results of `check` on a stored dump.
fn check(case: &str, dump: &str, more: &str) -> (i32, Vec<Value>) {
    let directory = temporary();
    let dump = data(dump);
    let answer = directory.run(format!("check {case} --dump {dump} --json {more}"));
    assert_eq!(answer.err, "");
    assert!(directory.join("grainbench-out/index.html").is_file());
    (answer.code.unwrap(), answer.rows())
}

/// Returns the exit code and the results of `check` on a changed dump of a disc on an incline.
fn check_text(dump: &str, more: &str) -> (Option<i32>, Vec<Value>) {
    let directory = temporary_with("changed", dump);
    directory.run(format!("check incline-disc/60deg-mu.9 --dump changed --json {more}")).judged()
}

#[test]
fn what_is_right_passes_by_exact_answers_and_by_our_solvers() {
    let (code, rows) = check("incline-disc/60deg-mu.9", "lammps-incline.dump.gz", "");
    assert_eq!((code, count(&rows, "pass"), rows.len()), (0, 11, 11));
    assert_eq!(rows.iter().filter(|row| row["evidence"] == "analytic").count(), 3);
    let (code, rows) = check("incline-disc/60deg-mu.9", "lammps-2025-granular-incline.dump.gz", "");
    assert_eq!((code, count(&rows, "pass"), rows.len()), (0, 11, 11));
}

#[test]
fn six_digits_in_odd_order_pass_with_a_wider_tolerance_that_says_so() {
    let (code, full) = check("incline-disc/60deg-mu.9", "lammps-incline.dump.gz", "");
    let (six_code, six) = check("incline-disc/60deg-mu.9", "lammps-incline-six-digits.dump.gz", "");
    assert_eq!((code, six_code, count(&six, "pass"), six.len()), (0, 0, 9, 9));
    for (full, six) in full.iter().zip(&six).filter(|(row, _)| row["evidence"] == "analytic") {
        let allowed = |row: &Value| row["allowed"].as_f64().unwrap();
        assert!(allowed(six) > allowed(full) && allowed(six) < 3e-5, "{six}");
    }
    let directory = temporary();
    let dump = data("lammps-incline-six-digits.dump.gz");
    let answer = directory.run(format!("check incline-disc/60deg-mu.9 --dump {dump}"));
    assert!(answer.out.contains("for the printed digits, at most 6"), "{}", answer.out);
}

#[test]
fn half_the_friction_is_red() {
    let (code, rows) = check("incline-disc/60deg-mu.9", "lammps-incline-half-friction.dump.gz", "");
    assert_eq!((code, count(&rows, "fail")), (1, 7));
}

/// Output of a released LAMMPS version whose walls are wrong: the friction is wrong by about 10⁻⁴, or values are NaN.
#[test]
fn a_released_defect_is_red() {
    let (code, rows) = check("incline-disc/60deg-mu.9", "lammps-2025-incline.dump.gz", "");
    assert_eq!((code, count(&rows, "fail")), (1, 7));
    let analytic = rows.iter().filter(|row| row["evidence"] == "analytic");
    assert!(analytic.into_iter().all(|row| row["verdict"] == "fail" && row["error"].as_f64().unwrap().abs() < 1e-3));
}

/// Output of the LAMMPS version with wrong walls, for an oblique impact. Walls of the kind `granular` are correct in
/// this version.
#[test]
fn a_released_defect_is_red_in_an_oblique_impact_too() {
    for (dump, code, red) in [
        ("lammps-oblique.dump.gz", 0, 0),
        ("lammps-2025-granular-oblique.dump.gz", 0, 0),
        ("lammps-2025-oblique.dump.gz", 1, 6),
    ] {
        let (found, rows) = check("oblique-impact/damped", dump, "");
        assert_eq!((found, count(&rows, "fail"), rows.len()), (code, red, 11), "{dump}");
        // There is no exact reference, because the solution of a damped impact depends on the dashpot.
        let stored = rows.iter().filter(|row| row["source"].as_str().unwrap().contains("stored run of 20"));
        assert_eq!(stored.count(), 5, "{dump}");
    }
    // The velocity along the wall is 3.8878 m/s. The stored LAMMPS run has 3.1267 m/s.
    let (_, rows) = check("oblique-impact/damped", "lammps-2025-oblique.dump.gz", "");
    let of_stored = |row: &&Value| row["quantity"].as_str().unwrap().contains("stored samples");
    let along =
        rows.iter().filter(of_stored).find(|row| row["quantity"].as_str().unwrap().starts_with("grain.vx")).unwrap();
    assert!((along["value"].as_f64().unwrap() - 3.8878).abs() < 1e-3, "{along}");
    assert!(along["error"].as_f64().unwrap() > 0.19, "{along}");
}

#[test]
fn the_time_step_comes_from_the_log_or_is_asked_for() {
    let log = data("liggghts-backspin.log");
    let (code, rows) = check("backspin/sphere", "liggghts-backspin.dump.gz", &format!("--log {log}"));
    // The stored run has a longer time step, which changes the impact by more than 5 %, so these results are amber.
    assert_eq!((code, count(&rows, "pass"), count(&rows, "fail"), rows.len()), (0, 16, 0, 19));
    let (code, rows) = check("backspin/sphere", "liggghts-backspin.dump.gz", "--time-step 2e-4");
    assert_eq!((code, count(&rows, "pass"), count(&rows, "fail"), rows.len()), (0, 16, 0, 19));
    // With another time step, the times of the output belong to another motion.
    let (code, rows) = check("backspin/sphere", "liggghts-backspin.dump.gz", "--time-step 3e-4");
    assert!(code == 1 && count(&rows, "fail") > 2);
}

/// A table with other column names is compared too.
#[test]
fn a_table_is_judged_too() {
    let directory = temporary();
    let mut text = "time;way;speed\n".to_owned();
    // A rigid disc that rolls down this slope has v = (2/3) g sin 60° t.
    for step in 0..=100 {
        let (t, a) = (f64::from(step) * 0.01, 2.0 / 3.0 * 9.8 * 60_f64.to_radians().sin());
        text.push_str(&format!("{t};{:e};{:e}\n", 0.5 * a * t * t, a * t));
    }
    directory.write("mine.csv", text);
    let how = "--map x=way,vx=speed --time-step 1e-4 --json";
    let (code, rows) = directory.run(format!("check incline-disc/60deg-mu.9 --dump mine.csv {how}")).judged();
    let row_of =
        |quantity: &str| rows.iter().find(|row| row["quantity"].as_str().unwrap().starts_with(quantity)).unwrap();
    // The rigid solution lacks the oscillation of the soft contacts of the scene. Its displacement differs by less than our
    // conventions differ.
    let verdicts = (&row_of("grain.x")["verdict"], &row_of("grain.vx")["verdict"]);
    assert_eq!(verdicts, (&"no-reference".into(), &"fail".into()));
    assert_eq!((rows.len(), code), (5, Some(1)));
}

/// Names of columns for contact forces, from a contact dump and from wall columns with other names.
const CONTACTS: &str =
    "id1=c_2[1],id2=c_2[2],force_x=c_1[3],force_y=c_1[4],bottom.force_x=f_wall3[2],bottom.force_y=f_wall3[3]";

#[test]
fn forces_at_contacts_are_judged_where_a_dump_tells_them() {
    let judged = |name: &str, more: &str| {
        let contacts = data(&format!("{name}.contacts.gz"));
        check("nine-discs/static-0", &format!("{name}.dump.gz"), &format!("--dump {contacts} {more}"))
    };
    let forces = |rows: &[Value], verdict: &str| {
        let of_forces = |row: &&Value| row["evidence"] == "analytic" && row["unit"] == "N";
        rows.iter().filter(of_forces).filter(|row| row["verdict"] == verdict).count()
    };
    // Three snapshots show only the end of the run.
    let (code, rows) = judged("lammps-nine-static", &format!("--map {CONTACTS} --partial"));
    assert_eq!((code, forces(&rows, "pass"), count(&rows, "fail")), (0, 4, 0), "{rows:#?}");
    let (code, rows) = judged("lammps-nine-static-stiffer", &format!("--map {CONTACTS}"));
    assert_eq!((code, forces(&rows, "fail")), (1, 4));
    // A dump of grains only contains no forces.
    let (_, rows) = check("nine-discs/static-0", "lammps-nine-static.dump.gz", "");
    assert_eq!(forces(&rows, "no-reference"), 4, "{rows:#?}");
}

#[test]
fn two_outputs_against_each_other() {
    let directory = temporary();
    let compare = |a: &str, b: &str| directory.run(format!("compare {} {} --json", data(a), data(b)));
    // A file that is scaled and rounded to six digits contains the same motion.
    let same = compare("lammps-incline.dump.gz", "lammps-incline-six-digits.dump.gz");
    assert_eq!((same.code, count(&same.rows(), "pass"), count(&same.rows(), "fail")), (Some(0), 8, 0));
    // Columns that exist only in the first file are listed.
    let alone = |row: &Value| row["detail"].as_str().is_some_and(|words| words.starts_with("only "));
    assert_eq!(same.rows().iter().filter(|row| alone(row)).count(), same.rows().len() - 8);
    let other = compare("lammps-incline.dump.gz", "lammps-incline-half-friction.dump.gz");
    assert_eq!(other.code, Some(1));
    assert!(count(&other.rows(), "fail") >= 3);
    assert!(directory.join("grainbench-out/index.html").is_file());
}

/// `check` reports a dump with only the first half of the snapshots as incomplete.
#[test]
fn half_a_run_is_not_judged_as_the_whole() {
    let whole = unpacked("lammps-incline.dump.gz");
    let snapshots: Vec<&str> = whole.split_inclusive("ITEM: TIME\n").collect();
    assert!(snapshots.len() > 90, "{}", snapshots.len());
    let half = snapshots[..50].concat();
    let checked = |more: &str| check_text(half.trim_end_matches("ITEM: TIME\n"), more);
    let (code, rows) = checked("");
    assert_eq!((code, &rows[0]["verdict"], count(&rows, "fail")), (Some(1), &"fail".into(), 1), "{rows:#?}");
    assert_eq!(rows[0]["expected"]["at_least"], 1.0);
    for row in &rows[1..] {
        let (quantity, verdict) = (row["quantity"].as_str().unwrap(), &row["verdict"]);
        if row["evidence"] == "analytic" {
            assert_eq!(verdict, "no-reference", "{quantity}");
        } else {
            assert!(quantity.contains("samples to t = 0.4") && verdict == "pass", "{row}");
        }
    }
    let (code, rows) = checked("--partial");
    assert_eq!((code, &rows[0]["verdict"]), (Some(0), &"known".into()));
    assert_eq!(checked("--partial --strict").0, Some(1));
}

/// The first and the last snapshot are not enough to judge a run. Every tenth snapshot is enough.
#[test]
fn samples_far_apart_judge_no_course() {
    let whole = unpacked("lammps-incline.dump.gz");
    let snapshots: Vec<&str> = whole.split_inclusive("ITEM: TIME\n").collect();
    let checked = |kept: &dyn Fn(usize) -> bool, more: &str| {
        // Each part ends with the first line of the next snapshot. The first part contains no snapshot.
        let kept: String = (1..snapshots.len()).filter(|at| kept(at - 1)).map(|at| snapshots[at]).collect();
        check_text(&format!("{}{}", snapshots[0], kept.trim_end_matches("ITEM: TIME\n")), more)
    };
    let last = snapshots.len() - 2;
    let is_end = move |at: usize| at == 0 || at == last;
    let (code, rows) = checked(&is_end, "");
    assert_eq!((code, count(&rows, "pass")), (Some(1), 4), "{rows:#?}");
    // Values at the end are still judged, because missing samples in between do not change them.
    assert!(rows[1..].iter().all(|row| (row["evidence"] == "analytic") == (row["verdict"] == "pass")), "{rows:#?}");
    let detail = rows.iter().find(|row| row["verdict"] == "fail").unwrap()["detail"].as_str().unwrap();
    assert!(detail.starts_with("no sample for 1 s from t = 0 s; at most 0.1"), "{detail}");
    let (code, rows) = checked(&is_end, "--partial");
    assert_eq!((code, count(&rows, "fail"), count(&rows, "known")), (Some(0), 0, 7), "{rows:#?}");
    let (code, rows) = checked(&|at| at % 10 == 0, "");
    assert_eq!((code, count(&rows, "fail")), (Some(0), 0), "{rows:#?}");
    // Two tenths of the samples are missing in the middle of the run.
    let (code, rows) = checked(&|at| !(31..50).contains(&at), "");
    assert_eq!((code, count(&rows, "fail")), (Some(1), 7), "{rows:#?}");
}

/// A sampling interval set by the user does not replace the sampling interval of the case.
#[test]
fn an_interval_of_the_caller_does_not_excuse_missing_samples() {
    let directory = temporary();
    let whole = unpacked("liggghts-backspin.dump.gz");
    let snapshots: Vec<&str> = whole.split("ITEM: TIMESTEP\n").collect();
    let ends = ["", snapshots[1], snapshots[snapshots.len() - 1]].join("ITEM: TIMESTEP\n");
    directory.write("ends", ends);
    for more in ["", "--set output.every=1"] {
        let answer = directory.run(format!("check backspin/sphere --dump ends --time-step 2e-4 --json {more}"));
        let rows = answer.rows();
        let details =
            rows.iter().filter(|row| row["verdict"] == "fail").map(|row| row["detail"].as_str().unwrap_or_default());
        let gaps = details.filter(|detail| detail.starts_with("no sample for")).count();
        assert!(answer.code == Some(1) && gaps > 0, "{more:?}: {}", answer.out);
    }
}

/// A sample between two steps has no counterpart in our runs. The result is red, because all other samples are then not compared.
#[test]
fn a_time_between_two_steps_is_red() {
    let whole = unpacked("lammps-incline.dump.gz");
    let time = whole.split("ITEM: TIME\n").nth(50).unwrap().lines().next().unwrap();
    for off in [1e-4, 3e-3] {
        let moved = format!("ITEM: TIME\n{:?}\n", time.parse::<f64>().unwrap() + off * 0.01);
        let text = whole.replacen(&format!("ITEM: TIME\n{time}\n"), &moved, 1);
        let checked = |more: &str| {
            let (code, mut rows) = check_text(&text, more);
            rows.retain(|row| row["quantity"] == "comparison with our solvers");
            (code, rows)
        };
        let (code, rows) = checked("");
        assert_eq!((code, count(&rows, "fail")), (Some(1), 1), "{off}: {rows:#?}");
        assert!(rows[0]["detail"].as_str().unwrap().contains("is not a whole number of steps"), "{rows:#?}");
        let (code, rows) = checked("--partial");
        assert_eq!((code, count(&rows, "no-reference")), (Some(0), 1), "{off}: {rows:#?}");
    }
}

/// Masses may be rounded to six digits, and a snapshot or a row may occur twice with the same numbers.
#[test]
fn rounded_and_repeated_numbers_are_judged() {
    let directory = temporary();
    let write = |name: &str, text: &str| directory.write(name, text);
    let whole = unpacked("lammps-incline.dump.gz");
    write("rounded", &whole.replace("\n1 1 0.5 2356.1944901923448 ", "\n1 1 0.5 2356.19 "));
    write("same", &format!("{whole}{}", &whole[whole.rfind("ITEM: TIME\n").unwrap()..]));
    write("once.csv", "time,x\n0,1.0000\n1,2.0000\n2,2.5000\n");
    write("again.csv", "time,x\n0,1.0000\n1,2.0000\n2,2.5000\n2,2.5000\n");
    directory.ok("check incline-disc/60deg-mu.9 --dump rounded");
    directory.ok("check incline-disc/60deg-mu.9 --dump same");
    directory.ok("compare once.csv again.csv");
}

/// With three digits, the file agrees with two initial states of the variant. The nearer one is used for the exact solutions.
#[test]
fn few_digits_take_no_other_start() {
    let whole = unpacked("lammps-incline.dump.gz");
    for digits in [3, 4] {
        let word = |word: &str| match word.parse::<f64>() {
            Ok(value) if word.contains('.') => format!("{value:.*e}", digits - 1),
            _ => word.to_owned(),
        };
        let row = |line: &str| line.split(' ').map(word).collect::<Vec<_>>().join(" ");
        let line = |line: &str| if line.starts_with("1 1 ") { row(line) } else { line.to_owned() };
        let text: String = whole.lines().map(|text| line(text) + "\n").collect();
        let (_, rows) = check_text(&text, "");
        let exact = rows.iter().filter(|row| row["evidence"] == "analytic").count();
        assert_eq!((exact, count(&rows, "fail")), (3, 0), "{digits}: {rows:#?}");
    }
}

/// A result is amber if its tolerance exceeds a twentieth of the scale. A check without any judged result is not a success.
#[test]
fn what_cannot_be_told_is_amber() {
    let directory = temporary();
    let checked = |text: &str| {
        directory.write("mine.csv", text);
        directory.run("check collision/gamma-zeta.1 --dump mine.csv --time-step 1e-5 --json").judged()
    };
    let (code, rows) = checked("time,a.x\n0,-1\n0.03,-1\n0.06,-1\n");
    assert_eq!((code, count(&rows[1..], "no-reference"), rows.len()), (Some(1), 2, 3), "{rows:#?}");
    assert!(rows[1]["detail"].as_str().unwrap().starts_with("inconclusive: "), "{}", rows[1]);
    let (code, rows) = checked("time,contact.overlap\n0,0\n0.06,0\n");
    assert_eq!((code, rows.len(), &rows[1]["verdict"]), (Some(1), 2, &"no-reference".into()), "{rows:#?}");
}

#[test]
fn outputs_are_compared_in_time_where_their_steps_differ() {
    let directory = temporary();
    let write = |name: &str, head: &str, step: f64, count: u32, shift: f64| {
        let row = |k: u32| {
            let t = f64::from(k) * step;
            format!("{t:.12},{:.12},{}\n", (3.0 * t).sin() + shift, if shift > 0.0 { "0.04" } else { "0.0" })
        };
        let text: String = (0..=count).map(row).collect();
        directory.write(name, format!("{head}\n{text}"));
    };
    write("a.csv", "time,x,f", 0.01, 100, 0.0);
    write("b.csv", "time,x,f", 0.003, 334, 0.0);
    write("off.csv", "time,x,f", 0.003, 334, 1e-3);
    write("short.csv", "time,x,f", 0.01, 50, 0.0);
    write("named.csv", "t,way,g", 0.003, 334, 0.0);
    let compared = |arguments: &str| {
        let answer = directory.run(format!("compare {arguments} --json"));
        (answer.code.unwrap(), answer.rows())
    };
    let (code, rows) = compared("a.csv b.csv --tolerance 1e-5");
    assert_eq!((code, count(&rows, "pass")), (0, 4), "{rows:#?}");
    // Linear interpolation between samples has an error of h² x''/8 = 9 h²/8. The tested shift is about 100 times as large.
    assert!(rows[2]["allowed"].as_f64().unwrap() < 1.2 * (1e-5 + 9.0 * 0.003 * 0.003 / 8.0), "{}", rows[2]);
    let (code, rows) = compared("a.csv off.csv --tolerance 1e-5 --columns x");
    assert_eq!((code, count(&rows, "fail"), rows.len()), (1, 1, 3), "{rows:#?}");
    // In a file with more digits elsewhere, `0.0` is a whole number and not a number with one digit.
    let (code, rows) = compared("a.csv off.csv --columns f");
    assert_eq!((code, &rows[2]["verdict"]), (1, &"fail".into()), "{rows:#?}");
    let (code, rows) = compared("a.csv short.csv");
    assert_eq!((code, count(&rows[..2], "fail"), count(&rows[2..], "pass")), (1, 2, 2), "{rows:#?}");
    let (code, rows) = compared("a.csv short.csv --partial");
    assert_eq!((code, count(&rows[..2], "known")), (0, 2), "{rows:#?}");
    assert_eq!(compared("a.csv named.csv --tolerance 1e-5 --map x=way,f=g,time=t").0, 0);
}

/// The digits of each row count. Few digits in one row do not hide a difference in another row, and no row is left out.
#[test]
fn a_difference_is_judged_by_half_a_unit_of_the_last_digit() {
    let directory = temporary();
    let compared = |a: &str, b: &str, more: &str| {
        directory.write("a.csv", a);
        directory.write("b.csv", b);
        let answer = directory.run(format!("compare a.csv b.csv --json {more}"));
        let rows = answer.rows()[2..].to_vec();
        let verdicts: Vec<String> = rows.iter().map(|row| row["verdict"].as_str().unwrap().to_owned()).collect();
        (answer.code.unwrap(), verdicts.join(" "), rows)
    };
    // Whole numbers are exact.
    let (code, verdicts, rows) = compared("step,n\n0,3\n1,3\n", "step,n\n0,3\n1,4\n", "");
    assert_eq!((code, verdicts.as_str()), (1, "fail"), "{rows:#?}");
    // The digits of a small value determine its uncertainty, whatever the digits of a large value in the column are.
    let (code, verdicts, rows) = compared("step,v\n0,1.2e6\n1,0.02\n", "step,v\n0,1.2e6\n1,3.5\n", "");
    assert_eq!((code, verdicts.as_str()), (1, "fail"), "{rows:#?}");
    // If the digits of a column have an uncertainty above 5 % of the scale, this is reported and is not a success.
    let (code, verdicts, rows) = compared("step,v\n0,0.1\n1,0.4\n", "step,v\n0,0.1\n1,0.44\n", "");
    assert_eq!((code, verdicts.as_str()), (1, "no-reference"), "{rows:#?}");
    assert!(rows[0]["detail"].as_str().unwrap().starts_with("inconclusive: "), "{rows:#?}");
    // Columns that exist in only one file are listed. Equal grain types alone do not count as a comparison.
    let (code, verdicts, rows) = compared("step,type,v\n0,1,2.5\n", "step,type,w\n0,1,2.5\n", "");
    assert_eq!((code, verdicts.as_str()), (1, "pass no-reference no-reference"), "{rows:#?}");
    assert_eq!(rows[1]["detail"], "only a.csv has this column");
    // Equal sizes and masses alone do not count as a comparison, because no run changes them.
    let table = |name: &str| format!("step,n,radius,mass,{name}\n0,1,0.5,2,1\n1,1,0.5,2,3\n");
    assert_eq!(compared(&table("v").replace(",n,", ",id,"), &table("w").replace(",n,", ",id,"), "").0, 1);
    assert_eq!(compared(&table("v"), &table("w"), "").0, 0);
    // An option with one value does not take the next argument as a second value.
    assert_eq!(compared("step,v\n0,0.512345\n", "step,v\n0,0.512345\n", "--time-step 1e-5 --partial").0, 0);
}
