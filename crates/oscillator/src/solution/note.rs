//! Notes on an answer beside its formulas: its truncation, the parts left out, its validity.
//!
//! Their sentences are in `note/sentences.rs`.

mod sentences;

pub use super::linear_drive::LinearDrive;
use super::{Definition, Degrees, LeadingCycle, Method};
use crate::exact::{Monomial, Polynomial};
use crate::expr::Expr;
use crate::symbol::Symbol;

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
