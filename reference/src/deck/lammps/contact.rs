//! Contact laws in the styles of LAMMPS: `gran/hooke/history` and `gran/hertz/history`. Other laws use `granular` if
//! its formulas equal those of the scene.

use grainbench_scene::contact_law::ContactLaw;
use grainbench_scene::scene::Scene;

use crate::deck::dashpots::{Dashpots, Side};
use crate::deck::outline::{grain_materials, hertz};

/// Returns the commands for the contact law between grains. A deck for LAMMPS has one law for all pairs of grains.
pub(crate) fn between_grains(scene: &Scene) -> Result<String, String> {
    let materials = grain_materials(scene);
    let mut found: Option<String> = None;
    for &a in &materials {
        for &b in materials.iter().filter(|&&b| b >= a) {
            let Some(law) = scene.law(a, b) else { continue };
            // A single grain has no contacts with grains, so its mass does not matter here.
            let lines = if scene.grains.len() == 1 {
                pair_style(&history(scene, law, a, Side::Wall)?)
            } else {
                pair(scene, law, a, b)?
            };
            same(&mut found, lines, "a deck for LAMMPS has one law for all pairs of grains")?;
        }
    }
    // Without a law, no two grains can come into contact.
    Ok(found.unwrap_or_else(|| pair_style("hooke/history 1.0 0.0 0.0 0.0 0.0 0")))
}

fn pair_style(law: &str) -> String {
    format!("pair_style gran/{law}\npair_coeff * *")
}

fn pair(scene: &Scene, law: &ContactLaw, a: u16, b: u16) -> Result<String, String> {
    const ARM: &str = "only `granular` supports, whose lever arm between grains is R - overlap/2 instead of R";
    if law.rolling_friction != 0.0 {
        return Err(format!("it has rolling resistance between grains, which {ARM}"));
    }
    if !(law.is_hertz() && law.damping_ratio != 0.0) {
        return Ok(pair_style(&history(scene, law, a, Side::Grains(b))?));
    }
    if law.has_friction() {
        return Err(format!("it has friction and `restitution` at Hertz contacts between grains, which {ARM}"));
    }
    Ok(format!("pair_style granular\npair_coeff * * {}", tsuji(law)?))
}

/// Returns style and parameters of the contacts of a wall with all grains, or `None` if there is no law for such
/// contacts.
pub(crate) fn at_wall(scene: &Scene, material: u16, name: &str) -> Result<Option<String>, String> {
    let mut found: Option<String> = None;
    for grains in grain_materials(scene) {
        let Some(law) = scene.law(grains, material) else { continue };
        let style = if law.rolling_friction != 0.0 {
            format!("granular {}", rolling(scene, law, grains)?)
        } else if law.is_hertz() && law.damping_ratio != 0.0 {
            format!("granular {}", tsuji(law)?)
        } else {
            history(scene, law, grains, Side::Wall)?
        };
        same(&mut found, style, &format!("wall/gran has one law for all grains at the wall `{name}`"))?;
    }
    Ok(found)
}

/// Stores a law in `found`. Returns an error if a different law is already stored.
fn same(found: &mut Option<String>, law: String, reason: &str) -> Result<(), String> {
    match found {
        Some(before) if *before != law => Err(format!("{reason}, and the scene has several")),
        _ => {
            *found = Some(law);
            Ok(())
        }
    }
}

/// Returns `hooke/history` or `hertz/history` with the parameters `K_n K_t γ_n γ_t μ 1`.
///
/// Hertz contacts have F_n = √(R_eff δ) K_n δ and F_t = √(R_eff δ) K_t s, with overlap δ and tangential displacement s.
/// Hence K_n = (4/3)E* and K_t = 8G*. Hertz contacts have no dashpots here.
fn history(scene: &Scene, law: &ContactLaw, material: u16, side: Side) -> Result<String, String> {
    let friction = law.friction;
    if law.is_hertz() {
        let (normal, tangential) = hertz(law);
        return Ok(format!("hertz/history {normal:?} {tangential:?} 0.0 0.0 {friction:?} 1"));
    }
    let Dashpots { normal, tangential } = Dashpots::from_law(scene, law, material, side)?;
    let (k_n, k_t) = (law.normal_stiffness(), law.tangential_stiffness());
    Ok(format!("hooke/history {k_n:?} {k_t:?} {normal:?} {tangential:?} {friction:?} 1"))
}

/// Returns parameters of `granular` with Tsuji's dashpot c = α √(k_n a m_eff), with k_n = (4/3)E* and a = √(R_eff δ).
///
/// With α = √5 ζ this dashpot equals the dashpot 2√(5/6) ζ √(S m_eff) of the scene, with S = 2E*a.
fn tsuji(law: &ContactLaw) -> Result<String, String> {
    let alpha = 5.0_f64.sqrt() * law.damping_ratio;
    let coefficient = coefficient_for(alpha).ok_or_else(|| {
        let ratio = law.damping_ratio;
        format!(
            "`restitution` requires a damping ratio of {ratio:.4}, but the largest ratio of `damping tsuji` is \
                 0.5692"
        )
    })?;
    let (normal, tangential) = hertz(law);
    let friction = law.friction;
    Ok(format!("hertz {normal:?} {coefficient:?} tangential mindlin {tangential:?} 0.0 {friction:?} damping tsuji"))
}

/// Returns the coefficient of restitution for which the polynomial of `damping tsuji` equals α, or `None` if there is
/// none.
///
/// For a coefficient of restitution from 0.1 to 0.7, the polynomial is √5 ζ/√2 within 0.2 %. The effective mass requires
/// α = √5 ζ, so the coefficient of the scene would give too weak a dashpot: 0.616 instead of 0.5. The polynomial is
/// therefore inverted. With the returned coefficient, the dashpot equals the dashpot of the scene up to rounding.
///
/// Newer source code of LAMMPS (commit 07b704c) multiplies the polynomial by √2. This function is for releases without
/// this factor.
fn coefficient_for(alpha: f64) -> Option<f64> {
    const FIT: [f64; 7] = [1.2728, -4.2783, 11.087, -22.348, 27.467, -18.022, 4.8218];
    let fitted = |coefficient: f64| FIT.iter().rev().fold(0.0, |sum, factor| sum * coefficient + factor);
    let (mut low, mut high) = (0.0_f64, 1.0_f64);
    if alpha > fitted(low) || alpha < fitted(high) {
        return None;
    }
    // The polynomial decreases between 0 and 1. Bisection ends when no number lies between the bounds.
    while (low + high) / 2.0 > low && (low + high) / 2.0 < high {
        let middle = (low + high) / 2.0;
        if fitted(middle) > alpha { low = middle } else { high = middle }
    }
    Some(low)
}

/// Returns parameters of `granular hooke` with `rolling sds`. A spring of stiffness k = 2.25 k_n μ_r² acts against the
/// rolling displacement R_eff θ (m). The force of the spring is at most μ_r F_n.
fn rolling(scene: &Scene, law: &ContactLaw, material: u16) -> Result<String, String> {
    if law.rolling_damping != 0.0 {
        return Err(
            "the dashpot of the rolling spring acts only below the limit of the spring, but `rolling sds` limits the \
                    sum of spring and dashpot (`rolling_damping`)"
                .to_owned(),
        );
    }
    let Dashpots { normal, tangential } = Dashpots::from_law(scene, law, material, Side::Wall)?;
    if normal == 0.0 && tangential != 0.0 {
        return Err(
            "in `granular` the tangential dashpot is a multiple of the normal dashpot, which is zero here".to_owned()
        );
    }
    let ratio = if normal == 0.0 { 0.0 } else { tangential / normal };
    let (k_n, k_t, friction) = (law.normal_stiffness(), law.tangential_stiffness(), law.friction);
    let stiffness = 2.25 * k_n * law.rolling_friction * law.rolling_friction;
    Ok(format!(
        "hooke {k_n:?} {normal:?} tangential linear_history {k_t:?} {ratio:?} {friction:?} rolling sds {stiffness:?} 0.0 {:?} \
         damping mass_velocity",
        law.rolling_friction
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The polynomial below has the coefficients of LAMMPS. The dashpots of LAMMPS and of the scene are equal because
    /// 2√(5/6) ζ √(2E*a m) = √5 ζ √((4/3)E*a m).
    #[test]
    fn the_polynomial_is_inverted() {
        for alpha in [0.001, 0.014, 0.48, 1.27] {
            let e = coefficient_for(alpha).unwrap_or(f64::NAN);
            let fitted = 1.2728 - 4.2783 * e + 11.087 * e.powi(2) - 22.348 * e.powi(3) + 27.467 * e.powi(4)
                - 18.022 * e.powi(5)
                + 4.8218 * e.powi(6);
            assert!((fitted - alpha).abs() < 1e-14, "{alpha}: {fitted}");
        }
        assert_eq!((coefficient_for(1.28), coefficient_for(0.0)), (None, None));
    }
}
