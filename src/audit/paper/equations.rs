//! The paper's equations (1) to (8), each compared with the equation that follows from the energies
//! of its pendulum and barrier.
//!
//! A printed equation is never computed with: it is compared with the derived one term by term and
//! unit by unit.

use std::collections::BTreeMap;

use crate::expr::{Expr, ExprError, Function, Node};
use crate::mechanics::dimension::{Dimension, check, dimension};
use crate::mechanics::{EquationsOfMotion, Groups, MechanicsError, Mechanism, MechanismQuestion};
use crate::symbol::Symbol;

/// An equation of the paper.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "json", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Finding {
    /// Its number: `(1)`.
    pub equation: String,
    /// What is printed.
    pub printed: String,
    /// Whether it follows as it is printed; null where it is put in and not derived.
    pub agrees: Option<bool>,
    /// What was found, in words.
    pub words: String,
}

/// T of equation (1) as it is printed, without the square on its last term.
const PRINTED_KINETIC: &str = "m/2*((Ae*Omega*cos(Omega*t) + L*x'*cos(x))^2 + L*x'*sin(x))";
/// T with the square.
const KINETIC: &str = "m/2*((Ae*Omega*cos(Omega*t) + L*x'*cos(x))^2 + (L*x'*sin(x))^2)";
/// V of equation (2).
const POTENTIAL: &str = "m*g*L*(1 - cos(x))";
/// F_c of equation (3), the force between sphere and barrier.
const CONTACT_FORCE: &str = "4*E/3*sqrt(R)*(l*sin(x - xc))^(3/2)";
/// V_c of equation (4); omega is sqrt(g/L).
const CONTACT_DAMPING: &str = "mu4*sqrt(g/L)*x'*sin(x - xc)^(3/2)";
/// Equation (5) without its contact, with 2 zeta omega = c/(m L^2), alpha omega^2 = F/(m L^2) and
/// omega^2 = g/L.
const PRINTED_SWING: &str =
    "x'' + c*x'/(m*L^2) + F*sgn(x')/(m*L^2) - Ae*Omega^2/L*sin(Omega*t)*cos(x) + g/L*sin(x)";
/// Equation (7), with sgn(x') in the place of equation (6).
const PRINTED_SCALED: &str = "x'' + 2*zeta*x' + alpha*sgn(x') - beta*sin(eta*t)*cos(x) + sin(x) + (gamma + mu*x')*(x - xc)^(3/2)*H(x - xc)";
/// gamma and beta of equation (8), with omega^2 = g/L.
const PRINTED_GROUPS: [(&str, &str); 2] =
    [("gamma", "4*l^(5/2)*E*sqrt(R)/(3*g*m*L)"), ("beta", "Ae*Omega^2/g")];

/// The paper's mechanism: a pendulum on a driven pivot that meets an elastic barrier, with viscous
/// and dry friction. Hertz's force acts on the lever l, the damping of equation (4) is a torque; Ae
/// is the amplitude A of the pivot, mu4 the mu of equation (4).
pub fn pendulum() -> Mechanism {
    let read = |text: &str| text.parse::<Expr>().unwrap_or_else(|_| Expr::zero());
    let contact = format!("-H(x - xc)*(l*{CONTACT_FORCE} + {CONTACT_DAMPING})");
    Mechanism {
        coordinates: vec![Symbol::new("x")],
        kinetic: read(KINETIC),
        potential: read(POTENTIAL),
        dissipation: read("c*x'^2/2 + F*abs(x')"),
        forces: [(Symbol::new("x"), read(&contact))].into(),
    }
}

/// The units of the letters of [`pendulum`].
pub fn units() -> BTreeMap<Symbol, Dimension> {
    [
        ("x", [0, 0, 0]),
        ("xc", [0, 0, 0]),
        ("m", [1, 0, 0]),
        ("L", [0, 1, 0]),
        ("l", [0, 1, 0]),
        ("R", [0, 1, 0]),
        ("Ae", [0, 1, 0]),
        ("Omega", [0, 0, -1]),
        ("g", [0, 1, -2]),
        ("E", [1, -1, -2]),
        ("c", [1, 2, -1]),
        ("F", [1, 2, -2]),
        // A torque over omega x', as equations (5) and (7) imply.
        ("mu4", [1, 2, 0]),
    ]
    .map(|(name, exponents)| (Symbol::new(name), Dimension::from_exponents(exponents)))
    .into()
}

/// The mechanism of the paper with the units of its letters, ready for
/// [`study`](crate::mechanics::study).
pub fn mechanism() -> MechanismQuestion {
    MechanismQuestion { mechanism: pendulum(), units: Some(units()), values: BTreeMap::new() }
}

/// The paper's equations (1) to (8), each compared with the derived one.
///
/// # Errors
/// [`MechanicsError`] is never met for the mechanism of [`pendulum`].
///
/// ```
/// use lindstedt::audit::paper::findings;
///
/// let findings = findings()?;
/// assert!(findings[0].equation == "(1)" && findings[0].agrees == Some(false));
/// assert!(findings[0].words.contains("L*m*x'*sin(x)/2"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn findings() -> Result<Vec<Finding>, MechanicsError> {
    let mechanism = pendulum();
    let units = units();
    let all = mechanism.all_units(&units);
    let equations = mechanism.equations()?;
    let groups = Groups::from_mechanism(&mechanism, &equations, &units)?;
    let read = |text: &str| text.parse::<Expr>().unwrap_or_else(|_| Expr::zero());
    let energy = Dimension::from_exponents([1, 2, -2]);
    let mut findings = vec![kinetic(&mechanism, &energy, &all)?];
    let potential = check(&read(POTENTIAL), &energy, &all, "potential energy");
    findings.push(Finding {
        equation: "(2)".to_owned(),
        printed: POTENTIAL.to_owned(),
        agrees: Some(potential.is_ok()),
        words: match potential {
            Ok(()) => "every term is an energy".to_owned(),
            Err(error) => error.to_string(),
        },
    });
    for (equation, printed, unit, words) in [
        ("(3)", CONTACT_FORCE, [1, 1, -2], "a force"),
        (
            "(4)",
            CONTACT_DAMPING,
            [1, 2, -2],
            "a torque, if mu is measured in kg m^2 as equations (5) and (7) need it",
        ),
    ] {
        let found = dimension(&read(printed), &all, "contact")?;
        findings.push(Finding {
            equation: equation.to_owned(),
            printed: printed.to_owned(),
            agrees: Some(found == Dimension::from_exponents(unit)),
            words: format!("{words}: {found}"),
        });
    }
    findings.push(equation_of_motion(&equations, &all)?);
    findings.push(Finding {
        equation: "(6)".to_owned(),
        printed: "sgn(x') ~ (2/pi)*atan(100*x')".to_owned(),
        agrees: None,
        words: "an approximation, not derived; `lindstedt friction` judges it".to_owned(),
    });
    findings.push(scaled(&groups)?);
    findings.push(definitions(&groups)?);
    Ok(findings)
}

/// Equation (1): the term that is not an energy, and the effect of the square.
fn kinetic(
    mechanism: &Mechanism,
    energy: &Dimension,
    all: &BTreeMap<Symbol, Dimension>,
) -> Result<Finding, MechanicsError> {
    let printed: Expr = PRINTED_KINETIC.parse().unwrap_or_else(|_| Expr::zero());
    let refused = check(&printed, energy, all, "kinetic energy");
    let squared = check(&mechanism.kinetic, energy, all, "kinetic energy").is_ok();
    Ok(Finding {
        equation: "(1)".to_owned(),
        printed: PRINTED_KINETIC.to_owned(),
        agrees: Some(refused.is_ok()),
        words: match (refused, squared) {
            (Ok(()), _) => "every term is an energy".to_owned(),
            (Err(error), true) => {
                format!("{error}; with the square, (L*x'*sin(x))^2, every term is an energy")
            }
            (Err(error), false) => error.to_string(),
        },
    })
}

/// Equation (5): its swing term by term, its contact by its unit.
fn equation_of_motion(
    equations: &EquationsOfMotion,
    all: &BTreeMap<Symbol, Dimension>,
) -> Result<Finding, MechanicsError> {
    let swing: Expr = PRINTED_SWING.parse().unwrap_or_else(|_| Expr::zero());
    let own: Expr = equations.left[0]
        .expand()?
        .terms()
        .iter()
        .filter(|term| !term.contains_function(Function::Step))
        .cloned()
        .sum();
    let difference = (&own - &swing).expand()?;
    let force: Expr = CONTACT_FORCE.parse().unwrap_or_else(|_| Expr::zero());
    let per_inertia: Expr = "1/(m*L^2)".parse().unwrap_or_else(|_| Expr::one());
    let rate = Dimension::from_exponents([0, 0, -2]);
    let contact = check(&(&force * &per_inertia), &rate, all, "equation of motion");
    let lever =
        check(&(force * per_inertia * Expr::symbol("l")), &rate, all, "equation of motion").is_ok();
    let swing_words = match difference.is_zero() {
        true => "the swing follows term by term".to_owned(),
        false => format!("the swing differs by {difference}"),
    };
    let contact_words = match (&contact, lever) {
        (Ok(()), _) => "so does the contact".to_owned(),
        (Err(error), true) => {
            format!("of the contact, {error}: the lever l is missing, with which it is a torque")
        }
        (Err(error), false) => error.to_string(),
    };
    Ok(Finding {
        equation: "(5)".to_owned(),
        printed: format!("{PRINTED_SWING} + H(x - xc)*(F_c + V_c)/(m*L^2)"),
        agrees: Some(difference.is_zero() && contact.is_ok()),
        words: format!("{swing_words}; {contact_words}"),
    })
}

/// Equation (7): the equation in its groups, for a contact of small depth.
fn scaled(groups: &Groups) -> Result<Finding, MechanicsError> {
    let printed: Expr = PRINTED_SCALED.parse().unwrap_or_else(|_| Expr::zero());
    let depth: Expr = "x - xc".parse().unwrap_or_else(|_| Expr::zero());
    let own = for_small(&groups.left[0], &depth)?.expand()?;
    let difference = (own - printed.expand()?).expand()?;
    Ok(Finding {
        equation: "(7)".to_owned(),
        printed: PRINTED_SCALED.to_owned(),
        agrees: Some(difference.is_zero()),
        words: match difference.is_zero() {
            true => {
                "in units of 1/omega, omega^2 = g/L, for sin(x - xc) ~ x - xc and a lever that stays l; the arctangent \
                     of (6) stands for sgn(x')"
                    .to_owned()
            }
            false => format!("differs by {difference}"),
        },
    })
}

/// Equation (8): the two groups that are printed.
fn definitions(groups: &Groups) -> Result<Finding, MechanicsError> {
    let mut differing = Vec::new();
    for (name, printed) in PRINTED_GROUPS {
        let printed: Expr = printed.parse().unwrap_or_else(|_| Expr::zero());
        let own = groups.groups.iter().find(|group| group.name.name() == name);
        if own.is_none_or(|own| own.definition != printed) {
            differing.push(name);
        }
    }
    let printed: Vec<String> =
        PRINTED_GROUPS.iter().map(|(name, definition)| format!("{name} = {definition}")).collect();
    Ok(Finding {
        equation: "(8)".to_owned(),
        printed: printed.join(", "),
        agrees: Some(differing.is_empty()),
        words: match differing.as_slice() {
            [] => "gamma and beta are the groups that the derived equation has".to_owned(),
            names => format!("not the groups that the derived equation has: {}", names.join(", ")),
        },
    })
}

/// The expression with `sin(u)` as `u`, where u is small.
fn for_small(expression: &Expr, small: &Expr) -> Result<Expr, ExprError> {
    expression.fold(|expr, children: &[Expr]| match expr.node() {
        Node::Function(Function::Sin, arguments) if arguments[0] == *small => Ok(small.clone()),
        _ => expr.with_children(children),
    })
}
