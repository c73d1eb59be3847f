//! The same scene, solver and step give the same bits, however often and beside whatever else they run.

use grainbench::cases::registry::CASES;
use grainbench::cases::solvers;
use grainbench::scene::record::{Cost, Record};
use grainbench::scene::solver::Resolution;

/// A record without its times. Debug output tells every bit of a number but the sign of a NaN, and there are none.
fn bits(mut record: Record) -> String {
    record.cost = Cost { wall_seconds: 0.0, ..record.cost };
    format!("{record:?}")
}

#[test]
fn a_rerun_gives_the_same_bits() {
    for case in CASES {
        let variant = &case.variants().unwrap()[0];
        let mut scene = case.variant(variant).unwrap();
        // Long runs are cut: bits part at once or not at all.
        if scene.grains.len() > 100 {
            scene.duration = grainbench::scene::scene::Duration::Cycles(200);
        }
        // Of the method that takes long, scenes made for it that are short.
        let deformable = ["incline-disc", "two-discs"].contains(&case.name);
        for solver in solvers::all().into_iter().filter(|solver| deformable || !solver.name().starts_with("mpm")) {
            let resolution = match solver.name().split(':').next() {
                Some("rigid") => Resolution::substeps(2),
                Some("mpm") => Resolution::grid(2.0, 2),
                _ => Resolution::CriticalFraction(0.05),
            };
            // A run that breaks must break alike.
            let run = || solver.run(&scene, &resolution, &mut ()).map(bits);
            let (first, second) = std::thread::scope(|scope| {
                let beside = scope.spawn(run);
                (run(), beside.join().unwrap())
            });
            assert!(first == second, "{} with {} differs from its rerun", case.name, solver.name());
        }
    }
}
