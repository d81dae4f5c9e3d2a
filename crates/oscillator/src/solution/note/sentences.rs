//! Notes as sentences.

use std::fmt;

use num_traits::One as _;

use super::super::{Definition, Degrees};
use super::{
    BoundsHold, CollocationInstant, CornerSide, CrossWell, CrossWellEnd, ExactBy, ExactFirstStep,
    FollowedRoot, Note, Poles, Position, RootEnd, Truncation,
};
use crate::decimal::decimal;
use crate::exact::{Monomial, Polynomial, Rational};
use crate::expr::Expr;
use crate::symbol::Symbol;
use crate::symbol::letters::{AMPLITUDE, FIRST_HARMONIC, FREQUENCY};

const SLOPE_AT_HALF: &str =
    "one line: exact for linear forces, and to first order for cubic ones alone";
const MOTION_OF_SERIES: &str = "the motion is that of Lindstedt-Poincare to its first correction";
const CORNERS: &str =
    "the force has corners: the expansion holds for motions that stay before the nearest";
const ROUNDED_COEFFICIENTS: &str =
    "numerical coefficients, rounded to 15 digits: the equilibrium is no fraction";

impl fmt::Display for CrossWell {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            formatter,
            "motions through the unstable equilibrium {} = {}, over the wells on both sides: ",
            self.coordinate, self.equilibrium
        )?;
        match (&self.from, &self.to) {
            (Some(from), CrossWellEnd::At(to)) => {
                write!(formatter, "{from} < |{AMPLITUDE}| < {to}")?
            }
            (Some(from), CrossWellEnd::Never) => write!(formatter, "|{AMPLITUDE}| > {from}")?,
            (Some(from), CrossWellEnd::Somewhere) => {
                write!(formatter, "|{AMPLITUDE}| > {from}, up to the next unstable one")?
            }
            (None, CrossWellEnd::Somewhere) => write!(
                formatter,
                "where the potential energy at {AMPLITUDE} is above that of the equilibrium, up to the next unstable one"
            )?,
            (None, _) => write!(
                formatter,
                "where the potential energy at {AMPLITUDE} is above that of the equilibrium"
            )?,
        }
        if self.others {
            formatter.write_str(", and others farther out")?;
        }
        match self.positive.is_empty() {
            true => Ok(()),
            false => write!(formatter, "; for positive {}", listed(&self.positive)),
        }
    }
}

impl fmt::Display for Note {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::FirstStep(step) => step.fmt(formatter),
            Self::Collocated(instant) => instant.fmt(formatter),
            Self::OtherLetter {
                usual,
                written,
                is_coordinate,
            } => {
                let of_answer = match *usual {
                    FREQUENCY => "frequency",
                    FIRST_HARMONIC => "amplitude of the first harmonic",
                    _ => "amplitude",
                };
                let of_equation = if *is_coordinate { "the coordinate" } else { "a parameter" };
                write!(
                    formatter,
                    "the {of_answer} of the answer is written {}, since {} is {of_equation} of the equation",
                    written.name(),
                    usual.name()
                )
            }
            Self::Misleading { name, instead } => write!(formatter, "{name} is read as a parameter; {instead}"),
            Self::EvenPartLeftOut(even) => even_part(formatter, even),
            Self::Cut(cut) => cut.fmt(formatter),
            Self::MotionAtLeadingOrder { small } => write!(
                formatter,
                "the motion is {AMPLITUDE} times the cosine of its phase: its part of the size of {small}, drift and harmonics, is left out"
            ),
            Self::ConvergenceControl(hbar) => write!(
                formatter,
                "{hbar} controls the convergence; numbers are given with the one of least squared residual"
            ),
            Self::TaylorPolynomial { degree } => write!(
                formatter,
                "the force entered as its Taylor polynomial of degree {degree}"
            ),
            Self::MotionCutAfter { harmonic } => write!(formatter, "the motion is cut after its harmonic {harmonic}"),
            Self::Balanced { harmonics, by_numbers } => balanced(formatter, harmonics, *by_numbers),
            Self::ArcsFor { positive } => write!(formatter, "the arcs are written for {positive} > 0"),
            Self::Bounds {
                at_rest,
                at_turning,
                range,
            } => bounds(formatter, at_rest, at_turning, range),
            Self::ConvergesEverywhere {
                variable,
                highest,
                last,
            } => {
                let words = |monomial: &Monomial| Expr::from(&Polynomial::term(monomial.clone(), Rational::one()));
                match last {
                    Some(last) => write!(
                        formatter,
                        "the series converges everywhere: {FREQUENCY}^2 ends with {}, none of the powers of {} up to {} stands behind it",
                        words(last),
                        words(variable),
                        words(&variable.power(i32::try_from(*highest).unwrap_or(i32::MAX)))
                    ),
                    None => write!(
                        formatter,
                        "the series converges everywhere: by {highest} coefficients, which fall faster than the powers of any number, \
                         {FREQUENCY}^2 has no singularity in {}",
                        words(variable)
                    ),
                }
            }
            Self::AgreesThrough {
                degrees,
                small,
                step,
                order,
            } => agreement(formatter, *degrees, *small, *step, *order),
            Self::Poles(poles) => poles.fmt(formatter),
            Self::Followed(root) => root.fmt(formatter),
            Self::EllipticFunctions => formatter.write_str(
                "the elliptic functions of Jacobi have an argument and a parameter, the square of the modulus; a quarter of their period \
                 is the complete integral of the first kind",
            ),
            Self::Exact(by) => by.fmt(formatter),
            Self::Stability(cycle) => write!(formatter, "the limit cycle {}", cycle.stability()),
            Self::RoundedAmplitude {
                amplitude,
                square,
                polynomial,
            } => write!(
                formatter,
                "{amplitude}^2 is a root {square} of {polynomial} = 0; the value of {amplitude} is rounded to 15 digits"
            ),
            Self::Action { rate, pendulum } => action(formatter, rate, *pendulum),
            Self::HalfSwings { lost, size } => half_swings(formatter, lost, size),
            Self::Grows => formatter.write_str("the amplitude grows: energy is fed and nothing drains it"),
            Self::LinearDrive(drive) => drive.fmt(formatter),
            Self::ForcedWaves { near, far } => {
                let names = listed(far);
                let distance = "far from it, its half, third, double and triple";
                match far.len() {
                    1 => write!(formatter, "{near} is taken to be near omega0, and {names} {distance}"),
                    _ => write!(
                        formatter,
                        "{near} is taken to be near omega0, and {names} {distance}, as are their sums and differences"
                    ),
                }?;
                formatter.write_str(": to leading order the motion that such a drive holds is that of the linear equation")
            }
            Self::RelativeCoordinate {
                relative,
                coordinate,
                base,
            } => write!(
                formatter,
                "in the coordinate relative to the base: {relative} = {}, so that {coordinate} = {}",
                &Expr::from(*coordinate) - base,
                &Expr::from(*relative) + base
            ),
            Self::HighestOrderHere { asked, given } => write!(
                formatter,
                "order {asked} was asked for; {given} is the highest for this equation"
            ),
            Self::InsteadOf { usual, reason } => write!(
                formatter,
                "chosen because {}, which usually answers, does not apply: {reason}",
                usual.title()
            ),
            Self::QuadraticTerms => formatter.write_str(
                "in powers of the amplitude, because quadratic terms change the frequency as much as cubic ones: in its square",
            ),
            Self::QuadraticTermsLeftOut => formatter.write_str(
                "the effect of quadratic terms on the frequency comes at order 2, as large as that of cubic ones: --order 2 has it",
            ),
            Self::NonlinearTermsLeftOut => formatter.write_str(
                "no nonlinear term comes up to this order: the slow equations are those of the linear oscillator; `response` balances the harmonics of the whole force",
            ),
            Self::Stopped { asked } => {
                write!(
                    formatter,
                    "stopped before order {asked}, which was asked for: these are the orders that there were"
                )
            }
            Self::SteadyAmplitudes {
                square,
                polynomial,
                reason,
            } => write!(
                formatter,
                "the amplitudes that stay follow from {polynomial} = 0, {square} = {FIRST_HARMONIC}^2, {reason}"
            ),
            Self::Positive(definition) => positive(formatter, definition),
            Self::Driven {
                resonance,
                parametric,
                small,
                power,
                nearest,
            } => {
                let name = resonance_in_words(*nearest, *parametric);
                driven(formatter, *resonance, &name, small, *power)
            }
            Self::LeastForce { force, least } => {
                write!(
                    formatter,
                    "a steady motion only where {force} > {least}: dry friction holds it below"
                )
            }
            Self::CornerSides(sides) => corner_sides(formatter, sides),
            Self::EndlessPotential { coordinate } => write!(
                formatter,
                "at {coordinate} = 0 the force and the speed are infinite: the motion goes through as the limit of weaker forces, \
                 sgn({coordinate})*abs({coordinate})^p for p -> -1, by its energy"
            ),
            Self::Equilibrium { coordinate, position } => {
                write!(formatter, "swings about the equilibrium {coordinate} = {position}")
            }
            Self::AlongTrueMotion { harmonic } => write!(
                formatter,
                "averaged along the exact motion without damping, of any amplitude; its harmonics are rounded, and cut after the {harmonic}th"
            ),
            Self::CrossWell(motions) => motions.fmt(formatter),
            Self::SlopeAtHalf => formatter.write_str(SLOPE_AT_HALF),
            Self::MotionOfSeries => formatter.write_str(MOTION_OF_SERIES),
            Self::Corners => formatter.write_str(CORNERS),
            Self::RoundedCoefficients => formatter.write_str(ROUNDED_COEFFICIENTS),
            Self::Stated(words) => formatter.write_str(words),
        }
    }
}

fn even_part(formatter: &mut fmt::Formatter<'_>, even: &Expr) -> fmt::Result {
    write!(
        formatter,
        "the even part of the force, {even}, contributes nothing to a motion of one term: its drift is left out"
    )
}

fn positive(formatter: &mut fmt::Formatter<'_>, definition: &Definition) -> fmt::Result {
    let meaning = definition.meaning_in_words();
    write!(formatter, "{} = {meaning} > 0", definition.symbol)
}

fn half_swings(formatter: &mut fmt::Formatter<'_>, lost: &Expr, size: &Expr) -> fmt::Result {
    write!(
        formatter,
        "exact from one turning point a_n to the next, a_m: {lost} = {size}*(a_n + a_m)"
    )
}

fn action(formatter: &mut fmt::Formatter<'_>, rate: &Expr, pendulum: bool) -> fmt::Result {
    write!(
        formatter,
        "for any amplitude the action J, 1/(2*pi) of the area of the orbit, decays as J({AMPLITUDE})*exp(-({rate})*t)"
    )?;
    match pendulum {
        true => {
            write!(formatter, "; J = (8/pi)*(E(m) - (1 - m)*K(m)), m = sin({FIRST_HARMONIC}/2)^2")
        }
        false => Ok(()),
    }
}

fn resonance_in_words(nearest: Option<(u32, u32)>, parametric: bool) -> String {
    match nearest {
        None => "combination resonance".to_owned(),
        Some((2, 1)) if parametric => "principal parametric resonance".to_owned(),
        Some((p, q)) if parametric => format!("parametric resonance {p}:{q}"),
        Some((1, 1)) => "primary resonance".to_owned(),
        Some((1, q)) => format!("superharmonic resonance 1:{q}"),
        Some((p, q)) => format!("subharmonic resonance {p}:{q}"),
    }
}

fn driven(
    formatter: &mut fmt::Formatter<'_>,
    resonance: (u32, u32),
    name: &str,
    small: &[Expr],
    power: usize,
) -> fmt::Result {
    let (p, q) = resonance;
    let as_power = match power {
        1 => "the small parameter".to_owned(),
        2 => "the square of the small parameter".to_owned(),
        4 => "the fourth power of the small parameter".to_owned(),
        power => format!("the power {power} of the small parameter"),
    };
    write!(
        formatter,
        "{name}, Omega : omega0 near {p} : {q}; as small as {as_power}: {}",
        listed(small)
    )
}

impl fmt::Display for CollocationInstant {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let at = match self {
            Self::EighthOfPeriod => "an eighth of the period",
            Self::CosineSquared => "a twelfth of the period",
        };
        write!(formatter, "one term, collocated at {at}: the instant is a convention of the method")
    }
}

fn balanced(
    formatter: &mut fmt::Formatter<'_>,
    harmonics: &[usize],
    by_numbers: bool,
) -> fmt::Result {
    let how = if by_numbers { "; solved by numbers at an amplitude" } else { "" };
    write!(formatter, "harmonics {} balanced, those above left out{how}", listed(harmonics))
}

fn agreement(
    formatter: &mut fmt::Formatter<'_>,
    degrees: Degrees,
    small: Symbol,
    step: u32,
    order: u32,
) -> fmt::Result {
    let variable = match step {
        1 => small.to_string(),
        _ => format!("{small}^{step}"),
    };
    match degrees {
        Degrees::Quotient(above, below) => {
            write!(formatter, "degree {above} over degree {below} in {variable}")?
        }
        Degrees::Quadratic(p, q, r) => write!(formatter, "degrees {p}, {q} and {r} in {variable}")?,
    }
    write!(formatter, ": agrees with the exact series through {small}^{}", step * order)
}

fn corner_sides(formatter: &mut fmt::Formatter<'_>, sides: &[CornerSide]) -> fmt::Result {
    let mut conditions: Vec<String> =
        sides.iter().map(|side| format!("{} > 0", side.positive)).collect();
    conditions.dedup();
    write!(formatter, "for {}: ", conditions.join(", "))?;
    if sides.iter().all(|side| side.taken.is_zero()) {
        return formatter.write_str("no barrier acts at rest");
    }
    let sides: Vec<String> =
        sides.iter().map(|side| format!("{} is {}", side.corner, side.taken)).collect();
    write!(formatter, "near rest {}", sides.join(", "))
}

impl fmt::Display for Truncation {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Truncated { small, order, marks } => {
                truncated(formatter, small, *order, marks.as_ref())
            }
            Self::FirstOrderOnly { small } => write!(
                formatter,
                "truncated after {small}^1, the highest order for a force that is no polynomial; an expansion for small {small}"
            ),
            Self::TruncatedRelation { bookkeeping, order, linear_frequency } => {
                write!(formatter, "truncated after {bookkeeping}^{order}; ")?;
                root(formatter, *linear_frequency)
            }
            Self::Passes { passes, linear_frequency } => {
                write!(formatter, "after {passes} passes; ")?;
                root(formatter, *linear_frequency)
            }
            Self::Corrections { order: 1, embedding } => write!(
                formatter,
                "order 1: the first frequency alone, the terms without {embedding}"
            ),
            Self::Corrections { order, embedding } => {
                let highest = order - 1;
                let corrections = match highest {
                    1 => "one correction".to_owned(),
                    count => format!("{count} corrections"),
                };
                write!(
                    formatter,
                    "order {order}: the first frequency and {corrections}, truncated after {embedding}^{highest}"
                )
            }
        }
    }
}

fn truncated(
    formatter: &mut fmt::Formatter<'_>,
    small: &[Symbol],
    order: u32,
    marks: Option<&Expr>,
) -> fmt::Result {
    let names: Vec<&str> = small.iter().map(|name| name.written()).collect();
    let (first, others) = match names.split_first() {
        Some((first, others)) => (*first, others.join(" and ")),
        None => ("", String::new()),
    };
    let names = names.join(" and ");
    match (marks, small.len()) {
        (Some(value), 2..) => write!(
            formatter,
            "truncated after order {order} in {names} together; {first} marks the terms without {others}, which are taken to be small beside \
             the linear one too, and is {value} in this equation"
        ),
        (Some(value), _) => write!(
            formatter,
            "truncated after {names}^{order}; {names} marks all terms but the linear one, which are taken to be small, and is {value} in this equation"
        ),
        (None, 1) => {
            write!(formatter, "truncated after {names}^{order}; an expansion for small {names}")
        }
        (None, _) => write!(
            formatter,
            "truncated after order {order} in {names} together; an expansion for small {names}"
        ),
    }
}

fn root(formatter: &mut fmt::Formatter<'_>, linear_frequency: Option<Symbol>) -> fmt::Result {
    match linear_frequency {
        Some(name) => write!(
            formatter,
            "the frequency is the root that continues {name}^2 from {AMPLITUDE} = 0"
        ),
        None => formatter.write_str("the frequency is the root that continues the one of order 1"),
    }
}

impl fmt::Display for ExactFirstStep {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (terms, linear) = match self {
            Self::TermOfForce => ("one term", "force"),
            Self::TermOfEquation => ("one term", "equation"),
            Self::Harmonic => ("one harmonic", "force"),
        };
        write!(
            formatter,
            "{terms}: exact for a linear {linear}, the first step beyond it otherwise"
        )
    }
}

impl fmt::Display for ExactBy {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        if *self == Self::Linear {
            return formatter.write_str("exact: the equation is linear with constant coefficients");
        }
        formatter.write_str("exact wherever the motion is periodic")?;
        formatter.write_str(match self {
            Self::ClosedForm | Self::Linear => "",
            Self::EnergyQuadrature => ", by quadrature of the energy",
            Self::Quadrature => {
                ", by quadrature: no elliptic or Gamma function is known to give it"
            }
        })
    }
}

fn bounds(
    formatter: &mut fmt::Formatter<'_>,
    at_rest: &Expr,
    at_turning: &Expr,
    range: &BoundsHold,
) -> fmt::Result {
    if let BoundsHold::UpTo(place) = range {
        return write!(
            formatter,
            "{FREQUENCY}^2 lies between the least and the largest of f(x)/x: {at_rest} and {at_turning} up to {AMPLITUDE} = {}, \
             where f(x)/x turns back",
            decimal(*place)
        );
    }
    write!(formatter, "{FREQUENCY}^2 lies between {at_rest} and {at_turning}")?;
    if let BoundsHold::While { slope, coordinate, positive } = range {
        write!(formatter, " while {slope} keeps its sign for 0 < {coordinate} < {AMPLITUDE}")?;
        if let Some(letters) = positive {
            write!(formatter, ", as it does for positive {}", listed(letters))?;
        }
    }
    Ok(())
}

impl fmt::Display for Poles {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unknown => formatter.write_str(
                "where its denominator vanishes the quotient has a pole: none may lie between rest and the amplitude",
            ),
            Self::At { places, .. } if places.is_empty() => formatter.write_str("its denominator has no real zero"),
            Self::At { name, places } => {
                let places: Vec<String> = places.iter().map(|&place| decimal(place)).collect();
                write!(
                    formatter,
                    "poles at {name} = {}: none may lie between rest and the amplitude",
                    places.join(", ")
                )
            }
        }
    }
}

impl fmt::Display for FollowedRoot {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { variable, sign, crossings, ends } = self;
        let mut sentences = vec![];
        if !crossings.is_empty() {
            let places: Vec<String> = crossings.iter().map(|place| decimal(*place)).collect();
            sentences.push(format!(
                "the two roots cross at {variable} = {}: there {sign} changes its sign, and the root goes straight on",
                places.join(", ")
            ));
        }
        for (place, end) in ends {
            let why = match end {
                RootEnd::Meets => "where it meets the other one",
                RootEnd::Infinite => "where it is infinite",
            };
            sentences.push(format!("the root ends at {variable} = {}, {why}", decimal(*place)));
        }
        formatter.write_str(&sentences.join("; "))
    }
}

impl Position {
    /// Whether it is printed with a minus sign.
    pub fn is_negative(&self) -> bool {
        match self {
            Self::Exact(position) | Self::WhereReal(position) => position.has_leading_minus(),
            Self::Number(position) => *position < 0.0,
        }
    }
}

impl fmt::Display for Position {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Exact(position) => write!(formatter, "{position}"),
            Self::Number(position) => formatter.write_str(&decimal(*position)),
            Self::WhereReal(position) => {
                write!(formatter, "{position}, where that is real and stable")
            }
        }
    }
}

fn listed(items: &[impl ToString]) -> String {
    let items: Vec<String> = items.iter().map(ToString::to_string).collect();
    items.join(", ")
}
