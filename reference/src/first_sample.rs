//! First sample of the outputs: sizes, masses and motion of the grains, and the box.

use std::path::Path;

use grainbench_scene::dimension::Dimension;
use grainbench_scene::scene::Scene;

use crate::names::GrainColumns;
use crate::observer::Names;
use crate::outputs::OutputError;
use crate::read::format::{Snapshots, in_order, shown};
use crate::read::read_error::ReadError;
use crate::read::snapshot::{DumpKind, DumpSnapshot};

/// Reads the first sample of a dump into a scene: radii, masses, positions, velocities and spins of the grains, and the
/// bounds of periodic axes. Quantities that the file lacks stay as in the scene. Returns the names of the quantities read.
///
/// # Errors
/// If the file is damaged, contains no grains, or has another number of grains than the scene.
pub fn read_start(file: &Path, names: &Names, scene: &mut Scene) -> Result<Vec<&'static str>, OutputError> {
    let name = shown(file);
    let none = || OutputError::no_grains(&name);
    let files = in_order(&[file.to_owned()])?;
    let mut reader = Snapshots::open(files.first().ok_or_else(none)?, u64::MAX, false)?;
    let mut snapshot = DumpSnapshot::default();
    while snapshot.kind != DumpKind::Atoms || snapshot.columns.is_empty() {
        if !reader.read(&mut snapshot)? {
            return Err(none());
        }
    }
    let columns = GrainColumns::find(&snapshot, names);
    if let Some(id) = columns.id {
        snapshot.check_ids(&name, id)?;
    }
    if snapshot.rows() != scene.grains.len() {
        let expected = format!("{} grains, the number in the scene", scene.grains.len());
        return Err(ReadError::at(&name, snapshot.first_line, expected, snapshot.rows().to_string()).into());
    }
    let order = snapshot.rows_by(columns.id);
    let (flat, shape) = (scene.dimension == Dimension::Two, scene.grain_shape);
    let axes = scene.dimension.count();
    let mut read = Vec::new();
    let positive = |ours: &str, at: usize, scale: f64, row: usize| {
        let value = scale * snapshot.row(row)[at];
        if value.is_finite() && value > 0.0 {
            return Ok(value);
        }
        let line = snapshot.first_line + row as u64;
        Err(ReadError::at(&name, line, format!("a positive {ours}"), format!("{value:?}")))
    };
    if let Some((at, scale)) = columns.radius {
        read.push("radii");
        for (grain, &row) in scene.grains.iter_mut().zip(&order) {
            let density = grain.mass / shape.mass(grain.radius, 1.0);
            grain.radius = positive("radius", at, scale, row)?;
            grain.mass = shape.mass(grain.radius, density);
            grain.inertia = shape.inertia_factor() * grain.mass * grain.radius * grain.radius;
        }
    }
    if let Some(at) = columns.mass {
        read.push("masses");
        for (grain, &row) in scene.grains.iter_mut().zip(&order) {
            grain.mass = positive("mass", at, 1.0, row)?;
            grain.inertia = shape.inertia_factor() * grain.mass * grain.radius * grain.radius;
        }
    }
    let positions = &columns.position[..axes];
    if positions.iter().all(Option::is_some) {
        read.push("positions");
        for (grain, &row) in scene.grains.iter_mut().zip(&order) {
            for (axis, at) in positions.iter().enumerate() {
                grain.position[axis] = at.map_or(0.0, |at| at.value(snapshot.row(row)));
            }
        }
    }
    for (words, columns) in [("velocities", columns.velocity), ("spins", columns.spin)] {
        let range = match (flat, words) {
            (true, "spins") => 2..3,
            _ => 0..axes,
        };
        if !columns[range.clone()].iter().all(Option::is_some) {
            continue;
        }
        read.push(words);
        for (grain, &row) in scene.grains.iter_mut().zip(&order) {
            let vector = if words == "spins" { &mut grain.spin } else { &mut grain.velocity };
            for axis in range.clone() {
                vector[axis] = columns[axis].map_or(0.0, |at| snapshot.row(row)[at]);
            }
        }
    }
    let has_bounds = snapshot.bounds.0 != snapshot.bounds.1;
    if let Some(domain) = scene.domain.as_mut().filter(|domain| has_bounds && domain.periodic.contains(&true)) {
        read.push("box");
        let (low, high) = snapshot.bounds;
        for axis in (0..axes).filter(|&axis| domain.periodic[axis]) {
            (domain.low[axis], domain.high[axis]) = (low[axis], high[axis]);
        }
    }
    Ok(read)
}
