//! Figures of three-dimensional records: grains as lit spheres, walls as lines, contact forces as bars.
//!
//! The projection is orthographic. A position p is drawn at (p·r, p·u), where the unit vectors r, u and t point right,
//! up and towards the eye. If two objects cover one pixel, the object with the larger p·t is visible.

use crate::number;
use grainbench_fields::picture::{Shot, two_digits};
use grainbench_harness::figure::{Field, Figure, Panel, Shades};
use grainbench_harness::raster::{RIM, Raster, VOID, level, lit};
use grainbench_solver::record::{ContactState, Partner, Snapshot, WallState};
use nalgebra::{Vector2, Vector3};
use std::f64::consts::TAU;

/// Number of pixels along the longer side of a picture.
const PIXELS: f64 = 640.0;
/// Direction of the eye from the centre of the scene.
const EYE: Vector3<f64> = Vector3::new(0.5, -0.8, 0.4);
const LIGHT: Vector3<f64> = Vector3::new(0.1, -0.7, 0.8);
/// Light intensity on surfaces that face away from the light source.
const AMBIENT: f64 = 0.3;
/// Half-width of the widest force bar, in grain radii.
const WIDEST: f64 = 0.7;
/// Number of straight lines that represent a circle.
const PIECES: usize = 48;

/// Projection from positions (m) to pixels.
struct View {
    right: Vector3<f64>,
    up: Vector3<f64>,
    toward: Vector3<f64>,
    low: Vector2<f64>,
    pixel: f64,
    size: (u32, u32),
}

impl View {
    /// Returns a projection that shows all grains, material points and outlined walls.
    fn from_shots(shots: &[Shot<'_>]) -> Option<Self> {
        let toward = EYE.normalize();
        let right = Vector3::z().cross(&toward).normalize();
        let up = toward.cross(&right);
        let (mut low, mut high) = (Vector2::repeat(f64::INFINITY), Vector2::repeat(f64::NEG_INFINITY));
        let mut include = |place: Vector3<f64>, reach: f64| {
            let at = Vector2::new(place.dot(&right), place.dot(&up));
            if at.iter().all(|value| value.is_finite()) {
                (low, high) = (low.inf(&at.add_scalar(-reach)), high.sup(&at.add_scalar(reach)));
            }
        };
        for snapshot in shots.iter().flat_map(|shot| &shot.frames) {
            snapshot.grains.iter().for_each(|grain| include(grain.position, grain.radius));
            snapshot.points.iter().for_each(|point| include(point.position, 0.5 * point.volume.cbrt()));
            outlines(snapshot).into_iter().flatten().for_each(|place| include(place, 0.0));
        }
        let reach = high - low;
        let pixel = reach.max() / PIXELS;
        if !(pixel.is_finite() && pixel > 0.0) {
            return None;
        }
        let (low, count) = (low.add_scalar(-2.0 * pixel), |reach: f64| (reach / pixel).ceil() as u32 + 4);
        Some(Self { right, up, toward, low, pixel, size: (count(reach.x), count(reach.y)) })
    }

    /// Returns the pixel coordinates from the left and from the top, and the depth towards the eye (m).
    fn at(&self, place: Vector3<f64>) -> (f64, f64, f64) {
        let across = (place.dot(&self.right) - self.low.x) / self.pixel;
        let up = (place.dot(&self.up) - self.low.y) / self.pixel;
        (across, f64::from(self.size.1) - up, place.dot(&self.toward))
    }
}

/// Levels of all pixels, and depths of the visible objects.
struct Canvas<'a> {
    view: &'a View,
    levels: Vec<u8>,
    depth: Vec<f64>,
}

impl<'a> Canvas<'a> {
    fn new(view: &'a View) -> Self {
        let count = (view.size.0 * view.size.1) as usize;
        Self { view, levels: vec![VOID; count], depth: vec![f64::NEG_INFINITY; count] }
    }

    fn put(&mut self, x: i64, y: i64, depth: f64, level: u8) {
        let (wide, high) = (i64::from(self.view.size.0), i64::from(self.view.size.1));
        if x < 0 || y < 0 || x >= wide || y >= high {
            return;
        }
        let at = (y * wide + x) as usize;
        if depth > self.depth[at] {
            (self.depth[at], self.levels[at]) = (depth, level);
        }
    }

    /// Draws a sphere. `level` returns the level for a light intensity from 0 to 1.
    fn sphere(&mut self, centre: Vector3<f64>, radius: f64, level: impl Fn(f64) -> u8) {
        let (x, y, depth) = self.view.at(centre);
        let (reach, light) = (radius / self.view.pixel, LIGHT.normalize());
        if !(x.is_finite() && y.is_finite() && reach.is_finite()) {
            return;
        }
        for row in (y - reach).floor() as i64..=(y + reach).ceil() as i64 {
            for column in (x - reach).floor() as i64..=(x + reach).ceil() as i64 {
                let (across, up) = ((column as f64 + 0.5 - x) / reach, (y - row as f64 - 0.5) / reach);
                let rest = 1.0 - across * across - up * up;
                if rest < 0.0 {
                    continue;
                }
                let normal = self.view.right * across + self.view.up * up + self.view.toward * rest.sqrt();
                let shade = AMBIENT + (1.0 - AMBIENT) * normal.dot(&light).max(0.0);
                self.put(column, row, depth + radius * rest.sqrt(), level(shade));
            }
        }
    }

    /// Draws a straight bar. `width` is in pixels.
    fn bar(&mut self, from: Vector3<f64>, to: Vector3<f64>, width: f64, level: u8) {
        let (a, b) = (self.view.at(from), self.view.at(to));
        let length = (b.0 - a.0).hypot(b.1 - a.1);
        if !length.is_finite() {
            return;
        }
        let steps = (2.0 * length).ceil().clamp(1.0, 4.0 * PIXELS) as usize;
        let half = 0.5 * width;
        for step in 0..=steps {
            let part = step as f64 / steps as f64;
            let (x, y, depth) = (a.0 + part * (b.0 - a.0), a.1 + part * (b.1 - a.1), a.2 + part * (b.2 - a.2));
            for row in (y - half).floor() as i64..=(y + half).floor() as i64 {
                for column in (x - half).floor() as i64..=(x + half).floor() as i64 {
                    let away = (column as f64 + 0.5 - x).hypot(row as f64 + 0.5 - y);
                    if away <= half.max(0.75) {
                        self.put(column, row, depth, level);
                    }
                }
            }
        }
    }

    fn walls(&mut self, snapshot: &Snapshot) {
        for outline in outlines(snapshot) {
            for pair in outline.windows(2) {
                self.bar(pair[0], pair[1], 1.0, RIM);
            }
        }
    }

    fn raster(self) -> Raster {
        Raster { width: self.view.size.0, height: self.view.size.1, levels: self.levels }
    }
}

/// Returns the edges of the walls as polylines.
fn outlines(snapshot: &Snapshot) -> Vec<Vec<Vector3<f64>>> {
    snapshot.walls.iter().flat_map(|wall| outline(wall, snapshot.bounds)).collect()
}

fn outline(wall: &WallState, (low, high): (Vector3<f64>, Vector3<f64>)) -> Vec<Vec<Vector3<f64>>> {
    match wall.corners[..] {
        // An infinite plane is drawn over the extent of the domain.
        [point, normal, ..] if wall.infinite => {
            let middle = 0.5 * (low + high);
            let foot = middle + normal * (point - middle).dot(&normal);
            let (first, second) = across(normal);
            let half = |way: Vector3<f64>| 0.5 * (high - low).dot(&way.abs());
            let (a, b) = (first * half(first), second * half(second));
            vec![vec![foot - a - b, foot + a - b, foot + a + b, foot - a + b, foot - a - b]]
        }
        // A cylinder or cone is given by the two ends of its axis and a point on the rim at each end.
        [a, b, rim_a, rim_b] if is_round([a, b, rim_a, rim_b]) => {
            let (first, second) = across((b - a).normalize());
            let circle = |centre: Vector3<f64>, radius: f64| {
                let at = |piece: usize| {
                    let (sine, cosine) = (TAU * piece as f64 / PIECES as f64).sin_cos();
                    centre + radius * (first * cosine + second * sine)
                };
                (0..=PIECES).map(at).collect::<Vec<_>>()
            };
            let (ring_a, ring_b) = (circle(a, (rim_a - a).norm()), circle(b, (rim_b - b).norm()));
            let sides = (0..PIECES).step_by(PIECES / 8).map(|at| vec![ring_a[at], ring_b[at]]).collect::<Vec<_>>();
            [vec![ring_a, ring_b], sides].concat()
        }
        // A snapshot contains the position of a mesh, but not its triangles, so nothing is drawn.
        [] | [_, _, _] => Vec::new(),
        ref corners => vec![corners.iter().chain(corners.first()).copied().collect()],
    }
}

/// Returns true if four points describe a round wall. The third point of a round wall is on the rim, so its direction
/// from the first is perpendicular to the axis. The third point of a rectangle is the opposite corner.
fn is_round([a, b, rim_a, rim_b]: [Vector3<f64>; 4]) -> bool {
    let axis = b - a;
    let is_across = |way: Vector3<f64>| way.dot(&axis).abs() <= 1e-9 * axis.norm_squared();
    is_across(rim_a - a) && is_across(rim_b - b)
}

/// Returns two unit vectors that are perpendicular to `normal` and to each other.
fn across(normal: Vector3<f64>) -> (Vector3<f64>, Vector3<f64>) {
    let other = if normal.z.abs() < 0.9 { Vector3::z() } else { Vector3::x() };
    let first = normal.cross(&other).normalize();
    (first, normal.cross(&first))
}

/// Returns the speeds of grains and material points (m/s).
fn speeds(snapshot: &Snapshot) -> impl Iterator<Item = f64> {
    let points = snapshot.points.iter().map(|point| point.velocity.norm());
    snapshot.grains.iter().map(|grain| grain.velocity.norm()).chain(points)
}

/// Returns a figure of the lit grains, coloured by speed. Several frames make a film.
pub(crate) fn grains(shots: &[Shot<'_>], times: &[f64]) -> Option<Figure> {
    let view = View::from_shots(shots)?;
    let all = shots.iter().flat_map(|shot| &shot.frames).flat_map(|snapshot| speeds(snapshot));
    let range = (0.0, readable(all.filter(|speed| speed.is_finite()).fold(0.0, f64::max)));
    let frame = |snapshot: &&Snapshot| {
        let mut canvas = Canvas::new(&view);
        let colour = |velocity: Vector3<f64>| velocity.norm() / range.1;
        if snapshot.points.is_empty() {
            for grain in &snapshot.grains {
                canvas.sphere(grain.position, grain.radius, |shade| lit(colour(grain.velocity), shade));
            }
        }
        // A material point is drawn as a sphere of the same volume.
        for point in &snapshot.points {
            let radius = (0.75 / std::f64::consts::PI * point.volume).cbrt();
            canvas.sphere(point.position, radius, |shade| lit(colour(point.velocity), shade));
        }
        canvas.walls(snapshot);
        canvas.raster()
    };
    let film = times.len() > 1;
    Some(Figure::field(
        if film { "grains-film" } else { "grains" },
        if film { "Grains, film" } else { "Grains" },
        "Grains from the front, from the right and from above, without perspective, coloured by speed. Lines are \
         walls.",
        field(&view, &shots.iter().collect::<Vec<_>>(), times, ("speed", "m/s"), range, Shades::Lit, &frame),
    ))
}

/// Returns a figure of the contact forces as bars; none if no record contains a contact.
pub(crate) fn forces(shots: &[Shot<'_>]) -> Option<Figure> {
    let view = View::from_shots(shots)?;
    let has_contacts = |shot: &&Shot<'_>| shot.frames.iter().all(|snapshot| snapshot.contacts.is_some());
    let (shown, others): (Vec<&Shot<'_>>, Vec<&Shot<'_>>) = shots.iter().partition(has_contacts);
    let strength = |contact: &ContactState| (contact.shear_force - contact.normal * contact.normal_force).norm();
    let all = || shown.iter().flat_map(|shot| &shot.frames).flat_map(|snapshot| snapshot.told_contacts()).map(strength);
    all().next()?;
    let range = (0.0, readable(all().filter(|force| force.is_finite()).fold(0.0, f64::max)));
    let frame = |snapshot: &&Snapshot| {
        let mut canvas = Canvas::new(&view);
        let mut contacts: Vec<_> = snapshot.told_contacts().iter().collect();
        contacts.sort_by(|a, b| strength(b).total_cmp(&strength(a)));
        for contact in contacts {
            let Some(grain) = snapshot.grain(contact.grain) else { continue };
            let other = match contact.partner {
                Partner::Grain(id) => snapshot.grain(id).map(|other| contact.point + contact.normal * other.radius),
                Partner::Body(_) | Partner::Wall(_) => None,
            };
            let width = 2.0 * WIDEST * grain.radius / view.pixel * strength(contact) / range.1;
            let from = contact.point - contact.normal * grain.radius;
            canvas.bar(from, other.unwrap_or(contact.point), width, level(strength(contact), range));
        }
        canvas.walls(snapshot);
        canvas.raster()
    };
    let missing = not_recorded(others.iter().map(|shot| shot.title.as_str()));
    Some(Figure::field(
        "forces",
        "Contact forces",
        &format!(
            "Each bar connects the centres of two grains in contact. Its width is proportional to the contact \
                  force.{missing}"
        ),
        field(&view, &shown, &[0.0], ("contact force", "N"), range, Shades::Amount, &frame),
    ))
}

/// Returns a sentence that names the records without data for a figure; empty if there are none.
pub(crate) fn not_recorded<'a>(names: impl Iterator<Item = &'a str>) -> String {
    let names: Vec<&str> = names.collect();
    if names.is_empty() { String::new() } else { format!(" Not recorded by {}.", names.join(", ")) }
}

fn field(
    view: &View,
    shots: &[&Shot<'_>],
    times: &[f64],
    (label, unit): (&str, &str),
    range: (f64, f64),
    shades: Shades,
    frame: &dyn Fn(&&Snapshot) -> Raster,
) -> Field {
    let panel = |shot: &&Shot<'_>| Panel {
        title: shot.title.clone(),
        frames: shot.frames.iter().map(frame).collect(),
        own: None,
    };
    Field {
        label: label.to_owned(),
        unit: unit.to_owned(),
        range,
        shades,
        pixel: view.pixel,
        length: "m".to_owned(),
        panels: shots.iter().map(panel).collect(),
        clock: "time t (s)".to_owned(),
        times: times.to_vec(),
    }
}

/// Returns the smallest number with two significant digits that is at least `value`; 1 if `value` is not positive.
fn readable(value: f64) -> f64 {
    number::significant(two_digits(value), 15).parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::sample;

    fn snapshot() -> Snapshot {
        let mut snapshot = sample::record().snapshots.pop().unwrap();
        snapshot.grains.truncate(2);
        for (at, grain) in snapshot.grains.iter_mut().enumerate() {
            grain.radius = 1.0;
            // From the eye, the second grain is behind the first.
            grain.position = -EYE.normalize() * 5.0 * at as f64;
            grain.velocity = Vector3::new(at as f64, 0.0, 0.0);
        }
        snapshot.walls.clear();
        snapshot.points.clear();
        snapshot
    }

    #[test]
    fn the_nearer_grain_hides_the_one_behind() {
        let snapshot = snapshot();
        let figure = grains(&[Shot::new("", &snapshot)], &[0.0]).unwrap();
        let grainbench_harness::figure::Drawing::Field(field) = figure.drawing else { unreachable!() };
        let raster = &field.panels[0].frames[0];
        let middle = raster.levels[(raster.height / 2 * raster.width + raster.width / 2) as usize];
        let dark = lit(0.0, 0.0)..=lit(0.0, 1.0);
        assert!(dark.contains(&middle), "{middle}: the one at rest is in front");
    }

    #[test]
    fn contacts_that_nobody_told_are_not_drawn_as_none() {
        let mut snapshot = snapshot();
        snapshot.contacts = None;
        assert!(forces(&[Shot::new("dump", &snapshot)]).is_none());
        let with_contacts = Snapshot { contacts: sample::snapshot().contacts, ..snapshot.clone() };
        let both = [Shot::new("dump", &snapshot), Shot::new("dem", &with_contacts)];
        let figure = forces(&both).unwrap();
        assert!(figure.caption.contains("Not recorded by dump"));
    }

    #[test]
    fn round_walls_are_told_from_rectangles() {
        let v = Vector3::new;
        assert!(is_round([v(0., 0., 0.), v(0., 0., 2.), v(1., 0., 0.), v(0., 2., 2.)]));
        assert!(!is_round([v(0., 0., 0.), v(2., 0., 0.), v(2., 1., 0.), v(0., 1., 0.)]));
    }
}
