//! A contact as the last force evaluation saw it: what a snapshot and the energy budget are made of.

use super::chain::Answer;
use crate::geometry::Geometry;
use grainbench_lanes::Number;
use grainbench_scene::record::Partner;
use nalgebra::Vector3;

/// A contact as the last force evaluation saw it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Seen {
    /// Id of the first grain, from 1.
    pub(crate) grain: u32,
    /// The grain or wall that it touches.
    pub(crate) partner: Partner,
    /// Contact point (m), halfway through the overlap.
    pub(crate) point: Vector3<f64>,
    /// Unit normal e from the first grain to its partner.
    pub(crate) normal: Vector3<f64>,
    /// Overlap δ (m).
    pub(crate) overlap: f64,
    /// Normal force F_n (N), positive when it pushes apart.
    pub(crate) normal_force: f64,
    /// Tangential force F_s on the first grain (N).
    pub(crate) shear: Vector3<f64>,
    /// Whether Coulomb's limit was reached.
    pub(crate) slipping: bool,
    /// Energy in the springs (J).
    pub(crate) elastic_energy: f64,
    /// Work of friction in the step (J).
    pub(crate) rubbed: f64,
}

impl Seen {
    /// What is seen of an answer, the first if there are several, at the contact point of a grain whose centre (m) and
    /// radius (m) are given.
    pub(crate) fn new<S: Geometry, X: Number>(
        answer: &Answer<S, X>,
        grain: u32,
        partner: Partner,
        centre: Vector3<f64>,
        radius: f64,
    ) -> Self {
        let zero = answer.overlap.like(0.0);
        let vector = |of: S::Vectors<X>| Vector3::from(S::whole(of, zero).map(X::first));
        let (normal, overlap) = (vector(answer.normal), answer.overlap.first());
        Self {
            grain,
            partner,
            point: centre + normal * (radius - 0.5 * overlap),
            normal,
            overlap,
            normal_force: answer.normal_force.first(),
            shear: vector(S::along(answer.shear, answer.normal)),
            slipping: X::choose(answer.slipping, zero.like(1.0), zero).first() > 0.0,
            elastic_energy: answer.elastic_energy.first(),
            rubbed: answer.rubbed.first(),
        }
    }
}
