//! Tests that the friction of a block sliding on a moving wall does not depend on the frame of reference.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod support;

use support::{column, run};

/// Returns the change of velocity (m/s) of a block that slides at 1 m/s relative to a wall. The wall has the tangential
/// velocity `wall` (m/s).
fn braked(solver: &str, wall: f64) -> f64 {
    let text = format!(
        "dimension = 2\nduration = 0.1\ngravity = [0.0, -9.8]\nsettle = {{ duration = 0.3, damping = 60.0 }}\n\
         reference_length = 0.5\n\
         materials.m = {{ density = 3000.0, bulk_modulus = 1.0e7, shear_modulus = 2.5e6 }}\n\
         contacts.m = {{ between = ['m', 'm'], law = 'coulomb', friction = 0.5 }}\n\
         [bodies.b]\nmaterial = 'm'\nbox = {{ low = [0.0, 0.0], high = [1.0, 0.5] }}\nvelocity = [{:?}, 0.0]\n\
         [walls.w]\nmaterial = 'm'\nplane = {{ point = [0.0, 0.0], normal = [0.0, 1.0] }}\n\
         motion = [{{ velocity = [{wall:?}, 0.0] }}]\n[output]\nevery = 0.1\n[probes]\nb.body = 'b'\n",
        wall + 1.0
    );
    let record = run(solver, &text, 4.0, 2);
    let velocity = column(&record, "b.vx");
    velocity[velocity.len() - 1] - velocity[0]
}

/// Coulomb friction changes the velocity by μ g t = .49 m/s in .1 s in any frame. With a wall at −2 m/s the block moves
/// at −1 m/s. If the wall were treated as at rest, friction would have the opposite sign. The block crosses cells in
/// only one of the frames, which causes a difference of at most a tenth.
#[test]
fn a_block_is_braked_alike_in_any_frame() {
    for solver in ["mpm", "mpm:2000", "mpm:2001", "mpm:gap"] {
        let (at_rest, moving) = (braked(solver, 0.0), braked(solver, -2.0));
        println!("{solver}: {at_rest} and {moving}");
        assert!(moving < 0.0 && (moving - at_rest).abs() < 0.1 * 0.49, "{solver}: {at_rest} and {moving}");
    }
}
