//! The vibro-impact sink: a light body between two walls of a main mass, which hits each once a period. A
//! ball in a cavity flies freely, a pendulum swings at `w` times the frequency of the main mass, `0 < w < 1`.
//!
//! ```text
//! x = X cos t + U sin t,   y'' + w^2 y = -x'' between the impacts y = b at t = 0 and y = -b at t = pi:
//! y = Z sin(w (pi/2 - t))/sin(pi w/2) - x/(1 - w^2)
//! Z - X/(1 - w^2) = b,  y'(0+) = -r y'(0-):   U = -s kappa Z (1 - w^2),  kappa = w cot(pi w/2),  s = (1 - r)/(1 + r)
//! C^2 = X^2 + U^2 = (1 - w^2)^2 ((Z - b)^2 + (s kappa Z)^2)
//! ```
//!
//! Here y is the displacement relative to the main mass. The ball is the limit w = 0, kappa = 2/pi.
//! The body is light: an impact does not change the motion of the main mass, whose amplitude C falls
//! from impact to impact (the ball: E. Gourc, G. Michon, S. Seguy, A. Berlioz, *J. Vib. Acoust.* 137 (2015) 031008; T. Li, S. Seguy,
//! A. Berlioz, *Nonlinear Dyn.* 87 (2017) 2415).
//!
//! With the speed `V = (1 + s) kappa Z` just before an impact and the acceleration `a = (1 - w^2) Z - b`
//! just after it, an impact at `t = d` instead of 0, after which `y' = -r V + e`, and the next at `t = pi + d'`, where `y' = r V - e'`,
//! are related in first order by
//!
//! ```text
//! V d' = r V c d + S (e - a d),   e' = r (c (e - a d) - w^2 S r V d - a d'),   c = cos(pi w),  S = sin(pi w)/w
//! trace 2 r c - (1 + r) S a/V,   determinant r^2
//! ```
//!
//! The motion is stable between the multiplier 1 of this map, where C is least, and the multiplier -1.
//!
//! Each impact takes `mu/(1 + mu) (1 - r^2) V^2/2` from the energy `C^2/2`, so that along the manifold
//!
//! ```text
//! d(C^2)/dt = -mu/(1 + mu) (1 - r^2) V^2/pi = -4 mu s kappa^2 Z^2/((1 + mu) pi)
//! ```

use std::ops::Bound;

use super::{
    AbsorberDesign, AbsorberError, AbsorberFormula, AbsorberKind, AbsorberLaws, AbsorberLetter,
    AbsorberRelation,
};
use crate::exact::polynomial::Monomial;
use crate::exact::rational::ratio;
use crate::exact::{Polynomial, RationalFunction};
use crate::expr::{Expr, Function};
use crate::modes::by_powers;
use crate::solution::Definition;
use crate::symbol::Symbol;

const RESTITUTION: AbsorberLetter = AbsorberLetter {
    name: "r",
    meaning: "the coefficient of restitution",
    range: (Bound::Excluded(0.0), Bound::Excluded(1.0)),
    example: "0.65",
};

/// The letters of the designs of a ball.
pub(super) const LETTERS: [AbsorberLetter; 3] = [
    RESTITUTION,
    AbsorberLetter {
        name: "b",
        meaning: "half the width of the cavity, less the radius of the ball,",
        range: (Bound::Excluded(0.0), Bound::Unbounded),
        example: "1",
    },
    AbsorberLetter {
        name: "mu",
        meaning: "the mass ratio of a light ball",
        range: (Bound::Excluded(0.0), Bound::Included(0.1)),
        example: "1/100",
    },
];

/// The letters of the designs of a pendulum.
pub(super) const LETTERS_OF_PENDULUM: [AbsorberLetter; 4] = [
    RESTITUTION,
    AbsorberLetter {
        name: "b",
        meaning: "half the way between the barriers",
        range: (Bound::Excluded(0.0), Bound::Unbounded),
        example: "1",
    },
    AbsorberLetter {
        name: "w",
        meaning: "the frequency of the pendulum over that of the main mass",
        range: (Bound::Excluded(0.0), Bound::Excluded(1.0)),
        example: "0.5",
    },
    AbsorberLetter {
        name: "mu",
        meaning: "the mass ratio of a light pendulum",
        range: (Bound::Excluded(0.0), Bound::Included(0.1)),
        example: "1/100",
    },
];

const WHAT: &str = "the motion with two impacts a period";

/// The motion of the light body from impact to impact.
struct Flight {
    /// The numerator and the denominator of kappa.
    kappa: [Expr; 2],
    /// The power of pi in the square of that denominator.
    power_of_pi: i32,
    /// w.
    frequency: Expr,
}

impl Flight {
    fn of(kind: AbsorberKind) -> Self {
        match kind {
            AbsorberKind::PendulumSink => Self {
                kappa: [Expr::symbol("kappa"), Expr::one()],
                power_of_pi: 0,
                frequency: Expr::symbol("w"),
            },
            _ => {
                Self { kappa: [Expr::from(2), Expr::pi()], power_of_pi: 2, frequency: Expr::zero() }
            }
        }
    }

    /// `1 - w^2`.
    fn forced(&self) -> Result<Expr, AbsorberError> {
        Ok(Expr::one() - self.frequency.integer_power(2)?)
    }

    /// kappa times a factor.
    fn kappa_times(&self, factor: &Expr) -> Result<Expr, AbsorberError> {
        let [numerator, denominator] = &self.kappa;
        Ok(Expr::divide(&(numerator * factor), denominator)?)
    }
}

/// Derives the manifold, its least amplitude, where the motion is stable, and the decay.
pub(super) fn derive(kind: AbsorberKind) -> Result<AbsorberLaws, AbsorberError> {
    let none = || AbsorberError::NoClosedForm(WHAT);
    let of = Symbol::new;
    let expr = |name: &str| Expr::symbol(name);
    let flight = Flight::of(kind);
    let loss = loss()?;
    let forced = flight.forced()?;
    // (C/(1 - w^2))^2 times the square of kappa's denominator, a polynomial of second degree in Z.
    let place = expr("Z") - expr("b");
    let speed = flight.kappa_times(&expr("Z"))?;
    let velocity = -expr("s") * &speed;
    let square = place.integer_power(2)? + velocity.integer_power(2)?;
    let cleared = &square * &flight.kappa[1].integer_power(2)?;
    let cleared = cleared.to_polynomial(&mut |_| None)?.ok_or_else(none)?;
    let parts = by_powers(&cleared, of("Z"));
    let [c0, c1, c2] = &parts[..] else { return Err(none()) };
    let mut middle = c1.map(|number| number / ratio(2, 1));
    middle.negate();
    let lowest_place = Expr::divide(&Expr::from(&middle), &Expr::from(c2))?;
    // c0/c2 - (c1/(2 c2))^2 of these coefficients where C is least.
    let mut lowest = middle.product(&middle);
    lowest.negate();
    lowest.accumulate(&c0.product(c2));
    let over = Monomial::power_of(of("pi"), -flight.power_of_pi);
    let lowest = lowest.times_monomial(&over).single_term_root();
    let lowest = Expr::divide(&Expr::from(&lowest.ok_or_else(none)?), &Expr::from(c2).sqrt()?)?;
    let doubling = period_doubling(&flight)?;
    let slopes = [c1, c2].map(|part| part.times_monomial(&over));
    let time = decay_time(&slopes, &loss, &flight)?;
    let formula = |name: &'static str, symbol: &str, formula: Expr| AbsorberFormula {
        name,
        symbol: of(symbol),
        formula,
    };
    let mut definitions = vec![Definition { symbol: of("s"), meaning: loss.to_expr(of("r"))? }];
    if kind == AbsorberKind::PendulumSink {
        let quarter = Expr::divide(&(Expr::pi() * &flight.frequency), &Expr::from(2))?;
        let tangent = Expr::function(Function::Tan, vec![quarter])?;
        let meaning = Expr::divide(&flight.frequency, &tangent)?;
        definitions.push(Definition { symbol: of("kappa"), meaning });
    }
    let words = Words::of(kind);
    Ok(AbsorberLaws {
        kind,
        equations: words.equations()?,
        meanings: words.meanings(),
        definitions,
        relations: vec![
            AbsorberRelation { left: expr("X"), right: &forced * &place, words: words.place },
            AbsorberRelation {
                left: expr("U"),
                right: &forced * &velocity,
                words: "its velocity there, by the restitution",
            },
            AbsorberRelation {
                left: expr("C").integer_power(2)?,
                right: forced.integer_power(2)? * &square,
                words: "motions with two impacts a period, by the sum of both squares",
            },
            AbsorberRelation {
                left: expr("t"),
                right: time,
                words: "decay along them, by the energy that impacts take",
            },
        ],
        designs: vec![
            AbsorberDesign {
                name: "threshold",
                words: "the least amplitude of the main mass with two impacts a period",
                formulas: vec![
                    formula("amplitude", "C_min", &forced * &lowest),
                    formula(words.amplitude, "Z_min", lowest_place),
                ],
                refined_by: None,
            },
            AbsorberDesign {
                name: "period-doubling",
                words: "the largest amplitude at which that motion is stable",
                formulas: vec![
                    formula("amplitude", "C_max", &forced * &doubling.amplitude),
                    formula(words.amplitude, "Z_max", doubling.place),
                ],
                refined_by: None,
            },
        ],
        validity: words.validity,
    })
}

/// The words of a ball, or of a pendulum.
struct Words {
    kind: AbsorberKind,
    place: &'static str,
    /// The name of the amplitude Z.
    amplitude: &'static str,
    validity: &'static str,
}

impl Words {
    fn of(kind: AbsorberKind) -> Self {
        match kind {
            AbsorberKind::PendulumSink => Self {
                kind,
                place: "place of the main mass at an impact",
                amplitude: "pendulum_amplitude",
                validity: "a light pendulum with w below 1, whose impacts take little from the main mass in a period; t to first order in mu; an impact takes no time; \
                   where 1 - kappa^2 - w^2 - s^2*w^2 is not positive, no multiplier reaches -1 and there is no C_max; large motions end where the pendulum touches a barrier between its \
                   impacts, which has no formula",
            },
            _ => Self {
                kind,
                place: "place of the main mass at an impact, where the ball turns",
                amplitude: "ball_amplitude",
                validity: "a light ball, whose impacts take little from the main mass in a period; t to first order in mu; an impact takes no time; where r is below 0.09 or so, the ball \
                   touches a wall between its impacts before C_max is reached",
            },
        }
    }

    fn equations(&self) -> Result<Vec<(Expr, Expr)>, AbsorberError> {
        let expr = |name: &str| Expr::symbol(name);
        let second = |name: &str| Expr::from(Symbol::new(name).derivative().derivative());
        let main = second("x") + expr("x");
        Ok(match self.kind {
            AbsorberKind::PendulumSink => {
                let pull = expr("w").integer_power(2)? * expr("y");
                vec![(main, expr("mu") * &pull), (second("y") + second("x") + pull, Expr::zero())]
            }
            _ => vec![(main, Expr::zero()), (second("y"), Expr::zero())],
        })
    }

    fn meanings(&self) -> Vec<(Symbol, &'static str)> {
        let mut rows = match self.kind {
            AbsorberKind::PendulumSink => vec![
                (
                    "y",
                    "displacement of the pendulum relative to it, which hits a barrier where abs(y) = b",
                ),
                ("b", "half the way between the barriers"),
                ("w", "frequency of the pendulum over that of the main mass"),
                ("r", "coefficient of restitution"),
                ("C", "amplitude of the main mass"),
                ("Z", "y + x/(1 - w^2) just after an impact: what the pendulum swings by itself"),
                ("Z0", "the same at t = 0"),
                ("mu", "mass of the pendulum over that of the main mass"),
            ],
            _ => vec![
                ("y", "displacement of the ball, which hits a wall where abs(y - x) = b"),
                ("b", "half the width of the cavity, less the radius of the ball"),
                ("r", "coefficient of restitution"),
                ("C", "amplitude of the main mass"),
                ("Z", "amplitude of the ball, which flies to and fro at the speed 2*Z/pi"),
                ("Z0", "its amplitude at t = 0"),
                ("mu", "mass of the ball over that of the main mass"),
            ],
        };
        rows.insert(0, ("x", "displacement of the main mass, time in units of 1/(its frequency)"));
        rows.into_iter().map(|(name, words)| (Symbol::new(name), words)).collect()
    }
}

/// The time in which Z falls from `Z0`: the integral of `-(dC^2/dZ)/(rate of C^2) dZ`, with
/// `dC^2/dZ = (1 - w^2)^2 (p + 2 q Z)` and the rate a number times `s kappa^2 Z^2`.
fn decay_time(
    [p, q]: &[Polynomial; 2],
    loss: &RationalFunction,
    flight: &Flight,
) -> Result<Expr, AbsorberError> {
    let none = || AbsorberError::NoClosedForm(WHAT);
    let expr = |name: &str| Expr::symbol(name);
    let letter = Symbol::new("r");
    let one = RationalFunction::number(ratio(1, 1));
    let r =
        RationalFunction::from_polynomial(&Polynomial::symbol(letter), letter).ok_or_else(none)?;
    // (1 - r^2) V^2 = number s (kappa Z)^2: the number does not depend on r.
    let gap = one.sum(loss);
    let taken = one.difference(&r.product(&r)).product(&gap.product(&gap));
    let number = taken.quotient(loss).ok_or_else(none)?.to_expr(letter)?;
    let [numerator, denominator] = &flight.kappa;
    // There is an impact every pi.
    let mass = Expr::divide(&(Expr::one() + expr("mu")), &expr("mu"))?;
    let per_impact =
        Expr::pi() * denominator.integer_power(2)? * flight.forced()?.integer_power(2)?;
    let rate = number * numerator.integer_power(2)? * expr("s");
    let scale = Expr::divide(&per_impact, &rate)?;
    let [before, now] = [expr("Z0"), expr("Z")];
    let fallen = Expr::function(Function::Log, vec![Expr::divide(&before, &now)?])?;
    let inverse = Expr::divide(&Expr::one(), &now)? - Expr::divide(&Expr::one(), &before)?;
    let slope = Expr::from(2) * Expr::from(q);
    Ok(mass * scale * (slope * &fallen + Expr::from(p) * &inverse))
}

/// `s = -u/v` in r, from the condition of restitution `-v - u = -r (v - u)`, where `v = kappa Z` and
/// `u = U/(1 - w^2)`.
fn loss() -> Result<RationalFunction, AbsorberError> {
    let none = || AbsorberError::NoClosedForm(WHAT);
    let (r, u, v) = (Symbol::new("r"), Symbol::new("u"), Symbol::new("v"));
    let after = -Expr::from(v) - Expr::from(u);
    let before = Expr::from(v) - Expr::from(u);
    let condition = after + Expr::from(r) * before;
    let condition = condition.to_polynomial(&mut |_| None)?.ok_or_else(none)?;
    let part = |name: Symbol| {
        RationalFunction::from_polynomial(&condition.slope(name), r).ok_or_else(none)
    };
    part(v)?.quotient(&part(u)?).ok_or_else(none)
}

/// The motion with a multiplier of -1.
struct PeriodDoubling {
    /// Z.
    place: Expr,
    /// `C/(1 - w^2)`.
    amplitude: Expr,
}

/// Z and C where a multiplier is -1, `1 + trace + determinant = 0`.
fn period_doubling(flight: &Flight) -> Result<PeriodDoubling, AbsorberError> {
    let none = || AbsorberError::NoClosedForm(WHAT);
    let expr = |name: &str| Expr::symbol(name);
    let (one, place) = (Expr::one(), Symbol::new("Z"));
    let squares = [flight.kappa_times(&one)?.integer_power(2)?, flight.frequency.integer_power(2)?];
    let [kappa, w] = &squares;
    // With r = back/forth, c = (kappa^2 - w^2)/(kappa^2 + w^2), S = 2 kappa/(kappa^2 + w^2): the condition
    // 1 + r^2 + 2 r c = (1 + r) S a/V times forth^2 (kappa^2 + w^2) Z/2.
    let (forth, back) = (&one + expr("s"), &one - expr("s"));
    let both = forth.integer_power(2)? + back.integer_power(2)?;
    let half = Expr::divide(&both, &Expr::from(2))?;
    let left = half * (kappa + w) + &forth * &back * (kappa - w);
    let right = flight.forced()? * expr("Z") - expr("b");
    let condition = left * expr("Z") - Expr::from(2) * right;
    let condition = condition.to_polynomial(&mut |_| None)?.ok_or_else(none)?;
    let halved = |part: &Polynomial| Expr::from(&part.map(|number| number / ratio(2, 1)));
    let slope = halved(&condition.slope(place));
    let constant = halved(&condition.slope(Symbol::new("b"))) * expr("b");
    let at = Expr::divide(&constant, &-&slope)?;
    // X/(1 - w^2) = Z - b = (1 + slope) Z, and U/(1 - w^2) = -s kappa Z.
    let over_kappa = Expr::divide(&(&one + &slope), &flight.kappa_times(&one)?)?;
    let directions = expr("s").integer_power(2)? + over_kappa.integer_power(2)?;
    Ok(PeriodDoubling { amplitude: flight.kappa_times(&at)? * directions.sqrt()?, place: at })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn written(kind: AbsorberKind) -> Vec<String> {
        let laws = derive(kind).expect("closed forms");
        let formulas = laws.designs.iter().flat_map(|design| &design.formulas);
        formulas.map(|own| format!("{} = {}", own.symbol, own.formula)).collect()
    }

    #[test]
    fn formulas_of_two_impacts_a_period() {
        let laws = derive(AbsorberKind::PendulumSink).expect("closed forms");
        let meanings = laws.definitions.iter().map(|own| own.meaning.to_string());
        assert_eq!(meanings.collect::<Vec<_>>(), ["(1 - r)/(1 + r)", "w/tan(pi*w/2)"]);
        assert_eq!(
            written(AbsorberKind::ImpactSink),
            [
                "C_min = 2*b*s/sqrt(pi^2 + 4*s^2)",
                "Z_min = pi^2*b/(pi^2 + 4*s^2)",
                "C_max = 2*b*sqrt(4/pi^2 + s^2)/(pi*(1 - 4/pi^2))",
                "Z_max = b/(1 - 4/pi^2)",
            ]
        );
    }

    #[test]
    fn a_pendulum_has_its_own_frequency() {
        assert_eq!(
            written(AbsorberKind::PendulumSink),
            [
                "C_min = b*kappa*s*(1 - w^2)/sqrt(1 + kappa^2*s^2)",
                "Z_min = b/(1 + kappa^2*s^2)",
                "C_max = b*kappa*(1 - w^2)*sqrt(s^2 + (kappa^2 + w^2 + s^2*w^2)^2/kappa^2)/(1 - kappa^2 - w^2 - s^2*w^2)",
                "Z_max = b/(1 - kappa^2 - w^2 - s^2*w^2)",
            ]
        );
    }
}
