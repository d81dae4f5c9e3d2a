//! The methods: each takes an [`Oscillator`] and options, and gives a [`Solution`] or a [`Refusal`].
//!
//! One file per method, each opening with its reference and equations. To add one: write its file with a function
//! `solve(&Oscillator, &Options) -> Result<Solution, Refusal>`, give it a name in [`Method`], and add one line to [`solve`].

pub mod expansion;
pub mod homotopy_perturbation;
pub mod lindstedt_poincare;
pub mod secular;

use num_traits::{One, Zero};

use crate::decimal::decimal;
use crate::equilibrium::centred;
use crate::exact::rational::to_f64;
use crate::exact::{Integer, Polynomial};
use crate::expr::{Expr, ExprError, parse_expression};
use crate::oscillator::{Oscillator, OscillatorError};
use crate::series::FourierSeries;
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
    /// Degree of the Taylor polynomial by which homotopy perturbation replaces the force.
    pub taylor: Option<u32>,
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
    /// Terms with velocities, in a method for forces of position alone.
    #[error("{method} is for forces of the position alone, but `{term}` depends on the velocity")]
    Velocity {
        /// The method's name in running text.
        method: &'static str,
        /// The term.
        term: String,
    },
    /// A method that measures the amplitude in one way only.
    #[error("{method} measures the amplitude as A = x(0)")]
    Convention {
        /// The method's name in running text.
        method: &'static str,
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
            Self::Velocity { .. } => Some("try --method lindstedt-poincare".to_owned()),
            Self::Convention { .. } => Some("leave out --amplitude first-harmonic".to_owned()),
            Self::AmplitudeNotFree { .. } => {
                Some("give the term a small factor, as in eps*(1 - x^2)*x', and expand in that".to_owned())
            }
            Self::LimitCycle { equation, .. } => {
                // Numbers alone do not help where there are numbers already.
                let symbols = parse_expression(equation).map(|equation| equation.symbols().len());
                symbols.is_ok_and(|count| count > 1).then(|| "give numbers for the parameters in it".to_owned())
            }
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
    let method = options.method.unwrap_or(Method::LindstedtPoincare);
    // Every method expands about x = 0: the equation is seen from its equilibrium, and the answer moved back.
    let degree = match method {
        Method::LindstedtPoincare => options.order.unwrap_or(4) + 1,
        Method::HomotopyPerturbation => options.taylor.unwrap_or(2 * options.order.unwrap_or(2) + 1),
    };
    let centred = centred(oscillator, degree)?;
    let mut solution = match method {
        Method::LindstedtPoincare => lindstedt_poincare::solve(&centred.oscillator, options),
        Method::HomotopyPerturbation => homotopy_perturbation::solve(&centred.oscillator, options),
    }?;
    if centred.position.is_zero() {
        return Ok(solution);
    }
    let position = Polynomial::constant(centred.position.clone());
    solution.displacement = solution
        .displacement
        .sum(&FourierSeries::constant(position, Integer::one()));
    solution.equation = oscillator.equation();
    if centred.numerical {
        solution.round_coefficients();
    }
    let position = if centred.numerical {
        decimal(to_f64(&centred.position))
    } else {
        centred.position.to_string()
    };
    solution
        .validity
        .push(format!("swings about the equilibrium x = {position}"));
    solution.equilibrium = Expr::number(centred.position);
    Ok(solution)
}

/// The term of a sum that a refusal names.
fn first_term(sum: &Expr) -> String {
    sum.terms().first().unwrap_or(sum).to_string()
}
