//! The derivation of a nonlinear normal mode order by order, as lines.
//!
//! ```text
//! x = a x_1 + a^2 x_2 + ...,  omega^2 = W_0 + a W_1 + a^2 W_2 + ...,  derivatives in theta
//! W_0 M x_n'' + K x_n = r_n + W_(n-1) M v cos theta,   W_(n-1) so that nothing drives the mode itself
//! ```
//!
//! The unknowns are those of the [`Basis`]: the coordinates, or of two coordinates in closed form the
//! modal ones, which are called u and v.

use num_traits::Zero;

use super::FreeSystem;
use super::expansion::{Basis, Expansion};
use crate::derivation::{DerivationFormula, DerivationLine, DerivativeTerm};
use crate::exact::{POLYNOMIALS, Polynomial, Polynomials};
use crate::expr::Expr;
use crate::series::FourierSeries;
use crate::symbol::letters::FREQUENCY;
use crate::symbol::{Symbol, fresh, fresh_stem, phase_beside};

/// The names of what a derivation introduces.
struct StepNames {
    /// The unknowns without the number of their order.
    unknowns: Vec<String>,
    /// The corrections of omega^2.
    correction: String,
    taken: Vec<Symbol>,
}

impl StepNames {
    /// An unknown of an order.
    fn unknown(&self, index: usize, order: usize) -> Symbol {
        let stem = &self.unknowns[index];
        let between = if stem.ends_with(|last: char| last.is_ascii_digit()) { "_" } else { "" };
        fresh(&format!("{stem}{between}{order}"), &self.taken)
    }

    /// A correction of omega^2.
    fn correction(&self, order: usize) -> Symbol {
        Symbol::new(&format!("{}{order}", self.correction))
    }
}

/// The lines of a derivation; none if it was not kept.
pub(super) fn derivation(
    system: &FreeSystem,
    basis: &Basis,
    expansion: &Expansion<Polynomials>,
    amplitude: Symbol,
    taken: Vec<Symbol>,
) -> Vec<DerivationLine> {
    if expansion.steps.is_empty() {
        return vec![];
    }
    let coordinates = &system.equations.coordinates;
    let is_modal = basis.projection.iter().enumerate().any(|(row, entries)| {
        entries.iter().enumerate().any(|(column, entry)| entry.is_zero() == (row == column))
    });
    let unknowns = match is_modal {
        true => ["u", "v"].map(|stem| fresh_stem(fresh(stem, &taken).written(), &taken)).to_vec(),
        false => coordinates.iter().map(|name| name.written().to_owned()).collect(),
    };
    let names = StepNames { unknowns, correction: fresh_stem("W", &taken), taken };
    let phase = phase_beside(&names.taken);
    let mut lines = vec![DerivationLine::words(expanded(&names, amplitude, phase))];
    if is_modal {
        for (name, row) in coordinates.iter().zip(&basis.coordinates) {
            let modal = row.iter().zip(&names.unknowns);
            let sum: Expr = modal.map(|(entry, stem)| Expr::from(entry) * Expr::symbol(stem)).sum();
            lines.push(DerivationLine::equation(Expr::from(*name), sum));
        }
    }
    let square = &expansion.frequency_squared[0];
    lines.push(DerivationLine::equation(names.correction(0), Expr::from(square)));
    let wave = FourierSeries::cos(POLYNOMIALS, 1);
    let times_wave =
        |factor: Polynomial| FourierSeries::constant(POLYNOMIALS, factor).product(&wave);
    let waves = |series: FourierSeries<Polynomials>| DerivationFormula::Waves { series, phase };
    lines.push(DerivationLine::words("order 1"));
    lines.extend(basis.shape.iter().enumerate().map(|(index, entry)| {
        DerivationLine::equal([names.unknown(index, 1).into(), waves(times_wave(entry.clone()))])
    }));
    for (step, order) in expansion.steps.iter().zip(2..) {
        let correction = &expansion.frequency_squared[order - 1];
        let drives = |series: &FourierSeries<Polynomials>| !series.cosine(1).is_zero();
        let is_secular = !correction.is_zero() || step.right_sides.iter().any(drives);
        let is_empty = |series: &FourierSeries<Polynomials>| series.is_zero();
        if step.right_sides.iter().all(is_empty) && step.unknowns.iter().all(is_empty) {
            continue;
        }
        lines.push(DerivationLine::words(format!("order {order}")));
        for (row, right) in step.right_sides.iter().enumerate() {
            let inertia = basis.mass[row].iter().zip(&basis.shape);
            let along = inertia
                .map(|(entry, shape)| entry.product(shape))
                .fold(Polynomial::zero(), |sum, product| sum + product);
            let own = along.product(&Polynomial::symbol(names.correction(order - 1)));
            let right = if is_secular { right.sum(&times_wave(own)) } else { right.clone() };
            let left = [(&basis.mass, 2), (&basis.stiffness, 0)].map(|(matrix, derivatives)| {
                let entries = matrix[row].iter().enumerate();
                let scaled = entries.map(move |(index, entry)| {
                    let factor =
                        if derivatives == 2 { entry.product(square) } else { entry.clone() };
                    (index, factor)
                });
                let present = scaled.filter(|(_, factor)| !factor.is_zero());
                let term = |(index, factor): (usize, Polynomial)| DerivativeTerm {
                    factor: Expr::from(&factor),
                    of: names.unknown(index, order),
                    derivatives,
                };
                present.map(term).collect::<Vec<_>>()
            });
            let left = DerivationFormula::Linear(left.concat());
            lines.push(DerivationLine::equal([left, waves(right)]));
        }
        if is_secular {
            let fixed =
                DerivationLine::equation(names.correction(order - 1), Expr::from(correction));
            lines.push(fixed.because(format!("no secular cos({phase}) along the mode")));
        }
        lines.extend(step.unknowns.iter().enumerate().map(|(index, series)| {
            DerivationLine::equal([names.unknown(index, order).into(), waves(series.clone())])
        }));
    }
    lines
}

/// The expansions in words.
fn expanded(names: &StepNames, amplitude: Symbol, phase: Symbol) -> String {
    let unknowns = (0..names.unknowns.len()).map(|index| {
        let [one, two] = [1, 2].map(|order| names.unknown(index, order));
        format!("{} = {amplitude}*{one} + {amplitude}^2*{two} + ...", names.unknowns[index])
    });
    let [zero, one, two] = [0, 1, 2].map(|order| names.correction(order));
    let unknowns: Vec<String> = unknowns.collect();
    format!(
        "{}, {FREQUENCY}^2 = {zero} + {amplitude}*{one} + {amplitude}^2*{two} + ..., derivatives in {phase} = {FREQUENCY}*t",
        unknowns.join(", ")
    )
}
