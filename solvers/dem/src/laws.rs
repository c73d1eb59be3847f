//! Contact laws of a scene in the form that kernels read. There is one set of constants per pair of materials.

use crate::contact::options::Options;
use grainbench_lanes::{Lanes, Quad, SimdPack, WIDEST};
use grainbench_scene::contact_law::ContactLaw;
use grainbench_scene::release::no_tension_ratio;
use grainbench_scene::scene::Scene;

/// Constants of one contact law, or of several contact laws at a time. The type of the law is fixed by the stages for
/// which a kernel is compiled, so a stage reads its constants without a check. [`ContactLaw`] documents each constant.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Constants<X> {
    /// Constants of the springs: k_n and k_s (N/m), or E* and G* (Pa).
    pub(crate) springs: [X; 2],
    /// Coefficient of friction tan φ.
    pub(crate) friction: X,
    /// Cohesion c (N).
    pub(crate) cohesion: X,
    /// Stiffness-proportional damping β (s).
    pub(crate) stiffness_damping: X,
    /// Mass-proportional normal damping γ_n (1/s).
    pub(crate) normal_damping: X,
    /// Mass-proportional tangential damping γ_t (1/s).
    pub(crate) tangential_damping: X,
    /// Damping ratio ζ that gives the coefficient of restitution. It depends on whether the convention ends a contact at
    /// zero overlap or at zero force.
    pub(crate) damping_ratio: X,
    /// Coefficient of rolling resistance μ_r.
    pub(crate) rolling_friction: X,
    /// Damping ratio η_r of the rolling spring.
    pub(crate) rolling_damping: X,
}

impl Constants<f64> {
    /// Returns the constants of a law. A law without friction has no tangential spring or dashpot, even if other laws of
    /// the scene have friction.
    fn new(law: &ContactLaw, options: &Options) -> Self {
        let [normal, tangential] = law.springs.constants();
        let if_sheared = |number: f64| if law.has_friction() { number } else { 0.0 };
        Self {
            springs: [normal, if_sheared(tangential)],
            friction: law.friction,
            cohesion: law.cohesion,
            stiffness_damping: law.stiffness_damping,
            normal_damping: law.normal_damping,
            tangential_damping: if_sheared(law.tangential_damping),
            damping_ratio: damping_ratio(law, options),
            rolling_friction: law.rolling_friction,
            rolling_damping: law.rolling_damping,
        }
    }
}

/// Returns the damping ratio ζ that gives the coefficient of restitution of a law. It depends on whether the convention
/// ends a contact at zero overlap or at zero force.
pub(crate) fn damping_ratio(law: &ContactLaw, options: &Options) -> f64 {
    if options.may_pull() { law.damping_ratio } else { no_tension_ratio(law.damping_ratio) }
}

/// Laws between all pairs of materials.
#[derive(Default)]
pub(crate) struct Laws {
    /// Law of each pair of materials. Each row holds the laws of one material with all materials.
    laws: Vec<Constants<f64>>,
    /// The same laws as three tables of quads: springs, friction and cohesion; dashpots; rolling resistance.
    quads: [Vec<Quad>; 3],
    material_count: usize,
}

impl Laws {
    /// Creates the laws of a scene with the options of a convention.
    pub(crate) fn new(scene: &Scene, options: &Options) -> Self {
        let constants =
            |law: &Option<ContactLaw>| law.as_ref().map(|law| Constants::new(law, options)).unwrap_or_default();
        let laws: Vec<Constants<f64>> = scene.laws.iter().map(constants).collect();
        let quads = |quad: fn(&Constants<f64>) -> [f64; 4]| laws.iter().map(|law| Quad(quad(law))).collect();
        Self {
            quads: [
                quads(|law| [law.springs[0], law.springs[1], law.friction, law.cohesion]),
                quads(|law| [law.stiffness_damping, law.normal_damping, law.tangential_damping, law.damping_ratio]),
                quads(|law| [law.rolling_friction, law.rolling_damping, 0.0, 0.0]),
            ],
            laws,
            material_count: scene.materials.len(),
        }
    }

    /// Returns true if there is only one law.
    pub(crate) fn is_one(&self) -> bool {
        self.material_count == 1
    }

    /// Returns the index of the law between two materials.
    #[inline(always)]
    pub(crate) fn number(&self, one: u16, other: u16) -> usize {
        usize::from(one) * self.material_count + usize::from(other)
    }

    /// Returns the law indices of up to `WIDEST` pairs, whose grains have the slots `first` and `second`.
    #[inline(always)]
    pub(crate) fn numbers(&self, material: &[u16], [first, second]: &[[usize; WIDEST]; 2]) -> [usize; WIDEST] {
        let mut numbers = [0; WIDEST];
        for (number, (&one, &other)) in numbers.iter_mut().zip(first.iter().zip(second)) {
            *number = self.number(material[one], material[other]);
        }
        numbers
    }

    /// Returns the law between two materials.
    pub(crate) fn between(&self, one: u16, other: u16) -> &Constants<f64> {
        &self.laws[self.number(one, other)]
    }

    /// Returns the laws with these indices, one law per lane.
    #[inline(always)]
    pub(crate) fn gather<L: Lanes>(&self, lanes: L, numbers: &[usize; WIDEST]) -> Constants<SimdPack<L>> {
        let [normal, tangential, friction, cohesion] = gathered(lanes, &self.quads[0], numbers);
        let [stiffness_damping, normal_damping, tangential_damping, damping_ratio] =
            gathered(lanes, &self.quads[1], numbers);
        let [rolling_friction, rolling_damping, _, _] = gathered(lanes, &self.quads[2], numbers);
        Constants {
            springs: [normal, tangential],
            friction,
            cohesion,
            stiffness_damping,
            normal_damping,
            tangential_damping,
            damping_ratio,
            rolling_friction,
            rolling_damping,
        }
    }
}

/// Gathers the quads of a table at the indices `at`, one quad per lane. The first pack of the result holds the first
/// numbers of all quads, the second pack the second numbers, and so on.
#[inline(always)]
pub(crate) fn gathered<L: Lanes>(lanes: L, table: &[Quad], at: &[usize; WIDEST]) -> [SimdPack<L>; 4] {
    gathered_of(lanes, table.as_chunks::<1>().0, 0, at)
}

/// Gathers one quad of each table entry at the indices `at`, like `gathered`. `number` is the index of the quad in an
/// entry.
#[inline(always)]
pub(crate) fn gathered_of<L: Lanes, const N: usize>(
    lanes: L,
    table: &[[Quad; N]],
    number: usize,
    at: &[usize; WIDEST],
) -> [SimdPack<L>; 4] {
    let [a, b, c, d] = lanes.gather(table, number, at);
    [SimdPack::new(lanes, a), SimdPack::new(lanes, b), SimdPack::new(lanes, c), SimdPack::new(lanes, d)]
}

/// Returns the difference of a quad between the table entries at `to` and at `from`, for each lane. The fourth number is
/// the sum instead of the difference. `number` is the index of the quad in an entry.
#[inline(always)]
pub(crate) fn between<L: Lanes, const N: usize>(
    lanes: L,
    table: &[[Quad; N]],
    number: usize,
    [from, to]: [&[usize; WIDEST]; 2],
) -> [SimdPack<L>; 4] {
    let [a, b, c, d] = lanes.between(table, number, from, to);
    [SimdPack::new(lanes, a), SimdPack::new(lanes, b), SimdPack::new(lanes, c), SimdPack::new(lanes, d)]
}

/// Converts the first `L::WIDTH` slots to table indices. Each index is checked once against the length of the tables, so
/// that no table needs a further check.
///
/// # Panics
/// When an index is out of range.
#[inline(always)]
pub(crate) fn places<L: Lanes>(_: L, slots: &[u32], length: usize) -> [usize; WIDEST] {
    let slots = &slots[..L::WIDTH];
    let mut places = [0; WIDEST];
    for lane in 0..L::WIDTH {
        places[lane] = slots[lane] as usize;
        assert!(places[lane] < length, "a place in the tables");
    }
    places
}
