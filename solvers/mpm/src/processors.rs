//! Loops over points are compiled once for every processor; what they compute is the same.

use crate::options::{Basis, Setting, Transfer};
use crate::trial::prepared;
use grainbench_lanes::Processor;
use grainbench_scene::space::{Plane, Solid, Space};

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

#[test]
fn runs_leave_the_same_bits_on_all_processors() {
    for basis in [Basis::Linear, Basis::Quadratic, Basis::Gimp] {
        for transfer in [Transfer::Flip { pic: 0.1 }, Transfer::Apic, Transfer::Spin] {
            let flat = |processor| state::<Plane>(processor, basis, transfer);
            assert!(flat(Processor::Portable) == flat(Processor::best()), "{basis}, {transfer} in the plane");
            let full = |processor| state::<Solid>(processor, basis, transfer);
            assert!(full(Processor::Portable) == full(Processor::best()), "{basis}, {transfer} in space");
        }
    }
}
