//! The contact laws of a scene as the kernels read them: one row of numbers for every two materials.

use crate::contact::Options;
use grainbench_lanes::{Lanes, Quad, WIDEST, Wide};
use grainbench_scene::contact_law::ContactLaw;
use grainbench_scene::release::no_tension_ratio;
use grainbench_scene::scene::Scene;

/// The numbers of a contact law, one or several at a time. Which law they belong to is the type of the kernel's stages, so
/// that a stage reads its numbers without asking; [`ContactLaw`] says what each means.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Constants<X> {
    /// Constants of the springs: k_n and k_s (N/m), or E* and G* (Pa).
    pub(crate) springs: [X; 2],
    /// Friction tan φ.
    pub(crate) friction: X,
    /// Cohesion c (N).
    pub(crate) cohesion: X,
    /// Stiffness-proportional damping β (s).
    pub(crate) stiffness_damping: X,
    /// Mass-proportional normal damping γ_n (1/s).
    pub(crate) normal_damping: X,
    /// Mass-proportional tangential damping γ_t (1/s).
    pub(crate) tangential_damping: X,
    /// Damping ratio ζ that gives the coefficient of restitution at the release of the convention.
    pub(crate) damping_ratio: X,
    /// Coefficient of rolling resistance μ_r.
    pub(crate) rolling_friction: X,
    /// Damping ratio η_r of the rolling spring.
    pub(crate) rolling_damping: X,
}

impl Constants<f64> {
    /// The numbers of a law. One without friction has no tangential spring or dashpot either, also in a scene that has friction
    /// elsewhere.
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

/// Damping ratio ζ of a law that gives its coefficient of restitution at the release of a convention.
pub(crate) fn damping_ratio(law: &ContactLaw, options: &Options) -> f64 {
    if options.may_pull() { law.damping_ratio } else { no_tension_ratio(law.damping_ratio) }
}

/// The law between every two materials.
pub(crate) struct Laws {
    /// Row after row: the laws of a material with every other.
    laws: Vec<Constants<f64>>,
    /// The same in quads: springs, friction and cohesion; dashpots; rolling.
    quads: [Vec<Quad>; 3],
    material_count: usize,
}

impl Laws {
    /// The laws of a scene in a convention.
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

    /// Whether there is one law only.
    pub(crate) fn is_one(&self) -> bool {
        self.material_count == 1
    }

    /// The number of the law between two materials.
    #[inline(always)]
    pub(crate) fn number(&self, one: u16, other: u16) -> usize {
        usize::from(one) * self.material_count + usize::from(other)
    }

    /// The numbers of the laws between the grains of some pairs, of these materials.
    #[inline(always)]
    pub(crate) fn numbers(&self, material: &[u16], [first, second]: [&[usize; WIDEST]; 2]) -> [usize; WIDEST] {
        let mut numbers = [0; WIDEST];
        for (number, (&one, &other)) in numbers.iter_mut().zip(first.iter().zip(second)) {
            *number = self.number(material[one], material[other]);
        }
        numbers
    }

    /// The law between two materials.
    pub(crate) fn between(&self, one: u16, other: u16) -> &Constants<f64> {
        &self.laws[self.number(one, other)]
    }

    /// The laws of these numbers, in lanes.
    #[inline(always)]
    pub(crate) fn gather<L: Lanes>(&self, lanes: L, numbers: &[usize; WIDEST]) -> Constants<Wide<L>> {
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

/// The quads of a table at the first places of `at`, in lanes.
#[inline(always)]
pub(crate) fn gathered<L: Lanes>(lanes: L, table: &[Quad], at: &[usize; WIDEST]) -> [Wide<L>; 4] {
    gathered_of(lanes, table.as_chunks::<1>().0, 0, at)
}

/// The same of one of several quads that an entry has.
#[inline(always)]
pub(crate) fn gathered_of<L: Lanes, const N: usize>(
    lanes: L,
    table: &[[Quad; N]],
    of: usize,
    at: &[usize; WIDEST],
) -> [Wide<L>; 4] {
    let [a, b, c, d] = lanes.gather(table, of, at);
    [Wide::new(lanes, a), Wide::new(lanes, b), Wide::new(lanes, c), Wide::new(lanes, d)]
}

/// One of several quads that entries of a table have, at the first places of `to` less at those of `from`, in lanes; of the
/// fourth numbers the sum.
#[inline(always)]
pub(crate) fn between<L: Lanes, const N: usize>(
    lanes: L,
    table: &[[Quad; N]],
    of: usize,
    [from, to]: [&[usize; WIDEST]; 2],
) -> [Wide<L>; 4] {
    let [a, b, c, d] = lanes.between(table, of, from, to);
    [Wide::new(lanes, a), Wide::new(lanes, b), Wide::new(lanes, c), Wide::new(lanes, d)]
}

/// Places in tables of a length, as many as a register holds: looked at once, so that no table must.
///
/// # Panics
/// When one of them lies beyond the tables.
#[inline(always)]
pub(crate) fn places<L: Lanes>(_: L, of: &[u32], length: usize) -> [usize; WIDEST] {
    let of = &of[..L::WIDTH];
    let mut places = [0; WIDEST];
    for lane in 0..L::WIDTH {
        places[lane] = of[lane] as usize;
        assert!(places[lane] < length, "a place in the tables");
    }
    places
}
