//! Laws within laws: a wider law fits no worse than a narrower one that it contains.
//!
//! ```text
//! linear spring:      beta = 0,  b = 0,  or k = w^2, n = 1
//! viscous damping:    alpha = 0,  or r = 2 zeta w, p = 1          dry friction: zeta = 0          quadratic damping: r = q, p = 2
//! ```
//!
//! A fit of the wider law with a larger sum of squares ended in another minimum, and begins anew from the narrower law.

use crate::fit::laws::{Law, Loss, Spring};
use crate::fit::motion::MotionSolver;
use crate::fit::sample_fit::{SampleFit, Samples, fit_samples};

/// Whether the motions of a law are among those of a wider one.
fn is_within(narrow: (Spring, Loss), wide: (Spring, Loss)) -> bool {
    let spring = narrow.0 == wide.0
        || narrow.0 == Spring::Linear
            && matches!(wide.0, Spring::Duffing | Spring::Quadratic | Spring::Power);
    let loss = narrow.1 == wide.1
        || match narrow.1 {
            Loss::None => true,
            Loss::Viscous => matches!(wide.1, Loss::ViscousAndCoulomb | Loss::Power),
            Loss::Coulomb => wide.1 == Loss::ViscousAndCoulomb,
            Loss::Quadratic => wide.1 == Loss::Power,
            Loss::Power | Loss::ViscousAndCoulomb => false,
        };
    narrow != wide && spring && loss
}

/// The parameters of a wider law at which it is the narrower one with these. Returns `None` if it does not contain it.
fn within(narrow: &Law, parameters: &[f64], wide: &Law) -> Option<Vec<f64>> {
    if !is_within(narrow.parts?, wide.parts?) {
        return None;
    }
    let own = |name: &str| narrow.parameter(name).and_then(|place| parameters.get(place)).copied();
    let viscous = own("c").or_else(|| Some(2.0 * own("zeta")? * own("w")?));
    let dry = own("d").or_else(|| Some(own("alpha")? * own("w")?.powi(2)));
    let quadratic = own("q");
    let value = |name: &str| match name {
        "k" => own("k").or_else(|| Some(own("w")?.powi(2))),
        "n" => Some(own("n").unwrap_or(1.0)),
        "c" => Some(viscous.unwrap_or(0.0)),
        "d" => Some(dry.unwrap_or(0.0)),
        "r" => own("r").or(quadratic).or(viscous).or(Some(0.0)),
        "p" => Some(own("p").unwrap_or(if quadratic.is_some() { 2.0 } else { 1.0 })),
        // The frequency is needed; all others vanish where the narrower law has none of them.
        "w" => own("w"),
        name => Some(own(name).unwrap_or(0.0)),
    };
    wide.parameters.iter().map(|name| value(name.name())).collect()
}

/// Fits wider laws again from narrower ones that fit better.
pub fn refit_wider(fits: &mut [SampleFit], samples: &[&Samples]) {
    fits.sort_by_key(|fit| fit.values.len());
    for place in 0..fits.len() {
        let (before, rest) = fits.split_at_mut(place);
        let Some(wide) = rest.first_mut() else { continue };
        let better = before.iter().filter(|narrow| narrow.square() < wide.square());
        let starts = better.filter_map(|narrow| {
            let (parameters, local) = narrow.values.split_at(narrow.law.parameters.len());
            let own = within(&narrow.law, parameters, &wide.law)?;
            Some((narrow.square(), [own.as_slice(), local].concat()))
        });
        // The best of the narrower laws is below all others.
        let Some((_, start)) = starts.min_by(|one, other| one.0.total_cmp(&other.0)) else {
            continue;
        };
        let Ok(solver) = MotionSolver::new(&wide.law) else { continue };
        let again = fit_samples(&wide.law, &solver, samples, &start);
        if let Some(again) = again.filter(|again| again.square() < wide.square()) {
            *wide = again;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_law_at_these_parameters_is_the_narrower_one() {
        let law = |spring, loss| Law::from_parts(spring, loss).unwrap();
        let narrow = law(Spring::Linear, Loss::Viscous);
        let parameters = [2.0, 0.01];
        for (spring, loss) in [
            (Spring::Duffing, Loss::Viscous),
            (Spring::Quadratic, Loss::ViscousAndCoulomb),
            (Spring::Linear, Loss::Power),
            (Spring::Power, Loss::ViscousAndCoulomb),
        ] {
            let wide = law(spring, loss);
            let own = within(&narrow, &parameters, &wide).unwrap();
            let at = |law: &Law, parameters: &[f64]| {
                let solver = MotionSolver::new(law).unwrap();
                let motion =
                    solver.sample(parameters, [1.0, 0.0], &[0.0, 3.0], 1.5, Default::default());
                motion.unwrap().columns[0][1]
            };
            let [one, other] = [at(&narrow, &parameters), at(&wide, &own)];
            // Powers with unknown exponents are rounded near zero.
            assert!((one - other).abs() < 1e-3, "{} {one} {other}", wide.name);
        }
        assert!(within(&law(Spring::Duffing, Loss::Viscous), &[2.0, 1.0, 0.01], &narrow).is_none());
    }
}
