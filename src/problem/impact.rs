//! The input of `impact` from a problem file: an undamped swing and its barrier, released from
//! rest.

use super::{Barrier, BarrierSide, Order, Problem, ProblemError, ReadingCommand, refused};
use crate::expr::{Expr, parse_expression};
use crate::impact::contact::{ContactLaw, LossyLaw};
use crate::impact::hertz::{NotPositive, StiffnessDesign};
use crate::impact::{
    CollisionError, ContactDamping, ContactLoss, ContactScales, LossAmount, Rule, Setup, Side,
    SpeedUnit, UnknownRule,
};
use crate::oscillator::Oscillator;
use crate::solution::{AmplitudeConvention, Method};
use crate::spelling::nearest;
use crate::symbol::Symbol;
use crate::values::Values;

/// The impact of a problem file, in SI units if the file has them.
///
/// ```
/// use lindstedt::impact::{Setup, solve};
/// use lindstedt::problem::Problem;
///
/// let file: Problem = "[pendulum]\nmass = 0.02\nlength = 0.25".parse()?;
/// let si = solve(Setup::try_from(&file)?)?.si().ok_or("no units")?;
/// assert!((si.units.time() - (0.25_f64 / 9.81).sqrt()).abs() < 1e-15); // s
/// assert!(si.peak_force.runge_kutta > 1000.0 * 0.02 * 9.81); // N
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
impl TryFrom<&Problem> for Setup {
    type Error = ProblemError;

    /// ```
    /// use lindstedt::impact::{Setup, solve};
    /// use lindstedt::problem::Problem;
    ///
    /// let file: Problem = "[contact]\ngamma = 1e6".parse()?;
    /// let impact = solve(Setup::try_from(&file)?)?;
    /// assert!((impact.truth.penetration - 0.00544677).abs() < 1e-8);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    fn try_from(problem: &Problem) -> Result<Self, ProblemError> {
        problem.check_keys(ReadingCommand::Impact)?;
        let (damping, contact) = (&problem.damping, &problem.contact);
        let damps =
            [damping.zeta, damping.alpha].into_iter().chain(damping.viscous).chain(damping.torque);
        if damps.into_iter().any(|number| number != 0.0) {
            return refused(
                "the flights in closed form are those of the undamped equation (9): leave out zeta and alpha, or use `lindstedt simulate`",
            );
        }
        if problem.excitation.beta != 0.0 {
            return refused(
                "the three phases in closed form are those of the free motion, equation (9): leave out [excitation], or use \
                 `lindstedt simulate`",
            );
        }
        if problem.pendulum.speed.is_some_and(|speed| speed != 0.0) {
            return refused(
                "the three phases begin at rest: leave out `speed`, or use `lindstedt simulate`",
            );
        }
        let swing = swing(problem)?;
        let lossy = LossInWords::from_problem(problem)?;
        let dashpot = lossy.as_ref().and_then(|words| words.law?.dashpot());
        let force = match force(problem)? {
            None if dashpot.is_some() => {
                Some(Expr::from(Symbol::new("gamma")) * Expr::from(Symbol::new("d")))
            }
            force => force,
        };
        let given = ImpactValues::from_problem(problem, swing.as_ref(), force.is_some())?;
        let side = match problem.pendulum.side {
            Some(BarrierSide::Left) => Side::Left,
            Some(BarrierSide::Right) | None => Side::Right,
        };
        let amplitude = given.amplitude.unwrap_or(problem.pendulum.amplitude);
        if !(amplitude.is_finite() && amplitude > 0.0) && problem.pendulum.start.is_none() {
            return Err(CollisionError::Amplitude(amplitude).into());
        }
        let release = problem.pendulum.start.unwrap_or(-side.sign() * amplitude);
        let barrier = match given.barrier {
            Some(barrier) => barrier,
            None => barrier(problem.pendulum.barrier, side, release)?,
        };
        let (stiffness, source) = match given.stiffness {
            Some(stiffness) => (stiffness, "given"),
            None => problem.stiffness()?,
        };
        let gives_stiffness = contact.gamma.is_some() || given.stiffness.is_some();
        if let Some(force) = &force
            && gives_stiffness
            && !force.contains(Symbol::new("gamma"))
        {
            return refused(format!(
                "gamma says nothing beside the force `{force}`: write it into the force, or leave it out"
            ));
        }
        let is_hertz = swing.is_none() && force.is_none();
        let has_stiffness = |force: &Expr| force.contains(Symbol::new("gamma"));
        let gamma_follows = !gives_stiffness && force.as_ref().is_none_or(has_stiffness);
        let units = problem.units(is_hertz, gamma_follows)?;
        let is_all = |name: &Option<String>| {
            name.as_deref().and_then(|name| name.split_whitespace().next()) == Some(EVERY_LAW)
        };
        Ok(Self {
            swing,
            values: given.others,
            release,
            barrier,
            side,
            stiffness,
            stiffness_source: source.to_owned(),
            units,
            force,
            method: method(problem)?,
            order: problem.order.and_then(Order::power),
            degrees: problem.order.and_then(Order::degrees),
            amplitude_convention: convention(problem)?,
            rule: linearisation(problem)?,
            contact_law: match contact.law.as_deref() {
                None | Some(EVERY_LAW) => ContactLaw::default(),
                Some(_) if lossy.is_some() => ContactLaw::default(),
                Some(name) => name.parse()?,
            },
            every_contact_law: is_all(&contact.law) || is_all(&contact.linearisation),
            loss: loss(problem, lossy.as_ref(), stiffness)?,
            integrator_tolerance: problem.run.integrator_tolerance,
            step_limit: problem.run.step_limit,
            ..Self::default()
        })
    }
}

/// The numbers of an impact that are given among the values, by the symbols of the printed
/// equation, and the other values.
struct ImpactValues {
    amplitude: Option<f64>,
    barrier: Option<f64>,
    stiffness: Option<f64>,
    others: Values,
}

impl ImpactValues {
    /// Reads the values of a problem; numbers that are not among them have their own keys.
    ///
    /// # Errors
    /// A number given in both ways, or for a given equation in neither.
    fn from_problem(
        problem: &Problem,
        swing: Option<&Oscillator>,
        has_force: bool,
    ) -> Result<Self, ProblemError> {
        let parameters = swing.map_or(&[][..], |swing| &swing.parameters);
        let coordinate = swing.map_or("x", |swing| swing.coordinate.name());
        let letters = [
            ("A".to_owned(), "A", "[pendulum] amplitude"),
            (format!("{coordinate}c"), "xc", "[pendulum] barrier"),
            ("gamma".to_owned(), "gamma", "[contact] gamma"),
        ];
        let values = problem.values_of_motion()?;
        let own = letters.each_ref().map(|(name, ..)| Symbol::new(name));
        let own: Vec<Symbol> = own.into_iter().filter(|name| !parameters.contains(name)).collect();
        let (_, others) = values.split(&own);
        let mut found = [None; 3];
        for ((written, letter, key), found) in letters.iter().zip(&mut found) {
            let name = Symbol::new(written);
            *found = own.contains(&name).then(|| values.get(name)).flatten();
            // The command line wins over the file.
            let wins = problem.overriding.contains(written);
            if found.is_some() && problem.has_key(key) && !wins {
                return refused(format!(
                    "`{letter}` in [values] and `{key}` say the same: give one of them"
                ));
            }
        }
        let starts = problem.pendulum.start.is_some();
        let gives = |index: usize| found[index].is_some() || problem.has_key(letters[index].2);
        if starts && gives(0) {
            return refused(
                "`amplitude` says nothing beside `start`, where the swing is released: give one of them",
            );
        }
        if swing.is_some() {
            let given = [gives(0) || starts, gives(1), gives(2) || has_force];
            let missing = letters.iter().zip(given).filter(|(_, given)| !given);
            let missing: Vec<&str> = missing.map(|((name, ..), _)| name.as_str()).collect();
            if !missing.is_empty() {
                let (barrier, missing) = (&letters[1].0, missing.join(" and "));
                return refused(format!(
                    "an equation of your own needs a release A, a barrier {barrier} and its stiffness gamma, or a `force`: give \
                     {missing}, such as --at A=1 --at {barrier}=0.3 --at gamma=1e6"
                ));
            }
        }
        let [amplitude, barrier, stiffness] = found;
        Ok(Self { amplitude, barrier, stiffness, others })
    }
}

/// The position of the barrier on this side; one on the other side is never touched if it lies
/// beyond the release.
fn barrier(barrier: Barrier, side: Side, release: f64) -> Result<f64, ProblemError> {
    match (barrier, side) {
        (Barrier::Absent(_), _) => refused(
            "an impact needs a barrier: leave out `barrier = false`, or follow the free swing by `lindstedt simulate`",
        ),
        (Barrier::One(position), _) => Ok(position),
        (Barrier::Both([left, right]), Side::Right) if left < release => Ok(right),
        (Barrier::Both([left, right]), Side::Left) if right > release => Ok(left),
        (Barrier::Both(_), _) => refused(
            "released from rest at x = -amplitude the pendulum starts behind the left barrier: move it below -amplitude",
        ),
    }
}

/// The swing, about the equilibrium asked for.
fn swing(problem: &Problem) -> Result<Option<Oscillator>, ProblemError> {
    problem.check_derived_equation()?;
    let Some(equation) = &problem.equation else {
        return match problem.about {
            None => Ok(None),
            Some(_) => refused(
                "`about` chooses an equilibrium of `equation`: the pendulum has one, leave it out",
            ),
        };
    };
    let swing = Oscillator::parse(equation)?;
    let Some(text) = &problem.about else {
        return Ok(Some(swing));
    };
    let coordinate = swing.coordinate;
    let place = text.split_once('=').filter(|(name, _)| name.trim() == coordinate.name());
    let place = place.and_then(|(_, place)| parse_expression(place).ok());
    let known = |place: &Expr| place.symbols().iter().all(|name| swing.parameters.contains(name));
    match place.filter(known) {
        Some(place) => Ok(Some(swing.about(place))),
        None => refused(format!(
            "about = \"{text}\": expected \"{coordinate} = VALUE\", an equilibrium of the coordinate {coordinate}"
        )),
    }
}

/// The whole force of the barrier.
fn force(problem: &Problem) -> Result<Option<Expr>, ProblemError> {
    let Some(text) = &problem.contact.force else {
        return Ok(None);
    };
    let refusal = |error| ProblemError::new(format!("[contact] force = \"{text}\": {error}"));
    parse_expression(text).map(Some).map_err(refusal)
}

fn method(problem: &Problem) -> Result<Option<Method>, ProblemError> {
    let Some(name) = &problem.method else {
        return Ok(None);
    };
    let unknown = || {
        let near = nearest(name, Method::ALL.iter().map(|method| method.name()));
        let near = near.map_or(String::new(), |near| format!(": did you mean `{near}`?"));
        ProblemError::new(format!("unknown method `{name}`{near}"))
    };
    Method::from_name(name).map(Some).ok_or_else(unknown)
}

fn convention(problem: &Problem) -> Result<Option<AmplitudeConvention>, ProblemError> {
    let Some(name) = &problem.amplitude else {
        return Ok(None);
    };
    let unknown = || {
        ProblemError::new(format!("unknown amplitude `{name}`: choose initial or first-harmonic"))
    };
    AmplitudeConvention::from_name(name).map(Some).ok_or_else(unknown)
}

/// The word for a table of all laws in place of the name of one.
const EVERY_LAW: &str = "all";

/// The rule that replaces the elastic force by a line.
fn linearisation(problem: &Problem) -> Result<Rule, UnknownRule> {
    match problem.contact.linearisation.as_deref() {
        None | Some(EVERY_LAW) => Ok(Rule::default()),
        Some(name) => name.parse(),
    }
}

/// What a problem says of a contact that loses energy: `kelvin-voigt restitution=0.8`, `all restitution=0.8`.
struct LossInWords {
    /// The law; `None` for every one.
    law: Option<LossyLaw>,
    /// The restitution that stands beside its name.
    restitution: Option<f64>,
}

impl LossInWords {
    /// The words of the problem; `None` for a law without loss, and for a table of those.
    ///
    /// # Errors
    /// Words beside the name that are not a restitution.
    fn from_problem(problem: &Problem) -> Result<Option<Self>, ProblemError> {
        let Some(text) = &problem.contact.law else { return Ok(None) };
        let mut words = text.split_whitespace();
        let name = words.next().unwrap_or_default();
        let law = LossyLaw::from_name(name);
        if law.is_none() && name != EVERY_LAW {
            return Ok(None);
        }
        let mut restitution = None;
        for word in words {
            let value = word.strip_prefix("restitution=").and_then(|value| value.parse().ok());
            let (Some(value), None) = (value, restitution) else {
                return refused(format!(
                    "`{word}` says nothing beside {name}: write \"{name} restitution=0.8\""
                ));
            };
            restitution = Some(value);
        }
        Ok((law.is_some() || restitution.is_some()).then_some(Self { law, restitution }))
    }

    /// The name of the law, as it is typed.
    fn name(&self) -> &'static str {
        self.law.map_or(EVERY_LAW, LossyLaw::name)
    }
}

/// The loss in the contact.
fn loss(
    problem: &Problem,
    lossy: Option<&LossInWords>,
    stiffness: f64,
) -> Result<Option<ContactLoss>, ProblemError> {
    let contact = &problem.contact;
    let beside = lossy.and_then(|law| law.restitution);
    if beside.is_some() && contact.restitution.is_some() {
        return refused(
            "the restitution stands beside the law and in [contact] restitution: give it once",
        );
    }
    let losses = [
        ("mu", contact.mu),
        ("mu_over_gamma", contact.mu_over_gamma),
        ("lambda", contact.lambda),
        ("restitution", contact.restitution.or(beside)),
        ("damping", contact.damping),
    ];
    let given: Vec<(&'static str, f64)> =
        losses.into_iter().filter_map(|(key, value)| value.map(|value| (key, value))).collect();
    if contact.at_speed.is_some() && contact.restitution.is_none() {
        return refused(
            "[contact] at_speed changes nothing without restitution: give that too, or leave it out",
        );
    }
    let (key, value) = match given[..] {
        [] => {
            return match lossy {
                Some(words) => refused(format!(
                    "the law {name} loses energy, and says not how much: write \"{name} restitution=0.8\"",
                    name = words.name()
                )),
                None => Ok(None),
            };
        }
        [one] => one,
        [(one, _), (other, _), ..] => {
            return refused(format!(
                "[contact] has both {one} and {other}: either says what the contact loses, give one of them"
            ));
        }
    };
    let of_restitution = key == "restitution";
    if of_restitution && !(value > 0.0 && value <= 1.0) {
        return refused(format!(
            "[contact] restitution must lie above 0 and be at most 1, not {value}: 1 is a contact without loss"
        ));
    }
    let no_damping = || {
        refused(format!(
            "[contact] {key} must be a number and not negative, not {value}: 0 is a contact without loss"
        ))
    };
    if !(value.is_finite() && value >= 0.0) {
        return no_damping();
    }
    let law = lossy.and_then(|words| words.law).unwrap_or(LossyLaw::HuntCrossley);
    if law.dashpot().is_some() && (!of_restitution || contact.at_speed.is_some()) {
        let key = if of_restitution { "at_speed" } else { key };
        return refused(format!(
            "[contact] {key} says nothing beside {}, whose restitution is the same at any speed: give that alone",
            law.name()
        ));
    }
    // This value means a contact without loss.
    if value == if of_restitution { 1.0 } else { 0.0 } {
        return Ok(None);
    }
    if !of_restitution && (problem.equation.is_some() || contact.force.is_some()) {
        return refused(format!(
            "[contact] {key} belongs to the pendulum at the barrier of Hertz: with an `equation` or a `force` give `restitution`"
        ));
    }
    let laws = [("law", &contact.law), ("linearisation", &contact.linearisation)];
    let without_loss = |(key, name): &(&str, &Option<String>)| {
        let is_every = name.as_deref() == Some(EVERY_LAW);
        name.is_some() && !(*key == "law" && (lossy.is_some() || is_every))
    };
    if let Some((law, _)) = laws.into_iter().find(without_loss) {
        return refused(format!(
            "[contact] {law} is that of a contact without loss: beside {key} the law is that of Hunt and Crossley, leave one of them out"
        ));
    }
    if of_restitution && contact.at_speed.is_none() {
        return Ok(Some(ContactLoss { law, amount: LossAmount::Restitution(value) }));
    }
    let StiffnessDesign { mass, length, gravity, .. } = problem.design()?;
    let needed: &[(&'static str, f64)] = match key {
        "lambda" => &[("length", length), ("gravity", gravity)],
        "damping" => &[("mass", mass), ("length", length), ("gravity", gravity)],
        _ if problem.speed_unit(&[]) == SpeedUnit::MetresPerSecond => {
            &[("length", length), ("gravity", gravity)]
        }
        _ => &[],
    };
    let none = |value: &f64| !(value.is_finite() && *value > 0.0);
    if let Some(&(quantity, value)) = needed.iter().find(|(_, value)| none(value)) {
        return Err(NotPositive { quantity, value }.into());
    }
    let scales = ContactScales {
        gamma: stiffness,
        mass,
        length,
        gravity,
        speed: contact
            .at_speed
            .map(|speed| problem.speed_unit(&[]).dimensionless(speed, length, gravity)),
    };
    let Some(damping) = contact.given_damping() else {
        return Ok(None);
    };
    match damping.in_form(ContactDamping::MuOverGamma(0.0), &scales)?.value() {
        ratio if ratio.is_finite() => {
            Ok(Some(ContactLoss { law, amount: LossAmount::Damping(ratio) }))
        }
        _ => no_damping(),
    }
}
