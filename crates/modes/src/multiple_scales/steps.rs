//! The derivation of slow equations order by order, as lines.
//!
//! ```text
//! q = V eta,   eta_j = eta_j0 + eta_j1 + ...,   eta_j0 = B_j e^(i nu_j t) + cc,   B_j' = D1B_j + D2B_j + ...
//! order n, no e^(i nu_j t) on the right:   2 i nu_j DnB_j = r_(j,n) at nu_j
//! ```

use num_traits::Zero;

use super::expansion::{Expansion, Problem, Waves, is_first};
use super::modal::ModalForm;
use super::slow_equations::PolarNames;
use crate::derivation::DerivationLine;
use crate::exact::rational::ratio;
use crate::exact::{ComplexPolynomial, Polynomial};
use crate::expr::{Expr, ExprError, Function};
use crate::symbol::{Symbol, fresh, fresh_stem};

/// The lines of a derivation.
///
/// # Errors
/// A step of algebra that fails.
pub(super) fn derivation(
    coordinates: &[Symbol],
    problem: &Problem,
    expansion: &Expansion,
    form: &ModalForm,
    polar: &PolarNames,
    round: &dyn Fn(&Polynomial) -> Polynomial,
) -> Result<Vec<DerivationLine>, ExprError> {
    let taken = &form.names.taken;
    let (unit, modal) = (fresh("i", taken), fresh_stem("eta", taken));
    let i = Expr::from(unit);
    let t = Expr::symbol("t");
    let complex = |value: &ComplexPolynomial| {
        Expr::from(&round(&value.real)) + &i * &Expr::from(&round(&value.imaginary))
    };
    let own = |mode: usize| Expr::symbol(&format!("{modal}{}", mode + 1));
    let of_order = |mode: usize, order: usize| Symbol::new(&format!("{modal}{}_{order}", mode + 1));
    let rate = |mode: usize, order: usize| {
        Symbol::new(&format!("D{order}{}", polar.complex[mode][0].written()))
    };
    let exponential = |of: Expr| Expr::function(Function::Exp, vec![of]);
    let wave = |frequency: &Expr| exponential(&i * frequency * &t);
    // The first halves of the waves: the others are their conjugates, and a mean is a half of itself.
    let halves = |waves: &Waves| -> Result<Expr, ExprError> {
        let mut sum = Vec::new();
        for (vector, value) in waves.iter().filter(|(vector, _)| is_first(vector)) {
            let still = vector.iter().all(|times| *times == 0);
            let half = Polynomial::constant(ratio(1, if still { 2 } else { 1 }));
            let frequency = Expr::from(&round(&problem.frequency(vector)));
            sum.push(complex(&value.times(&half)) * wave(&frequency)?);
        }
        Ok(Expr::sum(sum))
    };
    let modes = 0..polar.complex.len();
    let mut lines = Vec::new();
    for (name, row) in coordinates.iter().zip(&form.shapes) {
        let parts = modes.clone().map(|mode| Expr::from(&round(&row[mode])) * own(mode));
        lines.push(DerivationLine::equation(Expr::from(*name), Expr::sum(parts)));
    }
    let listed = |order: usize, of: &dyn Fn(usize, usize) -> Symbol| {
        modes.clone().map(|mode| of(mode, order).to_string()).collect::<Vec<_>>().join(", ")
    };
    lines.push(DerivationLine::words(format!(
        "each mode is the sum of its orders, {} and so on, each of which is written without its conjugate; {unit}^2 = -1",
        listed(0, &of_order)
    )));
    lines.push(DerivationLine::words(format!(
        "each {} is the sum of its rates on the slow times, {} and so on",
        modes
            .clone()
            .map(|mode| polar.complex[mode][0].derivative().to_string())
            .collect::<Vec<_>>()
            .join(", "),
        listed(1, &rate)
    )));
    for order in 0..=problem.order {
        let mut found = Vec::new();
        for mode in modes.clone() {
            let nu = Expr::from(&round(&problem.references[mode]));
            let known = &expansion.rates[order][mode];
            if order > 0 && !(known.real.is_zero() && known.imaginary.is_zero()) {
                let name = Expr::from(rate(mode, order));
                let factor = Polynomial::constant(ratio(2, 1)).product(&problem.references[mode]);
                let resonant = known.times_i().times(&factor);
                found.push(
                    DerivationLine::equation(
                        Expr::from(2) * &i * &nu * &name,
                        complex(&resonant).expand()?,
                    )
                    .because(format!("no {} on the right", wave(&nu)?)),
                );
                found.push(
                    DerivationLine::equation(name, complex(known).expand()?).because("fixes"),
                );
            }
            let waves = expansion.displacement[mode].get(order);
            let motion = halves(waves.unwrap_or(&Waves::new()))?;
            if !motion.is_zero() {
                found.push(DerivationLine::equation(of_order(mode, order), motion));
            }
        }
        if !found.is_empty() {
            lines.push(DerivationLine::words(format!("order {order}")));
            lines.append(&mut found);
        }
    }
    for mode in modes {
        let [b, _] = polar.complex[mode];
        let (a, phi) = (Expr::from(polar.amplitudes[mode]), Expr::from(polar.phases[mode]));
        lines.push(
            DerivationLine::equation(b, a * Expr::number(ratio(1, 2)) * exponential(&i * &phi)?)
                .because("in amplitude and phase"),
        );
    }
    Ok(lines)
}
