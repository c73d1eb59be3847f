//! Decks for other programs: what is written, what is refused and why, and what a command line leaves.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod common;

use common::{files, grainbench};
use grainbench::cases::registry::{CASES, by_name};
use grainbench::reference::deck::{DeckError, Program, write_deck};
use grainbench::scene::scene::Scene;

/// The deck's files one below the other.
fn shown(case: &str, variant: &str, program: Program) -> String {
    let case = by_name(case).unwrap();
    let deck = write_deck(&case.variant(variant).unwrap(), &case.default_rung.resolution, program).unwrap();
    deck.files.iter().map(|(name, text)| format!("==> {name} <==\n{text}\n")).collect()
}

#[test]
fn an_incline_for_lammps() {
    insta::assert_snapshot!(shown("incline-disc", "60deg-mu.9", Program::Lammps));
}

#[test]
fn moving_walls_for_lammps() {
    insta::assert_snapshot!(shown("nine-discs", "kappa-0", Program::Lammps));
}

#[test]
fn moving_walls_for_liggghts_are_meshes() {
    insta::assert_snapshot!(shown("nine-discs", "kappa-0", Program::Liggghts));
}

/// A dashpot ∝ stiffness becomes one ∝ effective mass where all grains have one mass.
#[test]
fn a_dashpot_of_another_kind_for_liggghts() {
    insta::assert_snapshot!(shown("collision", "beta-zeta.1", Program::Liggghts));
}

#[test]
fn every_case_has_a_deck_or_a_reason() {
    let mut written = 0;
    for case in CASES {
        for variant in case.variants().unwrap() {
            let scene = case.variant(&variant).unwrap();
            for program in Program::ALL {
                match write_deck(&scene, &case.default_rung.resolution, program) {
                    Ok(deck) => {
                        assert!(deck.files.iter().all(|(_, text)| text.is_ascii()), "{}/{variant}", case.name);
                        written += 1;
                    }
                    Err(DeckError::Unsupported { reason, .. }) => assert!(!reason.is_empty()),
                    // Rigid engines' cases have steps of their own.
                    Err(DeckError::Resolution(reason)) => assert!(!reason.is_empty()),
                }
            }
        }
    }
    assert!(written > 30, "{written}");
}

/// Why a program refuses a changed scene.
fn refusal(case: &str, variant: &str, program: Program, change: impl Fn(&mut Scene)) -> String {
    let case = by_name(case).unwrap();
    let mut scene = case.variant(variant).unwrap();
    change(&mut scene);
    write_deck(&scene, &case.default_rung.resolution, program).unwrap_err().to_string()
}

#[test]
fn refusals_give_the_reason() {
    let lammps =
        |case: &str, variant: &str, change: &dyn Fn(&mut Scene)| refusal(case, variant, Program::Lammps, change);
    let said = [
        lammps("chung-ooi", "plain", &|_| {}),
        lammps("cohesive-disc", "plain", &|_| {}),
        lammps("nine-discs", "static-0", &|_| {}),
        lammps("collision", "beta-zeta.1", &|scene| {
            scene.grains[0].mass *= 2.0;
            scene.grains[0].inertia *= 2.0;
        }),
        lammps("collision", "oblique", &|scene| scene.grains[0].inertia *= 1.1),
        refusal("nine-discs", "kappa-1", Program::Liggghts, |_| {}),
        refusal("nine-discs", "kappa-0", Program::Liggghts, |scene| {
            scene.walls[0].motion.phases[0].stop = grainbench::scene::motion::Moment::Seconds(0.1234);
        }),
    ];
    insta::assert_snapshot!(said.join("\n"));
}

/// A title cannot become a command.
#[test]
fn a_title_is_no_part_of_the_script() {
    let case = by_name("squash").unwrap();
    let mut scene = case.variant(&case.variants().unwrap()[0]).unwrap();
    scene.title = "mean\nshell rm &\n${x} \"".to_owned();
    let deck = write_deck(&scene, &case.default_rung.resolution, Program::Lammps).unwrap();
    assert!(deck.files[0].1.starts_with("# mean_shell rm ____x_ _\nunits si\n"), "{}", deck.files[0].1);
}

#[test]
fn the_command_leaves_a_whole_deck() {
    let directory = tempfile::tempdir().unwrap();
    let answer = grainbench(directory.path(), &["deck", "nine-discs/kappa-0", "--for", "liggghts", "--out", "d"]);
    assert_eq!((answer.code, answer.err.as_str()), (Some(0), ""));
    insta::assert_snapshot!(answer.out);
    assert_eq!(
        files(directory.path()),
        ["d/data.grains", "d/in.liggghts", "d/wall-1.stl", "d/wall-2.stl", "d/wall-3.stl", "d/wall-4.stl"]
    );
}

#[test]
fn the_command_refuses_and_leaves_nothing() {
    let directory = tempfile::tempdir().unwrap();
    let mut said = String::new();
    for arguments in [
        &["deck", "nine-discs/static-0", "--for", "lammps"][..],
        &["deck", "nine-discs", "--for", "lamps"],
        &["deck", "nine-disc", "--for", "lammps"],
        &["deck", "no-such.toml", "--for", "lammps"],
        &["deck", "squash", "--for", "lammps", "--set", "contacts.all.stifness=1"],
    ] {
        let answer = grainbench(directory.path(), arguments);
        assert_eq!((answer.code, answer.out.as_str()), (Some(2), ""));
        assert!(files(directory.path()).is_empty());
        let known = answer.err.find("one of backspin").map_or(answer.err.as_str(), |at| &answer.err[..at]);
        said.push_str(known.trim_end());
        said.push('\n');
    }
    insta::assert_snapshot!(said);
}
