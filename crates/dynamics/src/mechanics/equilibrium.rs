//! Equilibria of a mechanism: `dV/dq_i - Q_i = 0` with every velocity zero.
//!
//! The search is exact, in three steps, and not exhaustive: angles are tried at 0 and pi; the
//! equations are then solved for the coordinates that enter linearly; a single angle whose force is
//! `sin(q)*(a + b*cos(q))` has the equilibria `cos(q) = -a/b` besides. Terms in the time and
//! contacts (those with `H`) are left out: the equilibria are those of the undriven mechanism away
//! from its barriers.

use std::collections::{BTreeMap, BTreeSet};

use super::{EquationsOfMotion, MechanicsError, trigonometry::simplified};
use crate::expr::{Expr, ExprError, Function, Node};
use crate::symbol::Symbol;

/// The equilibrium position of a coordinate.
#[derive(Clone, Debug, PartialEq)]
pub enum RestPosition {
    /// The coordinate has this value.
    At(Expr),
    /// The coordinate may have any value, since no force acts on it.
    Anywhere,
}

/// An equilibrium.
#[derive(Clone, Debug, PartialEq)]
pub struct Rest {
    /// The position of each coordinate.
    pub places: Vec<RestPosition>,
    /// The expression in the parameters that must lie between -1 and 1 for the equilibrium to
    /// exist; `None` if it always exists.
    pub condition: Option<Expr>,
}

impl Rest {
    /// Returns the coordinates with their positions; a coordinate that may be anywhere is put at 0.
    pub fn values(&self, coordinates: &[Symbol]) -> BTreeMap<Symbol, Expr> {
        let place = |place: &RestPosition| match place {
            RestPosition::At(place) => place.clone(),
            RestPosition::Anywhere => Expr::zero(),
        };
        coordinates.iter().copied().zip(self.places.iter().map(place)).collect()
    }
}

/// Returns the equilibria that are found, an upright or folded pendulum among them; there may be
/// others.
///
/// # Errors
/// [`MechanicsError`] for forces that are too long to be expanded.
///
/// ```
/// # use lindstedt_dynamics as lindstedt;
/// use lindstedt::mechanics::{Mechanism, RestPosition, equilibria};
///
/// let spring = Mechanism::parse(&["r", "x"], "m*(r'^2 + r^2*x'^2)/2", "k*(r - L)^2/2 - m*g*r*cos(x)")?;
/// let found = equilibria(&spring.equations()?)?;
/// assert_eq!(found[0].places[0], RestPosition::At("L + g*m/k".parse()?));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn equilibria(equations: &EquationsOfMotion) -> Result<Vec<Rest>, MechanicsError> {
    let coordinates = &equations.coordinates;
    let forces = equations.forces_at_rest()?;
    let angles: Vec<Symbol> =
        coordinates.iter().copied().filter(|name| is_angle(*name, &forces)).collect();
    let mut found: Vec<Rest> = Vec::new();
    let mut add = |rest: Rest| {
        if !found.contains(&rest) {
            found.push(rest);
        }
    };
    for choice in 0..1_usize << angles.len() {
        let upright = |index: usize| match choice >> index & 1 {
            0 => Expr::zero(),
            _ => Expr::pi(),
        };
        let chosen: BTreeMap<Symbol, Expr> =
            angles.iter().enumerate().map(|(index, name)| (*name, upright(index))).collect();
        if let Some(places) = linear_places(coordinates, &forces, chosen)? {
            add(Rest { places, condition: None });
        }
    }
    // Equations that are not linear in the coordinates may still have an equilibrium at zero.
    let zero: BTreeMap<Symbol, Expr> =
        coordinates.iter().map(|name| (*name, Expr::zero())).collect();
    let rests = |force: &Expr| force.substitute_all(&zero).and_then(|force| simplified(&force));
    if found.is_empty()
        && forces.iter().all(|force| rests(force).is_ok_and(|force| force.is_zero()))
    {
        found.push(Rest {
            places: coordinates.iter().map(|_| RestPosition::At(Expr::zero())).collect(),
            condition: None,
        });
    }
    let mut add = |rest: Rest| {
        if !found.contains(&rest) {
            found.push(rest);
        }
    };
    if let ([angle], [force]) = (coordinates.as_slice(), forces.as_slice())
        && let Some(cosine) = cosine_of_tilt(*angle, force)?
    {
        let place = Expr::function(Function::Acos, vec![cosine.clone()])?;
        for place in [place.clone(), -place] {
            add(Rest { places: vec![RestPosition::At(place)], condition: Some(cosine.clone()) });
        }
    }
    Ok(found)
}

/// The effect of explicit time dependence at an equilibrium of the autonomous equations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DriveAtRest {
    /// No term depends on the time explicitly.
    Absent,
    /// The time-dependent terms vanish there, as for a pendulum whose pivot is shaken upright: it
    /// is an equilibrium, whose oscillations they change.
    Vanishes,
    /// The time-dependent terms act there: it is no equilibrium while they do.
    Acts,
}

impl EquationsOfMotion {
    /// Determines the effect of explicit time dependence at an equilibrium of the undriven
    /// mechanism.
    pub(super) fn drive_at(&self, rest: &Rest) -> Result<DriveAtRest, ExprError> {
        let at = |place: &RestPosition| match place {
            RestPosition::At(place) => Some(place.clone()),
            RestPosition::Anywhere => None,
        };
        let names = self.coordinates.iter();
        let mut there: BTreeMap<Symbol, Expr> = names
            .clone()
            .zip(&rest.places)
            .filter_map(|(name, place)| Some((*name, at(place)?)))
            .collect();
        there.extend(names.map(|name| (name.derivative(), Expr::zero())));
        let mut drive = DriveAtRest::Absent;
        for rest in self.rest.iter().filter(|rest| rest.contains(Symbol::new("t"))) {
            let written_out = rest.expand()?;
            let terms = written_out.terms().iter();
            let driving: Expr = terms.filter(|term| term.contains(Symbol::new("t"))).cloned().sum();
            if driving.is_zero() {
                continue;
            }
            let acts = driving.substitute_all(&there).and_then(|driving| simplified(&driving));
            if !acts.is_ok_and(|driving| driving.is_zero()) {
                return Ok(DriveAtRest::Acts);
            }
            drive = DriveAtRest::Vanishes;
        }
        Ok(drive)
    }

    /// Generalised forces at rest, equation by equation: without velocities, time-dependent terms
    /// and contacts.
    pub(super) fn forces_at_rest(&self) -> Result<Vec<Expr>, ExprError> {
        let still: BTreeMap<Symbol, Expr> =
            self.coordinates.iter().map(|name| (name.derivative(), Expr::zero())).collect();
        let force = |rest: &Expr| {
            let kept = undriven(rest)?;
            simplified(&kept.substitute_all(&still)?)
        };
        self.rest.iter().map(force).collect()
    }
}

/// Returns the sum of the terms that neither contain the time nor belong to a contact.
pub(super) fn undriven(expression: &Expr) -> Result<Expr, ExprError> {
    let written_out = expression.expand()?;
    let kept = written_out.terms().iter();
    let kept = kept
        .filter(|term| !term.contains(Symbol::new("t")) && !term.contains_function(Function::Step));
    Ok(kept.cloned().sum())
}

/// Whether a coordinate occurs in the forces, and only inside sines and cosines.
fn is_angle(name: Symbol, forces: &[Expr]) -> bool {
    let outside = |force: &Expr| {
        let without = force.fold(|expr, children: &[Expr]| match expr.node() {
            Node::Function(Function::Sin | Function::Cos, _) => Ok(Expr::symbol("_wave")),
            _ => expr.with_children(children),
        });
        without.map_or(true, |without: Expr| without.contains(name))
    };
    forces.iter().any(|force| force.contains(name)) && !forces.iter().any(outside)
}

/// Returns the positions of all coordinates for the chosen values of the angles; `None` if the
/// others do not follow from linear equations, or a force does not vanish.
fn linear_places(
    coordinates: &[Symbol],
    forces: &[Expr],
    chosen: BTreeMap<Symbol, Expr>,
) -> Result<Option<Vec<RestPosition>>, ExprError> {
    let mut places: BTreeMap<Symbol, Expr> = chosen;
    let mut open: Vec<Expr> = Vec::new();
    for force in forces {
        // A force without a value there rules out an equilibrium.
        match force.substitute_all(&places) {
            Ok(force) => open.push(simplified(&force)?),
            Err(_) => return Ok(None),
        }
    }
    let mut free: BTreeSet<Symbol> = BTreeSet::new();
    for name in
        coordinates.iter().filter(|name| !places.contains_key(name)).copied().collect::<Vec<_>>()
    {
        let Some(row) = open.iter().position(|force| force.contains(name)) else {
            free.insert(name);
            continue;
        };
        let slope = simplified(&open[row].differentiate(name)?)?;
        if slope.contains(name) {
            return Ok(None);
        }
        let (Ok(without), false) = (open[row].substitute(name, &Expr::zero()), slope.is_zero())
        else {
            return Ok(None);
        };
        let value = -Expr::divide(&without, &slope)?.expand()?;
        for place in places.values_mut() {
            *place = place.substitute(name, &value)?.expand()?;
        }
        for force in &mut open {
            match force.substitute(name, &value) {
                Ok(left) => *force = simplified(&left)?,
                Err(_) => return Ok(None),
            }
        }
        places.insert(name, value);
    }
    if open.iter().any(|force| !force.is_zero()) {
        return Ok(None);
    }
    let place = |name: &Symbol| match free.contains(name) {
        true => RestPosition::Anywhere,
        false => RestPosition::At(places.get(name).cloned().unwrap_or_else(Expr::zero)),
    };
    Ok(Some(coordinates.iter().map(place).collect()))
}

/// Returns the cosine of the angle, other than 0 and pi, at which `sin(q)*(a + b*cos(q))` vanishes;
/// `None` for any other form of the force.
fn cosine_of_tilt(angle: Symbol, force: &Expr) -> Result<Option<Expr>, ExprError> {
    let (sine, cosine) = (Expr::from(angle).sin()?, Expr::from(angle).cos()?);
    let mark = Symbol::new("_cosine");
    let marked: BTreeMap<Symbol, Expr> = [(angle, Expr::symbol("_angle"))].into();
    let mut terms = Vec::new();
    for term in force.terms() {
        let rest = Expr::divide(term, &sine)?;
        let rest = rest.fold(|expr, children: &[Expr]| match *expr == cosine {
            true => Ok(Expr::from(mark)),
            false => expr.with_children(children),
        })?;
        if rest.substitute_all(&marked)? != rest {
            return Ok(None);
        }
        terms.push(rest);
    }
    let factor = Expr::sum(terms);
    let slope = factor.differentiate(mark)?;
    if slope.is_zero() || slope.contains(mark) {
        return Ok(None);
    }
    let without = factor.substitute(mark, &Expr::zero())?;
    if without.is_zero() {
        return Ok(None);
    }
    Ok(Some(-Expr::divide(&without, &slope)?))
}
