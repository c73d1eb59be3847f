//! Overhead of running an external program through a manifest. One program is started for each run. A second program is
//! started once and receives all runs.
//!
//! Each run writes two samples of a disc. The benchmark `the program by itself` starts the first program directly,
//! without manifest.

#![allow(clippy::unwrap_used, missing_docs, reason = "a benchmark")]

use criterion::{Criterion, criterion_group, criterion_main};
use grainbench::cases::registry::read_grains;
use grainbench::reference::outside::{DiscretizedScene, ExternalProgram, Resolved, SceneFormat};
use grainbench::scene::scene::Scene;
use grainbench::scene::source::SceneSource;
use grainbench::solver::Solver;
use grainbench::solver::resolution::Resolution;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

const SCENE: &str = r#"
title = "A disc in free fall"
dimension = 2
gravity = [0.0, -9.81]
duration_cycles = 100
[materials.rock]
density = 1000.0
[contacts.all]
between = ["rock", "rock"]
normal_stiffness = 1e6
[grains.disc]
material = "rock"
radius = 0.5
position = [0.0, 0.5]
[output]
every_cycles = 100
[probes]
disc = { grain = "disc" }
"#;

const REST: &str = r#"
[can]
dimension = [2]
laws = ["linear"]
[output]
grains = { path = "grains.csv", format = "csv" }
"#;

/// Shell function that writes two samples to the output folder.
const LEAVE: &str = r#"leave() { printf 'step,id,x,y,z,vx,vy,vz\n0,1,0,0.5,0,0,0,0\n100,1,0,0.4,0,0,-1,0\n' > "$1/grains.csv"; }
"#;
const ONCE: &str = "leave \"$2\"\n";
const STAYS: &str = r#"while read -r line; do
    out=${line##*\"out\":\"}
    leave "${out%%\"*}"
    echo '{"ran": {"seconds": 0.0}}'
done
"#;

fn solver(folder: &Path, name: &str, command: &str, script: &str) -> ExternalProgram {
    let manifest = folder.join(format!("{name}.toml"));
    fs::write(&manifest, format!("name = \"{name}\"\n{command}\n{REST}")).unwrap();
    fs::write(folder.join(format!("{name}.sh")), format!("{LEAVE}{script}")).unwrap();
    ExternalProgram::read(&manifest).unwrap()
}

fn runs(criterion: &mut Criterion) {
    let folder = tempfile::tempdir().unwrap();
    let scene: Scene = SceneSource::from_text("disc.toml", folder.path(), SCENE).scene(&read_grains).unwrap();
    let step = Resolution::CriticalFraction(0.1);
    let given = DiscretizedScene::new(&scene, &step).unwrap();
    let resolved = folder.path().join("scene.json");
    fs::write(&resolved, Resolved::new(&given).text(SceneFormat::Json).unwrap()).unwrap();

    let once = solver(folder.path(), "once", r#"run = ["sh", "once.sh", "{scene}", "{out}"]"#, ONCE);
    let stays = solver(folder.path(), "stays", r#"worker = ["sh", "stays.sh"]"#, STAYS);
    let mut group = criterion.benchmark_group("outside");
    group.bench_function("the program by itself", |bencher| {
        bencher.iter(|| {
            let mut program = Command::new("sh");
            program.arg(folder.path().join("once.sh")).arg(&resolved).arg(folder.path()).stdout(Stdio::null());
            assert!(program.status().unwrap().success());
        });
    });
    group.bench_function("started for every run", |bencher| bencher.iter(|| once.run(&scene, &step, &mut ()).unwrap()));
    group.bench_function("one that stays", |bencher| bencher.iter(|| stays.run(&scene, &step, &mut ()).unwrap()));
    group.finish();
}

criterion_group!(benches, runs);
criterion_main!(benches);
