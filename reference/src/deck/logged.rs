//! What the log of a run is asked for: sums over all contacts, which no dump of grains tells.

use grainbench_scene::record::Series;
use grainbench_scene::scene::{ProbeTarget, Scene};

use super::outline::AXES;
use crate::read::log::Log;

/// A column of the log that gives one of the series.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Logged {
    /// Column of the series, such as `floor.force_x`.
    pub(crate) column: String,
    /// Name of the variable. Short and plain, for LIGGGHTS cuts the names of columns.
    pub(crate) name: String,
    /// Its formula in the program.
    pub(crate) formula: String,
}

/// Components of the virial, in the order of both programs.
const VIRIAL: [&str; 6] = ["xx", "yy", "zz", "xy", "xz", "yz"];

/// What a program calls its sums.
pub(crate) struct Sums<'a> {
    /// The temperature that its pressure leaves out.
    pub(crate) temperature: &'a str,
    /// The group of the grains.
    pub(crate) grains: &'a str,
    /// The command and the components of the force of a wall on the grains, by the wall's number from 1.
    pub(crate) force: &'a dyn Fn(usize) -> (String, [String; 3]),
    /// How far a piston has gone, by the wall's number; none where it has none.
    pub(crate) advance: &'a dyn Fn(usize) -> Option<String>,
}

/// The commands that make the columns, and the columns.
///
/// The pressure of the programs counts forces between grains at the time of the step, as they moved the grains. It is
/// per volume of a box that grows with the grains, so that it is brought to the volume of the scene's domain.
pub(crate) fn logged(scene: &Scene, program: &Sums<'_>) -> Result<(String, Vec<Logged>), String> {
    let Sums { temperature, grains, force, advance } = program;
    let (mut commands, mut all) = (String::new(), Vec::new());
    let mut take = |column: String, formula: String| {
        let name = format!("g{}", all.len() + 1);
        all.push(Logged { column, name, formula });
    };
    for probe in &scene.probes {
        match probe.target {
            ProbeTarget::Wall(wall) => {
                let (command, components) = force(wall + 1);
                commands.push_str(&command);
                // Theirs is the force on the grains.
                for (component, axis) in components.iter().zip(AXES).take(scene.dimension.count()) {
                    take(format!("{}.force_{axis}", probe.name), format!("-{component}"));
                }
            }
            ProbeTarget::Piston(wall) => {
                if let Some(formula) = advance(wall + 1) {
                    take(format!("{}.advance", probe.name), formula);
                }
            }
            ProbeTarget::Stress => {
                let Some(domain) = scene.domain else {
                    return Err(
                        "mean stress needs a domain, for the box of the program grows with the grains".to_owned()
                    );
                };
                let count = scene.dimension.count();
                let volume: f64 = (domain.high - domain.low).iter().take(count).product();
                commands.push_str(&format!(
                    "compute virial all pressure {temperature} virial\ncompute touch {grains} contact/atom\n\
                     compute touching {grains} reduce ave c_touch\n"
                ));
                for (at, pair) in (1..).zip(VIRIAL) {
                    if count == 3 || !pair.contains('z') {
                        take(format!("{}.sigma_{pair}", probe.name), format!("-c_virial[{at}]*vol/{volume:?}"));
                    }
                }
                take(format!("{}.coordination", probe.name), "c_touching".to_owned());
            }
            _ => {}
        }
    }
    for Logged { name, formula, .. } in &all {
        commands.push_str(&format!("variable {name} equal {formula}\n"));
    }
    Ok((commands.trim_end().to_owned(), all))
}

/// What the log of the run says at the steps of a series, a column each.
pub(crate) fn read(logged: &[Logged], log: &Log, series: &Series) -> Vec<(String, Vec<f64>)> {
    let mut columns = Vec::new();
    for Logged { column, name, .. } in logged {
        let mut values = vec![f64::NAN; series.step.len()];
        for run in &log.runs {
            let (Some(step), Some(at)) = (
                run.thermo.column("Step"),
                run.thermo.column(&format!("v_{name}")).or_else(|| run.thermo.column(name)),
            ) else {
                continue;
            };
            for (step, value) in run.thermo.values(step).zip(run.thermo.values(at)) {
                // The step at which a run ends is printed once more by the one after it, before its lists of neighbours
                // are made: what was printed first holds.
                if let Some(first) = series.step.binary_search(&(step as u64)).ok().filter(|&at| values[at].is_nan()) {
                    values[first] = value;
                }
            }
        }
        columns.push((column.clone(), values));
    }
    columns
}
