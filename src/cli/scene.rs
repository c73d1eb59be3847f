//! `grainbench scene`: prints the resolved scene that external solvers receive.

use super::exit::{Fault, Outcome, print};
use super::step::Step;
use super::subject;
use super::value::{path_and_value, positive};
use grainbench::reference::outside::{DiscretizedScene, Resolved, SceneFormat};
use grainbench::scene::solver::Resolution;
use std::process::ExitCode;

/// Arguments of the command.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Case, variant of a case, or scene file.
    #[arg(value_name = "CASE|CASE/VARIANT|SCENE.toml")]
    scene: String,
    /// Override one key of the scene; repeatable.
    #[arg(long, value_name = "PATH=VALUE", value_parser = path_and_value)]
    set: Vec<(String, String)>,
    /// Format of the output.
    #[arg(long, value_enum, default_value = "json")]
    format: Format,
    #[command(flatten)]
    step: Step,
    /// Cells of a grid per reference length, instead of a time step, for solvers with deformable bodies.
    #[arg(long, value_name = "NUMBER", value_parser = positive, conflicts_with_all = ["time_step", "time_step_fraction"])]
    cells: Option<f64>,
}

/// Formats.
#[derive(Clone, Copy, clap::ValueEnum)]
enum Format {
    Json,
    Toml,
}

/// Prints the resolved scene.
pub(crate) fn scene(arguments: &Arguments) -> Outcome {
    let (scene, _) = subject::scene(&arguments.scene, &arguments.set)?;
    let resolution = arguments
        .cells
        .map_or_else(|| arguments.step.resolution(), |cells| Resolution::grid(cells, Resolution::POINTS));
    let given = DiscretizedScene::new(&scene, &resolution).map_err(Fault::input)?;
    let format = match arguments.format {
        Format::Json => SceneFormat::Json,
        Format::Toml => SceneFormat::Toml,
    };
    print(&(Resolved::new(&given).text(format).map_err(Fault::input)? + "\n"))?;
    Ok(ExitCode::SUCCESS)
}
