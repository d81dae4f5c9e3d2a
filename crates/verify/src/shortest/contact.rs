//! The question of a search about contacts: their duration over that without damping.
//!
//! ```text
//! x'' + k x^n (1 + c x') = 0,   x(0) = 0, x'(0) = v, until x = 0 again:     T/T_0 is a function of c v, or of e
//! G(c v) = G(-e c v),   G(z) = z - log(1 + z)                                e the coefficient of restitution
//! ```
//!
//! In: an equation of that form, and the range of c v, of one of its letters or of e. Out: the problem in one
//! variable, whose truth is that of `certificate::law_on_range`.
//!
//! Source: K. H. Hunt, F. R. E. Crossley, J. Appl. Mech. 42 (1975) 440.

use num_traits::{One as _, Signed as _, Zero as _};

use super::problem::{LawMotion, LawProblem, ShortestError, ends};
use crate::certificate::{HuntCrossleyForce, coordinate, restitution};
use crate::decimal::neighbours;
use crate::exact::Rational;
use crate::exact::rational::{from_f64, to_f64};
use crate::expr::Expr;
use crate::numeric::ode::root::find_root;
use crate::oscillator::Oscillator;
use crate::symbol::{Symbol, fresh};
use crate::values::Values;

/// The letter of the speed at the touch.
const SPEED: &str = "v";

/// Significant digits of the ends of a range that follow from those of a restitution.
const DIGITS: usize = 6;

impl LawProblem {
    /// The problem of a contact `x'' + k x^n (1 + c x') = 0`, touched with the speed v: its duration over that
    /// without damping depends on c v alone. The range is of that product, of one of its letters, or of the
    /// restitution e.
    ///
    /// # Errors
    /// [`ShortestError`].
    pub fn of_contact(
        oscillator: &Oscillator,
        varying: &Expr,
        (from, to): (&Rational, Option<&Rational>),
        at: &Values,
    ) -> Result<Self, ShortestError> {
        let to = ends(from, to)?.ok_or(ShortestError::EndOfContact)?;
        let contact = HuntCrossleyForce::of(&oscillator.force, oscillator.coordinate)?;
        let contact = contact.ok_or_else(|| ShortestError::NoContact(oscillator.force.clone()))?;
        let product = &contact.damping * &Expr::from(Symbol::new(SPEED));
        let letters = product.symbols();
        if let Some((name, _)) = at.iter().find(|(name, _)| !letters.contains(name)) {
            return Err(ShortestError::Unknown(name));
        }
        let taken: Vec<Symbol> = letters.iter().copied().chain([oscillator.coordinate]).collect();
        let (values, _) = at.split(&taken);
        let equation = format!("{} = 0", oscillator.residual.substitute_all(&values)?);
        let fresh_letter = fresh("s", &taken);
        let force = |damping: Rational| -> Result<Expr, ShortestError> {
            let [depth, speed] = [coordinate(), coordinate().derivative()].map(Expr::from);
            let depth = Expr::power(&depth, &Expr::number(contact.exponent.clone()))?;
            Ok(depth * (Expr::one() + Expr::number(damping) * speed))
        };
        if varying.as_symbol() == Some(restitution()) && !letters.contains(&restitution()) {
            let one = Rational::one();
            if to > one || !from.is_positive() {
                return Err(ShortestError::EndOfContact);
            }
            let [most, least] = [from, &to].map(|e| damping_of(to_f64(e)));
            let [below, above] = [least, most].map(|s| from_f64(s).unwrap_or_else(Rational::zero));
            let (from, to) = (from.clone(), to);
            return Ok(Self {
                motion: LawMotion::Contact { force: force(one)?, restitution: Some([from, to]) },
                equation,
                variable: fresh_letter,
                meaning: Some(product),
                from: neighbours(&below, DIGITS)[0].clone(),
                to: Some(neighbours(&above, DIGITS)[1].clone()),
            });
        }
        let given = product.substitute_all(&values)?;
        let factor = Expr::divide(&given, varying)?.expand()?;
        let Some(damping) = factor.as_number().filter(|c| c.is_positive()).cloned() else {
            let own = varying.symbols();
            let mut missing = given.symbols();
            missing.retain(|name| !own.contains(name));
            let names: Vec<Symbol> = missing.into_iter().collect();
            return Err(match own.iter().all(|name| letters.contains(name)) && !names.is_empty() {
                true => ShortestError::Missing(names),
                false => ShortestError::NotOfContact { varying: varying.clone(), product },
            });
        };
        let (variable, meaning) = match varying.as_symbol() {
            Some(name) => (name, None),
            None => (fresh_letter, Some(varying.clone())),
        };
        let motion = LawMotion::Contact { force: force(damping)?, restitution: None };
        Ok(Self { motion, equation, variable, meaning, from: from.clone(), to: Some(to) })
    }
}

/// The product of damping and speed whose contact has this restitution:
/// `G(s) = G(-e s)`, `G(z) = z - log(1 + z)`.
fn damping_of(restitution: f64) -> f64 {
    if restitution >= 1.0 {
        return 0.0;
    }
    let lost = |z: f64| z - z.ln_1p();
    let missing = |s: f64| lost(s) - lost(-restitution * s);
    // For little loss s is 3 (1 - e)/2.
    let least = 1e-2 * (1.0 - restitution);
    let most = restitution.recip() * (1.0 - f64::EPSILON);
    find_root(missing, least, most).unwrap_or(most)
}
