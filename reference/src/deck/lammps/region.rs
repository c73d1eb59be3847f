//! Walls as regions of LAMMPS. Planes may have any direction. Rectangles and segments are blocks without thickness.
//! Round walls are cylinders or cones. All regions may move and rotate.

use std::fmt::Write as _;

use grainbench_scene::function::{Function, FunctionKind};
use grainbench_scene::motion::{Moment, Motion, Phase};
use grainbench_scene::scene::{Wall, WallShape};
use nalgebra::{Matrix3, Rotation3, Unit, Vector3};

use crate::deck::Stepping;
use crate::deck::outline::AXES;

/// Region before its rotation, and its initial rotation.
struct PlacedRegion {
    shape: String,
    /// Point on the initial axis of rotation (m).
    centre: Vector3<f64>,
    /// Initial rotation vector (rad).
    rotation: Vector3<f64>,
}

/// Returns the commands that define the region `wallN` and its motion, with the wall number N. The displacements `ways`
/// along the axes are added to the prescribed motion.
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
        // If a wall has both an initial rotation and a spin, their axes are the same.
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
                format!("the axis of wall `{}` is not x, y or z, as a round region of LAMMPS requires", wall.name)
            })?;
            Ok(PlacedRegion { shape, centre: motion.centre, rotation: Vector3::zeros() })
        }
        WallShape::Mesh(_) => {
            Err(format!("wall `{}` is a mesh of triangles, which no region of LAMMPS can represent", wall.name))
        }
    }
}

/// Returns a cylinder or a cone about an axis of the box, or `None` for another direction. Both ends are open, so
/// grains can be in contact with the side from inside and outside.
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

/// Returns a block along the axes, and the rotation about `centre` that turns the block into the rectangle.
fn rectangle(wall: &Wall, corner: Vector3<f64>, [u, v]: [Vector3<f64>; 2]) -> Result<PlacedRegion, String> {
    let along_axes = |edge: Vector3<f64>| edge.iter().filter(|part| **part != 0.0).count() == 1;
    let spin = wall.motion.phases.iter().map(|phase| phase.spin).find(|spin| *spin != Vector3::zeros());
    let centre = if spin.is_some() { wall.motion.centre } else { corner };
    if along_axes(u) && along_axes(v) {
        return Ok(PlacedRegion { shape: block(corner, corner + u + v), centre, rotation: Vector3::zeros() });
    }
    // The second edge of a segment is along z, before and after the rotation.
    let axes = if along_axes(v) && v.z != 0.0 {
        Matrix3::from_columns(&[u.normalize(), Vector3::z().cross(&u).normalize(), Vector3::z()])
    } else {
        Matrix3::from_columns(&[u.normalize(), v.normalize(), u.cross(&v).normalize()])
    };
    let rotation = scaled_axis(axes);
    if let Some(spin) = spin
        && rotation.cross(&spin).norm() > 1e-12 * rotation.norm() * spin.norm()
    {
        let reason = "rotates about one axis and is tilted about another, but a region of LAMMPS has only one rotation";
        return Err(format!("wall `{}` {reason}", wall.name));
    }
    let upright = |point: Vector3<f64>| centre + axes.transpose() * (point - centre);
    let (mut low, mut high) = (upright(corner), upright(corner + u + v));
    // Rounding must not give the block a thickness. It is flat along the second axis if the second edge is along z,
    // otherwise along the third axis.
    let flat = if along_axes(v) && v.z != 0.0 { 1 } else { 2 };
    high[flat] = low[flat];
    (low, high) = (low.inf(&high), low.sup(&high));
    Ok(PlacedRegion { shape: block(low, high), centre, rotation })
}

/// Returns the rotation vector of a rotation matrix R: the axis times the angle.
///
/// A rotation by π about a unit vector n has R = 2nnᵀ − 1, a symmetric matrix, in whose antisymmetric part the axis is lost.
/// The largest column of R + 1 = 2nnᵀ is then parallel to n.
fn scaled_axis(axes: Matrix3<f64>) -> Vector3<f64> {
    let twice = axes + Matrix3::identity();
    let is_half_turn = (axes - axes.transpose()).norm() < 1e-12 && axes.trace() < 0.0;
    match twice.column_iter().max_by(|a, b| a.norm().total_cmp(&b.norm())) {
        Some(column) if is_half_turn => column.normalize() * std::f64::consts::PI,
        _ => Rotation3::from_matrix_unchecked(axes).scaled_axis(),
    }
}

/// Returns a block between two corners. Grains are outside the block and in contact with its nearest point.
fn block(a: Vector3<f64>, b: Vector3<f64>) -> String {
    let (low, high) = (a.inf(&b), a.sup(&b));
    let sides: Vec<String> = (0..3).map(|axis| format!("{:?} {:?}", low[axis], high[axis])).collect();
    format!("block {} side out", sides.join(" "))
}

/// Returns a LAMMPS formula of step and time step for the displacement along an axis (m) by sines and ramps. It is
/// empty if there are none.
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

/// Returns a LAMMPS formula of step and time step for the time integral of `rate`, summed over all phases of a motion.
/// It is empty if the rate is zero.
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
