//! Check of the time step during a run. It finds contacts that are too stiff for the time step.

use crate::geometry::Geometry;
use crate::simulation::DemSimulation;
use crate::walls::MovingWall;
use grainbench_solver::failure::{Cause, SimulationFailure};

impl<S: Geometry> DemSimulation<S> {
    /// Returns an error if 2√(m/k) of a contact is below the time step. m is the smaller mass of the two bodies, and k the
    /// normal or the tangential stiffness, whichever is larger. A smaller time step can still be unstable: a pair of
    /// equal grains has the critical step √2 √(m/k).
    pub(crate) fn refuse_stiff_contacts(&self) -> Result<(), Box<SimulationFailure>> {
        let grains = &self.grains;
        for share in &self.neighbours.list.shares {
            for pairs in [&share.across.pairs, &share.near.pairs] {
                for at in pairs.own() {
                    let [one, other] = [pairs.row[at], pairs.partner[at]].map(|slot| slot as usize);
                    let shift = pairs.shift.get(at).map_or_else(Default::default, S::vector_in_space);
                    let apart = (grains.position(other) - grains.position(one) - shift).norm_squared();
                    let [first, second] = [one, other].map(|slot| grains.radius(slot));
                    let reach = first + second;
                    if apart < reach * reach {
                        let inverse_mass = grains.inverse_mass(one).max(grains.inverse_mass(other));
                        let (overlap, radius) = (reach - apart.sqrt(), first * second / reach);
                        self.refuse_stiff(one, grains.material[other], overlap, radius, inverse_mass)?;
                    }
                }
            }
        }
        self.walls.iter().try_for_each(|wall| self.refuse_stiff_at(wall))
    }

    fn refuse_stiff_at(&self, wall: &MovingWall) -> Result<(), Box<SimulationFailure>> {
        for (slot, distance) in wall.distances(&self.grains) {
            let (radius, inverse_mass) = (self.grains.radius(slot), self.grains.inverse_mass(slot));
            if distance < radius {
                self.refuse_stiff(slot, wall.initial.material, radius - distance, radius, inverse_mass)?;
            }
        }
        Ok(())
    }

    /// Checks a contact of the grain in a slot with a body of the material `other`. `radius` is the effective radius
    /// R₁R₂/(R₁+R₂), or R at a wall (m), and `inverse_mass` that of the lighter body (1/kg).
    fn refuse_stiff(
        &self,
        slot: usize,
        other: u16,
        overlap: f64,
        radius: f64,
        inverse_mass: f64,
    ) -> Result<(), Box<SimulationFailure>> {
        let Some(law) = self.scene.law(self.grains.material[slot], other) else { return Ok(()) };
        let (normal, tangential) = law.springs.stiffness(overlap, radius);
        let stiffness = normal.max(if law.has_friction() { tangential } else { 0.0 });
        let time_step = self.motion.time_step;
        if time_step * time_step * stiffness * inverse_mass <= 4.0 {
            return Ok(());
        }
        let critical = 2.0 / (stiffness * inverse_mass).sqrt();
        let tenth = 0.1 * critical;
        let advice = format!("a step of at most {tenth:.4e} s, a tenth of the critical one, resolves the contact");
        let position = self.grains.position(slot);
        Err(self.failure(slot, position, Cause::StiffContact { stiffness }, critical, advice))
    }
}
