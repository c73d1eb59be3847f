//! Young's modulus and Poisson's ratio of each atom type. Together they give the effective moduli of all pairs.

use grainbench_scene::contact_law::ContactLaw;

/// Young's modulus of a rigid atom type (Pa), far above that of any real material.
const RIGID: f64 = 1e40;
/// Relative error of a compliance below which the error counts as rounding.
const ROUNDING: f64 = 1e-12;

/// Contributions of one atom type to the compliances of its pairs (1/Pa). For the normal modulus, 1/E* = a₁ + a₂ with a
/// = (1 − ν²)/E. For the shear modulus, 1/G* = b₁ + b₂ with b = 2(2 − ν)(1 + ν)/E.
#[derive(Clone, Copy)]
struct Shares {
    normal: f64,
    tangential: f64,
}

impl Shares {
    fn of_pair(law: &ContactLaw) -> Self {
        Self { normal: 1.0 / law.effective_modulus(), tangential: 1.0 / law.effective_shear_modulus() }
    }

    /// Returns Young's modulus E (Pa) and Poisson's ratio ν, which follows from b/a = 2(2 − ν)/(1 − ν). Returns `None`
    /// if ν is not between 0 and 0.5.
    fn moduli(self) -> Option<(f64, f64)> {
        let quotient = self.tangential / self.normal;
        let poisson = (quotient - 4.0) / (quotient - 2.0);
        let within = (-ROUNDING..=0.5 + ROUNDING).contains(&poisson);
        let poisson = poisson.clamp(0.0, 0.5);
        within.then(|| ((1.0 - poisson * poisson) / self.normal, poisson))
    }
}

/// Returns Young's modulus (Pa) and Poisson's ratio of every atom type from the laws of all pairs. `laws` is a table
/// with `types` entries per row. A type without partners is rigid.
///
/// If a type has a law for contacts with itself, its contribution is half of the compliance of this pair. Otherwise the
/// contribution is the compliance of a pair minus the contribution of the partner (0 if not known yet), minimized over
/// all partners.
pub(crate) fn moduli(laws: &[Option<ContactLaw>], types: usize) -> Result<(Vec<f64>, Vec<f64>), String> {
    let pair = |a: usize, b: usize| laws[a * types + b].as_ref().map(Shares::of_pair);
    let mut shares: Vec<Option<Shares>> = (0..types)
        .map(|a| pair(a, a).map(|own| Shares { normal: 0.5 * own.normal, tangential: 0.5 * own.tangential }))
        .collect();
    for a in 0..types {
        if shares[a].is_some() {
            continue;
        }
        let partners = || (0..types).filter_map(|b| Some((pair(a, b)?, shares[b])));
        let least = |pick: fn(&Shares) -> f64| {
            let left = partners().map(|(both, other)| pick(&both) - other.as_ref().map_or(0.0, pick));
            left.fold(f64::INFINITY, f64::min)
        };
        let share = Shares {
            normal: least(|compliance| compliance.normal),
            tangential: least(|compliance| compliance.tangential),
        };
        shares[a] = share.normal.is_finite().then_some(share);
    }
    let (mut young, mut poisson) = (Vec::new(), Vec::new());
    for a in 0..types {
        let whole = (0..types).filter_map(|b| pair(a, b)).map(|both| both.normal).fold(0.0, f64::max);
        let share = shares[a].filter(|share| share.normal.abs() > ROUNDING * whole);
        let found = share.map_or(Some((RIGID, 0.25)), Shares::moduli);
        let (modulus, ratio) = found.ok_or_else(|| not_of_materials("not those of any material with 0 ≤ ν ≤ 1/2"))?;
        if modulus < 0.0 {
            return Err(not_of_materials("not those of any material"));
        }
        for b in (0..types).filter(|&b| b <= a) {
            let (Some(both), Some(one), Some(other)) = (pair(a, b), shares[a], shares[b]) else { continue };
            if (one.normal + other.normal - both.normal).abs() > ROUNDING * both.normal
                || (one.tangential + other.tangential - both.tangential).abs() > ROUNDING * both.tangential
            {
                return Err(not_of_materials("not combinations of the moduli of two materials"));
            }
        }
        young.push(modulus);
        poisson.push(ratio);
    }
    Ok((young, poisson))
}

fn not_of_materials(how: &str) -> String {
    format!("`hertz` needs moduli of materials, but the moduli of the pairs in the scene are {how}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use grainbench_scene::contact_law::Springs;

    /// Returns the contact law of two materials with given E and ν. Without a second material, the partner is rigid.
    fn law(first: (f64, f64), second: Option<(f64, f64)>) -> Option<ContactLaw> {
        let compliances =
            |(young, ratio): (f64, f64)| ((1.0 - ratio * ratio) / young, 2.0 * (2.0 - ratio) * (1.0 + ratio) / young);
        let ((a, b), (c, d)) = (compliances(first), second.map_or((0.0, 0.0), compliances));
        let springs = Springs::Hertz { effective_modulus: 1.0 / (a + c), effective_shear_modulus: 1.0 / (b + d) };
        Some(ContactLaw { springs, ..Default::default() })
    }

    #[test]
    fn materials_are_found_again() {
        let (glass, steel) = ((48e9, 0.2), (210e9, 0.3));
        let laws = [law(glass, Some(glass)), law(glass, Some(steel)), law(steel, Some(glass)), None];
        let (young, poisson) = moduli(&laws, 2).unwrap();
        for (found, expected) in young.iter().chain(&poisson).zip([48e9, 210e9, 0.2, 0.3]) {
            assert!((found - expected).abs() < 1e-12 * expected, "{found} {expected}");
        }
    }

    #[test]
    fn a_partner_of_none_is_rigid_and_others_are_not() {
        let glass = (48e9, 0.2);
        let (young, poisson) = moduli(&[None, law(glass, None), law(glass, None), None], 2).unwrap();
        assert!((young[0] - 48e9).abs() < 1.0 && (poisson[0] - 0.2).abs() < 1e-12 && young[1] == RIGID);
        let three = [law(glass, Some(glass)), law((1e9, 0.2), None), law((1e9, 0.2), None), law(glass, Some(glass))];
        assert!(moduli(&three, 2).is_err());
    }
}
