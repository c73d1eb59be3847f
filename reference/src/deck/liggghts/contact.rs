//! Contact laws in the models of LIGGGHTS: `hooke/stiffness`, `hertz/stiffness` and `hertz` with `tangential history`,
//! and `rolling_friction epsd`.

use grainbench_scene::contact_law::ContactLaw;
use grainbench_scene::effects::Effects;
use grainbench_scene::scene::Scene;

use super::moduli::moduli;
use crate::deck::dashpots::{Dashpots, Side};
use crate::deck::outline::{grain_materials, hertz};

/// LIGGGHTS model for the contacts of a scene.
#[derive(Clone, Copy)]
pub(crate) struct Model {
    effects: Effects,
}

impl Model {
    pub(crate) fn from_scene(scene: &Scene) -> Self {
        Self { effects: Effects::from_scene(scene) }
    }

    /// Returns true for Hertz contacts whose dashpots follow from a coefficient of restitution. LIGGGHTS defines these
    /// contacts by moduli and all other contacts by stiffnesses.
    fn has_moduli(self) -> bool {
        self.effects.hertz && self.effects.restitution
    }

    /// Returns the model in the notation of LIGGGHTS.
    pub(crate) fn words(self) -> String {
        let normal = match (self.effects.hertz, self.has_moduli()) {
            (false, _) => "hooke/stiffness",
            (true, false) => "hertz/stiffness",
            (true, true) => "hertz",
        };
        let rolling = if self.effects.rolling_resistance { " rolling_friction epsd" } else { "" };
        format!("{normal} tangential history{rolling}")
    }

    /// Returns the switches of the model, which come last in a command.
    pub(crate) fn switches(self) -> &'static str {
        if self.has_moduli() { " tangential_damping off" } else { "" }
    }

    /// Returns the commands that must precede the model. Without these commands, LIGGGHTS refuses Young's moduli above 1
    /// GPa and below 5 MPa.
    pub(crate) fn preparation(self) -> Option<&'static str> {
        self.has_moduli().then_some("hard_particles yes\nsoft_particles yes")
    }

    /// Returns the properties of all atom types and pairs of types. There is one type per material for grains, followed
    /// by one type per material for walls.
    pub(crate) fn properties(self, scene: &Scene) -> Result<String, String> {
        let types = 2 * scene.materials.len();
        let grains = grain_materials(scene);
        let mut table: Vec<Option<(ContactLaw, Dashpots)>> = Vec::with_capacity(types * types);
        for a in 0..types {
            for b in 0..types {
                table.push(self.entry(scene, &grains, (a, b))?);
            }
        }
        type Pick = fn(&(ContactLaw, Dashpots)) -> f64;
        let mut picks: Vec<(&str, Pick)> = match (self.effects.hertz, self.has_moduli()) {
            (false, _) => {
                vec![("kn", |(law, _)| law.normal_stiffness()), ("kt", |(law, _)| law.tangential_stiffness())]
            }
            (true, false) => vec![("kn", |(law, _)| hertz(law).0), ("kt", |(law, _)| hertz(law).1)],
            (true, true) => Vec::new(),
        };
        if !self.has_moduli() {
            picks.push(("gamman", |(_, dashpots)| dashpots.normal));
            picks.push(("gammat", |(_, dashpots)| dashpots.tangential));
        }
        picks.push(("coefficientFriction", |(law, _)| law.friction));
        // LIGGGHTS requires this property, but does not use it in models with stiffnesses.
        let coefficient: Pick = if self.has_moduli() { |(law, _)| restitution(law) } else { |_| 0.5 };
        picks.push(("coefficientRestitution", coefficient));
        if self.effects.rolling_resistance {
            picks.push(("coefficientRollingFriction", |(law, _)| law.rolling_friction));
            picks.push(("coefficientRollingViscousDamping", |(law, _)| law.rolling_damping));
        }
        let mut lines = Vec::new();
        if self.has_moduli() {
            let laws: Vec<Option<ContactLaw>> = table.iter().map(|entry| entry.map(|(law, _)| law)).collect();
            let (young, poisson) = moduli(&laws, types)?;
            for (name, values) in [("youngsModulus", young), ("poissonsRatio", poisson)] {
                lines.push(format!("fix {name} all property/global {name} peratomtype {}", list(values)));
            }
        }
        for (name, pick) in picks {
            let values = table.iter().map(|entry| pick(&entry.unwrap_or_default()));
            lines.push(format!("fix {name} all property/global {name} peratomtypepair {types} {}", list(values)));
        }
        Ok(lines.join("\n"))
    }

    /// Returns the contact law and the dashpots between two types, or `None` if the types never come into contact.
    fn entry(
        self,
        scene: &Scene,
        grains: &[u16],
        (a, b): (usize, usize),
    ) -> Result<Option<(ContactLaw, Dashpots)>, String> {
        let count = scene.materials.len();
        let material = |kind: usize| (kind % count) as u16;
        let is_grain = |kind: usize| kind < count && grains.contains(&material(kind));
        let is_wall = |kind: usize| kind >= count;
        let (grain, side) = match (is_grain(a), is_grain(b)) {
            (true, true) if scene.grains.len() > 1 => (a, Side::Grains(material(b))),
            (true, _) if is_wall(b) => (a, Side::Wall),
            (_, true) if is_wall(a) => (b, Side::Wall),
            _ => return Ok(None),
        };
        let Some(law) = scene.law(material(a), material(b)) else { return Ok(None) };
        let dashpots = if self.effects.hertz {
            Dashpots::default()
        } else {
            Dashpots::from_law(scene, law, material(grain), side)?
        };
        Ok(Some((*law, dashpots)))
    }
}

/// Returns the atom type of walls of a material. Walls have their own types, because their dashpots may differ from
/// those of grains.
pub(crate) fn type_of_wall(scene: &Scene, material: u16) -> usize {
    scene.materials.len() + usize::from(material) + 1
}

/// Returns the coefficient of restitution e = exp(−πζ/√(1 − ζ²)) of the damping ratio ζ.
fn restitution(law: &ContactLaw) -> f64 {
    let ratio = law.damping_ratio;
    (-std::f64::consts::PI * ratio / (1.0 - ratio * ratio).sqrt()).exp()
}

fn list(values: impl IntoIterator<Item = f64>) -> String {
    values.into_iter().map(|value| format!("{value:?}")).collect::<Vec<_>>().join(" ")
}
