//! The force of the position alone: its equilibria, at zero and elsewhere.
//!
//! In: a force and its coordinate, with or without parameters. Out: its stable equilibria, in
//! closed form where there is one (chosen with sample values for the parameters), else as numbers;
//! and their list for messages.

use std::cell::Cell;
use std::collections::BTreeMap;

use num_traits::Zero;

use super::EquilibriumPosition;
use super::inverse::inverted;
use super::search::{Zero as SignChange, polynomial_zeros, zeros};
use super::shift::{closed_forms, coefficients, exact_zero, linear_zeros, shifted_force};
use crate::conservative::force::CentredForce as AtNumbers;
use crate::conservative::passage::{Passage, passages, pushes_away};
use crate::conservative::{is_odd, potential};
use crate::exact::Rational;
use crate::exact::rational::to_f64;
use crate::exact::real_roots::sign_changing_part;
use crate::expr::{CompiledFunction, Expr, Function, Node};
use crate::oscillator::{Equilibria, FurtherEquilibria, OscillatorError};
use crate::series::taylor::taylor;
use crate::solution::note::{CrossWell, CrossWellEnd, Position};
use crate::symbol::Symbol;

/// The strength of the attraction by a force that is infinite at `x = 0`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SingularAttraction {
    /// Weak attraction: the potential is finite there, as for `sgn(x)/abs(x)^(1/3)`, and the motion
    /// passes through.
    Passed,
    /// Attraction as `1/x` by an odd force: the potential is a logarithm, and the motion the limit
    /// of those of weaker powers, which swing through.
    Inverse,
    /// Attraction as `1/x`, but with an even part.
    UnevenInverse,
    /// Attraction faster than `1/x`: the potential is minus infinity as a power of the distance,
    /// and the equation does not say how a motion would come out.
    Endless,
}

/// A force of the position alone.
pub(super) struct PositionForce<'a> {
    force: &'a Expr,
    coordinate: Symbol,
    /// The force as a function, where it has no parameters.
    value: Option<CompiledFunction>,
}

impl<'a> PositionForce<'a> {
    pub(super) fn new(force: &'a Expr, coordinate: Symbol) -> Self {
        Self { force, coordinate, value: CompiledFunction::new(force, &[coordinate]).ok() }
    }

    /// Whether the force has no symbol but the coordinate.
    pub(super) fn is_numerical(&self) -> bool {
        self.value.is_some()
    }

    /// The force at rest, for messages; as it stands where it is too long to be written out.
    pub(super) fn at_rest<E>(&self, at_zero: &Result<Expr, E>) -> String {
        let as_it_stands = || self.force.substitute(self.coordinate, &Expr::zero()).ok();
        let at_zero = at_zero.as_ref().ok().cloned().or_else(as_it_stands);
        at_zero.unwrap_or_else(|| self.force.clone()).to_string()
    }

    /// Numbers in place of the parameters to choose between closed forms: all about equal, small
    /// first; and one of them much smaller or larger than the others, as the load may be.
    fn samples(&self) -> Vec<BTreeMap<Symbol, f64>> {
        let mut samples = [0.1, 0.01, 1.0, 0.001, 10.0].map(|scale| self.sample(scale)).to_vec();
        let alike = self.sample(1.0);
        for factor in [0.03, 30.0] {
            let unlike = |name: &Symbol| {
                let mut sample = alike.clone();
                sample.entry(*name).and_modify(|value| *value *= factor);
                sample
            };
            samples.extend(alike.keys().map(unlike));
        }
        samples
    }

    /// Numbers for the parameters, all about equal to `scale`.
    fn sample(&self, scale: f64) -> BTreeMap<Symbol, f64> {
        let parameters = self.force.symbols().into_iter().filter(|name| *name != self.coordinate);
        let values = (1..).map(|k| scale * (1.0 + 0.03 * f64::from(k)));
        parameters.zip(values).collect()
    }

    /// The force as a function with these numbers for its parameters.
    fn at_numbers(&self, numbers: &BTreeMap<Symbol, f64>) -> Option<impl Fn(f64) -> f64 + use<>> {
        let names: Vec<Symbol> =
            std::iter::once(self.coordinate).chain(numbers.keys().copied()).collect();
        let function = CompiledFunction::new(self.force, &names).ok()?;
        let numbers: Vec<f64> = numbers.values().copied().collect();
        Some(move |x: f64| function.call(&[&[x], numbers.as_slice()].concat()))
    }

    /// Whether a force that has no value at zero goes to zero there, as `(1 - cos(x))/x` does.
    pub(super) fn vanishes_towards_zero(&self) -> bool {
        let origin = [(self.coordinate, Rational::zero())];
        if let Ok(parts) = taylor(self.force, &origin, 1) {
            return parts.first().is_some_and(Expr::is_zero);
        }
        let Some(value) = self.at_numbers(&self.sample(1.0)) else {
            return false;
        };
        [1.0, -1.0].into_iter().all(|side| {
            let (near, far) = (value(side * 1e-100).abs(), value(side * 1e-30).abs());
            far.is_finite() && near <= 1e-3 * far
        })
    }

    /// Classifies a force that is infinite at zero and attracts from both sides; `None` for any
    /// other force.
    pub(super) fn pull_without_bound(&self) -> Option<SingularAttraction> {
        /// Two exponents that differ by less than this are the same: over seventy decades rounding
        /// amounts to an exponent of 1e-17.
        const SAME: f64 = 1e-12;
        let value = self.at_numbers(&self.sample(1.0))?;
        // Decay of force times distance from far to near, in decades per decade: p + 1 for a power
        // p.
        let falls = |side: f64| {
            let work = |decade: i32| {
                let distance = 10.0_f64.powi(-decade);
                side * value(side * distance) * distance
            };
            let (near, far) = (work(100), work(30));
            (near > 0.0 && far.is_finite()).then(|| (far / near).log10() / 70.0)
        };
        let (right, left) = (falls(1.0)?, falls(-1.0)?);
        Some(match f64::min(right, left) {
            least if least > SAME => SingularAttraction::Passed,
            least if least < -SAME => SingularAttraction::Endless,
            _ if is_odd(self.force, self.coordinate).unwrap_or(false) => {
                SingularAttraction::Inverse
            }
            _ => SingularAttraction::UnevenInverse,
        })
    }

    /// Whether the force, zero at `x = 0`, pulls back there; it is taken to do so where that
    /// depends on a parameter.
    pub(super) fn is_stable_at_zero(&self) -> bool {
        let origin = [(self.coordinate, Rational::zero())];
        for degree in [1, 3, 5, 9, 15] {
            let Ok(parts) = taylor(self.force, &origin, degree) else {
                break;
            };
            let coefficient = |part: &Expr| part.substitute(self.coordinate, &Expr::one()).ok();
            let lowest = parts.iter().enumerate().skip(1).find_map(|(power, part)| {
                let coefficient =
                    coefficient(part).filter(|coefficient| !is_nothing(coefficient))?;
                Some((power, coefficient))
            });
            if let Some((power, coefficient)) = lowest {
                let negative =
                    coefficient.evaluate(&BTreeMap::new()).is_ok_and(|value| value < 0.0);
                return power % 2 == 1 && !negative;
            }
        }
        // Without a Taylor series, or if all its terms vanish, the first nonzero force on either
        // side decides.
        let Some(value) = &self.value else {
            return true;
        };
        let felt = |side: f64| {
            let places = (-1200..1200).map(|k| side * 10_f64.powf(f64::from(k) / 40.0));
            let mut forces = places.map(|x| value.call(&[x])).take_while(|force| force.is_finite());
            forces.find(|force| *force != 0.0).unwrap_or(0.0)
        };
        felt(1.0) > 0.0 && felt(-1.0) < 0.0
    }

    /// All changes of sign of a force without parameters.
    pub(super) fn signs(&self) -> Vec<SignChange> {
        /// Fractions grow with every division of the exact polynomials.
        const LONGEST_EXACT: usize = 32;
        let Some(function) = &self.value else {
            return vec![];
        };
        let coefficients = coefficients(self.force, self.coordinate);
        let numbers = coefficients.and_then(|coefficients| {
            let exact: Option<Vec<Rational>> =
                coefficients.iter().map(|each| each.as_number().cloned()).collect();
            // A multiple zero of rounded coefficients would be many zeros near it.
            if let Some(exact) = exact.filter(|exact| exact.len() <= LONGEST_EXACT) {
                return Some(sign_changing_part(&exact).iter().map(to_f64).collect());
            }
            let values =
                coefficients.iter().map(|coefficient| coefficient.evaluate(&BTreeMap::new()).ok());
            values.collect::<Option<Vec<f64>>>()
        });
        if let Some(numbers) = numbers {
            return polynomial_zeros(&numbers);
        }
        let centres = linear_zeros(self.force, self.coordinate);
        let centres: Vec<f64> =
            centres.iter().filter_map(|zero| zero.evaluate(&BTreeMap::new()).ok()).collect();
        zeros(&|x| function.call(&[x]), &centres)
    }

    /// The stable equilibria, the nearest first; those that a pole hides only where there are no
    /// others.
    pub(super) fn stable(&self) -> Vec<SignChange> {
        let mut found: Vec<SignChange> =
            self.signs().into_iter().filter(|found| found.stable).collect();
        if found.iter().any(|found| found.reachable) {
            found.retain(|found| found.reachable);
        }
        // Of two mirror images the positive one, though rounding may put it farther away.
        found.sort_by(|a, b| {
            let size = |found: &SignChange| found.position.abs() as f32;
            size(a).total_cmp(&size(b)).then(b.position.total_cmp(&a.position))
        });
        found
    }

    /// A number with the closed form that belongs to it, where one is known.
    pub(super) fn exact_or_rounded(&self, position: f64) -> EquilibriumPosition {
        if let Some(exact) = exact_zero(self.force, self.coordinate, position) {
            return EquilibriumPosition::Exact(exact);
        }
        let belongs = |form: &Expr| {
            let value = form.evaluate(&BTreeMap::new());
            value.is_ok_and(|value| (value - position).abs() <= 1e-15 * position.abs())
        };
        let forms = closed_forms(self.force, self.coordinate);
        let form = forms.into_iter().find(belongs);
        form.map_or(EquilibriumPosition::Rounded(position), EquilibriumPosition::Exact)
    }

    /// Candidates for the equilibria of a force with parameters, in closed form.
    fn forms(&self) -> Vec<Expr> {
        let forms = closed_forms(self.force, self.coordinate);
        match forms.is_empty() {
            true => inverted(self.force, self.coordinate),
            false => forms,
        }
    }

    /// The closed form of the stable equilibrium in the parameters, chosen where loads are small,
    /// and where no pole hides it if that can be.
    pub(super) fn stable_closed_form(&self) -> Option<EquilibriumPosition> {
        let forms = self.forms();
        let samples = self.samples();
        let nearest = |hidden_too: bool| {
            samples.iter().find_map(|sample| {
                let mut stable = self.stable_at(&forms, sample);
                stable.retain(|(position, _)| hidden_too || !self.is_hidden(*position, sample));
                stable.sort_by(|a, b| a.0.abs().total_cmp(&b.0.abs()).then(b.0.total_cmp(&a.0)));
                stable.into_iter().next()
            })
        };
        let (_, form) = nearest(false).or_else(|| nearest(true))?;
        Some(EquilibriumPosition::Exact(form))
    }

    /// Whether the force has no value somewhere between zero and a position, with these numbers for
    /// its parameters.
    fn is_hidden(&self, position: f64, sample: &BTreeMap<Symbol, f64>) -> bool {
        let Some(value) = self.at_numbers(sample) else {
            return false;
        };
        let places = linear_zeros(self.force, self.coordinate);
        let mut places = places.iter().filter_map(|place| place.evaluate(sample).ok());
        places.any(|place| {
            place / position > 0.0 && place / position < 1.0 && !value(place).is_finite()
        })
    }

    /// The forms at which the force pulls back with these numbers for its parameters, and their
    /// values.
    fn stable_at(&self, forms: &[Expr], sample: &BTreeMap<Symbol, f64>) -> Vec<(f64, Expr)> {
        let Some(value) = self.at_numbers(sample) else {
            return vec![];
        };
        let stable = |form: &Expr| {
            let position = form.evaluate(sample).ok()?;
            let step = 1e-6 * position.abs();
            let (left, right) = (value(position - step), value(position + step));
            (left < 0.0 && right > 0.0 && position != 0.0).then(|| (position, form.clone()))
        };
        forms.iter().filter_map(stable).collect()
    }

    /// The stable equilibrium in closed form that equals `asked` for all sample values of the
    /// parameters, however `asked` is written.
    pub(super) fn stable_form_of(&self, asked: &Expr) -> Option<Expr> {
        if self.value.is_some() {
            return None;
        }
        let forms = self.forms();
        let samples = self.samples();
        let same = |form: &&Expr| {
            let pairs = samples.iter().filter_map(|sample| {
                Some((form.evaluate(sample).ok()?, asked.evaluate(sample).ok()?))
            });
            let pairs: Vec<(f64, f64)> = pairs.collect();
            !pairs.is_empty()
                && pairs.iter().all(|(one, other)| (one - other).abs() <= 1e-12 * one.abs())
        };
        let form = forms.iter().find(same)?;
        let is_stable = |sample| !self.stable_at(std::slice::from_ref(form), sample).is_empty();
        samples.iter().any(is_stable).then(|| form.clone())
    }

    /// The error of an unstable `x = 0`; it suggests the motions through it if the equation is
    /// conservative and has such motions.
    pub(super) fn unstable(&self, conservative: bool) -> OscillatorError {
        OscillatorError::Unstable {
            coordinate: self.coordinate,
            stable: self.stable_equilibria(),
            passed: conservative && self.cross_well(&Expr::zero()).is_some(),
        }
    }

    /// The motions through zero that run over the wells on both sides of it, where it is a hilltop
    /// between them; `position` is the position of zero in the equation as typed. A force with
    /// parameters counts if zero is a hilltop for positive sample values of all sizes.
    pub(super) fn cross_well(&self, position: &Expr) -> Option<CrossWell> {
        /// Largest relative difference of a closed form and the number found, which is as accurate
        /// as the quadrature of the energy.
        const AGREEMENT: f64 = 1e-7;
        let samples = match self.value {
            Some(_) => vec![BTreeMap::new()],
            None => self.samples(),
        };
        let unit =
            self.stable().iter().map(|found| found.position.abs()).fold(f64::INFINITY, f64::min);
        let unit = if unit.is_finite() { unit } else { 1.0 };
        // Most forces pull back: one value on either side tells.
        let value = self.at_numbers(samples.first()?)?;
        if value(1e-6 * unit) > 0.0 && value(-1e-6 * unit) < 0.0 {
            return None;
        }
        let rest = Expr::zero();
        let at = |sample: &BTreeMap<Symbol, f64>| {
            AtNumbers::new(self.force, self.coordinate, &rest, sample, unit)
        };
        let away = |sample: &BTreeMap<Symbol, f64>| {
            at(sample).is_some_and(|force| pushes_away(&force, unit))
        };
        if !samples.iter().all(away) || !is_odd(self.force, self.coordinate).unwrap_or(false) {
            return None;
        }
        let several = Cell::new(false);
        let ranges = |sample: &BTreeMap<Symbol, f64>| {
            let ranges = passages(&at(sample)?, unit);
            several.set(several.get() || ranges.len() > 1);
            ranges.first().copied()
        };
        let found: Vec<(&BTreeMap<Symbol, f64>, Passage)> =
            samples.iter().filter_map(|sample| Some((sample, ranges(sample)?))).collect();
        let first = found.first()?.1;
        let fits = |form: &Expr| {
            found.iter().all(|(sample, range)| {
                let value = form.evaluate(sample);
                value.is_ok_and(|value| (value - range.from).abs() <= AGREEMENT * range.from)
            })
        };
        let from = self.edges(first.from).into_iter().find(fits).map(Position::Exact);
        let from = from.or_else(|| self.value.is_some().then_some(Position::Number(first.from)));
        let to = match (first.to, self.value.is_some()) {
            (Some(rim), true) => {
                CrossWellEnd::At(match exact_zero(self.force, self.coordinate, rim.place) {
                    Some(exact) if rim.separatrix => Position::Exact(exact),
                    _ => Position::Number(rim.place),
                })
            }
            (None, true) => CrossWellEnd::Never,
            (_, false) if found.iter().any(|entry| entry.1.to.is_some()) => CrossWellEnd::Somewhere,
            (_, false) => CrossWellEnd::Never,
        };
        let mut positive: Vec<Symbol> = self.force.symbols().into_iter().collect();
        positive.retain(|name| *name != self.coordinate);
        Some(CrossWell {
            coordinate: self.coordinate,
            equilibrium: position.clone(),
            from,
            to,
            others: several.get(),
            positive,
        })
    }

    /// Candidates for the amplitude at which the potential is again that at zero; `near` is its
    /// numerical value.
    fn edges(&self, near: f64) -> Vec<Expr> {
        let x = self.coordinate;
        let risen = || {
            let potential = potential(self.force, x)?;
            let at_zero = potential.substitute(x, &Expr::zero()).ok()?;
            (potential - at_zero).expand().ok()
        };
        let Some(risen) = risen() else { return vec![] };
        let mut forms: Vec<Expr> = match self.value {
            Some(_) => exact_zero(&risen, x, near).into_iter().collect(),
            None => vec![],
        };
        let squared =
            Expr::from(x).integer_power(2).and_then(|squared| Expr::divide(&risen, &squared));
        if let Ok(quotient) = squared.and_then(|quotient| quotient.expand()) {
            forms.extend(closed_forms(&quotient, x));
        }
        forms
    }

    /// The stable equilibria: the nearest few, and the period with which they repeat.
    pub(super) fn stable_equilibria(&self) -> Equilibria {
        const MOST: usize = 4;
        if self.value.is_none() {
            let stable = self.stable_at(&self.forms(), &self.sample(1.0)).into_iter();
            return Equilibria {
                positions: stable.map(|(_, form)| Position::Exact(form)).collect(),
                others: None,
            };
        }
        let period = self.period();
        let half = period.as_ref().and_then(|period| period.evaluate(&BTreeMap::new()).ok());
        let near = |position: &f64| {
            half.is_none_or(|period| position.abs() <= 0.5 * period * (1.0 + 1e-9))
        };
        let mut positions: Vec<f64> =
            self.stable().into_iter().map(|found| found.position).collect();
        positions.retain(near);
        let more = positions.len() > MOST;
        positions.truncate(MOST);
        positions.sort_by(f64::total_cmp);
        let named = |position: f64| match exact_zero(self.force, self.coordinate, position) {
            Some(exact) if exact.to_string().len() <= 12 => Position::Exact(exact),
            _ => Position::Number(position),
        };
        let others = match period {
            Some(period) => Some(FurtherEquilibria::Every(period)),
            None => more.then_some(FurtherEquilibria::FartherOut),
        };
        Equilibria {
            others: others.filter(|_| !positions.is_empty()),
            positions: positions.into_iter().map(named).collect(),
        }
    }

    /// The period of a force that is periodic in the coordinate, found by trying those of its sines
    /// and cosines.
    fn period(&self) -> Option<Expr> {
        let mut slopes: Vec<Rational> = Vec::new();
        let collected = self.force.fold(|expr, _: &[()]| {
            if let Node::Function(Function::Sin | Function::Cos | Function::Tan, arguments) =
                expr.node()
                && let Some(slope) =
                    arguments.first().and_then(|angle| angle.differentiate(self.coordinate).ok())
                && let Some(slope) = slope.as_number().filter(|slope| !slope.is_zero())
            {
                slopes.push(num_traits::Signed::abs(slope));
            }
            Ok::<(), std::convert::Infallible>(())
        });
        collected.ok()?;
        slopes.sort();
        let periods =
            slopes.iter().map(|slope| Expr::from(2) * Expr::pi() * Expr::number(slope.recip()));
        periods.into_iter().find(|period| {
            let moved = shifted_force(self.force, self.coordinate, period);
            let difference = moved.and_then(|moved| (&moved - self.force).expand());
            difference.is_ok_and(|difference| difference.is_zero())
        })
    }
}

/// Whether a coefficient is zero, or what rounding leaves of terms that cancel.
fn is_nothing(coefficient: &Expr) -> bool {
    let Ok(expanded) = coefficient.expand() else {
        return false;
    };
    let values = expanded.terms().iter().map(|term| term.evaluate(&BTreeMap::new()));
    let Ok(values) = values.collect::<Result<Vec<f64>, _>>() else {
        return expanded.is_zero();
    };
    let (sum, size) =
        values.iter().fold((0.0, 0.0), |(sum, size), value| (sum + value, size + value.abs()));
    f64::abs(sum) <= 1e-14 * size
}
