//! The table of methods: a row each, with what the rest of the program needs to know of it.
//!
//! In: a [`Method`]. Out: its [`MethodEntry`]: the function that solves, the options it takes, the
//! representation of the force it uses.

use super::{
    Options, Refusal, amplitude_frequency, averaging, energy_balance, exact, frequency_formula,
    hamiltonian, harmonic_balance, hermite_pade, homotopy_analysis, homotopy_perturbation, inertia,
    iteration_perturbation, lindstedt_poincare, max_min, multiple_scales, one_term, pade,
    parameter_expansion, variational_iteration,
};
use crate::conservative::force::CentredForce;
use crate::oscillator::Oscillator;
use crate::solution::{Degrees, Method, Solution};

/// The definition of omega^2 for a motion `A cos(theta)`, evaluated numerically: takes the force
/// about the equilibrium and the absolute value of the amplitude, and returns omega^2 and a bound
/// of its relative error.
pub type Definition = fn(&CentredForce, f64) -> Option<(f64, f64)>;

/// A row of [`METHODS`].
pub struct MethodEntry {
    /// The method.
    pub method: Method,
    /// Derives its answer for an oscillator that swings about zero.
    pub solve: fn(&Oscillator, &Options) -> Result<Solution, Refusal>,
    /// Options that the method takes, beside the definition of the amplitude and the small
    /// parameter.
    pub takes: &'static [Choice],
    /// The representation of the force that the method uses.
    pub sees: ForceRepresentation,
    /// The degree of the Taylor polynomial with rounded coefficients that stands for the force
    /// about an equilibrium without a closed form, zero for a polynomial force kept whole; `None`
    /// if the force is taken as it is. The flag says whether the force is a polynomial.
    pub rounded_degree: fn(&Options, bool) -> Option<u32>,
    /// The definition of the frequency of a method of one term.
    pub definition: Option<Definition>,
    /// Whether its law holds for either sign of the amplitude; otherwise it is written for positive
    /// ones.
    pub signed: bool,
    /// The way in which its motion is evaluated numerically.
    pub motion: MotionEvaluation,
    /// Its treatment of equations with a position-dependent inertia; `None` if it has none of its
    /// own.
    pub inertia: Option<inertia::Approach>,
}

/// The way in which a motion is evaluated numerically.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MotionEvaluation {
    /// The formula.
    Formula,
    /// The formula of an iterate, whose projections of the force may be taken by quadrature.
    Iterate,
    /// The solution of a balance of harmonics.
    Balance,
    /// Quadrature of the energy: the true motion.
    Exact,
}

/// A method whose omega^2 is the projection of the force on the first harmonic, over the amplitude.
const OF_THE_SHARED_INTEGRAL: MethodEntry = MethodEntry {
    method: Method::Hamiltonian,
    solve: hamiltonian::solve,
    takes: &[Choice::Order],
    sees: ForceRepresentation::Force,
    rounded_degree: |_, _| None,
    definition: Some(one_term::first_projection_over_amplitude),
    signed: false,
    motion: MotionEvaluation::Formula,
    inertia: None,
};

/// An option of a method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Choice {
    /// An order: a power of the small parameter, a number of harmonics or of passes.
    Order,
    /// The degrees of an approximant.
    Degrees,
    /// The degree of a Taylor polynomial in place of the force.
    Taylor,
    /// The convergence-control parameter.
    Hbar,
    /// One of several limit cycles.
    Cycle,
    /// A resonance of a driven motion.
    Resonance,
    /// The frequency without the motion.
    FrequencyAlone,
}

impl Choice {
    /// In running text.
    pub fn words(self) -> &'static str {
        match self {
            Self::Order => "order",
            Self::Degrees => "degrees of an approximant",
            Self::Taylor => "Taylor polynomial in place of the force",
            Self::Hbar => "convergence-control parameter",
            Self::Cycle => "choice among limit cycles",
            Self::Resonance => "choice among resonances",
            Self::FrequencyAlone => "frequency without the motion",
        }
    }
}

/// The representation of the force that a method uses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ForceRepresentation {
    /// Its derivatives at the equilibrium.
    Derivatives,
    /// Its derivatives, as a Taylor polynomial of a chosen degree.
    TaylorPolynomial,
    /// The force as it is, unless its Taylor polynomial is asked for.
    Force,
}

/// Every method, in the order of [`Method::ALL`].
pub const METHODS: [MethodEntry; Method::ALL.len()] = [
    MethodEntry {
        method: Method::LindstedtPoincare,
        solve: lindstedt_poincare::solve,
        takes: &[Choice::Order, Choice::Cycle, Choice::FrequencyAlone],
        sees: ForceRepresentation::Derivatives,
        rounded_degree: |options, _| Some(options.order.unwrap_or(4) + 1),
        signed: true,
        ..OF_THE_SHARED_INTEGRAL
    },
    MethodEntry {
        method: Method::HomotopyPerturbation,
        solve: homotopy_perturbation::solve,
        takes: &[Choice::Order, Choice::Taylor],
        sees: ForceRepresentation::TaylorPolynomial,
        rounded_degree: |options, _| {
            Some(options.taylor.unwrap_or(beyond_twice(options.order.unwrap_or(2))))
        },
        definition: None,
        signed: true,
        ..OF_THE_SHARED_INTEGRAL
    },
    MethodEntry {
        method: Method::HomotopyAnalysis,
        solve: homotopy_analysis::solve,
        takes: &[Choice::Order, Choice::Taylor, Choice::Hbar],
        sees: ForceRepresentation::TaylorPolynomial,
        rounded_degree: |options, _| {
            Some(options.taylor.unwrap_or(beyond_twice(options.order.unwrap_or(2))))
        },
        definition: None,
        signed: true,
        ..OF_THE_SHARED_INTEGRAL
    },
    MethodEntry {
        method: Method::IterationPerturbation,
        solve: iteration_perturbation::solve,
        rounded_degree: |options, polynomial| {
            (polynomial && options.order.is_some_and(|order| order > 1)).then_some(0)
        },
        motion: MotionEvaluation::Iterate,
        ..OF_THE_SHARED_INTEGRAL
    },
    MethodEntry {
        method: Method::ParameterExpansion,
        solve: parameter_expansion::solve,
        takes: &[Choice::Order, Choice::Taylor],
        rounded_degree: |options, polynomial| match options.taylor {
            Some(degree) => Some(degree),
            None => (polynomial && options.order != Some(1)).then_some(0),
        },
        ..OF_THE_SHARED_INTEGRAL
    },
    MethodEntry {
        method: Method::HarmonicBalance,
        solve: harmonic_balance::solve,
        motion: MotionEvaluation::Balance,
        inertia: Some(inertia::HARMONIC_BALANCE),
        ..OF_THE_SHARED_INTEGRAL
    },
    MethodEntry {
        method: Method::EnergyBalance,
        solve: energy_balance::solve,
        definition: Some(energy_balance::by_quadrature),
        inertia: Some(inertia::ENERGY_BALANCE),
        ..OF_THE_SHARED_INTEGRAL
    },
    MethodEntry { method: Method::MaxMin, solve: max_min::solve, ..OF_THE_SHARED_INTEGRAL },
    MethodEntry {
        method: Method::AmplitudeFrequency,
        solve: amplitude_frequency::solve,
        definition: Some(amplitude_frequency::by_definition),
        ..OF_THE_SHARED_INTEGRAL
    },
    MethodEntry { inertia: Some(inertia::HAMILTONIAN), ..OF_THE_SHARED_INTEGRAL },
    MethodEntry {
        method: Method::VariationalIteration,
        solve: variational_iteration::solve,
        motion: MotionEvaluation::Iterate,
        ..OF_THE_SHARED_INTEGRAL
    },
    MethodEntry {
        method: Method::FrequencyFormula,
        solve: frequency_formula::solve,
        definition: Some(frequency_formula::by_definition),
        ..OF_THE_SHARED_INTEGRAL
    },
    MethodEntry {
        method: Method::Averaging,
        solve: averaging::solve,
        takes: &[Choice::Order, Choice::Resonance],
        rounded_degree: |_, polynomial| polynomial.then_some(0),
        definition: None,
        signed: true,
        ..OF_THE_SHARED_INTEGRAL
    },
    MethodEntry {
        method: Method::Pade,
        solve: pade::solve,
        takes: &[Choice::Degrees, Choice::Cycle],
        sees: ForceRepresentation::Derivatives,
        rounded_degree: |options, _| {
            let sum = options.degrees.map_or(3, Degrees::sum);
            Some(beyond_twice(sum))
        },
        definition: None,
        signed: true,
        ..OF_THE_SHARED_INTEGRAL
    },
    MethodEntry {
        method: Method::HermitePade,
        solve: hermite_pade::solve,
        takes: &[Choice::Degrees, Choice::Cycle],
        sees: ForceRepresentation::Derivatives,
        rounded_degree: |options, _| {
            Some(beyond_twice(options.degrees.map_or(3, Degrees::sum).saturating_add(1)))
        },
        definition: None,
        signed: true,
        ..OF_THE_SHARED_INTEGRAL
    },
    MethodEntry {
        method: Method::MultipleScales,
        solve: multiple_scales::solve,
        takes: &[Choice::Order, Choice::Cycle, Choice::Resonance],
        sees: ForceRepresentation::Derivatives,
        rounded_degree: |options, _| Some(options.order.unwrap_or(4) + 1),
        definition: None,
        signed: true,
        ..OF_THE_SHARED_INTEGRAL
    },
    MethodEntry {
        method: Method::Exact,
        solve: exact::solve,
        takes: &[],
        definition: None,
        motion: MotionEvaluation::Exact,
        inertia: Some(inertia::EXACT),
        ..OF_THE_SHARED_INTEGRAL
    },
];

impl MethodEntry {
    /// The row of a method.
    pub fn for_method(method: Method) -> &'static Self {
        // The rows are in the order of `Method::ALL`, which is that of the variants; a test checks
        // this.
        &METHODS[method as usize]
    }

    /// Whether a user may choose this.
    pub fn takes(&self, choice: Choice) -> bool {
        self.takes.contains(&choice)
    }

    /// Whether the method uses only the derivatives of the force at the equilibrium.
    pub fn expands(&self) -> bool {
        matches!(
            self.sees,
            ForceRepresentation::Derivatives | ForceRepresentation::TaylorPolynomial
        )
    }
}

/// The names of the methods that take a choice, in words: `lindstedt-poincare and pade`.
///
/// ```
/// # use lindstedt_oscillator as lindstedt;
/// use lindstedt::method::table::{Choice, that_take};
///
/// assert_eq!(that_take(Choice::Hbar), "homotopy-analysis");
/// ```
pub fn that_take(choice: Choice) -> String {
    let names: Vec<&str> = METHODS
        .iter()
        .filter(|entry| entry.takes(choice))
        .map(|entry| entry.method.name())
        .collect();
    match names.split_last() {
        Some((last, [])) => (*last).to_owned(),
        Some((last, others)) => format!("{} and {last}", others.join(", ")),
        None => String::new(),
    }
}

/// The degree to which an expansion of this order reaches in an odd force.
fn beyond_twice(order: u32) -> u32 {
    order.saturating_mul(2).saturating_add(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_method_has_its_row() {
        for method in Method::ALL {
            assert_eq!(MethodEntry::for_method(method).method, method);
        }
        assert_eq!(that_take(Choice::Hbar), "homotopy-analysis");
        assert_eq!(
            that_take(Choice::Cycle),
            "lindstedt-poincare, pade, hermite-pade and multiple-scales"
        );
    }
}
