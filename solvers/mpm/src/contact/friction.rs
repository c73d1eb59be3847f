//! Friction of contact springs: the tangential force on a surface tracer that penetrates another surface.
//!
//! A tangential spring is displaced by the slip and limited by Coulomb friction (Cundall & Strack 1979): F_s = −k s,
//! |F_s| ≤ μ k g. Here s is the tangential spring displacement (m), g the depth (m) and k the stiffness of the tracer's
//! springs (N/m).

use super::ContactPartner;
use grainbench_solver::space::Space;
use serde::{Deserialize, Serialize};

/// Overlap of a tracer that penetrates another surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Overlap<S: Space> {
    /// Depth (m).
    pub(crate) depth: f64,
    /// Outward unit normal of the penetrated body.
    pub(crate) normal: S::Vector,
    /// Stiffness k of the tracer's springs (N/m).
    pub(crate) stiffness: f64,
    /// Displacement of the tracer relative to the penetrated surface in the step (m).
    pub(crate) slip: S::Vector,
    /// Coefficient of friction μ.
    pub(crate) friction: f64,
}

impl<S: Space> Overlap<S> {
    /// Returns the component of a vector parallel to the surface.
    #[inline(always)]
    fn along(&self, vector: S::Vector) -> S::Vector {
        vector - self.normal * S::dot(vector, self.normal)
    }
}

/// Tangential response of a contact.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shear<S: Space> {
    /// Force along the surface (N).
    pub(crate) force: S::Vector,
    /// Tangential spring displacement before and after the step (m).
    stretch: [S::Vector; 2],
    /// True if the Coulomb limit was reached.
    pub(crate) slipping: bool,
}

impl<S: Space> Shear<S> {
    /// Computes the new spring displacement and the tangential force −k s after a further `slip`. The force is limited
    /// to μ times the normal force.
    #[inline(always)]
    fn new(stretch: S::Vector, overlap: &Overlap<S>) -> Self {
        let Overlap { depth, stiffness, slip, friction, .. } = *overlap;
        let along = overlap.along(stretch + slip);
        let size = stiffness * S::dot(along, along).sqrt();
        let limit = friction * stiffness * depth;
        if size <= limit {
            Self { force: along * -stiffness, stretch: [stretch, along], slipping: false }
        } else {
            let kept = along * (limit / size);
            Self { force: kept * -stiffness, stretch: [stretch, kept], slipping: true }
        }
    }

    /// Returns the response without friction. Surfaces slip if they move along each other.
    #[inline(always)]
    pub(crate) fn without_friction(overlap: &Overlap<S>) -> Self {
        let along = overlap.along(overlap.slip);
        let slipping = overlap.stiffness * S::dot(along, along).sqrt() > 0.0;
        Self { force: S::ORIGIN, stretch: [S::ORIGIN; 2], slipping }
    }

    /// Returns the frictional work in the step (J): the mean spring force times the sliding displacement of the
    /// spring's end.
    ///
    /// The sliding displacement is the slip minus the change of the spring displacement.
    #[inline(always)]
    pub(crate) fn rubbed(&self, overlap: &Overlap<S>) -> f64 {
        let [before, after] = self.stretch;
        let along = overlap.along(before + overlap.slip - after);
        0.5 * overlap.stiffness * S::dot(before + after, along)
    }

    /// Returns the energy in the normal and tangential springs, ½ k (g² + s²) (J).
    #[inline(always)]
    pub(crate) fn energy(&self, overlap: &Overlap<S>) -> f64 {
        let [_, stretch] = self.stretch;
        0.5 * overlap.stiffness * (overlap.depth * overlap.depth + S::dot(stretch, stretch))
    }

    /// Returns the spring energy at the end of the step (J), when points and stresses are observed.
    ///
    /// Spring forces belong to the beginning of the step. A spring that slips stays at the Coulomb limit, so its
    /// displacement changes in proportion to the depth. A spring that sticks is displaced by the slip.
    #[inline(always)]
    pub(crate) fn energy_ahead(&self, overlap: &Overlap<S>) -> f64 {
        let Overlap { depth, normal, stiffness, slip, .. } = *overlap;
        let [_, stretch] = self.stretch;
        let away = S::dot(slip, normal);
        let deeper = (depth - away).max(0.0);
        let stretched = if self.slipping { stretch * (deeper / depth) } else { stretch + slip - normal * away };
        0.5 * stiffness * (deeper * deeper + S::dot(stretched, stretched))
    }
}

/// Maximum number of tangential springs of a tracer.
const AT_ONCE: usize = 4;

/// Tangential contact spring of a tracer to one partner.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(bound = "")]
struct Spring<S: Space> {
    /// Contact partner of the tracer.
    other: ContactPartner,
    /// Number of the evaluation at which the spring was last in contact.
    stamp: u64,
    /// Tangential spring displacement (m).
    stretch: S::Vector,
}

/// Tangential springs of all tracers. A spring that had no contact at the previous evaluation restarts at zero
/// displacement.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(bound = "")]
pub(crate) struct Coulomb<S: Space> {
    of: Vec<[Spring<S>; AT_ONCE]>,
    now: u64,
}

impl<S: Space> Coulomb<S> {
    /// Creates the tangential springs of a number of tracers.
    pub(crate) fn new(tracers: usize) -> Self {
        let none = Spring { other: ContactPartner::Wall(u16::MAX), stamp: 0, stretch: S::ORIGIN };
        Self { of: vec![[none; AT_ONCE]; tracers], now: 1 }
    }

    /// Returns the number of tracers.
    pub(crate) const fn tracers(&self) -> usize {
        self.of.len()
    }

    /// Returns the memory in use (bytes).
    pub(crate) fn bytes(&self) -> usize {
        size_of_val(&*self.of)
    }

    /// Starts a new evaluation of all contacts.
    pub(crate) const fn begin(&mut self) {
        self.now += 1;
    }

    /// Returns the tangential spring displacement of a tracer and contact partner, and marks the spring as in contact.
    #[inline(always)]
    fn stretch(&mut self, tracer: usize, other: ContactPartner) -> &mut S::Vector {
        let (now, springs) = (self.now, &mut self.of[tracer]);
        let same = springs.iter().position(|spring| spring.other == other);
        let oldest = || (1..AT_ONCE).fold(0, |a, b| if springs[b].stamp < springs[a].stamp { b } else { a });
        let at = same.unwrap_or_else(oldest);
        let spring = &mut springs[at];
        if same.is_none() || spring.stamp + 1 < now {
            *spring = Spring { other, stamp: now, stretch: S::ORIGIN };
        }
        spring.stamp = now;
        &mut spring.stretch
    }

    /// Computes the tangential response of a tracer that penetrates `other`.
    #[inline(always)]
    pub(crate) fn respond(&mut self, tracer: usize, other: ContactPartner, overlap: &Overlap<S>) -> Shear<S> {
        let stretch = self.stretch(tracer, other);
        let shear = Shear::new(*stretch, overlap);
        *stretch = shear.stretch[1];
        shear
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use grainbench_solver::space::Plane;
    use nalgebra::Vector2;

    /// Returns the force along x on a tracer with springs of 200 N/m at a depth of .01 m, after it has slipped by `slip` (m).
    fn force(springs: &mut Coulomb<Plane>, slip: f64, coefficient: f64) -> f64 {
        let (normal, slip) = (Vector2::y(), Vector2::new(slip, 0.0));
        let overlap = Overlap { depth: 0.01, normal, stiffness: 200.0, slip, friction: coefficient };
        springs.respond(0, ContactPartner::Wall(0), &overlap).force.x
    }

    /// A spring keeps its displacement only during contact. After an evaluation without contact it restarts at zero.
    #[test]
    fn a_hop_leaves_no_stretch() {
        let mut springs = Coulomb::<Plane>::new(1);
        for (touches, slip, expected) in [
            (true, 1e-3, -0.2),
            (true, 1e-3, -0.4),
            (true, 0.0, -0.4),
            // An evaluation without contact, and the first evaluation after it.
            (false, 0.0, f64::NAN),
            (true, 0.0, 0.0),
            (true, -1e-3, 0.2),
        ] {
            springs.begin();
            if touches {
                let found = force(&mut springs, slip, 1.0);
                assert!((found - expected).abs() < 1e-15, "{found} for {expected}");
            }
        }
    }

    /// A spring of 200 N/m is pulled by .03 m from rest. Its force is limited to 2 N, at a displacement of .01 m. Its
    /// end slides by .02 m under a mean force of 1 N. If it is pulled by .01 m more, its end slides by .01 m under 2 N.
    #[test]
    fn what_slides_rubs_off_the_mean_force_times_its_way() {
        let normal = Vector2::y();
        for (before, slip, work) in [(0.0, 0.03, 0.02), (0.01, 0.01, 0.02), (0.0, 0.01, 0.0)] {
            let slip = Vector2::new(slip, 0.0);
            let overlap = Overlap::<Plane> { depth: 0.01, normal, stiffness: 200.0, slip, friction: 1.0 };
            let found = Shear::new(Vector2::new(before, 0.0), &overlap).rubbed(&overlap);
            assert!((found - work).abs() < 1e-15, "{found} J for {work} J");
        }
    }

    /// A slipping tracer has the force μ k g = μ · 200 N/m · .01 m, independent of the displacement. The force is
    /// proportional to μ, so an increase of μ by two thousandths increases the force by the same ratio.
    #[test]
    fn what_slips_feels_the_coefficient_of_friction() {
        for coefficient in [0.3, 0.3 * 1.002] {
            let mut springs = Coulomb::<Plane>::new(1);
            for _ in 0..3 {
                springs.begin();
                let found = force(&mut springs, 0.1, coefficient);
                assert!((found / (-2.0 * coefficient) - 1.0).abs() < 1e-14, "{found} of {coefficient}");
            }
        }
    }
}
