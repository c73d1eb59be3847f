//! Names of the outputs of a deck, and parts of scripts that all programs share.

use super::logged;
use super::stepping::Stepping;
use grainbench_scene::scene::{ProbeTarget, Scene};

/// Name of the dump with the grains at the samples.
pub const SAMPLES: &str = "dump.grains";
/// Name of the dump at the end of the run. It is written if the last step is not a regular sample.
pub const END: &str = "dump.end";
/// Name of the dump with contacts at the samples. It is written if a probe or the snapshots need contacts between
/// grains.
pub(crate) const CONTACTS: &str = "dump.contacts";
/// Name of the dump with contacts at the end of the run.
pub(crate) const END_CONTACTS: &str = "dump.end-contacts";
/// Columns of the dumps of grains.
pub(super) const COLUMNS: [&str; 19] = [
    "id", "type", "radius", "mass", "x", "y", "z", "vx", "vy", "vz", "omegax", "omegay", "omegaz", "fx", "fy", "fz",
    "tqx", "tqy", "tqz",
];

/// Returns true if a probe requests the force on a wall or at one of its contacts. Walls are counted from 1.
pub(super) fn asks_for_wall(scene: &Scene, number: usize) -> bool {
    asks_for_contacts_at(scene, number) || asks_for_force(scene, number)
}

/// Returns true if a probe requests the total force on a wall. Walls are counted from 1.
pub(super) fn asks_for_force(scene: &Scene, number: usize) -> bool {
    scene.probes.iter().any(|probe| probe.target == ProbeTarget::Wall(number - 1))
}

/// Returns true if a probe requests a contact of a grain with a wall. Walls are counted from 1.
pub(super) fn asks_for_contacts_at(scene: &Scene, number: usize) -> bool {
    let is_at = |target: ProbeTarget| matches!(target, ProbeTarget::GrainWall(_, wall) if wall + 1 == number);
    scene.probes.iter().any(|probe| is_at(probe.target))
}

/// Returns true if a probe requests a contact between grains or snapshots contain contacts.
pub(super) fn asks_for_pairs(scene: &Scene) -> bool {
    scene.snapshot_contacts || scene.probes.iter().any(|probe| matches!(probe.target, ProbeTarget::Pair(..)))
}

/// Returns the commands that select the output of the log: the quantities `logged` at every sample or, if there are
/// none, only kinetic energy and number of atoms at the end of the run.
pub(super) fn thermo(commands: &str, logged: &[logged::LogColumn], stepping: &Stepping) -> String {
    if logged.is_empty() {
        return format!("thermo_style custom step time ke atoms\nthermo {}", stepping.steps.max(1));
    }
    let names: Vec<String> = logged.iter().map(|logged| format!(" v_{}", logged.name)).collect();
    format!(
        "{commands}\nthermo_style custom step time ke atoms{}\nthermo_modify norm no format float %.17g\nthermo {}",
        names.concat(),
        stepping.interval
    )
}

/// Returns the title of the scene for a comment in the first line of a script. Characters other than ASCII letters,
/// digits, spaces and `.,:-()` are replaced, because some have a meaning in scripts even within comments.
pub(super) fn heading(scene: &Scene) -> String {
    let plain = |letter: char| if letter.is_ascii_alphanumeric() || " .,:-()".contains(letter) { letter } else { '_' };
    scene.title.chars().take(100).map(plain).collect::<String>().trim().to_owned()
}
