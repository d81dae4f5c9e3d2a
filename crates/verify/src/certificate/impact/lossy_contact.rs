//! Enclosures of a contact that loses energy, or whose force is a sum of powers, by a validated integration of its motion.
//!
//! The contact of Hunt and Crossley is `d'' = -sin(xc + d) - gamma d^n (1 + lambda d')` from the touch with the speed
//! v until d = 0 again. Its energy is not kept, so that there is no integral to take; a sum of powers stands in the
//! place of `gamma d^n` as well. With the depth `d = q^2` and
//! the variable s, `dt = q ds`, it is a system of analytic functions, through both touches:
//!
//! ```text
//! dq/ds = v/2,    dv/ds = -q (sin(xc + q^2) + gamma q^(2 n) (1 + lambda v)),    dt/ds = q
//! step:  y(s + h) = sum_(k <= N) c_k + c_(N+1)(Y)      c_k: coefficients in (s' - s)/h, by recurrences
//! Y:     y + [-1, 1] r with h |f(Y)| <= r              holds the motion on the step (Picard)
//! ```
//!
//! On every step v has one sign, or falls throughout: there is one deepest point, and one end. Both are roots of
//! the polynomials of a step between two certain signs.
//!
//! A spring with a dashpot that pulls, `d'' = -sin(xc + d) - gamma (d + lambda d')`, is the same with
//! `gamma (q^3 + lambda q v)` for `gamma q^(2 n + 1) (1 + lambda v)`. One that does not pull lets go where
//! `P = q^2 + lambda v` passes zero: positive on the whole of the steps before, falling throughout on that one. From
//! there the swing alone is followed to q = 0, P falling throughout, so that the barrier is not met again.
//!
//! In: place, stiffness, exponent and damping of the barrier, the speed. Out: depth, duration and exit speed as
//! balls. A contact takes some thirty steps.
//!
//! Sources: R. E. Moore, *Methods and Applications of Interval Analysis*, SIAM 1979, chapter 8; K. H. Hunt, F. R. E.
//! Crossley, J. Appl. Mech. 42 (1975) 440.

use super::NotEnclosed;
use super::contact::{is_positive, product, sine_and_cosine, sum};
use crate::certificate::fourier_series::WORKING;
use crate::exact::Integer;
use crate::exact::ball::Ball;
use crate::exact::bound::Bound;

/// Powers of a Taylor series that are kept.
const ORDER: usize = 48;

/// Binary exponent of the largest remainder of a step; a step with a larger one is halved.
const NEGLIGIBLE: i32 = -150;

/// A contact that loses energy, or whose force is a sum of powers.
pub(super) struct LossyContact {
    /// Place of the barrier.
    pub(super) barrier: Ball,
    /// gamma of each power of the depth, with p, two more than twice the exponent.
    pub(super) terms: Vec<(Ball, u32)>,
    /// lambda.
    pub(super) damping: Ball,
    /// The law of the loss.
    pub(super) law: LossLaw,
    /// The speed at the touch.
    pub(super) speed: Ball,
}

/// The law of a loss.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum LossLaw {
    /// The law of Hunt and Crossley: the elastic force times 1 + lambda d'.
    HuntCrossley,
    /// A dashpot beside a spring.
    Dashpot {
        /// Whether it pulls on the way out.
        pulls: bool,
    },
}

/// The part of a contact that is followed.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Leg {
    /// The barrier acts.
    Pressed,
    /// It has let go: the swing alone acts.
    Released,
}

/// The numbers of a contact.
pub(super) struct LossyContactEnds {
    /// The square root of the greatest depth.
    pub(super) root_of_depth: Ball,
    /// The duration.
    pub(super) duration: Ball,
    /// The speed at which the motion leaves the barrier.
    pub(super) exit_speed: Ball,
}

/// The states q, v and t as balls, or their series.
type States<T> = [T; 3];

/// The sign that all numbers of a ball have.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Sign {
    Positive,
    Negative,
    Uncertain,
}

fn sign(ball: &Ball) -> Sign {
    match (is_positive(ball), is_positive(&WORKING.scaled(ball, -1))) {
        (true, _) => Sign::Positive,
        (_, true) => Sign::Negative,
        _ => Sign::Uncertain,
    }
}

/// A step of the integration.
struct Step {
    /// The polynomials of the states in u, the part of the step.
    series: States<Vec<Ball>>,
    /// The remainders beyond the polynomials.
    remainders: States<Bound>,
    /// The signs of v and of dv/ds on the whole step.
    signs: [Sign; 2],
    /// The signs of the push P = q^2 + lambda v and of dP/dt on the whole step.
    push: [Sign; 2],
}

impl Step {
    /// A state at a part of the step.
    fn at(&self, state: usize, part: &Ball) -> Ball {
        let terms = self.series[state].iter().rev();
        let mut value = terms.fold(Ball::zero(), |value, term| sum(&product(&value, part), term));
        value.radius += self.remainders[state];
        value
    }

    fn end(&self) -> States<Ball> {
        let whole = WORKING.integer(1);
        [0, 1, 2].map(|state| self.at(state, &whole))
    }

    /// The part of the step at which a quantity passes zero from above, which it does once.
    fn root(&self, quantity: impl Fn(&Ball) -> Ball) -> Ball {
        const HALVINGS: usize = 200;
        let (mut low, mut bits) = (Integer::from(0), 0);
        for _ in 0..HALVINGS {
            let middle = Integer::from(2) * &low + Integer::from(1);
            let value = quantity(&WORKING.dyadic(&middle, bits + 1));
            low = match sign(&value) {
                Sign::Positive => middle,
                Sign::Negative => Integer::from(2) * &low,
                Sign::Uncertain => break,
            };
            bits += 1;
        }
        // The root lies within [low, low + 1] in units of 2^-bits.
        let middle = Integer::from(2) * &low + Integer::from(1);
        let half = WORKING.magnitude(&WORKING.dyadic(&Integer::from(1), bits + 1));
        let mut root = WORKING.dyadic(&middle, bits + 1);
        root.radius += half;
        root
    }
}

impl LossyContact {
    /// Follows the contact from the touch to its end.
    ///
    /// # Errors
    /// [`NotEnclosed::Digits`] where no step is short enough, or the contact does not end;
    /// [`NotEnclosed::PressedAgain`] where a barrier that has let go may be met again.
    pub(super) fn follow(&self) -> Result<LossyContactEnds, NotEnclosed> {
        const MOST_STEPS: usize = 2_000;
        let mut states = [Ball::zero(), self.speed.clone(), Ball::zero()];
        let mut deepest: Option<Ball> = None;
        let lets_go =
            self.law == LossLaw::Dashpot { pulls: false } && sign(&self.damping) == Sign::Positive;
        let mut leg = Leg::Pressed;
        let first = self.first_halvings().ok_or(NotEnclosed::Digits)?;
        let mut halvings = first;
        for _ in 0..MOST_STEPS {
            let step = self.step(&states, halvings, leg);
            let ended = step.and_then(|step| {
                let end = step.end();
                let is_loose = match (lets_go, leg, step.push) {
                    (false, ..) | (true, Leg::Pressed, [Sign::Positive, _]) => false,
                    (true, Leg::Released, [_, Sign::Negative]) => false,
                    (true, Leg::Pressed, [_, Sign::Negative]) => match sign(&self.push(&end)) {
                        Sign::Positive => false,
                        Sign::Negative => true,
                        Sign::Uncertain => return None,
                    },
                    _ => return None,
                };
                let turns = match (step.signs, &deepest) {
                    ([Sign::Positive, _], None) | ([Sign::Negative, _], Some(_)) => false,
                    ([_, Sign::Negative], None) => match sign(&end[1]) {
                        Sign::Positive => false,
                        Sign::Negative => true,
                        Sign::Uncertain => return None,
                    },
                    _ => return None,
                };
                let is_out = match (turns || deepest.is_some(), sign(&end[0])) {
                    (true, Sign::Uncertain) => return None,
                    (true, Sign::Negative) => true,
                    _ => false,
                };
                // A contact that turns, lets go or ends on one step is followed on shorter ones.
                let happenings = [turns, is_loose, is_out].into_iter().filter(|own| *own).count();
                (happenings <= 1).then_some((step, end, [turns, is_loose, is_out]))
            });
            let Some((step, end, [turns, is_loose, is_out])) = ended else {
                // Between two signs that are not certain a step ends elsewhere.
                halvings += 1;
                if halvings > first + 40 {
                    return Err(match leg {
                        Leg::Pressed => NotEnclosed::Digits,
                        Leg::Released => NotEnclosed::PressedAgain,
                    });
                }
                continue;
            };
            if turns {
                deepest = Some(step.at(0, &step.root(|part| step.at(1, part))));
            }
            if is_loose {
                let part =
                    step.root(|part| self.push(&[0, 1, 2].map(|state| step.at(state, part))));
                states = [0, 1, 2].map(|state| step.at(state, &part));
                leg = Leg::Released;
                continue;
            }
            if let (true, Some(root_of_depth)) = (is_out, deepest.clone()) {
                let part = step.root(|part| step.at(0, part));
                let duration = step.at(2, &part);
                let exit_speed = WORKING.scaled(&step.at(1, &part), -1);
                return Ok(LossyContactEnds { root_of_depth, duration, exit_speed });
            }
            states = end;
            halvings = halvings.saturating_sub(1).max(first);
        }
        Err(NotEnclosed::Digits)
    }

    /// The number of halvings of 1 that give an eighth of the time s in which an elastic contact would reach its
    /// deepest point at the speed of the touch, by the power that stops it first.
    fn first_halvings(&self) -> Option<u32> {
        let speed = WORKING.nearest(&self.speed);
        let deepest = |(stiffness, power): &(Ball, u32)| {
            let degree = f64::from(*power);
            (0.25 * degree * speed * speed / WORKING.nearest(stiffness)).powf(1.0 / degree)
        };
        let deepest = self.terms.iter().map(deepest).fold(f64::INFINITY, f64::min);
        let eighth = 0.25 * deepest / speed;
        let halvings = (-eighth.log2()).ceil();
        (halvings.is_finite() && halvings.abs() < 500.0).then_some(halvings.max(0.0) as u32)
    }

    /// The push P = q^2 + lambda v, the force of a spring with a dashpot over gamma.
    fn push(&self, [q, v, _]: &States<Ball>) -> Ball {
        sum(&product(q, q), &product(&self.damping, v))
    }

    /// dP/dt = v + lambda dv/dt.
    fn push_rate(&self, [q, v, _]: &States<Ball>, push: &Ball, leg: Leg) -> Option<Ball> {
        let [swing, _] = sine_and_cosine(&sum(&self.barrier, &product(q, q)))?;
        let force = match leg {
            Leg::Released => swing,
            Leg::Pressed => sum(&swing, &product(&self.terms.first()?.0, push)),
        };
        Some(sum(v, &WORKING.scaled(&product(&self.damping, &force), -1)))
    }

    /// The step of the length `2^-halvings`; `None` if it is too long.
    fn step(&self, states: &States<Ball>, halvings: u32, leg: Leg) -> Option<Step> {
        const TRIALS: usize = 6;
        let length = WORKING.dyadic(&Integer::from(1), halvings as usize);
        // Coefficients of order 1 are rates times the length.
        let change = |states: &States<Ball>| -> Option<States<Ball>> {
            let [q, v, t] = self.series(states, &length, 1, leg)?;
            Some([q, v, t].map(|series| series[1].clone()))
        };
        let mut reach = change(states)?.map(|own| {
            let size = WORKING.magnitude(&own);
            size + size + Bound::power_of_two(-200)
        });
        let around = |reach: &States<Bound>| -> States<Ball> {
            std::array::from_fn(|state| {
                let mut ball = states[state].clone();
                ball.radius += reach[state];
                ball
            })
        };
        let mut found = None;
        for _ in 0..TRIALS {
            let whole = around(&reach);
            let changes = change(&whole)?;
            let sizes = [0, 1, 2].map(|state| WORKING.magnitude(&changes[state]));
            if (0..3).all(|state| sizes[state] <= reach[state]) {
                found = Some((whole, changes));
                break;
            }
            for (reach, size) in reach.iter_mut().zip(sizes) {
                *reach = reach.max(size + size / 4);
            }
        }
        let (whole, changes) = found?;
        let last = self.series(&whole, &length, ORDER + 1, leg)?;
        let remainders = [0, 1, 2].map(|state| WORKING.magnitude(&last[state][ORDER + 1]));
        if remainders.iter().any(|own| *own > Bound::power_of_two(NEGLIGIBLE)) {
            return None;
        }
        let series = self.series(states, &length, ORDER, leg)?;
        let push = self.push(&whole);
        let push_rate = self.push_rate(&whole, &push, leg)?;
        Some(Step {
            series,
            remainders,
            signs: [sign(&whole[1]), sign(&changes[1])],
            push: [sign(&push), sign(&push_rate)],
        })
    }

    /// The coefficients of the states up to an order, in the part u of a step of this length.
    fn series(
        &self,
        [q, v, t]: &States<Ball>,
        length: &Ball,
        order: usize,
        leg: Leg,
    ) -> Option<States<Vec<Ball>>> {
        let products: Vec<Vec<[usize; 2]>> =
            self.terms.iter().map(|(_, power)| factors_of_power(power - 1)).collect();
        let (mut q, mut v, mut t) = (vec![q.clone()], vec![v.clone()], vec![t.clone()]);
        let mut powers: Vec<Vec<Vec<Ball>>> =
            products.iter().map(|own| vec![vec![]; own.len()]).collect();
        let mut elastic: Vec<Ball> = vec![];
        let (mut sine, mut cosine): (Vec<Ball>, Vec<Ball>) = (vec![], vec![]);
        for k in 0..order {
            for (powers, products) in powers.iter_mut().zip(&products) {
                for (index, [left, right]) in products.iter().enumerate() {
                    let factor = |own: &usize| if *own == 0 { &q } else { &powers[*own - 1] };
                    let next = coefficient(factor(left), factor(right), k);
                    powers[index].push(next);
                }
            }
            // The first product is q^2.
            let square = powers.first()?.first()?;
            let [next_sine, next_cosine] = match u32::try_from(k).ok()? {
                0 => sine_and_cosine(&sum(&self.barrier, &square[0]))?,
                divisor => {
                    let weighted = |waves: &[Ball]| {
                        let terms = (1..=k).map(|j| {
                            let weight = i64::try_from(j).unwrap_or(i64::MAX);
                            WORKING.scaled(&product(&square[j], &waves[k - j]), weight)
                        });
                        let total = terms.fold(Ball::zero(), |total, term| sum(&total, &term));
                        WORKING.divided(&total, divisor)
                    };
                    [weighted(&cosine), WORKING.scaled(&weighted(&sine), -1)]
                }
            };
            sine.push(next_sine);
            cosine.push(next_cosine);
            let terms = self.terms.iter().zip(&powers);
            let force_of = |((stiffness, _), powers): (&(Ball, u32), &Vec<Vec<Ball>>)| {
                Some(product(stiffness, &powers.last()?[k]))
            };
            let each = terms.map(force_of).collect::<Option<Vec<Ball>>>()?;
            elastic.push(each.iter().fold(Ball::zero(), |total, term| sum(&total, term)));
            let swing = coefficient(&q, &sine, k);
            let force = match leg {
                Leg::Released => swing,
                Leg::Pressed => {
                    let lost = match self.law {
                        LossLaw::Dashpot { .. } => {
                            product(&self.terms.first()?.0, &coefficient(&q, &v, k))
                        }
                        LossLaw::HuntCrossley => coefficient(&elastic, &v, k),
                    };
                    let barrier = sum(&elastic[k], &product(&self.damping, &lost));
                    sum(&swing, &barrier)
                }
            };
            let divisor = u32::try_from(k + 1).ok()?;
            let of_rate = |rate: &Ball| WORKING.divided(&product(length, rate), divisor);
            let next = [
                of_rate(&WORKING.divided(&v[k], 2)),
                of_rate(&WORKING.scaled(&force, -1)),
                of_rate(&q[k]),
            ];
            for (series, next) in [&mut q, &mut v, &mut t].into_iter().zip(next) {
                series.push(next);
            }
        }
        Some([q, v, t])
    }
}

/// The coefficient of order k of a product.
fn coefficient(left: &[Ball], right: &[Ball], k: usize) -> Ball {
    (0..=k).fold(Ball::zero(), |total, j| sum(&total, &product(&left[j], &right[k - j])))
}

/// The products that lead to a power of q, 2 or higher: 0 stands for q, i for the i-th product. The first is q^2.
fn factors_of_power(exponent: u32) -> Vec<[usize; 2]> {
    let mut products: Vec<[usize; 2]> = vec![];
    let mut known = 0;
    for bit in (0..exponent.max(2).ilog2()).rev() {
        products.push([known, known]);
        known = products.len();
        if exponent >> bit & 1 == 1 {
            products.push([known, 0]);
            known = products.len();
        }
    }
    products
}

#[cfg(test)]
mod tests {
    use super::factors_of_power;

    #[test]
    fn products_lead_to_every_power() {
        for exponent in 2..=41_u32 {
            let mut degrees = vec![1];
            for [left, right] in factors_of_power(exponent) {
                degrees.push(degrees[left] + degrees[right]);
            }
            assert_eq!(degrees.last(), Some(&exponent));
            assert_eq!(degrees[1], 2);
        }
    }
}
