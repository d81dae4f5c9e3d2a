//! The law of the frequency: one kind for each form in which methods give it.

use std::collections::BTreeSet;
use std::fmt;

use crate::derivation::DerivationLine;
use crate::exact::{Polynomial, Rational};
use crate::expr::Expr;
use crate::symbol::Symbol;
use crate::symbol::letters::FREQUENCY;

/// The law of frequency and amplitude. Polynomials and expressions are in the parameters of the
/// equation, the amplitude symbol and the symbols of the definitions of the solution.
#[derive(Clone, Debug, PartialEq)]
pub enum Law {
    /// omega^2 as a polynomial, and omega itself beside it where the method expands both.
    Series {
        /// omega^2.
        squared: Polynomial,
        /// omega, cut at the same order.
        frequency: Option<Polynomial>,
    },
    /// omega alone as a polynomial.
    Frequency(Polynomial),
    /// A polynomial in even powers of `omega`, equal to zero, and its root where that can be
    /// written down.
    Relation {
        /// Zero on the branch that starts at the linear frequency.
        relation: Polynomial,
        /// The relation solved for omega^2.
        root: Option<Root>,
    },
    /// An expression that is not a polynomial.
    Closed(ClosedForm),
    /// A law that only numbers solve: `omega^2 = (2/(pi*A)) int_0^pi ...`; the lines say which.
    Quadrature(Vec<DerivationLine>),
    /// The equations of a balance of several harmonics, solved by numbers.
    System(AlgebraicSystem),
}

/// A relation solved for omega^2.
#[derive(Clone, Debug, PartialEq)]
pub enum Root {
    /// As a polynomial: the relation is linear in omega^2.
    Polynomial(Polynomial),
    /// With a root in it.
    Closed(ClosedForm),
}

/// A law that is not a polynomial: `omega^2 = 2*J1(A)/A`.
#[derive(Clone, Debug, PartialEq)]
pub struct ClosedForm {
    /// Whether the value is omega^2; otherwise omega.
    pub squared: bool,
    /// The right side.
    pub value: Expr,
}

/// Algebraic equations that determine frequency and coefficients together, solved by numbers alone.
#[derive(Clone, Debug, PartialEq)]
pub struct AlgebraicSystem {
    /// The unknowns: `omega` and the coefficients of the motion.
    pub unknowns: Vec<Symbol>,
    /// Each is equal to zero.
    pub equations: Vec<Expr>,
}

impl Law {
    /// omega^2 alone, as a polynomial.
    pub fn squared(value: Polynomial) -> Self {
        Self::Series { squared: value, frequency: None }
    }

    /// omega, if the law gives it as a polynomial; `None` otherwise.
    pub fn frequency(&self) -> Option<&Polynomial> {
        match self {
            Self::Series { frequency, .. } => frequency.as_ref(),
            Self::Frequency(frequency) => Some(frequency),
            _ => None,
        }
    }

    /// omega^2, if the law gives it as a polynomial; `None` otherwise.
    pub fn frequency_squared(&self) -> Option<&Polynomial> {
        match self {
            Self::Series { squared, .. } => Some(squared),
            Self::Relation { root: Some(Root::Polynomial(squared)), .. } => Some(squared),
            _ => None,
        }
    }

    /// The relation of an implicit law.
    pub fn relation(&self) -> Option<&Polynomial> {
        match self {
            Self::Relation { relation, .. } => Some(relation),
            _ => None,
        }
    }

    /// The expression for omega or omega^2 that is not a polynomial.
    pub fn closed_form(&self) -> Option<&ClosedForm> {
        match self {
            Self::Closed(form) | Self::Relation { root: Some(Root::Closed(form)), .. } => {
                Some(form)
            }
            _ => None,
        }
    }

    /// The lines of a law that only numbers solve.
    pub fn quadrature(&self) -> Option<&[DerivationLine]> {
        match self {
            Self::Quadrature(lines) => Some(lines),
            _ => None,
        }
    }

    /// The equations of a balance.
    pub fn system(&self) -> Option<&AlgebraicSystem> {
        match self {
            Self::System(system) => Some(system),
            _ => None,
        }
    }

    /// Whether omega^2 is not evaluated but solved for: a balance, an integral, the exact motion.
    pub fn is_solved_by_numbers(&self) -> bool {
        matches!(self, Self::Quadrature(_) | Self::System(_))
    }

    /// Every polynomial in it.
    pub fn polynomials(&self) -> impl Iterator<Item = &Polynomial> {
        [self.frequency(), self.frequency_squared(), self.relation()].into_iter().flatten()
    }

    /// The law with every polynomial changed.
    #[must_use]
    pub fn map(&self, change: impl Fn(&Polynomial) -> Polynomial) -> Self {
        match self {
            Self::Series { squared, frequency } => {
                Self::Series { squared: change(squared), frequency: frequency.as_ref().map(change) }
            }
            Self::Frequency(frequency) => Self::Frequency(change(frequency)),
            Self::Relation { relation, root } => Self::Relation {
                relation: change(relation),
                root: root.as_ref().map(|root| match root {
                    Root::Polynomial(squared) => Root::Polynomial(change(squared)),
                    Root::Closed(form) => Root::Closed(form.clone()),
                }),
            },
            other => other.clone(),
        }
    }

    /// The law with every number of its closed forms, integrals and equations changed.
    #[must_use]
    pub fn with_numbers(self, change: &dyn Fn(&Rational) -> Rational) -> Self {
        let changed = |value: &Expr| value.with_numbers(change).unwrap_or_else(|_| value.clone());
        let closed = |form: ClosedForm| ClosedForm { value: changed(&form.value), ..form };
        match self {
            Self::Closed(form) => Self::Closed(closed(form)),
            Self::Relation { relation, root: Some(Root::Closed(form)) } => {
                Self::Relation { relation, root: Some(Root::Closed(closed(form))) }
            }
            Self::Quadrature(lines) => {
                Self::Quadrature(lines.iter().map(|line| line.with_numbers(change)).collect())
            }
            Self::System(system) => Self::System(AlgebraicSystem {
                equations: system.equations.iter().map(changed).collect(),
                ..system
            }),
            other => other,
        }
    }

    /// The law with this name of the phase in its lines.
    #[must_use]
    pub(crate) fn with_phase(self, name: Symbol) -> Self {
        match self {
            Self::Quadrature(lines) => {
                Self::Quadrature(lines.into_iter().map(|line| line.with_phase(name)).collect())
            }
            other => other,
        }
    }

    /// Whether a symbol stands in it; integrals are taken along the motion, so the amplitude stands
    /// in each.
    pub fn contains(&self, symbol: Symbol) -> bool {
        let equations = self.system().into_iter().flat_map(|system| &system.equations);
        let forms = self.closed_form().map(|form| &form.value).into_iter().chain(equations);
        self.quadrature().is_some()
            || self.polynomials().any(|law| law.symbols().contains(&symbol))
            || forms.into_iter().any(|form| form.contains(symbol))
    }
}

/// A law in one of the forms in which reports show it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DisplayedLaw<'a> {
    /// omega^2 is this polynomial.
    Squared(&'a Polynomial),
    /// omega is this polynomial.
    Frequency(&'a Polynomial),
    /// This polynomial in omega and the amplitude is zero.
    Relation(&'a Polynomial),
    /// An expression that is not a polynomial.
    Closed(&'a ClosedForm),
    /// Integrals.
    Quadrature(&'a [DerivationLine]),
    /// Equations that are solved numerically.
    System(&'a AlgebraicSystem),
}

impl Law {
    /// All forms of it that a report of one answer shows, in their order. A relation that is solved
    /// by a polynomial is left out.
    pub fn display_forms(&self) -> Vec<DisplayedLaw<'_>> {
        let shown = self.in_one_line();
        let beside = match self {
            Self::Series { frequency, .. } => frequency.as_ref().map(DisplayedLaw::Frequency),
            _ => None,
        };
        let before = match self {
            Self::Relation { relation, root: Some(Root::Closed(_)) } => {
                Some(DisplayedLaw::Relation(relation))
            }
            _ => None,
        };
        before.into_iter().chain([shown]).chain(beside).collect()
    }

    /// The form that stands for it where there is room for one.
    pub fn in_one_line(&self) -> DisplayedLaw<'_> {
        match self {
            Self::Series { squared, .. }
            | Self::Relation { root: Some(Root::Polynomial(squared)), .. } => {
                DisplayedLaw::Squared(squared)
            }
            Self::Frequency(frequency) => DisplayedLaw::Frequency(frequency),
            Self::Closed(form) | Self::Relation { root: Some(Root::Closed(form)), .. } => {
                DisplayedLaw::Closed(form)
            }
            Self::Relation { relation, root: None } => DisplayedLaw::Relation(relation),
            Self::Quadrature(lines) => DisplayedLaw::Quadrature(lines),
            Self::System(system) => DisplayedLaw::System(system),
        }
    }
}

impl DisplayedLaw<'_> {
    /// The symbols of a formula, those of its integrals included; empty for a system of equations.
    pub fn symbols(&self) -> BTreeSet<Symbol> {
        match self {
            Self::Squared(law) | Self::Frequency(law) | Self::Relation(law) => {
                law.symbols().into_iter().collect()
            }
            Self::Closed(form) => form.value.symbols(),
            Self::Quadrature(lines) => lines.iter().flat_map(DerivationLine::symbols).collect(),
            Self::System(_) => BTreeSet::new(),
        }
    }
}

impl ClosedForm {
    /// The left side: `omega^2` or `omega`.
    pub fn name(&self) -> String {
        match self.squared {
            true => format!("{FREQUENCY}^2"),
            false => FREQUENCY.to_string(),
        }
    }
}

impl fmt::Display for ClosedForm {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{} = {}", self.name(), self.value)
    }
}
