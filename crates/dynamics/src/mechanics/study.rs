//! The complete study of a mechanism, from its energies to its groups, which `lindstedt lagrange`
//! reports.

use std::collections::BTreeMap;

use super::modes::Jacobians;
use super::{
    Dimension, DriveAtRest, EquationsOfMotion, Groups, MechanicsError, Mechanism, Mode, Modes,
    Rest, equilibria,
};
use crate::symbol::Symbol;

/// A study of a mechanism: its energies, forces and values.
#[derive(Clone, Debug, PartialEq)]
pub struct MechanismQuestion {
    /// The mechanism.
    pub mechanism: Mechanism,
    /// The unit of every coordinate and parameter; if `None`, dimensions are not checked and there
    /// are no groups.
    pub units: Option<BTreeMap<Symbol, Dimension>>,
    /// The values of parameters; with the values of all, the modes are computed as numbers.
    pub values: BTreeMap<Symbol, f64>,
}

/// Everything that follows from the energies.
#[derive(Clone, Debug, PartialEq)]
pub struct MechanismStudy {
    /// The question that this answers.
    pub question: MechanismQuestion,
    /// The equations of motion.
    pub equations: EquationsOfMotion,
    /// The equilibria, with the small oscillations about them.
    pub rests: Vec<RestStudy>,
    /// The dimensionless form; `None` without units.
    pub groups: Option<Result<Groups, MechanicsError>>,
}

/// The study of an equilibrium.
#[derive(Clone, Debug, PartialEq)]
pub struct RestStudy {
    /// The equilibrium.
    pub rest: Rest,
    /// The effect there of explicit time dependence, which the linear equations leave out.
    pub drive: DriveAtRest,
    /// The linear equations there.
    pub modes: Modes,
    /// The modes as numbers; `None` if a parameter has no value, or the equilibrium does not exist
    /// for these values.
    pub numbers: Option<Result<Vec<Mode>, MechanicsError>>,
}

/// Derives the equations, checks the units, finds the equilibria and linearises about them.
///
/// # Errors
/// [`MechanicsError`] with the term or the name concerned.
///
/// ```
/// # use lindstedt_dynamics as lindstedt;
/// use lindstedt::mechanics::{Mechanism, MechanismQuestion, study};
///
/// let units = [("x", "1"), ("m", "kg"), ("L", "m"), ("g", "m/s^2"), ("c", "kg m^2/s")];
/// let mut mechanism = Mechanism::parse(&["x"], "m*L^2*x'^2/2", "m*g*L*(1 - cos(x))")?;
/// mechanism.dissipation = "c*x'^2/2".parse()?;
/// let units = units.map(|(name, unit)| Ok((name.into(), unit.parse()?)));
/// let study = study(MechanismQuestion {
///     mechanism,
///     units: Some(units.into_iter().collect::<Result<_, lindstedt::mechanics::UnitError>>()?),
///     values: Default::default(),
/// })?;
/// let groups = study.groups.ok_or("no units")??;
/// let names: Vec<&str> = groups.groups.iter().map(|group| group.name.name()).collect();
/// assert_eq!(names, ["zeta"]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn study(question: MechanismQuestion) -> Result<MechanismStudy, MechanicsError> {
    let mechanism = &question.mechanism;
    let equations = mechanism.equations()?;
    let parameters = mechanism.parameters();
    if let Some(unknown) = question.values.keys().find(|name| !parameters.contains(name)) {
        return Err(MechanicsError::UnknownValue(*unknown));
    }
    if let Some(units) = &question.units {
        mechanism.check_units(units)?;
        equations.check_units(&mechanism.all_units(units))?;
    }
    let jacobians = Jacobians::new(&equations)?;
    let mut rests = Vec::new();
    for rest in equilibria(&equations)? {
        let modes = jacobians.modes_at(&equations, &rest)?;
        // An equilibrium whose cosine lies beyond 1 does not exist for these values.
        let exists = rest.condition.as_ref().is_none_or(|cosine| {
            let value = cosine.evaluate(&question.values);
            value.is_ok_and(|value| value.abs() <= 1.0)
        });
        let needed = modes.parameters();
        let known = (needed.is_empty() || !question.values.is_empty())
            && needed.iter().all(|name| question.values.contains_key(name));
        let numbers = (known && exists).then(|| modes.numbers(&question.values));
        let drive = equations.drive_at(&rest).map_err(MechanicsError::from)?;
        rests.push(RestStudy { rest, drive, modes, numbers });
    }
    let groups =
        question.units.as_ref().map(|units| Groups::from_mechanism(mechanism, &equations, units));
    Ok(MechanismStudy { equations, rests, groups, question })
}
