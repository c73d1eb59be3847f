//! Keys of a scene that follow from overridden keys. The positions of grains that touch walls or other grains follow
//! their radii. Keys that a new contact law or new moduli exclude are removed.

use grainbench_cases::registry::read_grains;
use grainbench_cases::static_overlap;
use grainbench_scene::error::SceneError;
use grainbench_scene::nalgebra::Vector3;
use grainbench_scene::scene::{Scene, WallShape};
use grainbench_scene::source::SceneSource;
use std::path::Path;
use toml::Value;

/// Keys of a contact that only a linear law has, or whose values belong to its stiffness.
const LINEAR: [&str; 5] =
    ["normal_stiffness", "tangential_stiffness", "stiffness_damping", "normal_damping", "tangential_damping"];
/// Two equivalent pairs of elastic moduli. A material has one of the pairs.
const MODULI: [[&str; 2]; 2] = [["young_modulus", "poisson_ratio"], ["bulk_modulus", "shear_modulus"]];
/// Largest gap that counts as contact, and largest error of a moved position, as a fraction of the radius.
const TOUCHING: f64 = 1e-9;
/// Largest relative difference between the contact force and the weight of a grain at rest.
const AT_REST: f64 = 0.05;
/// Largest number of sweeps over the contacts.
const SWEEPS: usize = 100_000;

/// Scene with overridden keys and with the keys that follow from them.
pub struct AdaptedScene {
    /// Resolved scene.
    pub scene: Scene,
    /// Keys that follow from the overridden keys, with their values; an empty value removes the key.
    pub implied: Vec<(String, String)>,
    /// Indices of the grains that were moved because of a radius.
    pub moved: Vec<usize>,
}

/// Overrides keys of a scene, and changes the keys that follow from them.
///
/// # Errors
/// When the scene is invalid with the overridden keys.
pub fn adapted(source: &SceneSource, set: &[(String, String)]) -> Result<AdaptedScene, SceneError> {
    let mut implied = excluded_keys(source, set)?;
    let places = positions(source, &with(with(source.clone(), set), &implied), set)?;
    let moved = places.iter().map(|(grain, _)| *grain).collect();
    implied.extend(places.into_iter().map(|(_, key_and_value)| key_and_value));
    let scene = with(with(source.clone(), set), &implied).scene(&read_grains)?;
    Ok(AdaptedScene { scene, implied, moved })
}

fn with(source: SceneSource, set: &[(String, String)]) -> SceneSource {
    set.iter().fold(source, |source, (path, value)| source.set(path, value))
}

/// Returns the overridden keys as a table. Removed keys are not in it.
fn overlay(set: &[(String, String)]) -> Result<toml::Table, SceneError> {
    let empty = SceneSource::from_text("--set", Path::new(""), "");
    set.iter()
        .filter(|(_, value)| !value.is_empty())
        .fold(empty, |source, (path, value)| source.set(path, value))
        .table()
}

fn at<'t>(table: &'t toml::Table, path: &[&str]) -> Option<&'t Value> {
    let (last, path) = path.split_last()?;
    path.iter().try_fold(table, |table, key| table.get(*key)?.as_table())?.get(*last)
}

/// Returns the keys that the new law of a contact or the new moduli of a material exclude, each with an empty value.
fn excluded_keys(source: &SceneSource, set: &[(String, String)]) -> Result<Vec<(String, String)>, SceneError> {
    let (before, new) = (source.table()?, overlay(set)?);
    let mut excluded = Vec::new();
    let mut exclude = |path: [&str; 3]| {
        let key = path.join(".");
        let is_set = at(&new, &path).is_some() || set.iter().any(|(other, _)| *other == key);
        if at(&before, &path).is_some() && !is_set {
            excluded.push((key, String::new()));
        }
    };
    let entries = |table: &str| new.get(table).and_then(Value::as_table).into_iter().flatten();
    for (contact, keys) in entries("contacts") {
        let law = |table: &toml::Table| {
            at(table, &["contacts", contact, "law"]).and_then(Value::as_str).unwrap_or("linear").to_owned()
        };
        if keys.get("law").is_some() && law(&new) != "linear" && law(&before) == "linear" {
            LINEAR.iter().for_each(|key| exclude(["contacts", contact, key]));
        }
    }
    for (material, keys) in entries("materials") {
        for (given, other) in [(MODULI[0], MODULI[1]), (MODULI[1], MODULI[0])] {
            if given.iter().any(|key| keys.get(key).is_some()) && !other.iter().any(|key| keys.get(key).is_some()) {
                other.iter().for_each(|key| exclude(["materials", material, key]));
            }
        }
    }
    Ok(excluded)
}

/// Contact of a grain with a plane wall or with another grain, as a condition on the distance along its normal.
struct Contact {
    grain: usize,
    /// Other grain; `None` for a wall.
    other: Option<usize>,
    /// Unit vector towards the grain.
    normal: Vector3<f64>,
    /// Overlap before the change (m).
    overlap: f64,
    /// Change of the distance along the normal (m).
    change: f64,
}

/// New position of a grain: its index, and the key and the value of its position.
type NewPosition = (usize, (String, String));

/// Returns the new positions of the grains that touch a wall or a grain, if a radius changes. A grain at rest under its
/// weight is placed at its new static overlap; every other overlap keeps its ratio to the radius. Returns no position if
/// the grains cannot keep their contacts.
fn positions(
    source: &SceneSource,
    changed: &SceneSource,
    set: &[(String, String)],
) -> Result<Vec<NewPosition>, SceneError> {
    let new = overlay(set)?;
    let groups = new.get("grains").and_then(Value::as_table);
    if !groups.is_some_and(|groups| groups.values().any(|group| group.get("radius").is_some())) {
        return Ok(Vec::new());
    }
    let file = changed.scene_file()?;
    if file.grains.values().any(|group| group.position.is_none()) {
        return Ok(Vec::new());
    }
    let Ok(scene) = source.scene(&read_grains) else { return Ok(Vec::new()) };
    let names: Vec<&String> = file.grains.keys().collect();
    let radii: Vec<f64> = file.grains.values().map(|group| group.radius.unwrap_or(f64::NAN)).collect();
    if radii.len() != scene.grains.len() || !radii.iter().all(|radius| radius.is_finite() && *radius > 0.0) {
        return Ok(Vec::new());
    }
    let fixed: Vec<bool> = names.iter().map(|name| at(&new, &["grains", name, "position"]).is_some()).collect();
    let mut contacts = contacts(&scene);
    for contact in &mut contacts {
        let sum = |radius: &dyn Fn(usize) -> f64| radius(contact.grain) + contact.other.map_or(0.0, radius);
        let [before, after] = [sum(&|grain| scene.grains[grain].radius), sum(&|grain| radii[grain])];
        contact.change = (after - before) * (1.0 - contact.overlap / before);
    }
    let mut start = vec![Vector3::zeros(); radii.len()];
    for ((start, group), (grain, fixed)) in
        start.iter_mut().zip(file.grains.values()).zip(scene.grains.iter().zip(&fixed))
    {
        for (axis, coordinate) in group.position.iter().flatten().enumerate().take(3).filter(|_| *fixed) {
            start[axis] = coordinate - grain.position[axis];
        }
    }
    let Some(moves) = moves(&contacts, &fixed, &radii, start) else { return Ok(Vec::new()) };
    let place = |moves: &[Vector3<f64>]| -> Vec<NewPosition> {
        let axes = scene.dimension.count();
        let moved = (0..moves.len()).filter(|&grain| !fixed[grain] && moves[grain] != Vector3::zeros());
        let value = |grain: usize| {
            let position = scene.grains[grain].position + moves[grain];
            let numbers: Vec<String> = position.iter().take(axes).map(|number| rounded(*number)).collect();
            (format!("grains.{}.position", names[grain]), format!("[{}]", numbers.join(", ")))
        };
        moved.map(|grain| (grain, value(grain))).collect()
    };
    let provisional = place(&moves);
    let keys: Vec<_> = provisional.iter().map(|(_, key_and_value)| key_and_value.clone()).collect();
    let Ok(after) = with(changed.clone(), &keys).scene(&read_grains) else { return Ok(provisional) };
    let mut moves = moves;
    for contact in &contacts {
        let is_alone =
            contacts.iter().filter(|other| other.grain == contact.grain || other.other == Some(contact.grain));
        if contact.other.is_some() || is_alone.count() > 1 || contact.change == 0.0 {
            continue;
        }
        let at_rest = |scene: &Scene| {
            let grain = &scene.grains[contact.grain];
            let weight = -grain.mass * scene.gravity.dot(&contact.normal);
            let wall = scene.walls.iter().find(|wall| plane(&wall.shape).is_some_and(|(_, n)| n == contact.normal))?;
            let law = scene.law(grain.material, wall.material)?;
            (weight > 0.0).then(|| static_overlap(&law.springs, weight, grain.radius))
        };
        if let (Some(before), Some(rest)) = (at_rest(&scene), at_rest(&after))
            && (contact.overlap - before).abs() <= AT_REST * before
        {
            let grain = &after.grains[contact.grain];
            let ratio = contact.overlap / scene.grains[contact.grain].radius;
            moves[contact.grain] += contact.normal * (ratio * grain.radius - rest);
        }
    }
    Ok(place(&moves))
}

fn plane(shape: &WallShape) -> Option<(Vector3<f64>, Vector3<f64>)> {
    match shape {
        WallShape::Plane { point, normal } => Some((*point, *normal)),
        _ => None,
    }
}

/// Returns the contacts of a scene at its start, at plane walls and between grains.
fn contacts(scene: &Scene) -> Vec<Contact> {
    let mut contacts = Vec::new();
    for (grain, state) in scene.grains.iter().enumerate() {
        for (point, normal) in scene.walls.iter().filter_map(|wall| plane(&wall.shape)) {
            let overlap = state.radius - normal.dot(&(state.position - point));
            if overlap >= -TOUCHING * state.radius && overlap < state.radius {
                contacts.push(Contact { grain, other: None, normal, overlap, change: 0.0 });
            }
        }
        for (other, second) in scene.grains.iter().enumerate().take(grain) {
            let apart = state.position - second.position;
            let overlap = state.radius + second.radius - apart.norm();
            if overlap >= -TOUCHING * state.radius && apart.norm() > 0.0 {
                let normal = apart / apart.norm();
                contacts.push(Contact { grain, other: Some(other), normal, overlap, change: 0.0 });
            }
        }
    }
    contacts
}

/// Returns a coordinate with 13 significant digits, so that rounding errors do not show.
fn rounded(coordinate: f64) -> String {
    let text = format!("{coordinate:.12e}");
    text.parse::<f64>().map_or(text, |rounded| format!("{rounded:?}"))
}

/// Returns the displacements of the grains (m) that satisfy all conditions, found by projections onto one condition
/// after the other; `None` if the projections do not converge. Fixed grains keep their displacement in `moves`.
fn moves(
    contacts: &[Contact],
    fixed: &[bool],
    radii: &[f64],
    mut moves: Vec<Vector3<f64>>,
) -> Option<Vec<Vector3<f64>>> {
    for _ in 0..SWEEPS {
        let mut is_done = true;
        for contact in contacts {
            let free = |grain: &usize| !fixed[*grain];
            let (first, second) = (Some(contact.grain).filter(free), contact.other.filter(free));
            let count = usize::from(first.is_some()) + usize::from(second.is_some());
            if count == 0 {
                continue;
            }
            let other = contact.other.map_or(Vector3::zeros(), |other| moves[other]);
            let off = contact.change - contact.normal.dot(&(moves[contact.grain] - other));
            if off.abs() <= 1e-5 * TOUCHING * radii[contact.grain] {
                continue;
            }
            is_done = false;
            for (grain, sign) in [(first, 1.0), (second, -1.0)] {
                if let Some(grain) = grain {
                    moves[grain] += contact.normal * (sign * off / count as f64);
                }
            }
        }
        if is_done {
            return Some(moves);
        }
    }
    None
}
