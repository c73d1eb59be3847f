//! Means over the cells of a grid, the same for grains and for material points (Rycroft, Kamrin and Bazant 2009, §3).
//!
//! ```text
//! packing fraction  φ = (1/V) Σ volume of grain within the cell, exact; overlaps count twice      | Σ V_p/V
//! stress            T = (1/V) Σ Δx⊗F over the contacts of grains whose centre is in the cell       | (1/V) Σ V_p σ_p
//! velocity          v = v⁰ + L (x − x̄), least squares over the centres of these grains             | over points, by volume
//! ```
//!
//! Δx goes from the centre of a grain to its contact and F acts on it there, so compression is negative. The two
//! stresses are one: for a grain in equilibrium ∫σ dV = Σ Δx⊗F by Gauss' theorem. A grain counts as a whole to the cell
//! of its centre, so that T of a single cell scatters by as much as grains stick out of it; summed over cells nothing
//! is lost. Momentum flux is left out. Pressure is p = −tr T/d, and the deviator T + p·1 (the paper prints p/3 there).

use crate::overlap::{disc_in_box, sphere_in_box};
use grainbench_scene::file::GrainShape;
use grainbench_scene::record::{Partner, Snapshot};
use grainbench_scene::scene::{Dimension, Scene};
use nalgebra::{Matrix3, Vector3};

/// Equal cells that fill a box; in the plane one cell deep, from −½ to ½.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// Lower corner (m).
    pub low: Vector3<f64>,
    /// Size of a cell (m).
    pub cell: Vector3<f64>,
    /// Cells along each axis.
    pub count: [usize; 3],
}

impl Grid {
    /// The grid over the domain of a snapshot with cells of about `size` (m).
    #[must_use]
    pub fn over(snapshot: &Snapshot, size: Vector3<f64>) -> Self {
        let (low, high) = snapshot.bounds;
        let count = [0, 1, 2].map(|axis| ((high[axis] - low[axis]) / size[axis]).round().max(1.0) as usize);
        let cell = Vector3::from_fn(|axis, _| (high[axis] - low[axis]) / count[axis] as f64);
        Self { low, cell, count }
    }

    /// Volume of a cell (m³; m² in the plane).
    #[must_use]
    pub fn volume(&self) -> f64 {
        self.cell.product()
    }

    /// Corner of the cell at a place along each axis (m).
    #[must_use]
    pub fn corner(&self, at: [usize; 3]) -> Vector3<f64> {
        self.low + Vector3::from_fn(|axis, _| at[axis] as f64 * self.cell[axis])
    }

    /// Place of a cell in the list of all: x runs fastest.
    #[must_use]
    pub const fn place(&self, at: [usize; 3]) -> usize {
        at[0] + self.count[0] * (at[1] + self.count[1] * at[2])
    }

    /// The cell that a point is in.
    fn find(&self, point: Vector3<f64>) -> Option<usize> {
        let mut at = [0; 3];
        for axis in 0..3 {
            let cell = ((point[axis] - self.low[axis]) / self.cell[axis]).floor();
            if !(0.0..self.count[axis] as f64).contains(&cell) {
                return None;
            }
            at[axis] = cell as usize;
        }
        Some(self.place(at))
    }
}

/// What a cell holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Element {
    /// Grains or material points whose centre is in the cell.
    pub members: usize,
    /// Part of the cell that is filled.
    pub packing_fraction: f64,
    /// T (Pa), compression negative.
    pub stress: Matrix3<f64>,
    /// Mean velocity v⁰ (m/s).
    pub velocity: Vector3<f64>,
    /// L (1/s), L_ij = ∂v_i/∂x_j; none where too few centres are in the cell, or all in one line.
    pub velocity_gradient: Option<Matrix3<f64>>,
    dimension: usize,
}

impl Element {
    /// p = −tr T/d (Pa).
    #[must_use]
    pub fn pressure(&self) -> f64 {
        -self.stress.trace() / self.dimension as f64
    }

    /// sin φ of the steepest shear on any plane: |(λ_max − λ_min)/(λ_max + λ_min)| of T.
    #[must_use]
    pub fn stress_ratio(&self) -> f64 {
        let values = if self.dimension == 2 {
            self.stress
                .fixed_view::<2, 2>(0, 0)
                .into_owned()
                .symmetric_part()
                .symmetric_eigenvalues()
                .as_slice()
                .to_vec()
        } else {
            self.stress.symmetric_part().symmetric_eigenvalues().as_slice().to_vec()
        };
        let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let low = values.iter().copied().fold(f64::INFINITY, f64::min);
        ((high - low) / (high + low)).abs()
    }

    /// |D₀| (1/s): Frobenius' norm of the deviator of D = (L + Lᵀ)/2.
    #[must_use]
    pub fn shear_rate(&self) -> Option<f64> {
        let rate = self.velocity_gradient?.symmetric_part();
        let mut deviator = rate;
        for axis in 0..self.dimension {
            deviator[(axis, axis)] -= rate.trace() / self.dimension as f64;
        }
        Some(deviator.norm())
    }

    /// |D₀| d √(ρ/p) for grains of a diameter (m) and density (kg/m³); none without pressure.
    #[must_use]
    pub fn inertial_number(&self, diameter: f64, density: f64) -> Option<f64> {
        let pressure = self.pressure();
        (pressure > 0.0).then(|| self.shear_rate().map(|rate| rate * diameter * (density / pressure).sqrt()))?
    }
}

/// Sums over a cell for its velocity: one pass, about the middle of the cell.
#[derive(Clone, Copy, Default)]
struct Motion {
    members: usize,
    weight: f64,
    place: Vector3<f64>,
    velocity: Vector3<f64>,
    /// Σ w x⊗x and Σ w v⊗x.
    spread: Matrix3<f64>,
    carried: Matrix3<f64>,
}

impl Motion {
    fn add(&mut self, weight: f64, place: Vector3<f64>, velocity: Vector3<f64>) {
        self.members += 1;
        self.weight += weight;
        self.place += place * weight;
        self.velocity += velocity * weight;
        self.spread += place * place.transpose() * weight;
        self.carried += velocity * place.transpose() * weight;
    }

    fn gradient(&self, dimension: usize, cell: Vector3<f64>) -> Option<Matrix3<f64>> {
        if self.members <= dimension {
            return None;
        }
        let mut spread = self.spread - self.place * self.place.transpose() / self.weight;
        let carried = self.carried - self.velocity * self.place.transpose() / self.weight;
        if dimension == 2 {
            spread.m33 = self.weight;
        }
        // Centres in a line (a plane) leave one direction open: rounding must not choose.
        let size: f64 = (0..dimension).map(|axis| self.weight * cell[axis] * cell[axis]).product();
        let size = if dimension == 2 { size * self.weight } else { size };
        if spread.determinant() < 1e-12 * size {
            return None;
        }
        spread.try_inverse().map(|inverse| carried * inverse)
    }
}

/// The cells of a grid over a snapshot, in the order of [`Grid::place`]: of material points where there are some, else
/// of grains.
#[must_use]
pub fn elements(snapshot: &Snapshot, scene: &Scene, grid: &Grid) -> Vec<Element> {
    let cells = grid.count.iter().product();
    let mut motion = vec![Motion::default(); cells];
    let mut filled = vec![0.0; cells];
    let mut stress = vec![Matrix3::zeros(); cells];
    let middle = |cell: usize| {
        let at = [cell % grid.count[0], cell / grid.count[0] % grid.count[1], cell / (grid.count[0] * grid.count[1])];
        grid.corner(at) + grid.cell * 0.5
    };
    if snapshot.points.is_empty() {
        grains(snapshot, scene, grid, &mut |cell, volume| filled[cell] += volume);
        let homes: Vec<Option<usize>> = snapshot.grains.iter().map(|grain| grid.find(grain.position)).collect();
        for (grain, home) in snapshot.grains.iter().zip(&homes) {
            if let Some(cell) = *home {
                motion[cell].add(1.0, grain.position - middle(cell), grain.velocity);
            }
        }
        if snapshot.contacts.is_none() {
            // Stress that nobody told is not zero.
            stress.fill(Matrix3::repeat(f64::NAN));
        }
        for contact in snapshot.told_contacts() {
            let force = contact.shear_force - contact.normal * contact.normal_force;
            let arm = |id: u32, side: f64| {
                let place = (id as usize).checked_sub(1)?;
                let radius = snapshot.grains.get(place)?.radius;
                Some((homes[place]?, contact.normal * (side * (radius - 0.5 * contact.overlap))))
            };
            if let Some((cell, arm)) = arm(contact.grain, 1.0) {
                stress[cell] += arm * force.transpose();
            }
            if let Partner::Grain(other) = contact.partner
                && let Some((cell, arm)) = arm(other, -1.0)
            {
                stress[cell] -= arm * force.transpose();
            }
        }
    } else {
        for point in &snapshot.points {
            let place = inside(snapshot, point.position);
            let Some(cell) = grid.find(place) else { continue };
            let [xx, yy, zz, xy, yz, zx] = point.stress;
            filled[cell] += point.volume;
            stress[cell] += Matrix3::new(xx, xy, zx, xy, yy, yz, zx, yz, zz) * point.volume;
            motion[cell].add(point.volume, place - middle(cell), point.velocity);
        }
    }
    let dimension = scene.dimension.count();
    let volume = grid.volume();
    (0..cells)
        .map(|cell| Element {
            members: motion[cell].members,
            packing_fraction: filled[cell] / volume,
            stress: in_plane(stress[cell] / volume, scene.dimension),
            velocity: if motion[cell].members > 0 {
                motion[cell].velocity / motion[cell].weight
            } else {
                Vector3::zeros()
            },
            velocity_gradient: motion[cell].gradient(dimension, grid.cell),
            dimension,
        })
        .collect()
}

/// Contacts of discs know nothing of the stress along z, and pressure is that of the plane.
fn in_plane(mut stress: Matrix3<f64>, dimension: Dimension) -> Matrix3<f64> {
    if dimension == Dimension::Two {
        stress.set_row(2, &Vector3::zeros().transpose());
        stress.set_column(2, &Vector3::zeros());
    }
    stress
}

/// Where a place is within the domain along periodic axes.
pub(crate) fn inside(snapshot: &Snapshot, mut place: Vector3<f64>) -> Vector3<f64> {
    let (low, high) = snapshot.bounds;
    for axis in (0..3).filter(|&axis| snapshot.periodic[axis]) {
        place[axis] = low[axis] + (place[axis] - low[axis]).rem_euclid(high[axis] - low[axis]);
    }
    place
}

/// Gives every cell the volume of each grain that is in it, of images across periodic sides too.
fn grains(snapshot: &Snapshot, scene: &Scene, grid: &Grid, add: &mut impl FnMut(usize, f64)) {
    let dimension = scene.dimension.count();
    let (low, high) = snapshot.bounds;
    let shifts = |axis: usize| -> &[f64] {
        if axis < dimension && snapshot.periodic[axis] { &[-1.0, 0.0, 1.0] } else { &[0.0] }
    };
    for grain in &snapshot.grains {
        for &i in shifts(0) {
            for &j in shifts(1) {
                for &k in shifts(2) {
                    let centre = grain.position + Vector3::new(i, j, k).component_mul(&(high - low));
                    share_out(centre, grain.radius, scene, grid, add);
                }
            }
        }
    }
}

fn share_out(centre: Vector3<f64>, radius: f64, scene: &Scene, grid: &Grid, add: &mut impl FnMut(usize, f64)) {
    let reach = |axis: usize| {
        if axis == 2 && scene.dimension == Dimension::Two {
            return 0..1;
        }
        let cell = |place: f64| ((place - grid.low[axis]) / grid.cell[axis]).floor().max(0.0) as usize;
        cell(centre[axis] - radius)..(cell(centre[axis] + radius) + 1).min(grid.count[axis])
    };
    for k in reach(2) {
        for j in reach(1) {
            for i in reach(0) {
                let corner = grid.corner([i, j, k]);
                let low = corner - centre;
                let high = low + grid.cell;
                // A sphere kept in a plane is a disc per metre to whoever looks at the plane.
                let volume = if scene.dimension == Dimension::Two || scene.grain_shape == GrainShape::Disc {
                    disc_in_box(radius, [low.x, low.y], [high.x, high.y])
                } else {
                    sphere_in_box(radius, low.into(), high.into())
                };
                add(grid.place([i, j, k]), volume);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use grainbench_scene::record::{ContactState, GrainState, Owner, PointState};
    use grainbench_scene::source::SceneSource;
    use std::path::Path;

    const COUNT: usize = 4;
    const RADIUS: f64 = 0.5;

    /// A periodic square lattice of discs pressed by p_x and p_y (N a contact), that moves as v = L x.
    fn lattice(presses: [f64; 2], gradient: Matrix3<f64>) -> (Scene, Snapshot) {
        let text = format!(
            "title = 'lattice'\ndimension = 2\nduration = 1.0\nmaterials.m.density = 1.0\n\
             contacts.all = {{ between = ['m', 'm'], normal_stiffness = 1.0 }}\n\
             domain = {{ low = [0.0, 0.0], high = [{COUNT}.0, {COUNT}.0], periodic = [true, true] }}\n\
             [grains.g]\nmaterial = 'm'\nradius = {RADIUS}\n\
             lattice = {{ origin = [0.5, 0.5], spacing = [1.0, 1.0], count = [{COUNT}, {COUNT}] }}\n"
        );
        let scene = SceneSource::from_text("test", Path::new(""), &text).scene(&|_| Err("no files".to_owned()));
        let scene = scene.unwrap_or_else(|error| unreachable!("{error}"));
        let mut grains: Vec<GrainState> =
            scene.grains.iter().zip(1..).map(|(grain, id)| GrainState::start(id, grain)).collect();
        grains.iter_mut().for_each(|grain| grain.velocity = gradient * grain.position);
        let id = |x: usize, y: usize| {
            let near = |grain: &&GrainState| {
                let at = Vector3::new((x % COUNT) as f64 + 0.5, (y % COUNT) as f64 + 0.5, 0.0);
                (grain.position - at).norm() < 0.1
            };
            grains.iter().find(near).map_or(0, |grain| grain.id)
        };
        let contact = |x: usize, y: usize, axis: usize| ContactState {
            grain: id(x, y),
            partner: Partner::Grain(if axis == 0 { id(x + 1, y) } else { id(x, y + 1) }),
            point: Vector3::zeros(),
            normal: if axis == 0 { Vector3::x() } else { Vector3::y() },
            overlap: 0.0,
            normal_force: presses[axis],
            shear_force: Vector3::zeros(),
            slipping: false,
        };
        let contacts =
            (0..COUNT * COUNT * 2).map(|at| contact(at / 2 % COUNT, at / 2 / COUNT, at % 2)).collect::<Vec<_>>();
        let snapshot = Snapshot { contacts: Some(contacts), ..Snapshot::of_grains(&scene, 0, 0.0, grains) };
        (scene, snapshot)
    }

    fn shear() -> Matrix3<f64> {
        Matrix3::new(0.3, -1.2, 0.0, 0.7, -0.4, 0.0, 0.0, 0.0, 0.0)
    }

    #[test]
    fn a_lattice_has_the_stress_of_its_load_and_the_gradient_of_its_motion() {
        let (scene, snapshot) = lattice([3.0, 5.0], shear());
        let grid = Grid::over(&snapshot, Vector3::new(2.0, 2.0, 1.0));
        assert_eq!(grid.count, [2, 2, 1]);
        for element in elements(&snapshot, &scene, &grid) {
            // One contact a spacing along each axis: T_xx = −p_x/1.
            let exact = Matrix3::from_diagonal(&Vector3::new(-3.0, -5.0, 0.0));
            assert!((element.stress - exact).norm() < 1e-12, "{}", element.stress);
            assert!((element.pressure() - 4.0).abs() < 1e-12 && (element.stress_ratio() - 0.25).abs() < 1e-12);
            assert!((element.packing_fraction - std::f64::consts::FRAC_PI_4).abs() < 1e-12);
            assert_eq!(element.members, 4);
            let gradient = element.velocity_gradient.unwrap_or_default();
            assert!((gradient - shear()).norm() < 1e-12, "{gradient}");
            // D = ((.3, −.25), (−.25, −.4)), tr D = −.1.
            let exact = (2.0 * 0.35_f64.powi(2) + 2.0 * 0.25_f64.powi(2)).sqrt();
            assert!((element.shear_rate().unwrap_or(0.0) - exact).abs() < 1e-12);
        }
    }

    #[test]
    fn a_lost_contact_and_a_stray_velocity_are_seen() {
        let (scene, mut snapshot) = lattice([3.0, 5.0], shear());
        let grid = Grid::over(&snapshot, Vector3::new(4.0, 4.0, 1.0));
        snapshot.contacts.as_mut().unwrap().pop();
        snapshot.grains[5].velocity.x += 1.0;
        let element = elements(&snapshot, &scene, &grid)[0];
        assert!((element.stress.m22 + 5.0 * 15.0 / 16.0).abs() < 1e-12);
        assert!((element.velocity_gradient.unwrap_or_default() - shear()).norm() > 0.02);
    }

    #[test]
    fn a_row_of_centres_has_no_gradient() {
        let (scene, mut snapshot) = lattice([0.0, 0.0], shear());
        snapshot.grains.retain(|grain| grain.position.y < 1.0);
        snapshot.contacts.as_mut().unwrap().clear();
        let grid = Grid::over(&snapshot, Vector3::new(4.0, 4.0, 1.0));
        let element = elements(&snapshot, &scene, &grid)[0];
        assert_eq!((element.members, element.velocity_gradient), (COUNT, None));
        assert_eq!(element.inertial_number(1.0, 1.0), None);
    }

    #[test]
    fn cells_share_grains_out_whatever_their_size() {
        let (scene, snapshot) = lattice([1.0, 1.0], Matrix3::zeros());
        let grid = Grid::over(&snapshot, Vector3::new(0.3, 0.7, 1.0));
        let all = elements(&snapshot, &scene, &grid);
        let mean = all.iter().map(|element| element.packing_fraction).sum::<f64>() / all.len() as f64;
        assert!((mean - std::f64::consts::FRAC_PI_4).abs() < 1e-12, "{mean}");
        assert!(all.iter().any(|element| (element.packing_fraction - mean).abs() > 0.1));
    }

    /// The stress that a disc's contacts give it is the mean of the stress inside it, so grains and points compare.
    #[test]
    fn material_points_under_the_same_load_give_the_same_stress() {
        use crate::disc::{Load, LoadedDisc};
        use nalgebra::Vector2;
        let (scene, mut snapshot) = lattice([3.0, 5.0], shear());
        let of_contacts = elements(&snapshot, &scene, &Grid::over(&snapshot, Vector3::new(4.0, 4.0, 1.0)))[0];
        let loads = [(Vector2::x(), 3.0), (-Vector2::x(), 3.0), (Vector2::y(), 5.0), (-Vector2::y(), 5.0)];
        let loads = loads.map(|(normal, force)| Load { normal, force: -normal * force });
        let disc = LoadedDisc::new(RADIUS, loads.to_vec());
        let mut of_points = |rings: i32| {
            snapshot.points.clear();
            for grain in &snapshot.grains {
                for at in 0..rings * rings {
                    let ring = RADIUS * (f64::from(at / rings) + 0.5) / f64::from(rings);
                    let angle = std::f64::consts::TAU * (f64::from(at % rings) + 0.5) / f64::from(rings);
                    let arm = Vector2::new(ring * angle.cos(), ring * angle.sin());
                    let stress = disc.stress(arm);
                    let position = grain.position + Vector3::new(arm.x, arm.y, 0.0);
                    snapshot.points.push(PointState {
                        owner: Owner::Grain(grain.id),
                        position,
                        displacement: Vector3::zeros(),
                        velocity: shear() * position,
                        stress: [stress.m11, stress.m22, -7.0, stress.m12, 0.0, 0.0],
                        plastic_strain: 0.0,
                        rotation: 0.0,
                        volume: ring * (RADIUS / f64::from(rings)) * std::f64::consts::TAU / f64::from(rings),
                    });
                }
            }
            elements(&snapshot, &scene, &Grid::over(&snapshot, Vector3::new(4.0, 4.0, 1.0)))[0]
        };
        let (coarse, fine) = (of_points(40), of_points(80));
        // Stress grows as 1/r at the contacts, of which points miss as much as they are apart.
        let stress = fine.stress * 2.0 - coarse.stress;
        assert!((stress - of_contacts.stress).norm() < 3e-3 * of_contacts.stress.norm(), "{stress}");
        assert!((fine.packing_fraction - of_contacts.packing_fraction).abs() < 1e-9);
        assert!((fine.velocity_gradient.unwrap_or_default() - shear()).norm() < 1e-9);
    }
}
