//! Deformable bodies other than grains.

use super::Resolver;
use crate::body::{Block, BlockShape, Hold, InitialStress, Sides, Wave};
use crate::dimension::Dimension;
use crate::error::SceneError;
use crate::file::BodySpec;
use crate::scene::Grain;
use nalgebra::Matrix3;
use std::f64::consts::PI;

impl Resolver<'_> {
    pub(super) fn bodies(&self) -> Result<Vec<Block>, SceneError> {
        self.file.bodies.iter().map(|(name, spec)| self.body(name, spec)).collect()
    }

    fn body(&self, name: &str, spec: &BodySpec) -> Result<Block, SceneError> {
        let check = &self.check;
        let key = |part: &str| format!("bodies.{name}.{part}");
        let material = self.material(&key("material"), &spec.material)?;
        let density = self.density(material)?;
        check.exactly_one(
            &format!("bodies.{name}"),
            &[("box", spec.cuboid.is_some()), ("annulus", spec.annulus.is_some())],
        )?;
        let shape = self.block_shape(name, spec)?;
        let wave = match (&spec.wave, shape) {
            (None, _) => None,
            (Some(wave), BlockShape::Box { low, high }) if wave.mode > 0 => Some(Wave {
                amplitude: check.finite(&key("wave.amplitude"), wave.amplitude, "velocity (m/s)")?,
                wave_number: (2.0 * f64::from(wave.mode) - 1.0) * PI / (2.0 * (high.x - low.x)),
            }),
            (Some(_), _) => return Err(check.error(&key("wave"), "a mode of 1 or more, for a box", "something else")),
        };
        Ok(Block {
            name: name.to_owned(),
            material,
            density,
            shape,
            velocity: check.vector_or_zero(&key("velocity"), spec.velocity.as_ref())?,
            spin: self.spin(&key("spin"), spec.spin.as_ref())?,
            stretch: check.vector_or_zero(&key("stretch"), spec.stretch.as_ref())?,
            stress: self.initial_stress(name, spec, material)?,
            sides: self.sides(name, spec)?,
            wave,
        })
    }

    fn initial_stress(&self, name: &str, spec: &BodySpec, material: u16) -> Result<Option<InitialStress>, SceneError> {
        let check = &self.check;
        let key = |part: &str| format!("bodies.{name}.{part}");
        let gradient = match (&spec.stress, &spec.stress_gradient) {
            (None, None) => return Ok(None),
            (_, gradient) => gradient.clone().unwrap_or_default(),
        };
        let is_only = self.file.initial_pressure.is_none();
        check.require(is_only, &key("stress"), "one of `stress` and `initial_pressure`", "both")?;
        let of_material = &self.file.materials[usize::from(material)];
        let Some(moduli) = of_material.deformable(&spec.material, check)? else {
            return Err(check.error(
                &key("stress"),
                "a material with elastic moduli",
                format_args!("`{}`", spec.material),
            ));
        };
        // In two dimensions there is no strain along z (plane strain), so σ_zz = ν (σ_xx + σ_yy).
        let tensor = |part: &str, rows: Option<&Vec<Vec<f64>>>| -> Result<Matrix3<f64>, SceneError> {
            let mut stress = rows.map_or(Ok(Matrix3::zeros()), |rows| check.symmetric(&key(part), rows))?;
            if check.dimension == Dimension::Two {
                stress.m33 = moduli.poisson_ratio() * (stress.m11 + stress.m22);
            }
            Ok(stress)
        };
        let is_of_scene = gradient.z.is_none() || check.dimension == Dimension::Three;
        check.require(is_of_scene, &key("stress_gradient.z"), "axes of the scene, `x` or `y`", "`z`")?;
        Ok(Some(InitialStress {
            centre: tensor("stress", spec.stress.as_ref())?,
            gradient: [
                tensor("stress_gradient.x", gradient.x.as_ref())?,
                tensor("stress_gradient.y", gradient.y.as_ref())?,
                tensor("stress_gradient.z", gradient.z.as_ref())?,
            ],
        }))
    }

    fn block_shape(&self, name: &str, spec: &BodySpec) -> Result<BlockShape, SceneError> {
        let check = &self.check;
        let key = |part: &str| format!("bodies.{name}.{part}");
        if let Some(ring) = &spec.annulus {
            let is_flat = check.dimension == Dimension::Two;
            check.require(is_flat, &key("annulus"), "a `box` in three dimensions", "a ring")?;
            let inner = check.positive(&key("annulus.inner"), ring.inner, "radius (m)")?;
            let outer = check.positive(&key("annulus.outer"), ring.outer, "radius (m)")?;
            let found = format_args!("{inner} to {outer}");
            check.require(outer > inner, &key("annulus.outer"), "a radius above `inner`", found)?;
            let centre = check.vector(&key("annulus.centre"), &ring.centre)?;
            return Ok(BlockShape::Annulus { centre, inner, outer });
        }
        let Some(corners) = &spec.cuboid else {
            return Err(check.error(&format!("bodies.{name}"), "a shape", "none"));
        };
        let low = check.vector(&key("box.low"), &corners.low)?;
        let high = check.vector(&key("box.high"), &corners.high)?;
        let is_above = (0..check.dimension.count()).all(|axis| high[axis] > low[axis]);
        let found = format_args!("{:?} to {:?}", corners.low, corners.high);
        check.require(is_above, &key("box.high"), "a corner above `low`", found)?;
        Ok(BlockShape::Box { low, high })
    }

    fn sides(&self, name: &str, spec: &BodySpec) -> Result<Sides, SceneError> {
        let mut sides = Sides::default();
        for (list, held, what) in [(&spec.sliding, Hold::Sliding, "sliding"), (&spec.fixed, Hold::Fixed, "fixed")] {
            for side in list {
                let [axis, end] = side.axis_and_end();
                let has_side = spec.annulus.is_none() && axis < self.check.dimension.count();
                let key = format!("bodies.{name}.{what}");
                self.check.require(has_side, &key, "sides that the body has", format_args!("{side:?}"))?;
                sides[axis][end] = held;
            }
        }
        Ok(sides)
    }

    /// Returns the reference length of the file (m). If it is not given, the result is the smallest radius of a grain
    /// or, without grains, the smallest characteristic length of a body.
    pub(super) fn reference_length(&self, grains: &[Grain], bodies: &[Block]) -> Result<f64, SceneError> {
        if let Some(length) = self.file.reference_length {
            return self.check.positive("reference_length", length, "length (m)");
        }
        let smallest = grains.iter().map(|grain| grain.radius).reduce(f64::min);
        let dimensions = self.check.dimension.count();
        let edge = || bodies.iter().map(|body| body.shape.length(dimensions)).fold(f64::INFINITY, f64::min);
        Ok(smallest.unwrap_or_else(edge))
    }
}
