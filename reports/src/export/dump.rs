//! Snapshots as a LAMMPS text dump, which LAMMPS tools, OVITO and VMD read.

use std::io::{self, Write};

use grainbench_solver::record::{GrainState, Snapshot};

/// Columns of every snapshot, named as in LAMMPS.
const COLUMNS: &str = "id type radius mass x y z vx vy vz omegax omegay omegaz";
/// Columns of forces and torques. Some programs do not report them.
const FORCES: &str = " fx fy fz tqx tqy tqz";

/// Beginning of a dump. Units are SI.
pub(crate) const HEAD: &str = "ITEM: UNITS\nsi\n";

/// Adds a snapshot to a dump. `type` is the index of the material in the scene, from 1.
///
/// # Errors
/// When `out` cannot be written.
pub(crate) fn add(snapshot: &Snapshot, out: &mut impl Write) -> io::Result<()> {
    writeln!(out, "ITEM: TIME\n{:?}", snapshot.time)?;
    writeln!(out, "ITEM: TIMESTEP\n{}", snapshot.step)?;
    writeln!(out, "ITEM: NUMBER OF ATOMS\n{}", snapshot.grains.len())?;
    let kinds = snapshot.periodic.map(|periodic| if periodic { "pp" } else { "ff" });
    writeln!(out, "ITEM: BOX BOUNDS {}", kinds.join(" "))?;
    for axis in 0..3 {
        let (low, high) = bounds_along(snapshot, axis);
        writeln!(out, "{low:?} {high:?}")?;
    }
    let has_forces = snapshot.grains.iter().all(|grain| grain.force.is_some() && grain.torque.is_some());
    writeln!(out, "ITEM: ATOMS {COLUMNS}{}", if has_forces { FORCES } else { "" })?;
    for grain in &snapshot.grains {
        write!(out, "{} {} {:?} {:?}", grain.id, u32::from(grain.material) + 1, grain.radius, grain.mass)?;
        let forces = [grain.force, grain.torque].into_iter().flatten().filter(|_| has_forces);
        for vector in [grain.position, grain.velocity, grain.spin].into_iter().chain(forces) {
            write!(out, " {:?} {:?} {:?}", vector.x, vector.y, vector.z)?;
        }
        writeln!(out)?;
    }
    Ok(())
}

/// Returns the bounds of the box along an axis (m). These are the bounds of the domain, or of the grains if the domain
/// is flat or unbounded, or ±0.5 m if both are. Readers reject a box without thickness.
fn bounds_along(snapshot: &Snapshot, axis: usize) -> (f64, f64) {
    let is_thick = |(low, high): &(f64, f64)| low.is_finite() && high.is_finite() && low < high;
    let around = |(low, high): (f64, f64), grain: &GrainState| {
        (low.min(grain.position[axis] - grain.radius), high.max(grain.position[axis] + grain.radius))
    };
    let of_grains = || snapshot.grains.iter().fold((f64::INFINITY, f64::NEG_INFINITY), around);
    let of_domain = Some((snapshot.bounds.0[axis], snapshot.bounds.1[axis])).filter(is_thick);
    of_domain.or_else(|| Some(of_grains()).filter(is_thick)).unwrap_or((-0.5, 0.5))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::sample;

    #[test]
    fn writes_what_lammps_would() {
        let mut out = Vec::from(HEAD);
        let mut later = sample::snapshot();
        later.step = 20;
        later.time = 0.2;
        later.grains.truncate(1);
        for snapshot in [sample::snapshot(), later] {
            add(&snapshot, &mut out).unwrap();
        }
        let head = |time: &str, step: u32, grains: u32| {
            format!(
                "ITEM: TIME\n{time}\nITEM: TIMESTEP\n{step}\nITEM: NUMBER OF ATOMS\n{grains}\n\
                 ITEM: BOX BOUNDS pp ff ff\n0.0 4.0\n0.0 3.0\n-0.5 0.5\nITEM: ATOMS {COLUMNS}{FORCES}\n"
            )
        };
        let first = "1 1 0.5 1.25 3.75 0.25 0.0 0.1 -2e-7 0.0 0.0 0.0 3.0 1.0 2.0 0.0 0.0 0.0 -0.125\n";
        let second = "2 1 0.5 1.25 0.5 0.25 0.0 0.1 -2e-7 0.0 0.0 0.0 3.0 1.0 2.0 0.0 0.0 0.0 -0.125\n";
        let expected = ["ITEM: UNITS\nsi\n", &head("0.1", 10, 2), first, second, &head("0.2", 20, 1), first];
        assert_eq!(String::from_utf8(out).unwrap(), expected.concat());
    }
}
