//! `grainbench check`: judges the output of any program against a case or scene.

use super::exit::{Fault, Outcome, check_writable, refuse, refuse_inputs};
use super::pattern;
use super::provenance::provenance;
use super::publish::ReportArguments;
use super::subject::{self, Variant};
use super::value::{path_and_value, positive};
use glob::Pattern;
use grainbench::adapt::AdaptedScene;
use grainbench::check::{
    CONVENTION_NAMES, DeclaredScene, Options, Power, StartFile, check as judge, is_of_power, power_words, sentence,
};
use grainbench::harness::expect::ExpectedValue;
use grainbench::harness::verdict::{self, Verdict};
use grainbench::reference::observer::Names;
use grainbench::reference::outputs::{Outputs, Sources, is_of_a_run};
use grainbench::reference::read_start;
use grainbench::reports::{Report, Section, line};
use grainbench::scene::scene::Scene;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::time::Instant;

#[derive(Clone, clap::Args)]
pub(crate) struct Arguments {
    /// Case, variant of a case, folder of a case, or scene file.
    #[arg(value_name = "CASE|CASE/VARIANT|FOLDER|SCENE.toml", required_unless_present = "all")]
    scene: Option<String>,
    /// Override one key of the scene, if your run has other parameters than the case. Exact solutions are computed for
    /// the new value. Positions follow a changed radius, and `law = "hertz"` removes linear stiffness. Repeatable.
    #[arg(long, value_name = "PATH=VALUE", value_parser = path_and_value)]
    set: Vec<(String, String)>,
    /// Take radii, masses, positions, velocities, spins and periodic bounds from the first sample of this file, for
    /// example of your dump. The start of the scene is then not tested.
    #[arg(long, value_name = "FILE")]
    like: Option<PathBuf>,
    /// Contact convention with which your output is compared: a solver such as `dem:lammps`, or the `nearest` one. An
    /// error outside the tolerance is red. For the nearest one, it is amber if our conventions differ by more.
    #[arg(long, value_name = "NAME", default_value = "nearest", value_parser = CONVENTION_NAMES)]
    convention: String,
    /// Output files, plain or compressed by gzip or zstd. Formats: dumps of grains and of contacts (`dump local`) at
    /// the same steps; VTK files (`.vtk`, `.vtp`, `.vtu`, `.vtkhdf`, `.pvd`); NumPy arrays (`.npz`); CSV tables of
    /// grains from ParaView, one per time or one for all times; one CSV table of probes.
    #[arg(long, value_name = "FILE", required_unless_present = "all", num_args = 1..)]
    dump: Vec<PathBuf>,
    /// Check all outputs in this directory. The output of a case is in `DIR/CASE` or `DIR/CASE/VARIANT`. A folder
    /// without output is red.
    #[arg(long, value_name = "DIR", conflicts_with_all = ["scene", "set", "like", "dump", "log", "map"])]
    all: Option<PathBuf>,
    /// File name that `--all` ignores, or a quoted pattern such as `'*.log'`. Repeatable. Any other file that is not
    /// output is red.
    #[arg(long, value_name = "NAME", requires = "all")]
    ignore: Vec<String>,
    /// Log file of the run. Default: `log.lammps` or `log.liggghts` in the directory of the first dump.
    #[arg(long, value_name = "FILE")]
    log: Option<PathBuf>,
    /// Time step in seconds, if neither the dumps nor the log contain it.
    #[arg(long, value_name = "SECONDS", value_parser = positive, allow_hyphen_values = true)]
    time_step: Option<f64>,
    /// Time between frames in seconds, for files that contain frame numbers but no times.
    #[arg(long, value_name = "SECONDS", value_parser = positive, allow_hyphen_values = true)]
    frame_interval: Option<f64>,
    /// Column names in the files, such as `x=xu,omegaz=wz`. Our contact columns are `id1`, `id2`, `force_x` (on the first
    /// grain) and, optionally, `tangential_x`. `WALL.force_x` is the force of a wall on a grain, and `angle`
    /// is the angle of a disc.
    #[arg(long, value_name = "OURS=THEIRS,…", value_delimiter = ',', value_parser = path_and_value)]
    map: Vec<(String, String)>,
    /// Report incomplete output as amber instead of red. The output may then end early or have few samples. Of a
    /// truncated file, the complete frames are judged. Without this option, samples farther apart than both a tenth of
    /// the run and the scene's sampling interval are red.
    #[arg(long)]
    partial: bool,
    /// Accept a time step at or above the critical one.
    #[arg(long)]
    allow_unstable: bool,
    /// Search for changes of the scene that the output reveals. `off` skips the search, `limited` takes at most three
    /// times the work of the comparison, and `full` tries all changes.
    #[arg(long, value_name = "HOW", default_value = "limited", value_parser = ["off", "limited", "full"])]
    power: String,
    #[command(flatten)]
    report: ReportArguments,
}

/// Checks one output or all outputs of a directory, and writes the report.
pub(crate) fn check(arguments: &Arguments) -> Outcome {
    let start = Instant::now();
    let Arguments { dump, like, log, all: folder, report, .. } = arguments;
    check_writable(&report.out)?;
    refuse_inputs(&report.out, dump.iter().chain(like).chain(log).chain(folder))?;
    let mut words = vec!["check".to_owned()];
    let sections = match (&arguments.scene, &arguments.all) {
        (Some(scene), _) => {
            let (section, name) = one(arguments, scene)?;
            words.extend([scene.clone(), name]);
            words.extend(arguments.set.iter().map(|(path, value)| format!("--set {path}={value}")));
            words.extend(arguments.like.iter().map(|file| format!("--like {}", file.display())));
            vec![section]
        }
        (None, Some(folder)) => {
            words.push(format!("--all {}", folder.display()));
            all(arguments, folder)?
        }
        (None, None) => Vec::new(),
    };
    let report = Report::new(provenance(words, start.elapsed().as_secs_f64()), sections);
    // Each section needs at least one judged result about a quantity, because the coverage alone does not show that the
    // content is right.
    let is_told = report.sections.iter().all(|section| {
        let mut rows = section.verdicts.iter().skip(1);
        rows.any(|row| row.outcome.is_judged() && (row.value.is_some() || row.outcome.is_red()) && !is_of_power(row))
    });
    let text = text(&report);
    arguments.report.publish(report, !is_told, Some(text))
}

/// Checks one output. Returns its section and the name of the output for the page.
fn one(arguments: &Arguments, scene: &str) -> Result<(Section, String), Fault> {
    let names = || Names(arguments.map.clone());
    let like = arguments.like.clone().map(|path| StartFile { path, names: names() });
    let subject = if subject::is_scene_file(scene) {
        let (adapted, _) = subject::adapted_scene(scene, &arguments.set)?;
        subject::tell_implied(&adapted.implied);
        let AdaptedScene { scene: mut own, moved, .. } = adapted;
        if let Some(StartFile { path, names }) = like {
            read_start(&path, &names, &mut own)?;
        }
        let name = Path::new(scene).file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let unchanged = subject::scene(scene, &[]).ok().map(|(unchanged, _)| Box::new(unchanged));
        DeclaredScene::Scene { name, scene: Box::new(own), own: unchanged, moved }
    } else {
        let Variant { case, variant } = Variant::read_with_folders(scene)?;
        DeclaredScene::Case { case, variant, set: &arguments.set, like }
    };
    let beside = || {
        let first = arguments.dump.first()?;
        LOGS.map(|log| first.with_file_name(log)).into_iter().find(|log| log.is_file())
    };
    let sources = Sources {
        files: arguments.dump.clone(),
        log: arguments.log.clone().or_else(beside),
        names: names(),
        time_step: arguments.time_step,
        frame_interval: arguments.frame_interval,
        most_rows: Some(most_rows(&subject)?),
        partial: arguments.partial,
        from_first: true,
        snapshot_steps: Vec::new(),
    };
    let outputs = Outputs::survey(sources)?;
    outputs.check_names()?;
    let power = match arguments.power.as_str() {
        "off" => Power::Off,
        "full" => Power::Full,
        _ => Power::Limited,
    };
    let Arguments { partial, allow_unstable, .. } = *arguments;
    let convention = CONVENTION_NAMES.into_iter().skip(1).find(|name| *name == arguments.convention);
    let options = Options { partial, allow_unstable, power, convention };
    let section = judge(&subject, &outputs, options)?;
    Ok((section, outputs.name()))
}

/// Default names of log files.
const LOGS: [&str; 2] = ["log.lammps", "log.liggghts"];

/// Files that `deck` writes; they are input of a program, not output.
const INPUTS: [&str; 5] = ["in.lammps", "in.liggghts", "data.grains", "wall-*.stl", "manifest.json"];

/// Checks all outputs in the folders of cases and variants. The content of a file decides whether the file is output.
fn all(arguments: &Arguments, folder: &Path) -> Result<Vec<Section>, Fault> {
    let mut ignored: Vec<Pattern> =
        arguments.ignore.iter().map(|name| pattern::read("--ignore", name)).collect::<Result<_, _>>()?;
    ignored.extend(LOGS.iter().chain(&INPUTS).filter_map(|name| Pattern::new(name).ok()));
    let name = |path: &Path| path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let found = |folder: &Path| -> Result<(Vec<PathBuf>, Vec<PathBuf>), Fault> {
        let unreadable = |error: io::Error| {
            Fault::input(format!("{}: expected a folder that can be read, found {error}", folder.display()))
        };
        let entries = fs::read_dir(folder).map_err(unreadable)?;
        let paths = entries.map(|entry| entry.map(|entry| entry.path()));
        let mut paths = paths.collect::<io::Result<Vec<_>>>().map_err(unreadable)?;
        paths.retain(|path| !ignored.iter().any(|pattern| pattern.matches(&name(path))));
        paths.sort();
        Ok(paths.into_iter().partition(|path| path.is_dir()))
    };
    // Each folder of a case or a variant with its scene and its files.
    let mut folders: Vec<(PathBuf, String, Vec<PathBuf>)> = Vec::new();
    let (of_cases, mut misplaced) = found(folder)?;
    for of_case in of_cases {
        let case = name(&of_case);
        let (variants, files) = found(&of_case)?;
        if !files.is_empty() || variants.is_empty() {
            folders.push((of_case, case.clone(), files));
        }
        for of_variant in variants {
            let (deeper, files) = found(&of_variant)?;
            let scene = format!("{case}/{}", name(&of_variant));
            folders.push((of_variant, scene, files));
            misplaced.extend(deeper);
        }
    }
    let (mut sections, mut not_judged, mut empty) = (Vec::new(), Vec::new(), Vec::new());
    for (folder, scene, files) in folders {
        if files.is_empty() {
            empty.push((folder, without_output(&scene)));
        }
        let mut dump = Vec::new();
        for file in files {
            match is_of_a_run(&file) {
                Ok(()) => dump.push(file),
                Err(error) => not_judged.push((file, error.to_string())),
            }
        }
        if !dump.is_empty() {
            sections.push(one(&Arguments { dump, ..arguments.clone() }, &scene)?.0);
        }
    }
    let place = |path: PathBuf| (path, "it is not in a folder `CASE` or `CASE/VARIANT`".to_owned());
    not_judged.extend(empty);
    not_judged.extend(misplaced.into_iter().map(place));
    if sections.is_empty() && not_judged.is_empty() {
        let folder = folder.display();
        refuse!("{folder}: expected outputs in its folders `CASE` or `CASE/VARIANT`, found none");
    }
    sections.extend((!not_judged.is_empty()).then(|| section_of_not_judged(folder, &not_judged)));
    Ok(sections)
}

/// Returns the error message for a folder without output. It also states if the scene is unknown.
fn without_output(scene: &str) -> String {
    let unknown = match Variant::read(scene) {
        Err(Fault::Unknown(message, _)) => format!("; {}", message.trim_end_matches("; choices:")),
        Err(fault) => format!("; {fault}"),
        Ok(_) => String::new(),
    };
    format!("expected output of a run in the folder, found none{unknown}")
}

/// Returns a section with one red result, and its reason, for each file or folder that was not judged.
fn section_of_not_judged(folder: &Path, files: &[(PathBuf, String)]) -> Section {
    let row = |(path, reason): &(PathBuf, String)| {
        let name = path.strip_prefix(folder).unwrap_or(path).to_string_lossy();
        let row = Verdict {
            because: "each file and each folder of a case must be judged or ignored by name (--ignore)".to_owned(),
            source: "content of the file or folder".to_owned(),
            ..Verdict::open("files", format!("{name}, not judged"), "1")
        };
        row.left(verdict::Outcome::Fail, reason)
    };
    Section {
        name: "files".to_owned(),
        title: format!("Files of {} that were not judged", folder.display()),
        claim: "Each file and each folder below the directory is judged or ignored by name.".to_owned(),
        verdicts: files.iter().map(row).collect(),
        ..Section::default()
    }
}

/// Returns the largest accepted number of rows of a snapshot: 16 contacts per grain, and one contact of each grain with
/// each wall.
fn most_rows(subject: &DeclaredScene<'_>) -> Result<u64, Fault> {
    let row_count = |scene: &Scene| scene.grains.len() * (16 + scene.walls.len());
    let most = match subject {
        DeclaredScene::Scene { scene, .. } => row_count(scene),
        DeclaredScene::Case { case, .. } => {
            let scenes =
                case.variants()?.into_iter().map(|variant| case.variant(&variant).map(|scene| row_count(&scene)));
            scenes.collect::<Result<Vec<_>, _>>()?.into_iter().max().unwrap_or(0)
        }
    };
    Ok(most as u64)
}

/// Returns the text of a check: for each output, the outcome in words, the files with their time step, and the results.
/// The number of results of each colour follows.
fn text(report: &Report) -> String {
    let mut text = String::new();
    for section in &report.sections {
        let Some(first) = section.verdicts.first() else { continue };
        text.push_str(&format!("{}\n", sentence(section)));
        let is_one = |row: &Verdict| {
            (&row.solver, &row.resolution, &row.variant) == (&first.solver, &first.resolution, &first.variant)
        };
        let is_of_one_file = section.verdicts.iter().all(is_one) && !first.solver.is_empty();
        if is_of_one_file {
            let place =
                if first.variant.is_empty() { first.case.clone() } else { format!("{}/{}", first.case, first.variant) };
            text.push_str(&format!("{place} · {} · {}\n", first.solver, first.resolution));
        }
        let is_zero = |row: &&Verdict| {
            row.outcome == verdict::Outcome::Pass
                && row.value == Some(0.0)
                && row.expected == Some(ExpectedValue::Value(0.0))
        };
        let shown: Vec<&Verdict> = section.verdicts.iter().filter(|row| !is_zero(row)).collect();
        let (power, shown): (Vec<_>, Vec<_>) = shown.into_iter().partition(|row| is_of_power(row));
        let line = if is_of_one_file { line::quantity } else { line::verdict_in_section };
        text.push_str(&line::with_reasons(&shown, line));
        let name = |row: &Verdict| row.quantity.split(", ").next().unwrap_or_default().to_owned();
        let zeros: Vec<String> = section.verdicts.iter().filter(is_zero).map(name).collect();
        if !zeros.is_empty() {
            text.push_str(&format!("{:<12} exactly zero as expected: {}\n", "pass", zeros.join(", ")));
        }
        if !power.is_empty() {
            text.push_str("mistakes that this output would reveal, found by runs of our solver with each mistake:\n");
        }
        for row in power {
            text.push_str(&format!("{:<12} {}\n", row.outcome.word(), power_words(row)));
        }
    }
    text + &line::counts(&report.verdicts().collect::<Vec<_>>())
}
