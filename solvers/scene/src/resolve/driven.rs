//! Grains with prescribed motion.

use super::{Groups, Resolver};
use crate::error::SceneError;
use crate::file::{DrivenSpec, SideSpec};
use crate::motion::Moment;
use crate::scene::{Domain, Driven, Grain};

impl Resolver<'_> {
    /// Returns the groups of grains with prescribed motion. If the motion of a group starts at t = 0, its grains get
    /// the `velocity` and the `spin` of the group as initial values.
    pub(super) fn driven(
        &self,
        grains: &mut [Grain],
        groups: &Groups,
        domain: Option<&Domain>,
    ) -> Result<Vec<Driven>, SceneError> {
        let mut taken = vec![false; grains.len()];
        let mut all = Vec::new();
        for (name, spec) in &self.file.driven {
            let key = format!("driven.{name}");
            let members = self.members(&key, spec, grains, groups, domain)?;
            self.check.require(!members.is_empty(), &key, "at least one grain", "none")?;
            let span = self.span(&key, spec)?;
            let velocity = self.check.vector_or_zero(&format!("{key}.velocity"), spec.velocity.as_ref())?;
            for &grain in &members {
                let is_taken = std::mem::replace(&mut taken[grain], true);
                let found = format_args!("grain {} in two groups", grain + 1);
                self.check.require(!is_taken, &key, "grains that are in only one driven group", found)?;
            }
            let spin = self.spin(&format!("{key}.spin"), spec.spin.as_ref())?;
            let key = format!("{key}.motion");
            let motion = self.motion(&key, &spec.motion)?;
            let expected =
                "a motion without spin (the key `spin` next to `motion` rotates each grain about its own centre)";
            self.check.require(!motion.rotates(), &key, expected, "a motion with spin")?;
            let in_cycles = |moment: Moment| matches!(moment, Moment::Cycle(_));
            let is_in_cycles = motion.phases.iter().any(|phase| in_cycles(phase.start) || in_cycles(phase.stop));
            self.check.require(!is_in_cycles, &key, "times in seconds", "a time in cycles")?;
            let driven = Driven { name: name.clone(), grains: members, velocity, span, spin, motion };
            if driven.is_moved_at(0.0) {
                for &grain in &driven.grains {
                    (grains[grain].velocity, grains[grain].spin) = (velocity, spin);
                }
            }
            all.push(driven);
        }
        Ok(all)
    }

    /// Returns the start and the end of the prescribed motion (s). The end is infinite if it is not given.
    fn span(&self, key: &str, spec: &DrivenSpec) -> Result<[f64; 2], SceneError> {
        let start = self.check.not_negative(&format!("{key}.start"), spec.start.unwrap_or(0.0), "time (s)")?;
        let Some(stop) = spec.stop else { return Ok([start, f64::INFINITY]) };
        let key = format!("{key}.stop");
        let stop = self.check.positive(&key, stop, "time (s)")?;
        self.check.require(stop > start, &key, format!("a time after the start at {start} s"), stop)?;
        Ok([start, stop])
    }

    fn members(
        &self,
        key: &str,
        spec: &DrivenSpec,
        grains: &[Grain],
        groups: &Groups,
        domain: Option<&Domain>,
    ) -> Result<Vec<usize>, SceneError> {
        let check = &self.check;
        let kinds = [
            ("grains", spec.grains.is_some()),
            ("material", spec.material.is_some()),
            ("face", spec.face.is_some()),
            ("region", spec.region.is_some()),
        ];
        check.exactly_one(key, &kinds)?;
        if let Some(group) = &spec.grains {
            let place = check.place_of(&format!("{key}.grains"), group, "a group of grains", groups.keys())?;
            return Ok(groups[place].clone().collect());
        }
        if let Some(name) = &spec.material {
            let material = self.material(&format!("{key}.material"), name)?;
            return Ok((0..grains.len()).filter(|&at| grains[at].material == material).collect());
        }
        if let Some(spec) = &spec.region {
            let [low, high] = self.corners(&format!("{key}.region"), &spec.low, &spec.high)?;
            let within = |grain: &Grain| {
                (0..check.dimension.count()).all(|axis| (low[axis]..=high[axis]).contains(&grain.position[axis]))
            };
            return Ok((0..grains.len()).filter(|&at| within(&grains[at])).collect());
        }
        let key = format!("{key}.face");
        let Some(domain) = domain else {
            return Err(check.error(&key, "a `domain` that has faces", "none"));
        };
        let [axis, end] = spec.face.map_or([0, 0], SideSpec::axis_and_end);
        let is_open = axis < check.dimension.count() && !domain.periodic[axis];
        check.require(is_open, &key, "a face that is not periodic", format_args!("{:?}", spec.face))?;
        let place = [domain.low, domain.high][end][axis];
        let is_cut = |grain: &Grain| (grain.position[axis] - place).abs() < grain.radius;
        Ok((0..grains.len()).filter(|&at| is_cut(&grains[at])).collect())
    }
}
