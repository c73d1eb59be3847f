//! Names and units of the columns of probes.

use crate::budget::Budget;
use grainbench_scene::dimension::Dimension;
use grainbench_scene::scene::{ProbeTarget, Scene};

const AXES: [&str; 3] = ["x", "y", "z"];

/// Name of an energy, and its value in a budget.
pub(crate) type Entry = (&'static str, fn(&Budget) -> f64);

/// Entries of an energy budget, by name.
pub(crate) const ENERGIES: [Entry; 11] = [
    ("kinetic", |budget| budget.kinetic),
    ("elastic", |budget| budget.elastic),
    ("springs", |budget| budget.springs),
    ("gravitational", |budget| budget.gravitational),
    ("work", |budget| budget.work),
    ("plastic", |budget| budget.plastic),
    ("friction", |budget| budget.friction),
    ("damping", |budget| budget.damping),
    ("transfer", |budget| budget.transfer),
    ("contact", |budget| budget.contact),
    ("unbalanced", Budget::unbalanced),
];

/// Components of the stress, in the order of [`crate::record::PointState::stress`].
const STRESSES: [&str; 6] = ["xx", "yy", "zz", "xy", "yz", "zx"];

/// Returns the number of stress components: four in two dimensions (plane strain), six in three.
pub(crate) const fn stresses(dimension: Dimension) -> usize {
    match dimension {
        Dimension::Two => 4,
        Dimension::Three => 6,
    }
}

/// Returns the recorded components of the mean stress of grains, as pairs of axes.
pub(crate) const fn mean_stresses(dimension: Dimension) -> &'static [(usize, usize)] {
    match dimension {
        Dimension::Two => &[(0, 0), (1, 1), (0, 1)],
        Dimension::Three => &[(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)],
    }
}

/// Returns the number of columns of all probes of a scene.
pub(crate) fn count(scene: &Scene) -> usize {
    scene.probes.iter().map(|probe| columns(probe.target, scene.dimension).len()).sum()
}

fn axes(dimension: Dimension) -> &'static [&'static str] {
    &AXES[..dimension.count()]
}

/// Returns the names and units of the columns of a probe.
pub(crate) fn columns(target: ProbeTarget, dimension: Dimension) -> Vec<(String, &'static str)> {
    let flat = dimension == Dimension::Two;
    let named = |prefix: &str, unit: &'static str| -> Vec<(String, &'static str)> {
        axes(dimension).iter().map(|axis| (format!("{prefix}{axis}"), unit)).collect()
    };
    let plain = |pairs: &[(&str, &'static str)]| -> Vec<(String, &'static str)> {
        pairs.iter().map(|&(name, unit)| (name.to_owned(), unit)).collect()
    };
    let spins = |name: &str, unit: &'static str| {
        if flat { plain(&[(name, unit)]) } else { named(&format!("{name}_"), unit) }
    };
    match target {
        ProbeTarget::Grain(_) | ProbeTarget::Body(_) => {
            let mut all = named("", "m");
            all.extend(named("v", "m/s"));
            all.extend(spins("omega", "rad/s"));
            if flat {
                all.extend(plain(&[("angle", "rad")]));
            }
            all
        }
        ProbeTarget::Point(_) => {
            let mut all = named("u", "m");
            all.extend(named("v", "m/s"));
            all.extend(STRESSES[..stresses(dimension)].iter().map(|axes| (format!("sigma_{axes}"), "Pa")));
            all.extend(plain(&[("plastic_strain", "1")]));
            all
        }
        ProbeTarget::Pair(..) | ProbeTarget::GrainWall(..) => {
            plain(&[("overlap", "m"), ("normal_force", "N"), ("shear_force", "N"), ("slipping", "1")])
        }
        ProbeTarget::Wall(_) | ProbeTarget::Driven(_) => named("force_", "N"),
        ProbeTarget::Budget => {
            let energies = ENERGIES.map(|(name, _)| (name.to_owned(), "J"));
            let mut all = Vec::from(energies);
            all.extend(named("momentum_", "kg m/s"));
            all.extend(named("impulse_", "N s"));
            all
        }
        ProbeTarget::Stress => {
            let column = |&(i, j): &(usize, usize)| (format!("sigma_{}{}", AXES[i], AXES[j]), "Pa");
            let mut all: Vec<_> = mean_stresses(dimension).iter().map(column).collect();
            all.extend(plain(&[("coordination", "1")]));
            all
        }
        ProbeTarget::Piston(_) => plain(&[("advance", "m")]),
        ProbeTarget::Count => plain(&[("present", "1"), ("entered", "1"), ("left", "1")]),
        ProbeTarget::System => {
            let mut all = plain(&[
                ("kinetic_energy", "J"),
                ("rotational_energy", "J"),
                ("elastic_energy", "J"),
                ("gravitational_energy", "J"),
                ("total_energy", "J"),
            ]);
            all.extend(named("momentum_", "kg m/s"));
            all.extend(spins("angular_momentum", "kg m²/s"));
            all.extend(plain(&[("contacts", "1"), ("slipping_contacts", "1"), ("largest_spin", "rad/s")]));
            all
        }
    }
}
