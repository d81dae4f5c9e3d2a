//! The transition curves of one tongue, exact, order by order.
//!
//! On them a motion of the period 4 pi/Omega exists, `x(phi)` with `phi = Omega t/2`, so that the
//! mean stiffness `lambda` is an eigenvalue. The harmonic n is separated by effective perturbation
//! theory (C. Bloch, Nucl. Phys. 6 (1958) 329): with `X` the motions that begin as `cos n phi` and
//! `sin n phi`, and have no other part of harmonic n,
//!
//! ```text
//! lambda x = -(Omega^2/4) x_phiphi - (Omega/2) c x_phi - p x =: (M0 + V) x
//! (M0 + V) X = X H,   H_0 = n^2 Omega^2/4,   H_j = [sum V_i X_(j-i)]_n
//! (k^2 - n^2) Omega^2/4 [X_j]_k = [sum_(i>=1) X_(j-i) H_i - sum_(i>=1) V_i X_(j-i)]_k,   k /= n
//! ```
//!
//! The eigenvalues of the two by two matrix H are the two curves: its diagonal where it has no
//! other entries, and otherwise `C -+ sqrt(Q)`, `C = tr H/2`, `Q = C^2 - det H`. C and Q are power
//! series in the small parameters even where the curves are not, as at the tip of a tongue that
//! damping has moved away from the axis.

use std::collections::BTreeMap;

use num_traits::{One, Zero};

use super::periodic::fraction;
use super::{Hill, HillError, Unknown};
use crate::exact::rational::ratio;
use crate::exact::{Monomial, POLYNOMIALS, Polynomial, Polynomials, Rational};
use crate::series::FourierSeries;
use crate::symbol::Symbol;

/// One curve: `middle`, or `middle -+ sqrt(under_root)`.
#[derive(Clone, Debug, PartialEq)]
pub struct TransitionCurve {
    /// `a1` and `b1` for a motion of cosines and one of sines; `lower1` and `upper1` for a motion
    /// of both.
    pub name: String,
    /// n: on the curve a motion of the frequency n*Omega/2 exists.
    pub tongue: usize,
    /// The curve, or the middle of the two.
    pub middle: Polynomial,
    /// The radicand; `None` if the curve is a power series.
    pub under_root: Option<Polynomial>,
    /// Whether it is the upper curve of its pair for positive small parameters: the one to which
    /// the root is added.
    pub upper: bool,
    /// The harmonics of the periodic motion on the curve.
    pub motion: WavesOfMotion,
}

/// The kind of Fourier series of the motion on a curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WavesOfMotion {
    /// Cosines alone.
    Cosines,
    /// Sines alone.
    Sines,
    /// Cosines and sines.
    Both,
}

/// The curves of tongue n.
pub(super) fn of_tongue(
    hill: &Hill,
    tongue: usize,
    order: u32,
) -> Result<Vec<TransitionCurve>, HillError> {
    let matrix = effective_matrix(hill, tongue, order);
    let [[cosine, upper_right], [lower_left, _]] = &matrix;
    if tongue == 0 {
        let middle = TruncatedPowers { hill, order }.solved(cosine, tongue);
        let mut curve = of_waves("a", tongue, middle);
        if !is_even(hill) {
            curve.motion = WavesOfMotion::Both;
        }
        return Ok(vec![curve]);
    }
    Ok(match upper_right.is_zero() && lower_left.is_zero() {
        true => separate(hill, tongue, order, &matrix),
        false => mixed(hill, tongue, order),
    })
}

/// Whether no order mixes cosines and sines.
fn is_even(hill: &Hill) -> bool {
    hill.graded.iter().all(|[stiffness, damping]| {
        let waves = |series: &FourierSeries<Polynomials>| series.harmonics();
        waves(stiffness).iter().all(|(_, _, sine)| sine.is_zero())
            && waves(damping).iter().all(|(_, cosine, _)| cosine.is_zero())
    })
}

/// The curve of motions of cosines, a, or of sines, b.
fn of_waves(letter: &str, tongue: usize, middle: Polynomial) -> TransitionCurve {
    TransitionCurve {
        name: format!("{letter}{tongue}"),
        tongue,
        middle,
        under_root: None,
        upper: false,
        motion: match letter {
            "a" => WavesOfMotion::Cosines,
            _ => WavesOfMotion::Sines,
        },
    }
}

/// Both curves if H is diagonal: each diagonal entry gives one.
fn separate(
    hill: &Hill,
    tongue: usize,
    order: u32,
    matrix: &[[Polynomial; 2]; 2],
) -> Vec<TransitionCurve> {
    let power = TruncatedPowers { hill, order };
    let [[cosine, _], [_, sine]] = matrix;
    let mut pair = vec![
        of_waves("a", tongue, power.solved(cosine, tongue)),
        of_waves("b", tongue, power.solved(sine, tongue)),
    ];
    // The order of the two curves may show only beyond the truncation order.
    let further = match pair[0].middle == pair[1].middle {
        false => None,
        true => Some(effective_matrix(hill, tongue, order + 2 * tongue as u32)),
    };
    let [[cosine, _], [_, sine]] = further.as_ref().unwrap_or(matrix);
    if power.is_above(cosine, sine) != power.decreases_with_eigenvalue() {
        pair.swap(0, 1);
    }
    pair[1].upper = true;
    if !is_even(hill) {
        for (curve, side) in pair.iter_mut().zip(["lower", "upper"]) {
            curve.name = format!("{side}{tongue}");
            curve.motion = WavesOfMotion::Both;
        }
    }
    pair
}

/// Both curves where H mixes cosines and sines: the mean of its diagonal, and a root beside it.
fn mixed(hill: &Hill, tongue: usize, order: u32) -> Vec<TransitionCurve> {
    // The terms that open the tongue enter the radicand Q squared, with the power 2 n.
    let beyond = order.max(2 * tongue as u32);
    let further = effective_matrix(hill, tongue, beyond);
    let power = TruncatedPowers { hill, order: beyond };
    let (middle, root) = middle_and_square(&power, tongue, &further);
    let middle = power.cut(&middle, order.into());
    let shown = i64::from(order.max(beyond - 1)) + 1;
    let exact_root = power.square_root(&root);
    let curve = |upper: bool| {
        let (middle, under_root) = match &exact_root {
            Some(root) => {
                let curve = if upper { middle.sum_with(root) } else { middle.less(root) };
                (power.cut(&curve, order.into()), None)
            }
            None => (middle.clone(), Some(power.cut(&root, shown))),
        };
        TransitionCurve {
            name: format!("{}{tongue}", if upper { "upper" } else { "lower" }),
            tongue,
            middle,
            under_root,
            upper,
            motion: WavesOfMotion::Both,
        }
    };
    vec![curve(false), curve(true)]
}

/// The mean of the diagonal of H, and the square of the distance of the curves from it, in terms of
/// the unknown.
fn middle_and_square(
    power: &TruncatedPowers,
    tongue: usize,
    matrix: &[[Polynomial; 2]; 2],
) -> (Polynomial, Polynomial) {
    let hill = power.hill;
    let [[cosine, upper_right], [lower_left, sine]] = matrix;
    let middle = cosine.sum_with(sine).scaled(&ratio(1, 2));
    let difference = cosine.less(sine).scaled(&ratio(1, 2));
    let least = [&difference, upper_right, lower_left]
        .into_iter()
        .filter_map(|entry| power.least_degree(entry));
    let known = i64::from(power.order) + least.min().unwrap_or(0);
    let root = difference.product(&difference).sum_with(&upper_right.product(lower_left));
    let root = power.cut(&root, known);
    match hill.unknown {
        Unknown::Stiffness { .. } => {
            let inverse = power.inverse_factor();
            let middle = middle.less(&hill.constant).product(&inverse);
            (middle, root.product(&inverse.product(&inverse)))
        }
        Unknown::Frequency(name) => power.frequency_squared(&middle, &root, tongue, name),
    }
}

/// H to an order in the small parameters; for tongue 0 its first entry alone.
fn effective_matrix(hill: &Hill, tongue: usize, order: u32) -> [[Polynomial; 2]; 2] {
    let frequency = hill.frequency.polynomial();
    let quarter = frequency.product(&frequency).scaled(&ratio(1, 4));
    let constant = |value: Polynomial| FourierSeries::constant(POLYNOMIALS, value);
    let half = constant(frequency.scaled(&ratio(1, 2)));
    // 4/Omega^2
    let inverse = Polynomial::term(
        hill.frequency.unit.power(-2),
        ratio(4, 1) / (&hill.frequency.number * &hill.frequency.number),
    );
    let columns: &[usize] = if tongue == 0 { &[0] } else { &[0, 1] };
    let mut waves: Vec<Vec<FourierSeries<Polynomials>>> = vec![
        columns
            .iter()
            .map(|column| match column {
                0 => FourierSeries::cos(POLYNOMIALS, tongue),
                _ => FourierSeries::sin(POLYNOMIALS, tongue),
            })
            .collect(),
    ];
    let at_rest = quarter.scaled(&fraction(tongue * tongue, 1));
    let zero =
        || [[Polynomial::zero(), Polynomial::zero()], [Polynomial::zero(), Polynomial::zero()]];
    let mut orders = vec![zero()];
    orders[0][0][0] = at_rest.clone();
    orders[0][1][1] = at_rest;
    for j in 1..=order as usize {
        let mut matrix = zero();
        let mut next = Vec::new();
        for column in columns {
            let mut image = FourierSeries::zero(POLYNOMIALS);
            for (i, [stiffness, damping]) in hill.graded.iter().enumerate().take(j) {
                let wave = &waves[j - i - 1][*column];
                image = image.difference(&stiffness.product(wave));
                image = image.difference(&half.product(&damping.product(&wave.derivative())));
            }
            let entry = |k: usize| (image.cosine(k).constant_term(), image.sine(k).constant_term());
            let (cosine, sine) = entry(tongue);
            matrix[0][*column] = cosine;
            matrix[1][*column] = sine;
            let mut rest = image.times(-1);
            for i in 1..j {
                for (row, wave) in waves[j - i].iter().enumerate() {
                    rest = rest.sum(&wave.product(&constant(orders[i][row][*column].clone())));
                }
            }
            let divided = |part: Polynomial, k: usize| match k == tongue {
                true => Polynomial::zero(),
                false => {
                    let squares = (k * k) as i64 - (tongue * tongue) as i64;
                    part.product(&inverse).scaled(&ratio(1, squares))
                }
            };
            let highest = rest.highest_harmonic();
            let cosines = (0..=highest).map(|k| divided(rest.cosine(k).constant_term(), k));
            let sines = (0..=highest).map(|k| divided(rest.sine(k).constant_term(), k));
            next.push(FourierSeries::from_parts(POLYNOMIALS, cosines.collect(), sines.collect()));
        }
        waves.push(next);
        orders.push(matrix);
    }
    let mut sum = zero();
    for matrix in &orders {
        for (row, column) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            sum[row][column].accumulate(&matrix[row][column]);
        }
    }
    sum
}

/// Sums, differences and multiples, each a new polynomial.
trait Combined {
    fn sum_with(&self, other: &Self) -> Self;
    fn less(&self, other: &Self) -> Self;
    fn scaled(&self, factor: &Rational) -> Self;
}

impl Combined for Polynomial {
    fn sum_with(&self, other: &Self) -> Self {
        let mut sum = self.clone();
        sum.accumulate(other);
        sum
    }

    fn less(&self, other: &Self) -> Self {
        self.sum_with(&other.scaled(&ratio(-1, 1)))
    }

    fn scaled(&self, factor: &Rational) -> Self {
        self.product(&Self::constant(factor.clone()))
    }
}

/// Power series in the small parameters, truncated after an order.
#[derive(Clone, Copy)]
struct TruncatedPowers<'a> {
    hill: &'a Hill,
    order: u32,
}

impl TruncatedPowers<'_> {
    fn degree(&self, monomial: &Monomial) -> i64 {
        self.hill.small.iter().map(|name| i64::from(monomial.exponent(*name))).sum()
    }

    fn least_degree(&self, polynomial: &Polynomial) -> Option<i64> {
        polynomial.terms().map(|(monomial, _)| self.degree(monomial)).min()
    }

    fn kept(&self, polynomial: &Polynomial, keep: impl Fn(i64) -> bool) -> Polynomial {
        let mut kept = Polynomial::zero();
        for (monomial, number) in polynomial.terms().filter(|term| keep(self.degree(term.0))) {
            kept.add_term(monomial.clone(), number.clone());
        }
        kept
    }

    fn cut(&self, polynomial: &Polynomial, highest: i64) -> Polynomial {
        self.kept(polynomial, |degree| degree <= highest)
    }

    /// Whether the first of two curves is the upper one for small parameters just above zero, all
    /// other symbols being positive.
    fn is_above(&self, first: &Polynomial, second: &Polynomial) -> bool {
        let difference = first.less(second);
        let Some(least) = self.least_degree(&difference) else {
            return false;
        };
        let leading = self.kept(&difference, |degree| degree == least);
        leading.evaluate(|_| Some(1.0)).is_ok_and(|value| value > 0.0)
    }

    /// Whether the unknown decreases as the eigenvalue grows.
    fn decreases_with_eigenvalue(&self) -> bool {
        match self.hill.unknown {
            Unknown::Stiffness { .. } => {
                let factor = self.hill.factor.single_term();
                factor.is_some_and(|(_, number)| *number < Rational::zero())
            }
            // A larger eigenvalue equals the mean stiffness at a lower frequency.
            Unknown::Frequency(_) => true,
        }
    }

    /// The reciprocal of the coefficient of the unknown power.
    fn inverse_factor(&self) -> Polynomial {
        let factor = self.hill.factor.single_term();
        factor.map_or_else(Polynomial::zero, |(monomial, number)| {
            Polynomial::term(monomial.power(-1), number.recip())
        })
    }

    /// The curve on which the mean stiffness is `eigenvalue`.
    fn solved(&self, eigenvalue: &Polynomial, tongue: usize) -> Polynomial {
        match self.hill.unknown {
            Unknown::Stiffness { .. } => {
                eigenvalue.less(&self.hill.constant).product(&self.inverse_factor())
            }
            Unknown::Frequency(name) => {
                // constant = n^2 w/4 + rest(w), solved by iteration with the right side of the
                // order before.
                let scale = self.first_square(tongue);
                let mut square = scale.product(&self.hill.constant);
                let rest = self.kept(eigenvalue, |degree| degree > 0);
                // Each iteration gains one order, and truncates the others.
                for order in 1..=self.order {
                    let round = TruncatedPowers { order, ..*self };
                    let rest = round.with_square(&rest, name, &square);
                    square =
                        self.cut(&scale.product(&self.hill.constant.less(&rest)), order.into());
                }
                square
            }
        }
    }

    /// `w/lambda` at zero small parameters: `4/(n^2 q^2)` for the frequency `q*Omega`.
    fn first_square(&self, tongue: usize) -> Polynomial {
        let number = &self.hill.frequency.number;
        Polynomial::constant(ratio(4, 1) / (fraction(tongue * tongue, 1) * number * number))
    }

    /// A polynomial in even powers, of either sign, of `name`, with a power series in place of its
    /// square.
    fn with_square(
        &self,
        polynomial: &Polynomial,
        name: Symbol,
        square: &Polynomial,
    ) -> Polynomial {
        let exponents = || polynomial.terms().map(|(monomial, _)| monomial.exponent(name) / 2);
        let highest =
            |sign: i32| exponents().map(|exponent| sign * exponent).max().unwrap_or(0).max(0);
        let inverse = self.inverse(square);
        let [above, below] = [(square, highest(1)), (&inverse, highest(-1))]
            .map(|(base, highest)| self.powers(base, highest));
        let mut sum = Polynomial::zero();
        for (monomial, number) in polynomial.terms() {
            let exponent = monomial.exponent(name) / 2;
            let powers = if exponent < 0 { &below } else { &above };
            let term = Polynomial::term(monomial.without(name), number.clone());
            let power = &powers[exponent.unsigned_abs() as usize];
            sum.accumulate(&self.product(&term, power, self.highest()));
        }
        sum
    }

    /// The product up to a degree; higher terms are not computed.
    fn product(&self, left: &Polynomial, right: &Polynomial, highest: i64) -> Polynomial {
        let by_degree = |polynomial: &Polynomial| {
            let mut parts: BTreeMap<i64, Polynomial> = BTreeMap::new();
            for (monomial, number) in polynomial.terms() {
                let part = parts.entry(self.degree(monomial)).or_insert_with(Polynomial::zero);
                part.add_term(monomial.clone(), number.clone());
            }
            parts
        };
        let (left, right) = (by_degree(left), by_degree(right));
        let mut sum = Polynomial::zero();
        for (degree, part) in &left {
            for (_, other) in right.range(..=highest - degree) {
                sum.accumulate(&part.product(other));
            }
        }
        sum
    }

    /// The truncation order while a series is computed: two more than the order shown.
    fn highest(&self) -> i64 {
        i64::from(self.order) + 2
    }

    /// The powers of a series from 0 to the highest.
    fn powers(&self, base: &Polynomial, highest: i32) -> Vec<Polynomial> {
        let mut powers = vec![Polynomial::constant(Rational::one())];
        for power in 0..highest as usize {
            powers.push(self.product(&powers[power], base, self.highest()));
        }
        powers
    }

    /// The reciprocal of a series that begins with a single term: `1/(s (1 + u)) = (1 - u + u^2 -
    /// ...)/s`.
    fn inverse(&self, series: &Polynomial) -> Polynomial {
        let first = self.kept(series, |degree| degree == 0);
        let inverse = first
            .single_term()
            .map(|(monomial, number)| Polynomial::term(monomial.power(-1), number.recip()));
        let Some(inverse) = inverse else {
            return Polynomial::zero();
        };
        let one = Polynomial::constant(Rational::one());
        let rest = series.less(&first).product(&inverse).scaled(&ratio(-1, 1));
        let mut sum = one.clone();
        // Each iteration gains one order.
        for order in 1..=self.highest() {
            sum = one.sum_with(&self.product(&rest, &sum, order));
        }
        sum.product(&inverse)
    }

    /// The root of a power series whose least part is the square of a single term.
    fn square_root(&self, series: &Polynomial) -> Option<Polynomial> {
        let Some(least) = self.least_degree(series) else {
            return Some(Polynomial::zero());
        };
        let first = self.kept(series, |degree| degree == least);
        let root = first.single_term_root()?;
        let (monomial, number) = root.single_term()?;
        let inverse = Polynomial::term(monomial.power(-1), number.recip());
        // r + h with 2 r h + h^2 = rest.
        let rest = series.less(&first);
        let mut correction = Polynomial::zero();
        for _ in 0..=self.order {
            let right =
                rest.less(&correction.product(&correction)).product(&inverse).scaled(&ratio(1, 2));
            correction = self.cut(&right, self.order.into());
        }
        let whole = correction
            .terms()
            .all(|(monomial, _)| self.hill.small.iter().all(|name| monomial.exponent(*name) >= 0));
        whole.then(|| root.sum_with(&correction))
    }

    /// Middle and half distance squared of `w = Omega^2` from those of the eigenvalues at a given
    /// w: Weierstrass's polynomial `v^2 + b v + e`, `v = w - w_0`, of `F(w) = (lambda - C(w))^2 -
    /// Q(w)`, which has the two roots that vanish with the small parameters. Dividing `v^2 = q F +
    /// r` gives it: `E q = 1 - hi(q lo(F))`, where `F = lo(F) + v^2 E` and lo is of degree one in
    /// v.
    fn frequency_squared(
        &self,
        middle: &Polynomial,
        root: &Polynomial,
        tongue: usize,
        name: Symbol,
    ) -> (Polynomial, Polynomial) {
        let v = crate::symbol::fresh("v", &[name]);
        let first = self.first_square(tongue).product(&self.hill.constant);
        // v counts as small.
        let mut small = self.hill.small.clone();
        small.push(v);
        let extended = Hill {
            small,
            graded: vec![],
            unknown: self.hill.unknown,
            factor: self.hill.factor.clone(),
            constant: self.hill.constant.clone(),
            frequency: self.hill.frequency.clone(),
            highest_harmonic: self.hill.highest_harmonic,
        };
        let highest = i64::from(self.order) + 2;
        let power = TruncatedPowers { hill: &extended, order: self.order };
        let square = first.sum_with(&Polynomial::symbol(v));
        let distance = self.hill.constant.less(&power.with_square(middle, name, &square));
        let function = power
            .product(&distance, &distance, highest)
            .less(&power.with_square(root, name, &square));
        let function = power.cut(&function, highest);
        let split = |polynomial: &Polynomial| {
            let (mut low, mut high) = (Polynomial::zero(), Polynomial::zero());
            for (monomial, number) in polynomial.terms() {
                match monomial.exponent(v) < 2 {
                    true => low.add_term(monomial.clone(), number.clone()),
                    false => {
                        high.add_term(monomial.product(&Monomial::power_of(v, -2)), number.clone())
                    }
                }
            }
            [low, high]
        };
        let [low, high] = split(&function);
        let unit = power.inverse(&high);
        let one = Polynomial::constant(Rational::one());
        let mut quotient = unit.clone();
        // Each iteration gains one order in the small parameters without v, since every term of
        // lo(F) contains them.
        for order in 1..=highest {
            let [_, above] = split(&power.product(&quotient, &low, highest + 2));
            let next = power.product(&unit, &one.less(&above), highest);
            quotient = self.cut(&next, order);
        }
        // v^2 = q F + r
        let v_squared = Polynomial::term(Monomial::power_of(v, 2), Rational::one());
        let [remainder, _] = split(&v_squared.less(&power.product(&quotient, &function, highest)));
        let at = |exponent: i32| {
            let mut part = Polynomial::zero();
            for (monomial, number) in
                remainder.terms().filter(|term| term.0.exponent(v) == exponent)
            {
                part.add_term(monomial.without(v), number.clone());
            }
            part
        };
        let half = at(1).scaled(&ratio(1, 2));
        let under_root = half.product(&half).sum_with(&at(0));
        (
            self.cut(&first.sum_with(&half), self.order.into()),
            self.cut(&under_root, i64::from(self.order) + 1),
        )
    }
}
