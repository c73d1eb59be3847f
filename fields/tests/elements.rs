//! Tests of granular elements against closed forms: lattices under known strain, linear velocity fields, noise, and
//! sums that do not depend on the grid.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use grainbench_fields::course::Course;
use grainbench_fields::element::{Element, elements, velocity_at};
use grainbench_fields::grid::Grid;
use grainbench_fields::mask::Masks;
use grainbench_fields::motion::{Mover, motion, movers, movers_between};
use grainbench_fields::tensor;
use grainbench_fields::trails::{hencky, tracers};
use grainbench_scene::dimension::Dimension;
use grainbench_scene::scene::Grain;
use grainbench_solver::record::{ContactState, GrainState, Partner, Snapshot};
use nalgebra::{Matrix3, Vector3};

fn grain(id: u32, position: Vector3<f64>) -> GrainState {
    GrainState::start(id, &Grain { radius: 0.5, mass: 1.0, inertia: 0.1, position, ..Grain::default() })
}

fn snapshot(grains: Vec<GrainState>, high: Vector3<f64>, periodic: [bool; 3]) -> Snapshot {
    let bounds = (Vector3::zeros(), high);
    Snapshot { bounds, periodic, grains, contacts: Some(Vec::new()), ..Snapshot::default() }
}

/// Returns a face-centred cubic lattice of spheres of diameter one under a deformation F, and the undeformed positions.
/// Contact forces are k δ, with stiffness k and overlap δ.
///
/// F has at most one off-diagonal entry, and the block has 5 cells along each axis. The block is not periodic. The
/// stress is evaluated in the cell in the middle, whose grains have all their contacts.
fn lattice(deformation: &Matrix3<f64>, stiffness: f64) -> (Snapshot, Vec<Vector3<f64>>) {
    let root = 2.0_f64.sqrt();
    let bases = [[0.0, 0.0, 0.0], [0.5, 0.5, 0.0], [0.5, 0.0, 0.5], [0.0, 0.5, 0.5]].map(Vector3::from);
    let mut first = Vec::new();
    for cell in 0..125 {
        let at = Vector3::new(f64::from(cell % 5), f64::from(cell / 5 % 5), f64::from(cell / 25));
        // The grains are at least a quarter of a cell away from the sides of the cells.
        first.extend(bases.map(|base| (at + base + Vector3::repeat(0.25)) * root));
    }
    let grains: Vec<GrainState> = (1..).zip(&first).map(|(id, &at)| grain(id, deformation * at)).collect();
    let mut contacts = Vec::new();
    for (one, a) in grains.iter().enumerate() {
        for (other, b) in grains.iter().enumerate().skip(one + 1) {
            if (first[one] - first[other]).norm() > 1.01 {
                continue;
            }
            let between = b.position - a.position;
            let overlap = 1.0 - between.norm();
            contacts.push(ContactState {
                grain: a.id,
                partner: Partner::Grain(b.id),
                point: a.position + between * 0.5,
                normal: between.normalize(),
                overlap,
                normal_force: stiffness * overlap,
                ..ContactState::default()
            });
        }
    }
    let snapshot = Snapshot { contacts: Some(contacts), ..snapshot(grains, Vector3::repeat(5.0 * root), [false; 3]) };
    (snapshot, first)
}

/// Returns the mean stress over the cell in the middle of a block, whose grains have all their contacts.
fn middle_cell(snapshot: &Snapshot, first: &[Vector3<f64>], deformation: &Matrix3<f64>) -> Matrix3<f64> {
    let root = 2.0_f64.sqrt();
    let inside = |id: u32| (first[id as usize - 1] / root).iter().all(|along| (2.0..3.0).contains(along));
    // Grains of other cells are moved far away, so that their share of the contacts is not counted.
    let mut alone = snapshot.clone();
    alone.grains.iter_mut().filter(|grain| !inside(grain.id)).for_each(|grain| grain.position.x = 1e6);
    let volume = (root.powi(3)) * deformation.determinant();
    let grid = Grid { low: Vector3::zeros(), cell: Vector3::repeat(20.0), count: [1; 3] };
    let element = elements(&alone, Dimension::Three, &grid)[0];
    assert_eq!(element.motion.members, 4);
    element.stress.unwrap() * grid.volume() / volume
}

fn close(found: f64, exact: f64, part: f64) {
    assert!((found - exact).abs() <= part * exact.abs().max(1e-300), "{found:.12} for {exact:.12}");
}

/// The stress is T = −(1/2V) Σ₁₂ k(1 − |b|) b⊗b/|b| over the vectors b = F b₀ from the centre of a grain to its twelve
/// neighbours. V = det F/√2 is the volume per grain.
#[test]
fn a_lattice_under_strain_has_its_stress() {
    const STIFFNESS: f64 = 2e5;
    let even = Matrix3::identity() * 0.999;
    let (shot, first) = lattice(&even, STIFFNESS);
    let stress = middle_cell(&shot, &first, &even);
    close(tensor::pressure(&stress, 3), 2.0 * 2.0_f64.sqrt() * STIFFNESS * 0.001 / 0.999_f64.powi(2), 1e-10);
    close(tensor::pressure(&stress, 3), 566.818_495_1, 1e-9);

    let mut strained = Matrix3::from_diagonal(&Vector3::new(0.9985, 0.999, 0.9992));
    strained.m13 = 0.0008;
    let (shot, first) = lattice(&strained, STIFFNESS);
    let stress = middle_cell(&shot, &first, &strained);
    let known = [
        (stress.m11, -679.658_283_34),
        (stress.m22, -609.520_405_86),
        (stress.m33, -581.378_099_63),
        (stress.m13, 113.005_981_54),
        (tensor::pressure(&stress, 3), 623.518_930),
        (tensor::sine_of_friction(&stress, 3), 0.195_438_99),
        (tensor::drucker_prager(&stress, 3), 0.198_586_97),
    ];
    for (found, exact) in known {
        // The tolerance corresponds to the digits of the reference values.
        close(found, exact, 5e-8);
    }
    // The sum over twelve neighbours gives the same result to machine precision.
    let (mut exact, root) = (Matrix3::zeros(), 0.5_f64.sqrt());
    for (i, j) in [(0, 1), (0, 2), (1, 2)] {
        for signs in [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]] {
            let mut before = Vector3::zeros();
            (before[i], before[j]) = (signs[0] * root, signs[1] * root);
            let branch = strained * before;
            exact -= branch * branch.transpose() * (STIFFNESS * (1.0 - branch.norm()) / branch.norm());
        }
    }
    exact *= 0.5 * 2.0_f64.sqrt() / strained.determinant();
    assert!((stress - exact).norm() < 1e-10 * exact.norm(), "{stress} {exact}");
    // A missing contact changes the result.
    let mut less = shot.clone();
    let contacts = less.contacts.as_mut().unwrap();
    let is_inside = |contact: &ContactState| first[contact.grain as usize - 1].iter().all(|x| (2.9..4.2).contains(x));
    let place = contacts.iter().position(is_inside);
    contacts.remove(place.unwrap());
    assert!((middle_cell(&less, &first, &strained) - exact).norm() > 1e-2 * exact.norm());
}

/// Generator of pseudo-random numbers, uniform from 0 to 1 and normal.
struct RandomNumbers(u64);

impl RandomNumbers {
    fn even(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 11) as f64) / (1_u64 << 53) as f64
    }

    fn normal(&mut self) -> f64 {
        let (radius, angle) = ((-2.0 * (1.0 - self.even()).ln()).sqrt(), std::f64::consts::TAU * self.even());
        radius * angle.cos()
    }

    fn place(&mut self, size: Vector3<f64>) -> Vector3<f64> {
        Vector3::from_fn(|axis, _| self.even() * size[axis])
    }
}

#[test]
fn a_field_that_is_linear_has_its_gradient_and_leaves_nothing() {
    let mut odd = RandomNumbers(1);
    let size = Vector3::new(7.5, 8.0, 7.5);
    let gradient = Matrix3::new(0.3, -1.2, 0.4, 0.7, -0.4, 0.1, 0.2, -0.6, 0.15);
    let grid = Grid::filling((Vector3::zeros(), size), Vector3::new(2.5, 8.0, 2.5));
    let movers: Vec<Mover> = (0..600)
        .map(|_| {
            let position = odd.place(size);
            Mover { position, velocity: gradient * position + Vector3::new(3.0, 0.0, -9.0), weight: 1.0 }
        })
        .collect();
    for motion in motion(&movers, 3, &grid) {
        assert!((motion.gradient.unwrap() - gradient).norm() < 1e-12);
        assert!(motion.residual.unwrap() < 1e-12);
    }
}

/// For random velocity components with standard deviation σ, the rms of |D₀| is σ √((10/3 a + 5/3 b) N/(N−5)) with a =
/// 12/(Nℓ²) and b = 12/(Nm²). N is the number of grains in a cell of ℓ × m × ℓ. The residual is |v′| = σ √(3 (N−4)/N).
#[test]
fn noise_gives_the_rate_of_shear_that_it_must() {
    for (count, size, known) in [(60.0, [2.5, 8.0, 2.5], 0.3494), (240.0, [5.0, 8.0, 5.0], 0.0902)] {
        let size = Vector3::from(size);
        let grid = Grid { low: Vector3::zeros(), cell: size, count: [1; 3] };
        let (a, b) = (12.0 / (count * size.x * size.x), 12.0 / (count * size.y * size.y));
        let exact = ((10.0 / 3.0 * a + 5.0 / 3.0 * b) * count / (count - 5.0)).sqrt();
        assert!((exact - known).abs() < 1e-3);
        let (mut square, mut residual, mut odd) = (0.0, 0.0, RandomNumbers(7));
        const TIMES: i32 = 4000;
        for _ in 0..TIMES {
            let mover =
                |_| Mover { position: odd.place(size), velocity: Vector3::from_fn(|_, _| odd.normal()), weight: 1.0 };
            let movers: Vec<Mover> = (0..count as usize).map(mover).collect();
            let motion = motion(&movers, 3, &grid)[0];
            let element = Element { packing_fraction: 0.0, stress: None, motion, dimension: 3 };
            square += element.shear_rate().unwrap().powi(2);
            residual += motion.residual.unwrap().powi(2);
        }
        // The mean square of 4000 samples with five degrees of freedom has a standard error of √(2/(5 · 4000)) = 1 %, and
        // the rms half of it. The degrees of freedom have different variances, so the error is somewhat larger.
        close((square / f64::from(TIMES)).sqrt(), exact, 0.03);
        close((residual / f64::from(TIMES)).sqrt(), (3.0 * (count - 4.0) / count).sqrt(), 0.005);
    }
}

/// The sums over all cells do not depend on the size of the cells. Σ φ V is the volume of all grains, the sum of the
/// members is the number of grains, and Σ V T is the sum over all contacts.
#[test]
fn no_choice_of_cells_gains_or_loses_anything() {
    let mut odd = RandomNumbers(3);
    let high = Vector3::new(10.0, 8.0, 12.0);
    let mut grains: Vec<GrainState> = (1..=300).map(|id| grain(id, odd.place(high))).collect();
    grains.iter_mut().for_each(|grain| grain.radius = 0.3 + 0.4 * odd.even());
    let contacts: Vec<ContactState> = (1..300)
        .map(|id| ContactState {
            grain: id,
            partner: if id % 7 == 0 { Partner::Wall(0) } else { Partner::Grain(id + 1) },
            normal: Vector3::from_fn(|_, _| odd.normal()).normalize(),
            overlap: 0.01 * odd.even(),
            normal_force: odd.even(),
            shear_force: Vector3::from_fn(|_, _| odd.normal()),
            ..ContactState::default()
        })
        .collect();
    let all: f64 = grains.iter().map(|grain| 4.0 / 3.0 * std::f64::consts::PI * grain.radius.powi(3)).sum();
    let radius = |id: u32| grains[id as usize - 1].radius;
    let mut sum = Matrix3::zeros();
    for contact in &contacts {
        let force = contact.shear_force - contact.normal * contact.normal_force;
        let arm = |id: u32| contact.normal * (radius(id) - 0.5 * contact.overlap);
        sum += arm(contact.grain) * force.transpose();
        if let Partner::Grain(other) = contact.partner {
            sum += arm(other) * force.transpose();
        }
    }
    let shot = Snapshot { contacts: Some(contacts), ..snapshot(grains, high, [true; 3]) };
    for size in [[2.5, 8.0, 2.5], [1.3, 1.7, 0.9], [10.0, 8.0, 12.0]] {
        let grid = Grid::filling(shot.bounds, size.into());
        let elements = elements(&shot, Dimension::Three, &grid);
        let filled: f64 = elements.iter().map(|element| element.packing_fraction * grid.volume()).sum();
        close(filled, all, 1e-13);
        assert_eq!(elements.iter().map(|element| element.motion.members).sum::<usize>(), 300);
        let stress: Matrix3<f64> = elements.iter().map(|element| element.stress.unwrap() * grid.volume()).sum();
        assert!((stress - sum).norm() < 1e-12 * sum.norm());
    }
}

/// Other programs write grains outside a periodic box, by a part of a radius or by whole box lengths. These grains
/// count at their image in the box of 4 m × 4 m × 4 m.
#[test]
fn grains_outside_a_periodic_box_count_inside() {
    let periodic =
        |grains: Vec<GrainState>| Snapshot { time: 1.0, ..snapshot(grains, Vector3::repeat(4.0), [true; 3]) };
    // The images of the two grains are at x = 3.75 m and 0.5 m. Their overlap is 0.25 m, so each lever arm is 0.375 m. Each
    // grain adds −0.375 m · 8 N to a cell of 32 m³. A cap of height 0.25 m of grain 1 lies in the first cell.
    let mut shot = periodic(vec![grain(1, Vector3::new(-0.25, 2.0, 2.0)), grain(2, Vector3::new(8.5, -2.0, 6.0))]);
    let contact =
        ContactState { grain: 1, partner: Partner::Grain(2), overlap: 0.25, normal_force: 8.0, ..Default::default() };
    shot.contacts = Some(vec![ContactState { normal: Vector3::x(), ..contact }]);
    let (sphere, cap) = (std::f64::consts::PI / 6.0, std::f64::consts::PI * 0.0625 * 1.25 / 3.0);
    let halves = Grid::filling(shot.bounds, Vector3::new(2.0, 4.0, 4.0));
    for (element, volume) in elements(&shot, Dimension::Three, &halves).iter().zip([sphere + cap, sphere - cap]) {
        assert_eq!((element.motion.members, element.stress.unwrap().m11), (1, -3.0 / 32.0));
        close(element.packing_fraction, volume / 32.0, 1e-13);
    }
    // The virials of the grains give the same stress as the contact.
    shot.contacts = None;
    shot.grains.iter_mut().for_each(|grain| grain.virial = Some(Box::new([-3.0, 0.0, 0.0, 0.0, 0.0, 0.0])));
    assert!(
        elements(&shot, Dimension::Three, &halves).iter().all(|element| element.stress.unwrap().m11 == -3.0 / 32.0)
    );

    // Eight grains at the corners of a cube move with v = L x. Each grain is shifted by another number of box lengths.
    let gradient = Matrix3::new(0.03, -0.12, 0.04, 0.07, -0.04, 0.01, 0.02, -0.06, 0.015);
    let corner = |id: u32| Vector3::from_fn(|axis, _| if (id - 1) >> axis & 1 == 1 { 2.5 } else { 1.5 });
    let cube = |place: &dyn Fn(u32) -> Vector3<f64>| {
        let moving = |id| GrainState { velocity: gradient * corner(id), ..grain(id, place(id)) };
        periodic((1..=8).map(moving).collect())
    };
    let after = cube(&|id| corner(id) + Vector3::new(4.0, -8.0, 12.0) * (f64::from(id) - 4.0));
    let before = Snapshot { time: 0.0, ..cube(&|id| corner(id) - gradient * corner(id)) };
    let whole = Grid::filling(after.bounds, Vector3::repeat(4.0));
    for movers in [movers(&after), movers_between(&before, &after)] {
        assert!((motion(&movers, 3, &whole)[0].gradient.unwrap() - gradient).norm() < 1e-12);
    }
    let stretch = tracers(&after, &whole)[0].deformation(&cube(&|id| corner(id) * 1.1), 3).unwrap();
    assert!((stretch - Matrix3::identity() * 1.1).norm() < 1e-12, "{stretch}");

    // A position in the box stays the same to the bit, although −0.1 + (0.3 + 0.1) is not 0.3. A position that rounds to the
    // upper side moves to the lower side.
    let mut shot = periodic(vec![grain(1, Vector3::new(0.3, 4.0, -1e-17))]);
    shot.bounds.0.x = -0.1;
    assert_eq!(movers(&shot)[0].position, Vector3::new(0.3, 0.0, 0.0));
}

/// A column of three grains fills cells of 1 m between a floor and a lid. If the contacts may lack those with the lid, the
/// top cell is masked as a cell at a wall.
#[test]
fn without_wall_contacts_the_cell_under_a_lid_is_masked() {
    let grains = (1..=3).map(|id| grain(id, Vector3::new(0.5, 0.5, f64::from(id) - 0.5))).collect();
    let dump = snapshot(grains, Vector3::new(1.0, 1.0, 3.0), [true, true, false]);
    let (mut forces, mut lid) = (dump.clone(), dump.clone());
    forces.grains.iter_mut().for_each(|grain| grain.force = Some(Vector3::zeros()));
    lid.contacts = Some(vec![ContactState { grain: 3, partner: Partner::Wall(0), ..ContactState::default() }]);
    for (shot, top) in [(dump.clone(), "wall"), (forces, ""), (lid, ""), (Snapshot { contacts: None, ..dump }, "")] {
        let (periodic, up) = (shot.periodic, (2, true));
        let masks = Masks { fewest: 1, surface: 0.4, up, periodic, dimension: 3, orifice: None, flowing: None };
        let grid = Grid::filling(shot.bounds, Vector3::repeat(1.0));
        let mut course = Course::new(grid, Dimension::Three, [0, 2], masks, false);
        course.add(shot);
        let words: Vec<String> = course.frames[0].masked.iter().map(|masked| masked.words()).collect();
        assert_eq!(words, ["wall", "", top]);
    }
}

/// Unknown stress is `None`, never zero.
#[test]
fn without_contacts_there_is_no_stress() {
    let shot =
        Snapshot { contacts: None, ..snapshot(vec![grain(1, Vector3::repeat(1.0))], Vector3::repeat(2.0), [false; 3]) };
    let grid = Grid::filling(shot.bounds, Vector3::repeat(2.0));
    let element = elements(&shot, Dimension::Three, &grid)[0];
    assert_eq!((element.stress, element.pressure(), element.sine_of_friction()), (None, None, None));
    close(element.packing_fraction, std::f64::consts::PI / 6.0 / 8.0, 1e-13);
}

/// Grains move with v = L x. The labelled grains of a tracer give F = exp(L t). The motion between two snapshots gives
/// the gradient of the mean velocity.
#[test]
fn tracers_move_and_deform_with_the_flow() {
    let mut odd = RandomNumbers(5);
    let (high, rate, step) = (Vector3::new(10.0, 8.0, 10.0), 0.08, 0.05);
    let at = |start: &Vector3<f64>, time: f64| {
        let stretch = (rate * time).exp();
        Vector3::new(start.x * stretch, start.y, start.z / stretch)
    };
    let starts: Vec<Vector3<f64>> = (0..3000).map(|_| odd.place(high)).collect();
    let shot = |frame: i32| {
        let time = step * f64::from(frame);
        let mut grains: Vec<GrainState> = (1..).zip(&starts).map(|(id, start)| grain(id, at(start, time))).collect();
        grains.iter_mut().for_each(|grain| {
            grain.velocity = Vector3::new(rate * grain.position.x, 0.0, -rate * grain.position.z);
        });
        Snapshot { time, ..snapshot(grains, Vector3::new(20.0, 8.0, 10.0), [false, true, false]) }
    };
    let first = shot(0);
    let grid = Grid::filling(first.bounds, Vector3::new(2.5, 8.0, 2.5));
    let at_start = tracers(&first, &Grid::filling((Vector3::zeros(), high), Vector3::new(5.0, 8.0, 5.0)));
    let mut all = at_start.clone();
    assert_eq!(all.len(), 4);
    // The mean velocity of a cell belongs to the mean position of its grains, which is only close to the cell centre.
    let before = elements(&first, Dimension::Three, &grid);
    let found = velocity_at(&before, &grid, first.periodic, Vector3::new(5.0, 4.0, 5.0)).unwrap();
    assert!((found - Vector3::new(0.4, 0.0, -0.4)).norm() < 0.02, "{found}");
    for frame in 0..40 {
        let shot = shot(frame);
        let elements = elements(&shot, Dimension::Three, &grid);
        all.iter_mut().for_each(|tracer| tracer.carry(&elements, &grid, shot.periodic, step));
        assert!(all.iter().all(|tracer| !tracer.lost));
    }
    let last = shot(40);
    for (tracer, start) in all.iter().zip(&at_start) {
        let exact = at(&start.position, 2.0);
        assert!((tracer.position - exact).norm() < 0.05, "{} for {exact}", tracer.position);
        let strain = hencky(&tracer.deformation(&last, 3).unwrap()).unwrap();
        assert!((strain - Matrix3::from_diagonal(&Vector3::new(0.16, 0.0, -0.16))).norm() < 1e-12, "{strain}");
    }
    let between =
        motion(&movers_between(&shot(0), &shot(1)), 3, &Grid::filling(first.bounds, Vector3::new(10.0, 8.0, 10.0)))[0];
    let mut exact = Matrix3::zeros();
    // The mean velocity over a time Δ, as a function of the later position x, is (x − x e^{−rΔ})/Δ.
    (exact.m11, exact.m33) = ((1.0 - (-rate * step).exp()) / step, (1.0 - (rate * step).exp()) / step);
    assert!((between.gradient.unwrap() - exact).norm() < 1e-12);
}
