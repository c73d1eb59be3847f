//! How large a step any packing of equal grains bears.

use grainbench_scene::scene::{ContactLaw, Dimension, Scene};

/// A fraction of the critical step `2√(m/k_n)` at which no packing of equal grains is unstable.
///
/// Bound on the largest frequency of a grain with `z` contacts between neighbours that move against it:
/// ω² ≤ z (k_n/m) (1 + κ(1 + mR²/I)), κ = k_s/k_n, hence f = 2/(ω · 2√(m/k_n)) = 1/√(z(1 + κ(1 + mR²/I))), with z = 6 for
/// discs and 12 for spheres. For the square lattice (z = 4) it is exact at κ = 0 and κ = 1.
#[must_use]
pub fn stable_fraction(scene: &Scene) -> f64 {
    let contacts = match scene.dimension {
        Dimension::Two => 6.0,
        Dimension::Three => 12.0,
    };
    let ratio = |law: &ContactLaw| {
        let (normal, tangential) = law.stiffness(1.0, 1.0);
        if law.has_friction() { tangential / normal } else { 0.0 }
    };
    let worst = scene.laws.iter().flatten().map(ratio).fold(0.0, f64::max);
    1.0 / (contacts * (1.0 + worst * (1.0 + 1.0 / scene.grain_shape.inertia_factor()))).sqrt()
}
