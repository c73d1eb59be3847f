//! Friction of springs: what a tracer feels along the surface that it has gone through, or that nothing rubs.
//!
//! Along the surface a spring is stretched by the slip and limited by Coulomb friction (Cundall & Strack 1979): F_s =
//! −k s, |F_s| ≤ μ k g, with s the stretch (m), g the depth (m) and k the stiffness of the tracer's springs (N/m).

use super::Other;
use crate::off::Off;
use grainbench_scene::space::Space;
use serde::{Deserialize, Serialize};

/// A tracer that has gone through another surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Overlap<S: Space> {
    /// How deep it is (m).
    pub(crate) depth: f64,
    /// Unit normal out of what it has gone into.
    pub(crate) normal: S::Vector,
    /// Stiffness k of its springs (N/m).
    pub(crate) stiffness: f64,
    /// How far it moves against the other surface in the step (m).
    pub(crate) slip: S::Vector,
    /// Coefficient of friction μ.
    pub(crate) friction: f64,
}

impl<S: Space> Overlap<S> {
    /// What of a vector is along the surface.
    #[inline(always)]
    fn along(&self, vector: S::Vector) -> S::Vector {
        vector - self.normal * S::dot(vector, self.normal)
    }
}

/// What friction answers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shear<S: Space> {
    /// Force along the surface (N).
    pub(crate) force: S::Vector,
    /// Stretch of the spring before the step and after it (m).
    stretch: [S::Vector; 2],
    /// Whether Coulomb's limit was reached.
    pub(crate) slipping: bool,
}

impl<S: Space> Shear<S> {
    /// Force along the surface after `slip` more, and the spring's new stretch: −k s, at most μ times the push.
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

    /// Work of friction in the step (J), in which the spring went from one stretch to another and slid for the rest of
    /// the slip: the mean force of the spring times what its end slid.
    #[inline(always)]
    pub(crate) fn rubbed(&self, overlap: &Overlap<S>) -> f64 {
        let [before, after] = self.stretch;
        let along = overlap.along(before + overlap.slip - after);
        0.5 * overlap.stiffness * S::dot(before + after, along)
    }

    /// Energy in the springs across and along the surface, ½ k (g² + s²) (J).
    #[inline(always)]
    pub(crate) fn energy(&self, overlap: &Overlap<S>) -> f64 {
        let [_, stretch] = self.stretch;
        0.5 * overlap.stiffness * (overlap.depth * overlap.depth + S::dot(stretch, stretch))
    }

    /// The same at the end of the step, when points and stresses are looked at: forces are those at its beginning. A
    /// spring that slips stores no more.
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

/// Friction of the springs of tracers, or its absence.
pub(crate) trait Tangential<S: Space> {
    /// Whether there is a force along surfaces at all.
    const ACTIVE: bool;
    /// What a tracer feels along the surface of what it has gone into.
    fn respond(&mut self, tracer: usize, other: Other, overlap: &Overlap<S>) -> Shear<S>;
}

impl<S: Space> Tangential<S> for Off {
    const ACTIVE: bool = false;

    /// Surfaces slip wherever they move along each other.
    #[inline(always)]
    fn respond(&mut self, _tracer: usize, _other: Other, overlap: &Overlap<S>) -> Shear<S> {
        let along = overlap.along(overlap.slip);
        let slipping = overlap.stiffness * S::dot(along, along).sqrt() > 0.0;
        Shear { force: S::ORIGIN, stretch: [S::ORIGIN; 2], slipping }
    }
}

/// Springs along the surface that a tracer can have at a time.
const AT_ONCE: usize = 4;

/// A spring along the surface.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(bound = "")]
struct Spring<S: Space> {
    /// What the tracer touches.
    other: Other,
    /// Evaluation at which it last touched.
    stamp: u64,
    /// Stretch (m).
    stretch: S::Vector,
}

/// Springs along the surface of every tracer; one that did not touch at the last evaluation has been forgotten.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(bound = "")]
pub(crate) struct Coulomb<S: Space> {
    of: Vec<[Spring<S>; AT_ONCE]>,
    now: u64,
}

impl<S: Space> Coulomb<S> {
    fn new(tracers: usize) -> Self {
        let none = Spring { other: Other::Wall(u16::MAX), stamp: 0, stretch: S::ORIGIN };
        Self { of: vec![[none; AT_ONCE]; tracers], now: 1 }
    }

    /// Stretch of the spring of a tracer to what it touches; it counts as touching now.
    #[inline(always)]
    fn stretch(&mut self, tracer: usize, other: Other) -> &mut S::Vector {
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
}

impl<S: Space> Tangential<S> for &mut Coulomb<S> {
    const ACTIVE: bool = true;

    #[inline(always)]
    fn respond(&mut self, tracer: usize, other: Other, overlap: &Overlap<S>) -> Shear<S> {
        let stretch = self.stretch(tracer, other);
        let shear = Shear::new(*stretch, overlap);
        *stretch = shear.stretch[1];
        shear
    }
}

/// Friction of a scene's springs.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(bound = "")]
pub(crate) enum Friction<S: Space> {
    /// μ = 0 for all laws, or bodies meet at nodes.
    Absent,
    /// Every tracer has springs.
    Present(Coulomb<S>),
}

impl<S: Space> Friction<S> {
    /// That of so many tracers, if it `acts`.
    pub(crate) fn new(acts: bool, tracers: usize) -> Self {
        if acts { Self::Present(Coulomb::new(tracers)) } else { Self::Absent }
    }

    /// Begins an evaluation.
    pub(crate) const fn begin(&mut self) {
        if let Self::Present(springs) = self {
            springs.now += 1;
        }
    }

    /// Memory that is in use (B).
    pub(crate) fn bytes(&self) -> usize {
        match self {
            Self::Absent => 0,
            Self::Present(springs) => size_of_val(&*springs.of),
        }
    }

    /// Whether it is that of as many tracers as another one, or as absent.
    pub(crate) const fn is_like(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Absent, Self::Absent) => true,
            (Self::Present(one), Self::Present(two)) => one.of.len() == two.of.len(),
            _ => false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use grainbench_scene::space::Plane;
    use nalgebra::Vector2;

    /// What a tracer with springs of 200 N/m that is .01 m deep feels along x, after it has slipped by `slip` (m).
    fn force(friction: &mut Friction<Plane>, slip: f64, coefficient: f64) -> f64 {
        let Friction::Present(springs) = friction else { return f64::NAN };
        let (normal, slip) = (Vector2::y(), Vector2::new(slip, 0.0));
        let overlap = Overlap { depth: 0.01, normal, stiffness: 200.0, slip, friction: coefficient };
        Tangential::respond(&mut &mut *springs, 0, Other::Wall(0), &overlap).force.x
    }

    /// A spring is stretched for as long as its tracer touches, and no longer: after a hop it begins at nothing again.
    #[test]
    fn a_hop_leaves_no_stretch() {
        let mut friction = Friction::<Plane>::new(true, 1);
        for (touches, slip, expected) in [
            (true, 1e-3, -0.2),
            (true, 1e-3, -0.4),
            (true, 0.0, -0.4),
            // One evaluation without a touch, and the first one after it.
            (false, 0.0, f64::NAN),
            (true, 0.0, 0.0),
            (true, -1e-3, 0.2),
        ] {
            friction.begin();
            if touches {
                let found = force(&mut friction, slip, 1.0);
                assert!((found - expected).abs() < 1e-15, "{found} for {expected}");
            }
        }
    }

    /// A slipping tracer feels μ k g, whatever the stretch: μ 200 · .01 N. Two thousandths more of μ are two thousandths
    /// more of it, and springs half as stiff half of it.
    #[test]
    fn what_slips_feels_the_coefficient_of_friction() {
        for coefficient in [0.3, 0.3 * 1.002] {
            let mut friction = Friction::<Plane>::new(true, 1);
            for _ in 0..3 {
                friction.begin();
                let found = force(&mut friction, 0.1, coefficient);
                assert!((found / (-2.0 * coefficient) - 1.0).abs() < 1e-14, "{found} of {coefficient}");
            }
        }
    }
}
