//! The methods by name, and what their orders count.

/// The method that derived a solution.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Method {
    /// Strained time, secular terms eliminated order by order.
    LindstedtPoincare,
    /// The whole nonlinearity at the first power of a bookkeeping parameter.
    HomotopyPerturbation,
    /// A homotopy with a convergence-control parameter hbar, frequency expanded as well.
    HomotopyAnalysis,
    /// The nonlinear factor frozen at the previous iterate.
    IterationPerturbation,
    /// Coefficients of the equation expanded in a bookkeeping parameter.
    ParameterExpansion,
    /// As many harmonics as wanted, each balanced.
    HarmonicBalance,
    /// The energy of a one-term motion collocated at an eighth of the period.
    EnergyBalance,
    /// omega^2 between the least and the largest of f(x)/x.
    MaxMin,
    /// Two trial motions and the residuals they leave at one instant.
    AmplitudeFrequency,
    /// The mean Hamiltonian of a one-term motion made stationary.
    Hamiltonian,
    /// One correction functional, its secular term removed.
    VariationalIteration,
    /// The slope of the force at half the amplitude.
    FrequencyFormula,
    /// Slow equations for amplitude and phase, by Krylov, Bogoliubov and Mitropolsky.
    Averaging,
    /// A quotient of polynomials that agrees with the exact series.
    Pade,
    /// A root of a quadratic equation in polynomials that agrees with it.
    HermitePade,
    /// Amplitude and phase on slow times, one for each order.
    MultipleScales,
    /// The period by elliptic integrals or Gamma functions, else by quadrature.
    Exact,
}

/// The meaning of the order of an answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Counts {
    /// Powers of the small parameter.
    Powers,
    /// Powers of a bookkeeping parameter that is one in the end; everything stands in units of
    /// omega.
    PowersOfBookkeeping,
    /// The first frequency and its corrections.
    Corrections,
    /// Passes of an iteration.
    Passes,
    /// Harmonics.
    Harmonics,
    /// The degrees of this many polynomials.
    Degrees(usize),
    /// There is only one order.
    Nothing,
}

impl Method {
    /// Every method, in the order in which they are listed to users.
    pub const ALL: [Self; 17] = [
        Self::LindstedtPoincare,
        Self::HomotopyPerturbation,
        Self::HomotopyAnalysis,
        Self::IterationPerturbation,
        Self::ParameterExpansion,
        Self::HarmonicBalance,
        Self::EnergyBalance,
        Self::MaxMin,
        Self::AmplitudeFrequency,
        Self::Hamiltonian,
        Self::VariationalIteration,
        Self::FrequencyFormula,
        Self::Averaging,
        Self::Pade,
        Self::HermitePade,
        Self::MultipleScales,
        Self::Exact,
    ];

    /// The name on the command line and in JSON, the name in running text, and what the order
    /// counts.
    fn words(self) -> (&'static str, &'static str, Counts) {
        match self {
            Self::LindstedtPoincare => ("lindstedt-poincare", "Lindstedt-Poincare", Counts::Powers),
            Self::HomotopyPerturbation => {
                ("homotopy-perturbation", "Homotopy perturbation", Counts::PowersOfBookkeeping)
            }
            Self::HomotopyAnalysis => {
                ("homotopy-analysis", "Homotopy analysis", Counts::Corrections)
            }
            Self::IterationPerturbation => {
                ("iteration-perturbation", "Iteration perturbation", Counts::Passes)
            }
            Self::ParameterExpansion => {
                ("parameter-expansion", "Parameter expansion", Counts::PowersOfBookkeeping)
            }
            Self::HarmonicBalance => ("harmonic-balance", "Harmonic balance", Counts::Harmonics),
            Self::EnergyBalance => ("energy-balance", "Energy balance", Counts::Nothing),
            Self::MaxMin => ("max-min", "Max-min approach", Counts::Nothing),
            Self::AmplitudeFrequency => {
                ("amplitude-frequency", "Amplitude-frequency formulation", Counts::Nothing)
            }
            Self::Hamiltonian => ("hamiltonian", "Hamiltonian approach", Counts::Nothing),
            Self::VariationalIteration => {
                ("variational-iteration", "Variational iteration", Counts::Nothing)
            }
            Self::FrequencyFormula => ("frequency-formula", "Frequency formula", Counts::Nothing),
            Self::Averaging => ("averaging", "Averaging", Counts::Powers),
            Self::Pade => ("pade", "Pade approximant", Counts::Degrees(2)),
            Self::HermitePade => ("hermite-pade", "Hermite-Pade approximant", Counts::Degrees(3)),
            Self::MultipleScales => ("multiple-scales", "Multiple scales", Counts::Powers),
            Self::Exact => ("exact", "Exact frequency", Counts::Nothing),
        }
    }

    /// The name on the command line and in JSON.
    pub fn name(self) -> &'static str {
        self.words().0
    }

    /// The name in running text.
    pub fn title(self) -> &'static str {
        self.words().1
    }

    /// The meaning of the order of its answers.
    pub fn counts(self) -> Counts {
        self.words().2
    }

    /// The abbreviation in use in the literature, where there is one.
    pub fn abbreviation(self) -> Option<&'static str> {
        Some(match self {
            Self::LindstedtPoincare => "lp",
            Self::HomotopyPerturbation => "hpm",
            Self::HomotopyAnalysis => "ham",
            Self::ParameterExpansion => "pem",
            Self::HarmonicBalance => "hb",
            Self::EnergyBalance => "ebm",
            Self::AmplitudeFrequency => "aff",
            Self::VariationalIteration => "vim",
            Self::Averaging => "kbm",
            Self::MultipleScales => "mms",
            _ => return None,
        })
    }

    /// The method of this name or abbreviation, in capital letters or small ones.
    ///
    /// ```
    /// # use lindstedt_oscillator as lindstedt;
    /// use lindstedt::solution::Method;
    /// assert_eq!(Method::from_name("HPM"), Some(Method::HomotopyPerturbation));
    /// assert_eq!(Method::from_name("Pade"), Some(Method::Pade));
    /// ```
    pub fn from_name(name: &str) -> Option<Self> {
        let is = |known: &str| known.eq_ignore_ascii_case(name);
        Self::ALL
            .into_iter()
            .find(|method| is(method.name()) || method.abbreviation().is_some_and(is))
    }
}
