//! Walls as regions of LAMMPS. Planes can have any direction, rectangles are blocks without thickness, and round
//! walls are cylinders or cones. All regions can move and rotate.

use std::fmt::Write as _;

use grainbench_scene::function::{Function, FunctionKind};
use grainbench_scene::motion::{Moment, Motion, Phase};
use grainbench_scene::scene::{Wall, WallShape};
use nalgebra::{Matrix3, Rotation3, Unit, Vector3};

use crate::deck::Stepping;
use crate::deck::outline::AXES;

/// Region before its rotation, and its rotation at the start of the run.
struct PlacedRegion {
    shape: String,
    /// Point on the axis of rotation at the start (m).
    centre: Vector3<f64>,
    /// Rotation vector at the start (rad).
    rotation: Vector3<f64>,
}

/// Returns the commands that define the region `wallN` and its motion. The displacements `ways` along the axes are
/// added to the motion.
pub(crate) fn region(wall: &Wall, number: u32, stepping: &Stepping, ways: &[String; 3]) -> Result<String, String> {
    let motion = &wall.motion;
    let PlacedRegion { shape, centre, rotation } = placed(wall)?;
    let (mut lines, mut moves) = (String::new(), String::new());
    let moves_along = motion.phases.iter().any(|phase| phase.velocity != Vector3::zeros());
    if moves_along || !motion.functions.is_empty() || ways.iter().any(|way| !way.is_empty()) {
        moves.push_str(" move");
        for (axis, name) in AXES.into_iter().enumerate() {
            let prescribed = course(motion, |phase| phase.velocity[axis], stepping);
            let by_functions = functions(motion, axis);
            let all = [prescribed.as_str(), &by_functions, &ways[axis]];
            let path = all.into_iter().filter(|way| !way.is_empty()).collect::<Vec<_>>().join("+");
            if path.is_empty() {
                moves.push_str(" NULL");
            } else {
                let _ = writeln!(lines, "variable wall{number}{name} equal \"{path}\"");
                let _ = write!(moves, " v_wall{number}{name}");
            }
        }
    }
    let spin = motion.phases.iter().map(|phase| phase.spin).find(|spin| *spin != Vector3::zeros());
    if let Some(axis) = Unit::try_new(spin.unwrap_or(rotation), 0.0) {
        // If a wall has both an initial rotation and a spin, they have the same axis.
        let start = rotation.dot(&axis);
        let turned = course(motion, |phase| phase.spin.dot(&axis), stepping);
        let angle = [format!("{start:?}"), turned].into_iter().filter(|part| !part.is_empty() && part != "0.0");
        let angle = angle.collect::<Vec<_>>().join("+");
        let _ = writeln!(lines, "variable wall{number}turn equal \"{angle}\"");
        let (c, a) = (centre, axis);
        let _ = write!(moves, " rotate v_wall{number}turn {:?} {:?} {:?} {:?} {:?} {:?}", c.x, c.y, c.z, a.x, a.y, a.z);
    }
    let _ = write!(lines, "region wall{number} {shape} units box{moves}");
    Ok(lines)
}

fn placed(wall: &Wall) -> Result<PlacedRegion, String> {
    let motion = &wall.motion;
    match wall.shape {
        WallShape::Plane { point: p, normal: n } => Ok(PlacedRegion {
            shape: format!("plane {:?} {:?} {:?} {:?} {:?} {:?} side in", p.x, p.y, p.z, n.x, n.y, n.z),
            centre: motion.centre,
            rotation: Vector3::zeros(),
        }),
        WallShape::Segment { ends: [a, b] } => {
            let across = Vector3::z() * (b - a).norm();
            rectangle(wall, a - across, [b - a, across * 2.0])
        }
        WallShape::Rectangle { corner, edges } => rectangle(wall, corner, edges),
        WallShape::Round { axis, radii } => {
            let shape = round(axis, radii).ok_or_else(|| {
                format!("wall `{}` is round about an axis that is not x, y or z: LAMMPS has no other", wall.name)
            })?;
            Ok(PlacedRegion { shape, centre: motion.centre, rotation: Vector3::zeros() })
        }
        WallShape::Mesh(_) => Err(format!("wall `{}` is a mesh of triangles: no region of LAMMPS is one", wall.name)),
    }
}

/// Returns a cylinder or a cone about an axis of the box. Both ends are open, so grains touch the side from inside
/// and outside.
fn round([from, to]: [Vector3<f64>; 2], radii: [f64; 2]) -> Option<String> {
    let along = (0..3).find(|&along| (0..3).all(|axis| axis == along || from[axis] == to[axis]))?;
    let across: Vec<f64> = (0..3).filter(|&axis| axis != along).map(|axis| from[axis]).collect();
    let mut ends = [(from[along], radii[0]), (to[along], radii[1])];
    ends.sort_by(|a, b| a.0.total_cmp(&b.0));
    let [(low, first), (high, last)] = ends;
    let (name, radii) =
        if first == last { ("cylinder", format!("{first:?}")) } else { ("cone", format!("{first:?} {last:?}")) };
    let axis = AXES[along];
    Some(format!("{name} {axis} {:?} {:?} {radii} {low:?} {high:?} open 1 open 2", across[0], across[1]))
}

/// Returns a block along the axes and its rotation about the centre of rotation, which give the rectangle.
fn rectangle(wall: &Wall, corner: Vector3<f64>, [u, v]: [Vector3<f64>; 2]) -> Result<PlacedRegion, String> {
    let along_axes = |edge: Vector3<f64>| edge.iter().filter(|part| **part != 0.0).count() == 1;
    let spin = wall.motion.phases.iter().map(|phase| phase.spin).find(|spin| *spin != Vector3::zeros());
    let centre = if spin.is_some() { wall.motion.centre } else { corner };
    if along_axes(u) && along_axes(v) {
        return Ok(PlacedRegion { shape: block(corner, corner + u + v), centre, rotation: Vector3::zeros() });
    }
    // The second edge of a segment is along z and stays there.
    let axes = if along_axes(v) && v.z != 0.0 {
        Matrix3::from_columns(&[u.normalize(), Vector3::z().cross(&u).normalize(), Vector3::z()])
    } else {
        Matrix3::from_columns(&[u.normalize(), v.normalize(), u.cross(&v).normalize()])
    };
    let rotation = Rotation3::from_matrix_unchecked(axes).scaled_axis();
    if let Some(spin) = spin
        && rotation.cross(&spin).norm() > 1e-12 * rotation.norm() * spin.norm()
    {
        let reason = "which turns about one axis and lies turned about another: LAMMPS has one rotation of a region";
        return Err(format!("a rectangle such as `{}`, {reason}", wall.name));
    }
    let upright = |point: Vector3<f64>| centre + axes.transpose() * (point - centre);
    let (mut low, mut high) = (upright(corner), upright(corner + u + v));
    // Rounding must not give the block a thickness. It is flat along the second axis if the second edge is along z,
    // and else along the third.
    let flat = if along_axes(v) && v.z != 0.0 { 1 } else { 2 };
    high[flat] = low[flat];
    (low, high) = (low.inf(&high), low.sup(&high));
    Ok(PlacedRegion { shape: block(low, high), centre, rotation })
}

/// Returns a block between two corners. A grain outside touches its nearest point.
fn block(a: Vector3<f64>, b: Vector3<f64>) -> String {
    let (low, high) = (a.inf(&b), a.sup(&b));
    let sides: Vec<String> = (0..3).map(|axis| format!("{:?} {:?}", low[axis], high[axis])).collect();
    format!("block {} side out", sides.join(" "))
}

/// Returns the displacement by functions along an axis, as a formula of step and time step. It is empty without
/// functions.
fn functions(motion: &Motion, axis: usize) -> String {
    let mut terms = Vec::new();
    for Function { kind, start, stop } in &motion.functions {
        let now = if stop.is_finite() {
            format!("((step*dt<{stop:?})*(step*dt)+(step*dt>={stop:?})*{stop:?})")
        } else {
            "(step*dt)".to_owned()
        };
        let since = if *start > 0.0 { format!("((step*dt>{start:?})*({now}-{start:?}))") } else { now };
        match *kind {
            FunctionKind::Sine { amplitude, frequency, phase } if amplitude[axis] != 0.0 => {
                let rate = std::f64::consts::TAU * frequency;
                let a = amplitude[axis];
                terms.push(format!("({a:?})*(sin({rate:?}*{since}+({phase:?}))-sin({phase:?}))"));
            }
            FunctionKind::Ramp { velocity, over } if velocity[axis] != 0.0 => {
                let v = velocity[axis];
                let (rising, even) = (format!("0.5*{since}*{since}/{over:?}"), format!("({since}-{:?})", 0.5 * over));
                terms.push(format!("({v:?})*(({since}<{over:?})*{rising}+({since}>={over:?})*{even})"));
            }
            FunctionKind::Sine { .. } | FunctionKind::Ramp { .. } => {}
        }
    }
    terms.join("+")
}

/// Returns the time integral of a rate of the phases, as a formula of step and time step. It is empty without rates.
fn course(motion: &Motion, rate: impl Fn(&Phase) -> f64, stepping: &Stepping) -> String {
    let time = |moment: Moment| match moment {
        Moment::Seconds(time) => format!("{time:?}"),
        Moment::Cycle(cycle) => format!("({cycle}*dt)"),
        Moment::Never => format!("{:?}", f64::MAX),
    };
    let mut terms = Vec::new();
    for phase in motion.phases.iter().filter(|phase| rate(phase) != 0.0) {
        let rate = rate(phase);
        let start = phase.start.seconds(stepping.time_step);
        let elapsed = if phase.stop == Moment::Never {
            "(step*dt)".to_owned()
        } else {
            let stop = time(phase.stop);
            format!("((step*dt<{stop})*(step*dt)+(step*dt>={stop})*{stop})")
        };
        terms.push(if start > 0.0 {
            let start = time(phase.start);
            format!("({rate:?})*(step*dt>{start})*({elapsed}-{start})")
        } else {
            format!("({rate:?})*{elapsed}")
        });
    }
    terms.join("+")
}
