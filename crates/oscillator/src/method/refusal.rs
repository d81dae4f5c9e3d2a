//! Why a method does not answer: each [`Reason`] with its words and a way forward, in one row.

use std::fmt;

use super::HIGHEST_ORDER;
use super::secular::SecularError;
use super::table::{Choice, MethodEntry, that_take};
use crate::exact::Polynomial;
use crate::expr::{Expr, ExprError, Node, Quotation};
use crate::oscillator::OscillatorError;
use crate::solution::{Advice, AmplitudeConvention, Degrees, Method, Setting, constant_in_words};
use crate::symbol::Symbol;
use crate::symbol::letters::{AMPLITUDE, FIRST_HARMONIC, FREQUENCY};

/// The reason why a method does not answer, and what to do instead.
#[derive(Clone, Debug, PartialEq)]
pub struct Refusal {
    /// The reason.
    pub reason: Reason,
    refuser: Option<Refuser>,
    pub(super) quoted: Option<Box<Quotation>>,
}

/// The reason of a refusal. The term of the equation, if there is one to name, is that of
/// [`Refusal::term`].
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Reason {
    /// The equation is not an oscillator, or cannot be expanded.
    Oscillator(OscillatorError),
    /// A parameter with the name of something in the answer.
    NameOfAnswer(Symbol),
    /// A self-excited oscillator whose amplitude the equation determines, asked for in powers of
    /// that amplitude.
    AmplitudeNotFree,
    /// A limit cycle exists or may exist, but not in closed form, for the reason in words.
    LimitCycle {
        /// The polynomial in z = amplitude^2 whose root is needed; `z_` where the equation has a z
        /// of its own.
        equation: Polynomial,
        /// The reason why that is not possible.
        reason: &'static str,
    },
    /// A self-excited oscillator without a limit cycle, and the polynomial in z = amplitude^2.
    NoLimitCycle(Polynomial),
    /// A limit cycle that the equation does not have: the number asked for, of so many.
    NoSuchCycle(u32, usize),
    /// The periodic expansion breaks down.
    Secular(SecularError),
    /// The quotient `f(x)/x` has no finite bounds.
    Unbounded(String),
    /// A force that is flat at half the amplitude.
    NoSlope(String),
    /// The algebra grew beyond this many terms.
    TooLong(usize),
    /// Degrees for which this kind of approximant does not exist.
    Approximant {
        /// The kind of approximant.
        method: Method,
        /// The degrees asked for.
        degrees: Degrees,
        /// The reason.
        reason: &'static str,
    },
    /// The order asked for is too high.
    Order {
        /// The order asked for.
        asked: u32,
        /// The highest order of what was asked for.
        limit: u32,
    },
    /// A step of algebra failed.
    Expression(ExprError),
    /// A term that takes energy out, or feeds it, so that no motion repeats.
    Damping {
        /// Whether it feeds energy for positive letters.
        feeds: bool,
    },
    /// A term that drives the motion in time.
    Forcing,
    /// A term with velocities, in a method for forces of position alone.
    Velocity,
    /// A method that measures the amplitude in one way only.
    Convention,
    /// A term that depends on time, but is not a single wave.
    NoWave,
    /// A second driving frequency.
    SecondDrive,
    /// A linear oscillator driven at its own frequency.
    ResonanceWithoutDamping,
    /// A resonance that the equation does not have to the order asked for.
    NoResonance {
        /// Omega : omega0 as asked for.
        asked: (u32, u32),
        /// The resonances that there are.
        others: Vec<(u32, u32)>,
    },
    /// There is no linear restoring force, and a term that the methods without one do not take.
    NoLinearForce {
        /// The linear force.
        force: Expr,
        /// Whether the term drives, and does not damp.
        drives: bool,
        /// Whether averaging takes the equation all the same, or would without the drive.
        averaged: bool,
    },
    /// A linear force that pushes away from the equilibrium that motions over several wells pass.
    PushesAway,
    /// A driving frequency far from every resonance that is known.
    FarFromResonance {
        /// Omega : omega0.
        ratio: f64,
        /// The nearest resonance.
        nearest: (u32, u32),
    },
    /// A method whose amplitude is that of the first harmonic only.
    ConventionOfFirstHarmonic,
    /// An even term of the force, in a method for odd forces.
    NotOdd,
    /// The force is not odd about an equilibrium that is not zero: the coordinate, and its value
    /// there.
    NotOddAbout(Symbol, Expr),
    /// A term of inertia that grows beyond all bounds towards the equilibrium, or has no value
    /// there: no motion passes it.
    NoInertiaAtRest,
    /// A series in several combinations of letters, in a method for one variable.
    SeveralVariables,
    /// An order beyond the highest that a method has.
    HighestOrder(u32),
    /// An order above the first, where one power alone restores.
    FirstOrderOfPower,
    /// An order in the amplitude below the lowest at which anything holds a motion that is damped
    /// or driven.
    BelowBalance(u32),
    /// An order below the lowest that a method has.
    LowestOrder(u32),
    /// A motion whose amplitude changes, measured at its start alone.
    SlowAmplitude,
    /// Slow equations among answers for periodic motions.
    NoSteadyAmplitude,
    /// A term whose projection on the first harmonic has no closed form.
    NoProjection,
    /// An option that says nothing to the method.
    NoSuchChoice(Choice),
    /// Terms of the force that are no polynomial, where one is needed.
    PolynomialOnly,
}

/// The subject of a refusal, which is unsuited.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refuser {
    /// A method, by its title.
    Method(Method),
    /// The expansion of Lindstedt and Poincare, whoever uses it.
    Expansion,
    /// The first order of that method for a force that is not a polynomial.
    FirstOrder,
}

impl fmt::Display for Refuser {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Method(method) => method.title(),
            Self::Expansion => "the method of Lindstedt and Poincare",
            Self::FirstOrder => "the first order of a force that is no polynomial",
        })
    }
}

/// Advice to follow any equation in numbers.
const IN_NUMBERS: &str = "in numbers any equation can be followed: `lindstedt simulate`";

impl Reason {
    /// The refusal of a method.
    pub fn to(self, method: Method) -> Refusal {
        self.refused_by(Refuser::Method(method))
    }

    /// The refusal of a method or a part of one.
    pub fn refused_by(self, refuser: Refuser) -> Refusal {
        Refusal { refuser: Some(refuser), ..self.into() }
    }
}

impl<T: Into<Reason>> From<T> for Refusal {
    fn from(reason: T) -> Self {
        Self { reason: reason.into(), refuser: None, quoted: None }
    }
}

impl From<OscillatorError> for Reason {
    fn from(error: OscillatorError) -> Self {
        Self::Oscillator(error)
    }
}

impl From<SecularError> for Reason {
    fn from(error: SecularError) -> Self {
        Self::Secular(error)
    }
}

impl From<ExprError> for Reason {
    fn from(error: ExprError) -> Self {
        Self::Expression(error)
    }
}

impl fmt::Display for Refusal {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(refuser) = self.refuser {
            write!(formatter, "{refuser} ")?;
        }
        formatter.write_str(&self.row().0)
    }
}

impl std::error::Error for Refusal {}

impl Refusal {
    /// Returns the refusal with the term that is the reason.
    pub(super) fn about(self, term: &Expr) -> Self {
        Self { quoted: Some(Box::new(term.clone().into())), ..self }
    }

    /// The refusal of a term that damps, or feeds, as it stands in the force.
    pub(super) fn damping(term: &Expr, refuser: Refuser) -> Self {
        // A product with a sum in it may both feed and damp.
        let written_out = term.expand();
        let feeds = written_out
            .is_ok_and(|written| written.terms().len() == 1 && written.has_leading_minus());
        Reason::Damping { feeds }.refused_by(refuser).about(term)
    }

    /// The message without the name of the method at its head, for lists that name it already.
    pub fn without_title(&self, method: Method) -> String {
        match self.refuser == Some(Refuser::Method(method)) {
            true => self.row().0,
            false => self.to_string(),
        }
    }

    /// The term that it names, where it names one of the equation.
    pub fn term(&self) -> Option<&str> {
        match &self.reason {
            Reason::Oscillator(error) => error.term(),
            _ => self.quoted.as_ref().map(|term| term.words()),
        }
    }

    /// A way forward, where one is known.
    pub fn help(&self) -> Option<Advice> {
        self.row().1
    }

    /// The words after the name of the refusing method, and a way forward.
    fn row(&self) -> (String, Option<Advice>) {
        let term = self.term().unwrap_or_default();
        let words = |words: &str| Advice::words(words);
        let a_try = |setting: Setting| words("try ").choose(setting);
        let by_method = |method: Method| a_try(Setting::Method(method));
        let of_order = |order: u32| a_try(Setting::Order(order));
        let leave_out = |amplitude| words("leave out ").choose(Setting::Amplitude(amplitude));
        let lower_order = || words("try a lower order");
        let (text, help) = match &self.reason {
            Reason::Oscillator(error) => return (error.to_string(), error.help()),
            Reason::Expression(error) => return (error.to_string(), None),
            Reason::NameOfAnswer(name) => (
                format!("`{name}` in the equation has the name of the amplitude or the frequency in the answer"),
                Advice::words(format!("give it another name, such as `{name}1`")),
            ),
            Reason::AmplitudeNotFree => (
                format!("the term `{term}` feeds or drains energy, so the amplitude is not free and nothing can be expanded in it"),
                words("limit cycles start from x'' + omega0^2*x with all other terms small: do not ask for `")
                    .choose(Setting::Small(AmplitudeConvention::Initial.symbol()))
                    .then("`, and write a polynomial such as x - eps*x^3/6 for sin(x)"),
            ),
            Reason::LimitCycle { equation, reason } => {
                let text = format!("the amplitude of the limit cycle follows from `{equation} = 0`, {reason}");
                // Numbers alone do not help where there are numbers already.
                let help = (equation.symbols().len() > 1).then(|| {
                    words("give numbers for the parameters in it, in the equation or by `")
                        .choose(Setting::Values)
                        .then("`")
                });
                return (text, help);
            }
            Reason::NoLimitCycle(equation) => (
                format!("no limit cycle to first order: `{equation} = 0` has no positive root z = amplitude^2"),
                words("energy is fed at every amplitude or drained at every amplitude: no motion repeats; try ")
                    .choose(Setting::Method(Method::Averaging))
                    .then(" for how it grows or decays"),
            ),
            Reason::NoSuchCycle(asked, count) => (
                format!("there is no limit cycle number {asked}: the equation has {count} to leading order"),
                words("they are counted from 1, the smallest first"),
            ),
            Reason::Secular(error) => (format!("no periodic expansion: {error}"), lower_order()),
            Reason::Unbounded(quotient) => (
                format!("max-min needs bounds of f(x)/x, but none was found at rest for `{quotient}`"),
                by_method(Method::Hamiltonian),
            ),
            Reason::NoSlope(force) => (
                format!("the slope of `{force}` at x = {AMPLITUDE}/2 is zero, so the formula gives no frequency"),
                by_method(Method::Hamiltonian),
            ),
            Reason::TooLong(terms) => (format!("stopped at {terms} terms in one coefficient"), lower_order()),
            Reason::Approximant { method, degrees, reason } => {
                let other = match method {
                    Method::HermitePade => Degrees::Quadratic(2, 2, 2),
                    _ => Degrees::Quotient(1, 1),
                };
                (
                    format!("no {} of degrees {degrees}: {reason}", method.title()),
                    words("try other degrees, such as ").choose(Setting::Degrees(other)),
                )
            }
            Reason::Order { asked, limit } => (
                format!("order {asked} is above the limit of {limit}"),
                match *limit {
                    HIGHEST_ORDER => words("try a lower order, or `--omega-only`, whose limit is higher"),
                    _ => lower_order(),
                },
            ),
            Reason::Damping { feeds } => {
                let (does, fate, course) =
                    if *feeds { ("feeds", "grows", "growth") } else { ("damps", "dies out", "decay") };
                (
                    format!("needs a periodic motion, but the term `{term}` {does} it"),
                    Advice::words(format!("there is no frequency-amplitude law of a motion that {fate}; try "))
                        .choose(Setting::Method(Method::Averaging))
                        .then(format!(" for its {course}, or leave the term out to get the law of the undamped motion")),
                )
            }
            Reason::Forcing => (
                format!("is for free vibrations, but the term `{term}` drives the motion"),
                words("leave the term out to get the frequency of the free vibration (the backbone curve), or try ")
                    .choose(Setting::Method(Method::MultipleScales)),
            ),
            Reason::Velocity => (
                format!("is for forces of the position alone, but `{term}` depends on the velocity"),
                by_method(Method::LindstedtPoincare),
            ),
            Reason::Convention => (
                format!("measures the amplitude as {AMPLITUDE} = x(0)"),
                leave_out(AmplitudeConvention::FirstHarmonic),
            ),
            Reason::NoWave => (
                format!("takes drives such as F*cos(Omega*t) and h*x*cos(Omega*t), but `{term}` is no such wave, periodic in time"),
                words(IN_NUMBERS),
            ),
            Reason::SecondDrive => (
                format!("takes drives whose frequencies are small multiples of one, but that of the term `{term}` and of the first are none that is known"),
                words("write both as multiples of one letter or number, such as cos(W*t) and cos(3*W*t); without such a ratio the first order of a drive near omega0 is derived, where a letter such as eps makes all nonlinear terms small, none is quadratic, and the other drives are forces far from every resonance; ")
                    .then(IN_NUMBERS),
            ),
            Reason::ResonanceWithoutDamping => (
                format!("finds no steady motion: the term `{term}` drives at the linear frequency, and nothing damps or detunes the motion"),
                words("the amplitude grows in proportion to time, x = (F/(2*omega0))*t*sin(omega0*t) for F*cos(omega0*t); give a damping such as 2*zeta*x'"),
            ),
            Reason::NoResonance { asked: (p, q), others } => {
                let names: Vec<String> = others.iter().map(|(p, q)| format!("{p}:{q}")).collect();
                let at = if names.is_empty() { String::new() } else { format!("; it does at {}", names.join(", ")) };
                (
                    format!("finds nothing at this order by which the drive would reach the motion at {p}:{q}{at}"),
                    others.first().map_or(words(IN_NUMBERS), |&(p, q)| a_try(Setting::Resonance(p, q))),
                )
            }
            Reason::NoLinearForce { force, drives, averaged } => (
                format!("needs a linear restoring force omega0^2*x with omega0^2 > 0, but it is `{force}`; methods that need none do not take the term `{term}`"),
                match (drives, averaged) {
                    (true, _) => words("in numbers `lindstedt response` finds the steady states of a drive that repeats itself; without the term try "),
                    (false, true) => words("the true motion of one power of the coordinate can be averaged: try "),
                    (false, false) => words("in numbers `lindstedt simulate` follows the motion from any start; without the term try "),
                }
                .choose(Setting::Method(if *averaged { Method::Averaging } else { Method::Exact })),
            ),
            Reason::PushesAway => (
                format!("expands about a linear force that pulls back, but `{term}` pushes away"),
                words("take the force as it is: try ")
                    .choose(Setting::Method(Method::Exact))
                    .then(" or ")
                    .choose(Setting::Method(Method::HarmonicBalance)),
            ),
            Reason::FarFromResonance { ratio, nearest: (p, q) } => {
                let ratio = crate::decimal::significant(*ratio, 4);
                (
                    format!("needs a drive near a resonance, but Omega : omega0 = {ratio} is far from {p}:{q}, the nearest that it finds"),
                    words("in numbers `lindstedt response` finds the steady states at any frequency; the formulas of a resonance are those of ")
                        .choose(Setting::Resonance(*p, *q)),
                )
            }
            Reason::ConventionOfFirstHarmonic => (
                "measures the amplitude as that of the first harmonic, a".to_owned(),
                leave_out(AmplitudeConvention::Initial),
            ),
            Reason::NotOdd | Reason::NotOddAbout(..) => (
                match &self.reason {
                    Reason::NotOddAbout(coordinate, position) => format!(
                        "is for forces that are odd about the equilibrium, but `{term}` is not odd about {coordinate} = {}",
                        constant_in_words(position)
                    ),
                    _ => format!("is for forces with f(-x) = -f(x), but `{term}` is not odd"),
                },
                by_method(Method::HarmonicBalance).then(", which balances the drift as well"),
            ),
            Reason::NoInertiaAtRest => (
                format!("needs inertia that has a value at the equilibrium, but with the term `{term}` it has none"),
                words("no swing about that place is known; in numbers `lindstedt simulate` follows the motion up to it"),
            ),
            Reason::SeveralVariables => (
                format!("needs a series in one variable, but the symbols of {FREQUENCY}^2 enter in several combinations"),
                words("give numbers for them, in the equation or by `")
                    .choose(Setting::Values)
                    .then("`, or try ")
                    .choose(Setting::Method(Method::Pade)),
            ),
            Reason::HighestOrder(highest) => (format!("has no order above {highest}"), of_order(*highest)),
            Reason::FirstOrderOfPower => (
                format!("goes along the true motion of the force `{term}`, which it knows to order 1 alone"),
                of_order(1).then(", which holds at any amplitude; in numbers `lindstedt simulate` follows the motion"),
            ),
            Reason::BelowBalance(lowest) => (
                format!("needs order {lowest} in the amplitude here: below it no damping, no detuning and no nonlinear term holds the motion"),
                of_order(*lowest),
            ),
            Reason::LowestOrder(lowest) => (format!("has no order below {lowest}"), of_order(*lowest)),
            Reason::SlowAmplitude => (
                format!("measures an amplitude that changes by the first harmonic: {FIRST_HARMONIC}, which begins at {AMPLITUDE}"),
                leave_out(AmplitudeConvention::Initial),
            ),
            Reason::NoSteadyAmplitude => (
                "gives an amplitude that changes, and no closed form of one that stays".to_owned(),
                words("give numbers for the parameters, in the equation"),
            ),
            Reason::NoProjection => (
                format!("knows no closed form for the first harmonic of `{term}`"),
                match self.quoted.as_deref().is_some_and(turns_with_both) {
                    true => words("a function of x and x' together has none; in factors of their own both have one, as sgn(x)*sgn(x') for sgn(x*x'); ")
                        .then(IN_NUMBERS),
                    false => words("powers of x and x', their sizes and signs, and (2/pi)*atan(k*x') have one"),
                },
            ),
            Reason::NoSuchChoice(choice) => (
                format!("takes no {}", choice.words()),
                Advice::words(format!("it belongs to {}", that_take(*choice))),
            ),
            Reason::PolynomialOnly => (
                format!("needs a polynomial force at this order, not `{term}`"),
                match self.refuser {
                    Some(Refuser::Method(Method::IterationPerturbation)) => of_order(1)
                        .then(", which takes any force, or ")
                        .choose(Setting::Method(Method::HomotopyPerturbation)),
                    Some(Refuser::Method(Method::LindstedtPoincare)) => {
                        of_order(1).then(", which takes this force as it is")
                    }
                    refuser => {
                        let as_it_is = ", which takes a force as it is where its first harmonic has a closed form";
                        match refuser.is_some_and(takes_taylor) && self.quoted.as_deref().is_some_and(is_smooth) {
                            true => of_order(1).then(as_it_is).then(", or ").choose(Setting::Taylor),
                            false => of_order(1).then(as_it_is),
                        }
                    }
                },
            ),
        };
        (text, Some(help))
    }
}

/// Whether a Taylor polynomial may stand for the force in a method.
fn takes_taylor(refuser: Refuser) -> bool {
    match refuser {
        Refuser::Method(method) => MethodEntry::for_method(method).takes(Choice::Taylor),
        Refuser::Expansion | Refuser::FirstOrder => false,
    }
}

/// Whether a term has no corner.
fn is_smooth(term: &Quotation) -> bool {
    use crate::expr::Function::{Absolute, Maximum, Minimum, Sign, Step};
    let corners = [Absolute, Maximum, Minimum, Sign, Step];
    !corners.into_iter().any(|corner| term.expression().contains_function(corner))
}

/// Whether a function in a term depends on a coordinate and its velocity both.
fn turns_with_both(term: &Quotation) -> bool {
    let both = |part: &Expr| part.symbols().iter().any(|name| part.contains(name.derivative()));
    let functions = |part: &&Expr| matches!(part.node(), Node::Function(..));
    term.expression().unique_nodes().filter(functions).any(both)
}
