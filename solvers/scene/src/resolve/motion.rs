//! Motions of walls and of grains with prescribed motion.

use super::{Groups, Resolver};
use crate::dimension::Dimension;
use crate::error::SceneError;
use crate::file::{DrivenSpec, MotionSpec, SideSpec, SpinSpec};
use crate::function::{Function, FunctionKind};
use crate::motion::{Moment, Motion, Phase};
use crate::scene::{Domain, Driven, Grain};
use nalgebra::Vector3;

impl Resolver<'_> {
    /// Reads an angular velocity (rad/s): a number in two dimensions, a vector in three.
    pub(super) fn spin(&self, key: &str, spin: Option<&SpinSpec>) -> Result<Vector3<f64>, SceneError> {
        match (spin, self.check.dimension) {
            (None, _) => Ok(Vector3::zeros()),
            (Some(SpinSpec::About(rate)), Dimension::Two) => {
                Ok(Vector3::new(0.0, 0.0, self.check.finite(key, *rate, "angular velocity (rad/s)")?))
            }
            (Some(SpinSpec::Vector(rates)), Dimension::Three) => self.check.vector(key, rates),
            (Some(SpinSpec::About(rate)), Dimension::Three) => {
                Err(self.check.error(key, "a vector of three numbers", rate))
            }
            (Some(SpinSpec::Vector(rates)), Dimension::Two) => {
                Err(self.check.error(key, "one number, the spin about z", format_args!("{rates:?}")))
            }
        }
    }

    pub(super) fn motion(&self, key: &str, specs: &[MotionSpec]) -> Result<Motion, SceneError> {
        let check = &self.check;
        let mut motion = Motion::default();
        let mut centre_of: Option<Vector3<f64>> = None;
        for (number, spec) in specs.iter().enumerate() {
            let part = format!("{key}[{number}]");
            let key = |key_part: &str| format!("{part}.{key_part}");
            if self.in_other_form(&part, spec, &mut motion)? {
                continue;
            }
            let spin = self.spin(&key("spin"), spec.spin.as_ref())?;
            if spec.spin.is_some() {
                let Some(centre) = &spec.centre else {
                    return Err(check.error(&key("centre"), "a centre to rotate about", "none"));
                };
                let centre = check.vector(&key("centre"), centre)?;
                let is_same = centre_of.is_none_or(|other| other == centre);
                check.require(is_same, &key("centre"), "one centre for all phases of a wall", "another one")?;
                let is_other = |phase: &Phase| phase.spin.cross(&spin).norm() > 0.0;
                let is_same = !motion.phases.iter().any(is_other);
                check.require(is_same, &key("spin"), "one axis for all phases of a wall", "another one")?;
                centre_of = Some(centre);
            }
            let start = self.moment(&key("start"), spec.start, spec.start_cycle, Moment::Seconds(0.0))?;
            let stop = self.moment(&key("stop"), spec.stop, spec.stop_cycle, Moment::Never)?;
            let velocity = check.vector_or_zero(&key("velocity"), spec.velocity.as_ref())?;
            motion.phases.push(Phase { velocity, spin, start, stop });
        }
        motion.centre = centre_of.unwrap_or_default();
        Ok(motion)
    }

    /// Adds a part of a motion that is a table, a sine or a ramp. Returns false, and adds nothing, if the part is none
    /// of these.
    fn in_other_form(&self, key: &str, spec: &MotionSpec, motion: &mut Motion) -> Result<bool, SceneError> {
        let forms = [
            ("table", spec.table.is_some()),
            ("sine", spec.sine.is_some()),
            ("ramp", spec.ramp.is_some()),
            ("spin", spec.spin.is_some()),
        ];
        if forms[..3].iter().all(|(_, is)| !is) {
            return Ok(false);
        }
        let check = &self.check;
        check.exactly_one(key, &forms)?;
        let (expected, found) = match spec.ramp {
            Some(_) => ("the final `velocity` of the ramp", "none"),
            None => ("a ramp without `velocity`", "one"),
        };
        let is_fitting = spec.velocity.is_some() == spec.ramp.is_some();
        check.require(is_fitting, &format!("{key}.velocity"), expected, found)?;
        let is_in_seconds = spec.start_cycle.is_none() && spec.stop_cycle.is_none() && spec.centre.is_none();
        let found = "`start_cycle`, `stop_cycle` or `centre`";
        check.require(is_in_seconds, key, "a `start` and a `stop` in seconds", found)?;
        if let Some(rows) = &spec.table {
            let has_no_times = spec.start.is_none() && spec.stop.is_none();
            check.require(has_no_times, key, "only the times of the table", "`start` or `stop`")?;
            motion.phases.extend(self.table(&format!("{key}.table"), rows)?);
            return Ok(true);
        }
        let seconds = |part: &str, time: Option<f64>, otherwise: f64| match time {
            Some(time) => check.not_negative(&format!("{key}.{part}"), time, "time (s)"),
            None => Ok(otherwise),
        };
        let (start, stop) = (seconds("start", spec.start, 0.0)?, seconds("stop", spec.stop, f64::INFINITY)?);
        let kind = if let Some(sine) = &spec.sine {
            let key = |part: &str| format!("{key}.sine.{part}");
            FunctionKind::Sine {
                amplitude: check.vector(&key("amplitude"), &sine.amplitude)?,
                frequency: check.positive(&key("frequency"), sine.frequency, "frequency (Hz)")?,
                phase: check.finite(&key("phase_deg"), sine.phase_deg, "angle (degrees)")?.to_radians(),
            }
        } else {
            FunctionKind::Ramp {
                velocity: check.vector_or_zero(&format!("{key}.velocity"), spec.velocity.as_ref())?,
                over: check.positive(&format!("{key}.ramp"), spec.ramp.unwrap_or_default(), "time (s)")?,
            }
        };
        motion.functions.push(Function { kind, start, stop });
        Ok(true)
    }

    /// Converts a table to phases of constant velocity. Consecutive rows with the same velocity between them form one
    /// phase.
    fn table(&self, key: &str, rows: &[Vec<f64>]) -> Result<Vec<Phase>, SceneError> {
        let check = &self.check;
        let shape = if check.dimension.count() == 2 { "[t, x, y]" } else { "[t, x, y, z]" };
        let mut places = Vec::new();
        for row in rows {
            let wrong = row.len() != check.dimension.count() + 1 || row.iter().any(|value| !value.is_finite());
            let rises = |(before, _): &(f64, Vector3<f64>)| row[0] > *before;
            let is_valid = !wrong && row[0] >= 0.0 && places.last().is_none_or(rises);
            let expected = format!("at least two rows {shape}, with increasing times from 0 on");
            check.require(is_valid, key, &expected, format_args!("{row:?}"))?;
            places.push((row[0], check.vector(key, &row[1..])?));
        }
        let Some(first) = places.first().filter(|_| places.len() > 1) else {
            return Err(check.error(key, format!("at least two rows {shape}"), places.len()));
        };
        let expected = "a first row with zeros after its time, because displacements are relative to the start";
        check.require(first.1 == Vector3::zeros(), key, expected, format_args!("{:?}", rows[0]))?;
        let mut phases: Vec<Phase> = Vec::new();
        for pair in places.windows(2) {
            let [(from, before), (to, after)] = [pair[0], pair[1]];
            let velocity = (after - before) / (to - from);
            match phases.last_mut() {
                Some(last) if last.velocity == velocity => last.stop = Moment::Seconds(to),
                _ => phases.push(Phase {
                    velocity,
                    spin: Vector3::zeros(),
                    start: Moment::Seconds(from),
                    stop: Moment::Seconds(to),
                }),
            }
        }
        Ok(phases)
    }

    fn moment(
        &self,
        key: &str,
        seconds: Option<f64>,
        cycle: Option<u64>,
        otherwise: Moment,
    ) -> Result<Moment, SceneError> {
        match (seconds, cycle) {
            (Some(_), Some(_)) => Err(self.check.error(key, "a time or a cycle", "both")),
            (Some(seconds), None) => Ok(Moment::Seconds(self.check.not_negative(key, seconds, "time (s)")?)),
            (None, Some(cycle)) => Ok(Moment::Cycle(cycle)),
            (None, None) => Ok(otherwise),
        }
    }

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
