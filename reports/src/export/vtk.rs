//! Snapshots as VTK PolyData (XML, ASCII) for ParaView and VisIt.

use std::collections::HashMap;
use std::fmt::Debug;
use std::io::{self, Write};

use grainbench_solver::record::{ContactState, GrainState, Owner, Partner, Snapshot};
use maud::html;
use nalgebra::Vector3;

/// Writes the grains as points with their state. Each grain has a vertex, so that ParaView shows it without a filter.
///
/// # Errors
/// When `out` cannot be written.
pub(crate) fn write_grains(snapshot: &Snapshot, out: &mut impl Write) -> io::Result<()> {
    let grains = &snapshot.grains;
    open(out, snapshot.time, grains.len(), grains.len(), 0)?;
    writeln!(out, "<PointData Scalars=\"radius\" Vectors=\"velocity\">")?;
    whole(out, "Int64", "id", grains.iter().map(|grain| i64::from(grain.id)))?;
    whole(out, "Int32", "material", grains.iter().map(|grain| i64::from(grain.material)))?;
    scalars(out, "radius", grains.iter().map(|grain| grain.radius))?;
    scalars(out, "mass", grains.iter().map(|grain| grain.mass))?;
    write_if_complete(grains, |grain| grain.angle, |angles| scalars(out, "angle", angles.into_iter()))?;
    vectors(out, "velocity", grains.iter().map(|grain| grain.velocity))?;
    vectors(out, "spin", grains.iter().map(|grain| grain.spin))?;
    write_if_complete(grains, |grain| grain.force, |forces| vectors(out, "force", forces.into_iter()))?;
    write_if_complete(grains, |grain| grain.torque, |torques| vectors(out, "torque", torques.into_iter()))?;
    close(out, "PointData", grains.iter().map(|grain| grain.position), ("Verts", 1, grains.len()))
}

/// Writes a quantity as an array if all grains report it. If a grain lacks it, no array is written.
fn write_if_complete<T>(
    grains: &[GrainState],
    value: impl Fn(&GrainState) -> Option<T>,
    write: impl FnOnce(Vec<T>) -> io::Result<()>,
) -> io::Result<()> {
    grains.iter().map(value).collect::<Option<Vec<T>>>().map_or(Ok(()), write)
}

/// Writes the material points of deformable bodies.
///
/// `body` is the id of a grain, or −1 − index for a body that is not a grain. `stress` contains the components xx, yy,
/// zz, xy, yz and xz of the Cauchy stress (Pa), with tension positive.
///
/// # Errors
/// When `out` cannot be written.
pub(crate) fn write_points(snapshot: &Snapshot, out: &mut impl Write) -> io::Result<()> {
    let points = &snapshot.points;
    open(out, snapshot.time, points.len(), points.len(), 0)?;
    writeln!(out, "<PointData Scalars=\"body\" Vectors=\"velocity\" Tensors=\"stress\">")?;
    let body = |owner| match owner {
        Owner::Grain(id) => i64::from(id),
        Owner::Body(place) => -1 - i64::from(place),
    };
    whole(out, "Int64", "body", points.iter().map(|point| body(point.owner)))?;
    vectors(out, "velocity", points.iter().map(|point| point.velocity))?;
    vectors(out, "displacement", points.iter().map(|point| point.displacement))?;
    array(out, "Float64", "stress", points.iter().map(|point| point.stress))?;
    scalars(out, "plastic_strain", points.iter().map(|point| point.plastic_strain))?;
    scalars(out, "rotation", points.iter().map(|point| point.rotation))?;
    scalars(out, "volume", points.iter().map(|point| point.volume))?;
    close(out, "PointData", points.iter().map(|point| point.position), ("Verts", 1, points.len()))
}

/// Writes the contacts as lines. A line begins at the centre of the grain. It ends at the centre of the other grain, or
/// at the contact point on a wall or body.
///
/// `partner` is the id of a grain. For a wall of the scene it is −1 − index, and for a body that is not a grain −2³¹ −
/// index.
///
/// # Errors
/// When `out` cannot be written.
pub(crate) fn write_contacts(snapshot: &Snapshot, out: &mut impl Write) -> io::Result<()> {
    let by_id: HashMap<u32, &GrainState> = snapshot.grains.iter().map(|grain| (grain.id, grain)).collect();
    // Contacts with grains that are not in the snapshot are left out.
    let contacts: Vec<(&ContactState, [Vector3<f64>; 2])> =
        snapshot.told_contacts().iter().filter_map(|contact| Some((contact, ends(contact, &by_id)?))).collect();
    let all = || contacts.iter().map(|(contact, _)| *contact);
    open(out, snapshot.time, 2 * contacts.len(), 0, contacts.len())?;
    writeln!(out, "<CellData Scalars=\"normal_force\" Vectors=\"shear_force\">")?;
    whole(out, "Int64", "grain", all().map(|contact| i64::from(contact.grain)))?;
    let partner = |contact: &ContactState| match contact.partner {
        Partner::Grain(id) => i64::from(id),
        Partner::Wall(place) => -1 - i64::from(place),
        Partner::Body(place) => i64::from(i32::MIN) - i64::from(place),
    };
    whole(out, "Int64", "partner", all().map(partner))?;
    scalars(out, "normal_force", all().map(|contact| contact.normal_force))?;
    vectors(out, "shear_force", all().map(|contact| contact.shear_force))?;
    scalars(out, "overlap", all().map(|contact| contact.overlap))?;
    whole(out, "UInt8", "slipping", all().map(|contact| i64::from(contact.slipping)))?;
    close(out, "CellData", contacts.iter().flat_map(|(_, ends)| *ends), ("Lines", 2, contacts.len()))
}

/// Returns a ParaView collection (`.pvd`) of files, with the time (s) of each file.
pub(crate) fn collection(files: &[(f64, String)]) -> String {
    let line = |(time, file): &(f64, String)| {
        let file = html! { (file) }.into_string();
        format!("<DataSet timestep=\"{time:?}\" group=\"\" part=\"0\" file=\"{file}\"/>\n")
    };
    format!(
        "<?xml version=\"1.0\"?>\n\
         <VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n<Collection>\n\
         {}</Collection>\n</VTKFile>\n",
        files.iter().map(line).collect::<String>()
    )
}

/// Returns both ends of the line of a contact. The second end is computed from the normal, not from the position of the
/// partner. The line of a contact across a periodic boundary then ends at the image of the partner.
fn ends(contact: &ContactState, by_id: &HashMap<u32, &GrainState>) -> Option<[Vector3<f64>; 2]> {
    let grain = by_id.get(&contact.grain)?;
    let length = match contact.partner {
        Partner::Grain(id) => grain.radius + by_id.get(&id)?.radius - contact.overlap,
        Partner::Body(_) | Partner::Wall(_) => grain.radius - 0.5 * contact.overlap,
    };
    Some([grain.position, grain.position + contact.normal * length])
}

fn open(out: &mut impl Write, time: f64, points: usize, vertices: usize, lines: usize) -> io::Result<()> {
    writeln!(
        out,
        "<?xml version=\"1.0\"?>\n\
         <VTKFile type=\"PolyData\" version=\"0.1\" byte_order=\"LittleEndian\">\n<PolyData>\n\
         <FieldData>\n\
         <DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">\n{time:?}\n\
         </DataArray>\n</FieldData>\n\
         <Piece NumberOfPoints=\"{points}\" NumberOfVerts=\"{vertices}\" NumberOfLines=\"{lines}\" \
         NumberOfStrips=\"0\" NumberOfPolys=\"0\">"
    )
}

/// Ends the element `data`, and writes the points and `count` cells of `size` consecutive points each.
fn close(
    out: &mut impl Write,
    data: &str,
    points: impl Iterator<Item = Vector3<f64>>,
    (cells, size, count): (&str, usize, usize),
) -> io::Result<()> {
    let number = |value: usize| i64::try_from(value).unwrap_or(i64::MAX);
    writeln!(out, "</{data}>\n<Points>")?;
    vectors(out, "points", points)?;
    writeln!(out, "</Points>\n<{cells}>")?;
    whole(out, "Int64", "connectivity", (0..size * count).map(number))?;
    whole(out, "Int64", "offsets", (1..=count).map(|cell| number(cell * size)))?;
    writeln!(out, "</{cells}>\n</Piece>\n</PolyData>\n</VTKFile>")?;
    out.flush()
}

/// Writes an array with one line of `N` components for each value.
fn array<const N: usize, T: Debug>(
    out: &mut impl Write,
    kind: &str,
    name: &str,
    values: impl Iterator<Item = [T; N]>,
) -> io::Result<()> {
    let shape = if N == 1 { String::new() } else { format!(" NumberOfComponents=\"{N}\"") };
    writeln!(out, "<DataArray type=\"{kind}\" Name=\"{name}\"{shape} format=\"ascii\">")?;
    for value in values {
        for (at, component) in value.iter().enumerate() {
            write!(out, "{}{component:?}", if at == 0 { "" } else { " " })?;
        }
        writeln!(out)?;
    }
    writeln!(out, "</DataArray>")
}

pub(crate) fn whole(out: &mut impl Write, kind: &str, name: &str, values: impl Iterator<Item = i64>) -> io::Result<()> {
    array(out, kind, name, values.map(|value| [value]))
}

fn scalars(out: &mut impl Write, name: &str, values: impl Iterator<Item = f64>) -> io::Result<()> {
    array(out, "Float64", name, values.map(|value| [value]))
}

fn vectors(out: &mut impl Write, name: &str, values: impl Iterator<Item = Vector3<f64>>) -> io::Result<()> {
    array(out, "Float64", name, values.map(<[f64; 3]>::from))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::sample;

    fn text(write: impl FnOnce(&mut Vec<u8>) -> io::Result<()>) -> String {
        let mut out = Vec::new();
        write(&mut out).unwrap();
        String::from_utf8(out).unwrap()
    }

    #[test]
    fn contacts_never_cross_the_box() {
        insta::assert_snapshot!(text(|out| write_contacts(&sample::snapshot(), out)));
    }

    #[test]
    fn grains_carry_their_state() {
        insta::assert_snapshot!(text(|out| write_grains(&sample::snapshot(), out)));
    }

    #[test]
    fn points_carry_their_state() {
        insta::assert_snapshot!(text(|out| write_points(&sample::deformable(), out)));
    }

    #[test]
    fn a_collection_lists_times() {
        let files = [(0.0, "a.vtp".to_owned()), (0.1, "b&c.vtp".to_owned())];
        assert_eq!(
            collection(&files),
            "<?xml version=\"1.0\"?>\n\
             <VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n<Collection>\n\
             <DataSet timestep=\"0.0\" group=\"\" part=\"0\" file=\"a.vtp\"/>\n\
             <DataSet timestep=\"0.1\" group=\"\" part=\"0\" file=\"b&amp;c.vtp\"/>\n\
             </Collection>\n</VTKFile>\n"
        );
    }
}
