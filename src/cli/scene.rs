//! `grainbench scene`: prints the resolved scene that external solvers get, or the schema of scene files.

use super::exit::{Fault, Outcome, print_json, print_with};
use super::subject;
use super::value::{Step, path_and_value, positive};
use grainbench::reference::outside::{self, DiscretizedScene, Resolved, SceneFormat};
use grainbench::solver::resolution::Resolution;

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Case, variant of a case, or scene file.
    #[arg(value_name = "CASE|CASE/VARIANT|SCENE.toml", required_unless_present = "schema")]
    scene: Option<String>,
    /// Print the JSON schema of scene files or of resolved scenes, instead of a scene. Default: `file`.
    #[arg(long, value_enum, num_args = 0..=1, require_equals = true, default_missing_value = "file")]
    #[arg(conflicts_with_all = ["scene", "set", "format", "time_step", "time_step_fraction", "cells"])]
    schema: Option<Schema>,
    /// Override one key of the scene. Repeatable.
    #[arg(long, value_name = "PATH=VALUE", value_parser = path_and_value)]
    set: Vec<(String, String)>,
    /// Format of the resolved scene.
    #[arg(long, default_value = "json", value_parser = ["json", "toml"])]
    format: String,
    #[command(flatten)]
    step: Step,
    /// Number of cells per reference length, instead of a time step, for solvers with deformable bodies.
    #[arg(long, value_name = "NUMBER", value_parser = positive, conflicts_with_all = ["time_step", "time_step_fraction"])]
    cells: Option<f64>,
}

#[derive(Clone, Copy, clap::ValueEnum)]
pub(crate) enum Schema {
    /// Scene files.
    File,
    /// Resolved scenes, as external solvers get them.
    Resolved,
}

pub(crate) fn print_schema(kind: Schema) -> Outcome {
    match kind {
        Schema::File => print_json(&grainbench::scene::schema()),
        Schema::Resolved => print_json(&outside::schema()),
    }
}

/// Prints the resolved scene or a schema.
pub(crate) fn scene(arguments: &Arguments) -> Outcome {
    let Some(name) = &arguments.scene else { return print_schema(arguments.schema.unwrap_or(Schema::File)) };
    let (scene, _) = subject::scene(name, &arguments.set)?;
    let resolution = arguments
        .cells
        .map_or_else(|| arguments.step.resolution(), |cells| Resolution::grid(cells, Resolution::POINTS));
    if let Some(reason) = outside::inexpressible(&scene) {
        return Err(Fault::input(reason));
    }
    let given = DiscretizedScene::new(&scene, &resolution).map_err(Fault::input)?;
    let format = if arguments.format == "toml" { SceneFormat::Toml } else { SceneFormat::Json };
    let resolved = Resolved::new(&given);
    print_with(|out| {
        resolved.write(format, out)?;
        out.write_all(b"\n")
    })
}
