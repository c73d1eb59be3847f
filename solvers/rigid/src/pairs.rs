//! Friction and restitution of every pair, from the contact laws of the scene.

use grainbench_scene::contact_law::ContactLaw;
use grainbench_scene::release::no_tension_ratio;
use grainbench_scene::scene::Scene;

/// One partner of a contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Side {
    /// Grain, by its index in the scene.
    Grain(usize),
    /// Wall, by its index in the scene.
    Wall(usize),
}

const WALL: u128 = 1 << 64;

impl Side {
    /// Returns the number that the engine stores with the shape of this partner.
    pub(crate) const fn tag(self) -> u128 {
        match self {
            Self::Grain(at) => at as u128,
            Self::Wall(at) => WALL | at as u128,
        }
    }

    /// Returns the contact partner with this stored number.
    pub(crate) const fn of_tag(tag: u128) -> Self {
        let at = tag as u64 as usize;
        if tag & WALL == 0 { Self::Grain(at) } else { Self::Wall(at) }
    }
}

/// Parameters of a contact law that a rigid contact uses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Coefficients {
    /// Friction coefficient μ.
    pub(crate) friction: f64,
    /// Coefficient of restitution e.
    pub(crate) restitution: f64,
}

/// Returns the index of the material and the inverse mass (1/kg) of a contact partner.
fn body(scene: &Scene, side: Side) -> (u16, f64) {
    match side {
        Side::Grain(at) => (scene.grains[at].material, 1.0 / scene.grains[at].mass),
        Side::Wall(at) => (scene.walls[at].material, 0.0),
    }
}

/// Returns the coefficients of a pair; `None` if the scene has no law for this pair.
pub(crate) fn coefficients(scene: &Scene, one: Side, other: Side) -> Option<Coefficients> {
    let ((a, inverse_a), (b, inverse_b)) = (body(scene, one), body(scene, other));
    let law = scene.law(a, b)?;
    Some(Coefficients { friction: law.friction, restitution: restitution(law, 1.0 / (inverse_a + inverse_b)) })
}

/// Returns the coefficients if all pairs of a scene have the same coefficients, otherwise `None`. The result is also
/// `None` if there are more than [`MOST_KINDS`] kinds of grains.
pub(crate) fn common_coefficients(scene: &Scene) -> Option<Coefficients> {
    let Scene { grains, walls, .. } = scene;
    let mut kinds: Vec<(u16, f64)> = grains.iter().map(|grain| (grain.material, grain.mass)).collect();
    kinds.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    kinds.dedup();
    // With many different masses and damping, some pairs have different coefficients. A comparison of all pairs would
    // have quadratic cost.
    if kinds.len() > MOST_KINDS {
        return None;
    }
    let of_kind = |kind: &(u16, f64)| grains.iter().position(|grain| (grain.material, grain.mass) == *kind);
    let kinds: Vec<usize> = kinds.iter().filter_map(of_kind).collect();
    let several = grains.len() > 1;
    let grain_pairs = kinds.iter().enumerate().flat_map(|(at, &a)| {
        kinds[at..].iter().map(move |&b| (Side::Grain(a), Side::Grain(b))).filter(move |_| several)
    });
    let walls = kinds.iter().flat_map(|&a| (0..walls.len()).map(move |w| (Side::Grain(a), Side::Wall(w))));
    let mut all = grain_pairs.chain(walls).map(|(one, other)| coefficients(scene, one, other));
    // A scene without pairs never uses the coefficients.
    let Some(first) = all.next() else { return Some(Coefficients { friction: 0.0, restitution: 0.0 }) };
    let first = first?;
    all.all(|next| next == Some(first)).then_some(first)
}

/// Maximum number of kinds of grains, distinguished by material and mass, for which pairs are compared.
const MOST_KINDS: usize = 16;

/// Returns the coefficient of restitution of the spring and dashpot of a law.
///
/// The damping ratio of the law states e = exp(−πζ/√(1−ζ²)), as `restitution` in the scene requires. A linear spring with
/// dashpots c = β k_n + γ_n m has ζ = c/(2√(k_n m)), with the effective mass m of the pair. Its contact ends when the force is
/// zero, because contacts do not pull (see [`no_tension_ratio`]):
///
/// ```text
/// e = exp(−2ζ acos ζ/√(1 − ζ²))   below critical damping, exp(−2ζ acosh ζ/√(ζ² − 1)) above it
/// ```
fn restitution(law: &ContactLaw, mass: f64) -> f64 {
    let viscosity = law.stiffness_damping * law.normal_stiffness() + law.normal_damping * mass;
    if viscosity == 0.0 {
        return law.restitution();
    }
    let ratio = no_tension_ratio(law.damping_ratio) + viscosity / (2.0 * (law.normal_stiffness() * mass).sqrt());
    let root = (1.0 - ratio * ratio).abs().sqrt();
    let arc = if ratio < 1.0 { libm::atan2(root, ratio) } else { libm::log1p(ratio - 1.0 + root) };
    libm::exp(-2.0 * ratio * if root > 0.0 { arc / root } else { 1.0 })
}

#[cfg(test)]
mod tests {
    use super::*;
    use grainbench_scene::contact_law::Springs;

    #[test]
    fn tags_tell_grains_from_walls() {
        for side in [Side::Grain(0), Side::Wall(0), Side::Grain(70_000), Side::Wall(3)] {
            assert_eq!(Side::of_tag(side.tag()), side);
        }
    }

    #[test]
    fn restitution_of_a_damping_ratio() {
        // With k m* = 1 (m*: effective mass), ζ = c/2.
        let springs = Springs::Linear { normal: 2.0, tangential: 0.0 };
        let law = ContactLaw { springs, normal_damping: 0.4, ..ContactLaw::default() };
        let expected = (-0.2 * 0.1_f64.acos() / 0.99_f64.sqrt()).exp();
        let is_near = |law: &ContactLaw, expected: f64| (restitution(law, 0.5) - expected).abs() < 1e-12;
        assert!(is_near(&law, expected));
        assert!(is_near(&ContactLaw { stiffness_damping: 0.1, normal_damping: 0.0, ..law }, expected));
        assert_eq!(restitution(&ContactLaw { normal_damping: 0.0, ..law }, 0.5), 1.0);
        assert!(is_near(&ContactLaw { normal_damping: 4.0, ..law }, (-2.0_f64).exp()));
        assert!(is_near(
            &ContactLaw { normal_damping: 40.0, ..law },
            (-20.0 * 10.0_f64.acosh() / 99.0_f64.sqrt()).exp()
        ));
        let mut stated = ContactLaw { normal_damping: 0.0, ..law };
        stated.set_restitution(0.5);
        assert!(is_near(&stated, 0.5));
        // A dashpot of negligible viscosity leaves the stated coefficient.
        assert!(is_near(&ContactLaw { normal_damping: 1e-14, ..stated }, 0.5));
    }
}
