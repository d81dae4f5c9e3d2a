//! The slow equations of a system, and the motion they belong to.

use std::collections::BTreeMap;

use num_traits::{One, Signed, Zero};

use super::expansion::{Expansion, OrderedTerm, Problem, WaveVector};
use super::modal::ModalForm;
use super::resonance::{Frequencies, Lattice, Resonance, alias};
use super::slow_equations::{
    PolarNames, SlowRate, combination, expression, in_slow_phases, motion, rates, reduced_rows,
    slow_phases,
};
use super::{CoupledSystem, MultipleScalesError, SlowSteadyState, steps};
use crate::coupled::CoupledEquations;
use crate::decimal::rounded_fraction;
use crate::derivation::DerivationLine;
use crate::exact::rational::{Integer, ratio, to_f64};
use crate::exact::{ComplexPolynomial, Polynomial, Rational};
use crate::expr::Expr;
use crate::interrupt::Supervision;
use crate::modes::ModeError;
use crate::solution::Definition;
use crate::symbol::{Symbol, fresh, fresh_stem};

use num_integer::Integer as _;

/// The highest order.
const HIGHEST_ORDER: usize = 6;

/// Number of digits of rounded coefficients.
pub(super) const KEPT_DIGITS: usize = 15;

/// Size below which a coefficient of rounded numbers is what is left of terms that cancel.
const NOISE: f64 = 1e-40;

/// The choices of a derivation.
#[derive(Clone, Debug, Default)]
pub struct MultipleScalesOptions {
    /// The highest order of the slow equations; without it the lowest at which damping, detuning and
    /// the nonlinear forces act.
    pub order: Option<usize>,
    /// Whether the slow equations are those of averaging to first order: of the means of forces along
    /// the motion of the linear system, which is the motion.
    pub averaging: bool,
    /// The resonances, such as `omega2 = 2*omega1, Omega = omega2`, or `none`; without them those
    /// that are near, where the frequencies are numbers.
    pub resonance: Option<String>,
    /// Whether the derivation is kept, order by order.
    pub steps: bool,
    /// Values of parameters, by which resonances are found where none are asked for; the formulas keep
    /// the letters.
    pub values: BTreeMap<Symbol, f64>,
    /// Interrupt and progress.
    pub supervision: Supervision,
}

/// The slow equations of a system.
#[derive(Clone, Debug, PartialEq)]
pub struct SlowMotion {
    /// The system.
    pub system: CoupledSystem,
    /// The highest order.
    pub order: usize,
    /// Whether these are the equations of averaging to first order.
    pub averaging: bool,
    /// The order as which damping, detunings and drives at a resonance count.
    pub small_order: usize,
    /// The resonances, as people write them.
    pub resonances: Vec<String>,
    /// The resonances, as relations between the linear frequencies and those of drives.
    pub(super) relations: Vec<Resonance>,
    /// The linear frequencies, the modes in their order.
    pub frequencies: Vec<Expr>,
    /// The shape of each mode: the coordinates in which it moves.
    pub shapes: Vec<Vec<Expr>>,
    /// The reference frequencies, which obey the resonances exactly.
    pub references: Vec<Expr>,
    /// The frequency of which that of the single drive is a multiple, and those of the modes that are
    /// [locked](Self::locked) to it.
    pub base: Option<Expr>,
    /// The frequency of the single drive.
    pub drive: Option<Expr>,
    /// The number of drive periods in a period of the base.
    pub periods: Option<usize>,
    /// Whether the reference frequency of each mode is a multiple of the base.
    pub locked: Vec<bool>,
    /// `sigma_j`, reference frequency less linear frequency, where they differ.
    pub detunings: Vec<Definition>,
    /// `a_j`, the amplitude of the first harmonic of each mode.
    pub amplitudes: Vec<Symbol>,
    /// `phi_j`, the phase of each mode.
    pub phases: Vec<Symbol>,
    /// The slow phases, whole combinations of the phases; a phase that is slow by itself has its own
    /// name.
    pub slow_phases: Vec<(Symbol, Vec<i32>)>,
    /// The rates of amplitudes and phases, in the slow phases.
    pub rates: Vec<SlowRate>,
    /// `B_j` and its conjugate, the complex amplitudes `(a_j/2) e^(i phi_j)`.
    pub complex_amplitudes: Vec<[Symbol; 2]>,
    /// `B_j'`, polynomials in all complex amplitudes.
    pub complex_rates: Vec<ComplexPolynomial>,
    /// The motion of each coordinate, in `t`, amplitudes and phases.
    pub motion: Vec<Expr>,
    /// Symbols that the formulas introduce; each may use those before it.
    pub definitions: Vec<Definition>,
    /// The derivation order by order; empty if it was not asked for.
    pub derivation: Vec<DerivationLine>,
    /// Whether coefficients are rounded to fifteen digits.
    pub rounded: bool,
    /// Whether terms of the equations are of a higher order, and so left out.
    pub leaves_out: bool,
    /// Waves in the motion that are near the frequency of a mode they are not in resonance with, where
    /// values are known: a divisor is small.
    pub near: Vec<NearDivisor>,
}

/// A wave near the frequency of a mode.
#[derive(Clone, Debug, PartialEq)]
pub struct NearDivisor {
    /// The number of the mode.
    pub mode: usize,
    /// The frequency of the wave.
    pub frequency: Expr,
    /// Its distance from that of the mode, as a part of it.
    pub distance: f64,
}

/// The indices of the modes that move.
fn moving(state: &SlowSteadyState) -> Vec<usize> {
    (0..state.amplitudes.len()).filter(|mode| state.amplitudes[*mode] != 0.0).collect()
}

impl SlowMotion {
    /// The method and its order.
    pub fn title(&self) -> String {
        match self.averaging {
            true => "Averaging to first order".to_owned(),
            false => format!("Multiple scales to order {}", self.order),
        }
    }

    /// Whether the drive fixes the phases of all modes that are locked to it, so that steady motions of
    /// these alone are periodic with the drive.
    pub fn is_driven(&self) -> bool {
        let locked = self.locked.iter().filter(|locked| **locked).count();
        self.base.is_some() && locked > 0 && self.slow_phases.len() == locked
    }

    /// The frequency of a steady motion that is periodic with the drive: no mode moves that it does not
    /// lock. `None` for other motions.
    pub fn driven_frequency(&self, state: &SlowSteadyState) -> Option<&Expr> {
        let moving = moving(state);
        if moving.is_empty() {
            return self.base.as_ref().or(self.drive.as_ref());
        }
        let is_locked = moving.iter().all(|mode| self.locked[*mode]);
        self.base.as_ref().filter(|_| is_locked && self.ties(&moving) == moving.len())
    }

    /// The slow equations of the system in which everything small is multiplied by a factor, each term
    /// by the power of it that is its order, and the detunings with the damping; its equations are those
    /// of its own system. Amplitudes stay as they are: the deviation from the true motion falls with a
    /// power of the factor.
    ///
    /// # Errors
    /// [`MultipleScalesError`], and where the equations cannot be written.
    pub fn with_small_terms_times(&self, factor: &Rational) -> Result<Self, MultipleScalesError> {
        let options = MultipleScalesOptions {
            order: Some(self.order),
            averaging: self.averaging,
            ..MultipleScalesOptions::default()
        };
        derive_scaled(&self.system, &options, Some(&self.relations), factor)
    }

    /// Whether the slow phases tie the moving modes of a steady motion to each other: without a drive
    /// it is periodic then.
    pub fn is_locked_together(&self, state: &SlowSteadyState) -> bool {
        let moving = moving(state);
        moving.len() == self.ties(&moving) + 1
    }

    /// The number of slow phases of these modes alone: the combinations of all slow phases, which are
    /// independent, in which the other modes cancel.
    fn ties(&self, moving: &[usize]) -> usize {
        let at_rest: Vec<Vec<i32>> = self
            .slow_phases
            .iter()
            .map(|(_, turns)| {
                let own = turns.iter().enumerate().filter(|(mode, _)| !moving.contains(mode));
                own.map(|(_, turn)| *turn).collect()
            })
            .collect();
        self.slow_phases.len() - reduced_rows(at_rest).len()
    }

    /// `a_j'` and `phi_j'` as expressions.
    ///
    /// # Errors
    /// A step of algebra that fails.
    pub fn rate(&self, mode: usize) -> Result<[Expr; 2], crate::expr::ExprError> {
        let phases: Vec<Symbol> = self.slow_phases.iter().map(|(name, _)| *name).collect();
        let over = Polynomial::symbol(self.amplitudes[mode]).power(-1);
        let over = over.unwrap_or_else(Polynomial::zero);
        let rate = &self.rates[mode];
        Ok([
            expression(&rate.amplitude, &phases, &|part| Expr::from(part))?,
            expression(&rate.phase, &phases, &|part| Expr::from(&part.product(&over)))?,
        ])
    }

    /// A slow phase as a combination of the phases; `None` of one that is a phase.
    pub fn meaning(&self, slow_phase: usize) -> Option<Expr> {
        let (name, turns) = self.slow_phases.get(slow_phase)?;
        (!self.phases.contains(name)).then(|| combination(turns, &self.phases))
    }
}

/// Derives the slow equations of a system.
///
/// # Errors
/// [`MultipleScalesError`].
///
/// ```
/// # use lindstedt_modes as lindstedt;
/// use lindstedt::multiple_scales::{CoupledSystem, MultipleScalesOptions, derive};
///
/// let system = CoupledSystem::parse(
///     "u'' + 2*mu1*u' + w1^2*u - alpha1*u*v = 0; v'' + 2*mu2*v' + w2^2*v - alpha2*u^2 = 0",
/// )?;
/// let resonance = Some("w2 = 2*w1".to_owned());
/// let slow = derive(&system, &MultipleScalesOptions { resonance, ..Default::default() })?;
/// let [rate, _] = slow.rate(0)?;
/// assert_eq!(rate.to_string(), "-a1*mu1 - a1*a2*alpha1*sin(gamma1)/(4*w1)");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn derive(
    system: &CoupledSystem,
    options: &MultipleScalesOptions,
) -> Result<SlowMotion, MultipleScalesError> {
    if let Some(order) = options.order.filter(|order| *order > HIGHEST_ORDER) {
        return Err(MultipleScalesError::Order(order, HIGHEST_ORDER));
    }
    derive_scaled(system, options, None, &Rational::one())
}

/// The slow equations of a system in which everything small is multiplied by a factor, each term by
/// the power of it that is its order; of these relations between the frequencies where they are known.
fn derive_scaled(
    system: &CoupledSystem,
    options: &MultipleScalesOptions,
    relations: Option<&[Resonance]>,
    factor: &Rational,
) -> Result<SlowMotion, MultipleScalesError> {
    let mut form = ModalForm::new(system)?;
    let drives: Vec<Polynomial> =
        system.drives.iter().map(|rate| drive_frequency(rate, &mut form)).collect();
    let known = known_values(&form, &options.values);
    let forced: Vec<bool> = (0..drives.len()).map(|drive| is_forced(system, drive)).collect();
    let frequencies = Frequencies {
        names: names_of_frequencies(system, &form, &drives),
        values: form
            .frequencies
            .iter()
            .map(|frequency| {
                frequency.number.or_else(|| Expr::from(&frequency.value).evaluate(&known).ok())
            })
            .chain(system.drives.iter().map(|rate| rate.evaluate(&known).ok()))
            .collect(),
        modes: form.frequencies.len(),
        degree: highest_degree(system),
        forced: &forced,
    };
    let resonances: Vec<Resonance> = match (relations, &options.resonance) {
        (Some(relations), _) => relations.to_vec(),
        (None, Some(text)) => frequencies.parse(text)?,
        (None, None) => frequencies.near()?,
    };
    let mut reference = References::new(system, &mut form, &drives, &resonances)?;
    let polar = polar_names(&form);
    let small_order = match system.small {
        Some(_) => 1,
        None => order_of_balance(system, &mut form.clone(), &reference, &polar)?,
    };
    let order = options.order.unwrap_or(small_order);
    if order < small_order {
        return Err(MultipleScalesError::BelowBalance { asked: order, lowest: small_order });
    }
    let mut terms = ordered(system, &reference, &form.projection, small_order);
    let power = |order: usize| num_traits::pow(factor.clone(), order);
    for own in terms.iter_mut().flatten() {
        own.term.coefficient = own.term.coefficient.map(|number| number * power(own.order));
    }
    for own in &mut reference.meanings {
        own.meaning = Expr::number(power(small_order)) * &own.meaning;
    }
    let leaves_out = terms.iter().flatten().any(|term| term.order > order);
    let problem = Problem {
        terms,
        drives: reference.drives.clone(),
        own: reference.own.clone(),
        references: reference.references.clone(),
        bases: reference.bases.clone(),
        detunings: reference.detunings.clone(),
        small_order,
        amplitudes: polar.complex.clone(),
        order,
        supervision: options.supervision,
        known: known_values(&form, &options.values),
    };
    form.near.clear();
    let mut expansion = problem.expand(&mut form)?;
    if options.averaging {
        let lowest = problem.terms.iter().flatten().map(|term| term.order).filter(|own| *own > 0);
        if order > small_order || lowest.min().is_some_and(|lowest| lowest < small_order) {
            return Err(MultipleScalesError::NoMean);
        }
        expansion.displacement.iter_mut().for_each(|orders| orders.truncate(1));
    }
    let written = resonances.iter().map(|resonance| frequencies.written(resonance)).collect();
    let derivation =
        Derivation { system, form: &form, reference: &reference, polar: &polar, problem: &problem };
    let mut slow = derivation.answer(&expansion, written, leaves_out, options.steps)?;
    slow.averaging = options.averaging;
    slow.relations = resonances;
    if !factor.is_one() {
        slow.system = scaled_system(system, &form, &reference, &problem)?;
    }
    Ok(slow)
}

/// The system whose small terms and detunings are those of a problem, as equations.
fn scaled_system(
    system: &CoupledSystem,
    form: &ModalForm,
    reference: &References,
    problem: &Problem,
) -> Result<CoupledSystem, MultipleScalesError> {
    let known = form.names.definitions.iter().chain(&reference.meanings);
    let in_letters = |polynomial: &Polynomial| -> Result<Expr, MultipleScalesError> {
        // Later names use those before them.
        let mut found = Expr::from(polynomial);
        for definition in known.clone().rev() {
            found = found.substitute(definition.symbol, &definition.meaning)?;
        }
        Ok(found)
    };
    let count = system.mass.len();
    // The stiffness with the frequencies nu - sigma: K + M V diag((nu - sigma)^2 - omega^2) P M.
    let mut changes = Vec::new();
    for (mode, frequency) in form.frequencies.iter().enumerate() {
        let [nu, sigma, own] =
            [&reference.references[mode], &problem.detunings[mode], &frequency.value];
        let moved = in_letters(nu)? - in_letters(sigma)?;
        changes.push(moved.integer_power(2)? - in_letters(own)?.integer_power(2)?);
    }
    let times_mass = |vector: &dyn Fn(usize) -> Polynomial, mass: &dyn Fn(usize) -> Polynomial| {
        let products = (0..count).map(|index| vector(index).product(&mass(index)));
        products.fold(Polynomial::zero(), |sum, product| sum + product)
    };
    let mut sides = Vec::new();
    for (row, terms) in problem.terms.iter().enumerate() {
        let mut left = Vec::new();
        for (column, name) in system.equations.coordinates.iter().enumerate() {
            let place = Expr::from(*name);
            let acceleration = Expr::from(name.derivative().derivative());
            left.push(in_letters(&system.mass[row][column])? * acceleration);
            left.push(in_letters(&system.stiffness[row][column])? * &place);
            for (mode, change) in changes.iter().enumerate() {
                let shape = times_mass(&|index| form.shapes[index][mode].clone(), &|index| {
                    system.mass[row][index].clone()
                });
                let onto = times_mass(&|index| form.projection[mode][index].clone(), &|index| {
                    system.mass[index][column].clone()
                });
                left.push(in_letters(&shape)? * change * in_letters(&onto)? * &place);
            }
        }
        for own in terms {
            left.push(in_letters(&own.term.coefficient)? * own.term.product(system)?);
        }
        sides.push((Expr::sum(left), Expr::zero()));
    }
    let equations = CoupledEquations::new(sides).map_err(ModeError::from)?;
    match equations.coordinates == system.equations.coordinates {
        true => Ok(CoupledSystem { equations, ..system.clone() }),
        false => Err(MultipleScalesError::NotScaled),
    }
}

/// The parts of a derivation.
struct Derivation<'a> {
    system: &'a CoupledSystem,
    form: &'a ModalForm,
    reference: &'a References,
    polar: &'a PolarNames,
    problem: &'a Problem,
}

impl Derivation<'_> {
    /// The slow equations of an expansion.
    fn answer(
        &self,
        expansion: &Expansion,
        resonances: Vec<String>,
        leaves_out: bool,
        keeps_steps: bool,
    ) -> Result<SlowMotion, MultipleScalesError> {
        let Self { system, form, reference, polar, problem } = self;
        let round = |polynomial: &Polynomial| match form.rounded {
            true => polynomial.map(|number| match to_f64(&number.abs()) < NOISE {
                true => Rational::zero(),
                false => rounded_fraction(number, KEPT_DIGITS),
            }),
            false => polynomial.clone(),
        };
        let in_phases = rates(expansion, polar, |order| order > 0);
        let basis = slow_phases(&in_phases);
        let stem = fresh_stem("gamma", &form.names.taken);
        let mut named = 0;
        let slow_phases: Vec<(Symbol, Vec<i32>)> = basis
            .iter()
            .map(|turns| {
                let alone = turns.iter().filter(|m| **m != 0).count() == 1;
                let own = turns.iter().position(|m| *m == 1).filter(|_| alone);
                let name = match own {
                    Some(mode) => polar.phases[mode],
                    None => {
                        named += 1;
                        Symbol::new(&format!("{stem}{named}"))
                    }
                };
                (name, turns.clone())
            })
            .collect();
        let rounded_rates = |rate: &SlowRate| {
            let rate = in_slow_phases(rate, &basis);
            let waves = |waves: &super::PhaseWaves| {
                waves
                    .iter()
                    .map(|(turns, parts)| (turns.clone(), parts.each_ref().map(round)))
                    .collect()
            };
            SlowRate { amplitude: waves(&rate.amplitude), phase: waves(&rate.phase) }
        };
        // The base of the single drive, and the number of its periods in one of that.
        let base = match reference.drives.as_slice() {
            [wave] => {
                let mut places = wave.iter().enumerate().filter(|(_, times)| **times != 0);
                match (places.next(), places.next()) {
                    (Some((place, times)), None) => {
                        usize::try_from(*times).ok().map(|periods| (place, periods))
                    }
                    _ => None,
                }
            }
            _ => None,
        };
        let motion = motion(problem, expansion, polar, &form.shapes, &round)?;
        let columns = |column: usize| {
            form.shapes.iter().map(|row| Expr::from(&round(&row[column]))).collect::<Vec<Expr>>()
        };
        let mut slow = SlowMotion {
            system: (*system).clone(),
            order: problem.order,
            averaging: false,
            small_order: problem.small_order,
            resonances,
            relations: vec![],
            frequencies: form
                .frequencies
                .iter()
                .map(|frequency| Expr::from(&round(&frequency.value)))
                .collect(),
            shapes: (0..form.frequencies.len()).map(columns).collect(),
            references: reference.references.iter().map(|nu| Expr::from(&round(nu))).collect(),
            base: base.map(|(place, _)| Expr::from(&round(&reference.bases[place]))),
            drive: match reference.drives.as_slice() {
                [wave] => Some(Expr::from(&round(&sum_of_bases(wave, &reference.bases)))),
                _ => None,
            },
            periods: base.map(|(_, periods)| periods),
            locked: reference
                .own
                .iter()
                .map(|row| {
                    let mut others = row.iter().enumerate().filter(|(_, times)| **times != 0);
                    base.is_some_and(|(place, _)| others.all(|(other, _)| other == place))
                })
                .collect(),
            detunings: reference.meanings.clone(),
            amplitudes: polar.amplitudes.clone(),
            phases: polar.phases.clone(),
            slow_phases,
            rates: in_phases.iter().map(rounded_rates).collect(),
            complex_amplitudes: polar.complex.clone(),
            complex_rates: (0..polar.complex.len())
                .map(|mode| {
                    let mut sum = ComplexPolynomial::zero();
                    expansion.rates.iter().for_each(|rates| sum.accumulate(&rates[mode]));
                    sum.map(round)
                })
                .collect(),
            motion,
            definitions: vec![],
            derivation: match keeps_steps {
                true => {
                    let coordinates = &system.equations.coordinates;
                    steps::derivation(coordinates, problem, expansion, form, polar, &round)?
                }
                false => vec![],
            },
            rounded: form.rounded,
            leaves_out,
            near: form.near.clone(),
        };
        slow.definitions = used(&slow, form.names.definitions.clone())?;
        Ok(slow)
    }
}

/// The definitions that occur in an answer, or in others that do.
fn used(
    slow: &SlowMotion,
    definitions: Vec<Definition>,
) -> Result<Vec<Definition>, MultipleScalesError> {
    let mut names: Vec<Symbol> = slow
        .motion
        .iter()
        .chain(&slow.frequencies)
        .chain(&slow.references)
        .chain(slow.shapes.iter().flatten())
        .flat_map(Expr::symbols)
        .collect();
    for mode in 0..slow.rates.len() {
        names.extend(slow.rate(mode)?.iter().flat_map(Expr::symbols));
    }
    names.extend(slow.detunings.iter().flat_map(|detuning| detuning.meaning.symbols()));
    names.extend(slow.derivation.iter().flat_map(DerivationLine::symbols));
    let mut kept: Vec<Definition> = Vec::new();
    for definition in definitions.into_iter().rev() {
        if names.contains(&definition.symbol) {
            names.extend(definition.meaning.symbols());
            kept.push(definition);
        }
    }
    kept.reverse();
    Ok(kept)
}

/// The values that are given, and those of the definitions that follow from them.
fn known_values(form: &ModalForm, given: &BTreeMap<Symbol, f64>) -> BTreeMap<Symbol, f64> {
    let mut known = given.clone();
    known.insert(Symbol::new("pi"), std::f64::consts::PI);
    for definition in &form.names.definitions {
        if let Ok(value) = definition.meaning.evaluate(&known) {
            known.insert(definition.symbol, value);
        }
    }
    known
}

/// The frequency of a drive, a single term.
fn drive_frequency(rate: &Expr, form: &mut ModalForm) -> Polynomial {
    let taken = form.names.taken.clone();
    let polynomial = crate::modes::reading::polynomial(rate, &taken, &mut form.names.definitions);
    form.names.taken.extend(form.names.definitions.iter().map(|known| known.symbol));
    form.names.single(&polynomial, "Omega_")
}

/// Whether a drive is a force, alone.
fn is_forced(system: &CoupledSystem, drive: usize) -> bool {
    let mut terms = system.terms.iter().flatten();
    terms.any(|term| term.powers.is_empty() && term.waves.iter().any(|wave| wave.drive == drive))
}

/// The greatest number of factors of a term that may drive a resonance, three at least with the
/// squares of quadratic terms.
fn highest_degree(system: &CoupledSystem) -> i32 {
    let degrees = system.terms.iter().flatten().map(|term| term.degree() + term.waves.len());
    degrees.max().map_or(3, |degree| i32::try_from(degree).unwrap_or(3).clamp(3, 5))
}

/// The names by which the frequencies may be called.
fn names_of_frequencies(
    system: &CoupledSystem,
    form: &ModalForm,
    drives: &[Polynomial],
) -> Vec<Vec<Expr>> {
    let modes = form.frequencies.iter().enumerate().map(|(index, frequency)| {
        let own = Expr::from(&frequency.value);
        let alias = alias(index + 1, &system.equations.parameters);
        // A name, and one that no other mode has.
        let twice = form
            .frequencies
            .iter()
            .filter(|other| Expr::from(&other.value).symbols() == own.symbols());
        match own.as_number().is_some() || twice.count() > 1 {
            true => alias.into_iter().chain([own]).collect(),
            false => std::iter::once(own).chain(alias).collect(),
        }
    });
    let drives = drives.iter().zip(&system.drives).enumerate().map(|(index, (drive, rate))| {
        let number = if drives.len() > 1 { (index + 1).to_string() } else { String::new() };
        let alias = Symbol::new(&format!("Omega{number}"));
        let own = [Expr::from(drive), rate.clone()];
        match rate.as_number() {
            Some(_) => std::iter::once(Expr::from(alias)).chain(own).collect(),
            None if system.equations.parameters.contains(&alias) => own.to_vec(),
            None => own.into_iter().chain([Expr::from(alias)]).collect(),
        }
    });
    modes.chain(drives).collect()
}

/// The names of amplitudes and phases.
fn polar_names(form: &ModalForm) -> PolarNames {
    let taken = &form.names.taken;
    let count = form.frequencies.len();
    let family = |stem: &str| -> Vec<Symbol> {
        let stem = fresh_stem(stem, taken);
        (1..=count).map(|number| Symbol::new(&format!("{stem}{number}"))).collect()
    };
    let (own, conjugate) = (family("B"), family("Bc"));
    PolarNames {
        complex: own.into_iter().zip(conjugate).map(|(own, other)| [own, other]).collect(),
        amplitudes: family("a"),
        phases: family("phi"),
    }
}

/// The reference frequencies and the waves of modes and drives.
struct References {
    bases: Vec<Polynomial>,
    own: Vec<WaveVector>,
    drives: Vec<WaveVector>,
    references: Vec<Polynomial>,
    detunings: Vec<Polynomial>,
    /// The names of detunings.
    meanings: Vec<Definition>,
}

impl References {
    fn new(
        system: &CoupledSystem,
        form: &mut ModalForm,
        drives: &[Polynomial],
        resonances: &[Resonance],
    ) -> Result<Self, MultipleScalesError> {
        let modes = form.frequencies.len();
        let waves = system.terms.iter().flatten().flat_map(|term| &term.waves);
        let denominators =
            waves.fold(Integer::one(), |common, wave| common.lcm(wave.multiple.denom()));
        let count = modes + drives.len();
        let lattice = Lattice::new([modes, count], resonances, &denominators)?;
        let value = |column: usize| match column.checked_sub(modes) {
            Some(drive) => drives[drive].clone(),
            None => form.frequencies[column].value.clone(),
        };
        let part = Polynomial::constant(ratio(1, lattice.divisor));
        let mut bases: Vec<Polynomial> =
            lattice.bases.iter().map(|base| value(*base).product(&part)).collect();
        let mut rows = lattice.rows.clone();
        let mut references = Vec::new();
        for index in 0..modes {
            let frequency = sum_of_bases(&rows[index], &bases);
            let reference = form.names.single(&frequency, &format!("nu{}", index + 1));
            if frequency.single_term().is_none() {
                put_in_place_of_a_base(index, &reference, &mut rows, &mut bases);
            }
            references.push(reference);
        }
        let mut found = Self {
            own: rows[..modes].to_vec(),
            drives: rows[modes..].to_vec(),
            references: vec![],
            detunings: vec![],
            meanings: vec![],
            bases,
        };
        for (index, reference) in references.into_iter().enumerate() {
            let own = &form.frequencies[index].value;
            let mut difference = own.clone();
            difference.negate();
            difference.accumulate(&reference);
            let difference = form.tidied(&difference);
            if form.is_zero(&difference) {
                found.detunings.push(Polynomial::zero());
            } else {
                let wanted = format!("sigma{}", index + 1);
                let symbol = fresh(&wanted, &form.names.taken);
                form.names.taken.push(symbol);
                let round = |number: &Rational| match form.rounded {
                    true => rounded_fraction(number, KEPT_DIGITS),
                    false => number.clone(),
                };
                let meaning = Expr::from(&difference.map(round));
                found.meanings.push(Definition { symbol, meaning });
                found.detunings.push(Polynomial::symbol(symbol));
            }
            found.references.push(reference);
        }
        Ok(found)
    }
}

/// The frequency with this row.
fn sum_of_bases(row: &WaveVector, bases: &[Polynomial]) -> Polynomial {
    let mut sum = Polynomial::zero();
    for (times, base) in row.iter().zip(bases) {
        let times = Polynomial::constant(Rational::from_integer((*times).into()));
        sum.accumulate(&base.product(&times));
    }
    sum
}

/// Makes a frequency with a name a base, in the place of one that it contains once: sums such as
/// `Omega - omega1` do not stand in the formulas then.
fn put_in_place_of_a_base(
    index: usize,
    reference: &Polynomial,
    rows: &mut [WaveVector],
    bases: &mut [Polynomial],
) {
    let own = rows[index].clone();
    let Some(place) = (0..own.len()).rev().find(|place| own[*place].abs() == 1) else { return };
    bases[place] = reference.clone();
    for row in rows {
        let times = row[place] * own[place];
        for (entry, own) in row.iter_mut().zip(&own) {
            *entry -= times * own;
        }
        row[place] = times;
    }
}

/// The order of each term, damping and what drives a resonance counted as small as detunings.
fn ordered(
    system: &CoupledSystem,
    reference: &References,
    projection: &[Vec<Polynomial>],
    small_order: usize,
) -> Vec<Vec<OrderedTerm>> {
    // Whether a wave on an equation drives a mode at its own frequency.
    let resonant = |row: usize, multiple: &Rational, drive: usize| {
        let wave: Vec<Rational> = reference.drives[drive]
            .iter()
            .map(|m| multiple * Rational::from_integer((*m).into()))
            .collect();
        reference.own.iter().zip(projection).any(|(own, onto)| {
            !onto[row].is_zero()
                && own.iter().zip(&wave).all(|(own, m)| Rational::from_integer((*own).into()) == *m)
        })
    };
    let order =
        |row: usize, term: &super::system::SmallTerm| match (term.degree(), term.written_order) {
            (0, written) => match term.waves.as_slice() {
                [wave] if !resonant(row, &wave.multiple, wave.drive) => written,
                _ => written.max(small_order),
            },
            (_, written @ 1..) => written,
            (1, 0) => small_order,
            (degree, 0) => match system.small {
                Some(_) => 1,
                None => degree - 1,
            },
        };
    let row = |(row, terms): (usize, &Vec<super::system::SmallTerm>)| {
        terms
            .iter()
            .map(|term| OrderedTerm { order: order(row, term), term: term.clone() })
            .collect()
    };
    system.terms.iter().enumerate().map(row).collect()
}

/// The order at which nonlinear terms, and nonlinear terms with drives, change the amplitudes first.
fn order_of_balance(
    system: &CoupledSystem,
    form: &mut ModalForm,
    reference: &References,
    polar: &PolarNames,
) -> Result<usize, MultipleScalesError> {
    /// The order without a nonlinear effect below it: that of a cubic force.
    const USUAL: usize = 2;
    let nonlinear =
        |term: &OrderedTerm| term.term.degree() > 1 || (term.term.degree() == 0 && term.order == 0);
    let all = ordered(system, reference, &form.projection, HIGHEST_ORDER + 1);
    let terms: Vec<Vec<OrderedTerm>> =
        all.into_iter().map(|terms| terms.into_iter().filter(nonlinear).collect()).collect();
    let highest = terms.iter().flatten().map(|term| term.term.degree()).max().unwrap_or(0);
    for order in 1..=USUAL.max(highest.saturating_sub(1)).min(4) {
        let problem = Problem {
            terms: terms.clone(),
            drives: reference.drives.clone(),
            own: reference.own.clone(),
            references: reference.references.clone(),
            bases: reference.bases.clone(),
            detunings: vec![Polynomial::zero(); reference.own.len()],
            small_order: HIGHEST_ORDER + 1,
            amplitudes: polar.complex.clone(),
            order,
            supervision: Supervision::default(),
            known: BTreeMap::new(),
        };
        let expansion = problem.expand(form)?;
        let acts =
            |rate: &ComplexPolynomial| !form.is_zero(&rate.real) || !form.is_zero(&rate.imaginary);
        if expansion.rates.iter().flatten().any(acts) {
            return Ok(order);
        }
    }
    Ok(USUAL)
}
