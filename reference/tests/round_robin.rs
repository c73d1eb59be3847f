//! Round robin of bulk processes: quantities derived from the user's tables, and tables that are refused.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use grainbench_reference::round_robin::{Kind, PublishedTable, of_drum, of_drums, of_impact, read};
use std::fmt::Write as _;

fn published(name: &str, text: &str) -> Result<Option<PublishedTable>, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, text).unwrap();
    read(&path).map_err(|error| error.to_string())
}

/// Returns the height of a ball in free flight that decelerates from 21 ms on. It is `print` (m) above free flight at
/// 22 ms, and `stop` (m) at the end.
fn course(time: f64, speed: f64, print: f64, stop: f64) -> f64 {
    let flight = 0.06 + speed * time - 0.5 * 9.81 * time * time;
    let met = ((time - 0.021) / 0.001).clamp(0.0, 1.0);
    flight + print * met + (stop - print) * ((time - 0.022) / 0.008).clamp(0.0, 1.0)
}

/// Returns a table of four codes on four beds. In the last code, the numbers of the beds are one higher, and its
/// first bed is deeper. One ball is at rest.
fn table() -> String {
    let prints = [1.5e-4, 1.8e-4, 2.1e-4, 2.4e-4];
    let mut lines = "t".to_owned();
    for code in ["A", "B", "C", "D"] {
        for bed in 1..=4 {
            write!(lines, ",{code}_IC{bed}").unwrap();
        }
    }
    for step in 0..=40 {
        let time = f64::from(step) * 1e-3;
        write!(lines, "\n{time}").unwrap();
        for (code, off) in [("A", 0.0), ("B", 1e-5), ("C", 2e-5), ("D", 1e-5)] {
            for bed in 0..4_usize {
                let print = match (code, bed) {
                    ("D", 0) => 4.0e-4,
                    ("D", _) => prints[bed - 1],
                    _ => prints[bed],
                };
                let deep = if (code, bed) == ("D", 0) { -1.5e-3 } else { 0.0 };
                let speed = if (code, bed) == ("C", 3) { 0.0 } else { -5.0 };
                write!(lines, ",{:.7}", course(time, speed, print, 0.015 + off + 0.5 * print + deep)).unwrap();
            }
        }
    }
    lines
}

#[test]
fn says_which_ball_was_at_rest_and_which_beds_have_other_numbers() {
    let Some(PublishedTable { kind: Kind::Impact(impact), .. }) = published("a.csv", &table()).unwrap() else {
        panic!("no courses")
    };
    let findings: Vec<String> = of_impact(&impact).into_iter().map(|finding| finding.to_string()).collect();
    let has = |words: [&str; 2]| findings.iter().any(|line| words.iter().all(|word| line.contains(word)));
    assert!(has(["C, bed 4: velocity at the start: 0.00 m/s", "expected -5 m/s"]), "{findings:#?}");
    assert!(has(["D:", "numbers one higher"]), "{findings:#?}");
    assert!(has(["D:", "its bed 1 (held up by 400 µm)"]), "{findings:#?}");
    // The bed is 1.5 mm deeper. Half of the difference of its fingerprint, (4.0 − 1.8)/2 · 10⁻¹ mm, reduces this to
    // 1.4 mm.
    assert!(has(["D, bed 1:", "1.4 mm below"]), "{findings:#?}");
    assert!(!findings.iter().any(|line| line.starts_with("A") || line.starts_with("B")), "{findings:#?}");
}

#[test]
fn derives_means_and_deviations() {
    let Some(PublishedTable { kind: Kind::Impact(impact), .. }) = published("a.csv", &table()).unwrap() else {
        panic!("no courses")
    };
    let kept = |course: &grainbench_reference::round_robin::Course| ["A", "B"].contains(&course.code.as_str());
    let spread = impact.spread(kept, |impact, course| impact.height(course, 0.0305)).unwrap();
    let flight = 0.06 - 5.0 * 0.0305 - 0.5 * 9.81 * 0.0305 * 0.0305;
    assert!((spread.mean - (flight + 0.015 + 5e-6 + 0.5 * 1.95e-4)).abs() < 2e-6, "{spread:?}");
    assert!((spread.code - 1e-5 / 2.0_f64.sqrt()).abs() < 1e-7, "{spread:?}");
    assert!((spread.bed - 0.5 * 3.0e-5 * (5.0_f64 / 3.0).sqrt()).abs() < 1e-7, "{spread:?}");
}

/// The first sample of LIGGGHTS is about 0.05 ms late, although its ball was released like the others.
#[test]
fn a_clock_that_is_ahead_is_no_other_release() {
    let mut text = "t,A_IC1,L_IC1,R_IC1".to_owned();
    for step in 0..4 {
        let time = f64::from(step) * 1e-3;
        let fall = |speed: f64, time: f64| 0.06 + speed * time - 0.5 * 9.81 * time * time;
        let late = if step == 0 { 4.95e-5 } else { time };
        write!(text, "\n{time},{:.8},{:.8},{:.8}", fall(-5.0, time), fall(-5.0, late), fall(0.0, time)).unwrap();
    }
    let Some(PublishedTable { kind: Kind::Impact(impact), .. }) = published("a.csv", &text).unwrap() else {
        panic!("no courses")
    };
    let findings: Vec<String> = of_impact(&impact).into_iter().map(|finding| finding.to_string()).collect();
    let begins = ["R, bed 1: velocity at the start: 0.00 m/s", "L: clock ahead at its first sample: 4.95e-5 s"];
    let is_said = |begin: &&str| findings.iter().any(|line| line.starts_with(*begin));
    assert!(begins.iter().all(is_said) && findings.len() == begins.len(), "{findings:#?}");
}

#[test]
fn says_which_frame_is_counted_twice() {
    let text = "t,z1_m1,z1_m2,z2_m1,z2_m2\n0,1,2,30,41\n1,1,3,33,41\n2,4,6,66,80\n";
    let Some(PublishedTable { kind: Kind::Drum(drum), .. }) = published("a.csv", text).unwrap() else {
        panic!("no zones")
    };
    let findings = of_drum(&drum);
    assert_eq!(findings.len(), 1);
    assert_eq!(findings[0].about, "t = 2 s");
    assert_eq!(drum.in_zone_2(1.0), Some(33.0));
}

#[test]
fn says_which_drum_is_off() {
    let drum_table = |name: &str, at: [u32; 2]| {
        let text = format!("t,z1_m1,z1_m2,z2_m1,z2_m2\n0,1,2,30,41\n0.5,1,3,{},41\n1,4,6,{},81\n", at[0], at[1]);
        match published(name, &text).unwrap() {
            Some(PublishedTable { kind: Kind::Drum(drum), .. }) => drum,
            _ => panic!("no zones"),
        }
    };
    let findings = of_drums(&drum_table("b.csv", [1050, 800]), ("a", &drum_table("a.csv", [1000, 1000])));
    assert_eq!(findings.len(), 1, "{findings:?}");
    assert_eq!(findings[0].to_string(), "t = 1 s: M1 in zone 2: 800, -20.0 % of a's 1000; expected within 10 %");
}

#[test]
fn refuses_what_is_no_table_of_it() {
    for (text, place) in [
        ("t,A_IC1,B\n0,1,2\n", "a.csv:1: expected columns CODE_ICn"),
        ("t,A_IC0\n0,1\n", "a.csv:1: expected columns CODE_ICn"),
        ("t,A_IC1\n0,1\n-1,1\n", "a.csv:3: expected times that do not fall"),
        ("t,A_IC1\n0,x\n", "a.csv:2"),
        ("t,count\n0,5\n0,4\n", "a.csv:3: expected times that rise"),
        ("t,z1_m1,z2_m1\n0,1,2\n", "a.csv:1: expected columns z1_m1"),
        ("t,count\n", "a.csv"),
    ] {
        let error = published("a.csv", text).unwrap_err();
        assert!(error.contains(place), "{text}: {error}");
    }
    assert_eq!(published("a.csv", "x,y\n1,2\n").unwrap(), None);
}
