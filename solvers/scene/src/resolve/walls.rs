//! Walls and their motion.

use super::Resolver;
use crate::dimension::Dimension;
use crate::error::SceneError;
use crate::file::WallSpec;
use crate::motion::Motion;
use crate::scene::{Piston, Wall, WallShape};

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
}
