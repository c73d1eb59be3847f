//! Scenes in which walls and grains rotate together as one rigid body, with the exact position of every grain.
//!
//! All scenes rotate at angular velocity Ω about an axis through the origin, without gravity. In the rotating frame,
//! the centrifugal force, the Coriolis force and the contact forces act on a grain.

use super::scenes::{NamedScene, scene_of};
use grainbench_scene::error::SceneError;
use nalgebra::{Rotation3, Vector3};
use std::borrow::Borrow;

type V = Vector3<f64>;

/// Magnitude of the angular velocity Ω (rad/s).
const RATE: f64 = 3.0;
/// Duration T (s): about an eighth of a revolution in 168 steps of 0.08 of the critical time step.
const TIME: f64 = 0.2688;
/// Stiffness k of linear contacts (N/m), for grains of mass 1 kg and radius 1 m.
const STIFFNESS: f64 = 1.0e4;
/// Effective modulus E* of Hertz contacts (Pa), for grains of mass 1 kg and radius 1 m.
const MODULUS: f64 = 6.25e4;
/// Poisson's ratio of Hertz contacts.
const POISSON: f64 = 0.3;
/// Overlap between a grain and the walls that clamp it (m).
const HELD: f64 = 2.0e-3;
/// Radius of the drum (m).
const DRUM: f64 = 3.0;

/// Scene in which all bodies rotate as one rigid body.
pub(super) struct RotatingScene {
    pub(super) named: NamedScene,
    /// Angular velocity Ω of all bodies (rad/s).
    pub(super) spin: V,
    /// Angular frequency ω (rad/s) of a grain that vibrates on springs. They have the same stiffness in all directions and exert
    /// no net force at the start. None if each grain is at rest in the rotating frame.
    pub(super) frequency: Option<f64>,
    /// Largest overlap (m).
    pub(super) overlap: f64,
    /// True if the overlap shortens the lever arms, so that surfaces slip and the centres move.
    pub(super) carried: bool,
    /// True if contacts rotate about their normals.
    pub(super) twisted: bool,
    /// Component of Ω perpendicular to the contact normals, as a fraction of Ω. The lever arms of a clamped grain have an
    /// effect only if this component is not zero.
    pub(super) across: f64,
}

impl Borrow<NamedScene> for RotatingScene {
    fn borrow(&self) -> &NamedScene {
        &self.named
    }
}

impl RotatingScene {
    /// Returns the exact position of a grain (m) at a time (s).
    ///
    /// A grain whose springs exert no net force at r₀ obeys r̈ = −ω²(r − r₀(t)). Here r₀(t) rotates at Ω, and its component
    /// along the axis is constant. With w = x + iy perpendicular to the axis, w = r₀[a e^{iΩt} + b e^{iωt} + c
    /// e^{−iωt}], a = ω²/(ω² − Ω²), b + c = 1 − a and ω(b − c) = Ω(1 − a).
    pub(super) fn place(&self, start: V, time: f64) -> V {
        let angle = RATE * time;
        let turned = |by: f64| Rotation3::from_scaled_axis(self.spin * (by / RATE)) * start;
        let Some(frequency) = self.frequency else { return turned(angle) };
        let axis = self.spin / RATE;
        let along = axis * axis.dot(&start);
        let across = |by: f64| turned(by) - along;
        let forced = frequency.powi(2) / (frequency.powi(2) - RATE * RATE);
        let (sum, difference) = (1.0 - forced, RATE * (1.0 - forced) / frequency);
        let [forth, back] = [0.5 * (sum + difference), 0.5 * (sum - difference)];
        let phase = frequency * time;
        along + across(angle) * forced + across(phase) * forth + across(-phase) * back
    }

    /// Returns the angle of rotation of the scene at the end (rad).
    pub(super) const fn angle() -> f64 {
        RATE * TIME
    }

    /// Returns the largest distance of a grain's centre from the axis (m).
    pub(super) fn reach(&self) -> f64 {
        let axis = self.spin / RATE;
        let distance = |place: &V| (place - axis * axis.dot(place)).norm();
        self.named.scene.grains.iter().map(|grain| distance(&grain.position)).fold(0.0, f64::max)
    }
}

/// Contact law of all materials of a scene.
#[derive(Clone, Copy, PartialEq)]
enum Law {
    /// Linear springs with k_n = k_t, and this coefficient of rolling resistance.
    Linear(f64),
    /// Hertz contacts with this coefficient of rolling resistance.
    Hertz(f64),
}

impl Law {
    /// Returns the overlap (m) at a contact force (N) between a grain of radius 1 m and a wall.
    fn overlap(self, force: f64) -> f64 {
        match self {
            Self::Linear(_) => force / STIFFNESS,
            Self::Hertz(_) => (0.75 * force / MODULUS).powf(2.0 / 3.0),
        }
    }

    /// Returns the contact force (N) at an overlap (m) between a grain of radius 1 m and a wall.
    fn force(self, overlap: f64) -> f64 {
        match self {
            Self::Linear(_) => STIFFNESS * overlap,
            Self::Hertz(_) => MODULUS / 0.75 * overlap.powf(1.5),
        }
    }

    /// Returns the materials and contacts of a scene file for 2 or 3 dimensions.
    fn text(self, dimension: usize) -> String {
        let density = if dimension == 2 { 1.0 } else { 0.75 } / std::f64::consts::PI;
        let (Self::Linear(rolling) | Self::Hertz(rolling)) = self;
        // E* = E/2(1 − ν²) of two equal materials.
        let young = 2.0 * (1.0 - POISSON * POISSON) * MODULUS;
        let (moduli, springs) = match self {
            Self::Linear(_) => {
                (String::new(), format!("normal_stiffness = {STIFFNESS:?}\ntangential_stiffness = {STIFFNESS:?}"))
            }
            Self::Hertz(_) => {
                (format!("young_modulus = {young:?}\npoisson_ratio = {POISSON:?}\n"), "law = 'hertz'".to_owned())
            }
        };
        format!(
            "title = 'All turns together'\ndimension = {dimension}\nduration = {TIME:?}\n\
             [materials.m]\ndensity = {density:?}\n{moduli}\
             [contacts.m]\nbetween = ['m', 'm']\nfriction = 100.0\nrolling_friction = {rolling:?}\n{springs}\n"
        )
    }
}

/// Function that adds a wall with a name, a point and a normal.
type Walls = fn(Builder, &str, V, V) -> Builder;

/// Builds the text of one scene.
struct Builder {
    text: String,
    dimension: usize,
    spin: V,
}

impl Builder {
    fn new(dimension: usize, law: Law, axis: V) -> Self {
        Self { text: law.text(dimension), dimension, spin: axis.normalize() * RATE }
    }

    fn vector(&self, vector: V) -> String {
        format!("{:?}", &vector.as_slice()[..self.dimension])
    }

    fn spin(&self) -> String {
        if self.dimension == 2 { format!("{:?}", self.spin.z) } else { self.vector(self.spin) }
    }

    /// Adds a grain of radius 1 m that rotates with the scene.
    fn grain(mut self, name: &str, position: V) -> Self {
        let velocity = self.vector(self.spin.cross(&position));
        let (place, spin) = (self.vector(position), self.spin());
        self.text += &format!(
            "[grains.{name}]\nmaterial = 'm'\nradius = 1.0\nposition = {place}\nvelocity = {velocity}\nspin = {spin}\n"
        );
        self
    }

    fn wall(mut self, name: &str, shape: &str) -> Self {
        let (spin, centre) = (self.spin(), self.vector(V::zeros()));
        self.text +=
            &format!("[walls.{name}]\nmaterial = 'm'\n{shape}\nmotion = [{{ spin = {spin}, centre = {centre} }}]\n");
        self
    }

    fn plane(self, name: &str, point: V, normal: V) -> Self {
        let shape = format!("plane = {{ point = {}, normal = {} }}", self.vector(point), self.vector(normal));
        self.wall(name, &shape)
    }

    /// Adds a segment, or a rectangle in three dimensions, centred at a point.
    fn plate(self, name: &str, point: V, normal: V) -> Self {
        let across = if self.dimension == 2 { V::z() } else { V::new(normal.y, normal.z, normal.x) };
        let along = normal.cross(&across).normalize() * 3.0;
        if self.dimension == 2 {
            let ends = format!("segment = [{}, {}]", self.vector(point - along), self.vector(point + along));
            return self.wall(name, &ends);
        }
        let other = normal.cross(&along);
        let corner = self.vector(point - (along + other) * 0.5);
        let edges = format!("[{}, {}]", self.vector(along), self.vector(other));
        self.wall(name, &format!("rectangle = {{ corner = {corner}, edges = {edges} }}"))
    }

    /// Returns the scene of grains at rest in the rotating frame, whose overlap shortens the lever arms.
    fn carried(self, name: &'static str, overlap: f64) -> Result<RotatingScene, SceneError> {
        let (named, spin) = (scene_of(name, &[&self.text], true)?, self.spin);
        Ok(RotatingScene { named, spin, frequency: None, overlap, carried: true, twisted: false, across: 0.0 })
    }
}

/// Returns a scene with a grain between two walls. The contact springs are isotropic.
fn clamped(
    name: &'static str,
    (builder, walls): (Builder, Walls),
    normal: V,
    centre: V,
) -> Result<RotatingScene, SceneError> {
    let normal = normal.normalize();
    let off = normal * (1.0 - HELD);
    let builder = builder.grain("a", centre);
    let builder = walls(walls(builder, "low", centre - off, normal), "high", centre + off, -normal);
    let spin = builder.spin;
    let frequency = (2.0 * STIFFNESS).sqrt();
    let overlap = HELD + 2.0 * centre.norm() * (RATE / frequency).powi(2);
    let twisted = spin.dot(&normal).abs() > 1e-9;
    let across = spin.cross(&normal).norm() / RATE;
    let (named, frequency) = (scene_of(name, &[&builder.text], true)?, Some(frequency));
    Ok(RotatingScene { named, spin, frequency, overlap, carried: false, twisted, across })
}

/// Returns a scene with two grains in a row between two walls. The row intersects the axis at a right angle. The forces
/// on the two sides of a grain therefore differ by m Ω² r (m: mass, r: distance from the axis).
fn row(
    name: &'static str,
    law: Law,
    (builder, walls): (Builder, Walls),
    normal: V,
) -> Result<RotatingScene, SceneError> {
    let normal = normal.normalize();
    let first = 0.6;
    let builder = walls(builder, "low", normal * (first - 1.0 + HELD), normal).grain("a", normal * first);
    let force = law.force(HELD) + RATE * RATE * first;
    // The effective radius of two equal grains is half the effective radius of a grain and a wall.
    let between = law.overlap(if let Law::Hertz(_) = law { force * 2.0_f64.sqrt() } else { force });
    let second = first + 2.0 - between;
    let overlap = law.overlap(force + RATE * RATE * second);
    let builder = builder.grain("b", normal * second);
    let builder = walls(builder, "high", normal * (second + 1.0 - overlap), -normal);
    builder.carried(name, overlap)
}

/// Returns a scene with a sphere on the inside of a drum. The overlap δ obeys k δ = m Ω² (R_drum − R + δ) for linear springs.
fn drum(name: &'static str, law: Law, axis: V) -> Result<RotatingScene, SceneError> {
    let axis = axis.normalize();
    let mut overlap = 0.0;
    for _ in 0..100 {
        overlap = law.overlap(RATE * RATE * (DRUM - 1.0 + overlap));
    }
    let out = axis.cross(&V::new(0.3, 0.2, 0.9)).normalize();
    let builder = Builder::new(3, law, axis).grain("a", out * (DRUM - 1.0 + overlap));
    let ends = [builder.vector(axis * -5.0), builder.vector(axis * 5.0)].join(", ");
    let builder = builder.wall("drum", &format!("cylinder = {{ axis = [{ends}], radius = {DRUM:?} }}"));
    builder.carried(name, overlap)
}

/// Returns the rotating scenes of rigid grains and of grains with contact springs.
pub(super) fn all() -> Result<Vec<RotatingScene>, SceneError> {
    let [rolls, free, hertz] = [Law::Linear(0.1), Law::Linear(0.0), Law::Hertz(0.1)];
    let (flat, along) = (V::new(-0.3, 0.95, 0.0), V::new(2.0, -1.0, 2.0));
    let (across, oblique, near) = (V::new(1.0, 2.0, 0.0), V::new(1.0, 2.0, 2.0), V::new(0.9, -0.5, 0.4));
    let plane = |law| Builder::new(2, law, V::z());
    let space = |law| Builder::new(3, law, along);
    Ok(vec![
        clamped("planes-2d", (plane(rolls), Builder::plane), flat, V::new(1.2, 0.7, 0.0))?,
        row("segments-2d", free, (plane(free), Builder::plate), flat)?,
        clamped("planes-3d-along", (space(free), Builder::plane), along, V::new(1.2, 0.7, -0.5))?,
        clamped("rectangles-3d-oblique", (space(free), Builder::plate), oblique, near)?,
        row("planes-3d-hertz", hertz, (space(hertz), Builder::plane), across)?,
        drum("drum-3d", rolls, along)?,
    ])
}

/// Returns three scenes in which the order of convergence is measured. Errors due to lever arms do not depend on the time
/// step, so they do not change the measured order.
pub(super) fn smooth() -> Result<Vec<NamedScene>, SceneError> {
    let shown = ["planes-2d", "rectangles-3d-oblique", "drum-3d"];
    Ok(all()?.into_iter().map(|turning| turning.named).filter(|named| shown.contains(&named.name)).collect())
}

/// Returns freely rotating deformable bodies with each constitutive law. In two dimensions they rotate about the normal of
/// the plane, and in three about an oblique axis.
pub(super) fn free() -> Result<Vec<NamedScene>, SceneError> {
    let laws = [
        ("free-2d-neo-hookean", 2, "neo-hookean", ""),
        ("free-2d-hypoelastic", 2, "hypoelastic", ""),
        ("free-2d-von-mises", 2, "von-mises", ", yield_stress = 1e9"),
        ("free-3d-neo-hookean", 3, "neo-hookean", ""),
        ("free-3d-hypoelastic", 3, "hypoelastic", ""),
    ];
    laws.into_iter().map(|(name, dimension, law, more)| one_free(name, dimension, &format!("'{law}'{more}"))).collect()
}

fn one_free(name: &'static str, dimension: usize, law: &str) -> Result<NamedScene, SceneError> {
    let density = if dimension == 2 { 1.0 } else { 0.75 } / std::f64::consts::PI;
    let centre = [0.13, -0.21, 0.07];
    let text = format!(
        "title = 'A body turns freely'\ndimension = {dimension}\nduration = 1.0\n\
         materials.m = {{ density = {density:?}, bulk_modulus = 1e4, shear_modulus = 6e3, constitutive = {law} }}\n\
         contacts.m = {{ between = ['m', 'm'], normal_stiffness = {STIFFNESS:?} }}\n\
         [grains.a]\nmaterial = 'm'\nradius = 1.0\nposition = {:?}\n",
        &centre[..dimension]
    );
    let mut named = scene_of(name, &[&text], true)?;
    // The rim moves at 0.01 of the speed of longitudinal waves, which cross the radius of 1 m in `crossing_time(1.0)`.
    let rate = 0.01 / named.scene.crossing_time(1.0);
    named.scene.grains[0].spin = if dimension == 2 { V::z() } else { V::new(0.0, 0.6, 0.8) } * rate;
    named.scene.duration = grainbench_scene::scene::Duration::Seconds(1.0 / rate);
    Ok(named)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_scene_is_right() {
        assert_eq!((all().unwrap().len(), smooth().unwrap().len()), (6, 3));
        assert_eq!(free().unwrap().len(), 5);
    }

    /// The closed-form solution starts at r₀ with velocity Ω × r₀, and obeys r̈ = −ω²(r − r₀(t)).
    #[test]
    fn a_sprung_grain_obeys_its_equation() {
        for turning in all().unwrap().iter().filter(|turning| turning.frequency.is_some()) {
            let (start, step) = (turning.named.scene.grains[0].position, 1e-4);
            let at = |time: f64| turning.place(start, time);
            assert!((at(0.0) - start).norm() < 1e-14);
            let speed = (at(step) - at(-step)) / (2.0 * step);
            assert!((speed - turning.spin.cross(&start)).norm() < 1e-6 * start.norm(), "{}", turning.named.name);
            let time = 0.37;
            let acceleration = (at(time + step) - at(time) * 2.0 + at(time - step)) / (step * step);
            let anchor = Rotation3::from_scaled_axis(turning.spin * time) * start;
            let exact = (anchor - at(time)) * turning.frequency.unwrap().powi(2);
            assert!((acceleration - exact).norm() < 1e-3 * exact.norm(), "{}", turning.named.name);
        }
    }

    /// If all grains are at rest in the rotating frame, the contact forces on each grain sum to m Ω² r towards the axis.
    #[test]
    fn steady_scenes_are_in_balance() {
        use grainbench_scene::overlap::distance;
        for turning in all().unwrap().iter().filter(|turning| turning.frequency.is_none()) {
            let scene = &turning.named.scene;
            let law = scene.laws[0].unwrap();
            let force = |overlap: f64, radius: f64| {
                let overlap = overlap.max(0.0);
                law.springs.secant_stiffness(overlap, radius) * overlap
            };
            for grain in scene.grains.iter() {
                let mut sum = V::zeros();
                for wall in &scene.walls {
                    // The normals of the walls are parallel to the radial line through each grain.
                    let inwards = wall.name != "low";
                    let out = grain.position.normalize() * if inwards { -1.0 } else { 1.0 };
                    sum += out * force(1.0 - distance(grain.position, &wall.shape).abs(), 1.0);
                }
                for other in scene.grains.iter().filter(|other| other.position != grain.position) {
                    let apart = grain.position - other.position;
                    sum += apart.normalize() * force(2.0 - apart.norm(), 0.5);
                }
                let exact = -grain.position * RATE * RATE;
                assert!((sum - exact).norm() < 1e-9, "{}: {sum:?} {exact:?}", turning.named.name);
            }
        }
    }
}
