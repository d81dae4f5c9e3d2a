//! Classical oscillators by name, each with its source and the published law, if one is printed.
//!
//! In: a name. Out: a [`CatalogEntry`] with an equation to be parsed, or several, and the list of
//! methods that apply to it.
//!
//! A published law serves only for comparison with a derived one, never as an answer.

use std::fmt;

use crate::method::{Options, solve};
use crate::modes::{self, FreeSystem, ModeOptions};
use crate::multiple_scales::{self, CoupledSystem, MultipleScalesOptions};
use crate::oscillator::Oscillator;
use crate::solution::Method;

// The search for the name most similar to a misspelt one.
pub use crate::spelling::nearest;

/// A classical oscillator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CatalogEntry {
    /// The name on the command line.
    pub name: &'static str,
    /// The name in running text.
    pub title: &'static str,
    /// The equation of motion, or several separated by `;`.
    pub equation: &'static str,
    /// The publication that studies it.
    pub source: &'static str,
    /// The published law, for comparison.
    pub published: Option<Published>,
    /// The sides of rigid walls on which motions are allowed, `x < d`, each with the coefficient of
    /// restitution `e`; empty where there are none.
    pub walls: &'static [&'static str],
}

/// A formula of the frequency over a whole range of amplitudes, as its source prints it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RangeFormula {
    /// The name of the entry.
    pub entry: &'static str,
    /// The period over 2 pi as a formula of the amplitude `A` and, for the pendulum, `c = cos(A/2)`.
    pub period: &'static str,
    /// The publication.
    pub source: &'static str,
}

/// Published formulas of whole ranges, for comparison.
pub const RANGE_FORMULAS: &[RangeFormula] = &[
    RangeFormula { entry: "pendulum", period: "1 + A^2/16", source: "Bernoulli 1749" },
    RangeFormula {
        entry: "pendulum",
        period: "1/sqrt(1 - A^2/8)",
        source: "Jam, Fard 2012, equation (12)",
    },
    RangeFormula { entry: "pendulum", period: "1/(1 - A^2/16)", source: "Denman 1959" },
    RangeFormula {
        entry: "pendulum",
        period: "1/sqrt(sin(sqrt(3)*A/2)/(sqrt(3)*A/2))",
        source: "Ganley 1985, Parwani 2004",
    },
    RangeFormula { entry: "pendulum", period: "(sin(A)/A)^(-3/8)", source: "Molina 1997" },
    RangeFormula { entry: "pendulum", period: "1/sqrt(c)", source: "Kidd, Fogg 2002" },
    RangeFormula { entry: "pendulum", period: "-log(c)/(1 - c)", source: "Lima, Arun 2006" },
    RangeFormula { entry: "pendulum", period: "1/sqrt(2*J1(A)/A)", source: "Belendez 2007" },
    RangeFormula {
        entry: "pendulum",
        period: "4/(1 + sqrt(c))^2",
        source: "Carvalhaes, Suppes 2008; Belendez 2009",
    },
];

/// A law as its source prints it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Published {
    /// `omega` or `omega^2` as a polynomial in the amplitude `A` = x(0) and the parameters.
    pub law: &'static str,
    /// Whether it is omega^2.
    pub squared: bool,
    /// The order in the small parameter to which it is printed.
    pub order: u32,
}

impl CatalogEntry {
    /// Whether it has several equations, separated by `;`.
    pub fn is_coupled(&self) -> bool {
        self.equation.contains(';')
    }

    /// The entry as a problem file, with its walls.
    ///
    /// ```
    /// use lindstedt::{catalog::find, problem::Problem};
    ///
    /// let ball: Problem = find("bouncing-ball").ok_or("no entry")?.problem_file().parse()?;
    /// assert_eq!(ball.walls()?[0].0, "x > Z*sin(w*t)");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn problem_file(&self) -> String {
        let wall = |bound: &&str| format!("\n[[wall]]\nbound = \"{bound}\"\nrestitution = \"e\"\n");
        let walls: String = self.walls.iter().map(wall).collect();
        format!("equation = \"{}\"\n{walls}", self.equation)
    }
}

impl fmt::Display for Published {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = if self.squared { "omega^2" } else { "omega" };
        write!(formatter, "{name} = {} + ...", self.law)
    }
}

const fn omega(law: &'static str, order: u32) -> Option<Published> {
    Some(Published { law, squared: false, order })
}

const fn omega_squared(law: &'static str, order: u32) -> Option<Published> {
    Some(Published { law, squared: true, order })
}

const NAYFEH_MOOK: &str = "A. H. Nayfeh, D. T. Mook, Nonlinear Oscillations, Wiley 1979, chapter 2";
const NAYFEH_MOOK_DAMPED: &str =
    "A. H. Nayfeh, D. T. Mook, Nonlinear Oscillations, Wiley 1979, chapter 3";
const IMPACT_DAMPERS: &str = "Investigating Vibratory Behavior of Nonlinear Single Unit Impact Dampers Using Perturbation Method and Genetic Algorithm";
const MICKENS: &str = "R. E. Mickens, Truly Nonlinear Oscillations, World Scientific 2010";

/// Every oscillator, in the order of the listing.
pub const CATALOG: &[CatalogEntry] = &[
    CatalogEntry {
        name: "pendulum",
        title: "mathematical pendulum",
        equation: "x'' + sin(x) = 0",
        source: "NIST Digital Library of Mathematical Functions, 22.19(i): the expansion of omega = pi/(2 K(sin^2(A/2)))",
        published: omega("1 - A^2/16 + A^4/3072", 4),
        walls: &[],
    },
    CatalogEntry {
        name: "cubic-pendulum",
        title: "pendulum with the sine cut after its cubic term",
        equation: "x'' + x - x^3/6 = 0",
        source: "Investigating Vibratory Behavior of Nonlinear Single Unit Impact Dampers Using Perturbation Method and Genetic Algorithm, equations (11) and (12)",
        published: omega_squared("1 - A^2/8", 2),
        walls: &[],
    },
    CatalogEntry {
        name: "quintic-pendulum",
        title: "pendulum with the sine cut after its quintic term",
        equation: "x'' + x - x^3/6 + x^5/120 = 0",
        source: NAYFEH_MOOK,
        published: omega("1 - A^2/16 + A^4/3072", 4),
        walls: &[],
    },
    CatalogEntry {
        name: "duffing",
        title: "hardening spring of Duffing",
        equation: "x'' + x + eps*x^3 = 0",
        source: NAYFEH_MOOK,
        published: omega("1 + 3*eps*A^2/8 - 21*eps^2*A^4/256", 2),
        walls: &[],
    },
    CatalogEntry {
        name: "duffing-softening",
        title: "softening spring of Duffing",
        equation: "x'' + x - eps*x^3 = 0",
        source: NAYFEH_MOOK,
        published: omega("1 - 3*eps*A^2/8 - 21*eps^2*A^4/256", 2),
        walls: &[],
    },
    CatalogEntry {
        name: "double-well",
        title: "two wells, unstable between them",
        equation: "x'' - x + x^3 = 0",
        source: "J. Guckenheimer, P. Holmes, Nonlinear Oscillations, Dynamical Systems and Bifurcations, Springer 1983, section 2.2",
        published: None,
        walls: &[],
    },
    CatalogEntry {
        name: "pure-cubic",
        title: "spring without a linear part",
        equation: "x'' + x^3 = 0",
        source: MICKENS,
        published: None,
        walls: &[],
    },
    CatalogEntry {
        name: "quintic",
        title: "quintic spring",
        equation: "x'' + x + eps*x^5 = 0",
        source: MICKENS,
        published: omega("1 + 5*eps*A^4/16", 1),
        walls: &[],
    },
    CatalogEntry {
        name: "helmholtz",
        title: "quadratic spring of Helmholtz",
        equation: "x'' + x + eps*x^2 = 0",
        source: NAYFEH_MOOK,
        published: omega("1 - 5*eps^2*A^2/12", 2),
        walls: &[],
    },
    CatalogEntry {
        name: "mixed-parity",
        title: "quadratic and cubic spring",
        equation: "x'' + x + eps*(alpha*x^2 + beta*x^3) = 0",
        source: NAYFEH_MOOK,
        published: omega("1 + 3*beta*eps*A^2/8", 1),
        walls: &[],
    },
    CatalogEntry {
        name: "van-der-pol",
        title: "oscillator of van der Pol",
        equation: "x'' - mu*(1 - x^2)*x' + x = 0",
        source: "C. M. Andersen, J. F. Geer, SIAM J. Appl. Math. 42 (1982) 678-693",
        published: omega("1 - mu^2/16 + 17*mu^4/3072", 4),
        walls: &[],
    },
    CatalogEntry {
        name: "rayleigh",
        title: "oscillator of Rayleigh",
        equation: "x'' - mu*(1 - x'^2/3)*x' + x = 0",
        source: "Lord Rayleigh, Philosophical Magazine 15 (1883) 229-235; its x' solves van der Pol's equation, so the law is that of Andersen and Geer",
        published: omega("1 - mu^2/16 + 17*mu^4/3072", 4),
        walls: &[],
    },
    CatalogEntry {
        name: "duffing-harmonic",
        title: "Duffing-harmonic oscillator",
        equation: "x'' + x^3/(1 + x^2) = 0",
        source: "R. E. Mickens, J. Sound Vib. 244 (2001) 563-567",
        published: None,
        walls: &[],
    },
    CatalogEntry {
        name: "relativistic",
        title: "relativistic harmonic oscillator",
        equation: "x'' + (1 - x'^2)^(3/2)*x = 0",
        source: "R. E. Mickens, J. Sound Vib. 212 (1998) 905-908",
        published: omega_squared("1 - 3*A^2/8", 2),
        walls: &[],
    },
    CatalogEntry {
        name: "mathews-lakshmanan",
        title: "mass that depends on position",
        equation: "(1 + x^2)*x'' - x*x'^2 + x = 0",
        source: "P. M. Mathews, M. Lakshmanan, Quart. Appl. Math. 32 (1974) 215-218: omega^2 = 1/(1 + A^2)",
        published: omega_squared("1 - A^2 + A^4", 4),
        walls: &[],
    },
    CatalogEntry {
        name: "morse",
        title: "molecular bond of Morse",
        equation: "x'' + exp(-x) - exp(-2*x) = 0",
        source: "P. M. Morse, Phys. Rev. 34 (1929) 57-64",
        published: None,
        walls: &[],
    },
    CatalogEntry {
        name: "toda",
        title: "one link of Toda's lattice",
        equation: "x'' + exp(x) - 1 = 0",
        source: "M. Toda, J. Phys. Soc. Japan 22 (1967) 431-436",
        published: None,
        walls: &[],
    },
    CatalogEntry {
        name: "bubble",
        title: "gas bubble, x = (R/R0)^(5/2)",
        equation: "x'' + 5/2*(x^(1/5) - x^(-7/5)) = 0",
        source: "Lord Rayleigh, Phil. Mag. 34 (1917) 94-98, polytropic exponent 4/3; x by N. A. Kudryashov, D. I. Sinelshchikov, J. Phys. A 47 (2014) 405202",
        published: None,
        walls: &[],
    },
    CatalogEntry {
        name: "quadratic-odd",
        title: "odd quadratic spring",
        equation: "x'' + x*abs(x) = 0",
        source: MICKENS,
        published: None,
        walls: &[],
    },
    CatalogEntry {
        name: "signum",
        title: "constant force towards the middle",
        equation: "x'' + sgn(x) = 0",
        source: MICKENS,
        published: None,
        walls: &[],
    },
    CatalogEntry {
        name: "cube-root",
        title: "cube-root spring",
        equation: "x'' + x^(1/3) = 0",
        source: "R. E. Mickens, J. Sound Vib. 246 (2001) 375-378",
        published: None,
        walls: &[],
    },
    CatalogEntry {
        name: "rotating-pendulum",
        title: "pendulum on a rotating support",
        equation: "x'' + sin(x) - lambda*sin(x)*cos(x) = 0",
        source: NAYFEH_MOOK,
        published: None,
        walls: &[],
    },
    CatalogEntry {
        name: "magnetic-wire",
        title: "current-carrying wire beside a fixed one",
        equation: "x'' + x - lambda/(1 - x) = 0",
        source: NAYFEH_MOOK,
        published: None,
        walls: &[],
    },
    CatalogEntry {
        name: "damped-pendulum",
        title: "pendulum with viscous damping",
        equation: "x'' + 2*zeta*x' + sin(x) = 0",
        source: "Investigating Vibratory Behavior of Nonlinear Single Unit Impact Dampers Using Perturbation Method and Genetic Algorithm, equation (7) without friction, excitation and barrier",
        published: None,
        walls: &[],
    },
    CatalogEntry {
        name: "forced-duffing",
        title: "hardening spring of Duffing, damped and driven",
        equation: "x'' + 2*zeta*x' + x + eps*x^3 = F*cos(Omega*t)",
        source: "A. H. Nayfeh, D. T. Mook, Nonlinear Oscillations, Wiley 1979, section 4.1",
        published: None,
        walls: &[],
    },
    CatalogEntry {
        name: "forced-helmholtz",
        title: "quadratic spring of Helmholtz, damped and driven",
        equation: "x'' + 2*zeta*x' + x + eps*x^2 = F*cos(Omega*t)",
        source: "A. H. Nayfeh, D. T. Mook, Nonlinear Oscillations, Wiley 1979, section 4.2",
        published: None,
        walls: &[],
    },
    CatalogEntry {
        name: "mathieu-duffing",
        title: "spring of Duffing whose stiffness is driven",
        equation: "x'' + 2*zeta*x' + (1 + h*cos(Omega*t))*x + eps*x^3 = 0",
        source: "A. H. Nayfeh, D. T. Mook, Nonlinear Oscillations, Wiley 1979, section 5.7",
        published: None,
        walls: &[],
    },
    CatalogEntry {
        name: "dry-friction",
        title: "spring with the dry friction of Coulomb",
        equation: "x'' + alpha*sgn(x') + x = 0",
        source: NAYFEH_MOOK_DAMPED,
        published: None,
        walls: &[],
    },
    CatalogEntry {
        name: "quadratic-damping",
        title: "spring in a fluid that resists by the square of the speed",
        equation: "x'' + c*abs(x')*x' + x = 0",
        source: NAYFEH_MOOK_DAMPED,
        published: None,
        walls: &[],
    },
    CatalogEntry {
        name: "damped-duffing",
        title: "hardening spring with viscous damping",
        equation: "x'' + 2*zeta*x' + x + eps*x^3 = 0",
        source: NAYFEH_MOOK_DAMPED,
        published: None,
        walls: &[],
    },
    CatalogEntry {
        name: "similar-pair",
        title: "two masses on cubic springs, coupled by another",
        equation: "x'' + x + x^3 + K*(x - y)^3 = 0; y'' + y + y^3 + K*(y - x)^3 = 0",
        source: "A. F. Vakakis, R. H. Rand, Int. J. Non-Linear Mech. 27 (1992) 861-874: similar modes, of which two more branch off at K = 1/4",
        published: None,
        walls: &[],
    },
    CatalogEntry {
        name: "modal-pair",
        title: "two masses, one of them on a cubic spring",
        equation: "x'' + 2*x - y + x^3/2 = 0; y'' + 2*y - x = 0",
        source: "G. Kerschen, M. Peeters, J. C. Golinval, A. F. Vakakis, Mech. Syst. Signal Process. 23 (2009) 170-194",
        published: None,
        walls: &[],
    },
    CatalogEntry {
        name: "coupled-duffing",
        title: "two springs of Duffing with a linear coupling",
        equation: "x'' + x + eps*x^3 + k*(x - y) = 0; y'' + y + eps*y^3 + k*(y - x) = 0",
        source: "R. M. Rosenberg, Adv. Appl. Mech. 9 (1966) 155-242",
        published: None,
        walls: &[],
    },
    CatalogEntry {
        name: "coupled-pendulums",
        title: "two pendulums with a spring between them",
        equation: "x'' + sin(x) + k*(x - y) = 0; y'' + sin(y) + k*(y - x) = 0",
        source: "A. Sommerfeld, Mechanics, Academic Press 1952: sympathetic pendulums",
        published: None,
        walls: &[],
    },
    CatalogEntry {
        name: "double-pendulum",
        title: "two equal pendulums, one below the other",
        equation: "2*x'' + y''*cos(x - y) + y'^2*sin(x - y) + 2*sin(x) = 0; y'' + x''*cos(x - y) - x'^2*sin(x - y) + sin(y) = 0",
        source: "L. D. Landau, E. M. Lifshitz, Mechanics, Pergamon 1960, section 5",
        published: None,
        walls: &[],
    },
    CatalogEntry {
        name: "elastic-pendulum",
        title: "mass that swings on a spring",
        equation: "r'' - (1 + r)*b'^2 + W^2*r + 1 - cos(b) = 0; (1 + r)*b'' + 2*r'*b' + sin(b) = 0",
        source: "A. Vitt, G. Gorelik, J. Tech. Phys. USSR 3 (1933) 294-307: energy goes to and fro at W = 2",
        published: None,
        walls: &[],
    },
    CatalogEntry {
        name: "cart-pendulum",
        title: "pendulum on a cart held by a spring",
        equation: "(1 + m)*x'' + m*b''*cos(b) - m*b'^2*sin(b) + k*x = 0; b'' + x''*cos(b) + sin(b) = 0",
        source: "L. Meirovitch, Methods of Analytical Dynamics, McGraw-Hill 1970",
        published: None,
        walls: &[],
    },
    CatalogEntry {
        name: "henon-heiles",
        title: "star in an axisymmetric galaxy",
        equation: "x'' + x + 2*x*y = 0; y'' + y + x^2 - y^2 = 0",
        source: "M. Henon, C. Heiles, Astron. J. 69 (1964) 73-79",
        published: None,
        walls: &[],
    },
    CatalogEntry {
        name: "toda-pair",
        title: "two masses of Toda's lattice between walls",
        equation: "x'' - exp(-x) + exp(x - y) = 0; y'' - exp(x - y) + exp(y) = 0",
        source: "M. Toda, J. Phys. Soc. Japan 22 (1967) 431-436",
        published: None,
        walls: &[],
    },
    CatalogEntry {
        name: "fermi-pasta-ulam",
        title: "three masses of the chain of Fermi, Pasta and Ulam",
        equation: "x'' + 2*x - y - alpha*((y - x)^2 - x^2) = 0; y'' + 2*y - x - z - alpha*((z - y)^2 - (y - x)^2) = 0; z'' + 2*z - y - alpha*(z^2 - (z - y)^2) = 0",
        source: "E. Fermi, J. Pasta, S. Ulam, Los Alamos report LA-1940 (1955)",
        published: None,
        walls: &[],
    },
    CatalogEntry {
        name: "quadratic-pair",
        title: "two modes at 1:2 that exchange their energy",
        equation: "x'' + x - alpha1*x*y = 0; y'' + 4*y - alpha2*x^2 = 0",
        source: "A. H. Nayfeh, D. T. Mook, Nonlinear Oscillations, Wiley 1979, section 6.2",
        published: None,
        walls: &[],
    },
    CatalogEntry {
        name: "saturation",
        title: "two modes at 1:2, damped, the faster one driven",
        equation: "x'' + 2*mu1*x' + x - alpha1*x*y = 0; y'' + 2*mu2*y' + 4*y - alpha2*x^2 = F*cos(2*t)",
        source: "A. H. Nayfeh, D. T. Mook, Nonlinear Oscillations, Wiley 1979, section 6.5",
        published: None,
        walls: &[],
    },
    CatalogEntry {
        name: "coupled-van-der-pol",
        title: "two oscillators of van der Pol that lock or die",
        equation: "x'' - eps*(1 - x^2)*x' + x - eps*kappa*(y' - x') = 0; y'' - eps*(1 - y^2)*y' + (1 + eps*delta)*y - eps*kappa*(x' - y') = 0",
        source: "D. G. Aronson, G. B. Ermentrout, N. Kopell, Physica D 41 (1990) 403-449",
        published: None,
        walls: &[],
    },
    CatalogEntry {
        name: "bouncing-ball",
        title: "ball on a shaking table",
        equation: "x'' + g = 0",
        source: "P. J. Holmes, J. Sound Vib. 84 (1982) 173-189",
        published: None,
        walls: &["x > Z*sin(w*t)"],
    },
    CatalogEntry {
        name: "impact-oscillator",
        title: "driven oscillator beside a rigid stop",
        equation: "x'' + 2*zeta*x' + x = F*cos(w*t)",
        source: "S. W. Shaw, P. J. Holmes, J. Sound Vib. 90 (1983) 129-155",
        published: None,
        walls: &["x < d"],
    },
    CatalogEntry {
        name: "impact-damper",
        title: "pendulum that hits a rigid barrier",
        equation: "x'' + 2*zeta*x' + sin(x) = 0",
        source: IMPACT_DAMPERS,
        published: None,
        walls: &["x < d"],
    },
    CatalogEntry {
        name: "newtons-cradle",
        title: "three balls on strings",
        equation: "p'' + p = 0; q'' + q = 0; r'' + r = 0",
        source: "F. Herrmann, P. Schmaelzle, Am. J. Phys. 49 (1981) 761-764",
        published: None,
        walls: &["p < q", "q < r"],
    },
    CatalogEntry {
        name: "rattling-gear",
        title: "loose gear wheel between the flanks of another",
        equation: "z'' + beta*z' = A*cos(w*t)",
        source: "F. Pfeiffer, C. Glocker, Multibody Dynamics with Unilateral Contacts, Wiley 1996, section 9.1",
        published: None,
        walls: &["-b < z < b"],
    },
];

/// The entry of this name, regardless of case; `None` if there is none.
///
/// ```
/// let pendulum = lindstedt::catalog::find("pendulum").expect("an entry");
/// assert_eq!(pendulum.equation, "x'' + sin(x) = 0");
/// ```
pub fn find(name: &str) -> Option<&'static CatalogEntry> {
    CATALOG.iter().find(|entry| entry.name.eq_ignore_ascii_case(name))
}

/// Every method at its default order on an entry: `Ok` where it applies, the reason in words where it
/// does not. Coupled equations have the methods that are for them.
///
/// ```
/// use lindstedt::catalog::{find, methods};
///
/// let van_der_pol = find("van-der-pol").expect("an entry");
/// let answers = methods(van_der_pol);
/// assert!(answers.iter().any(|(_, answer)| answer.is_ok()) && answers.iter().any(|(_, answer)| answer.is_err()));
/// ```
pub fn methods(entry: &CatalogEntry) -> Vec<(Method, Result<(), String>)> {
    if !entry.walls.is_empty() {
        let reason = "no law across impacts on rigid walls: simulate, response and orbits take it";
        return Method::ALL.map(|method| (method, Err(reason.to_owned()))).to_vec();
    }
    if entry.is_coupled() {
        let methods = [
            Method::LindstedtPoincare,
            Method::Pade,
            Method::HarmonicBalance,
            Method::Averaging,
            Method::MultipleScales,
        ];
        return methods.map(|method| (method, of_coupled(entry.equation, method))).to_vec();
    }
    let attempt = |method: Method| {
        let options = Options { method: Some(method), ..Options::default() };
        let oscillator = Oscillator::parse(entry.equation).map_err(|error| error.to_string())?;
        solve(&oscillator, &options).map(|_| ()).map_err(|refusal| refusal.without_title(method))
    };
    Method::ALL.into_iter().map(|method| (method, attempt(method))).collect()
}

/// A method of coupled equations on these.
fn of_coupled(equations: &str, method: Method) -> Result<(), String> {
    let in_words = |error: &dyn fmt::Display| error.to_string();
    if [Method::MultipleScales, Method::Averaging].contains(&method) {
        let system = CoupledSystem::parse(equations).map_err(|error| in_words(&error))?;
        let averaging = method == Method::Averaging;
        let options = MultipleScalesOptions { averaging, ..MultipleScalesOptions::default() };
        let slow = multiple_scales::derive(&system, &options);
        return slow.map(|_| ()).map_err(|error| in_words(&error));
    }
    let system = FreeSystem::parse(equations).map_err(|error| in_words(&error))?;
    let pade = (method == Method::Pade).then_some((1, 1));
    let of_modes = ModeOptions { pade, ..ModeOptions::default() };
    let found = match method {
        Method::HarmonicBalance => modes::one_harmonic_modes(&system).map(|_| ()),
        _ => modes::derive(&system, &of_modes).and_then(|found| {
            // One mode with a formula is an answer.
            found
                .modes
                .into_iter()
                .reduce(|one, other| if one.is_err() && other.is_ok() { other } else { one })
                .map_or(Ok(()), |mode| mode.map(|_| ()))
        }),
    };
    found.map_err(|error| in_words(&error))
}
