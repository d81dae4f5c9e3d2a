//! The methods: each takes an [`Oscillator`] and options, and gives a [`Solution`] or a [`Refusal`].
//!
//! One file per method, each opening with its reference and equations. To add one: write its file with a function
//! `solve(&Oscillator, &Options) -> Result<Solution, Refusal>`, give it a name in [`Method`], and add one line to [`solve`].

pub mod lindstedt_poincare;
pub mod secular;

use crate::expr::ExprError;
use crate::oscillator::{Oscillator, OscillatorError};
use crate::solution::{AmplitudeConvention, Method, Solution};

/// The highest order any method accepts.
pub const HIGHEST_ORDER: u32 = 400;

/// What a user may choose; `None` leaves the choice to the method.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Options {
    /// The method.
    pub method: Option<Method>,
    /// Highest power of the small parameter, inclusive.
    pub order: Option<u32>,
    /// The meaning of the amplitude.
    pub amplitude: Option<AmplitudeConvention>,
    /// The name of the small parameter; `A` or `a` for the amplitude.
    pub small: Option<String>,
}

/// Why a method does not answer, and what to do instead.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Refusal {
    /// The equation is no oscillator, or cannot be expanded.
    #[error(transparent)]
    Oscillator(#[from] OscillatorError),
    /// Terms that take energy out, so that no motion repeats.
    #[error("{method} needs a periodic motion, but the term `{term}` damps it")]
    Damping {
        /// The method's name in running text.
        method: &'static str,
        /// The damping term.
        term: String,
    },
    /// Terms that drive the motion in time.
    #[error("{method} is for free vibrations, but the term `{term}` drives the motion")]
    Forcing {
        /// The method's name in running text.
        method: &'static str,
        /// The forcing term.
        term: String,
    },
    /// A self-excited oscillator whose amplitude the equation determines, asked for in powers of that amplitude.
    #[error("the term `{term}` feeds or drains energy, so the amplitude is not free and nothing can be expanded in it")]
    AmplitudeNotFree {
        /// The term.
        term: String,
    },
    /// A limit cycle exists or may exist, but not in closed form.
    #[error("the amplitude of the limit cycle follows from `{equation} = 0`, {reason}")]
    LimitCycle {
        /// The polynomial in z = amplitude^2 whose root is needed.
        equation: String,
        /// Why that is not possible.
        reason: &'static str,
    },
    /// The periodic expansion breaks down.
    #[error("no periodic expansion: {0}")]
    Secular(#[from] secular::SecularError),
    /// The order asked for is too high.
    #[error("order {asked} is above the limit of {HIGHEST_ORDER}")]
    Order {
        /// The order asked for.
        asked: u32,
    },
    /// A step of algebra failed.
    #[error("{0}")]
    Expression(#[from] ExprError),
}

impl Refusal {
    /// A way forward, where one is known.
    pub fn help(&self) -> Option<String> {
        match self {
            Self::Oscillator(error) => error.help(),
            Self::Damping { .. } => Some(
                "there is no frequency-amplitude law of a motion that dies out; leave the term out to get that of the undamped motion"
                    .to_owned(),
            ),
            Self::Forcing { .. } => {
                Some("leave the term out to get the frequency of the free vibration (the backbone curve)".to_owned())
            }
            Self::AmplitudeNotFree { .. } => {
                Some("give the term a small factor, as in eps*(1 - x^2)*x', and expand in that".to_owned())
            }
            Self::LimitCycle { .. } => Some("give numbers for the parameters in it".to_owned()),
            Self::Order { .. } | Self::Secular(_) => Some("try a lower order".to_owned()),
            Self::Expression(_) => None,
        }
    }
}

/// Solves by the method of `options`, or by the one that suits the equation.
///
/// # Errors
/// A [`Refusal`] that names the term in the way.
///
/// ```
/// use lindstedt::{method::{Options, solve}, Oscillator};
/// let pendulum = Oscillator::parse("x'' + sin(x) = 0")?;
/// let solution = solve(&pendulum, &Options { order: Some(2), ..Options::default() })?;
/// assert_eq!(solution.frequency_squared.unwrap().to_string(), "1 - A^2/8");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn solve(oscillator: &Oscillator, options: &Options) -> Result<Solution, Refusal> {
    if let Some(asked) = options.order.filter(|&order| order > HIGHEST_ORDER) {
        return Err(Refusal::Order { asked });
    }
    match options.method.unwrap_or(Method::LindstedtPoincare) {
        Method::LindstedtPoincare => lindstedt_poincare::solve(oscillator, options),
    }
}
