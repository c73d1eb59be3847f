//! Quantities read from the log of a run. They are sums over all contacts, which dumps of grains do not contain.

use grainbench_scene::record::Series;
use grainbench_scene::scene::{ProbeTarget, Scene};

use super::outline::AXES;
use crate::read::log::Log;

/// Column of the log that is also a column of the series.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct LogColumn {
    /// Column of the series, for example `floor.force_x`.
    pub(crate) column: String,
    /// Name of the variable. It is short and plain, because LIGGGHTS truncates the names of columns.
    pub(crate) name: String,
    /// Formula in the language of the program.
    pub(crate) formula: String,
}

/// Components of the virial in the order of both programs.
const VIRIAL: [&str; 6] = ["xx", "yy", "zz", "xy", "xz", "yz"];

/// Names that a program uses in its sums.
pub(crate) struct Sums<'a> {
    /// Temperature that the program excludes from its pressure.
    pub(crate) temperature: &'a str,
    /// Group of the grains.
    pub(crate) grains: &'a str,
    /// Returns the command and the components of the force of a wall on the grains, by the number of the wall from 1.
    pub(crate) force: &'a dyn Fn(usize) -> (String, [String; 3]),
    /// Returns the displacement of a piston by the number of its wall from 1, or `None` if the program has no piston
    /// there.
    pub(crate) advance: &'a dyn Fn(usize) -> Option<String>,
}

/// Returns the commands that define the columns, and the columns.
///
/// The pressure of the programs contains the forces between grains at the time of the step. It is divided by the
/// volume of a box that grows with the grains. The formula converts it to the volume of the scene's domain.
pub(crate) fn logged(scene: &Scene, program: &Sums<'_>) -> Result<(String, Vec<LogColumn>), String> {
    let Sums { temperature, grains, force, advance } = program;
    let (mut commands, mut all) = (String::new(), Vec::new());
    let mut take = |column: String, formula: String| {
        let name = format!("g{}", all.len() + 1);
        all.push(LogColumn { column, name, formula });
    };
    for probe in &scene.probes {
        match probe.target {
            ProbeTarget::Wall(wall) => {
                let (command, components) = force(wall + 1);
                commands.push_str(&command);
                // The programs sum the force on the grains; the probe is the force on the wall.
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
    for LogColumn { name, formula, .. } in &all {
        commands.push_str(&format!("variable {name} equal {formula}\n"));
    }
    Ok((commands.trim_end().to_owned(), all))
}

/// Returns the values of the log at the steps of a series, one column per quantity.
pub(crate) fn read(logged: &[LogColumn], log: &Log, series: &Series) -> Vec<(String, Vec<f64>)> {
    let mut columns = Vec::new();
    for LogColumn { column, name, .. } in logged {
        let mut values = vec![f64::NAN; series.step.len()];
        for run in &log.runs {
            let (Some(step), Some(at)) = (
                run.thermo.column("Step"),
                run.thermo.column(&format!("v_{name}")).or_else(|| run.thermo.column(name)),
            ) else {
                continue;
            };
            for (step, value) in run.thermo.values(step).zip(run.thermo.values(at)) {
                // The next run prints the last step of a run again before it builds neighbour lists. The value
                // printed first is valid.
                if let Some(first) = series.step.binary_search(&(step as u64)).ok().filter(|&at| values[at].is_nan()) {
                    values[first] = value;
                }
            }
        }
        columns.push((column.clone(), values));
    }
    columns
}
