//! Quantities that are read from the log of a run, because dumps of grains do not contain them: forces on walls, mean
//! stress, coordination number, and displacements of pistons.

use grainbench_scene::scene::{ProbeTarget, Scene};
use grainbench_solver::record::Series;

use super::outline::AXES;
use crate::read::log::Log;

/// Quantity in the log that becomes a column of the series.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct LogColumn {
    /// Column of the series, for example `floor.force_x`.
    pub(crate) column: String,
    /// Name of the variable. It is short, because LIGGGHTS truncates the names of columns.
    pub(crate) name: String,
    /// Formula in the script language of the program.
    pub(crate) formula: String,
}

/// Components of the virial in the order of both programs.
const VIRIAL: [&str; 6] = ["xx", "yy", "zz", "xy", "xz", "yz"];

/// Differences between the programs in the commands for logged quantities.
pub(crate) struct Sums<'a> {
    /// Temperature argument of `compute pressure`, whose contribution the keyword `virial` excludes.
    pub(crate) temperature: &'a str,
    /// Group of the grains.
    pub(crate) grains: &'a str,
    /// Function that returns the command and the components of the force of a wall on the grains. Walls are counted
    /// from 1.
    pub(crate) force: &'a dyn Fn(usize) -> (String, [String; 3]),
    /// Function that returns the formula for the displacement of a piston, or `None` if the wall is no piston. Walls
    /// are counted from 1.
    pub(crate) advance: &'a dyn Fn(usize) -> Option<String>,
}

/// Returns the commands that define the logged quantities of a scene, and the columns of the series.
///
/// `compute pressure` sums the forces between grains at the time of the step and divides by the volume of the program's
/// box, which may grow with the grains. The formula converts the result to the volume of the scene's domain.
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
                // The programs sum the force on the grains. The probe is the force on the wall.
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
                        "mean stress needs a domain, because the box of the program grows with the grains".to_owned()
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

/// Returns the values in the log at the steps of a series, one column per quantity. Missing values are NaN.
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
                // A later run prints the last step of the previous run again, before it builds neighbour lists. The
                // first value is valid.
                if let Some(first) = series.step.binary_search(&(step as u64)).ok().filter(|&at| values[at].is_nan()) {
                    values[first] = value;
                }
            }
        }
        columns.push((column.clone(), values));
    }
    columns
}
