//! Tests that results are equal on all processors and for any number of threads.

use crate::options::{Basis, Setting, StressUpdate, Transfer};
use crate::trial::prepared;
use grainbench_lanes::{Processor, Team};
use grainbench_solver::drive::Stepper;
use grainbench_solver::space::{Plane, Solid, Space};

/// Returns the state of the points, as text, after some steps of a round body. The body spins and crosses the faces of a
/// periodic domain.
fn state<S: Space>(processor: Processor, threads: usize, setting: Setting) -> String {
    let (dimension, axes, spin) = if S::DIMENSION == 2 { (2, 2, "0.3") } else { (3, 3, "[0.3, 0.1, -0.2]") };
    let vector = |value: &str| format!("[{}]", vec![value; axes].join(", "));
    let text = format!(
        "dimension = {dimension}\nduration = 0.4\n\
         domain = {{ low = {}, high = {}, periodic = [{}] }}\n\
         materials.m = {{ density = 1.0, bulk_modulus = 10.0, shear_modulus = 6.0 }}\n\
         grains.g = {{ material = 'm', radius = 1.0, position = {}, velocity = {}, spin = {spin} }}\n",
        vector("-1.5"),
        vector("1.5"),
        vec!["true"; axes].join(", "),
        vector("0.1"),
        vector("0.7"),
    );
    let (mut simulation, steps) = prepared::<S>(setting, &text, 3.0, 2);
    simulation.scheme.processor = processor;
    simulation.state.set_team(Team::new(threads));
    simulation.begin().expect("it starts");
    simulation.advance(steps).expect("it holds together");
    format!("{:?}", simulation.state.points)
}

#[test]
fn runs_leave_the_same_bits_on_all_processors_and_threads() {
    let updates = [StressUpdate::First, StressUpdate::Last, StressUpdate::ModifiedLast];
    for (basis, stress_update) in [Basis::Linear, Basis::Quadratic, Basis::Gimp].into_iter().zip(updates) {
        for transfer in [Transfer::Flip { pic: 0.1 }, Transfer::Apic, Transfer::Spin] {
            for setting in [
                Setting { basis, transfer, ..Setting::BEST },
                Setting { basis, transfer, stress_update, ..Setting::BEST },
            ] {
                let flat = state::<Plane>(Processor::best(), 1, setting);
                let full = state::<Solid>(Processor::best(), 1, setting);
                for (processor, threads) in [(Processor::Portable, 1), (Processor::best(), 2), (Processor::best(), 5)] {
                    let on = format!("{}, {threads} threads: {:?}", processor.name(), setting.words());
                    assert!(state::<Plane>(processor, threads, setting) == flat, "{on} in the plane");
                    assert!(state::<Solid>(processor, threads, setting) == full, "{on} in space");
                }
            }
        }
    }
}
