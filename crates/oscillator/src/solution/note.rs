//! Notes on an answer beside its formulas: its truncation, the parts left out, its validity.

use std::fmt;

use num_traits::One as _;

pub use super::linear_drive::LinearDrive;
use super::{Definition, Degrees, LeadingCycle, Method};
use crate::decimal::decimal;
use crate::exact::{Monomial, Polynomial, Rational};
use crate::expr::Expr;
use crate::symbol::Symbol;
use crate::symbol::letters::{AMPLITUDE, FIRST_HARMONIC, FREQUENCY};

/// One statement about an answer; printed, it is a sentence.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Note {
    /// A motion of one term, or a balance of one harmonic: exact for what is linear.
    FirstStep(ExactFirstStep),
    /// A one-term motion whose equation is met at one instant.
    Collocated(CollocationInstant),
    /// A symbol that the answer writes with another letter than usual, because the equation uses
    /// the usual one.
    OtherLetter {
        /// The usual letter: `A`, `a` or `omega`.
        usual: Symbol,
        /// The letter in this answer.
        written: Symbol,
        /// Whether the coordinate of the equation has the usual letter; otherwise a parameter has
        /// it.
        is_coordinate: bool,
    },
    /// A parameter whose name looks like something else.
    Misleading {
        /// The parameter.
        name: Symbol,
        /// The form to write instead.
        instead: String,
    },
    /// The slope of the force at half the amplitude.
    SlopeAtHalf,
    /// The part of the force that a motion of one term leaves out.
    EvenPartLeftOut(Expr),
    /// The truncation of the expansion.
    Cut(Truncation),
    /// The motion is left at its leading term.
    MotionAtLeadingOrder {
        /// The small parameter.
        small: Symbol,
    },
    /// The convergence-control parameter has no value yet.
    ConvergenceControl(Symbol),
    /// The force entered as a polynomial.
    TaylorPolynomial {
        /// Its degree.
        degree: u32,
    },
    /// The motion has harmonics above the last that is written.
    MotionCutAfter {
        /// The last harmonic.
        harmonic: usize,
    },
    /// The harmonics of a balance.
    Balanced {
        /// The harmonics that are kept.
        harmonics: Vec<usize>,
        /// Whether numbers alone solve it.
        by_numbers: bool,
    },
    /// The arcs in the equations of a balance.
    ArcsFor {
        /// The coefficient that is taken to be positive.
        positive: Symbol,
    },
    /// The bounds between which omega^2 lies.
    Bounds {
        /// `f(x)/x` at rest.
        at_rest: Expr,
        /// `f(x)/x` at the turning point.
        at_turning: Expr,
        /// The amplitudes for which it holds.
        range: BoundsHold,
    },
    /// The order through which a quotient agrees with its series.
    AgreesThrough {
        /// The degrees.
        degrees: Degrees,
        /// The symbol of the series.
        small: Symbol,
        /// The power of the symbol that one degree counts: 1 or 2.
        step: u32,
        /// The degree through which they agree.
        order: u32,
    },
    /// The series of omega^2 has no singularity, as far as its coefficients show.
    ConvergesEverywhere {
        /// The variable of the series.
        variable: Monomial,
        /// The highest power of it that was looked at.
        highest: usize,
        /// The last power of it that is there, where the series ends.
        last: Option<Monomial>,
    },
    /// The real zeros of the denominator of a quotient.
    Poles(Poles),
    /// The continuation from rest of the root of a quadratic equation, if the formula alone does
    /// not determine it.
    Followed(FollowedRoot),
    /// A resummation has the motion of the series to its first correction.
    MotionOfSeries,
    /// The motion is written by elliptic functions.
    EllipticFunctions,
    /// The law is exact.
    Exact(ExactBy),
    /// Whether the limit cycle attracts.
    Stability(LeadingCycle),
    /// The amplitude of a limit cycle has no closed form.
    RoundedAmplitude {
        /// The amplitude.
        amplitude: Symbol,
        /// Its square.
        square: Symbol,
        /// The polynomial in the square that is zero.
        polynomial: Polynomial,
    },
    /// A driven motion: which resonance, and what counts as small beside the small parameters.
    Driven {
        /// Omega : omega0.
        resonance: (u32, u32),
        /// Whether the drive is in a coefficient.
        parametric: bool,
        /// Ratio to omega0 of the drive in resonance among several; `None` if only sums and
        /// differences of them are in resonance.
        nearest: Option<(u32, u32)>,
        /// The small quantities.
        small: Vec<Expr>,
        /// The power of the small parameter as which it counts.
        power: usize,
    },
    /// A drive against dry friction: below the least force there is no steady motion.
    LeastForce {
        /// The drive.
        force: Expr,
        /// The least force.
        least: Expr,
    },
    /// The equation of the steady amplitudes, if they are not written down.
    SteadyAmplitudes {
        /// The square of the amplitude.
        square: Symbol,
        /// The polynomial of which it is a root.
        polynomial: Polynomial,
        /// The reason why they are not written down.
        reason: &'static str,
    },
    /// Viscous damping of a motion in a force that is not linear.
    Action {
        /// The coefficient of the velocity.
        rate: Expr,
        /// Whether it is the pendulum, whose action is known.
        pendulum: bool,
    },
    /// Dry friction on a motion in a force that is not linear.
    HalfSwings {
        /// The potential energy at a turning point less that at the next.
        lost: Expr,
        /// The coefficient of the sign of the velocity.
        size: Expr,
    },
    /// An average along the true motion without damping, whose shape is the same at every
    /// amplitude.
    AlongTrueMotion {
        /// The last harmonic that is written.
        harmonic: usize,
    },
    /// A motion whose amplitude grows, because no term dissipates energy.
    Grows,
    /// The motion relative to a base that moves.
    RelativeCoordinate {
        /// The relative coordinate.
        relative: Symbol,
        /// The coordinate of the equation.
        coordinate: Symbol,
        /// The motion of the base.
        base: Expr,
    },
    /// Drives far from resonance beside the one near the linear frequency, without a ratio to it.
    ForcedWaves {
        /// The frequency near the linear one.
        near: Expr,
        /// The others.
        far: Vec<Expr>,
    },
    /// A linear oscillator under a drive.
    LinearDrive(LinearDrive),
    /// An order that a method chosen by default does not reach.
    HighestOrderHere {
        /// The order asked for.
        asked: u32,
        /// The order given.
        given: u32,
    },
    /// A method in place of the one that usually answers where none is asked for.
    InsteadOf {
        /// The usual one.
        usual: Method,
        /// The reason why it does not answer.
        reason: String,
    },
    /// The expansion runs in the amplitude although a parameter might have been small, so that it
    /// contains the effect of quadratic terms.
    QuadraticTerms,
    /// A first order, which does not contain the effect of quadratic terms.
    QuadraticTermsLeftOut,
    /// A driven motion to an order too low for any nonlinear term.
    NonlinearTermsLeftOut,
    /// The expansion was stopped before the order asked for.
    Stopped {
        /// The order asked for.
        asked: u32,
    },
    /// A definition whose value is taken to be positive.
    Positive(Definition),
    /// An expansion of a force with corners.
    Corners,
    /// The sides of corners at rest that depend on the sign of a parameter.
    CornerSides(Vec<CornerSide>),
    /// A force that is infinite at rest, as `1/x`, with a potential that is minus infinity there.
    EndlessPotential {
        /// The coordinate.
        coordinate: Symbol,
    },
    /// The equilibrium about which the motion swings.
    Equilibrium {
        /// The coordinate.
        coordinate: Symbol,
        /// Its value there.
        position: Position,
    },
    /// Motions through an unstable equilibrium, over the wells on both sides of it.
    CrossWell(CrossWell),
    /// The coefficients are rounded to fifteen digits.
    RoundedCoefficients,
    /// A sentence taken from a document.
    Stated(String),
}

/// The truncation of an expansion.
#[derive(Clone, Debug, PartialEq)]
pub enum Truncation {
    /// After a power of what is small.
    Truncated {
        /// The small parameters, counted together.
        small: Vec<Symbol>,
        /// The highest power kept.
        order: u32,
        /// The value of a small parameter that marks terms of an equation without one.
        marks: Option<Expr>,
    },
    /// The first order of a force that is not a polynomial.
    FirstOrderOnly {
        /// The small parameter.
        small: Symbol,
    },
    /// A relation, after a power of a bookkeeping parameter.
    TruncatedRelation {
        /// The bookkeeping parameter.
        bookkeeping: Symbol,
        /// The highest power kept.
        order: u32,
        /// The linear frequency, where the root starts; `None` if rest is unstable, and it starts
        /// at the first order.
        linear_frequency: Option<Symbol>,
    },
    /// A relation after this many passes of an iteration.
    Passes {
        /// Number of passes.
        passes: u32,
        /// The linear frequency, where the root starts; `None` if rest is unstable, and it starts
        /// at the first order.
        linear_frequency: Option<Symbol>,
    },
    /// After this many corrections of the first frequency.
    Corrections {
        /// One more than the number of corrections.
        order: u32,
        /// The embedding parameter.
        embedding: Symbol,
    },
}

/// The equations for which a first step is exact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExactFirstStep {
    /// One term in a force.
    TermOfForce,
    /// One term in an equation whose inertia depends on the position.
    TermOfEquation,
    /// One harmonic in a force.
    Harmonic,
}

/// The instant at which a motion of one term satisfies its equation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CollocationInstant {
    /// An eighth of the period.
    EighthOfPeriod,
    /// The square of the cosine is three quarters.
    CosineSquared,
}

/// The amplitudes for which omega^2 lies between the values of `f(x)/x` at rest and at the turning
/// point.
#[derive(Clone, Debug, PartialEq)]
pub enum BoundsHold {
    /// All amplitudes.
    Always,
    /// As long as the slope of `f(x)/x` keeps its sign.
    While {
        /// The slope.
        slope: Expr,
        /// The coordinate.
        coordinate: Symbol,
        /// Parameters that need only be positive for that.
        positive: Option<Vec<Symbol>>,
    },
    /// Amplitudes up to the extremum of `f(x)/x`.
    UpTo(f64),
}

/// The real zeros of a denominator.
#[derive(Clone, Debug, PartialEq)]
pub enum Poles {
    /// The range depends on several symbols.
    Unknown,
    /// These values of one product of symbols; none where there are none.
    At {
        /// The product.
        name: Expr,
        /// The zeros, those of least size first.
        places: Vec<f64>,
    },
}

/// The continuation of a root of a quadratic equation from rest.
#[derive(Clone, Debug, PartialEq)]
pub struct FollowedRoot {
    /// The variable of the coefficients of the equation.
    pub variable: Expr,
    /// The symbol in front of the square root.
    pub sign: Symbol,
    /// Points at which both roots cross, the nearest first.
    pub crossings: Vec<f64>,
    /// Points at which the root ends, and why.
    pub ends: Vec<(f64, RootEnd)>,
}

/// The reason why a root ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RootEnd {
    /// The root meets the other one.
    Meets,
    /// The root is infinite.
    Infinite,
}

/// The form of an exact law.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExactBy {
    /// In closed form.
    ClosedForm,
    /// Quadrature of the energy with a position-dependent inertia.
    EnergyQuadrature,
    /// Quadrature, for want of a closed form.
    Quadrature,
    /// Solution of a linear equation.
    Linear,
}

/// A corner of a force whose side at rest depends on the sign of a parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct CornerSide {
    /// The parameter or expression that is taken to be positive.
    pub positive: Expr,
    /// The function with the corner: `max(0, d + x)`.
    pub corner: Expr,
    /// The branch of the function near rest.
    pub taken: Expr,
}

/// An equilibrium in the usual form.
#[derive(Clone, Debug, PartialEq)]
pub enum Position {
    /// In closed form.
    Exact(Expr),
    /// A numerical value.
    Number(f64),
    /// In closed form, where its value depends on parameters.
    WhereReal(Expr),
}

/// Motions of an odd force through an unstable equilibrium, over the wells on both sides of it.
#[derive(Clone, Debug, PartialEq)]
pub struct CrossWell {
    /// The coordinate.
    pub coordinate: Symbol,
    /// The unstable equilibrium.
    pub equilibrium: Expr,
    /// The amplitude that they exceed; `None` if it has no closed form in the parameters.
    pub from: Option<Position>,
    /// The end of the range of amplitudes.
    pub to: CrossWellEnd,
    /// Whether there are others farther out, over hilltops between other wells.
    pub others: bool,
    /// The parameters that are taken to be positive.
    pub positive: Vec<Symbol>,
}

/// The end of the range of motions over several wells.
#[derive(Clone, Debug, PartialEq)]
pub enum CrossWellEnd {
    /// The range does not end.
    Never,
    /// The end at this amplitude.
    At(Position),
    /// The range ends at an amplitude that depends on the values of parameters.
    Somewhere,
}

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

impl Note {
    /// Adapts the note to motions that do not begin at rest: the root of a relation is then the one
    /// that continues the first order.
    pub(crate) fn take_root_of_first_order(&mut self) {
        if let Self::Cut(
            Truncation::TruncatedRelation { linear_frequency, .. }
            | Truncation::Passes { linear_frequency, .. },
        ) = self
        {
            *linear_frequency = None;
        }
    }
}

const SLOPE_AT_HALF: &str =
    "one line: exact for linear forces, and to first order for cubic ones alone";
const MOTION_OF_SERIES: &str = "the motion is that of Lindstedt-Poincare to its first correction";
const CORNERS: &str =
    "the force has corners: the expansion holds for motions that stay before the nearest";
const ROUNDED_COEFFICIENTS: &str =
    "numerical coefficients, rounded to 15 digits: the equilibrium is no fraction";

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
