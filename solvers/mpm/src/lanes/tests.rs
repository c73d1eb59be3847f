use super::*;
use crate::options::{Basis, Setting, Transfer};
use crate::trial::prepared;
use grainbench_scene::space::{Plane, Solid, Space};

/// Every operation on awkward numbers, as bits.
struct Trial<'a>(&'a mut Vec<u64>);

impl Kernel for Trial<'_> {
    fn run<L: Lanes>(self, lanes: L) {
        let numbers = [1.0 / 3.0, -0.0, 1e300, -7.1e-310, f64::INFINITY, 2.5, -1.0 / 7.0, 1e16];
        for (at, &a) in numbers.iter().enumerate() {
            for &b in &numbers {
                let one = Four::new(lanes, [a, b, 0.1 * a, 3.0 * b]);
                let two = Four::new(lanes, [b, a + 0.1, b, numbers[(at + 3) % 8]]);
                let sums = Four::sums([one, two, one * two, one - two]);
                let all = [one + two, one - two, one * two, one / two, -one, one * 0.3, one + 0.7, one - 1.1];
                let picked = one.pick_below(two, one * 2.0, two);
                let values = all.iter().chain([&picked]).flat_map(|four| four.values()).chain(sums);
                // Which bits a result that is no number has is not said.
                self.0.extend(values.map(|value| if value.is_nan() { 0 } else { value.to_bits() }));
            }
        }
    }
}

#[test]
fn every_operation_leaves_the_same_bits_on_all_processors() {
    let [mut portable, mut best] = [Vec::new(), Vec::new()];
    Processor::Portable.run(Trial(&mut portable));
    Processor::new().run(Trial(&mut best));
    assert!(portable.len() == 64 * 40 && portable == best);
}

/// State of the points, as text, after some steps of a round body that spins, flies across the faces of a periodic
/// domain and shares nodes with its image.
fn state<S: Space>(processor: Processor, basis: Basis, transfer: Transfer) -> String {
    let (dimension, axes, spin) = if S::DIMENSION == 2 { (2, 2, "0.3") } else { (3, 3, "[0.3, 0.1, -0.2]") };
    let vector = |value: &str| format!("[{}]", vec![value; axes].join(", "));
    let text = format!(
        "dimension = {dimension}\nduration = 0.4\n\
         domain = {{ low = {}, high = {}, periodic = [{}] }}\n\
         materials.m = {{ density = 1.0, bulk_modulus = 10.0, shear_modulus = 6.0 }}\n\
         grains.g = {{ material = 'm', radius = 1.0, position = {}, velocity = {}, spin = {spin} }}\n",
        vector("-1.1"),
        vector("1.1"),
        vec!["true"; axes].join(", "),
        vector("0.1"),
        vector("0.7"),
    );
    let setting = Setting { basis, transfer, ..Setting::BEST };
    let (mut simulation, steps) = prepared::<S>(setting, &text, 3.0, 2);
    simulation.scheme.processor = processor;
    simulation.begin().expect("it starts");
    simulation.advance(steps).expect("it holds together");
    format!("{:?}", simulation.state.points)
}

/// Loops over points are compiled once for every processor; what they compute is the same.
#[test]
fn runs_leave_the_same_bits_on_all_processors() {
    for basis in [Basis::Linear, Basis::Quadratic, Basis::Gimp] {
        for transfer in [Transfer::Flip { pic: 0.1 }, Transfer::Apic, Transfer::Spin] {
            let flat = |processor| state::<Plane>(processor, basis, transfer);
            assert!(flat(Processor::Portable) == flat(Processor::new()), "{basis}, {transfer} in the plane");
            let full = |processor| state::<Solid>(processor, basis, transfer);
            assert!(full(Processor::Portable) == full(Processor::new()), "{basis}, {transfer} in space");
        }
    }
}
