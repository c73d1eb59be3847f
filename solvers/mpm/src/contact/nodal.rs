//! Contact conditions at nodes that several bodies, or a body and a wall, share. The conditions of the original papers
//! constrain the velocity of each body relative to a common velocity v.
//!
//! v is the velocity of the wall or of the driven body, if there is one, otherwise that of the centre of mass. Consider
//! a body in contact, with velocity vᵍ and outward unit normal n. Its relative velocity is Δv = vᵍ − v, with normal
//! component Δv_n and tangential component Δv_t along the unit vector t. The new velocity is vᵍ − Δv_n (n + μ' t), with
//! μ' = min(μ, Δv_t/Δv_n) (Bardenhagen, Brackbill & Sulsky 2000, eqs. 20–23; Bardenhagen et al. 2001, eq. 10). The
//! contact condition depends on the paper:
//!
//! - 2000: approach, Δv_n > 0;
//! - 2001: compression, n·σn < 0, for any motion of the body. For a departing body Δv_t/Δv_n is negative, and the body
//!   sticks, as the equation states. The impulse is scaled by min(γ/(ε̇Δt), 1) with γ = 1/2 and the strain rate ε̇ that
//!   the impulse would cause in a cell (eqs. 17–22; eq. 22 prints `max`, which would increase the impulse).
//!
//! At a wall, n is opposite to the normal of the wall. The normals of two bodies are in general not opposite. Momentum is
//! conserved only if they are opposite.

use super::shared::{Field, Member, SharedNodes};
use super::{ContactPartner, Rules};
use crate::boundary::driven::Group;
use crate::boundary::walls::RigidPlane;
use crate::energy::ledger::Tally;
use crate::options::Contact;
use crate::points::body::Body;
use grainbench_solver::space::Space;

/// Safety factor γ of eq. 21.
const COLLAPSE: f64 = 0.5;

/// Traction divided by the modulus, below which a surface counts as traction-free.
const UNSTRESSED: f64 = 1e-9;

/// Walls and driven bodies. The reactions of contact are added to them as forces over the step.
pub(crate) struct ReactionReceivers<'a, S: Space> {
    pub(crate) walls: &'a mut [RigidPlane<S>],
    pub(crate) driven: &'a mut [Group<S>],
    /// Energies of contacts, if the run requests an energy budget.
    pub(crate) tally: Option<&'a mut Tally>,
}

/// Applies nodal contact to the velocities of `field`.
pub(crate) fn meet<S: Space>(
    rules: &Rules<'_>,
    bodies: &[Body],
    shared: &mut SharedNodes<S>,
    felt: &mut ReactionReceivers<'_, S>,
    field: &mut Field<'_, S>,
) {
    match rules.setting.contact {
        Contact::Gap => apply_pairs(rules, bodies, shared, felt, field),
        Contact::NoSlip => apply(&NoSlip, rules, bodies, shared, felt, field),
        Contact::Traction => apply(&Compression, rules, bodies, shared, felt, field),
        Contact::Kinematic | Contact::Penalty => apply(&Approach, rules, bodies, shared, felt, field),
    }
}

/// Contact condition of a body at a shared node.
trait Condition {
    /// True if the condition also changes the velocities of driven bodies.
    const CONSTRAINS_DRIVEN: bool;

    /// Returns the velocity that contact takes from a body; `None` if the body is not in contact. `relative` is its
    /// velocity relative to the common velocity (m/s). `surface` returns its surface, or `None` if it has none.
    fn change<'a, S: Space>(
        &self,
        rules: &Rules<'_>,
        relative: S::Vector,
        surface: impl FnOnce() -> Option<Surface<'a, S>>,
    ) -> Option<Change<S>>;
}

/// Velocity that contact takes from a body (m/s).
struct Change<S: Space> {
    total: S::Vector,
    /// Part of `total` that friction causes.
    friction: S::Vector,
}

/// Surface of a body at a shared node.
struct Surface<'a, S: Space> {
    body: &'a Body,
    /// Mass of the body at the node (kg), and mass of the other bodies. Walls and driven bodies have infinite mass.
    masses: [f64; 2],
    /// Outward unit normal.
    normal: S::Vector,
    /// Stress times volume (Pa m³).
    stress: S::Matrix,
    /// Coefficient of friction.
    friction: f64,
}

impl<S: Space> Surface<'_, S> {
    /// Returns the tangential part of a relative velocity with the normal component `along`, and the fraction of this
    /// part that friction takes. For departing bodies Δv_t/Δv_n is negative and therefore below μ.
    #[inline(always)]
    fn slide(&self, relative: S::Vector, along: f64) -> (S::Vector, f64) {
        let tangential = relative - self.normal * along;
        let size = S::dot(tangential, tangential).sqrt();
        let limit = self.friction * along;
        (tangential, if along > 0.0 && size > limit { limit / size } else { 1.0 })
    }
}

/// One velocity field for all bodies. A member of a group then represents all bodies, driven ones included.
struct NoSlip;

impl Condition for NoSlip {
    const CONSTRAINS_DRIVEN: bool = true;

    #[inline(always)]
    fn change<'a, S: Space>(
        &self,
        _: &Rules<'_>,
        relative: S::Vector,
        _: impl FnOnce() -> Option<Surface<'a, S>>,
    ) -> Option<Change<S>> {
        Some(Change { total: relative, friction: S::ORIGIN })
    }
}

/// Contact while bodies approach (Bardenhagen, Brackbill & Sulsky 2000).
struct Approach;

impl Condition for Approach {
    const CONSTRAINS_DRIVEN: bool = false;

    #[inline(always)]
    fn change<'a, S: Space>(
        &self,
        _: &Rules<'_>,
        relative: S::Vector,
        surface: impl FnOnce() -> Option<Surface<'a, S>>,
    ) -> Option<Change<S>> {
        let surface = surface()?;
        let along = S::dot(relative, surface.normal);
        if along <= 0.0 || along.is_nan() {
            return None;
        }
        let (tangential, taken) = surface.slide(relative, along);
        Some(Change { total: surface.normal * along + tangential * taken, friction: tangential * taken })
    }
}

/// Contact under compression, with a scaled impulse (Bardenhagen et al. 2001).
struct Compression;

impl Condition for Compression {
    const CONSTRAINS_DRIVEN: bool = false;

    #[inline(always)]
    fn change<'a, S: Space>(
        &self,
        rules: &Rules<'_>,
        relative: S::Vector,
        surface: impl FnOnce() -> Option<Surface<'a, S>>,
    ) -> Option<Change<S>> {
        let surface = surface()?;
        let Surface { body, masses, normal, .. } = surface;
        let along = S::dot(relative, normal);
        // A traction-free surface counts as in contact while bodies approach. Otherwise contact could not begin.
        let none = UNSTRESSED * body.deformable.longitudinal_modulus() * masses[0] / body.density;
        let is_compressed = S::dot(normal, surface.stress * normal) < if along > 0.0 { none } else { 0.0 };
        if !is_compressed {
            return None;
        }
        let (tangential, taken) = surface.slide(relative, along);
        let total = normal * along + tangential * taken;
        let worse = (masses[0] / masses[1]).max(1.0);
        let rate = (0..S::DIMENSION)
            .map(|axis| worse * S::component(total, axis).abs() / rules.lattice.cell[axis])
            .fold(0.0, f64::max);
        let scale = (COLLAPSE / (rate * rules.time_step)).min(1.0);
        Some(Change { total: total * scale, friction: tangential * (taken * scale) })
    }
}

/// Applies a contact condition at all shared nodes.
fn apply<S: Space, C: Condition>(
    condition: &C,
    rules: &Rules<'_>,
    bodies: &[Body],
    shared: &SharedNodes<S>,
    felt: &mut ReactionReceivers<'_, S>,
    field: &mut Field<'_, S>,
) {
    let ReactionReceivers { walls, driven, tally } = felt;
    for group in &shared.groups {
        let members = &shared.members[group.members.clone()];
        let (mut mass, mut momentum, mut before) = (0.0, S::ORIGIN, S::ORIGIN);
        for member in members {
            mass += member.mass;
            momentum += *field.velocity(member.slot) * member.mass;
            before += field.before(member.slot) * member.mass;
        }
        let mover = members.iter().find_map(|member| bodies[member.body as usize].driven).map(usize::from);
        let common = match (group.wall, mover) {
            (Some(wall), _) => walls[wall].velocity(group.position),
            (None, Some(mover)) => driven[mover].velocity,
            (None, None) => momentum * (1.0 / mass),
        };
        let moved = group.wall.is_some() || mover.is_some();
        let common_before = if moved { common } else { before * (1.0 / mass) };
        for member in members {
            let body = &bodies[member.body as usize];
            if body.driven.is_some() && !C::CONSTRAINS_DRIVEN {
                continue;
            }
            let velocity = *field.velocity(member.slot);
            let surface = || {
                let face = &shared.faces[member.slot];
                let (normal, friction) = if let Some(wall) = group.wall {
                    (-walls[wall].normal, rules.friction.between(body.material, walls[wall].material))
                } else {
                    let other = members.iter().find(|other| other.body != member.body);
                    let material = |other: &Member| bodies[other.body as usize].material;
                    let between = |other| rules.friction.between(body.material, material(other));
                    (face.normal, other.map_or(Some(0.0), between))
                };
                let (friction, length) = (friction?, S::dot(normal, normal).sqrt());
                let masses = [member.mass, if moved { f64::INFINITY } else { mass - member.mass }];
                let surface =
                    |size: f64| Surface::<S> { body, masses, normal: normal * size, stress: face.stress, friction };
                (length != 0.0).then(|| surface(1.0 / length))
            };
            let Some(Change { total, friction }) = condition.change(rules, velocity - common, surface) else {
                continue;
            };
            *field.velocity(member.slot) = velocity - total;
            if matches!(field, Field::Stepped(_)) {
                let impulse = total * member.mass;
                if let Some(tally) = tally {
                    tally.friction += member.mass * S::dot(friction, field.before(member.slot) - common_before);
                    if group.wall.is_some() {
                        tally.walls -= S::dot(impulse, common);
                    }
                }
                match (group.wall, mover) {
                    (Some(wall), _) => walls[wall].force += impulse * (1.0 / rules.time_step),
                    (None, Some(mover)) => driven[mover].force += impulse * (1.0 / rules.time_step),
                    (None, None) => {}
                }
            }
        }
    }
}

/// Applies contact to pairs of bodies, or of a body and a wall, whose surfaces intersect near a node.
///
/// While a pair approaches or is under pressure, an impulse along the common normal stops the relative motion, with
/// Coulomb friction. The pairs of each node are solved by projected Gauss–Seidel iteration. Impulses are equal and
/// opposite, so momentum is conserved to rounding for any number of bodies.
fn apply_pairs<S: Space>(
    rules: &Rules<'_>,
    bodies: &[Body],
    shared: &mut SharedNodes<S>,
    felt: &mut ReactionReceivers<'_, S>,
    field: &mut Field<'_, S>,
) {
    let ReactionReceivers { walls, driven, tally } = felt;
    let SharedNodes { meetings, faces, .. } = shared;
    for node in meetings.chunk_by_mut(|a, b| a.key == b.key) {
        let single = node.len() == 1;
        node.iter_mut().for_each(|meeting| meeting.impulse = S::ORIGIN);
        for _ in 0..if single { 1 } else { SWEEPS } {
            let mut largest = 0.0_f64;
            for meeting in node.iter_mut() {
                let (one, normal) = (meeting.slots[0], meeting.normal);
                let body = &bodies[meeting.body as usize];
                let (velocity, inverse, material, traction) = match meeting.other {
                    ContactPartner::Wall(wall) => {
                        let wall = &walls[usize::from(wall)];
                        (wall.velocity(meeting.position), 0.0, wall.material, S::NO_GRADIENT)
                    }
                    ContactPartner::Body(other) => {
                        let (two, other) = (meeting.slots[1], &bodies[other as usize]);
                        (*field.velocity(two), 1.0 / meeting.masses[1], other.material, faces[two].stress)
                    }
                };
                let Some(friction) = rules.friction.between(body.material, material) else { continue };
                let apart = *field.velocity(one) - velocity;
                let along = S::dot(apart, normal);
                let stress = faces[one].stress + traction;
                let pressing = S::dot(normal, stress * normal) < 0.0;
                let effective = 1.0 / (1.0 / meeting.masses[0] + inverse);
                let before = meeting.impulse;
                if along <= 0.0 && !pressing && S::dot(before, normal) <= 0.0 {
                    continue;
                }
                // Normal impulse on the contact partner. It stops the relative normal motion, and may be negative only
                // while the pair is under pressure.
                let sum = S::dot(before, normal) + effective * along;
                let push = if pressing { sum } else { sum.max(0.0) };
                let rubbed = before - normal * S::dot(before, normal) + (apart - normal * along) * effective;
                let size = S::dot(rubbed, rubbed).sqrt();
                let limit = friction * push.max(0.0);
                let rub = if size > limit { rubbed * (limit / size) } else { rubbed };
                let impulse = normal * push + rub;
                let change = impulse - before;
                meeting.impulse = impulse;
                *field.velocity(one) -= change * (1.0 / meeting.masses[0]);
                if let ContactPartner::Body(_) = meeting.other {
                    *field.velocity(meeting.slots[1]) += change * inverse;
                }
                if matches!(field, Field::Stepped(_)) {
                    let force = change * (1.0 / rules.time_step);
                    if let Some(tally) = tally {
                        let slip = match meeting.other {
                            ContactPartner::Body(_) => field.before(one) - field.before(meeting.slots[1]),
                            ContactPartner::Wall(_) => {
                                tally.walls -= S::dot(change, velocity);
                                field.before(one) - velocity
                            }
                        };
                        tally.friction += S::dot(change - normal * S::dot(change, normal), slip);
                    }
                    if let Some(mover) = body.driven {
                        driven[usize::from(mover)].force -= force;
                    }
                    match meeting.other {
                        ContactPartner::Wall(wall) => walls[usize::from(wall)].force += force,
                        ContactPartner::Body(other) => {
                            if let Some(mover) = bodies[other as usize].driven {
                                driven[usize::from(mover)].force += force;
                            }
                        }
                    }
                }
                largest = largest.max(S::dot(change, change) / (effective * effective));
            }
            if largest <= 1e-28 {
                break;
            }
        }
    }
}

/// Maximum number of sweeps over the pairs of a node.
const SWEEPS: usize = 12;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::FrictionTable;
    use crate::contact::shared::{Face, NodalContact};
    use crate::grid::lattice::Node;
    use crate::options::Setting;
    use crate::trial::prepared;
    use grainbench_solver::space::Plane;
    use nalgebra::Vector2;

    /// Returns the velocities after contact of three bodies of 1, 2 and 3 kg at a node. The first and second body are
    /// in contact along x, and so are the second and third body.
    fn after(friction: f64, velocities: [Vector2<f64>; 3]) -> [Vector2<f64>; 3] {
        let discs = ["a", "b", "c"].map(|name| format!("grains.{name} = {{ material = 'm', radius = 1.0, position = "));
        let text = format!(
            "dimension = 2\nduration = 1.0\nmaterials.m = {{ density = 1.0, young_modulus = 1.0, poisson_ratio = 0.0 }}\n\
             contacts.m = {{ between = ['m', 'm'], law = 'coulomb', friction = {friction} }}\n\
             {}[0.0, 0.0] }}\n{}[3.0, 0.0] }}\n{}[6.0, 0.0] }}\n",
            discs[0], discs[1], discs[2]
        );
        let setting = Setting::classic(Contact::Gap);
        let (simulation, _) = prepared::<Plane>(setting, &text, 2.0, 2);
        let mut shared = SharedNodes::<Plane>::default();
        shared.faces = vec![Face { normal: Vector2::zeros(), stress: nalgebra::Matrix2::zeros() }; 3];
        let masses = [1.0, 2.0, 3.0];
        shared.meetings = [0_usize, 1]
            .map(|one| NodalContact {
                key: 7,
                body: one as u32,
                other: ContactPartner::Body(one as u32 + 1),
                position: Vector2::zeros(),
                slots: [one, one + 1],
                masses: [masses[one], masses[one + 1]],
                normal: Vector2::x(),
                impulse: Vector2::zeros(),
            })
            .to_vec();
        let mut nodes: Vec<Node<Plane>> =
            (0..3).map(|at| Node { mass: masses[at], velocity: velocities[at], change: velocities[at] }).collect();
        let friction = FrictionTable::from_scene(&simulation.scene);
        let lattice = &simulation.grid.lattice;
        let rules = Rules { lattice, friction: &friction, setting: &setting, time_step: 1.0 };
        let mut felt = ReactionReceivers { walls: &mut [], driven: &mut [], tally: None };
        meet(&rules, &simulation.state.bodies, &mut shared, &mut felt, &mut Field::Stepped(&mut nodes));
        [0, 1, 2].map(|at| nodes[at].velocity)
    }

    /// Three bodies meet at a node. Each of twelve sweeps reduces the error of the second pair's impulse by the factor
    /// (1/m₂)²/((1/m₁ + 1/m₂)(1/m₂ + 1/m₃)) = 1/5. The first pair is solved with the impulse of the previous sweep. The
    /// error of the first velocity is then 5⁻¹¹ p₂/3, with p₂ = 5 N s for impacts from both sides, and smaller
    /// otherwise.
    #[test]
    fn three_bodies_at_a_node_end_with_one_velocity() {
        let vector = Vector2::new;
        let near = |found: [Vector2<f64>; 3], expected: [Vector2<f64>; 3]| {
            let off = found.iter().zip(expected).map(|(found, expected)| (found - expected).norm()).fold(0.0, f64::max);
            assert!(off < 3.5e-8, "{found:?}");
        };
        // The first body pushes the other two, and all have 1 · 1/(1 + 2 + 3) m/s. Without friction they slide along
        // each other.
        let [pushed, still] = [vector(1.0, 0.3), Vector2::zeros()];
        let sixth = 1.0 / 6.0;
        near(after(0.0, [pushed, still, still]), [vector(sixth, 0.3), vector(sixth, 0.0), vector(sixth, 0.0)]);
        // With very high friction the three bodies move as one.
        near(after(1e6, [pushed, still, still]), [vector(sixth, 0.05); 3]);
        // The last body departs freely. The first two have (1 + 0)/(1 + 2) m/s.
        let third = 1.0 / 3.0;
        near(after(0.0, [pushed, still, vector(5.0, 0.0)]), [vector(third, 0.3), vector(third, 0.0), vector(5.0, 0.0)]);
        // Impacts from both sides: all have (1 · 4 − 3 · 2)/6 m/s.
        let together = vector(-2.0 * sixth, 0.0);
        near(after(0.0, [vector(4.0, 0.0), still, vector(-2.0, 0.0)]), [together; 3]);
    }

    /// With μ = .1 the tangential impulse is .1 of the normal impulse. Two bodies of 1 and 2 kg meet at (6, 3) and 0
    /// m/s. The normal impulse is 6/(1 + ½) = 4 N s, and the tangential impulse .4 N s.
    #[test]
    fn friction_at_a_node_is_a_part_of_the_push() {
        let found = after(0.1, [Vector2::new(6.0, 3.0), Vector2::zeros(), Vector2::new(50.0, 0.2)]);
        let expected = [Vector2::new(2.0, 2.6), Vector2::new(2.0, 0.2), Vector2::new(50.0, 0.2)];
        assert!(found.iter().zip(expected).all(|(found, expected)| (found - expected).norm() < 1e-14), "{found:?}");
    }
}
