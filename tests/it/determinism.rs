//! The same scene, solver and time step give the same bits when a run is repeated, also while other runs are in progress.

use crate::common::{Answer, Directory, bits, temporary, temporary_with};
use grainbench::cases::registry::CASES;
use grainbench::cases::solvers;
use grainbench::solver::observer::RunOptions;
use grainbench::solver::resolution::Resolution;
use rayon::prelude::*;

#[test]
fn a_rerun_gives_the_same_bits() {
    CASES.par_iter().for_each(|case| {
        let variant = &case.variants().unwrap()[0];
        let mut scene = case.variant(variant).unwrap();
        // Long runs are shortened, because bits that differ do so from the beginning.
        if scene.grains.len() > 100 {
            scene.duration = grainbench::scene::scene::Duration::Cycles(200);
            scene.snapshots = 5;
        }
        // The material point method is slow, so it runs only short scenes of deformable grains.
        let deformable = ["incline-disc", "two-discs"].contains(&case.name);
        for solver in solvers::all().into_iter().filter(|solver| deformable || !solver.name().starts_with("mpm")) {
            let resolution = match solver.name().split(':').next() {
                Some("rigid") => Resolution::substeps(2),
                Some("mpm") => Resolution::grid(2.0, 2),
                _ => Resolution::CriticalFraction(0.05),
            };
            // If a run crashes, its repetition must crash in the same way.
            let run =
                |threads| solver.run(&scene, &resolution, &mut RunOptions { threads, ..RunOptions::DEFAULT }).map(bits);
            let (first, second) = std::thread::scope(|scope| {
                let beside = scope.spawn(|| run(3));
                (run(1), beside.join().unwrap())
            });
            assert!(first == second, "{} with {} differs from its rerun on three threads", case.name, solver.name());
        }
    });
}

/// 1600 discs that fall on each other and roll across a periodic boundary.
const MANY: &str = include_str!("../scenes/many-discs.toml");

/// Two oscillating blocks, one fixed and one that falls onto a slope, with the energy budget.
const BLOCKS: &str = include_str!("../scenes/two-blocks.toml");

/// The number of threads changes no output: series, snapshots, contacts and checkpoints. A run can continue from a
/// checkpoint with another number of threads.
#[test]
fn threads_leave_no_trace() {
    for (scene, solver) in [(MANY, "dem"), (BLOCKS, "mpm"), (BLOCKS, "mpm:no-slip"), (BLOCKS, "mpm+usf")] {
        let directory = temporary_with("s.toml", scene);
        let cells = if solver == "dem" { "" } else { "--cells 14" };
        let simulate = format!("simulate s.toml --solver {solver} {cells} --write dump,vtk --out out");
        let left = |threads: &str, more: &str| {
            let checkpoints = "--checkpoint-every 60 --checkpoint c";
            directory.ok(format!("{simulate} {checkpoints} --threads {threads} {more}"));
            let read = |name: &str| std::fs::read(directory.join(name)).unwrap();
            [read("out/series.csv"), read("out/snapshots.dump"), read("c")]
        };
        let expected = left("1", "");
        std::fs::rename(directory.join("c"), directory.join("of-one")).unwrap();
        for threads in ["2", "3"] {
            assert!(left(threads, "") == expected, "{solver}, {threads} threads");
            assert!(left(threads, "--restart of-one") == expected, "{solver}, {threads} threads go on");
        }
        assert!(left("1", "--restart c") == expected, "{solver}, one goes on");
    }
}

/// Random discs with restitution on a slope under a rotating wall, and a neo-Hookean block.
const SCENES: [(&str, &str); 2] =
    [("dem", include_str!("../scenes/turning-wall.toml")), ("mpm", include_str!("../scenes/vibrating-block.toml"))];

/// The system library uses other functions if some features of the processor are masked. Our solvers have their own
/// functions, so their results do not change.
#[test]
fn the_library_of_the_system_has_no_part_in_the_bits() {
    let directory = temporary();
    for (solver, scene) in SCENES.into_iter().chain([("rigid", SCENES[0].1)]) {
        directory.write("s.toml", scene);
        let series = |masked: &str| {
            let mut simulate = directory.program(format!("simulate s.toml --solver {solver} --write dump --out out"));
            Answer::of(simulate.env("GLIBC_TUNABLES", masked)).ok();
            let read = |name: &str| std::fs::read(directory.join("out").join(name)).unwrap();
            (read("series.csv"), read("snapshots.dump"))
        };
        let all = series("");
        let plain = series("glibc.cpu.hwcaps=-AVX2,-AVX2_Usable,-FMA,-FMA_Usable,-AVX512F,-AVX512F_Usable");
        assert!(all == plain, "{solver} gives other bits without the processor's instructions");
    }
}
