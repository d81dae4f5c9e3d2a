//! The equations as matrices and small terms: `M q'' + K q + sum of small terms = 0`.
//!
//! Every term but those of M and K has an order. With a small parameter in the equations it is the
//! power of that; other terms that have to be small, such as damping, count as its first power.
//! Without one the amplitude is small: a term of degree d counts d - 1, and damping, detunings and
//! drives at a resonance count as the order at which the nonlinear terms change the amplitudes
//! first. A drive far from resonance is not small.

use std::collections::BTreeMap;

use num_traits::{One, ToPrimitive, Zero};

use super::MultipleScalesError;
use crate::coupled::CoupledEquations;
use crate::exact::{Polynomial, Rational};
use crate::expr::{Expr, ExprError};
use crate::mechanics::EquationsOfMotion;
use crate::method::{HarmonicExcitation, Quadrature};
use crate::modes::ModeError;
use crate::modes::reading::{at_rest, counted_from_rest, polynomial, with_own_names_apart};
use crate::series::taylor;
use crate::solution::Definition;
use crate::symbol::Symbol;

/// A system about its place of rest, where every coordinate is zero, with what damps and drives it.
#[derive(Clone, Debug, PartialEq)]
pub struct CoupledSystem {
    /// The equations as they were given; names that are those of something in an answer are
    /// [apart](Symbol::apart).
    pub equations: CoupledEquations,
    /// The place of rest from which each coordinate is counted, in the coordinates of the mechanism;
    /// zeros for equations that were typed.
    pub rest: Vec<Expr>,
    /// The small parameter; `None` if it is the amplitude.
    pub small: Option<Symbol>,
    /// The mass matrix M, a row for each equation.
    pub mass: Vec<Vec<Polynomial>>,
    /// The stiffness matrix K.
    pub stiffness: Vec<Vec<Polynomial>>,
    /// The frequencies of the drives, none a fraction of another.
    pub drives: Vec<Expr>,
    /// The constants of the equations that are no products of powers, such as `sqrt(2)`, by their
    /// names in polynomials.
    pub constants: Vec<Definition>,
    /// The small terms of each equation.
    pub(super) terms: Vec<Vec<SmallTerm>>,
}

/// A term of an equation: a coefficient, waves of drives, powers of the coordinates and their
/// derivatives.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SmallTerm {
    pub(super) coefficient: Polynomial,
    /// The power of the small parameter in the coefficient.
    pub(super) written_order: usize,
    pub(super) waves: Vec<DriveWave>,
    /// Coordinate, number of derivatives, exponent.
    pub(super) powers: Vec<(usize, usize, u32)>,
}

/// A wave `cos(multiple*rate*t)`, or the sine.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct DriveWave {
    /// The index of the drive.
    pub(super) drive: usize,
    /// The multiple of its frequency.
    pub(super) multiple: Rational,
    pub(super) quadrature: Quadrature,
}

impl SmallTerm {
    /// The number of factors: the power of the amplitude.
    pub(super) fn degree(&self) -> usize {
        self.powers.iter().map(|(_, _, exponent)| *exponent as usize).sum()
    }
}

impl SmallTerm {
    /// The factors beside the coefficient: powers of the coordinates of a system, and waves in time.
    pub(super) fn product(&self, system: &CoupledSystem) -> Result<Expr, ExprError> {
        let mut factors = Vec::new();
        for wave in &self.waves {
            let angle = Expr::number(wave.multiple.clone())
                * &system.drives[wave.drive]
                * Expr::from(Symbol::new("t"));
            factors.push(match wave.quadrature {
                Quadrature::Cosine => angle.cos()?,
                Quadrature::Sine => angle.sin()?,
            });
        }
        for (index, primes, exponent) in &self.powers {
            let name = system.equations.coordinates[*index];
            let name = (0..*primes).fold(name, |name, _| name.derivative());
            factors.push(Expr::from(name).integer_power(i64::from(*exponent))?);
        }
        Ok(Expr::product(factors))
    }
}

/// The highest Taylor polynomial of a force that is no polynomial.
const TAYLOR_DEGREE: u32 = 7;

impl CoupledSystem {
    /// Reads equations that are separated by `;`.
    ///
    /// # Errors
    /// [`MultipleScalesError`] with the term that is not of such a system.
    ///
    /// ```
    /// # use lindstedt_modes as lindstedt;
    /// use lindstedt::multiple_scales::CoupledSystem;
    ///
    /// let pair = CoupledSystem::parse("x'' + x - x*y = 0; y'' + 4*y - x^2 = F*cos(Omega*t)")?;
    /// assert_eq!(pair.drives[0].to_string(), "Omega");
    /// assert_eq!(pair.stiffness[1][1].to_string(), "4");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn parse(text: &str) -> Result<Self, MultipleScalesError> {
        let equations = CoupledEquations::parse(text).map_err(ModeError::from)?;
        Self::new(equations, None)
    }

    /// The system of a mechanism, its coordinates counted from the first place of rest that is found.
    ///
    /// # Errors
    /// [`MultipleScalesError`] with the term that is not of such a system.
    pub fn of_mechanism(
        equations: &EquationsOfMotion,
        small: Option<Symbol>,
    ) -> Result<Self, MultipleScalesError> {
        let (coupled, rest) = counted_from_rest(equations)?;
        Ok(Self { rest, ..Self::new(coupled, small)? })
    }

    /// The system of coupled equations; `eps` is the small parameter without a choice, if it occurs.
    ///
    /// # Errors
    /// [`MultipleScalesError`] with the term that is not of such a system.
    pub fn new(
        equations: CoupledEquations,
        small: Option<Symbol>,
    ) -> Result<Self, MultipleScalesError> {
        let equations = with_own_names_apart(equations)?;
        let coordinates = equations.coordinates.clone();
        let slow =
            coordinates.iter().find(|name| !equations.rates.states.contains(&name.derivative()));
        if let Some(name) = slow {
            return Err(ModeError::FirstOrder(*name).into());
        }
        if let Some(name) = small.filter(|name| !equations.parameters.contains(name)) {
            return Err(MultipleScalesError::NoSmallParameter(name));
        }
        let eps = Symbol::new("eps");
        let usual = || equations.parameters.contains(&eps).then_some(eps);
        let count = coordinates.len();
        let zeros = || vec![vec![Polynomial::zero(); count]; equations.equations.len()];
        let mut system = Self {
            rest: vec![Expr::zero(); count],
            small: small.or_else(usual),
            mass: zeros(),
            stiffness: zeros(),
            drives: vec![],
            constants: vec![],
            terms: vec![],
            equations,
        };
        for (row, (left, right)) in system.equations.equations.clone().iter().enumerate() {
            let residual = left - right;
            let written_out = residual.expand()?;
            let mut terms = Vec::new();
            let polynomial = written_out.terms().iter().all(|term| system.is_product(term));
            let parts = match polynomial {
                true => vec![written_out],
                false => taylor(&residual, &at_rest(&coordinates), TAYLOR_DEGREE)?,
            };
            for part in parts {
                let part = part.expand()?;
                for term in part.terms().iter().filter(|term| !term.is_zero()) {
                    for found in system.small_terms(term)? {
                        match found.powers.as_slice() {
                            [] if found.waves.is_empty() => {
                                let rest = Expr::from(&found.coefficient);
                                return Err(ModeError::NotAtRest(residual, rest).into());
                            }
                            [(index, primes @ (0 | 2), 1)]
                                if found.waves.is_empty() && found.written_order == 0 =>
                            {
                                let matrix = match primes {
                                    0 => &mut system.stiffness,
                                    _ => &mut system.mass,
                                };
                                matrix[row][*index].accumulate(&found.coefficient);
                            }
                            _ => terms.push(found),
                        }
                    }
                }
            }
            system.terms.push(terms);
        }
        system.order_rows();
        system.check_gyroscopic()?;
        Ok(system)
    }

    /// Puts each equation into the row of a coordinate whose acceleration is in it, where the
    /// equations stand in another order.
    fn order_rows(&mut self) {
        let count = self.mass.len();
        if (0..count).all(|row| !self.mass[row][row].is_zero()) {
            return;
        }
        let mut row_of: Vec<Option<usize>> = vec![None; count];
        for row in 0..count {
            self.give_row(row, &mut row_of, &mut vec![false; count]);
        }
        let Some(rows) = row_of.into_iter().collect::<Option<Vec<usize>>>() else { return };
        self.mass = rows.iter().map(|row| self.mass[*row].clone()).collect();
        self.stiffness = rows.iter().map(|row| self.stiffness[*row].clone()).collect();
        self.terms = rows.iter().map(|row| self.terms[*row].clone()).collect();
    }

    /// Gives a row to a coordinate, moving others if it has to.
    fn give_row(&self, row: usize, row_of: &mut Vec<Option<usize>>, seen: &mut Vec<bool>) -> bool {
        for coordinate in 0..row_of.len() {
            if self.mass[row][coordinate].is_zero() || seen[coordinate] {
                continue;
            }
            seen[coordinate] = true;
            let free = match row_of[coordinate] {
                None => true,
                Some(other) => self.give_row(other, row_of, seen),
            };
            if free {
                row_of[coordinate] = Some(row);
                return true;
            }
        }
        false
    }

    /// Returns the system with values in place of parameters.
    ///
    /// # Errors
    /// [`MultipleScalesError`] where an expression has no value.
    pub fn with_values(
        &self,
        values: &BTreeMap<Symbol, Expr>,
    ) -> Result<Self, MultipleScalesError> {
        let equations = self.equations.substituted(values).map_err(ModeError::from)?;
        let rest = self.rest.iter().map(|place| place.substitute_all(values));
        let small = self.small.filter(|name| equations.parameters.contains(name));
        Ok(Self { rest: rest.collect::<Result<_, ExprError>>()?, ..Self::new(equations, small)? })
    }

    /// The symbol that a typed name means: one of the equations, which may be kept
    /// [apart](Symbol::apart) from that of an answer.
    pub fn resolve(&self, name: Symbol) -> Symbol {
        let own = self.equations.parameters.iter().find(|own| own.name() == name.name());
        own.copied().unwrap_or(name)
    }

    /// The names of the equations: coordinates, parameters, constants, time.
    pub(super) fn names(&self) -> Vec<Symbol> {
        let constants = self.constants.iter().map(|constant| constant.symbol);
        let own = self.equations.coordinates.iter().chain(&self.equations.parameters).copied();
        own.chain(constants).chain([Symbol::new("t")]).collect()
    }

    /// The coordinate that a name is, or is a derivative of, and the number of derivatives.
    fn place(&self, name: Symbol) -> Option<(usize, usize)> {
        let index = self.equations.coordinates.iter().position(|own| *own == name.coordinate())?;
        Some((index, name.primes()))
    }

    /// Whether a factor has a coordinate, or a derivative of one, in it.
    fn moves(&self, factor: &Expr) -> bool {
        factor.symbols().into_iter().any(|name| self.place(name).is_some())
    }

    /// Whether a term is a product of powers of the coordinates with whole exponents, and of factors
    /// without them.
    fn is_product(&self, term: &Expr) -> bool {
        term.factors().1.iter().all(|factor| !self.moves(factor) || self.power(factor).is_some())
    }

    /// The power of a coordinate or of a derivative.
    fn power(&self, factor: &Expr) -> Option<(usize, usize, u32)> {
        let (base, exponent) = factor.base_and_exponent();
        let (index, primes) = self.place(base.as_symbol()?)?;
        let number = exponent.as_number().filter(|number| number.is_integer())?;
        Some((index, primes, number.to_integer().to_u32()?))
    }

    /// A term as one term, or as several where the phase of a wave is written out.
    fn small_terms(&mut self, term: &Expr) -> Result<Vec<SmallTerm>, MultipleScalesError> {
        let refused = || MultipleScalesError::Term(term.clone());
        let t = Symbol::new("t");
        let (number, factors) = term.factors();
        let mut still = Expr::number(number);
        let mut powers = Vec::new();
        let mut waves: Vec<HarmonicExcitation> = Vec::new();
        for factor in factors {
            if self.moves(factor) {
                powers.push(self.power(factor).ok_or_else(refused)?);
            } else if factor.contains(t) {
                let (base, exponent) = factor.base_and_exponent();
                let exponent = exponent
                    .as_number()
                    .filter(|number| number.is_integer())
                    .and_then(|number| number.to_integer().to_usize())
                    .filter(|exponent| *exponent <= 12)
                    .ok_or_else(refused)?;
                let wave = HarmonicExcitation::of_term(&base)?.ok_or_else(refused)?;
                waves.extend(std::iter::repeat_n(wave, exponent));
            } else {
                still = &still * factor;
            }
        }
        powers.sort_unstable();
        let written_order = match self.small {
            None => 0,
            Some(small) => self.order_of(&still, small).ok_or_else(refused)?,
        };
        let mut found = vec![(still, vec![])];
        for wave in waves {
            let (drive, multiple) = self.drive(&wave.rate)?;
            let [cosine, sine] = [wave.phase.cos()?, wave.phase.sin()?];
            let quadratures = match wave.quadrature {
                Quadrature::Cosine => [(cosine, Quadrature::Cosine), (-&sine, Quadrature::Sine)],
                Quadrature::Sine => [(cosine, Quadrature::Sine), (sine, Quadrature::Cosine)],
            };
            let mut next = Vec::new();
            for (still, waves) in &found {
                for (factor, quadrature) in quadratures.iter().filter(|(f, _)| !f.is_zero()) {
                    let wave =
                        DriveWave { drive, multiple: multiple.clone(), quadrature: *quadrature };
                    let all = waves.iter().cloned().chain([wave]).collect();
                    next.push((still * factor, all));
                }
            }
            found = next;
        }
        let names = self.names();
        Ok(found
            .into_iter()
            .map(|(still, waves)| SmallTerm {
                coefficient: polynomial(&still, &names, &mut self.constants),
                written_order,
                waves,
                powers: powers.clone(),
            })
            .collect())
    }

    /// The power of the small parameter in a coefficient.
    fn order_of(&self, coefficient: &Expr, small: Symbol) -> Option<usize> {
        let mut order = 0;
        for factor in coefficient.factors().1 {
            let (base, exponent) = factor.base_and_exponent();
            if base.as_symbol() == Some(small) {
                order = exponent
                    .as_number()
                    .filter(|number| number.is_integer())?
                    .to_integer()
                    .to_usize()?;
            } else if factor.contains(small) {
                return None;
            }
        }
        Some(order)
    }

    /// The drive of a wave, and the multiple of its frequency.
    fn drive(&mut self, rate: &Expr) -> Result<(usize, Rational), MultipleScalesError> {
        for (index, known) in self.drives.iter().enumerate() {
            let multiple = Expr::divide(rate, known)?.expand()?;
            if let Some(number) = multiple.as_number() {
                return Ok((index, number.clone()));
            }
        }
        self.drives.push(rate.clone());
        Ok((self.drives.len() - 1, Rational::one()))
    }

    /// Refuses a linear force of the velocities that does no work and is not marked as small.
    fn check_gyroscopic(&self) -> Result<(), MultipleScalesError> {
        let count = self.equations.coordinates.len();
        let mut damping = vec![vec![Polynomial::zero(); count]; count];
        for (row, terms) in self.terms.iter().enumerate() {
            for term in terms.iter().filter(|term| term.waves.is_empty() && term.written_order == 0)
            {
                if let [(column, 1, 1)] = term.powers.as_slice() {
                    damping[row][*column].accumulate(&term.coefficient);
                }
            }
        }
        let mut places = (0..count).flat_map(|i| (0..count).map(move |j| (i, j)));
        let all_skew = places.clone().all(|(i, j)| {
            let mut sum = damping[i][j].clone();
            sum.accumulate(&damping[j][i]);
            sum.is_zero()
        });
        match places.find(|(i, j)| !damping[*i][*j].is_zero()) {
            Some((i, j)) if all_skew => {
                let velocity = Expr::from(self.equations.coordinates[j].derivative());
                Err(MultipleScalesError::Gyroscopic(&Expr::from(&damping[i][j]) * &velocity))
            }
            _ => Ok(()),
        }
    }
}
