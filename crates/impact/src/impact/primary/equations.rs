//! The equations of every phase, from the energies.
//!
//! ```text
//! flight:   x' = v, y' = u, (v', u') = M^-1 h
//! contact:  the rates of flight with the force of the barrier, in s: see `regularised`
//! held:     y' = u, u' = b with v = v' = 0
//! ```
//!
//! The energies taken by damping and supplied by the force are integrated with the states.

use std::cell::{Ref, RefCell};
use std::collections::BTreeMap;
use std::rc::Rc;
use std::sync::LazyLock;

use super::super::model::{Friction, STEEPNESS, Side};
use super::super::regularised::regularised;
use super::{PrimaryCase, PrimaryError};
use crate::expr::{Expr, parse_expression};
use crate::mechanics::{MechanicsError, Mechanism};
use crate::symbol::Symbol;
use crate::system::{Event, Solver, System, SystemOptions};

/// Number of energies integrated with the states: viscous, friction, contact, dashpot, force.
pub(super) const ACCOUNTS: usize = 5;

/// The equations of motion of every case, from the energies.
struct Accelerations {
    /// x'', y'' with `P` for the torque of a contact and `G` for that of friction.
    free: [Expr; 2],
    /// y'' of the main mass with the pendulum held.
    held: Expr,
}

/// The accelerations, derived once for all cases.
static DERIVED: LazyLock<Result<Accelerations, MechanicsError>> = LazyLock::new(derive);

/// The equations of one case.
pub(super) struct PrimaryEquations {
    accelerations: &'static Accelerations,
    numbers: BTreeMap<Symbol, f64>,
    case: PrimaryCase,
    /// The systems of the phases met so far, because a motion repeats the same phases.
    built: RefCell<Vec<(PhaseKey, Rc<PhaseSystem>)>>,
    derived: DerivedSolvers,
}

/// A phase with equations of its own: in the barrier of a side or in none, and the direction in
/// which dry friction acts.
type PhaseKey = (Option<Side>, f64);

/// The system of a phase: its states, followed by the energies that change in it.
pub(super) struct PhaseSystem {
    system: System,
    /// Indices of these accounts.
    pub(super) accounts: Vec<usize>,
    /// Solvers for the events with which it has been followed.
    solvers: RefCell<Vec<Solver>>,
    derived: DerivedSolvers,
}

/// The solvers of several cases whose recurrences were derived: those of cases that differ in numbers are computed
/// side by side.
pub(super) type DerivedSolvers = Rc<RefCell<Vec<Solver>>>;

impl PhaseSystem {
    /// The place of the solver that follows the phase until one of these events. All runs have the same options.
    pub(super) fn place_of_solver(&self, events: &[Event], options: &SystemOptions) -> usize {
        let mut solvers = self.solvers.borrow_mut();
        let place = solvers.iter().position(|solver| solver.events() == events);
        place.unwrap_or_else(|| {
            let mut derived = self.derived.borrow_mut();
            let known =
                derived.iter().find_map(|own| own.for_system(&self.system, events, options));
            solvers.push(known.unwrap_or_else(|| {
                let own = self.system.clone().solver(events, options);
                derived.push(own.clone());
                own
            }));
            solvers.len() - 1
        })
    }

    /// The solver at a place.
    pub(super) fn solver(&self, place: usize) -> Ref<'_, Solver> {
        Ref::map(self.solvers.borrow(), |solvers| &solvers[place])
    }
}

/// Parses an expression of this file.
fn parsed(text: &str) -> Expr {
    parse_expression(text).unwrap_or_else(|_| Expr::zero())
}

fn derive() -> Result<Accelerations, MechanicsError> {
    let mut mechanism = Mechanism::parse(
        &["x", "y"],
        "R*y'^2/2 + ((y' + x'*cos(x))^2 + (x'*sin(x))^2)/2",
        "kappa*y^2/2 + 1 - cos(x)",
    )?;
    mechanism.dissipation = parsed("delta*y'^2/2 + zeta*x'^2");
    mechanism.forces =
        [(Symbol::new("x"), parsed("P + G")), (Symbol::new("y"), parsed("f*sin(eta*t)"))].into();
    let equations = mechanism.equations()?;
    let accelerations = equations.accelerations()?;
    let [x, y] = accelerations.as_slice() else {
        return Err(MechanicsError::CoordinateCount(accelerations.len()));
    };
    // With the pendulum held, the second equation alone determines the main mass.
    let at_rest: BTreeMap<Symbol, Expr> = [(Symbol::new("x'"), Expr::zero())].into();
    let (mass, rest) = (
        &equations.mass[1][1],
        equations.rest[1].substitute_all(&at_rest).map_err(MechanicsError::from)?,
    );
    let held = Expr::divide(&-rest, mass).map_err(MechanicsError::from)?;
    Ok(Accelerations { free: [x.clone(), y.clone()], held })
}

impl PrimaryEquations {
    pub(super) fn new(case: PrimaryCase, derived: DerivedSolvers) -> Result<Self, PrimaryError> {
        let accelerations = DERIVED.as_ref().map_err(Clone::clone)?;
        let (primary, model) = (case.primary, case.model);
        let numbers = [
            ("R", primary.mass),
            ("kappa", primary.stiffness),
            ("delta", primary.damping),
            ("f", primary.force),
            ("eta", primary.frequency),
            ("zeta", model.zeta),
            ("alpha", model.alpha),
            ("gamma", model.gamma),
            ("mu", model.mu),
        ];
        Ok(Self {
            accelerations,
            numbers: numbers.map(|(name, value)| (Symbol::new(name), value)).into(),
            case,
            built: RefCell::default(),
            derived,
        })
    }

    /// The system of a phase, built when it is first met.
    fn cached_system(
        &self,
        phase: PhaseKey,
        build: impl FnOnce() -> Result<PhaseSystem, PrimaryError>,
    ) -> Result<Rc<PhaseSystem>, PrimaryError> {
        let known = self.built.borrow().iter().find(|own| own.0 == phase).map(|own| own.1.clone());
        if let Some(known) = known {
            return Ok(known);
        }
        let followed = Rc::new(build()?);
        self.built.borrow_mut().push((phase, followed.clone()));
        Ok(followed)
    }

    /// The torque of dry friction in this direction, and its power loss.
    fn friction(&self, direction: f64) -> [Expr; 2] {
        let torque = match self.case.model.friction {
            _ if self.case.model.alpha == 0.0 => Expr::zero(),
            Friction::Exact => parsed("alpha") * Expr::from(direction as i64),
            Friction::Arctangent => parsed(&format!("alpha*2/pi*atan({STEEPNESS}*x')")),
        };
        let power = &torque * &parsed("x'");
        [-torque, power]
    }

    /// Rates of the accounts: viscous, friction, contact, dashpot, force.
    fn accounts(&self, friction: Expr, contact: Expr) -> [Expr; ACCOUNTS] {
        [parsed("2*zeta*x'^2"), friction, contact, parsed("delta*y'^2"), parsed("f*sin(eta*t)*y'")]
    }

    fn substitute_values(
        &self,
        expression: &Expr,
        values: &[(&str, Expr)],
    ) -> Result<Expr, PrimaryError> {
        let values: BTreeMap<Symbol, Expr> =
            values.iter().map(|(name, value)| (Symbol::new(name), value.clone())).collect();
        Ok(expression.substitute_all(&values).map_err(MechanicsError::from)?)
    }

    /// The equations of these states and the accounts that change; `more` are additional numbers of
    /// this phase.
    fn followed(
        &self,
        states: &[&str],
        time: &str,
        right: &[Expr],
        more: &[(&str, f64)],
    ) -> Result<PhaseSystem, PrimaryError> {
        // Terms with a zero factor and energies that do not change are left out to save time.
        let absent = self.numbers.iter().filter(|(_, value)| **value == 0.0);
        let absent: BTreeMap<Symbol, Expr> =
            absent.map(|(name, _)| (*name, Expr::zero())).collect();
        let right: Vec<Expr> = right
            .iter()
            .map(|rate| rate.substitute_all(&absent).map_err(MechanicsError::from))
            .collect::<Result<_, _>>()?;
        let (own_rates, account_rates) = right.split_at(states.len());
        let accounts: Vec<usize> =
            (0..account_rates.len()).filter(|account| !account_rates[*account].is_zero()).collect();
        let names = accounts.iter().map(|account| Symbol::new(&format!("account{account}")));
        let names: Vec<Symbol> = states.iter().map(|name| Symbol::new(name)).chain(names).collect();
        let rates = accounts.iter().map(|account| account_rates[*account].clone());
        let rates: Vec<Expr> = own_rates.iter().cloned().chain(rates).collect();
        let system = System::new(&names, Symbol::new(time), &rates, &self.numbers_and(more))?;
        let derived = self.derived.clone();
        Ok(PhaseSystem { system, accounts, solvers: RefCell::default(), derived })
    }

    /// The numbers of the case, and these in addition.
    fn numbers_and(&self, more: &[(&str, f64)]) -> BTreeMap<Symbol, f64> {
        let mut numbers = self.numbers.clone();
        numbers.extend(more.iter().map(|(name, value)| (Symbol::new(name), *value)));
        numbers
    }

    /// The torque on a pendulum at rest, which friction must hold: x'' + y'' cos x + sin x = P + G
    /// with x'' = 0.
    fn torque_at_rest(&self) -> Expr {
        parsed("P") - parsed("sin(x)") - parsed("cos(x)") * self.accelerations.held.clone()
    }

    /// The system away from the barriers, moving in this direction if dry friction needs one.
    pub(super) fn flight(&self, direction: f64) -> Result<Rc<PhaseSystem>, PrimaryError> {
        self.cached_system((None, direction), || self.flight_system(direction))
    }

    fn flight_system(&self, direction: f64) -> Result<PhaseSystem, PrimaryError> {
        let [torque, power] = self.friction(direction);
        let mut right = vec![parsed("x'")];
        let put = |acceleration: &Expr| {
            self.substitute_values(acceleration, &[("P", Expr::zero()), ("G", torque.clone())])
        };
        let [x, y] = [put(&self.accelerations.free[0])?, put(&self.accelerations.free[1])?];
        right.extend([x, parsed("y'"), y]);
        right.extend(self.accounts(power, Expr::zero()));
        self.followed(&["x", "x'", "y", "y'"], "t", &right, &[])
    }

    /// The system in the barrier of a side, at its position, in s; the force is that of Hertz and
    /// of Hunt and Crossley.
    pub(super) fn contact(
        &self,
        side: Side,
        place: f64,
        direction: f64,
    ) -> Result<Rc<PhaseSystem>, PrimaryError> {
        self.cached_system((Some(side), direction), || self.contact_system(side, place, direction))
    }

    fn contact_system(
        &self,
        side: Side,
        place: f64,
        direction: f64,
    ) -> Result<PhaseSystem, PrimaryError> {
        let [torque, power] = self.friction(direction);
        let put =
            |acceleration: &Expr| self.substitute_values(acceleration, &[("G", torque.clone())]);
        let [x, y] = [put(&self.accelerations.free[0])?, put(&self.accelerations.free[1])?];
        let mut rates = vec![x, parsed("y'"), y, Expr::one()];
        rates.extend(self.accounts(power, parsed("mu*x'^2*w^3")));
        let right = regularised(&rates, side).map_err(MechanicsError::from)?;
        self.followed(&["w", "x'", "y", "y'", "t"], "s", &right, &[("x_c", place)])
    }

    /// The main mass alone with the pendulum held at x; friction must balance the torque on the
    /// pendulum.
    pub(super) fn equations_when_held(
        &self,
        x: f64,
        contact: f64,
    ) -> Result<(PhaseSystem, Expr), PrimaryError> {
        let still = [("x'", Expr::zero())];
        let mut right = vec![parsed("y'"), self.accelerations.held.clone()];
        for account in self.accounts(Expr::zero(), Expr::zero()) {
            right.push(self.substitute_values(&account, &still)?);
        }
        let followed = self.followed(&["y", "y'"], "t", &right, &[("x", x), ("P", contact)])?;
        Ok((followed, self.torque_at_rest()))
    }

    /// x'' away from the barriers, as a number; dry friction acts in this direction.
    pub(super) fn acceleration(
        &self,
        t: f64,
        state: [f64; 4],
        direction: f64,
    ) -> Result<f64, PrimaryError> {
        let [torque, _] = self.friction(direction);
        let rate = self.substitute_values(
            &self.accelerations.free[0],
            &[("P", Expr::zero()), ("G", torque)],
        )?;
        let [x, velocity, y, speed] = state;
        let values =
            self.numbers_and(&[("t", t), ("x", x), ("x'", velocity), ("y", y), ("y'", speed)]);
        Ok(rate.evaluate(&values).unwrap_or(f64::NAN))
    }

    /// The torque that friction must hold, as a number.
    pub(super) fn torque(&self, t: f64, x: f64, contact: f64, [y, speed]: [f64; 2]) -> f64 {
        let values =
            self.numbers_and(&[("t", t), ("x", x), ("P", contact), ("y", y), ("y'", speed)]);
        self.torque_at_rest().evaluate(&values).unwrap_or(f64::NAN)
    }
}
