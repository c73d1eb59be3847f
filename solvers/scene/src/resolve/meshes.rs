//! Walls of triangles, read from STL files.

use super::Resolver;
use crate::dimension::Dimension;
use crate::error::SceneError;
use crate::file::{LengthUnit, MeshSpec};
use crate::mesh::{Flaw, Mesh, Place, Reading, Surface, stl};
use crate::scene::{Domain, Grain, Wall, WallShape};
use nalgebra::Vector3;

/// Largest size of a file (B). A binary file of this size has about ten million triangles.
const MOST: u64 = 1 << 29;
/// Largest ratio of the size of a mesh to the size of the domain or of all grains together, whichever is larger. A mesh
/// that surrounds the grains has a ratio of about 1. A mesh in millimetres that is read as metres has a ratio a
/// thousand times too large.
const TOO_LARGE: f64 = 300.0;

impl Resolver<'_> {
    pub(super) fn mesh(&self, wall: &str, spec: &MeshSpec) -> Result<WallShape, SceneError> {
        let check = &self.check;
        let key = |part: &str| format!("walls.{wall}.mesh{part}");
        let is_solid = check.dimension == Dimension::Three;
        check.require(is_solid, &key(""), "a `segment` or `plane` in two dimensions", "a mesh")?;
        let merge = check.not_negative(&key(".merge"), spec.merge, "length (m)")?;
        let has_inside = !(spec.open && spec.inward);
        check.require(has_inside, &key(".inward"), "a mesh that encloses a volume", "a mesh that is `open`")?;
        let path = check.source.directory.join(&spec.file);
        let unreadable = |found: String| check.error(&key(".file"), "a file of triangles (STL)", &found);
        let length = std::fs::metadata(&path).map_err(|error| unreadable(error.to_string()))?;
        if !length.is_file() || length.len() > MOST {
            let found = if length.is_file() {
                format!("{} bytes, more than {MOST}", length.len())
            } else {
                "no file".to_owned()
            };
            return Err(unreadable(found));
        }
        let bytes = std::fs::read(&path).map_err(|error| unreadable(error.to_string()))?;
        let unit = match spec.unit {
            LengthUnit::M => 1.0,
            LengthUnit::Mm => 1e-3,
        };
        let reading = Reading { unit, merge, open: spec.open, inward: spec.inward };
        let read = stl::read(&bytes).and_then(|facets| Surface::new(&facets, reading));
        let surface = read.map_err(|Flaw { expected, found, place, help }| {
            let (key, file) = (key(".file"), &spec.file);
            let in_file = place.map(Place::after_name).unwrap_or_default();
            let place = format!("{}: {key}: {file}{in_file}", check.source.place(&key));
            SceneError { place, key: String::new(), expected, found, help }
        })?;
        Ok(WallShape::Mesh(Mesh::at_rest(surface)))
    }

    /// Rejects a mesh so much larger than all grains and the domain that its unit must be wrong.
    pub(super) fn refuse_other_units(
        &self,
        grains: &[Grain],
        walls: &[Wall],
        domain: Option<&Domain>,
    ) -> Result<(), SceneError> {
        let start = (Vector3::repeat(f64::INFINITY), Vector3::repeat(f64::NEG_INFINITY));
        let (low, high) = grains.iter().fold(start, |(low, high), grain| {
            (low.inf(&grain.position.add_scalar(-grain.radius)), high.sup(&grain.position.add_scalar(grain.radius)))
        });
        let size = domain.map_or(0.0, |domain| (domain.high - domain.low).norm()).max((high - low).norm());
        for wall in walls {
            let WallShape::Mesh(mesh) = &wall.shape else { continue };
            let (low, high) = mesh.surface.bounds();
            let own = (high - low).norm();
            if own > TOO_LARGE * size {
                let expected =
                    format!("a mesh no more than {TOO_LARGE} times as large as all grains together or the domain");
                let found = format!("a mesh of {own} m for {size} m");
                let spec = self.file.walls.get(&wall.name).and_then(|spec| spec.mesh.as_ref());
                let help = match spec.map(|spec| spec.unit) {
                    Some(LengthUnit::M) => {
                        "set `unit = \"mm\"` if the file is in millimetres, or add a `domain` if this size is intended"
                    }
                    _ => "add a `domain` if this size is intended",
                };
                let key = format!("walls.{}.mesh.unit", wall.name);
                return Err(self.check.source.error(&key, &expected, &found, Some(help.to_owned())));
            }
        }
        Ok(())
    }
}
