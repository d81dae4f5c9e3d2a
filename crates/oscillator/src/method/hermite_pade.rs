//! Quadratic Hermite-Pade approximants of omega^2: roots of a quadratic equation whose coefficients
//! are polynomials.
//!
//! References: R. E. Shafer, *On quadratic approximation*, SIAM J. Numer. Anal. 11 (1974) 447-460;
//! G. A. Baker, P. Graves-Morris, *Pade Approximants*, 2nd ed., Cambridge 1996, section 8.6.
//!
//! ```text
//! omega^2 = c_0 f,   f = 1 + f_1 s + f_2 s^2 + ...,   s = A^2 or the small parameter, times the symbols that enter in step with it
//! P + Q f + R f^2 = O(s^n),   deg P = p, deg Q = q, deg R = r,   n = p + q + r + 2
//! f = (-Q + S sqrt(D))/(2 R) = -2 P/(Q + S sqrt(D)),   D = Q^2 - 4 P R,   2 R + Q > 0 and S = 1 at s = 0
//! ```
//!
//! A quotient lines up poles along a cut of omega^2; this approximant has branch points of its own.
//! The root is followed from rest: it is continuous as long as D does not vanish, and ends at a
//! single zero of D or where it is infinite. If both roots come so close that D has two almost
//! equal zeros, they cross: the difference of the roots passes through zero like `s - m`, and S is
//! the other sign from there on. All zeros of D and of R on the way are [counted for
//! certain](crate::exact::zero_clusters).
//!
//! Both forms of the root are quotients `N_i/M_i`. Where R vanishes and it is the other root that
//! is infinite, the first is 0/0; so is the second where P vanishes and it is the other root that
//! is zero. The root goes on through either: where each of the forms has such a place on the way,
//! their mediant is the formula, which has none,
//!
//! ```text
//! f = (M_1 N_1 + M_2 N_2)/(M_1^2 + M_2^2) = 2 (S sqrt(D) (R - P) - Q (P + R))/(4 R^2 + (Q + S sqrt(D))^2)
//! ```
//!
//! ```
//! # use lindstedt_oscillator as lindstedt;
//! use lindstedt::{Oscillator, method::{Options, solve}, solution::{Degrees, Method}};
//! let duffing = Oscillator::parse("x'' + x + eps*x^3 = 0")?;
//! let options = Options { method: Some(Method::HermitePade), degrees: Some(Degrees::Quadratic(1, 1, 1)), ..Options::default() };
//! let law = solve(&duffing, &options)?;
//! assert_eq!(law.law.closed_form().unwrap().to_string(), "omega^2 = (S*sqrt(Q^2 - 4*P*R) - Q)/(2*R)");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use std::cmp::Ordering;

use num_traits::{One, Signed, Zero};

use super::power_series::{CONSTANT, Resummed, STOPPED, TOO_LONG, has_values};
use super::{Options, Reason, Refusal};
use crate::derivation::DerivationLine;
use crate::exact::big_float::BigFloat;
use crate::exact::zero_clusters::{Cluster, clusters};
use crate::exact::{Integer, Monomial, Polynomial, Rational, convergent, to_f64};
use crate::expr::{Expr, ExprError, Function};
use crate::interrupt::Interrupt;
use crate::oscillator::Oscillator;
use crate::series::hermite_pade::by_primes::exact;
use crate::solution::note::{FollowedRoot, RootEnd};
use crate::solution::{Definition, Degrees, Method, Note, Solution};
use crate::symbol::{Symbol, fresh, fresh_stem};

const METHOD: Method = Method::HermitePade;

/// The largest degree of each of the three.
const LARGEST_DEGREE: u32 = 40;

/// The degrees to try in turn where none are given: a series whose first power is missing may have
/// no approximant of the first of them.
const DEFAULTS: [Degrees; 3] =
    [Degrees::Quadratic(1, 1, 1), Degrees::Quadratic(2, 2, 2), Degrees::Quadratic(3, 3, 3)];

/// The approximant of the degrees in the options; by default `[1/1/1]`, or the next of the defaults
/// that exists.
///
/// # Errors
/// As for the method of Lindstedt and Poincare; degrees without an approximant, and one whose root
/// cannot be followed.
pub fn solve(oscillator: &Oscillator, options: &Options) -> Result<Solution, Refusal> {
    if let Some(degrees) = options.degrees {
        return of_degrees(oscillator, options, degrees);
    }
    let [first, others @ ..] = DEFAULTS;
    let refusal = match of_degrees(oscillator, options, first) {
        Err(refusal @ Refusal { reason: Reason::Approximant { .. }, .. }) => refusal,
        other => return other,
    };
    let mut answers = others.into_iter().map(|degrees| of_degrees(oscillator, options, degrees));
    answers.find_map(Result::ok).ok_or(refusal)
}

fn of_degrees(
    oscillator: &Oscillator,
    options: &Options,
    degrees: Degrees,
) -> Result<Solution, Refusal> {
    let refused = |reason| Refusal::from(Reason::Approximant { method: METHOD, degrees, reason });
    let Degrees::Quadratic(p, q, r) = degrees else {
        return Err(refused("it has three, those of P, Q and R"));
    };
    if [p, q, r].iter().any(|degree| *degree > LARGEST_DEGREE) {
        return Err(refused("degrees go up to [40/40/40]"));
    }
    let order = p + q + r + 1;
    let resummed =
        Resummed::new(oscillator, options, (METHOD, order))?.ok_or_else(|| refused(STOPPED))?;
    let mut resummed = resummed;
    resummed.write_squares_by_their_roots();
    let series = &resummed.series;
    if (1..=i64::from(order)).all(|power| series.coefficient(power).is_zero()) {
        return Err(refused(CONSTANT));
    }
    let (variable, mut numbers) =
        series.in_one_variable().ok_or_else(|| Reason::SeveralVariables.to(METHOD))?;
    // f begins with one; the first coefficient c_0 is a factor of the law.
    let first = numbers[0].clone();
    numbers.iter_mut().for_each(|number| *number = &*number / &first);
    numbers.resize(order as usize + 1, Rational::zero());
    let quadratic = Quadratic::from_series(&numbers, [p, q, r].map(|degree| degree as usize))
        .map_err(refused)?;
    // A squared variable has one sign.
    let squared = variable.factors().iter().all(|(_, exponent)| exponent % 2 == 0);
    let sides: &[i64] = if squared { &[1] } else { &[1, -1] };
    let interrupt = options.supervision.interrupt;
    let root = quadratic.followed(sides, interrupt).ok_or_else(|| {
        refused(match interrupt.is_requested() {
            true => "the search for the zeros of its discriminant was stopped",
            false => {
                "its root cannot be followed: zeros of its discriminant are too close to each other"
            }
        })
    })?;
    let in_words = ApproximantNames::new(&resummed.names(), variable);
    let (value, definitions) = in_words.law(&quadratic, &root)?;
    if !definitions[..3].iter().all(|own| has_values(&own.meaning)) {
        return Err(refused(TOO_LONG));
    }
    let value = &Expr::from(&series.coefficient(0)) * &value;
    let notes = [resummed.agreement(degrees)]
        .into_iter()
        .chain(in_words.note(&root))
        .chain([Note::MotionOfSeries])
        .collect();
    let derivation = match resummed.long {
        true => vec![DerivationLine::words(format!(
            "the {} linear equations for P, Q and R are solved modulo many primes, and put together",
            order + 1
        ))],
        false => in_words.linear_system(&numbers, &quadratic)?,
    };
    Ok(resummed.answer(degrees, (value, definitions), (notes, derivation)))
}

/// `P + Q f + R f^2`, the lowest powers first: whole numbers without a common factor, `2 R + Q`
/// positive at zero.
struct Quadratic {
    lists: [Vec<Integer>; 3],
}

/// The course of the root on either side of zero.
struct RootCourse {
    /// Points at which the sign of the root of D changes.
    crossings: Vec<Rational>,
    /// Ends of the root, and whether D is negative everywhere beyond, so that the formula shows the
    /// end itself.
    ends: Vec<(Rational, RootEnd, bool)>,
    /// Whether the forms of the root over R and over `Q + S sqrt(D)` are 0/0 somewhere on the way.
    indeterminate: [bool; 2],
}

impl Quadratic {
    /// The approximant of a series that begins with one, or why there is none.
    fn from_series(series: &[Rational], degrees: [usize; 3]) -> Result<Self, &'static str> {
        let mut one = vec![Rational::zero(); series.len()];
        one[0] = Rational::one();
        let square: Vec<Rational> =
            (0..series.len()).map(|n| (0..=n).map(|k| &series[k] * &series[n - k]).sum()).collect();
        let [p, q, r] = degrees;
        let lists = exact(&[(one, p), (series.to_vec(), q), (square, r)]);
        let lists = lists.and_then(|lists| <[Vec<Integer>; 3]>::try_from(lists).ok());
        let mut own = Self { lists: lists.ok_or("the equations for P, Q and R are singular")? };
        match own.slope_at_zero().cmp(&Integer::zero()) {
            Ordering::Equal => return Err("both roots of its equation are the same at rest"),
            Ordering::Less => {
                own.lists.iter_mut().flatten().for_each(|number| *number = -std::mem::take(number))
            }
            Ordering::Greater => {}
        }
        Ok(own)
    }

    /// `2 R + Q` at zero, where f is one: the root of D there.
    fn slope_at_zero(&self) -> Integer {
        let [_, q, r] = &self.lists;
        &r[0] + &r[0] + &q[0]
    }

    /// `Q^2 - 4 P R`.
    fn discriminant(&self) -> Vec<Integer> {
        let [p, q, r] = &self.lists;
        let four = Integer::from(4);
        let mut sum = vec![Integer::zero(); (2 * q.len()).max(p.len() + r.len()) - 1];
        for (i, own) in q.iter().enumerate() {
            for (k, other) in q.iter().enumerate() {
                sum[i + k] += own * other;
            }
        }
        for (i, own) in p.iter().enumerate() {
            for (k, other) in r.iter().enumerate() {
                sum[i + k] -= &four * &(own * other);
            }
        }
        sum
    }

    /// The root on these sides of zero; `None` if it cannot be followed with certainty, or was
    /// interrupted.
    fn followed(&self, sides: &[i64], interrupt: Interrupt) -> Option<RootCourse> {
        let mut followed = RootCourse {
            crossings: vec![],
            ends: vec![],
            indeterminate: [2, 0].map(|list: usize| self.lists[list][0].is_zero()),
        };
        for side in sides {
            self.follow(*side, &mut followed, interrupt)?;
        }
        Some(followed)
    }

    /// The root on one side of zero.
    fn follow(&self, side: i64, followed: &mut RootCourse, interrupt: Interrupt) -> Option<()> {
        /// Largest distance, relative to their position, of two zeros of D that count as a
        /// crossing; zeros farther apart are ends.
        const CROSSES: f64 = 0.01;
        let degree: usize = self.lists.iter().map(Vec::len).sum();
        let bits = 512 + 16 * degree;
        let floats = |list: &[Integer]| -> Vec<BigFloat> {
            let mut sign = Integer::one();
            let mut turned = |number: &Integer| {
                let value = BigFloat::of_integer(&(number * &sign), bits);
                sign = &sign * &Integer::from(side);
                value
            };
            list.iter().map(&mut turned).collect()
        };
        let [p, q, r] = self.lists.each_ref().map(|list| floats(list));
        // A common factor of all coefficients of P or of R vanishes at zero alone.
        let zeros = |list: &[BigFloat]| match list.iter().position(|value| !value.is_zero()) {
            None => Some(vec![]),
            Some(first) => clusters(&list[first..], || interrupt.is_requested()),
        };
        let meetings = clusters(&floats(&self.discriminant()), || interrupt.is_requested())?;
        let (zeros_of_p, zeros_of_r) = (zeros(&p), zeros(&r)?);
        // The zeros of P only tell which form is written.
        followed.indeterminate[1] |= zeros_of_p.is_none();
        let zeros_of_p = zeros_of_p.unwrap_or_default();
        let (mut zeros_of_p, mut zeros_of_r) =
            (zeros_of_p.iter().peekable(), zeros_of_r.iter().peekable());
        let mut is_upper = true;
        let place =
            |cluster: &Cluster| Rational::from_integer(side.into()) * cluster.place.to_fraction();
        // If Q has the sign of the root of D, R vanishes with `S sqrt(D) - Q`; otherwise P does
        // with `Q + S sqrt(D)`.
        let same_sign = |zero: &&Cluster, is_upper: bool| {
            let nothing = BigFloat::zero(bits);
            let start = nothing.clone();
            let value = q.iter().rev().fold(start, |sum, number| &(&sum * &zero.place) + number);
            (value > nothing) == is_upper
        };
        for meeting in meetings.iter().map(Some).chain([None]) {
            let before = |zero: &&Cluster| meeting.is_none_or(|meeting| zero.place < meeting.place);
            let mut end: Option<&Cluster> = None;
            while let Some(zero) = zeros_of_r.next_if(|zero| end.is_none() && before(zero)) {
                match same_sign(&zero, is_upper) {
                    true => followed.indeterminate[0] = true,
                    false => end = Some(zero),
                }
            }
            while let Some(zero) =
                zeros_of_p.next_if(|zero| end.map_or(before(zero), |end| zero.place < end.place))
            {
                followed.indeterminate[1] |= !same_sign(&zero, is_upper);
            }
            if let Some(pole) = end {
                followed.ends.push((place(pole), RootEnd::Infinite, false));
                return Some(());
            }
            let Some(meeting) = meeting else { break };
            if meeting.count == 2 && meeting.distance.abs() <= CROSSES {
                is_upper = !is_upper;
                followed.crossings.push(place(meeting));
                continue;
            }
            let middle = place(meeting);
            let distance = crate::exact::from_f64(meeting.distance.abs())?;
            // D is negative from here on, if nothing follows.
            let says_so = meeting.count == 1
                && meetings.last().is_some_and(|last| std::ptr::eq(last, meeting));
            followed.ends.push((&middle - &middle * distance, RootEnd::Meets, says_so));
            return Some(());
        }
        Some(())
    }
}

/// The symbols with which the approximant is written.
struct ApproximantNames {
    /// The letters of P, Q, R, and of the sign.
    letters: [Symbol; 4],
    /// The stems of their coefficients, of the variable and of the series.
    stems: [String; 3],
    short: [Symbol; 2],
    variable: Monomial,
}

impl ApproximantNames {
    fn new(taken: &[Symbol], variable: Monomial) -> Self {
        Self {
            letters: ["P", "Q", "R", "S"].map(|letter| fresh(letter, taken)),
            stems: ["p", "q", "r"].map(|letter| fresh_stem(letter, taken)),
            short: ["s", "f"].map(|letter| fresh(letter, taken)),
            variable,
        }
    }

    /// f in terms of the symbols, and their definitions; the first three are P, Q and R.
    fn law(
        &self,
        quadratic: &Quadratic,
        root: &RootCourse,
    ) -> Result<(Expr, Vec<Definition>), ExprError> {
        let [p, q, r, s] = self.letters.map(Expr::from);
        let two = Expr::from(2);
        let discriminant = &(&q * &q) - &(&Expr::from(4) * &(&p * &r));
        let square = match root.crossings.is_empty() {
            true => discriminant,
            // Between two real zeros next to each other, and by rounding between any, D is
            // negative: the roots cross there.
            false => Expr::function(Function::Maximum, vec![Expr::zero(), discriminant])?,
        };
        let square = square.sqrt()?;
        let sign = self.sign(root)?;
        let upper = match sign.is_one() {
            true => square,
            false => &s * &square,
        };
        let value = match (quadratic.lists[1][0].is_positive(), root.indeterminate) {
            // If both forms have a value all the way, the one in which no terms cancel at rest is
            // used.
            (false, [false, _]) | (true, [false, true]) => {
                Expr::divide(&(&upper - &q), &(&two * &r))?
            }
            (true, [_, false]) | (false, [true, false]) => {
                Expr::divide(&-&(&two * &p), &(&q + &upper))?
            }
            (_, [true, true]) => {
                let above = &(&upper * &(&r - &p)) - &(&q * &(&p + &r));
                let [over_r, over_sum] =
                    [&two * &r, &q + &upper].map(|divisor| &divisor * &divisor);
                Expr::divide(&(&two * &above), &(&over_r + &over_sum))?
            }
        };
        let definition = |(symbol, meaning): (Symbol, Expr)| Definition { symbol, meaning };
        let polynomials = self.letters.into_iter().zip(self.polynomials(quadratic));
        let polynomials = polynomials.map(|(symbol, own)| (symbol, Expr::from(&own)));
        let sign = (!sign.is_one()).then_some((self.letters[3], sign));
        Ok((value, polynomials.chain(sign).map(definition).collect()))
    }

    /// P, Q and R as polynomials in the symbols; in units of the root of D at rest where they are
    /// too long for doubles.
    fn polynomials(&self, quadratic: &Quadratic) -> [Polynomial; 3] {
        /// Binary digits.
        const LONG: u64 = 400;
        let longest = quadratic.lists.iter().flatten().map(Integer::bits).max().unwrap_or(0);
        let unit = match longest > LONG {
            true => quadratic.slope_at_zero(),
            false => Integer::one(),
        };
        quadratic.lists.each_ref().map(|list| {
            let mut sum = Polynomial::zero();
            for (power, number) in (0..).zip(list) {
                sum.add_term(
                    self.variable.power(power),
                    Rational::new(number.clone(), unit.clone()),
                );
            }
            sum
        })
    }

    /// The factor of the root of D: one up to the first crossing, not real beyond an end.
    fn sign(&self, root: &RootCourse) -> Result<Expr, ExprError> {
        let s = Expr::from(&Polynomial::term(self.variable.clone(), Rational::one()));
        let before = |place: &Rational| -> Result<Expr, ExprError> {
            let ahead = &Expr::number(place.clone()) - &s;
            let ahead = if place.is_negative() { -&ahead } else { ahead };
            Expr::function(Function::Sign, vec![ahead])
        };
        let mut sign = Expr::one();
        for place in &root.crossings {
            sign = &sign * &before(&short(place))?;
        }
        // The root of D as it is written stays real beyond these ends, so a factor has to end it.
        let crosses = !root.crossings.is_empty();
        for (place, _, _) in root.ends.iter().filter(|(_, _, says_so)| crosses || !says_so) {
            sign = &sign * &before(&short(place))?.sqrt()?;
        }
        Ok(sign)
    }

    /// The note of the crossings and the ends of the root; `None` if there are none.
    fn note(&self, root: &RootCourse) -> Option<Note> {
        let mut crossings: Vec<f64> = root.crossings.iter().map(to_f64).collect();
        crossings.sort_by(|a, b| a.abs().total_cmp(&b.abs()));
        let ends: Vec<(f64, RootEnd)> =
            root.ends.iter().map(|(place, end, _)| (to_f64(place), *end)).collect();
        let says = !crossings.is_empty() || !ends.is_empty();
        says.then(|| {
            Note::Followed(FollowedRoot {
                variable: Expr::from(&Polynomial::term(self.variable.clone(), Rational::one())),
                sign: self.letters[3],
                crossings,
                ends,
            })
        })
    }

    /// The equations for the coefficients, with the numbers of this series in them, and their
    /// solution.
    fn linear_system(
        &self,
        series: &[Rational],
        quadratic: &Quadratic,
    ) -> Result<Vec<DerivationLine>, ExprError> {
        let [s, f] = self.short;
        let power = |k: usize| Expr::from(s).integer_power(k as i64);
        let in_powers = |numbers: &[Rational]| -> Result<Expr, ExprError> {
            let terms = numbers.iter().enumerate();
            let terms = terms.map(|(k, number)| Ok(&Expr::number(number.clone()) * &power(k)?));
            Ok(Expr::sum(terms.collect::<Result<Vec<_>, ExprError>>()?))
        };
        let square: Vec<Rational> =
            (0..series.len()).map(|n| (0..=n).map(|k| &series[k] * &series[n - k]).sum()).collect();
        let mut one = vec![Rational::zero(); series.len()];
        one[0] = Rational::one();
        let variable = Expr::from(&Polynomial::term(self.variable.clone(), Rational::one()));
        let name = |list: usize, k: usize| Expr::symbol(&format!("{}{k}", self.stems[list]));
        let mut lines = vec![
            DerivationLine::equation(s, variable).because("the series runs in"),
            DerivationLine::equation(f, in_powers(series)?)
                .because("over its first coefficient it begins"),
            DerivationLine::equation(Expr::from(f).integer_power(2)?, in_powers(&square)?),
        ];
        let [p, q, r] = [0, 1, 2].map(|list| {
            let terms = 0..quadratic.lists[list].len();
            let terms = terms.map(|k| Ok(&name(list, k) * &power(k)?));
            terms.collect::<Result<Vec<_>, ExprError>>().map(Expr::sum)
        });
        let [upper, middle, lower] = self.letters.first_chunk::<3>().copied().unwrap_or([s; 3]);
        for (letter, sum) in [(upper, p?), (middle, q?), (lower, r?)] {
            lines.push(DerivationLine::equation(letter, sum));
        }
        for n in 0..series.len() {
            let mut terms = vec![];
            for (list, numbers) in [&one[..], series, &square].into_iter().enumerate() {
                for k in 0..quadratic.lists[list].len().min(n + 1) {
                    terms.push(&Expr::number(numbers[n - k].clone()) * &name(list, k));
                }
            }
            let words = match n {
                0 => {
                    format!("in {upper} + {middle}*{f} + {lower}*{f}^2 each power of {s} vanishes")
                }
                _ => String::new(),
            };
            lines.push(DerivationLine::equation(Expr::sum(terms), Expr::zero()).because(words));
        }
        for (list, numbers) in quadratic.lists.iter().enumerate() {
            for (k, number) in numbers.iter().enumerate() {
                let words = match (list, k) {
                    (0, 0) => "up to a common factor",
                    _ => "",
                };
                let value = Expr::number(Rational::from_integer(number.clone()));
                lines.push(DerivationLine::equation(name(list, k), value).because(words));
            }
        }
        Ok(lines)
    }
}

/// A short fraction so near to `place` that only a value within rounding of it can lie on the wrong
/// side.
fn short(place: &Rational) -> Rational {
    let tolerance =
        place.abs() * Rational::new(Integer::one(), Integer::from(10_000_000_000_000_i64));
    convergent(place, &tolerance)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn derived(equation: &str, degrees: [u32; 3]) -> Result<Solution, Refusal> {
        let [p, q, r] = degrees;
        let options = Options {
            method: Some(METHOD),
            degrees: Some(Degrees::Quadratic(p, q, r)),
            ..Options::default()
        };
        crate::method::solve(&Oscillator::parse(equation).unwrap(), &options)
    }

    /// The frequencies of Toda's and Morse's forces have no term in A: their default is of higher
    /// degree, and that of the series of order 12 near rest.
    #[test]
    fn without_degrees_there_is_an_answer() {
        for equation in ["x'' + 1 - exp(-x) = 0", "x'' + exp(-x) - exp(-2*x) = 0"] {
            let oscillator = Oscillator::parse(equation).unwrap();
            let by = |method, order| {
                let options = Options { method: Some(method), order, ..Options::default() };
                crate::method::solve(&oscillator, &options)
                    .unwrap_or_else(|refusal| panic!("{equation}: {refusal}"))
            };
            let (found, series) = (by(METHOD, None), by(Method::LindstedtPoincare, Some(12)));
            assert_eq!(found.degrees, Some(Degrees::Quadratic(2, 2, 2)), "{equation}");
            for amplitude in [-0.2, 0.1, 0.2] {
                let [found, series] =
                    [&found, &series].map(|solution| at(solution, &[("A", amplitude)]).unwrap());
                assert!((found / series - 1.0).abs() < 1e-7, "{equation}: {found} {series}");
            }
        }
        assert!(derived("x'' + 1 - exp(-x) = 0", [1, 1, 1]).is_err());
    }

    fn at(solution: &Solution, values: &[(&str, f64)]) -> Option<f64> {
        solution.frequency_squared_at(&|name| {
            let found = values.iter().find(|(own, _)| *own == name.name());
            found.map(|(_, value)| *value)
        })
    }

    fn of(series: &[Rational], degrees: [usize; 3]) -> Quadratic {
        Quadratic::from_series(series, degrees).unwrap_or_else(|reason| panic!("{reason}"))
    }

    /// The series of the root of `P + Q f + R f^2` that is one at zero, by Newton's method on its
    /// coefficients.
    fn root_series(lists: [&[i64]; 3], length: usize) -> Vec<Rational> {
        let at = |list: usize, k: usize| {
            Rational::from_integer(lists[list].get(k).copied().unwrap_or(0).into())
        };
        let slope = at(1, 0) + at(2, 0) + at(2, 0);
        let mut f = vec![Rational::one()];
        for n in 1..length {
            f.push(Rational::zero());
            let mut rest = at(0, n);
            for k in 0..=n {
                rest += at(1, k) * &f[n - k];
                let square: Rational = (0..=n - k).map(|i| &f[i] * &f[n - k - i]).sum();
                rest += at(2, k) * square;
            }
            f[n] = -rest / &slope;
        }
        f
    }

    #[test]
    fn an_algebraic_function_is_its_own_approximant() {
        let lists: [&[i64]; 3] = [&[-3, 2, 5], &[2, 0, -7], &[1, 4, 1]];
        let found = of(&root_series(lists, 8), [2, 2, 2]);
        let expected =
            lists.map(|list| list.iter().map(|number| Integer::from(*number)).collect::<Vec<_>>());
        assert_eq!(found.lists, expected);
    }

    /// Two roots that cross: `(f - 1 - s)(f - 3 + s) = 0` at s = 1, exactly; where they nearly do,
    /// at the middle of the gap.
    #[test]
    fn roots_that_cross_go_straight_on() {
        for gap in [0, 1, -1] {
            // (f - 1 - s)(f - 3 + s) + gap s/10^8: all but crossing.
            let scale = 100_000_000;
            let lists: [Vec<i64>; 3] =
                [vec![-3 * scale, -2 * scale + gap, scale], vec![4 * scale], vec![-scale]];
            let quadratic = Quadratic {
                lists: lists.map(|list| list.into_iter().map(Integer::from).collect()),
            };
            let followed = quadratic.followed(&[1, -1], Interrupt::default()).expect("a way");
            assert_eq!(followed.crossings.len(), 1, "{gap}");
            assert!((to_f64(&followed.crossings[0]) - 1.0).abs() < 1e-6, "{gap}");
            assert!(followed.ends.is_empty(), "{gap}");
            let words = ApproximantNames::new(&[], Monomial::power_of("s".into(), 1));
            let (value, definitions) = words.law(&quadratic, &followed).expect("a law");
            let value = |s: f64| {
                let known = [(Symbol::new("s"), s)].into();
                let letters = definitions
                    .iter()
                    .map(|own| (own.symbol, own.meaning.evaluate(&known).expect("a number")));
                value.evaluate(&letters.collect()).expect("a root")
            };
            for s in [-3.0, 0.0, 0.5, 1.5, 2.5, 10.0] {
                assert!((value(s) - 1.0 - s).abs() < 1e-6, "{gap}: {} at {s}", value(s));
            }
        }
    }

    /// `f^2 = 1 - s` ends at one, `f (1 - s) = 1` is infinite there, and both say so;
    /// `f^2 = (1 - s)(2 - s)/2` does not come back.
    #[test]
    fn a_root_that_ends_has_no_value_beyond() {
        let followed = |lists: [&[i64]; 3]| {
            let quadratic = Quadratic {
                lists: lists.map(|list| list.iter().map(|number| Integer::from(*number)).collect()),
            };
            let followed = quadratic.followed(&[1, -1], Interrupt::default()).expect("a way");
            let ends: Vec<(f64, RootEnd)> =
                followed.ends.iter().map(|(place, end, _)| (to_f64(place), *end)).collect();
            let words = ApproximantNames::new(&[], Monomial::power_of("s".into(), 1));
            let (value, definitions) = words.law(&quadratic, &followed).expect("a law");
            let value = move |s: f64| {
                let known = [(Symbol::new("s"), s)].into();
                let letters = definitions
                    .iter()
                    .map(|own| Some((own.symbol, own.meaning.evaluate(&known).ok()?)));
                value.evaluate(&letters.collect::<Option<_>>()?).ok()
            };
            (ends, value)
        };
        let (ends, value) = followed([&[-1, 1], &[0], &[1]]);
        assert_eq!(ends, [(1.0, RootEnd::Meets)]);
        assert!(
            value(0.75).is_some_and(|found| (found - 0.5).abs() < 1e-15) && value(1.5).is_none()
        );
        let (ends, value) = followed([&[-2, 3, -1], &[0], &[2]]);
        assert_eq!(ends, [(1.0, RootEnd::Meets)]);
        assert!(value(0.5).is_some() && value(1.5).is_none() && value(3.0).is_none());
        // f^2 (1 - s) - 2 f s - 1: one root is infinite at s = 1, that with which it begins.
        let (ends, value) = followed([&[-1], &[0, -2], &[1, -1]]);
        assert_eq!(ends, [(1.0, RootEnd::Infinite)]);
        assert!(value(0.5).is_some() && value(1.5).is_none());
        assert!(value(-5.0).is_some_and(|f| (f * f * 6.0 + 10.0 * f - 1.0).abs() < 1e-12));
    }

    #[test]
    fn degrees_without_an_approximant_say_why() {
        for (equation, degrees, reason) in [
            ("x'' + 4*x = 0", [1, 1, 1], "does not depend"),
            ("x'' + x + b*x^3 + c*x^5 = 0", [1, 1, 1], "several combinations"),
            ("x'' + sin(x) = 0", [41, 1, 1], "[40/40/40]"),
        ] {
            let refusal = derived(equation, degrees).unwrap_err().to_string();
            assert!(refusal.contains(reason), "{refusal}");
        }
        let quotient = Options {
            method: Some(METHOD),
            degrees: Some(Degrees::Quotient(2, 1)),
            ..Options::default()
        };
        let pendulum = Oscillator::parse("x'' + sin(x) = 0").unwrap();
        let refusal = crate::method::solve(&pendulum, &quotient).unwrap_err().to_string();
        assert!(refusal.contains("it has three"), "{refusal}");
    }

    /// omega of Duffing's equation at eps A^2 = s is sqrt(1 + s) agm(1, sqrt(1 - s/(2 (1 + s)))),
    /// for a softening spring as well.
    #[test]
    fn the_elliptic_frequency_is_met() {
        let solution = derived("x'' + x + eps*x^3 = 0", [8, 8, 8]).unwrap();
        for (size, error) in [(-0.5, 1e-9), (0.5, 1e-13), (4.0, 1e-11), (100.0, 1e-8)] {
            let (mut a, mut g) = (1.0, f64::sqrt(1.0 - size / (2.0 * (1.0 + size))));
            for _ in 0..9 {
                (a, g) = ((a + g) / 2.0, f64::sqrt(a * g));
            }
            let omega = f64::sqrt(1.0 + size) * a;
            let found = at(&solution, &[("A", 1.0), ("eps", size)]).expect("a value").sqrt();
            assert!((found / omega - 1.0).abs() < error, "{size}: {found} {omega}");
        }
    }
}
