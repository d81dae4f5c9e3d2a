//! The tuned mass damper on a main mass without damping: equal peaks, the lowest peak, the lowest
//! variance.
//!
//! ```text
//! X(s) = B(s)/A(s),  s = i g,  w = g^2,  p = f^2,  z = 4 zeta^2 f^2:     |X|^2 = (b_e^2 + z w b_o^2)/(a_e^2 + z w a_o^2)
//! ```
//!
//! - Fixed points, through which the curve of every damping goes: `b_e a_o + b_o a_e = 0`, of second
//!   degree in w. They are equally high where `a_o` has opposite signs at them (J. Ormondroyd, J. P.
//!   Den Hartog, *Trans. ASME* 50 (1928)); the damping is the root mean square of those at which the
//!   curve is level at either of them (J. E. Brock, *J. Appl. Mech.* 13 (1946) A284).
//! - The lowest peak (O. Nishihara, T. Asami, *J. Vib. Acoust.* 124 (2002) 576): two peaks have the same
//!   height h, so that `|A|^2 - |B|^2/h^2 = (w^2 + a w + b)^2`. With `rho^2 = 1 - 1/h^2` the
//!   coefficients give a, b and z, and one relation between p and rho is left. In `q = p (1 + mu)^2/rho` it is linear
//!   in rho, so that rho is a quotient of polynomials in q, and least where its slope vanishes.
//! - The lowest variance (S. H. Crandall, W. D. Mark, *Random Vibration in Mechanical Systems*, 1963;
//!   T. Asami, O. Nishihara, A. M. Baz, *J. Vib. Acoust.* 124 (2002) 284): `B(s) B(-s)/(A(s) A(-s)) = C(s)/A(s) + C(-s)/A(-s)`, and the
//!   integral of the left side over the imaginary axis is `2 pi i c_3/a_4`.

use std::ops::Bound;

use num_traits::{One, Zero};

use super::{
    AbsorberDesign, AbsorberError, AbsorberFormula, AbsorberKind, AbsorberLaws, AbsorberLetter,
    AbsorberRelation, Excitation,
};
use crate::coupled::CoupledEquations;
use crate::exact::polynomial::Monomial;
use crate::exact::rational::ratio;
use crate::exact::{Polynomial, QuadraticSurd, Rational, RationalFunction};
use crate::expr::Expr;
use crate::modes::by_powers;
use crate::symbol::Symbol;

/// The letter of the designs.
pub(super) const MASS_RATIO: AbsorberLetter = AbsorberLetter {
    name: "mu",
    meaning: "the mass ratio",
    range: (Bound::Excluded(0.0), Bound::Unbounded),
    example: "1/20",
};

/// The letter of the designs on shaken ground: the tuning is real below 2.
pub(super) const MASS_RATIO_BELOW_TWO: AbsorberLetter = AbsorberLetter {
    meaning: "the mass ratio on shaken ground",
    range: (Bound::Excluded(0.0), Bound::Excluded(2.0)),
    ..MASS_RATIO
};

/// Polynomials in one unknown, lowest power first, over the rational functions of mu.
type InUnknown = Vec<RationalFunction>;

/// The symbols of the derivation.
pub(super) struct AbsorberNames {
    pub(super) mu: Symbol,
    pub(super) f: Symbol,
    pub(super) zeta: Symbol,
    pub(super) g: Symbol,
    /// s of the transfer function.
    s: Symbol,
    /// w = g^2.
    pub(super) w: Symbol,
    /// p = f^2.
    pub(super) p: Symbol,
    /// z = 4 zeta^2 f^2.
    pub(super) z: Symbol,
    rho: Symbol,
    q: Symbol,
    /// m = 1 + mu.
    m: Symbol,
}

impl AbsorberNames {
    pub(super) fn new() -> Self {
        let of = Symbol::new;
        Self {
            mu: of("mu"),
            f: of("f"),
            zeta: of("zeta"),
            g: of("g"),
            s: of("s"),
            w: of("w"),
            p: of("p"),
            z: of("z"),
            rho: of("rho"),
            q: of("q"),
            m: of("m"),
        }
    }
}

/// The right sides of both equations.
pub(super) fn right_sides(excitation: Excitation) -> [&'static str; 2] {
    match excitation {
        Excitation::Force => ["cos(g*t)", "0"],
        Excitation::Ground => ["-cos(g*t)", "-cos(g*t)"],
    }
}

/// The meanings of the letters.
pub(super) fn meanings(
    names: &AbsorberNames,
    excitation: Excitation,
) -> Vec<(Symbol, &'static str)> {
    vec![
        (names.mu, "mass of the absorber over the main mass"),
        (names.f, "natural frequency of the absorber alone over that of the main mass alone"),
        (names.zeta, "damping ratio of the absorber alone"),
        (
            names.g,
            match excitation {
                Excitation::Force => "frequency of the force over that of the main mass alone",
                Excitation::Ground => "frequency of the ground over that of the main mass alone",
            },
        ),
        (Symbol::new("X"), "amplitude of x"),
        (Symbol::new("h"), "amplitude of x over the static one, where it is largest"),
        (Symbol::new("V"), "variance of x, the right side white noise of intensity 1"),
    ]
}

/// Derives the designs.
pub(super) fn derive(excitation: Excitation) -> Result<AbsorberLaws, AbsorberError> {
    let names = AbsorberNames::new();
    let right = right_sides(excitation);
    let equations = CoupledEquations::parse(&format!(
        "x'' + x + mu*(2*zeta*f*(x' - y') + f^2*(x - y)) = {}; y'' + 2*zeta*f*(y' - x') + f^2*(y - x) = {}",
        right[0], right[1]
    ))?;
    let transfer = transfer(&equations, &names)?;
    let response = Response::new(&transfer, &names)?;
    let (points, equal_peaks) = equal_peaks(&response, &names)?;
    let lowest_peak = lowest_peak(&response, &names)?;
    let lowest_variance = lowest_variance(&transfer, &names)?;
    let x = Expr::symbol("X");
    let relations = vec![
        AbsorberRelation {
            left: &x * &x,
            right: response.written(&names)?,
            words: "the squared amplitude of x",
        },
        AbsorberRelation {
            left: Expr::zero(),
            right: names.written(&points)?,
            words: "the fixed points, through which the curve of every damping goes",
        },
    ];
    Ok(AbsorberLaws {
        kind: AbsorberKind::Tuned(excitation),
        equations: equations.equations,
        meanings: meanings(&names, excitation),
        definitions: vec![],
        relations,
        designs: [Some(equal_peaks), lowest_peak, Some(lowest_variance)]
            .into_iter()
            .flatten()
            .collect(),
        validity: match excitation {
            Excitation::Force => {
                "linear, a force on a main mass without damping, time in units of 1/(its frequency alone)"
            }
            Excitation::Ground => {
                "linear, the ground accelerates a main mass without damping, x relative to the ground, time in units of 1/(its frequency alone); the lowest peak is the root of a polynomial of fourth degree and has no short closed form"
            }
        },
    })
}

impl AbsorberNames {
    /// A polynomial with g, f and zeta in the place of w, p and z.
    fn written(&self, polynomial: &Polynomial) -> Result<Expr, crate::expr::ExprError> {
        let square = |name: Symbol| Expr::from(name) * Expr::from(name);
        let damping = Expr::from(4) * square(self.zeta) * square(self.f);
        let values = [(self.w, square(self.g)), (self.p, square(self.f)), (self.z, damping)];
        Expr::from(polynomial).substitute_all(&values.into_iter().collect())
    }
}

fn no_closed_form<T>(what: &'static str) -> Result<T, AbsorberError> {
    Err(AbsorberError::NoClosedForm(what))
}

pub(super) fn minus(polynomial: &Polynomial) -> Polynomial {
    let mut negative = polynomial.clone();
    negative.negate();
    negative
}

fn constant(value: i64) -> Polynomial {
    Polynomial::constant(ratio(value, 1))
}

fn power(name: Symbol, exponent: i32) -> Polynomial {
    Polynomial::term(Monomial::power_of(name, exponent), Rational::one())
}

/// Numerator and denominator of the transfer function of x, polynomials in s.
pub(super) fn transfer(
    equations: &CoupledEquations,
    names: &AbsorberNames,
) -> Result<[Polynomial; 2], AbsorberError> {
    let polynomial = |expr: &Expr| -> Result<Polynomial, AbsorberError> {
        match expr.to_polynomial(&mut |_| None)? {
            Some(polynomial) => Ok(polynomial),
            None => no_closed_form("the transfer function"),
        }
    };
    let mut rows = Vec::new();
    for (left, right) in &equations.equations {
        let mut row = Vec::new();
        for coordinate in &equations.coordinates {
            let mut stiffness = Polynomial::zero();
            let mut name = *coordinate;
            for derivatives in 0..3 {
                let slope = polynomial(&left.differentiate(name)?)?;
                stiffness.accumulate(&slope.product(&power(names.s, derivatives)));
                name = name.derivative();
            }
            row.push(stiffness);
        }
        // The wave cos(g t) is 1 at t = 0.
        row.push(polynomial(&right.substitute(Symbol::new("t"), &Expr::zero())?)?);
        rows.push(row);
    }
    let [first, second] = rows.as_slice() else { return no_closed_form("the transfer function") };
    let minor = |i: usize, k: usize| {
        let mut minor = first[i].product(&second[k]);
        minor.accumulate(&minus(&first[k].product(&second[i])));
        minor
    };
    Ok([minor(2, 1), minor(0, 1)])
}

/// The parts of the frequency response, `|X|^2 = (b_e^2 + z w b_o^2)/(a_e^2 + z w a_o^2)`, in w, p and mu.
pub(super) struct Response {
    /// b_e, b_o.
    pub(super) numerator: [Polynomial; 2],
    /// a_e, a_o.
    pub(super) denominator: [Polynomial; 2],
}

impl Response {
    pub(super) fn new(
        transfer: &[Polynomial; 2],
        names: &AbsorberNames,
    ) -> Result<Self, AbsorberError> {
        let parts = |polynomial: &Polynomial| -> Result<[Polynomial; 2], AbsorberError> {
            let mut parts = [Polynomial::zero(), Polynomial::zero()];
            for (exponent, coefficient) in by_powers(polynomial, names.s).iter().enumerate() {
                let half = i32::try_from(exponent / 2).unwrap_or(i32::MAX);
                let sign = if half % 2 == 0 { 1 } else { -1 };
                let wave = coefficient.product(&power(names.w, half)).product(&constant(sign));
                // Odd powers of s have the factor 2 zeta f.
                let wave = match exponent % 2 {
                    0 => wave,
                    _ => wave
                        .times_monomial(&Monomial::power_of(names.zeta, -1))
                        .times_monomial(&Monomial::power_of(names.f, -1))
                        .map(|number| number / ratio(2, 1)),
                };
                parts[exponent % 2].accumulate(&halved(&wave, &[(names.f, names.p)])?);
            }
            Ok(parts)
        };
        Ok(Self { numerator: parts(&transfer[0])?, denominator: parts(&transfer[1])? })
    }

    /// |X|^2 in the letters of the equations.
    fn written(&self, names: &AbsorberNames) -> Result<Expr, AbsorberError> {
        let square = |[even, odd]: &[Polynomial; 2]| -> Result<Expr, AbsorberError> {
            let damping = names.written(&power(names.z, 1).product(&power(names.w, 1)))?;
            let [even, odd] =
                [names.written(even)?.integer_power(2)?, names.written(odd)?.integer_power(2)?];
            Ok(even + damping * odd)
        };
        Ok(Expr::divide(&square(&self.numerator)?, &square(&self.denominator)?)?)
    }

    /// Squared numerator and denominator.
    fn squares(&self, names: &AbsorberNames) -> [Polynomial; 2] {
        [&self.numerator, &self.denominator].map(|[even, odd]| {
            let mut sum = odd.product(odd).product(&power(names.z, 1)).product(&power(names.w, 1));
            sum.accumulate(&even.product(even));
            sum
        })
    }
}

/// The polynomial in the squares of letters.
pub(super) fn halved(
    polynomial: &Polynomial,
    letters: &[(Symbol, Symbol)],
) -> Result<Polynomial, AbsorberError> {
    let mut sum = Polynomial::zero();
    for (monomial, number) in polynomial.terms() {
        let mut changed = monomial.clone();
        for (letter, square) in letters {
            let exponent = monomial.exponent(*letter);
            if exponent % 2 != 0 {
                return no_closed_form("the frequency response");
            }
            changed = changed.without(*letter).product(&Monomial::power_of(*square, exponent / 2));
        }
        sum.add_term(changed, number.clone());
    }
    Ok(sum)
}

/// A polynomial divided by the highest power of each letter that all its terms have.
fn without_powers(polynomial: &Polynomial, letters: &[Symbol]) -> Polynomial {
    letters.iter().fold(polynomial.clone(), |reduced, letter| {
        match reduced.exponent_range(*letter) {
            Some((lowest, _)) => reduced.times_monomial(&Monomial::power_of(*letter, -lowest)),
            None => reduced,
        }
    })
}

/// The coefficients of a polynomial in one unknown.
fn in_unknown(polynomial: &Polynomial, unknown: Symbol, mu: Symbol) -> Option<InUnknown> {
    let rows = by_powers(polynomial, unknown);
    rows.iter().map(|row| RationalFunction::from_polynomial(row, mu)).collect()
}

/// The value of a polynomial in mu and letters that have these values.
pub(super) fn value(
    polynomial: &Polynomial,
    values: &[(Symbol, &QuadraticSurd)],
    names: &AbsorberNames,
) -> Option<QuadraticSurd> {
    let (_, first) = values.first()?;
    let one = first.constant(RationalFunction::number(Rational::one()));
    let mut sum = first.constant(RationalFunction::number(Rational::zero()));
    for (monomial, number) in polynomial.terms() {
        let mut rest = monomial.clone();
        let mut product = one.clone();
        for (letter, value) in values {
            let exponent = monomial.exponent(*letter);
            rest = rest.without(*letter);
            for _ in 0..exponent.abs() {
                product = match exponent > 0 {
                    true => product.product(value),
                    false => product.quotient(value)?,
                };
            }
        }
        let coefficient = Polynomial::term(rest, number.clone());
        let coefficient = RationalFunction::from_polynomial(&coefficient, names.mu)?;
        sum = sum.sum(&product.product(&one.constant(coefficient)));
    }
    Some(sum)
}

/// A number without a root.
fn rational(value: RationalFunction) -> QuadraticSurd {
    let one = RationalFunction::number(Rational::one());
    let zero = RationalFunction::number(Rational::zero());
    QuadraticSurd { rational: value, coefficient: zero, radicand: one }
}

fn formula(name: &'static str, symbol: &str, formula: Expr) -> AbsorberFormula {
    AbsorberFormula { name, symbol: Symbol::new(symbol), formula }
}

/// The polynomial whose roots are the fixed points, and the design with equal heights there.
fn equal_peaks(
    response: &Response,
    names: &AbsorberNames,
) -> Result<(Polynomial, AbsorberDesign), AbsorberError> {
    const WHAT: &str = "the design with equal fixed points";
    let none = || AbsorberError::NoClosedForm(WHAT);
    let ([be, bo], [ae, ao]) = (&response.numerator, &response.denominator);
    let mut points = be.product(ao);
    points.accumulate(&bo.product(ae));
    let points = without_powers(&points, &[names.w]);
    let ([c0, c1, c2], [l0, l1]) = (&by_powers(&points, names.w)[..], &by_powers(ao, names.w)[..])
    else {
        return no_closed_form(WHAT);
    };
    if by_powers(bo, names.w).len() != 1 {
        return no_closed_form(WHAT);
    }
    // The sum of the roots is twice the root of a_o: -c1/c2 = -2 l0/l1.
    let mut condition = c1.product(l1);
    condition.accumulate(&c2.product(l0).product(&constant(-2)));
    let condition = in_unknown(&condition, names.p, names.mu).ok_or_else(none)?;
    let [free, slope] = condition.as_slice() else { return no_closed_form(WHAT) };
    let p = rational(free.negative().quotient(slope).ok_or_else(none)?);
    let at = |polynomial: &Polynomial| {
        value(polynomial, &[(names.p, &p)], names).map(|value| value.rational).ok_or_else(none)
    };
    let over =
        |above: &RationalFunction, below: &RationalFunction| above.quotient(below).ok_or_else(none);
    let mid = over(&at(l0)?.negative(), &at(l1)?)?;
    let distance = mid.product(&mid).difference(&over(&at(c0)?, &at(c2)?)?);
    // The height where a_o = l1 (w - mid), over that at w = 0.
    let swing = over(&at(bo)?, &at(l1)?)?;
    let height = over(&swing.product(&swing), &distance)?;
    let at_rest = |polynomial: &Polynomial| at(&by_powers(polynomial, names.w)[0]);
    let still = over(&at_rest(be)?, &at_rest(ae)?)?;
    let relative = over(&height, &still.product(&still))?;
    // The damping that makes the curve level at a fixed point: N' = h^2 D'.
    let one = RationalFunction::number(Rational::one());
    let point = QuadraticSurd::new(mid, &one, &distance);
    let p_there = point.constant(p.rational.clone());
    let height_there = point.constant(height.negative());
    let level = |above: &Polynomial, below: &Polynomial| -> Result<QuadraticSurd, AbsorberError> {
        let values = [(names.w, &point), (names.p, &p_there)];
        let [above, below] = [above, below].map(|part| value(&part.slope(names.w), &values, names));
        Ok(above.ok_or_else(none)?.sum(&below.ok_or_else(none)?.product(&height_there)))
    };
    let w = power(names.w, 1);
    let even = level(&be.product(be), &ae.product(ae))?;
    let odd = level(&bo.product(bo).product(&w), &ao.product(ao).product(&w))?;
    let z = even.quotient(&odd).ok_or_else(none)?;
    let squares = z.rational.negative();
    let damping = over(&squares, &p.rational)?.scaled(&ratio(1, 4));
    let written = |value: &RationalFunction| value.sqrt_expr(names.mu);
    Ok((
        points,
        AbsorberDesign {
            name: "equal-peaks",
            words: "the two fixed points equally high, the curve level near both",
            formulas: vec![
                formula("tuning", "f", written(&p.rational)?),
                formula("damping", "zeta", written(&damping)?),
                formula("height", "h", written(&relative)?),
                formula("lower_frequency", "g1", point.conjugate().sqrt_expr(names.mu)?),
                formula("upper_frequency", "g2", point.sqrt_expr(names.mu)?),
            ],
            refined_by: None,
        },
    ))
}

/// The numbers of the lowest peak.
pub(super) struct LowestPeak {
    pub(super) p: QuadraticSurd,
    pub(super) z: QuadraticSurd,
    /// zeta^2.
    pub(super) damping: QuadraticSurd,
    /// h^2.
    pub(super) height: QuadraticSurd,
    /// a and b of w^2 + a w + b, whose roots are the peaks.
    pub(super) peaks: [QuadraticSurd; 2],
}

/// The design with the lowest peak; `None` if the relation of p and rho is not linear in rho.
fn lowest_peak(
    response: &Response,
    names: &AbsorberNames,
) -> Result<Option<AbsorberDesign>, AbsorberError> {
    let Some(lowest) = numbers_of_the_lowest_peak(response, names)? else { return Ok(None) };
    let written = |value: &QuadraticSurd| value.sqrt_expr(names.mu);
    Ok(Some(AbsorberDesign {
        name: "lowest-peak",
        words: "the highest amplitude at any frequency is the least (H-infinity)",
        formulas: vec![
            formula("tuning", "f", written(&lowest.p)?),
            formula("damping", "zeta", written(&lowest.damping)?),
            formula("height", "h", written(&lowest.height)?),
        ],
        refined_by: None,
    }))
}

pub(super) fn numbers_of_the_lowest_peak(
    response: &Response,
    names: &AbsorberNames,
) -> Result<Option<LowestPeak>, AbsorberError> {
    const WHAT: &str = "the design with the lowest peak";
    let none = || AbsorberError::NoClosedForm(WHAT);
    let [numerator, denominator] = response.squares(names);
    // |A|^2 - (1 - rho^2) |B|^2
    let mut square = denominator;
    let mut factor = power(names.rho, 2);
    factor.accumulate(&constant(-1));
    square.accumulate(&numerator.product(&factor));
    let rows = by_powers(&square, names.w);
    let [t0, t1, t2, t3, t4] = &rows[..] else { return Ok(None) };
    if *t4 != constant(1) {
        return Ok(None);
    }
    // (w^2 + a w + b)^2
    let a = t3.map(|number| number / ratio(2, 1));
    let Some(b) = t0.single_term_root() else { return Ok(None) };
    let mut first = t1.clone();
    first.accumulate(&a.product(&b).product(&constant(-2)));
    let mut second = t2.clone();
    second.accumulate(&minus(&a.product(&a)));
    second.accumulate(&b.product(&constant(-2)));
    let (first, second) = (by_powers(&first, names.z), by_powers(&second, names.z));
    let ([free, slope], [e0, e1, e2]) = (&first[..], &second[..]) else { return Ok(None) };
    // z = -free/slope in the other relation.
    let mut relation = e0.product(slope).product(slope);
    relation.accumulate(&minus(&e1.product(free).product(slope)));
    relation.accumulate(&e2.product(free).product(free));
    let Some(curve) = scaled_relation(&relation, names) else { return Ok(None) };
    let [constant_part, linear_part] = &curve;
    // rho = -constant/linear in q is least where its slope vanishes and neither does.
    let (above, below) = (negated(constant_part), linear_part.clone());
    let mut level =
        subtracted(&multiplied(&slopes(&above), &below), &multiplied(&above, &slopes(&below)));
    for part in [&above, &below] {
        loop {
            let shared = common_divisor(&level, part);
            if shared.len() < 2 {
                break;
            }
            level = divided(&level, &shared).0;
        }
    }
    let [c0, c1, c2] = level.as_slice() else { return Ok(None) };
    let half = c1.quotient(&c2.scaled(&ratio(-2, 1))).ok_or_else(none)?;
    let radicand = half.product(&half).difference(&c0.quotient(c2).ok_or_else(none)?);
    let one = RationalFunction::number(Rational::one());
    let root = QuadraticSurd::new(half, &one, &radicand);
    for q in [root.clone(), root.conjugate()] {
        let rho = q.value_of(&above).quotient(&q.value_of(&below)).ok_or_else(none)?;
        let p = value(
            &Polynomial::term(
                Monomial::power_of(names.q, 1).product(&Monomial::power_of(names.rho, 1)),
                Rational::one(),
            ),
            &[(names.q, &q), (names.rho, &rho)],
            names,
        )
        .ok_or_else(none)?;
        let scale = Polynomial::symbol(names.mu) + constant(1);
        let scale =
            RationalFunction::from_polynomial(&scale.product(&scale), names.mu).ok_or_else(none)?;
        let p = p.quotient(&q.constant(scale)).ok_or_else(none)?;
        let numbers = [(names.p, &p), (names.rho, &rho)];
        let [free, slope] = [free, slope].map(|part| value(part, &numbers, names).ok_or_else(none));
        let z = minus_quotient(&free?, &slope?).ok_or_else(none)?;
        let quarter = p.constant(RationalFunction::number(ratio(1, 4)));
        let damping = z.quotient(&p).ok_or_else(none)?.product(&quarter);
        let unit = p.constant(one.clone());
        let minus_one = p.constant(one.negative());
        let rest = unit.sum(&rho.product(&rho).product(&minus_one));
        let height = unit.quotient(&rest).ok_or_else(none)?;
        // A peak is higher than the static deflection, and damping and stiffness are positive.
        let is_positive = |value: &QuadraticSurd| {
            let at = [(names.mu, 0.5)].into();
            let number = value.to_expr(names.mu).ok().and_then(|value| value.evaluate(&at).ok());
            number.is_some_and(|number| number > 0.0)
        };
        if [&p, &damping, &rest].into_iter().all(is_positive) {
            let numbers = [(names.p, &p), (names.rho, &rho), (names.z, &z)];
            let peaks = [value(&a, &numbers, names), value(&b, &numbers, names)];
            let [Some(a), Some(b)] = peaks else { return Err(none()) };
            return Ok(Some(LowestPeak { peaks: [a, b], p, z, damping, height }));
        }
    }
    Ok(None)
}

fn minus_quotient(above: &QuadraticSurd, below: &QuadraticSurd) -> Option<QuadraticSurd> {
    let minus = above.constant(RationalFunction::number(-Rational::one()));
    above.product(&minus).quotient(below)
}

/// The relation of p and rho in `q = p (1 + mu)^2/rho`, its two coefficients by powers of rho as
/// polynomials in q; `None` if it is not linear in rho.
fn scaled_relation(relation: &Polynomial, names: &AbsorberNames) -> Option<[InUnknown; 2]> {
    let mass = power(names.m, 1) + constant(-1);
    let scaled = Monomial::power_of(names.q, 1)
        .product(&Monomial::power_of(names.rho, 1))
        .product(&Monomial::power_of(names.m, -2));
    let scaled = Polynomial::term(scaled, Rational::one());
    let relation = relation.substitute(names.mu, &mass)?.substitute(names.p, &scaled)?;
    let relation = without_powers(&relation, &[names.rho, names.m, names.q]);
    let ratio_of_masses = Polynomial::symbol(names.mu) + constant(1);
    let mut rows = by_powers(&relation.substitute(names.m, &ratio_of_masses)?, names.rho);
    // Without the root rho = 1, an infinite height.
    while rows.len() > 2 {
        let mut carried = Polynomial::zero();
        let mut next = vec![Polynomial::zero(); rows.len() - 1];
        for place in (1..rows.len()).rev() {
            carried.accumulate(&rows[place]);
            next[place - 1] = carried.clone();
        }
        carried.accumulate(&rows[0]);
        if !carried.is_zero() {
            return None;
        }
        rows = next;
    }
    let [constant, linear] = rows.as_slice() else { return None };
    Some([in_unknown(constant, names.q, names.mu)?, in_unknown(linear, names.q, names.mu)?])
}

fn without_zeros(mut polynomial: InUnknown) -> InUnknown {
    while polynomial.last().is_some_and(RationalFunction::is_zero) {
        polynomial.pop();
    }
    polynomial
}

fn negated(polynomial: &[RationalFunction]) -> InUnknown {
    polynomial.iter().map(RationalFunction::negative).collect()
}

fn slopes(polynomial: &[RationalFunction]) -> InUnknown {
    let powers = polynomial.iter().zip(0_i64..).skip(1);
    powers.map(|(coefficient, power)| coefficient.scaled(&ratio(power, 1))).collect()
}

fn multiplied(left: &[RationalFunction], right: &[RationalFunction]) -> InUnknown {
    let zero = RationalFunction::number(Rational::zero());
    let mut sum = vec![zero; (left.len() + right.len()).saturating_sub(1)];
    for (i, one) in left.iter().enumerate() {
        for (k, other) in right.iter().enumerate() {
            sum[i + k] = sum[i + k].sum(&one.product(other));
        }
    }
    without_zeros(sum)
}

fn subtracted(left: &[RationalFunction], right: &[RationalFunction]) -> InUnknown {
    let zero = RationalFunction::number(Rational::zero());
    let at = |list: &[RationalFunction], place: usize| list.get(place).unwrap_or(&zero).clone();
    let length = left.len().max(right.len());
    without_zeros((0..length).map(|place| at(left, place).difference(&at(right, place))).collect())
}

/// Quotient and remainder.
fn divided(dividend: &[RationalFunction], divisor: &[RationalFunction]) -> (InUnknown, InUnknown) {
    let mut rest = without_zeros(dividend.to_vec());
    let zero = RationalFunction::number(Rational::zero());
    let mut quotient = vec![zero; (rest.len() + 1).saturating_sub(divisor.len())];
    while rest.len() >= divisor.len() {
        let shift = rest.len() - divisor.len();
        let Some(factor) = rest.last().zip(divisor.last()).and_then(|(a, b)| a.quotient(b)) else {
            break;
        };
        let mut product = vec![RationalFunction::number(Rational::zero()); shift];
        product.extend(divisor.iter().map(|coefficient| coefficient.product(&factor)));
        quotient[shift] = factor;
        rest = subtracted(&rest, &product);
    }
    (without_zeros(quotient), rest)
}

fn common_divisor(left: &[RationalFunction], right: &[RationalFunction]) -> InUnknown {
    let (mut left, mut right) = (without_zeros(left.to_vec()), without_zeros(right.to_vec()));
    while !right.is_empty() {
        let rest = divided(&left, &right).1;
        (left, right) = (right, rest);
    }
    left
}

/// The design with the lowest variance under white noise.
fn lowest_variance(
    transfer: &[Polynomial; 2],
    names: &AbsorberNames,
) -> Result<AbsorberDesign, AbsorberError> {
    let none = || AbsorberError::NoClosedForm(LOWEST_VARIANCE);
    let [above, below] = variance_parts(transfer, names);
    let variance = above.product(&below.power(-1).ok_or_else(none)?);
    let [p, z] = optimum(&variance, names)?;
    let squares = [(names.f, names.p), (names.zeta, names.z)];
    let square = halved(&variance.product(&variance), &squares)?;
    let square = value(&square, &[(names.p, &p), (names.z, &z)], names).ok_or_else(none)?;
    let written = |value: &QuadraticSurd| value.rational.sqrt_expr(names.mu);
    Ok(AbsorberDesign {
        name: "lowest-variance",
        words: "the variance under white noise is the least (H2)",
        formulas: vec![
            formula("tuning", "f", written(&p)?),
            formula("damping", "zeta", written(&z)?),
            formula("variance", "V", written(&square)?),
        ],
        refined_by: None,
    })
}

const LOWEST_VARIANCE: &str = "the design with the lowest variance";

/// f^2 and zeta^2 with which a variance is level, rational functions of mu.
pub(super) fn optimum(
    variance: &Polynomial,
    names: &AbsorberNames,
) -> Result<[QuadraticSurd; 2], AbsorberError> {
    const WHAT: &str = LOWEST_VARIANCE;
    let none = || AbsorberError::NoClosedForm(WHAT);
    let squares = [(names.f, names.p), (names.zeta, names.z)];
    // Both slopes vanish; without common powers they are polynomials in zeta^2 = z and f^2 = p.
    let level = |letter: Symbol| -> Result<Vec<Polynomial>, AbsorberError> {
        let slope = without_powers(&variance.slope(letter), &[names.f, names.zeta, names.mu]);
        Ok(by_powers(&halved(&slope, &squares)?, names.z))
    };
    let (damping, tuning) = (level(names.zeta)?, level(names.f)?);
    let ([d0, d1], [t0, t1]) = (&damping[..], &tuning[..]) else { return no_closed_form(WHAT) };
    let mut condition = t0.product(d1);
    condition.accumulate(&minus(&t1.product(d0)));
    let condition = without_powers(&condition, &[names.p]);
    let condition = in_unknown(&condition, names.p, names.mu).ok_or_else(none)?;
    let [free, slope] = condition.as_slice() else { return no_closed_form(WHAT) };
    let p = rational(free.negative().quotient(slope).ok_or_else(none)?);
    let at = |polynomial: &Polynomial| value(polynomial, &[(names.p, &p)], names).ok_or_else(none);
    let z = minus_quotient(&at(d0)?, &at(d1)?).ok_or_else(none)?;
    Ok([p, z])
}

/// Numerator and denominator of `1/(2 pi) int |B(i g)/A(i g)|^2 dg`, as c_3/a_4 of the partial
/// fractions.
pub(super) fn variance_parts(transfer: &[Polynomial; 2], names: &AbsorberNames) -> [Polynomial; 2] {
    let [b, a] = [&transfer[0], &transfer[1]].map(|polynomial| by_powers(polynomial, names.s));
    let degree = a.len() - 1;
    let at = |list: &[Polynomial], place: usize| {
        list.get(place).cloned().unwrap_or_else(Polynomial::zero)
    };
    // The coefficient of s^(2 row) of A(s) C(-s) + A(-s) C(s) = B(s) B(-s): odd powers cancel.
    let mut rows = Vec::new();
    for row in 0..degree {
        let mut equation = Vec::new();
        for column in 0..degree {
            let sign = if column % 2 == 0 { 2 } else { -2 };
            equation.push(match (2 * row).checked_sub(column) {
                Some(place) => at(&a, place).product(&constant(sign)),
                None => Polynomial::zero(),
            });
        }
        let mut right = Polynomial::zero();
        for place in 0..=2 * row {
            let sign = if place % 2 == 0 { 1 } else { -1 };
            right.accumulate(
                &at(&b, place).product(&at(&b, 2 * row - place)).product(&constant(sign)),
            );
        }
        equation.push(right);
        rows.push(equation);
    }
    let columns: Vec<usize> = (0..degree).collect();
    let replaced: Vec<usize> = (0..degree - 1).chain([degree]).collect();
    let below = determinant(&rows, &columns).product(&a[degree]);
    [determinant(&rows, &replaced), below]
}

/// The determinant of some columns, expanded by the rows.
fn determinant(rows: &[Vec<Polynomial>], columns: &[usize]) -> Polynomial {
    let Some((row, rest)) = rows.split_first() else { return constant(1) };
    let mut sum = Polynomial::zero();
    for (place, column) in columns.iter().enumerate() {
        let others: Vec<usize> = columns.iter().copied().filter(|other| other != column).collect();
        let sign = if place % 2 == 0 { 1 } else { -1 };
        sum.accumulate(&row[*column].product(&determinant(rest, &others)).product(&constant(sign)));
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    fn formulas(excitation: Excitation) -> Vec<String> {
        let laws = derive(excitation).expect("closed forms");
        println!("{:#?}", laws.relations);
        let written = |design: &AbsorberDesign| -> Vec<String> {
            let formulas = design.formulas.iter();
            formulas.map(|own| format!("{} = {}", own.symbol, own.formula)).collect()
        };
        laws.designs.iter().flat_map(written).collect()
    }

    /// Den Hartog; Nishihara and Asami; Asami, Nishihara and Baz.
    #[test]
    fn formulas_of_a_force_are_the_published_ones() {
        let lowest_peak = "sqrt(8*(16 + 23*mu + 9*mu^2 + 2*(2 + mu)*sqrt(4 + 3*mu))/(3*(64 + 80*mu + 27*mu^2)))/(1 + mu)";
        let found = formulas(Excitation::Force);
        assert_eq!(
            found[..3],
            ["f = 1/(1 + mu)", "zeta = sqrt(3*mu/(8*(1 + mu)))", "h = sqrt((2 + mu)/mu)"]
        );
        assert_eq!(found[5], format!("f = {lowest_peak}"));
        assert_eq!(
            found[8..],
            [
                "f = sqrt(1 + mu/2)/(1 + mu)",
                "zeta = sqrt(mu*(4 + 3*mu)/(8*(1 + mu)*(2 + mu)))",
                "V = sqrt((4 + 3*mu)/(mu*(1 + mu)))/2",
            ]
        );
    }

    /// G. B. Warburton, *Earthquake Eng. Struct. Dyn.* 10 (1982) 381, table 1.
    #[test]
    fn formulas_of_shaken_ground_are_the_published_ones() {
        let found = formulas(Excitation::Ground);
        assert_eq!(
            found[..3],
            [
                "f = sqrt(1 - mu/2)/(1 + mu)",
                "zeta = sqrt(3*mu/(4*(1 + mu)*(2 - mu)))",
                "h = sqrt(2/mu)"
            ]
        );
        assert_eq!(
            found[5..7],
            ["f = sqrt(1 - mu/2)/(1 + mu)", "zeta = sqrt(mu*(4 - mu)/(8*(1 + mu)*(2 - mu)))"]
        );
    }
}
