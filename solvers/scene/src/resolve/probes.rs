//! Probes, and the search for the objects that they name.

use super::{Groups, Resolver};
use crate::check::Checker;
use crate::error::SceneError;
use crate::file::ProbeSpec;
use crate::scene::{Block, BodyName, Driven, Grain, Probe, ProbeTarget, Spot, Wall};
use crate::stays::Stays;
use nalgebra::Vector3;

impl Resolver<'_> {
    pub(super) fn probe(
        &self,
        name: &str,
        spec: &ProbeSpec,
        names: &Names<'_>,
        spots: &mut Vec<Spot>,
    ) -> Result<Probe, SceneError> {
        let check = &self.check;
        let key = |part: &str| format!("probes.{name}.{part}");
        check.exactly_one(
            &format!("probes.{name}"),
            &[
                ("grain", spec.grain.is_some()),
                ("body", spec.body.is_some()),
                ("point", spec.point.is_some()),
                ("contact", spec.contact.is_some()),
                ("wall", spec.wall.is_some()),
                ("piston", spec.piston.is_some()),
                ("driven", spec.driven.is_some()),
                ("budget", spec.budget == Some(true)),
                ("stress", spec.stress == Some(true)),
                ("count", spec.count == Some(true)),
                ("system", spec.system == Some(true)),
            ],
        )?;
        let target = if let Some(grain) = &spec.grain {
            ProbeTarget::Grain(names.grain(check, &key("grain"), grain)?)
        } else if let Some(body) = &spec.body {
            ProbeTarget::Body(names.body(check, &key("body"), body)?)
        } else if let Some(point) = &spec.point {
            let body = match (&point.grain, &point.body) {
                (Some(grain), None) => BodyName::Grain(names.grain(check, &key("point.grain"), grain)?),
                (None, Some(body)) => BodyName::Body(names.body(check, &key("point.body"), body)?),
                _ => return Err(check.error(&key("point"), "one of `grain` and `body`", "both or none")),
            };
            let at = check.vector(&key("point.at"), &point.at)?;
            if let Some(away) = names.outside(&body, at, check.dimension.count()) {
                let found = format_args!("{:?}, {away:.3e} m outside", point.at);
                return Err(check.error(&key("point.at"), "a position inside the body at the start", found));
            }
            spots.push(Spot { body, at });
            ProbeTarget::Point(spots.len() - 1)
        } else if let Some([first, second]) = &spec.contact {
            let grain = names.grain(check, &key("contact"), first)?;
            match names.walls.iter().position(|wall| &wall.name == second) {
                Some(wall) => ProbeTarget::GrainWall(grain, wall),
                None => ProbeTarget::Pair(grain, names.grain_or_wall(check, &key("contact"), second)?),
            }
        } else if let Some(wall) = &spec.wall {
            let known = names.walls.iter().map(|wall| &wall.name);
            ProbeTarget::Wall(check.place_of(&key("wall"), wall, "a wall of this scene", known)?)
        } else if let Some(wall) = &spec.piston {
            let stays = |wall: &&Wall| wall.piston.is_some() && wall.until.is_none();
            let pressed = names.walls.iter().map(|wall| if stays(&wall) { wall.name.clone() } else { String::new() });
            let known: Vec<String> = pressed.collect();
            ProbeTarget::Piston(check.place_of(&key("piston"), wall, "a piston without `until`", known.iter())?)
        } else if let Some(group) = &spec.driven {
            let known = names.driven.iter().map(|driven| &driven.name);
            ProbeTarget::Driven(check.place_of(&key("driven"), group, "a group of driven grains", known)?)
        } else if spec.budget == Some(true) {
            ProbeTarget::Budget
        } else if spec.stress == Some(true) {
            ProbeTarget::Stress
        } else if spec.count == Some(true) {
            ProbeTarget::Count
        } else {
            ProbeTarget::System
        };
        let of_a_grain = matches!(target, ProbeTarget::Grain(_) | ProbeTarget::Pair(..) | ProbeTarget::GrainWall(..));
        let is_budget = target == ProbeTarget::Budget;
        let expected = "a probe of a wall, the system or a count, because grains are inserted or removed in this scene";
        let found = match target {
            ProbeTarget::Grain(_) => "a probe of a grain",
            ProbeTarget::Budget => "a probe of the budget",
            _ => "a probe of a contact",
        };
        let is_possible = names.stays.is_always() || !(of_a_grain || is_budget);
        check.require(is_possible, &format!("probes.{name}"), expected, found)?;
        let expected =
            "no budget in a scene with a piston, because the budget does not include the energy of the piston";
        let is_possible = !is_budget || names.walls.iter().all(|wall| wall.piston.is_none());
        check.require(is_possible, &key("budget"), expected, "one")?;
        Ok(Probe { name: name.to_owned(), target })
    }
}

/// Objects to which probes can refer.
pub(super) struct Names<'a> {
    pub(super) groups: &'a Groups,
    pub(super) grains: &'a [Grain],
    pub(super) bodies: &'a [Block],
    pub(super) walls: &'a [Wall],
    pub(super) driven: &'a [Driven],
    pub(super) stays: &'a Stays,
}

impl Names<'_> {
    fn body(&self, check: &Checker<'_>, key: &str, name: &str) -> Result<usize, SceneError> {
        check.place_of(key, name, "a body of this scene", self.bodies.iter().map(|body| &body.name))
    }

    /// Returns the distance (m) of a position from a body at the start; `None` if the position lies inside the body.
    fn outside(&self, body: &BodyName, at: Vector3<f64>, dimensions: usize) -> Option<f64> {
        let (away, size) = match *body {
            BodyName::Grain(grain) => {
                let Grain { position, radius, .. } = self.grains[grain];
                ((at - position).norm() - radius, radius)
            }
            BodyName::Body(place) => {
                let shape = self.bodies[place].shape;
                (shape.outside(at, dimensions), shape.length(dimensions))
            }
        };
        // Because of the tolerance, rounded positions on the surface count as inside.
        (away > 1e-6 * size).then_some(away)
    }

    /// Returns the index of the grain with a name. The name could also belong to a wall, so an error lists groups and
    /// walls.
    fn grain_or_wall(&self, check: &Checker<'_>, key: &str, name: &str) -> Result<usize, SceneError> {
        let group = name.rsplit_once('.').map_or(name, |(group, _)| group);
        if !self.groups.contains_key(name) && !self.groups.contains_key(group) {
            let walls: Vec<String> = self.walls.iter().map(|wall| wall.name.clone()).collect();
            check.place_of(key, name, "a group of grains or a wall", self.groups.keys().chain(&walls))?;
        }
        self.grain(check, key, name)
    }

    /// Returns the index of the grain with the name `group` (for a group of one grain) or `group.k`, k from 1.
    fn grain(&self, check: &Checker<'_>, key: &str, name: &str) -> Result<usize, SceneError> {
        let (group, number) = match name.rsplit_once('.').and_then(|(group, k)| Some((group, k.parse::<usize>().ok()?)))
        {
            Some((group, number)) if self.groups.contains_key(group) => (group, Some(number)),
            _ => (name, None),
        };
        let place = check.place_of(key, group, "a group of grains", self.groups.keys())?;
        let range = &self.groups[place];
        match number {
            Some(number) if (1..=range.len()).contains(&number) => Ok(range.start + number - 1),
            Some(_) => {
                let expected = format_args!("{group}.1 to {group}.{}", range.len());
                Err(check.error(key, expected, format_args!("`{name}`")))
            }
            None => {
                let expected = format_args!("{group}.k, with k from 1 to {}", range.len());
                check.require(range.len() == 1, key, expected, format_args!("`{name}`")).map(|()| range.start)
            }
        }
    }
}
