//! Impacts of a pendulum on an elastic barrier, in closed form and by simulation.
//!
//! x'' + f(x) + gamma F(x - x_c) H(x - x_c) = 0, released at rest from x = -A towards the barrier
//! at x_c: with f = sin x and F = depth^(3/2) the paper's equation (9); with damping, friction and
//! a moving pivot its equation (7). In: amplitude, barrier, stiffness, dampings and drive. Out: one
//! impact in three closed forms with its true motion, or a whole motion, event by event, or many of
//! them at once.
//!
//! Each file uses only those above it:
//!
//! - [`hertz`]: the contact alone: force, depth, duration, and gamma from mass, radius, length and
//!   modulus, equation (8).
//! - `units`: the pendulum in SI units: [`Units`], the [`Modulus`] of two bodies, force and
//!   pressure.
//! - `linearisation`: [`Rule`] and [`fit`], the straight line that replaces F while in contact,
//!   equation (15).
//! - [`contact`]: the contact by other laws, the exact one among them, side by side.
//! - `collision`: a [`Collision`], the question: two forces, a release and a barrier; the speed at
//!   the touch.
//! - `form`: a [`Form`], the function of time that a phase is.
//! - `phases`: [`three_phases`], approach | contact | return in closed form, equations (13) to
//!   (16).
//! - `parameter`: the numbers that a study may vary, by name, group and unit.
//! - `dissipation`: every damping in every form in which it may be given, and the form held fixed:
//!   [`Dissipation`].
//! - `model`: the forces of equation (7) and the ranges of its parameters.
//! - `case`: a [`Case`], the same by dimensions and materials, any number of which a [`Parameter`]
//!   reads or writes.
//! - `regularised`: contact in a variable in which it is a power series.
//! - `polynomial`: polynomials on an interval, and where their sign changes.
//! - `simulation`: the result of a simulation: its path, its energy, its rest time.
//! - `taylor`: the fast integrator, by power series, eight motions in one instruction stream.
//! - `judge`: Runge-Kutta on the equations as they stand, for one impact and for a whole motion.
//! - [`chain`](mod@chain): the same motion by closed forms, swing and contact in turn.
//! - `setup`: a [`Setup`], the whole problem, and its equations and forces.
//! - `derived`: a [`Flight`], any derived motion as approach and return.
//! - `trial`: the problem with its true motion, and the methods that are tried in turn.
//! - `closed_form`: [`solve`], every reading of the three phases and the judge together.
//! - `si`: the numbers of an impact in SI units, an [`SiImpact`].
//! - `compare`: [`compare`], every method in one table.
//! - `simulate`: [`simulate`](simulate()) and [`simulate_many`], by either integrator.
//! - `baseline`: the same swing without a barrier, and with a lossless one.
//! - `materials`: [`study_materials`], the same swing against barriers of several materials.
//! - [`sweep`]: parameters over a range, on all cores.
//! - [`friction`]: equation (6) beside Coulomb's law, at some speeds and near rest.
//!
//! ```
//! # use lindstedt_impact as lindstedt;
//! use lindstedt::impact::hertz::{StiffnessDesign, elastic_force};
//! use lindstedt::impact::Rule;
//! use lindstedt::impact::{ContactSpeed, ImpactProblem, three_phases};
//!
//! let swing = ImpactProblem {
//!     amplitude: 1.5,
//!     barrier: 0.323,
//!     stiffness: StiffnessDesign::default().stiffness()?,
//!     frequency_squared: 1.0 - 1.5 * 1.5 / 8.0,
//!     linear_stiffness: 1.0,
//!     restoring_force: &|x| x.sin(),
//!     elastic_force: &elastic_force,
//!     rule: Rule::LeastSquares,
//! };
//! let motion = three_phases(&swing, ContactSpeed::Paper)?;
//! assert_eq!(motion.phases[0].closed_form(), "x(t) = -1.5 cos(0.847791 t)");
//! assert!((motion.speed - 1.24185).abs() < 1e-5);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod baseline;
mod case;
pub mod chain;
mod closed_form;
mod collision;
mod compare;
pub mod contact;
mod derived;
mod dissipation;
mod error;
mod form;
pub mod friction;
pub mod hertz;
mod judge;
mod lanes;
mod linearisation;
mod lossy_laws;
mod materials;
mod model;
mod parameter;
mod phases;
mod polynomial;
pub mod primary;
mod regularised;
mod setup;
mod si;
mod simulate;
mod simulation;
pub mod sweep;
mod taylor;
mod trial;
mod units;

pub use baseline::{BASELINE_DURATIONS, Baseline, Geometry, baseline};
pub use case::Case;
pub use chain::{ChainError, chain};
pub use closed_form::{
    Impact, ImpactQuantity, JudgedPhases, PhaseReading, SampledMotion, Shortcoming, solve,
};
pub use collision::{Collision, CollisionError};
pub use compare::{ImpactComparison, ImpactMethod, ImpactRow, compare};
pub use derived::{DerivedContact, Flight};
pub use dissipation::{
    ContactDamping, ContactScales, Dissipation, SpeedUnit, friction_of_torque, torque_of_friction,
    viscous_coefficient, viscous_ratio,
};
pub use error::ImpactError;
pub use form::{Form, TimeFunction};
pub use judge::{Deviation, TrueImpact, assured_impact, deviation, true_impact};
pub use linearisation::{LinearContactForce, LinearisationError, Rule, UnknownRule, fit};
pub use lossy_laws::LossyRow;
pub(crate) use materials::impacts_until;
pub use materials::{
    DEFAULT_DURATION, DEFAULT_MATERIALS, DEFAULT_ZETA, FirstContact, HeldFixed, Material,
    MaterialMotions, MaterialQuestion, MaterialRow, MaterialStudy, MaterialsError, MotionToRest,
    StudiedMotion, course, default_lambda, material_motions, study_from_motions, study_materials,
};
pub use model::{
    DEFAULT_AMPLITUDE, DEFAULT_BARRIER, Friction, Model, ModelError, STEEPNESS, Side, Start,
};
pub use parameter::{Parameter, UnknownParameter};
pub use phases::{ContactSpeed, FittedLine, ImpactProblem, MotionPhase, ThreePhases, three_phases};
pub use setup::{ContactLoss, ImpactSymbols, LossAmount, Setup};
pub use si::{SiImpact, YieldCheck};
pub(crate) use simulate::simulate_each;
pub use simulate::{SimulationError, known_until, simulate, simulate_many};
pub use simulation::{
    ClosedForm, ContactDeviation, ContactRecord, EnergyBook, EnergyPoint, Integrator,
    MotionDifference, NoRest, PathSegment, REST_FRACTION, Regime, Rest, Settings, Simulation,
    SimulationPath, SimulationStop, TurningPoint,
};
pub use trial::Attempt;
pub use units::{Elastic, FIRST_YIELD, Modulus, Units};
