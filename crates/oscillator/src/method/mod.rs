//! The methods: each takes an [`Oscillator`] and options, and gives a [`Solution`] or a
//! [`Refusal`].
//!
//! In comes the equation with its [`Options`]; [`solve`] looks at it from its equilibrium and asks
//! the method of the table. Out goes a law and a motion with exact coefficients, the notes on where
//! they hold and the derivation; or the reason why not, with the term in the way and [`Advice`] on
//! what to try. At numbers, [`numbers`] gives the frequency and the motion of any answer.
//!
//! One file per method, each opening with its reference and equations. To add one: write its file
//! with a function `solve(&Oscillator, &Options) -> Result<Solution, Refusal>`, give it a name in
//! [`Method`] and a row in [`table::METHODS`].

pub(crate) mod amplitude_frequency;
pub mod averaging;
pub(crate) mod balance;
mod base_motion;
mod default_method;
mod drive;
mod driven_answer;
pub(crate) mod energy_balance;
pub(crate) mod exact;
mod exact_motion;
pub(crate) mod expansion;
pub(crate) mod first_order;
mod forced_waves;
pub(crate) mod frequency_formula;
mod frequency_response;
pub(crate) mod hamiltonian;
pub(crate) mod harmonic_balance;
pub(crate) mod hermite_pade;
pub mod homotopy_analysis;
pub(crate) mod homotopy_perturbation;
pub mod inertia;
pub(crate) mod iteration_perturbation;
pub(crate) mod joint_expansion;
pub(crate) mod limit_cycle;
pub(crate) mod lindstedt_poincare;
mod linear;
pub(crate) mod max_min;
pub mod motion;
pub mod multiple_scales;
pub mod numbers;
pub(crate) mod one_term;
pub(crate) mod pade;
pub(crate) mod parameter_expansion;
pub mod power_series;
mod quotation;
mod resonance;
pub mod secular;
pub mod table;
pub(crate) mod transient;
pub(crate) mod variational_iteration;

pub use default_method::default_method;
pub use harmonic_balance::MOST_HARMONICS;

pub use resonance::with_resonance_at;

pub use crate::conservative::{Force, cosine_coefficient, is_odd, is_smooth, potential};
pub use crate::equilibrium::with_numbers_where_needed;

use std::collections::BTreeMap;
use std::fmt;

use num_traits::Zero;
use table::{Choice, Entry, that_take};

use crate::equilibrium::{Centred, centred, stable_elsewhere};
use crate::exact::{POLYNOMIALS, Polynomial};
use crate::expr::{Expr, ExprError, NAMES_OF_ANSWERS, Node, Quotation};
use crate::interrupt::Supervision;
use crate::oscillator::corner::near_rest;
use crate::oscillator::{Oscillator, OscillatorError, SmallParameter};
use crate::series::FourierSeries;
use crate::series::taylor::TaylorError;
use crate::solution::{
    Advice, AmplitudeConvention, Degrees, Method, Note, Setting, Solution, constant_in_words,
    note::Position,
};
use crate::symbol::letters::{AMPLITUDE, FIRST_HARMONIC, FREQUENCY};
use crate::symbol::{Symbol, fresh};

/// The highest order any method accepts.
pub const HIGHEST_ORDER: u32 = 400;

/// The highest order of the [frequency alone](Options::frequency_alone), whose coefficients are
/// fewer.
pub const HIGHEST_ORDER_OF_FREQUENCY: u32 = 2000;

/// What a user may choose; `None` leaves the choice to the method.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Options {
    /// The method.
    pub method: Option<Method>,
    /// Highest power of the small parameter, inclusive.
    pub order: Option<u32>,
    /// The meaning of the amplitude.
    pub amplitude: Option<AmplitudeConvention>,
    /// The name of the small parameter; `A` or `a` for the amplitude.
    pub small: Option<String>,
    /// Degree of the Taylor polynomial by which homotopy methods replace the force.
    pub taylor: Option<u32>,
    /// The degrees of an approximant.
    pub degrees: Option<Degrees>,
    /// The convergence-control parameter of homotopy analysis; a symbol that numbers are chosen for
    /// where it is not given.
    pub hbar: Option<Expr>,
    /// Which limit cycle of a self-excited equation, counted from one by amplitude; without it the
    /// smallest that attracts.
    pub cycle: Option<u32>,
    /// Which resonance of a driven motion, Omega : omega0; without it the nearest to frequencies in
    /// numbers, or the primary one, 2:1 where the drive is in a coefficient. Both are whole numbers
    /// from 1 to 9.
    pub resonance: Option<(u32, u32)>,
    /// The frequency without the motion, to a [higher order](HIGHEST_ORDER_OF_FREQUENCY) in less
    /// time.
    pub frequency_alone: bool,
    /// Who may stop a long expansion, which then ends with the orders that there are.
    ///
    /// ```
    /// # use lindstedt_oscillator as lindstedt;
    /// use lindstedt::{Counter, Interrupt, Options, Oscillator, Progress, Supervision, solve};
    /// use std::sync::atomic::AtomicBool;
    ///
    /// // Stopped before it begins: the orders that need no long work are there.
    /// static STOP: AtomicBool = AtomicBool::new(true);
    /// static COUNTER: Counter = Counter::new();
    /// let supervision = Supervision { interrupt: Interrupt::by(&STOP), progress: Progress::by(&COUNTER) };
    /// let options = Options { order: Some(300), frequency_alone: true, supervision, ..Options::default() };
    /// let solution = solve(&Oscillator::parse("x'' - mu*(1 - x^2)*x' + x = 0")?, &options)?;
    /// assert!((1..300).contains(&solution.order));
    /// assert!(solution.validity.iter().any(|note| note.to_string().contains("stopped")));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub supervision: Supervision,
}

impl Options {
    /// Whether it is said what is small, or how far to go in it: by an option, or by a letter that
    /// is called `eps`.
    fn say_what_is_small(&self, oscillator: &Oscillator) -> bool {
        self.small.is_some()
            || self.order.is_some()
            || oscillator.parameters.contains(&Symbol::new("eps"))
    }
}

/// Why a method does not answer, and what to do instead.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Refusal {
    /// The equation is no oscillator, or cannot be expanded.
    #[error(transparent)]
    Oscillator(#[from] OscillatorError),
    /// A parameter with the name of something in the answer.
    #[error("`{0}` in the equation has the name of the amplitude or the frequency in the answer")]
    NameOfAnswer(Symbol),
    /// The method is not for this equation, or not for what was asked of it.
    #[error("{refuser} {reason}")]
    Unsuited {
        /// The method.
        refuser: Refuser,
        /// Why not.
        reason: Unsuited,
    },
    /// A self-excited oscillator whose amplitude the equation determines, asked for in powers of
    /// that amplitude.
    #[error(
        "the term `{term}` feeds or drains energy, so the amplitude is not free and nothing can be expanded in it"
    )]
    AmplitudeNotFree {
        /// The term.
        term: Quotation,
    },
    /// A limit cycle exists or may exist, but not in closed form.
    #[error("the amplitude of the limit cycle follows from `{equation} = 0`, {reason}")]
    LimitCycle {
        /// The polynomial in z = amplitude^2 whose root is needed; `z_` where the equation has a z
        /// of its own.
        equation: Polynomial,
        /// Why that is not possible.
        reason: &'static str,
    },
    /// A self-excited oscillator without a limit cycle.
    #[error("no limit cycle to first order: `{equation} = 0` has no positive root z = amplitude^2")]
    NoLimitCycle {
        /// The polynomial in z.
        equation: Polynomial,
    },
    /// A limit cycle that the equation does not have.
    #[error("there is no limit cycle number {asked}: the equation has {count} to leading order")]
    NoSuchCycle {
        /// The number asked for.
        asked: u32,
        /// How many there are.
        count: usize,
    },
    /// The periodic expansion breaks down.
    #[error("no periodic expansion: {0}")]
    Secular(#[from] secular::SecularError),
    /// `f(x)/x` has no finite bounds.
    #[error("max-min needs bounds of f(x)/x, but none was found at rest for `{quotient}`")]
    Unbounded {
        /// f(x)/x.
        quotient: String,
    },
    /// A force that is flat at half the amplitude.
    #[error(
        "the slope of `{force}` at x = {}/2 is zero, so the formula gives no frequency",
        AMPLITUDE
    )]
    NoSlope {
        /// The force.
        force: String,
    },
    /// The algebra grew beyond reason.
    #[error("stopped at {terms} terms in one coefficient")]
    TooLong {
        /// The limit.
        terms: usize,
    },
    /// Degrees for which no approximant exists.
    #[error("no {} of degrees {degrees}: {reason}", method.title())]
    Approximant {
        /// The kind of approximant.
        method: Method,
        /// The degrees asked for.
        degrees: Degrees,
        /// Why.
        reason: &'static str,
    },
    /// The order asked for is too high.
    #[error("order {asked} is above the limit of {limit}")]
    Order {
        /// The order asked for.
        asked: u32,
        /// The highest order of what was asked for.
        limit: u32,
    },
    /// A step of algebra failed.
    #[error("{0}")]
    Expression(#[from] ExprError),
}

/// Why a method is not for an equation, or not for what was asked of it.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Unsuited {
    /// Terms that take energy out, or feed it, so that no motion repeats.
    #[error("needs a periodic motion, but the term `{term}` {}", if *.feeds { "feeds it" } else { "damps it" })]
    Damping {
        /// The damping term.
        term: Quotation,
        /// Whether it feeds energy for positive letters.
        feeds: bool,
    },
    /// Terms that drive the motion in time.
    #[error("is for free vibrations, but the term `{term}` drives the motion")]
    Forcing {
        /// The forcing term.
        term: Quotation,
    },
    /// Terms with velocities, in a method for forces of position alone.
    #[error("is for forces of the position alone, but `{term}` depends on the velocity")]
    Velocity {
        /// The term.
        term: Quotation,
    },
    /// A method that measures the amplitude in one way only.
    #[error("measures the amplitude as {} = x(0)", AMPLITUDE)]
    Convention,
    /// A term that depends on time, but is no single wave.
    #[error(
        "takes drives such as F*cos(Omega*t) and h*x*cos(Omega*t), but `{term}` is no such wave, periodic in time"
    )]
    NoWave {
        /// The term.
        term: Quotation,
    },
    /// A second driving frequency.
    #[error(
        "takes drives whose frequencies are small multiples of one, but that of the term `{term}` and of the first are none that is known"
    )]
    SecondDrive {
        /// The term.
        term: Quotation,
    },
    /// A linear oscillator driven at its own frequency.
    #[error(
        "finds no steady motion: the term `{term}` drives at the linear frequency, and nothing damps or detunes the motion"
    )]
    ResonanceWithoutDamping {
        /// The drive.
        term: Quotation,
    },
    /// A resonance that the equation does not have to the order asked for.
    #[error(
        "finds nothing at this order by which the drive would reach the motion at {}:{}{}",
        asked.0, asked.1, resonances(others)
    )]
    NoResonance {
        /// Omega : omega0 as asked for.
        asked: (u32, u32),
        /// Those that there are.
        others: Vec<(u32, u32)>,
    },
    /// No linear restoring force, and what the methods that need none do not take.
    #[error(
        "needs a linear restoring force omega0^2*x with omega0^2 > 0, but it is `{force}`; methods that need none do not take the term `{term}`"
    )]
    NoLinearForce {
        /// The linear force.
        force: Expr,
        /// A term that drives or damps.
        term: Quotation,
        /// Whether it drives.
        drives: bool,
        /// Whether averaging takes the equation all the same, or would without the drive.
        averaged: bool,
    },
    /// A linear force that pushes away from the equilibrium that motions over several wells pass.
    #[error("expands about a linear force that pulls back, but `{term}` pushes away")]
    PushesAway {
        /// The linear force.
        term: Quotation,
    },
    /// A driving frequency far from every resonance that is known.
    #[error(
        "needs a drive near a resonance, but Omega : omega0 = {} is far from {}:{}, the nearest that it finds",
        crate::decimal::significant(*ratio, 4), nearest.0, nearest.1
    )]
    FarFromResonance {
        /// Omega : omega0.
        ratio: f64,
        /// The nearest resonance.
        nearest: (u32, u32),
    },
    /// A method whose amplitude is that of the first harmonic only.
    #[error("measures the amplitude as that of the first harmonic, a")]
    ConventionOfFirstHarmonic,
    /// An even part of the force, in a method for odd forces.
    #[error("is for forces with f(-x) = -f(x), but `{term}` is not odd")]
    NotOdd {
        /// The even term.
        term: Quotation,
    },
    /// As [`Unsuited::NotOdd`], about an equilibrium that is not zero.
    #[error(
        "is for forces that are odd about the equilibrium, but `{term}` is not odd about {coordinate} = {}",
        constant_in_words(position)
    )]
    NotOddAbout {
        /// The term.
        term: Quotation,
        /// The coordinate.
        coordinate: Symbol,
        /// The equilibrium.
        position: Expr,
    },
    /// Inertia that grows beyond all bounds towards the equilibrium, or has no value there: no
    /// motion passes it.
    #[error(
        "needs inertia that has a value at the equilibrium, but with the term `{term}` it has none"
    )]
    NoInertiaAtRest {
        /// The inertia term.
        term: Quotation,
    },
    /// A series in several combinations of letters, in a method for one variable.
    #[error(
        "needs a series in one variable, but the symbols of {}^2 enter in several combinations",
        FREQUENCY
    )]
    SeveralVariables,
    /// An order beyond what a method has.
    #[error("has no order above {highest}")]
    HighestOrder {
        /// Its highest order.
        highest: u32,
    },
    /// An order above the first, where one power alone restores.
    #[error("goes along the true motion of the force `{term}`, which it knows to order 1 alone")]
    FirstOrderOfPower {
        /// The force.
        term: Quotation,
    },
    /// An order in the amplitude below that at which anything holds a motion that is damped or
    /// driven.
    #[error(
        "needs order {lowest} in the amplitude here: below it no damping, no detuning and no nonlinear term holds the motion"
    )]
    BelowBalance {
        /// The lowest order at which they balance.
        lowest: u32,
    },
    /// An order below what a method has.
    #[error("has no order below {lowest}")]
    LowestOrder {
        /// Its lowest order.
        lowest: u32,
    },
    /// A motion whose amplitude changes, measured at its start alone.
    #[error(
        "measures an amplitude that changes by the first harmonic: {}, which begins at {}",
        FIRST_HARMONIC,
        AMPLITUDE
    )]
    SlowAmplitude,
    /// Slow equations among answers for periodic motions.
    #[error("gives an amplitude that changes, and no closed form of one that stays")]
    NoSteadyAmplitude,
    /// A term whose projection on the first harmonic has no closed form.
    #[error("knows no closed form for the first harmonic of `{term}`")]
    NoProjection {
        /// The term.
        term: Quotation,
    },
    /// An option that says nothing to the method.
    #[error("takes no {}", choice.words())]
    NoSuchChoice {
        /// The option.
        choice: Choice,
    },
    /// A force that is no polynomial, where one is needed.
    #[error("needs a polynomial force at this order, not `{term}`")]
    PolynomialOnly {
        /// The terms of the force that are none.
        term: Quotation,
    },
}

/// Whether a function in a term depends on a coordinate and its velocity both.
fn turns_with_both(term: &Expr) -> bool {
    let both = |part: &Expr| part.symbols().iter().any(|name| part.contains(name.derivative()));
    term.unique_nodes().any(|part| matches!(part.node(), Node::Function(..)) && both(part))
}

fn resonances(others: &[(u32, u32)]) -> String {
    let names: Vec<String> = others.iter().map(|(p, q)| format!("{p}:{q}")).collect();
    match names.is_empty() {
        true => String::new(),
        false => format!("; it does at {}", names.join(", ")),
    }
}

/// What a refusal says is unsuited.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refuser {
    /// A method, by its title.
    Method(Method),
    /// The expansion of Lindstedt and Poincare, whoever uses it.
    Expansion,
    /// The first order of that method for a force that is no polynomial.
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

impl Unsuited {
    /// A term that damps, or feeds: as it stands in the force.
    pub(super) fn damping(term: Quotation) -> Self {
        // What stands as a product with a sum in it may do both.
        let written_out = term.expression().expand();
        let feeds = written_out
            .is_ok_and(|written| written.terms().len() == 1 && written.has_leading_minus());
        Self::Damping { term, feeds }
    }

    /// The refusal of a method.
    pub fn to(self, method: Method) -> Refusal {
        self.by(Refuser::Method(method))
    }

    /// The refusal of a method or a part of one.
    pub fn by(self, refuser: Refuser) -> Refusal {
        Refusal::Unsuited { refuser, reason: self }
    }

    fn help(&self, refuser: Refuser) -> Advice {
        let first = |rest: &str| Advice::words("try ").choose(Setting::Order(1)).then(rest);
        match self {
            Self::Damping { feeds, .. } => {
                let (fate, course) = if *feeds { ("grows", "growth") } else { ("dies out", "decay") };
                Advice::words(format!("there is no frequency-amplitude law of a motion that {fate}; try "))
                    .choose(Setting::Method(Method::Averaging))
                    .then(format!(" for its {course}, or leave the term out to get the law of the undamped motion"))
            }
            Self::Forcing { .. } => Advice::words(
                "leave the term out to get the frequency of the free vibration (the backbone curve), or try ",
            )
            .choose(Setting::Method(Method::MultipleScales)),
            Self::Velocity { .. } => Advice::words("try ").choose(Setting::Method(Method::LindstedtPoincare)),
            Self::SeveralVariables => {
                Advice::words("give numbers for them, in the equation or by `")
                    .choose(Setting::Values)
                    .then("`, or try ")
                    .choose(Setting::Method(Method::Pade))
            }
            Self::Convention => {
                Advice::words("leave out ").choose(Setting::Amplitude(AmplitudeConvention::FirstHarmonic))
            }
            Self::NoWave { .. } => Advice::words("in numbers any equation can be followed: `lindstedt simulate`"),
            Self::SecondDrive { .. } => Advice::words(
                "write both as multiples of one letter or number, such as cos(W*t) and cos(3*W*t); without such a ratio the first order of a drive near omega0 is derived, where a letter such as eps makes all nonlinear terms small, none is quadratic, and the other drives are forces far from every resonance; in numbers any equation can be followed: `lindstedt simulate`",
            ),
            Self::ResonanceWithoutDamping { .. } => Advice::words(
                "the amplitude grows in proportion to time, x = (F/(2*omega0))*t*sin(omega0*t) for F*cos(omega0*t); give a damping such as 2*zeta*x'",
            ),
            Self::NoResonance { others, .. } => match others.first() {
                Some(&(driving, linear)) => Advice::words("try ").choose(Setting::Resonance(driving, linear)),
                None => Advice::words("in numbers any equation can be followed: `lindstedt simulate`"),
            },
            Self::NoLinearForce { drives: true, averaged, .. } => Advice::words(
                "in numbers `lindstedt response` finds the steady states of a drive that repeats itself; without the term try ",
            )
            .choose(Setting::Method(if *averaged { Method::Averaging } else { Method::Exact })),
            Self::NoLinearForce { averaged: true, .. } => Advice::words("the true motion of one power of the coordinate can be averaged: try ")
                .choose(Setting::Method(Method::Averaging)),
            Self::NoLinearForce { .. } => Advice::words(
                "in numbers `lindstedt simulate` follows the motion from any start; without the term try ",
            )
            .choose(Setting::Method(Method::Exact)),
            Self::PushesAway { .. } => Advice::words("take the force as it is: try ")
                .choose(Setting::Method(Method::Exact))
                .then(" or ")
                .choose(Setting::Method(Method::HarmonicBalance)),
            Self::FarFromResonance { nearest, .. } => Advice::words(
                "in numbers `lindstedt response` finds the steady states at any frequency; the formulas of a resonance are those of ",
            )
            .choose(Setting::Resonance(nearest.0, nearest.1)),
            Self::ConventionOfFirstHarmonic => {
                Advice::words("leave out ").choose(Setting::Amplitude(AmplitudeConvention::Initial))
            }
            Self::NotOdd { .. } | Self::NotOddAbout { .. } => Advice::words("try ")
                .choose(Setting::Method(Method::HarmonicBalance))
                .then(", which balances the drift as well"),
            Self::NoInertiaAtRest { .. } => Advice::words(
                "no swing about that place is known; in numbers `lindstedt simulate` follows the motion up to it",
            ),
            Self::FirstOrderOfPower { .. } => Advice::words("try ")
                .choose(Setting::Order(1))
                .then(", which holds at any amplitude; in numbers `lindstedt simulate` follows the motion"),
            Self::LowestOrder { lowest } | Self::BelowBalance { lowest } => Advice::words("try ").choose(Setting::Order(*lowest)),
            Self::SlowAmplitude => Advice::words("leave out ").choose(Setting::Amplitude(AmplitudeConvention::Initial)),
            Self::NoSteadyAmplitude => Advice::words("give numbers for the parameters, in the equation"),
            Self::NoProjection { term } => Advice::words(match turns_with_both(term.expression()) {
                true => {
                    "a function of x and x' together has none; in factors of their own both have one, as sgn(x)*sgn(x') for sgn(x*x'); in numbers any equation can be followed: `lindstedt simulate`"
                }
                false => "powers of x and x', their sizes and signs, and (2/pi)*atan(k*x') have one",
            }),
            Self::HighestOrder { highest } => Advice::words("try ").choose(Setting::Order(*highest)),
            Self::NoSuchChoice { choice } => Advice::words(format!("it belongs to {}", that_take(*choice))),
            Self::PolynomialOnly { .. } => match refuser {
                Refuser::Method(Method::IterationPerturbation) => {
                    first(", which takes any force, or ").choose(Setting::Method(Method::HomotopyPerturbation))
                }
                Refuser::Method(Method::LindstedtPoincare) => first(", which takes this force as it is"),
                _ => first(", which takes any force, or ").choose(Setting::Taylor),
            },
        }
    }
}

impl Refusal {
    /// The message without the name of the method at its head, for lists that name it already.
    pub fn reason(&self, method: Method) -> String {
        match self {
            Self::Unsuited { refuser, reason } if *refuser == Refuser::Method(method) => {
                reason.to_string()
            }
            other => other.to_string(),
        }
    }

    /// The term that it names, where it names one of the equation.
    pub fn term(&self) -> Option<&str> {
        Some(match self {
            Self::Unsuited {
                reason:
                    Unsuited::Damping { term, .. }
                    | Unsuited::Forcing { term }
                    | Unsuited::Velocity { term }
                    | Unsuited::NoWave { term }
                    | Unsuited::SecondDrive { term }
                    | Unsuited::ResonanceWithoutDamping { term }
                    | Unsuited::NotOdd { term }
                    | Unsuited::NotOddAbout { term, .. }
                    | Unsuited::NoProjection { term }
                    | Unsuited::NoLinearForce { term, .. }
                    | Unsuited::PushesAway { term }
                    | Unsuited::FirstOrderOfPower { term }
                    | Unsuited::NoInertiaAtRest { term }
                    | Unsuited::PolynomialOnly { term },
                ..
            }
            | Self::AmplitudeNotFree { term }
            | Self::Oscillator(
                OscillatorError::NotSmall { term, .. }
                | OscillatorError::OneSided { term, .. }
                | OscillatorError::NotPolynomial(term)
                | OscillatorError::Taylor(TaylorError::NotAnalytic { term, .. }),
            ) => term.words(),
            Self::Oscillator(OscillatorError::NonlinearAcceleration(words)) => words,
            _ => return None,
        })
    }

    /// A way forward, where one is known.
    pub fn help(&self) -> Option<Advice> {
        Some(match self {
            Self::Oscillator(error) => return error.help(),
            Self::Unsuited { refuser, reason } => reason.help(*refuser),
            Self::Unbounded { .. } | Self::NoSlope { .. } => {
                Advice::words("try ").choose(Setting::Method(Method::Hamiltonian))
            }
            Self::Approximant { method, .. } => {
                let degrees = match method {
                    Method::HermitePade => Degrees::Quadratic(2, 2, 2),
                    _ => Degrees::Quotient(1, 1),
                };
                Advice::words("try other degrees, such as ").choose(Setting::Degrees(degrees))
            }
            Self::AmplitudeNotFree { .. } => {
                let small = Setting::Small(AmplitudeConvention::Initial.symbol());
                Advice::words("limit cycles start from x'' + omega0^2*x with all other terms small: do not ask for `")
                    .choose(small)
                    .then("`, and write a polynomial such as x - eps*x^3/6 for sin(x)")
            }
            Self::NameOfAnswer(name) => Advice::words(format!("give it another name, such as `{name}1`")),
            Self::NoLimitCycle { .. } => {
                Advice::words("energy is fed at every amplitude or drained at every amplitude: no motion repeats; try ")
                    .choose(Setting::Method(Method::Averaging))
                    .then(" for how it grows or decays")
            }
            Self::NoSuchCycle { .. } => Advice::words("they are counted from 1, the smallest first"),
            // Numbers alone do not help where there are numbers already.
            Self::LimitCycle { equation, .. } if equation.symbols().len() > 1 => {
                Advice::words("give numbers for the parameters in it, in the equation or by `")
                    .choose(Setting::Values)
                    .then("`")
            }
            Self::Order { limit, .. } if *limit == HIGHEST_ORDER => {
                Advice::words("try a lower order, or `--omega-only`, whose limit is higher")
            }
            Self::TooLong { .. } | Self::Order { .. } | Self::Secular(_) => Advice::words("try a lower order"),
            Self::LimitCycle { .. } | Self::Expression(_) => return None,
        })
    }
}

/// Solves by the method of `options`, or by the one that suits the equation.
///
/// # Errors
/// A [`Refusal`] that names the term in the way.
///
/// ```
/// # use lindstedt_oscillator as lindstedt;
/// use lindstedt::{method::{Options, solve}, Oscillator};
/// let pendulum = Oscillator::parse("x'' + sin(x) = 0")?;
/// let solution = solve(&pendulum, &Options { order: Some(2), ..Options::default() })?;
/// assert_eq!(solution.law.frequency_squared().unwrap().to_string(), "1 - A^2/8");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn solve(oscillator: &Oscillator, options: &Options) -> Result<Solution, Refusal> {
    if let Some(name) = oscillator
        .parameters
        .iter()
        .chain([&oscillator.coordinate])
        .find(|name| NAMES_OF_ANSWERS.contains(&name.name()) && !name.is_apart())
    {
        return Err(Refusal::NameOfAnswer(name.apart()));
    }
    let _letters = oscillator.letters().in_force();
    let solution = solve_as_asked(oscillator, options)
        .map_err(|refusal| without_linear_force(refusal, oscillator, options))?;
    let phase = oscillator.phase();
    Ok(Solution {
        derivation: solution.derivation.into_iter().map(|line| line.with_phase(phase)).collect(),
        law: solution.law.with_phase(phase),
        ..solution
    })
}

/// Where `x = 0` pushes away the stable equilibria are named. Methods that need no linear force
/// take no damping and no drive: where there is one the way leads on to numbers.
fn without_linear_force(refusal: Refusal, oscillator: &Oscillator, options: &Options) -> Refusal {
    let Refusal::Oscillator(OscillatorError::NoRestoringForce(force)) = &refusal else {
        return refusal;
    };
    let asked = oscillator.about.is_some();
    // Two wells, say: with positive letters it pushes away here, and back elsewhere.
    if let (true, false, Some(unstable)) =
        (force.has_leading_minus(), asked, stable_elsewhere(oscillator))
    {
        return unstable.into();
    }
    if let (true, Ok(centred)) = (asked && !force.is_zero(), centred(oscillator, None))
        && centred.cross_well.is_some()
    {
        let method = options.method.unwrap_or(Method::LindstedtPoincare);
        let refusal = Unsuited::PushesAway { term: force.clone().into() };
        return quotation::as_typed(refusal.to(method), oscillator, &centred);
    }
    let Ok(parts) = oscillator.parts() else {
        return refusal;
    };
    let Some(other) = [&parts.forcing, &parts.damping].into_iter().find(|part| !part.is_zero())
    else {
        return refusal;
    };
    let otherwise = match parts.forcing.is_zero() {
        true => Method::Averaging,
        false => Method::MultipleScales,
    };
    let by_averaging = Options { method: Some(Method::Averaging), ..Options::default() };
    let mut free = oscillator.clone();
    if let Ok(force) = (&oscillator.force - &parts.forcing).expand() {
        free.force = force;
    }
    let refusal = Unsuited::NoLinearForce {
        force: force.clone(),
        term: first_term(other),
        drives: !parts.forcing.is_zero(),
        averaged: solve_as_asked(&free, &by_averaging).is_ok(),
    }
    .to(options.method.unwrap_or(otherwise));
    match centred(oscillator, None) {
        Ok(centred) => quotation::as_typed(refusal, oscillator, &centred),
        Err(_) => refusal,
    }
}

fn solve_as_asked(oscillator: &Oscillator, options: &Options) -> Result<Solution, Refusal> {
    let found = solve_in_its_coordinate(oscillator, options);
    match found.as_ref().is_err_and(base_motion::is_of_drive) {
        true => base_motion::solve(oscillator, options)
            .or_else(|| forced_waves::solve(oscillator, options))
            .map_or(found, Ok),
        false => found,
    }
}

/// Solves without another coordinate in view.
fn solve_in_its_coordinate(
    oscillator: &Oscillator,
    options: &Options,
) -> Result<Solution, Refusal> {
    let limit = match options.frequency_alone {
        true => HIGHEST_ORDER_OF_FREQUENCY,
        false => HIGHEST_ORDER,
    };
    if let Some(asked) = options.order.filter(|&order| order > limit) {
        return Err(Refusal::Order { asked, limit });
    }
    let may_expand = match options.method {
        None => default_method(oscillator) == Method::LindstedtPoincare,
        Some(method) => method == Method::LindstedtPoincare,
    };
    // What damps is not seen at the order 0, and rules a periodic motion out all the same.
    if options.order == Some(0) && may_expand {
        let first = Options { order: Some(1), ..options.clone() };
        if let Err(refusal) = solve_by(Method::LindstedtPoincare, oscillator, &first)
            && default_method::is_of_damping(&refusal, oscillator)
        {
            return Err(refusal);
        }
    }
    match options.method {
        Some(method) => solve_by(method, oscillator, options),
        None => default_method::solve(oscillator, options),
    }
}

/// Solves by one method.
fn solve_by(
    method: Method,
    oscillator: &Oscillator,
    options: &Options,
) -> Result<Solution, Refusal> {
    let entry = Entry::of(method);
    refuse_what_it_does_not_take(entry, options)?;
    // Every method works about x = 0: the equation is seen from its equilibrium, and the answer
    // moved back.
    let polynomial = oscillator.polynomial_degree()?.is_some();
    // The formulas of a driven motion have a letter for an equilibrium that is no fraction.
    let driven = oscillator.force.contains(Symbol::new("t"));
    let degree = (entry.rounded_degree)(options, polynomial).filter(|_| !(driven && polynomial));
    let centred = centred(oscillator, degree)?;
    let options = &about_a_load(&centred, options);
    let answer = match inertia::solve(entry, &centred.oscillator, options) {
        Ok(Some(solution)) => Ok(solution),
        Ok(None) => (entry.solve)(&centred.oscillator, options),
        Err(refusal) => Err(refusal),
    };
    let mut solution =
        answer.map_err(|refusal| quotation::as_typed(refusal, oscillator, &centred))?;
    // The first order of a force that is no polynomial projects the force as it is, corners and
    // all.
    let projected = method == Method::LindstedtPoincare && solution.law.frequency().is_none();
    if entry.expands() && !projected && has_corners(&oscillator.force) {
        solution.validity.push(Note::Corners);
    }
    let mut sides = centred.sides.clone();
    if entry.expands() && !projected {
        let (_, taken) = near_rest(&centred.oscillator.force, oscillator.coordinate)
            .map_err(OscillatorError::from)?;
        sides.extend(taken.into_iter().filter(|side| !centred.sides.contains(side)));
    }
    if !sides.is_empty() {
        solution.validity.push(Note::CornerSides(sides));
    }
    if centred.endless {
        solution.validity.push(Note::EndlessPotential { coordinate: oscillator.coordinate });
    }
    if let Some(motions) = &centred.cross_well {
        // A relation has no root that comes from an unstable rest.
        solution.validity.iter_mut().for_each(Note::take_root_of_first_order);
        solution.validity.push(Note::CrossWell(motions.clone()));
    }
    if centred.position.is_zero() {
        // The question is the equation as it was typed, whatever a method made of its force.
        solution.equation = oscillator.equation();
        return Ok(solution);
    }
    if let (Some(degree), true) =
        (degree, centred.numerical && !polynomial && entry.takes(Choice::Taylor))
    {
        solution.validity.push(Note::TaylorPolynomial { degree });
    }
    move_back(&mut solution, oscillator, &centred)?;
    Ok(solution)
}

/// An option that a method has no use for is a mistake, and never ignored.
fn refuse_what_it_does_not_take(entry: &Entry, options: &Options) -> Result<(), Refusal> {
    let given = [
        (Choice::Order, options.order.is_some()),
        (Choice::Degrees, options.degrees.is_some()),
        (Choice::Taylor, options.taylor.is_some()),
        (Choice::Hbar, options.hbar.is_some()),
        (Choice::Cycle, options.cycle.is_some()),
        (Choice::Resonance, options.resonance.is_some()),
        (Choice::FrequencyAlone, options.frequency_alone),
    ];
    match given.iter().find(|(choice, given)| *given && !entry.takes(*choice)) {
        Some(&(choice, _)) => Err(Unsuited::NoSuchChoice { choice }.to(entry.method)),
        None => Ok(()),
    }
}

/// A parameter that moves the equilibrium is no small one, unless it is asked for: the amplitude
/// is.
fn about_a_load(centred: &Centred, options: &Options) -> Options {
    let small = centred.oscillator.small_parameter(options.small.as_deref());
    let moves = |name: Symbol| centred.position.contains(name);
    let amplitude = options.small.is_none()
        && matches!(small, Ok(SmallParameter::Parameter(name)) if moves(name));
    Options {
        small: if amplitude { Some(AMPLITUDE.to_string()) } else { options.small.clone() },
        ..options.clone()
    }
}

/// Adds the equilibrium to an answer about zero.
fn move_back(
    solution: &mut Solution,
    oscillator: &Oscillator,
    centred: &Centred,
) -> Result<(), Refusal> {
    let x = oscillator.coordinate;
    let written = centred.written.to_polynomial(&mut |_| None)?;
    // What is no polynomial has a symbol.
    let position = written.unwrap_or_else(Polynomial::zero);
    // A motion known by numbers alone is left to them.
    if !solution.displacement.is_zero() {
        let position = FourierSeries::constant(POLYNOMIALS, position);
        solution.displacement = solution.displacement.sum(&position);
        let motion = solution.modulation.as_mut().and_then(|slow| slow.motion.as_mut());
        if let Some(motion) = motion {
            *motion = motion.sum(&position);
        }
    }
    if let Some(response) = &mut solution.response {
        response.motion = &response.motion + &centred.written;
    }
    if let Some(motion) = &mut solution.closed_motion {
        *motion = &*motion + &centred.written;
    }
    solution.equation = oscillator.equation();
    if centred.numerical {
        solution.round_coefficients();
    }
    let number = centred.position.evaluate(&BTreeMap::new()).ok();
    let position = match (&centred.definition, number) {
        (None, _) if !centred.numerical => Position::Exact(centred.position.clone()),
        (None | Some(_), Some(number)) => Position::Number(number),
        (_, None) => Position::WhereReal(centred.position.clone()),
    };
    if centred.cross_well.is_none() {
        solution.validity.push(Note::Equilibrium { coordinate: x, position });
    }
    if let Some(definition) = &centred.definition {
        solution.definitions.insert(0, definition.clone());
    }
    solution.equilibrium = centred.position.clone();
    Ok(())
}

fn has_corners(force: &Expr) -> bool {
    use crate::expr::Function::{Absolute, Maximum, Minimum, Sign, Step};
    let corners = [Absolute, Maximum, Minimum, Sign, Step];
    corners.into_iter().any(|function| force.contains_function(function))
}

/// The refusal of a force that is no polynomial in the coordinate, by the terms that are none.
fn not_polynomial(force: &Expr, coordinate: Symbol) -> Unsuited {
    let constant = fresh("c", &[coordinate]);
    let is_none = |term: &Expr, constants: bool| {
        let mut name =
            |factor: &Expr| (constants && !factor.contains(coordinate)).then_some(constant);
        match term.to_polynomial(&mut name) {
            Ok(Some(polynomial)) => {
                polynomial.exponent_range(coordinate).is_some_and(|(lowest, _)| lowest < 0)
            }
            Ok(None) | Err(_) => true,
        }
    };
    let expanded = force.expand().unwrap_or_else(|_| force.clone());
    // A constant such as sqrt(k) is in the way of some methods, and named where nothing else is.
    let found = [true, false].map(|constants| {
        let terms = expanded.terms().iter().filter(|term| is_none(term, constants));
        Expr::sum(terms.cloned())
    });
    let term = found.iter().find(|terms| !terms.is_zero()).unwrap_or(force);
    Unsuited::PolynomialOnly { term: term.clone().into() }
}

/// The term of a sum that a refusal names.
fn first_term(sum: &Expr) -> Quotation {
    sum.terms().first().unwrap_or(sum).clone().into()
}
