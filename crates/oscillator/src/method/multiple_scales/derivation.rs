//! The derivation of an answer by multiple scales, order by order.

use num_traits::Zero as _;

use super::driven::DrivenProblem;
use super::names::ExpansionSymbols;
use super::scaling::Scaling;
use super::slow_times::{FastPhaseSeries, MultipleScalesExpansion};
use super::slow_waves::{SlowRates, motion};
use crate::derivation::{DerivationFormula, DerivationLine};
use crate::exact::rational::ratio;
use crate::exact::{ComplexPolynomial as Complex, POLYNOMIALS, Polynomial, Polynomials};
use crate::expr::{Expr, ExprError};
use crate::method::Refusal;
use crate::series::FourierSeries;
use crate::solution::Response;
use crate::symbol::{Symbol, fresh_stem};

/// The contribution of an order to the motion, in `theta`, with `B = a/2`.
pub(super) fn motion_of(
    wave: &FastPhaseSeries,
    order: usize,
    names: &ExpansionSymbols,
) -> FourierSeries<Polynomials> {
    let length = wave.keys().copied().max().map_or(0, |m| m.max(0) as usize + 1);
    let (mut cosine, mut sine) =
        (vec![Polynomial::zero(); length], vec![Polynomial::zero(); length]);
    for (m, value) in wave.iter().filter(|entry| *entry.0 >= 0) {
        let m = *m as usize;
        let part = |part: &Polynomial, factor: i64| {
            let factor = if m == 0 { factor / 2 } else { factor };
            let scaled = names.polar(part).product(&Polynomial::constant(ratio(factor, 1)));
            scaled.times_monomial(&names.mark(order))
        };
        cosine[m] = part(&value.real, 2);
        sine[m] = part(&value.imaginary, -2);
    }
    FourierSeries::from_parts(POLYNOMIALS, cosine, sine)
}

/// The derivation of the answer; `response` is the frequency response of a driven motion.
pub(super) fn derivation(
    expansion: &MultipleScalesExpansion,
    scaling: &Scaling,
    names: &ExpansionSymbols,
    linear_frequency: &Polynomial,
    rates: &[Expr; 2],
    response: Option<&Response>,
) -> Result<Vec<DerivationLine>, ExprError> {
    let (own, conjugate, a) = (names.complex.own, names.complex.conjugate, names.amplitude);
    let i = Expr::from(names.unit);
    let [orders, times] = &names.orders;
    let complex =
        |value: &Complex| &Expr::from(&value.real) + &(&i * &Expr::from(&value.imaginary));
    let small = match scaling.marker {
        Some(marker) => marker.to_string(),
        None => a.to_string(),
    };
    let wave = format!("exp({i}*θ)");
    let turns = match response {
        None => format!("θ turns at the rate {}", Expr::from(linear_frequency)),
        Some(_) => "θ turns in step with the drive; what that forces far from resonance is added"
            .to_owned(),
    };
    let mut lines = vec![
        DerivationLine::words(format!(
            "the motion is {orders}0 + {orders}1 + {orders}2 + ..., each order with its power of {small} and a slow time of its own"
        )),
        DerivationLine::words(format!(
            "{orders}0 = {own}*{wave} + {conjugate}*exp(-{i}*θ), {conjugate} the conjugate of {own}; {turns}"
        )),
        DerivationLine::words(format!(
            "{times}1, {times}2, ... are the rates of {own} on the slow times"
        )),
    ];
    for k in 1..=scaling.order as usize {
        let (rate, resonant) = (&expansion.rates[k], &expansion.resonant[k]);
        if resonant.is_zero() && expansion.displacement[k].is_empty() {
            continue;
        }
        let left = Expr::symbol(&format!("{times}{k}"));
        let rest = Expr::from(&linear_frequency.product(&Polynomial::constant(ratio(2, 1))));
        let secular = &complex(resonant) - &(&(&i * &rest) * &left);
        lines.push(
            DerivationLine::equal([secular.expand()?.into(), Expr::zero().into()])
                .because(format!("order {k}, no {wave} on the right")),
        );
        lines.push(DerivationLine::equation(left, complex(rate).expand()?).because("fixes"));
        if response.is_none() {
            let unmarked = |polynomial: &Polynomial| scaling.unmarked(polynomial, names.marker);
            let motion = motion_of(&expansion.displacement[k], k, names);
            let motion = motion.map(POLYNOMIALS, |coefficient, _| unmarked(coefficient));
            lines.push(
                DerivationLine::equation(Symbol::new(&format!("{orders}{k}")), motion)
                    .because(format!("the motion, with {own} = {a}/2 in θ")),
            );
        }
    }
    let [amplitude_rate, phase_rate] = rates;
    let phase = names.phase;
    let polar = match response {
        None => format!("{own} is {a}/2 turned by the phase {phase} without θ"),
        Some(_) => format!("{own} is {a}/2 turned back by the phase {phase}"),
    };
    lines.push(DerivationLine::equation(a.derivative(), amplitude_rate).because(polar));
    lines.push(DerivationLine::equation(phase.derivative(), phase_rate));
    lines.extend(response.and_then(elimination));
    Ok(lines)
}

/// The relation of steady motions.
fn elimination(response: &Response) -> Option<DerivationLine> {
    let relation = DerivationFormula::from(Expr::from(response.relation.as_ref()?));
    let steady = "steady where both vanish; cos^2 + sin^2 = 1 eliminates the phase";
    Some(DerivationLine::equal([DerivationFormula::from(Expr::zero()), relation]).because(steady))
}

/// The expansion in the words of averaging: the contribution of each order to the rates and to the
/// motion.
pub(super) fn averaged_lines(
    question: &DrivenProblem,
    expansion: &MultipleScalesExpansion,
    [amplitude_rate, phase_rate]: &[Expr; 2],
    response: &Response,
) -> Result<Vec<DerivationLine>, Refusal> {
    let names = &question.names;
    let [correction, rate, turn] =
        ["u", "A", "B"].map(|letter| fresh_stem(letter, &question.taken));
    let numbered = |stem: &str, order: usize| Symbol::new(&format!("{stem}{order}"));
    let leading = motion(question, expansion, |k| k == 0)?;
    let mut lines =
        vec![DerivationLine::equation(question.oscillator.coordinate, leading).because("along")];
    for k in 1..=question.scaling.order as usize {
        let [own_rate, own_turn] =
            SlowRates::of_orders(expansion, question, |order| order == k).rates(question)?;
        lines.push(
            DerivationLine::equation(numbered(&rate, k), own_rate)
                .because(format!("no resonant wave is left at order {k}")),
        );
        lines.push(DerivationLine::equation(numbered(&turn, k), own_turn));
        if k < question.scaling.order as usize {
            let rest = motion(question, expansion, |order| order == k)?;
            lines.push(
                DerivationLine::equation(numbered(&correction, k), rest)
                    .because("what that leaves over"),
            );
        }
    }
    lines.push(
        DerivationLine::equation(names.amplitude.derivative(), amplitude_rate.clone())
            .because("both together"),
    );
    lines.push(DerivationLine::equation(names.phase.derivative(), phase_rate.clone()));
    lines.extend(elimination(response));
    Ok(lines)
}
