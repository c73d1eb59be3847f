//! Input decks for external programs: their contents, messages about unsupported scenes, and the files that the command writes.

use crate::common::{Directory, files, temporary};
use grainbench::cases::registry::{CASES, by_name};
use grainbench::harness::case::Case;
use grainbench::reference::deck::{Deck, DeckError, Program, write_deck};
use grainbench::scene::dimension::GrainShape;
use grainbench::scene::function::{Function, FunctionKind};
use grainbench::scene::motion::{Moment, Motion, Phase};
use grainbench::scene::scene::{Domain, Scene, WallShape};
use grainbench::scene::source::SceneSource;
use grainbench::solver::resolution::Resolution;
use nalgebra::Vector3;
use rayon::prelude::*;
use std::path::Path;

/// Writes the deck of a changed scene.
fn deck_of(case: &str, variant: &str, program: Program, change: impl Fn(&mut Scene)) -> Result<Deck, DeckError> {
    let case = by_name(case).unwrap();
    let mut scene = case.variant(variant).unwrap();
    change(&mut scene);
    write_deck(&scene, &case.default_level.resolution, program)
}

/// Returns the text of all files of a deck, one below another.
fn shown_of(case: &str, variant: &str, program: Program, change: impl Fn(&mut Scene)) -> String {
    let deck = deck_of(case, variant, program, change).unwrap();
    deck.files.iter().map(|(name, text)| format!("==> {name} <==\n{text}\n")).collect()
}

#[test]
fn decks_of_cases() {
    let (lammps, liggghts) = (Program::LAMMPS, Program::LIGGGHTS);
    for (name, case, variant, program) in [
        ("an_incline_for_lammps", "incline-disc", "60deg-mu.9", lammps),
        ("moving_walls_for_lammps", "nine-discs", "kappa-0", lammps),
        ("moving_walls_for_liggghts_are_meshes", "nine-discs", "kappa-0", liggghts),
        // A dashpot proportional to stiffness is written as one proportional to effective mass, if all grains have the
        // same mass.
        ("a_dashpot_of_another_kind_for_liggghts", "collision", "beta-zeta.1", liggghts),
        // Hertz contacts with and without a coefficient of restitution. LAMMPS uses `granular`, LIGGGHTS uses moduli.
        ("hertz_4-aluminium-oxide_LAMMPS", "chung-ooi", "4-aluminium-oxide", lammps),
        ("hertz_4-aluminium-oxide_LIGGGHTS", "chung-ooi", "4-aluminium-oxide", liggghts),
        ("hertz_1-glass_LAMMPS", "chung-ooi", "1-glass", lammps),
        ("hertz_1-glass_LIGGGHTS", "chung-ooi", "1-glass", liggghts),
        ("rolling_LAMMPS", "rolling-resistance", "disc", lammps),
        ("rolling_LIGGGHTS", "rolling-resistance", "disc", liggghts),
    ] {
        insta::assert_snapshot!(name, shown_of(case, variant, program, |_| {}));
    }
}

/// Walls that first move and then rotate. LAMMPS gets formulas, and LIGGGHTS gets intervals; its grains are spheres.
#[test]
fn walls_that_turn() {
    for program in Program::ALL {
        let deck = shown_of("nine-discs", "distortion-15deg-1", program, |scene| {
            scene.global_damping = 0.0;
            scene.grains.iter_mut().for_each(|grain| grain.inertia *= 0.8);
            scene.grain_shape = GrainShape::Sphere;
        });
        let lines = deck.lines().filter(|line| ["wall", "move", "run"].iter().any(|word| line.contains(word)));
        insta::assert_snapshot!(format!("turning_{program}"), lines.collect::<Vec<_>>().join("\n"));
    }
}

/// Walls of finite extent: an oblique rotating wall in two dimensions, and an oblique moving wall in three dimensions.
#[test]
fn walls_of_finite_extent_are_flat_blocks() {
    let [x, y, z] = [Vector3::x(), Vector3::y(), Vector3::z()];
    let phase = |velocity, spin| Phase { velocity, spin, start: Moment::Seconds(0.0), stop: Moment::Never };
    let lines = |case: &str, variant: &str, change: &dyn Fn(&mut Scene)| {
        let deck = shown_of(case, variant, Program::LAMMPS, change);
        deck.lines().filter(|line| line.contains("wall1")).collect::<Vec<_>>().join("\n")
    };
    let segment = lines("squash", "plain", &|scene| {
        scene.walls[0].shape = WallShape::Segment { ends: [-x - y, -x + y * 2.0 - x] };
        scene.walls[0].motion =
            Motion { centre: -x, phases: vec![phase(Vector3::zeros(), z * 0.5)], ..Motion::default() };
    });
    let rectangle = lines("chung-ooi", "2-aluminium-alloy", &|scene| {
        scene.walls[0].shape = WallShape::Rectangle { corner: -x - y - z * 0.5, edges: [x * 2.0 + z, y * 2.0] };
        scene.walls[0].motion = Motion { phases: vec![phase(z * 0.1, Vector3::zeros())], ..Motion::default() };
    });
    insta::assert_snapshot!(format!("{segment}\n{rectangle}"));
}

/// LAMMPS gets a sine and a ramp as formulas, and agrees with `dem:lammps`. LIGGGHTS gets intervals of constant velocity.
#[test]
fn a_wall_that_moves_by_functions() {
    let (x, y) = (Vector3::x(), Vector3::y());
    let sine = FunctionKind::Sine { amplitude: x * 0.5, frequency: 2.0, phase: 0.25 };
    let ramp = FunctionKind::Ramp { velocity: y * 0.1, over: 3.0 };
    let change = |scene: &mut Scene| {
        scene.walls[0].motion.functions = vec![
            Function { kind: sine, start: 0.0, stop: f64::INFINITY },
            Function { kind: ramp, start: 1.0, stop: 5.0 },
        ];
    };
    let deck = shown_of("squash", "plain", Program::LAMMPS, change);
    let lines = deck.lines().filter(|line| line.contains("wall1")).collect::<Vec<_>>().join("\n");
    let mut scene = by_name("squash").unwrap().variant("plain").unwrap();
    change(&mut scene);
    let refusal = write_deck(&scene, &Resolution::CriticalFraction(0.1), Program::LIGGGHTS).unwrap_err();
    insta::assert_snapshot!(format!("{lines}\n{refusal}"));
}

#[test]
fn every_case_has_a_deck_or_a_reason() {
    let decks = |case: &&Case| {
        let mut written = 0;
        for variant in case.variants().unwrap() {
            let scene = case.variant(&variant).unwrap();
            for program in Program::ALL {
                match write_deck(&scene, &case.default_level.resolution, program) {
                    Ok(deck) => {
                        assert!(deck.files.iter().all(|(_, text)| text.is_ascii()), "{}/{variant}", case.name);
                        written += 1;
                    }
                    Err(DeckError::Unsupported { reason, .. }) => assert!(!reason.is_empty()),
                    // Cases of rigid-body solvers have time steps that a deck cannot use.
                    Err(DeckError::Resolution(reason)) => assert!(!reason.is_empty()),
                }
            }
        }
        written
    };
    let written: u32 = CASES.par_iter().map(decks).sum();
    assert!(written > 30, "{written}");
}

/// The meshes of walls need room in the box, but not along a periodic axis, because the box is the period there. LIGGGHTS
/// deletes triangles beyond it.
#[test]
fn meshes_leave_the_period_as_it_is() {
    let deck = |depth: f64| {
        deck_of("chung-ooi", "plain", Program::LIGGGHTS, |scene| {
            let [x, y, z] = [Vector3::x(), Vector3::y(), Vector3::z()];
            scene.domain = Some(Domain { low: -x - y - z, high: x + y + z, periodic: [false, true, false] });
            scene.walls[0].shape = WallShape::Rectangle { corner: -x - y, edges: [x * 2.0, y * depth] };
        })
    };
    let box_of = |name: &str| -> String {
        let files = deck(2.0).unwrap().files;
        let (_, data) = files.iter().find(|(file, _)| file == "data.grains").unwrap();
        data.lines().find(|line| line.contains(name)).unwrap().to_owned()
    };
    assert_eq!(box_of("ylo"), "-1.0 1.0 ylo yhi");
    assert!(!box_of("xlo").starts_with("-1.0 "), "the mesh needs room: {}", box_of("xlo"));
    let message = deck(2.5).unwrap_err().to_string();
    assert!(message.contains("extends beyond the periodic bounds along y, -1 m to 1 m"), "{message}");
}

/// A mesh that moves out by 3 m and back needs room there too.
#[test]
fn meshes_have_room_for_their_whole_path() {
    let mut scene = by_name("chung-ooi").unwrap().variant("plain").unwrap();
    scene.walls[0].shape = WallShape::Rectangle { corner: -Vector3::x(), edges: [Vector3::x(), Vector3::y()] };
    let velocity = Vector3::x() * (3.0 / (0.1 * scene.critical_time_step()));
    let phase = |velocity, [start, stop]: [u64; 2]| Phase {
        velocity,
        spin: Vector3::zeros(),
        start: Moment::Cycle(start),
        stop: Moment::Cycle(stop),
    };
    scene.walls[0].motion.phases = vec![phase(velocity, [0, 1]), phase(-velocity, [1, 2])];
    let deck = write_deck(&scene, &Resolution::CriticalFraction(0.1), Program::LIGGGHTS).unwrap();
    let (_, data) = deck.files.iter().find(|(file, _)| file == "data.grains").unwrap();
    let bounds = data.lines().find(|line| line.contains("xlo")).unwrap();
    assert!(bounds.split(' ').nth(1).unwrap().parse::<f64>().unwrap() > 3.0, "{bounds}");
}

/// A disc of 1 kg hits another disc of 1 kg and a disc with prescribed motion, which has infinite mass. With k_n = 1e4 N/m
/// and β = 1e-3 s, γ_n = βk_n/m_eff is 20 /s between the free discs (m_eff = 1/2 kg), and 10 /s at the disc with
/// prescribed motion. Contacts without friction have no tangential dashpot, although the law has one.
#[test]
fn dashpots_follow_the_effective_mass_of_the_programs() {
    let scene = |partner: &str, friction: f64| {
        let text = format!(
            "title = 't'\ndimension = 2\nduration_cycles = 1\n\
             materials = {{ a.density = {0}, b.density = {0} }}\n\
             contacts.c = {{ between = ['a', 'b'], normal_stiffness = 1.0e4, tangential_stiffness = 1.0e3, \
             friction = {friction:?}, stiffness_damping = 1.0e-3, tangential_damping = 7.0 }}\n\
             [grains.a]\nmaterial = 'a'\nradius = 1.0\nposition = [0.0, 0.0]\n\
             [grains.b]\nmaterial = 'b'\nradius = 1.0\nposition = [3.0, 0.0]\n{partner}",
            std::f64::consts::FRAC_1_PI
        );
        SceneSource::from_text("t", Path::new("."), &text).scene(&grainbench::scene::resolve::no_data_file).unwrap()
    };
    let coefficients = |partner: &str, friction: f64| -> Vec<f64> {
        let scene = scene(partner, friction);
        let deck = write_deck(&scene, &Resolution::CriticalFraction(0.1), Program::LAMMPS).unwrap();
        let mut lines = deck.files.iter().flat_map(|(_, text)| text.lines());
        let line = lines.find(|line| line.contains("10000.0 1000.0")).unwrap();
        let after = line.split("10000.0 1000.0 ").nth(1).unwrap();
        after.split(' ').take(2).map(|word| word.parse().unwrap()).collect()
    };
    let close = |found: Vec<f64>, expected: [f64; 2]| {
        assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9), "{found:?}, {expected:?}");
    };
    close(coefficients("", 0.5), [20.0, 2.0 + 7.0]);
    close(coefficients("[driven.b]\ngrains = 'b'\n", 0.5), [10.0, 1.0 + 7.0]);
    close(coefficients("[driven.b]\ngrains = 'b'\n", 0.0), [10.0, 0.0]);
}

/// Returns the message about a changed scene that an external program does not support.
fn refusal(case: &str, variant: &str, program: Program, change: impl Fn(&mut Scene)) -> String {
    deck_of(case, variant, program, change).unwrap_err().to_string()
}

#[test]
fn refusals_give_the_reason() {
    let lammps =
        |case: &str, variant: &str, change: &dyn Fn(&mut Scene)| refusal(case, variant, Program::LAMMPS, change);
    let messages = [
        lammps("chung-ooi", "1-glass", &|scene| {
            scene.change_laws(|law| (law.damping_ratio, law.friction) = (0.1, 0.3));
        }),
        lammps("chung-ooi", "3-cast-iron", &|scene| scene.change_laws(|law| law.damping_ratio = 0.6)),
        lammps("chung-ooi", "plain", &|scene| scene.change_laws(|law| law.normal_damping = 1.0)),
        lammps("chung-ooi", "plain", &|scene| scene.change_laws(|law| law.rolling_friction = 0.1)),
        lammps("chung-ooi", "plain", &|scene| {
            let (x, y, z) = (Vector3::x(), Vector3::y(), Vector3::z());
            scene.walls[0].shape = WallShape::Rectangle { corner: -x - y, edges: [x * 2.0 + z, y * 2.0] };
            scene.walls[0].motion.phases =
                vec![Phase { velocity: Vector3::zeros(), spin: z, start: Moment::Seconds(0.0), stop: Moment::Never }];
        }),
        lammps("cohesive-disc", "plain", &|_| {}),
        lammps("rolling-resistance", "sphere-slope", &|_| {}),
        lammps("collision", "oblique", &|scene| scene.change_laws(|law| law.rolling_friction = 0.1)),
        refusal("chung-ooi", "3-cast-iron", Program::LIGGGHTS, |scene| {
            scene.change_laws(|law| law.scale_tangential(2.0));
        }),
        lammps("nine-discs", "static-0", &|_| {}),
        lammps("collision", "beta-zeta.1", &|scene| {
            scene.grains[0].mass *= 2.0;
            scene.grains[0].inertia *= 2.0;
        }),
        lammps("collision", "oblique", &|scene| scene.grains[0].inertia *= 1.1),
        refusal("nine-discs", "kappa-1", Program::LIGGGHTS, |_| {}),
        refusal("nine-discs", "kappa-0", Program::LIGGGHTS, |scene| {
            scene.walls[0].motion.phases[0].stop = Moment::Seconds(0.1234);
        }),
    ];
    insta::assert_snapshot!(messages.join("\n"));
}

/// The title of a scene must not become a command of the script.
#[test]
fn a_title_is_no_part_of_the_script() {
    let case = by_name("squash").unwrap();
    let mut scene = case.variant(&case.variants().unwrap()[0]).unwrap();
    scene.title = "mean\nshell rm &\n${x} \"".to_owned();
    let deck = write_deck(&scene, &case.default_level.resolution, Program::LAMMPS).unwrap();
    assert!(deck.files[0].1.starts_with("# mean_shell rm ____x_ _\nunits si\n"), "{}", deck.files[0].1);
}

#[test]
fn the_command_leaves_a_whole_deck() {
    let directory = temporary();
    insta::assert_snapshot!(directory.run("deck nine-discs/kappa-0 --for liggghts --out d").quiet());
    let walls = "d/wall-1.stl d/wall-2.stl d/wall-3.stl d/wall-4.stl";
    assert_eq!(files(&directory).join(" "), format!("d/data.grains d/in.liggghts d/manifest.json {walls}"));
}

/// The first solver-independent claim of this case has a resolution in grid cells, which is not a time step.
#[test]
fn an_exact_scene_is_stepped_in_time() {
    let directory = temporary();
    directory.run("deck incline-disc/30deg-mu.5 --for lammps --exact --out d").quiet();
    let script = directory.read("d/in.lammps");
    assert!(script.contains("timestep"), "{script}");
}

/// A second deck replaces the first one, because the files of the first deck belong to another scene.
#[test]
fn a_directory_holds_one_deck() {
    let directory = temporary();
    for (program, script) in [("lammps", "in.lammps"), ("liggghts", "in.liggghts")] {
        directory.run(format!("deck incline-sphere --for {program} --out d")).quiet();
        let found = files(&directory.join("d"));
        assert!(found.contains(&"manifest.json".to_owned()), "{found:?}");
        let scripts: Vec<&String> = found.iter().filter(|name| name.starts_with("in.")).collect();
        assert_eq!(scripts, [script]);
    }
}
