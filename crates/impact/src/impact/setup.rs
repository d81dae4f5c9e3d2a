//! The problem of one impact: a swing, a barrier in its way, and the closed forms asked for.
//!
//! In: an equation of the swing with the values of its parameters, a release, a barrier and the law
//! of its force. Out: the equation that is judged,
//!
//! ```text
//! x'' + f(x) + gamma F(x - x_c) H(x - x_c) = 0,   x(0) = x_r, x'(0) = 0       a barrier on the right
//! x'' + f(x) - gamma F(x_c - x) H(x_c - x) = 0                                on the left
//! ```
//!
//! where a contact that loses energy has gamma F (1 + lambda d') for gamma F, d' the speed inwards,
//! and its two forces as functions, in the coordinate z = s (x - x_e) that runs from the
//! equilibrium x_e towards the barrier.

use std::collections::BTreeMap;

use num_integer::Integer as _;
use num_traits::{Signed, ToPrimitive};

use super::contact::{ContactLaw, Dashpot, LossyLaw};
use super::error::ImpactError;
use super::hertz::DEFAULT_STIFFNESS;
use super::linearisation::Rule;
use super::model::{DEFAULT_AMPLITUDE, DEFAULT_BARRIER, Side};
use super::units::Units;
use crate::conservative::CentredForce;
use crate::conservative::force::NearRest;
use crate::equilibrium::{centred, no_bottom, with_numbers_where_needed};
use crate::exact::rational::ratio;
use crate::exact::{Integer, Rational};
use crate::expr::{CompiledFunction, Equation, Expr, ExprError, Function, Node};
use crate::oscillator::Oscillator;
use crate::solution::{AmplitudeConvention, Degrees, Method};
use crate::symbol::{Symbol, fresh};
use crate::values::Values;
use crate::verify::DEFAULT_TOLERANCE;

/// The swing without barrier, if none is given.
const FREE_SWING: &str = "x'' + sin(x) = 0";

/// The numbers of an impact, and what is to be derived.
#[derive(Clone, Debug)]
pub struct Setup {
    /// The swing without the barrier, a force of the position alone; the pendulum if none is given.
    pub swing: Option<Oscillator>,
    /// Values of the parameters of the swing and of the law of the barrier.
    pub values: Values,
    /// Released from rest here, in the unit of x: rad for a pendulum.
    pub release: f64,
    /// Position x_c of the barrier, in the unit of x.
    pub barrier: f64,
    /// The side of x_c on which the barrier is.
    pub side: Side,
    /// Stiffness gamma of the barrier, positive; dimensionless for a pendulum in units of 1/omega.
    pub stiffness: f64,
    /// The source of gamma, in words.
    pub stiffness_source: String,
    /// The pendulum in SI units, which must agree with `stiffness`; if `None`, the answer has only
    /// dimensionless numbers.
    pub units: Option<Units>,
    /// The whole force of the barrier as an expression in the depth `d` and in parameters, `gamma`
    /// among them; if `None`, that of Hertz, `gamma*d^(3/2)`.
    pub force: Option<Expr>,
    /// The method that derives the swing of the derived column; if `None`, the first of a few that
    /// passes.
    pub method: Option<Method>,
    /// Order of the law; if `None`, 2 for the paper's reading, and for the derived column the
    /// lowest that passes.
    pub order: Option<u32>,
    /// The degrees of an approximant.
    pub degrees: Option<Degrees>,
    /// The definition of the amplitude of the derived law.
    pub amplitude_convention: Option<AmplitudeConvention>,
    /// The rule of the line in the paper's version.
    pub rule: Rule,
    /// The law of the contact in the derived column; not used if `loss` is given.
    pub contact_law: ContactLaw,
    /// Whether a table of every law of the contact is wanted.
    pub every_contact_law: bool,
    /// The loss in the contact: with it the derived column is that of its law.
    pub loss: Option<ContactLoss>,
    /// The largest relative error of a passing closed form.
    pub tolerance: f64,
    /// Error per step of Runge-Kutta, relative; between 1e-15 and 0.1.
    pub integrator_tolerance: f64,
    /// Steps after which Runge-Kutta gives up, which is an error.
    pub step_limit: u32,
}

/// The loss in a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactLoss {
    /// The law; for a dashpot the force of the barrier must be a spring.
    pub law: LossyLaw,
    /// Its amount.
    pub amount: LossAmount,
}

/// The amount of a loss, by the damping or by the restitution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LossAmount {
    /// lambda, positive, in units of time over the unit of x, mu/gamma in equation (7); of a dashpot in units of
    /// time.
    Damping(f64),
    /// The coefficient of restitution, above 0 and below 1, of the contact alone, at the speed that the energy of
    /// the swing gives the touch.
    Restitution(f64),
}

/// The default pendulum: released at -1.5 rad, the barrier at 0.323, the stiffness of its design by
/// equation (8).
impl Default for Setup {
    fn default() -> Self {
        Self {
            swing: None,
            values: Values::default(),
            release: -DEFAULT_AMPLITUDE,
            barrier: DEFAULT_BARRIER,
            side: Side::Right,
            stiffness: DEFAULT_STIFFNESS,
            stiffness_source: "equation (8)".to_owned(),
            units: None,
            force: None,
            method: None,
            order: None,
            degrees: None,
            amplitude_convention: None,
            rule: Rule::default(),
            contact_law: ContactLaw::default(),
            every_contact_law: false,
            loss: None,
            tolerance: DEFAULT_TOLERANCE,
            integrator_tolerance: 1e-10,
            step_limit: 250_000,
        }
    }
}

/// The symbols of an equation with a barrier.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ImpactSymbols {
    /// The coordinate.
    pub coordinate: Symbol,
    /// The position of the barrier: `xc`.
    pub barrier: Symbol,
    /// Its stiffness: `gamma`.
    pub stiffness: Symbol,
    /// The depth in it, in the law of its force: `d`.
    pub depth: Symbol,
    /// Its damping, where it has one: `lambda`.
    pub damping: Symbol,
}

/// The equations of an impact, and their forces as functions.
pub(super) struct ImpactEquations {
    /// The swing alone, as it is given to methods: with numbers for parameters if its equilibrium
    /// needs them.
    pub(super) swing: Oscillator,
    /// The values of its parameters.
    pub(super) values: Values,
    /// x_e as a number; zero if there is no other.
    pub(super) equilibrium: f64,
    /// The letters.
    pub(super) letters: ImpactSymbols,
    /// The equation that is judged.
    pub(super) judged: String,
    /// The stiffness that multiplies the elastic force: gamma, or one if the whole force was given.
    pub(super) stiffness: f64,
    /// f(x), f'(x) and F(depth), each with gamma as a further argument.
    forces: [CompiledFunction; 3],
    gamma: f64,
    /// F near the touch, if its expression loses its digits there.
    near_touch: Option<NearTouch>,
}

/// The Taylor polynomial of a contact force that is a difference of nearly equal numbers near the
/// touch.
struct NearTouch {
    /// The polynomial in q, with depth = q^root, so that a force with roots of the depth has one as
    /// well.
    polynomial: NearRest,
    root: u32,
}

/// The power of a symbol among the factors of a term; `None` if it stands elsewhere in them.
fn power_of(symbol: Symbol, term: &Expr) -> Option<Rational> {
    let mut power = Rational::default();
    for factor in term.factors().1 {
        let (base, exponent) = factor.base_and_exponent();
        match (base.as_symbol() == Some(symbol), exponent.as_number()) {
            (true, Some(exponent)) => power += exponent,
            _ if factor.contains(symbol) => return None,
            _ => {}
        }
    }
    Some(power)
}

impl NearTouch {
    /// Highest root of the depth in which the polynomial may be; a force with higher roots is
    /// evaluated as typed.
    const HIGHEST_ROOT: u32 = 12;

    /// The polynomial of this force of the depth; `None` if the force keeps its digits, does not
    /// vanish at the touch, or is not analytic in a root of the depth.
    fn new(force: &Expr, depth: Symbol, stiffness: (Symbol, f64)) -> Option<Self> {
        /// A depth below any of interest: a force that keeps its digits here keeps them everywhere.
        const SMALLEST: f64 = 1e-12;
        if force.substitute(depth, &Expr::zero()).is_ok_and(|at_touch| !at_touch.is_zero()) {
            return None;
        }
        let exponents = force.unique_nodes().filter_map(|part| match part.node() {
            Node::Power(base, exponent) if base.contains(depth) => exponent.as_number(),
            _ => None,
        });
        let root = exponents.fold(Integer::from(1), |root, exponent| root.lcm(exponent.denom()));
        let root = root.to_u32().filter(|root| *root <= Self::HIGHEST_ROOT)?;
        let q = Expr::from(depth);
        // sqrt(q^2 + q^4) = q sqrt(1 + q^2): the common power of q of all terms under a root is
        // taken out of it.
        let in_root = force.fold(|part, children: &[Expr]| match (part.node(), children) {
            (Node::Symbol(name), _) if *name == depth => q.integer_power(root.into()),
            (Node::Power(_, exponent), [base, _]) if base.contains(depth) => {
                let powers = base.terms().iter().map(|term| power_of(depth, term));
                let lowest = powers.min().flatten().filter(Signed::is_positive);
                let (Some(exponent), Some(lowest)) = (exponent.as_number(), lowest) else {
                    return part.with_children(children);
                };
                let common = Expr::power(&q, &Expr::number(lowest.clone()))?;
                let rest = Expr::divide(base, &common)?.expand()?;
                let outside = Expr::power(&q, &Expr::number(lowest * exponent))?;
                Ok(&outside * &Expr::power(&rest, &Expr::number(exponent.clone()))?)
            }
            _ => part.with_children(children),
        });
        let numbers = BTreeMap::from([stiffness]);
        let force = CentredForce::new(&in_root.ok()?, depth, &Expr::zero(), &numbers, SMALLEST)?;
        Some(Self { polynomial: force.polynomial_near_rest()?.clone(), root })
    }

    fn value(&self, depth: f64) -> Option<f64> {
        self.polynomial.value(match self.root {
            1 => depth,
            2 => depth.sqrt(),
            root => depth.powf(1.0 / f64::from(root)),
        })
    }
}

impl ImpactEquations {
    /// f(x).
    pub(super) fn restoring_force(&self, x: f64) -> f64 {
        self.forces[0].call(&[x, self.gamma])
    }

    /// f'(x).
    pub(super) fn slope(&self, x: f64) -> f64 {
        self.forces[1].call(&[x, self.gamma])
    }

    /// F(depth) per unit of the stiffness.
    pub(super) fn elastic_force(&self, depth: f64) -> f64 {
        let near_touch = self.near_touch.as_ref().and_then(|near| near.value(depth));
        near_touch.unwrap_or_else(|| self.forces[2].call(&[depth, self.gamma]))
    }
}

impl Setup {
    /// The symbols, none of which the swing or the force of the barrier uses for another quantity.
    fn letters(&self, swing: &Oscillator) -> ImpactSymbols {
        let x = swing.coordinate;
        let mut taken = swing.parameters.clone();
        taken.extend(self.force.iter().flat_map(|force| force.symbols()));
        ImpactSymbols {
            coordinate: x,
            barrier: fresh(&format!("{x}c"), &swing.parameters),
            stiffness: fresh("gamma", &swing.parameters),
            depth: fresh("d", &swing.parameters),
            damping: fresh("lambda", &taken),
        }
    }

    /// The equation with the barrier in it, whose force is `written` in the depth.
    fn judged(
        &self,
        swing: &Oscillator,
        letters: ImpactSymbols,
        written: &Expr,
    ) -> Result<Equation, ExprError> {
        let x = letters.coordinate;
        let sign = Expr::from(match self.side {
            Side::Left => -1,
            Side::Right => 1,
        });
        let inside = &sign * &(&Expr::from(x) - &Expr::from(letters.barrier));
        let pressed = written.substitute(letters.depth, &inside)?;
        let pressed = match self.loss {
            None => pressed,
            Some(loss) => {
                let inwards = &sign * &Expr::from(x.derivative());
                let damped = &Expr::from(letters.damping) * &inwards;
                match loss.law.dashpot() {
                    None => &pressed * &(&Expr::from(1) + &damped),
                    // The force of a spring is that of d + lambda d' in place of d.
                    Some(dashpot) => {
                        let force = &pressed + &written.substitute(letters.depth, &damped)?;
                        match dashpot {
                            Dashpot::Pulls => force,
                            Dashpot::DoesNotPull => {
                                Expr::function(Function::Maximum, vec![force, Expr::zero()])?
                            }
                        }
                    }
                }
            }
        };
        let pressed = &(&sign * &pressed) * &Expr::function(Function::Step, vec![inside])?;
        Ok(Equation { left: &swing.residual + &pressed, right: Expr::zero(), ..swing.equation() })
    }

    /// The equations and their forces.
    ///
    /// # Errors
    /// A swing that is not an oscillator or whose force depends on more than the position; a
    /// parameter without a value.
    pub(super) fn equations(&self) -> Result<ImpactEquations, ImpactError> {
        let swing = match &self.swing {
            Some(swing) => swing.clone(),
            None => Oscillator::parse(FREE_SWING)?,
        };
        let parts = swing.parts()?;
        if let Some(term) = [&parts.damping, &parts.inertia, &parts.forcing]
            .into_iter()
            .find(|part| !part.is_zero())
        {
            return Err(ImpactError::NotOfPosition {
                term: term.terms().first().unwrap_or(term).to_string(),
            });
        }
        let x = swing.coordinate;
        let acceleration = x.derivative().derivative();
        let mass = swing.residual.differentiate(acceleration)?;
        if mass.contains(x) {
            return Err(ImpactError::NotOfPosition {
                term: (&mass * &Expr::from(acceleration)).to_string(),
            });
        }
        let letters = self.letters(&swing);
        let own = |name: &Symbol| {
            let of_force = self.force.as_ref().is_some_and(|force| force.contains(*name));
            swing.parameters.contains(name)
                || of_force && *name != letters.stiffness && *name != letters.depth
        };
        if let Some((name, _)) = self.values.iter().find(|(name, _)| !own(name)) {
            return Err(ImpactError::Unknown { name });
        }
        let depth = Expr::from(letters.depth);
        let hertz = Expr::power(&depth, &Expr::number(ratio(3, 2)))?;
        let written = match &self.force {
            None => &Expr::from(letters.stiffness) * &hertz,
            Some(force) => force.clone(),
        };
        let (per_unit, stiffness) = match &self.force {
            None => (hertz, self.stiffness),
            Some(force) => (force.clone(), 1.0),
        };
        let judged = self.judged(&swing, letters, &written)?;
        let in_numbers = |expression: &Expr| -> Result<Expr, ExprError> {
            let mut expression = expression.clone();
            for (name, value) in self.values.iter() {
                expression = expression.substitute(name, value)?;
            }
            Ok(expression)
        };
        let function = |expression: &Expr, argument: Symbol| {
            let expression = in_numbers(expression)?;
            let known = [argument, letters.stiffness, Symbol::new("pi")];
            match expression.symbols().into_iter().find(|name| !known.contains(name)) {
                Some(name) => Err(ImpactError::NoValue { name }),
                None => Ok(CompiledFunction::new(&expression, &[argument, letters.stiffness])?),
            }
        };
        let (known, rest) = self.values.split(&swing.parameters);
        let numerical = with_numbers_where_needed(&swing, &known)?;
        let swing_in_numbers = swing.with_values(&known)?;
        let centred = centred(&swing_in_numbers, None).ok();
        if centred.as_ref().is_some_and(|centred| centred.cross_well.is_some()) {
            return Err(no_bottom(&swing_in_numbers).into());
        }
        let position = centred.as_ref().map(|centred| &centred.position);
        let equilibrium =
            position.and_then(|position| position.evaluate(&[].into()).ok()).unwrap_or(0.0);
        let through = (self.release - equilibrium) * (self.barrier - equilibrium) <= 0.0;
        if through && centred.is_some_and(|centred| centred.endless) {
            return Err(ImpactError::InfinitelyFast {
                force: swing.force.to_string(),
                place: equilibrium,
            });
        }
        let swing_alone = in_numbers(&swing.force)?;
        for place in [self.release, self.barrier].into_iter().filter(|place| place.is_finite()) {
            swing_alone.check_digits(&BTreeMap::from([(x, place)]), &[x])?;
        }
        let elastic = Expr::divide(&per_unit, &mass)?;
        Ok(ImpactEquations {
            equilibrium,
            forces: [
                function(&swing.force, x)?,
                function(&swing.force.differentiate(x)?, x)?,
                function(&elastic, letters.depth)?,
            ],
            near_touch: NearTouch::new(
                &in_numbers(&elastic)?,
                letters.depth,
                (letters.stiffness, self.stiffness),
            ),
            gamma: self.stiffness,
            judged: judged.to_string(),
            values: if numerical.is_some() { rest } else { self.values.clone() },
            swing: numerical.unwrap_or(swing),
            letters,
            stiffness,
        })
    }
}
