//! Grains from the final state of a run.

use super::Resolver;
use crate::end_state::{EndState, Springs};
use crate::error::SceneError;
use crate::file::StateSpec;
use crate::scene::Grain;

impl Resolver<'_> {
    pub(super) fn grains_from_state(
        &self,
        name: &str,
        spec: &StateSpec,
        material: u16,
        (grains, springs): (&mut Vec<Grain>, &mut Option<Springs>),
    ) -> Result<(), SceneError> {
        let check = &self.check;
        let key = format!("grains.{name}.state.path");
        let path = check.source.directory.join(&spec.path);
        let refuse = |found: String| check.error(&key, "a state written by `simulate --state`", &found);
        let bytes = std::fs::read(&path).map_err(|error| refuse(error.to_string()))?;
        let state = EndState::from_bytes(&bytes).map_err(refuse)?;
        if state.dimension != check.dimension.count() {
            return Err(refuse(format!("a state in {} dimensions", state.dimension)));
        }
        // A state with a single material gets the material of the group, even if the names differ.
        let materials: Vec<u16> = match &state.materials[..] {
            [_] => vec![material],
            several => several.iter().map(|material| self.material(&key, material)).collect::<Result<_, _>>()?,
        };
        let first = grains.len() as u32;
        for grain in &state.grains {
            check.positive(&key, grain.radius, "radius (m)")?;
            check.positive(&key, grain.mass, "mass (kg)")?;
            check.positive(&key, grain.inertia, "moment of inertia (kg m²)")?;
            grains.push(Grain { material: materials[usize::from(grain.material)], ..*grain });
        }
        if spec.springs {
            let expected = "springs of one state (`springs = false` for further states)";
            check.require(springs.is_none(), &key, expected, "two")?;
            *springs = Some(state.springs.later_by(first));
        }
        Ok(())
    }
}
