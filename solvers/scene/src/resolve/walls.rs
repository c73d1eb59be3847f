//! Walls and their motion. Walls of triangles are read from STL files.

use super::Resolver;
use crate::dimension::Dimension;
use crate::error::SceneError;
use crate::file::{LengthUnit, MeshSpec, WallSpec};
use crate::mesh::{Mesh, Reading, Surface, stl};
use crate::motion::Motion;
use crate::scene::{Domain, Grain, Piston, Wall, WallShape};
use nalgebra::Vector3;

/// Largest size of a file (B). A binary file of this size has about ten million triangles.
const MOST: u64 = 1 << 29;
/// Largest ratio of the size of a mesh to the size of the domain or of all grains together, whichever is larger. A mesh
/// that surrounds the grains has a ratio of about 1. A mesh in millimetres that is read as metres has a ratio a
/// thousand times too large.
const TOO_LARGE: f64 = 300.0;

impl Resolver<'_> {
    pub(super) fn wall(&self, name: &str, spec: &WallSpec) -> Result<Wall, SceneError> {
        let check = &self.check;
        let key = |part: &str| format!("walls.{name}.{part}");
        let is_flat = check.dimension == Dimension::Two;
        check.exactly_one(
            &format!("walls.{name}"),
            &[
                ("plane", spec.plane.is_some()),
                ("segment", spec.segment.is_some()),
                ("rectangle", spec.rectangle.is_some()),
                ("cylinder", spec.cylinder.is_some()),
                ("cone", spec.cone.is_some()),
                ("mesh", spec.mesh.is_some()),
            ],
        )?;
        let shape = if let Some(plane) = &spec.plane {
            let normal = check.vector(&key("plane.normal"), &plane.normal)?;
            let length = normal.norm();
            let found = format_args!("a vector of length {length}");
            check.require(length > 0.0 && length.is_finite(), &key("plane.normal"), "a direction", found)?;
            WallShape::Plane { point: check.vector(&key("plane.point"), &plane.point)?, normal: normal.normalize() }
        } else if let Some([from, to]) = &spec.segment {
            let key = key("segment");
            check.require(is_flat, &key, "a `rectangle` or `plane` in three dimensions", "a segment")?;
            let ends = [check.vector(&key, from)?, check.vector(&key, to)?];
            check.require(ends[0] != ends[1], &key, "two different points", "the same point twice")?;
            WallShape::Segment { ends }
        } else if let Some(rectangle) = &spec.rectangle {
            check.require(!is_flat, &key("rectangle"), "a `segment` or `plane` in two dimensions", "a rectangle")?;
            let corner = check.vector(&key("rectangle.corner"), &rectangle.corner)?;
            let (key, [u, v]) = (key("rectangle.edges"), &rectangle.edges);
            let edges = [check.vector(&key, u)?, check.vector(&key, v)?];
            let lengths = edges[0].norm() * edges[1].norm();
            let is_skew = lengths == 0.0 || edges[0].dot(&edges[1]).abs() > 1e-9 * lengths;
            check.require(!is_skew, &key, "two perpendicular edges", format_args!("{u:?} and {v:?}"))?;
            WallShape::Rectangle { corner, edges }
        } else if let Some(cylinder) = &spec.cylinder {
            let radius = check.positive(&key("cylinder.radius"), cylinder.radius, "radius (m)")?;
            self.round(&key("cylinder"), &cylinder.axis, [radius; 2])?
        } else if let Some(cone) = &spec.cone {
            for radius in cone.radii {
                check.not_negative(&key("cone.radii"), radius, "radius (m)")?;
            }
            let [first, last] = cone.radii;
            let expected = "two different radii (a `cylinder` has one)";
            check.require(first != last, &key("cone.radii"), expected, format_args!("{first} twice"))?;
            self.round(&key("cone"), &cone.axis, cone.radii)?
        } else if let Some(mesh) = &spec.mesh {
            self.mesh(name, mesh)?
        } else {
            return Err(check.error(&format!("walls.{name}"), "a shape", "none"));
        };
        let material = self.material(&key("material"), &spec.material)?;
        let until = spec.until.map(|time| check.positive(&key("until"), time, "time (s)")).transpose()?;
        let motion = self.motion(&key("motion"), &spec.motion)?;
        if let Some(piston) = &spec.piston {
            self.check_piston(name, piston, &shape, &motion)?;
        }
        Ok(Wall { name: name.to_owned(), material, shape, motion, piston: spec.piston, until })
    }

    fn check_piston(&self, wall: &str, spec: &Piston, shape: &WallShape, motion: &Motion) -> Result<(), SceneError> {
        let check = &self.check;
        let key = |part: &str| format!("walls.{wall}.piston{part}");
        let is_plane = matches!(shape, WallShape::Plane { .. });
        check.require(is_plane, &key(""), "a `plane` as piston", "another wall")?;
        check.require(!motion.rotates(), &key(""), "a plane that does not rotate", "a rotating plane")?;
        check.finite(&key(".force"), spec.force, "force (N)")?;
        check.positive(&key(".mass"), spec.mass, "mass (kg)")?;
        check.not_negative(&key(".damping"), spec.damping, "damping (1/s)").map(|_| ())
    }

    fn round(&self, key: &str, axis: &[Vec<f64>; 2], radii: [f64; 2]) -> Result<WallShape, SceneError> {
        let check = &self.check;
        let is_solid = check.dimension == Dimension::Three;
        check.require(is_solid, key, "a `segment` or `plane` in two dimensions", "a round wall")?;
        let key = format!("{key}.axis");
        let axis = [check.vector(&key, &axis[0])?, check.vector(&key, &axis[1])?];
        let length = (axis[1] - axis[0]).norm();
        let found = format_args!("{length} m between them");
        check.require(length > 0.0 && length.is_finite(), &key, "two different points", found)?;
        Ok(WallShape::Round { axis, radii })
    }

    fn mesh(&self, wall: &str, spec: &MeshSpec) -> Result<WallShape, SceneError> {
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
        let surface = read.map_err(|error| {
            let key = key(".file");
            SceneError { place: format!("{}: {key}: {}{}", check.source.place(&key), spec.file, error.place), ..error }
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
