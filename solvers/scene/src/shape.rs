//! Expected forms ("shapes") of values in scene files, for error messages. Keys that exist only in three dimensions
//! always show three components.

use crate::dimension::Dimension;

/// Keys, and the shapes of their values. `@` is replaced by a vector, `%` by its components, and `#` by a symmetric
/// tensor. `table.key` distinguishes keys of the same name.
const SHAPES: &[(&[&str], &str)] = &[
    (&["plane"], "{ point = @, normal = @ }"),
    (&["segment"], "[@, @]"),
    (&["rectangle"], "{ corner = [x, y, z], edges = [[x, y, z], [x, y, z]] }"),
    (&["edges", "axis"], "[[x, y, z], [x, y, z]]"),
    (&["cylinder"], "{ axis = [[x, y, z], [x, y, z]], radius = r }"),
    (&["cone"], "{ axis = [[x, y, z], [x, y, z]], radii = [r, r] }"),
    (&["cone.radii"], "[r, r]"),
    (&["mesh"], "{ file = \"FILE.stl\", unit = \"m\" }"),
    (&["mesh.file"], "\"FILE.stl\""),
    (&["piston"], "{ force = F, mass = m }"),
    (&["motion"], "[{ velocity = @ }]"),
    (&["table"], "[[t, %], …], a row for each time"),
    (&["sine"], "{ amplitude = @, frequency = f }"),
    (&["annulus"], "{ centre = @, inner = r, outer = r }"),
    (&["wave"], "{ amplitude = v }"),
    (&["fixed", "sliding"], "[\"x-low\", …]"),
    (&["box", "region", "removal", "domain"], "{ low = @, high = @ }"),
    (&["lattice"], "{ origin = @, spacing = @, count = [how many along each axis] }"),
    (&["lattice.count"], "[how many along each axis]"),
    (&["random"], "{ count = n, seed = n }"),
    (
        &["random.radii"],
        "{ log_normal = { median = r, deviation = s, range = [least, most] } } or { by_mass = [[r, share], …] }",
    ),
    (&["log_normal"], "{ median = r, deviation = s, range = [least, most] }"),
    (&["by_mass"], "[[r, share], …]"),
    (&["range", "radius_range"], "[least, most]"),
    (&["packed"], "{ radii = [[r, how many], …], seed = n }"),
    (&["packed.radii"], "[[r, how many], …]"),
    (&["poured"], "{ count = n, rate = n, seed = n, low = @, high = @ }"),
    (&["state", "file"], "{ path = \"FILE\" }"),
    (&["types"], "[\"MATERIAL\", …]"),
    (&["between"], "[\"MATERIAL\", \"MATERIAL\"]"),
    (&["contact"], "[\"GRAIN\", \"GRAIN or WALL\"]"),
    (&["point"], "{ grain = \"NAME\", at = @ }"),
    (&["snapshot_times"], "[t, …]"),
    (&["columns"], "[\"spin\", …]"),
    (&["settle"], "{ duration = t, damping = α }"),
    (&["position", "origin", "centre", "corner", "low", "high", "at", "normal", "plane.point"], "@"),
    (&["velocity", "stretch", "sine.amplitude"], "@"),
    (&["stress", "stress_gradient.x", "stress_gradient.y", "stress_gradient.z"], "#"),
    (&["stress_gradient"], "{ y = # }, what it gains a metre along an axis"),
    (&["materials"], "tables [materials.NAME] such as { density = ρ }"),
    (&["contacts"], "tables [contacts.NAME] such as { between = [\"MATERIAL\", \"MATERIAL\"], normal_stiffness = k }"),
    (&["grains"], "tables [grains.NAME] such as { material = \"MATERIAL\", radius = r, position = @ }"),
    (&["bodies"], "tables [bodies.NAME] such as { material = \"MATERIAL\", box = { low = @, high = @ } }"),
    (&["walls"], "tables [walls.NAME] such as { material = \"MATERIAL\", plane = { point = @, normal = @ } }"),
    (&["driven"], "tables [driven.NAME] such as { grains = \"GROUP\", velocity = @ }"),
    (&["probes"], "a table for each NAME such as { grain = \"GRAIN\" }"),
    (&["output"], "{ every = t }"),
];

/// Tables whose keys are names chosen by the user.
const OF_NAMES: [&str; 7] = ["materials", "contacts", "grains", "bodies", "walls", "driven", "probes"];

/// Returns the shape of a vector.
pub(crate) const fn vector(dimension: Dimension) -> &'static str {
    match dimension {
        Dimension::Two => "[x, y]",
        Dimension::Three => "[x, y, z]",
    }
}

/// Returns the shape of a symmetric tensor, row by row.
pub(crate) const fn symmetric(dimension: Dimension) -> &'static str {
    match dimension {
        Dimension::Two => "[[xx, xy], [xy, yy]]",
        Dimension::Three => "[[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]",
    }
}

/// Returns the key at a dotted path, and the expected shape of its value. Indices in brackets at the end of the path
/// are removed, because they refer to parts of the value.
pub(crate) fn expected(path: &str, dimension: Dimension) -> Option<(&str, String)> {
    let mut end = path.trim_end_matches(|letter| letter != '.').len();
    end += path[end..].find('[').unwrap_or(path.len() - end);
    let key = &path[..end];
    let mut names = key.rsplit('.').map(|part| part.split('[').next().unwrap_or(part));
    let last = names.next()?;
    let above = names.next();
    // If the user's name equals the name of a key, the value is still a table of this kind.
    let kind = above.filter(|above| names.next().is_none() && OF_NAMES.contains(above));
    let shape_of = |key: &str| SHAPES.iter().find(|(names, _)| names.contains(&key)).map(|(_, shape)| *shape);
    let shape = match (kind, above) {
        (Some(kind), _) => shape_of(kind),
        (None, Some(above)) => shape_of(&format!("{above}.{last}")).or_else(|| shape_of(last)),
        (None, None) => shape_of(last),
    }?;
    let vector = vector(dimension);
    Some((
        key,
        shape.replace('@', vector).replace('#', symmetric(dimension)).replace('%', vector.trim_matches(['[', ']'])),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_of_a_value_shows_the_shape_of_the_whole() {
        let shown = |path| expected(path, Dimension::Two).map(|(key, shape)| format!("{key}: {shape}"));
        for (path, shape) in [
            ("walls.floor.segment[0][1]", Some("walls.floor.segment: [[x, y], [x, y]]")),
            ("walls.floor.motion[1].velocity", Some("walls.floor.motion[1].velocity: [x, y]")),
            ("walls.floor.plane.point", Some("walls.floor.plane.point: [x, y]")),
            ("probes.p.point", Some("probes.p.point: { grain = \"NAME\", at = [x, y] }")),
            ("grains.a.packed.radii[0]", Some("grains.a.packed.radii: [[r, how many], …]")),
            ("walls.segment.until", None),
            ("duration", None),
        ] {
            assert_eq!(shown(path).as_deref(), shape, "{path}");
        }
        let group = expected("walls.segment", Dimension::Three).map(|(_, shape)| shape).unwrap_or_default();
        assert!(group.starts_with("tables [walls.NAME]") && group.contains("[x, y, z]"), "{group}");
    }
}
