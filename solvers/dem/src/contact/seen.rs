//! A contact as the last force evaluation saw it: what a snapshot and the energy budget are made of.

use super::chain::Answer;
use grainbench_scene::record::Partner;
use grainbench_scene::space::Space;

/// A contact as the last force evaluation saw it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Seen<S: Space> {
    /// Id of the first grain, from 1.
    pub(crate) grain: u32,
    /// The grain or wall that it touches.
    pub(crate) partner: Partner,
    /// Contact point (m), halfway through the overlap.
    pub(crate) point: S::Vector,
    /// Unit normal e from the first grain to its partner.
    pub(crate) normal: S::Vector,
    /// Overlap δ (m).
    pub(crate) overlap: f64,
    /// Normal force F_n (N), positive when it pushes apart.
    pub(crate) normal_force: f64,
    /// Tangential force F_s on the first grain (N).
    pub(crate) shear: S::Tangent,
    /// Whether Coulomb's limit was reached.
    pub(crate) slipping: bool,
    /// Energy in the springs (J).
    pub(crate) elastic_energy: f64,
    /// Work of friction in the step (J).
    pub(crate) rubbed: f64,
}

impl<S: Space> Seen<S> {
    /// What is seen of an answer, at the contact point of a grain whose centre (m) and radius (m) are given.
    pub(crate) fn new(answer: &Answer<S>, grain: u32, partner: Partner, centre: S::Vector, radius: f64) -> Self {
        Self {
            grain,
            partner,
            point: centre + answer.normal * (radius - 0.5 * answer.overlap),
            normal: answer.normal,
            overlap: answer.overlap,
            normal_force: answer.normal_force,
            shear: answer.shear,
            slipping: answer.slipping,
            elastic_energy: answer.elastic_energy,
            rubbed: answer.rubbed,
        }
    }
}
