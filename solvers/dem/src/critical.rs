//! Check of the critical time step during a run, for contacts that stiffen until the time step is too long.

use crate::geometry::Geometry;
use crate::simulation::DemSimulation;
use crate::walls::MovingWall;
use grainbench_scene::contact_law::{ContactLaw, SpringsKind};
use grainbench_scene::solver::{Cause, FailedParticle, SimulationFailure};

/// Contact to be checked.
struct CheckedContact<'a> {
    law: Option<&'a ContactLaw>,
    /// Slot of a grain.
    slot: usize,
    /// Overlap (m).
    overlap: f64,
    /// Effective radius (m).
    radius: f64,
    /// Larger of the inverse masses (1/kg).
    inverse_mass: f64,
}

impl<S: Geometry> DemSimulation<S> {
    /// Enables periodic checks of contacts, unless unstable steps are allowed. They apply if the stiffness of contacts
    /// changes, or if the time step already exceeds the critical one of the scene.
    pub(crate) fn follow_critical_step(&mut self, allow_unstable: bool) {
        let curved = self.scene.laws.iter().flatten().any(|law| law.springs.kind() == SpringsKind::HertzMindlin);
        self.follows_critical = !allow_unstable && (curved || self.motion.time_step > self.critical);
    }

    /// Rejects a contact whose critical step 2√(m/k) is below the time step. m is the smaller mass, and k the larger
    /// one of the normal and tangential stiffness.
    pub(crate) fn refuse_stiff_contacts(&self) -> Result<(), Box<SimulationFailure>> {
        let grains = &self.grains;
        for share in &self.neighbours.shares {
            for pairs in [&share.across, &share.near] {
                for at in pairs.own() {
                    let [one, other] = [pairs.row[at], pairs.partner[at]].map(|slot| slot as usize);
                    let shift = pairs.shift.get(at).map_or_else(Default::default, S::vector_in_space);
                    let apart = (grains.position(other) - grains.position(one) - shift).norm_squared();
                    let [first, second] = [one, other].map(|slot| grains.radius(slot));
                    let reach = first + second;
                    if apart < reach * reach {
                        self.refuse_stiff(&CheckedContact {
                            law: self.scene.law(grains.material[one], grains.material[other]),
                            slot: one,
                            overlap: reach - apart.sqrt(),
                            radius: first * second / reach,
                            inverse_mass: grains.inverse_mass(one).max(grains.inverse_mass(other)),
                        })?;
                    }
                }
            }
        }
        self.walls.iter().try_for_each(|wall| self.refuse_stiff_at(wall))
    }

    fn refuse_stiff_at(&self, wall: &MovingWall) -> Result<(), Box<SimulationFailure>> {
        for (slot, distance) in wall.distances(&self.grains) {
            let radius = self.grains.radius(slot);
            if distance < radius {
                self.refuse_stiff(&CheckedContact {
                    law: self.scene.law(self.grains.material[slot], wall.material()),
                    slot,
                    overlap: radius - distance,
                    radius,
                    inverse_mass: self.grains.inverse_mass(slot),
                })?;
            }
        }
        Ok(())
    }

    fn refuse_stiff(&self, look: &CheckedContact<'_>) -> Result<(), Box<SimulationFailure>> {
        let Some(law) = look.law else { return Ok(()) };
        let (normal, tangential) = law.springs.stiffness(look.overlap, look.radius);
        let stiffness = normal.max(if law.has_friction() { tangential } else { 0.0 });
        let time_step = self.motion.time_step;
        if time_step * time_step * stiffness * look.inverse_mass <= 4.0 {
            return Ok(());
        }
        let critical = 2.0 / (stiffness * look.inverse_mass).sqrt();
        Err(Box::new(SimulationFailure {
            time: self.time(),
            step: self.step,
            subject: FailedParticle::Grain(self.grains.id[look.slot] + 1),
            position: self.grains.position(look.slot),
            cause: Cause::StiffContact { stiffness },
            time_step,
            critical,
            advice: format!("a step of at most {:.4e} s, a tenth of that, resolves the contact", 0.1 * critical),
        }))
    }
}
