//! The question: a linear driven oscillator with walls, in letters and in numbers.
//!
//! ```text
//! x'' + c x' + k x = P + A cos(omega t) + B sin(omega t)
//! y = s x + w0 + wc cos(omega t) + ws sin(omega t) >= 0       the gap of a wall, |s| = 1
//! y'' + c y' + k y = P_y + A_y cos(omega t) + B_y sin(omega t)
//! ```
//!
//! In the gap a wall that moves is at rest at y = 0, so that one closed form serves all walls.

use std::collections::{BTreeMap, BTreeSet};

use super::error::OrbitError;
use super::sweep::VaryingParameter;
use crate::Oscillator;
use crate::expr::{CompiledList, Expr, ExprError};
use crate::method::{HarmonicExcitation, Quadrature};
use crate::symbol::Symbol;
use crate::values::Values;
use crate::wall::Wall;

/// A constant and a wave, `constant + cosine cos(omega t) + sine sin(omega t)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BiasedHarmonic<T> {
    /// The constant.
    pub constant: T,
    /// The factor of the cosine.
    pub cosine: T,
    /// The factor of the sine.
    pub sine: T,
}

impl BiasedHarmonic<Expr> {
    /// Whether nothing of it moves.
    pub fn is_still(&self) -> bool {
        self.cosine.is_zero() && self.sine.is_zero()
    }

    fn parts(&self) -> [&Expr; 3] {
        [&self.constant, &self.cosine, &self.sine]
    }
}

/// A wall in the letters of the question.
#[derive(Clone, Debug, PartialEq)]
pub struct OrbitWall {
    /// The wall as it was given.
    pub wall: Wall,
    /// The sign s of the coordinate in the gap: -1 where the wall bounds it from above, 1 from
    /// below.
    pub side: i8,
    /// The gap without the coordinate.
    pub offset: BiasedHarmonic<Expr>,
    /// The right side of the equation of the gap.
    pub load: BiasedHarmonic<Expr>,
}

/// A linear driven oscillator with walls.
#[derive(Clone, Debug)]
pub struct ImpactEquation {
    /// The equation as it was given.
    pub oscillator: Oscillator,
    /// The damping c.
    pub damping: Expr,
    /// The stiffness k.
    pub stiffness: Expr,
    /// The frequency omega of the drive or of a moving wall.
    pub frequency: Expr,
    /// The right side of the equation.
    pub load: BiasedHarmonic<Expr>,
    /// One wall, or one on each side.
    pub walls: Vec<OrbitWall>,
}

impl ImpactEquation {
    /// Takes an equation and its walls apart.
    ///
    /// # Errors
    /// [`OrbitError`] names the term that stands in the way.
    ///
    /// ```
    /// # use lindstedt_impact as lindstedt;
    /// use lindstedt::{Oscillator, orbits::ImpactEquation, wall::Wall};
    ///
    /// let ball = Oscillator::parse("x'' + g = 0")?;
    /// let table = Wall::parse("x > Z*sin(w*t)", &"e".parse()?)?;
    /// let question = ImpactEquation::new(&ball, &table)?;
    /// assert_eq!(question.walls[0].load.constant.to_string(), "-g");
    /// assert_eq!(question.walls[0].load.sine.to_string(), "w^2*Z");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn new(oscillator: &Oscillator, walls: &[Wall]) -> Result<Self, OrbitError> {
        let (x, velocity) = (oscillator.coordinate, oscillator.velocity());
        let slope = |of: Symbol| oscillator.force.differentiate(of)?.expand();
        let [damping, stiffness] = [slope(velocity)?, slope(x)?];
        let moving = [x, velocity, Symbol::new("t")];
        if [&damping, &stiffness].iter().any(|slope| moving.iter().any(|&own| slope.contains(own)))
        {
            return Err(OrbitError::Nonlinear(offending_term(oscillator)?));
        }
        if oscillator.force.contains_corner() {
            return Err(OrbitError::Nonlinear(offending_term(oscillator)?));
        }
        let at_zero = [(x, Expr::zero()), (velocity, Expr::zero())].into();
        let force = oscillator.force.substitute_all(&at_zero)?;
        let mut frequency = None;
        let load = harmonic(&(-&force), &mut frequency)?;
        let places: Result<Vec<_>, OrbitError> =
            walls.iter().map(|wall| place(wall, x, &mut frequency)).collect();
        let places = places?;
        let Some(FirstWave { rate: frequency, .. }) = frequency else {
            return Err(OrbitError::NoDrive);
        };
        match walls.len() {
            0 => return Err(OrbitError::NoWall),
            1 => {}
            2 if places[0].0 != places[1].0 => {}
            2 => return Err(OrbitError::SameSide(walls[0].gap.clone(), walls[1].gap.clone())),
            count => return Err(OrbitError::ManyWalls(count)),
        }
        let dynamic = (&stiffness - &frequency.integer_power(2)?).expand()?;
        if damping.is_zero() && dynamic.is_zero() {
            return Err(OrbitError::Resonance(frequency));
        }
        let walls = walls.iter().zip(places).map(|(wall, (side, offset))| {
            let load = load_of_gap(side, &offset, &load, [&damping, &stiffness, &frequency])?;
            Ok(OrbitWall { wall: wall.clone(), side, offset, load })
        });
        let walls: Result<Vec<_>, OrbitError> = walls.collect();
        Ok(Self {
            oscillator: oscillator.clone(),
            damping,
            stiffness,
            frequency,
            load,
            walls: walls?,
        })
    }

    /// The names that need values, in alphabetical order.
    pub fn parameters(&self) -> Vec<Symbol> {
        let names: BTreeSet<Symbol> = self
            .quantities()
            .iter()
            .flat_map(Expr::symbols)
            .filter(|name| name.name() != "pi")
            .collect();
        names.into_iter().collect()
    }

    /// Whether two walls bound the motion alike on both sides of a force without a constant, so
    /// that symmetric orbits exist.
    ///
    /// # Errors
    /// A step of algebra that fails.
    pub fn is_symmetric(&self) -> Result<bool, ExprError> {
        let [first, second] = self.walls.as_slice() else { return Ok(false) };
        let is_equal =
            |one: &Expr, other: &Expr| Ok::<_, ExprError>((one - other).expand()?.is_zero());
        Ok(self.load.constant.is_zero()
            && first.offset.is_still()
            && second.offset.is_still()
            && is_equal(&first.offset.constant, &second.offset.constant)?
            && is_equal(&first.wall.restitution, &second.wall.restitution)?)
    }

    /// All quantities whose numbers determine the motion, in the order in which
    /// [`CompiledImpact::at`] reads them.
    fn quantities(&self) -> Vec<Expr> {
        let own = [&self.damping, &self.stiffness, &self.frequency];
        let walls = self.walls.iter().flat_map(|wall| {
            wall.offset.parts().into_iter().chain(wall.load.parts()).chain([&wall.wall.restitution])
        });
        own.into_iter().chain(self.load.parts()).chain(walls).cloned().collect()
    }

    /// Compiles the question for many values of the `varying` parameters; all others have a value.
    ///
    /// # Errors
    /// A name without a value, or a value without a name.
    pub fn compile(
        &self,
        values: &Values,
        varying: &[Symbol],
    ) -> Result<CompiledImpact, OrbitError> {
        let known = self.parameters();
        let given = values.iter().map(|(name, _)| name);
        if let Some(name) = given.chain(varying.iter().copied()).find(|name| !known.contains(name))
        {
            return Err(OrbitError::Unknown { name, known });
        }
        if let Some(name) = varying.iter().find(|name| values.get(**name).is_some()) {
            return Err(OrbitError::Given(*name));
        }
        let missing: Vec<Symbol> = known
            .into_iter()
            .filter(|name| values.get(*name).is_none() && !varying.contains(name))
            .collect();
        if !missing.is_empty() {
            return Err(OrbitError::Missing(missing));
        }
        let exact: BTreeMap<Symbol, Expr> =
            values.iter().map(|(name, value)| (name, value.clone())).collect();
        let quantities: Result<Vec<Expr>, ExprError> =
            self.quantities().iter().map(|quantity| quantity.substitute_all(&exact)).collect();
        Ok(CompiledImpact {
            list: CompiledList::new(&quantities?, varying)?,
            sides: self.walls.iter().map(|wall| f64::from(wall.side)).collect(),
            frequency: self.frequency.clone(),
        })
    }

    /// The question in numbers.
    ///
    /// # Errors
    /// A missing or unknown value, one out of its range.
    pub fn numbers(&self, values: &Values) -> Result<ImpactNumbers, OrbitError> {
        let numbers = self.compile(values, &[])?.at(&[])?;
        for wall in &self.walls {
            wall.wall.restitution_at(&values.numbers())?;
        }
        Ok(numbers)
    }
}

impl ImpactEquation {
    /// Refuses a coefficient of restitution that leaves 0 to 1 within the ranges of parameters.
    pub(super) fn check_restitution(
        &self,
        values: &Values,
        varying: &[VaryingParameter],
    ) -> Result<(), OrbitError> {
        // At the corners of the ranges, where a monotonic expression is extreme.
        for corner in 0..1_usize << varying.len() {
            let mut numbers = values.numbers();
            for (index, own) in varying.iter().enumerate() {
                numbers.insert(own.name, own.range[corner >> index & 1]);
            }
            for wall in &self.walls {
                wall.wall.restitution_at(&numbers)?;
            }
        }
        Ok(())
    }
}

/// The term of the equation that is not linear with constant coefficients, as it was typed.
fn offending_term(oscillator: &Oscillator) -> Result<String, ExprError> {
    let (x, velocity) = (oscillator.coordinate, oscillator.velocity());
    let own = [x, velocity, velocity.derivative(), Symbol::new("t")];
    for (number, value) in oscillator.typed.values().enumerate() {
        let is_free = |slope: Result<Expr, ExprError>| {
            slope
                .and_then(|slope| slope.expand())
                .is_ok_and(|slope| !own.iter().any(|&name| slope.contains(name)))
        };
        let moves = [x, velocity].iter().any(|&name| value.contains(name));
        let is_linear = own[..3].iter().all(|&name| is_free(value.differentiate(name)));
        if !is_linear || moves && value.contains_corner() {
            return Ok(oscillator.typed.quote(&[number]));
        }
    }
    Ok(oscillator.force.to_string())
}

/// The first wave that is met, whose frequency all others have.
struct FirstWave {
    term: Expr,
    rate: Expr,
}

/// Reads a sum of constants and waves of one frequency.
fn harmonic(
    sum: &Expr,
    frequency: &mut Option<FirstWave>,
) -> Result<BiasedHarmonic<Expr>, OrbitError> {
    let t = Symbol::new("t");
    let expanded = sum.expand()?;
    let (mut constant, mut cosine, mut sine) = (vec![], vec![], vec![]);
    for term in expanded.terms() {
        if !term.contains(t) {
            constant.push(term.clone());
            continue;
        }
        let Some(wave) = HarmonicExcitation::of_term(term)? else {
            return Err(OrbitError::NoWave(term.to_string()));
        };
        match frequency {
            None => *frequency = Some(FirstWave { term: term.clone(), rate: wave.rate.clone() }),
            Some(known) if known.rate == wave.rate => {}
            Some(known) => {
                let (first, second) = (known.term.clone(), term.clone());
                return Err(OrbitError::TwoFrequencies { first, second });
            }
        }
        let (c, s) = (wave.phase.cos()?, wave.phase.sin()?);
        match wave.quadrature {
            Quadrature::Cosine => {
                cosine.push(&wave.factor * &c);
                sine.push(-&(&wave.factor * &s));
            }
            Quadrature::Sine => {
                cosine.push(&wave.factor * &s);
                sine.push(&wave.factor * &c);
            }
        }
    }
    let [constant, cosine, sine] = [constant, cosine, sine].map(Expr::sum);
    Ok(BiasedHarmonic { constant, cosine, sine })
}

/// The side of a wall, and its gap without the coordinate, which has the factor 1 or -1.
fn place(
    wall: &Wall,
    x: Symbol,
    frequency: &mut Option<FirstWave>,
) -> Result<(i8, BiasedHarmonic<Expr>), OrbitError> {
    wall.check(&[x])?;
    let nonlinear = || OrbitError::NonlinearWall { gap: wall.gap.clone(), coordinate: x };
    let slope = wall.gap.differentiate(x)?.expand()?;
    let value = slope.as_number().cloned().ok_or_else(nonlinear)?;
    let is_above = slope.has_leading_minus();
    let size = Expr::number(if is_above { -value } else { value });
    if size.is_zero() || wall.gap.contains_corner() {
        return Err(nonlinear());
    }
    let offset = wall.gap.substitute(x, &Expr::zero())?;
    let offset = harmonic(&Expr::divide(&offset, &size)?, frequency)?;
    Ok((if is_above { -1 } else { 1 }, offset))
}

/// The right side of the equation of a gap: s times that of the coordinate, and what the wall adds
/// by its place.
fn load_of_gap(
    side: i8,
    offset: &BiasedHarmonic<Expr>,
    load: &BiasedHarmonic<Expr>,
    [damping, stiffness, frequency]: [&Expr; 3],
) -> Result<BiasedHarmonic<Expr>, ExprError> {
    let side = Expr::from(i64::from(side));
    let dynamic = stiffness - &frequency.integer_power(2)?;
    let turn = damping * frequency;
    let sum = |own: &Expr, added: Expr| (&(&side * own) + &added).expand();
    Ok(BiasedHarmonic {
        constant: sum(&load.constant, stiffness * &offset.constant)?,
        cosine: sum(&load.cosine, &(&dynamic * &offset.cosine) + &(&turn * &offset.sine))?,
        sine: sum(&load.sine, &(&dynamic * &offset.sine) - &(&turn * &offset.cosine))?,
    })
}

/// A question whose numbers are computed again and again.
#[derive(Clone, Debug)]
pub struct CompiledImpact {
    list: CompiledList,
    sides: Vec<f64>,
    frequency: Expr,
}

impl CompiledImpact {
    /// The numbers at these values of the varying parameters.
    ///
    /// # Errors
    /// A frequency that is not positive, a coefficient that is not finite.
    pub fn at(&self, arguments: &[f64]) -> Result<ImpactNumbers, OrbitError> {
        let mut values = vec![0.0; 6 + 7 * self.sides.len()];
        self.list.call(arguments, &mut Vec::new(), &mut values);
        let harmonic = |at: usize| BiasedHarmonic {
            constant: values[at],
            cosine: values[at + 1],
            sine: values[at + 2],
        };
        let frequency = values[2];
        if !(frequency > 0.0 && frequency.is_finite()) {
            return Err(OrbitError::Frequency { name: self.frequency.clone(), value: frequency });
        }
        let walls = self.sides.iter().enumerate().map(|(number, &side)| {
            let at = 6 + 7 * number;
            WallNumbers {
                side,
                offset: harmonic(at),
                load: harmonic(at + 3),
                restitution: values[at + 6],
            }
        });
        let numbers = ImpactNumbers {
            damping: values[0],
            stiffness: values[1],
            frequency,
            load: harmonic(3),
            walls: walls.collect(),
        };
        match values.iter().all(|value| value.is_finite()) {
            true => Ok(numbers),
            false if !values[0].is_finite() => Err(OrbitError::NotFinite("damping")),
            false if !values[1].is_finite() => Err(OrbitError::NotFinite("stiffness")),
            false => Err(OrbitError::NotFinite("drive or a wall")),
        }
    }
}

/// A linear driven oscillator with walls in numbers, in the units of the equation.
#[derive(Clone, Debug, PartialEq)]
pub struct ImpactNumbers {
    /// The damping c.
    pub damping: f64,
    /// The stiffness k.
    pub stiffness: f64,
    /// The frequency omega.
    pub frequency: f64,
    /// The right side of the equation.
    pub load: BiasedHarmonic<f64>,
    /// The walls.
    pub walls: Vec<WallNumbers>,
}

/// A wall in numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct WallNumbers {
    /// The sign s of the coordinate in the gap.
    pub side: f64,
    /// The gap without the coordinate.
    pub offset: BiasedHarmonic<f64>,
    /// The right side of the equation of the gap.
    pub load: BiasedHarmonic<f64>,
    /// The coefficient of restitution.
    pub restitution: f64,
}

impl BiasedHarmonic<f64> {
    /// The value at a phase of the wave.
    pub fn value(&self, phase: f64) -> f64 {
        let (sine, cosine) = phase.sin_cos();
        self.constant + self.cosine * cosine + self.sine * sine
    }

    /// The derivative with respect to the phase.
    pub fn slope(&self, phase: f64) -> f64 {
        let (sine, cosine) = phase.sin_cos();
        self.sine * cosine - self.cosine * sine
    }
}
