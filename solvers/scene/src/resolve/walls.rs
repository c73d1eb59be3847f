//! Walls and their motion.

use super::Resolver;
use crate::dimension::Dimension;
use crate::error::SceneError;
use crate::file::{PistonSpec, WallSpec};
use crate::motion::Motion;
use crate::scene::{Piston, Wall, WallShape};

impl Resolver<'_> {
    pub(super) fn wall(&self, name: &str, spec: &WallSpec) -> Result<Wall, SceneError> {
        let check = &self.check;
        let key = |part: &str| format!("walls.{name}.{part}");
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
            if !(length > 0.0 && length.is_finite()) {
                let found = format!("a vector of length {length}");
                return Err(check.error(&key("plane.normal"), "a direction", &found));
            }
            WallShape::Plane { point: check.vector(&key("plane.point"), &plane.point)?, normal: normal.normalize() }
        } else if let Some([from, to]) = &spec.segment {
            if check.dimension == Dimension::Three {
                return Err(check.error(&key("segment"), "a `rectangle` or `plane` in three dimensions", "a segment"));
            }
            let ends = [check.vector(&key("segment"), from)?, check.vector(&key("segment"), to)?];
            if ends[0] == ends[1] {
                return Err(check.error(&key("segment"), "two different points", "the same point twice"));
            }
            WallShape::Segment { ends }
        } else if let Some(rectangle) = &spec.rectangle {
            if check.dimension == Dimension::Two {
                return Err(check.error(&key("rectangle"), "a `segment` or `plane` in two dimensions", "a rectangle"));
            }
            let corner = check.vector(&key("rectangle.corner"), &rectangle.corner)?;
            let edges = [
                check.vector(&key("rectangle.edges"), &rectangle.edges[0])?,
                check.vector(&key("rectangle.edges"), &rectangle.edges[1])?,
            ];
            let lengths = edges[0].norm() * edges[1].norm();
            if lengths == 0.0 || edges[0].dot(&edges[1]).abs() > 1e-9 * lengths {
                let found = format!("{:?} and {:?}", rectangle.edges[0], rectangle.edges[1]);
                return Err(check.error(&key("rectangle.edges"), "two perpendicular edges", &found));
            }
            WallShape::Rectangle { corner, edges }
        } else if let Some(cylinder) = &spec.cylinder {
            let radius = check.positive(&key("cylinder.radius"), cylinder.radius, "radius (m)")?;
            self.round(&key("cylinder"), &cylinder.axis, [radius; 2])?
        } else if let Some(cone) = &spec.cone {
            for radius in cone.radii {
                check.not_negative(&key("cone.radii"), radius, "radius (m)")?;
            }
            if cone.radii[0] == cone.radii[1] {
                let found = format!("{} twice", cone.radii[0]);
                return Err(check.error(&key("cone.radii"), "two different radii (a `cylinder` has one)", &found));
            }
            self.round(&key("cone"), &cone.axis, cone.radii)?
        } else if let Some(mesh) = &spec.mesh {
            self.mesh(name, mesh)?
        } else {
            return Err(check.error(&format!("walls.{name}"), "a shape", "none"));
        };
        let material = self.material(&key("material"), &spec.material)?;
        let until = spec.until.map(|time| check.positive(&key("until"), time, "time (s)")).transpose()?;
        let motion = self.motion(&key("motion"), &spec.motion)?;
        let piston = spec.piston.as_ref().map(|piston| self.piston(name, piston, &shape, &motion)).transpose()?;
        Ok(Wall { name: name.to_owned(), material, shape, motion, piston, until })
    }

    fn piston(&self, wall: &str, spec: &PistonSpec, shape: &WallShape, motion: &Motion) -> Result<Piston, SceneError> {
        let check = &self.check;
        let key = |part: &str| format!("walls.{wall}.piston{part}");
        if !matches!(shape, WallShape::Plane { .. }) {
            return Err(check.error(&key(""), "a `plane` as piston", "another wall"));
        }
        if motion.phases.iter().any(|phase| phase.spin.norm() > 0.0) {
            return Err(check.error(&key(""), "a plane that does not rotate", "a rotating plane"));
        }
        Ok(Piston {
            force: check.finite(&key(".force"), spec.force, "force (N)")?,
            mass: check.positive(&key(".mass"), spec.mass, "mass (kg)")?,
            damping: check.not_negative(&key(".damping"), spec.damping, "damping (1/s)")?,
        })
    }

    fn round(&self, key: &str, axis: &[Vec<f64>; 2], radii: [f64; 2]) -> Result<WallShape, SceneError> {
        let check = &self.check;
        if check.dimension == Dimension::Two {
            return Err(check.error(key, "a `segment` or `plane` in two dimensions", "a round wall"));
        }
        let of_axis = format!("{key}.axis");
        let axis = [check.vector(&of_axis, &axis[0])?, check.vector(&of_axis, &axis[1])?];
        let length = (axis[1] - axis[0]).norm();
        if !(length > 0.0 && length.is_finite()) {
            return Err(check.error(&of_axis, "two different points", &format!("{length} m between them")));
        }
        Ok(WallShape::Round { axis, radii })
    }
}
