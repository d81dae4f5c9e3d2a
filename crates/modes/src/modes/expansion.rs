//! The orders of a nonlinear normal mode, over any ring.
//!
//! ```text
//! (K - k^2 lambda M) q_(n,k) = r_(n,k),    r_n = - f_n - sum_(0<j<n-1) W_j M q_(n-j)''
//! k = 1:  u^T (r_(n,1) + W_(n-1) M v) = 0   gives W_(n-1)
//! ```
//!
//! where `f_n` is the part of f at the power n of the amplitude, with `d/dt = omega d/dtheta`. The
//! unknowns are those of a [`Basis`]: the coordinates themselves, or of two coordinates in closed form
//! the modal ones, in which M is the unit matrix and every divisor a number or a name. What is left free by the first harmonic along v is fixed by the definition of the amplitude: with the
//! amplitude of the first harmonic `u^T M q_n` has none, with that of the start the first coordinate
//! of the linear mode is a at `theta = 0`. Products take `O(order^2 harmonics^2)` coefficient products
//! for each factor of a term.

use super::ModeError;
use super::free_system::ForceTerm;
use super::inverse::HarmonicInverse;
use crate::exact::{Polynomial, Ring};
use crate::interrupt::Supervision;
use crate::series::{Convolutions, FourierSeries, SeriesNode, sum_of_products};
use crate::solution::AmplitudeConvention;

/// The unknowns eta of an expansion, `q = V eta`, and the equations for them, `P (M q'' + K q + f) = 0`.
#[derive(Clone, Debug)]
pub(crate) struct Basis {
    /// V, a row for each coordinate.
    pub(super) coordinates: Vec<Vec<Polynomial>>,
    /// P, a row for each unknown.
    pub(super) projection: Vec<Vec<Polynomial>>,
    /// `P M V`.
    pub(super) mass: Vec<Vec<Polynomial>>,
    /// `P K V`.
    pub(super) stiffness: Vec<Vec<Polynomial>>,
    /// v in the unknowns.
    pub(super) shape: Vec<Polynomial>,
    /// `u^T/(u^T M v)` for the equations of the unknowns.
    pub(super) left: Vec<Polynomial>,
}

/// A mode order by order.
pub(super) struct Expansion<R: Ring> {
    /// `W_n`, from `W_0 = lambda` on.
    pub(super) frequency_squared: Vec<R::Element>,
    /// `q_n`, a series for each coordinate, from `q_1` on.
    pub(super) motion: Vec<Vec<FourierSeries<R>>>,
    /// The derivation, from the second order on; empty if it was not asked for.
    pub(super) steps: Vec<ExpansionStep<R>>,
}

/// An order of a derivation.
pub(super) struct ExpansionStep<R: Ring> {
    /// `r_n`, of each unknown, without what `W_(n-1)` adds.
    pub(super) right_sides: Vec<FourierSeries<R>>,
    /// The unknowns of this order.
    pub(super) unknowns: Vec<FourierSeries<R>>,
}

/// The question of an expansion.
pub(super) struct Question<'a> {
    /// The number of the mode, for refusals.
    pub(super) number: usize,
    /// lambda.
    pub(super) square: &'a Polynomial,
    pub(super) basis: &'a Basis,
    pub(super) force: &'a [Vec<ForceTerm>],
    /// The highest power of the amplitude in omega^2.
    pub(super) order: usize,
    pub(super) amplitude: AmplitudeConvention,
    /// Whether the derivation is kept.
    pub(super) steps: bool,
    pub(super) supervision: Supervision,
}

/// An expansion over a ring.
pub(super) struct OverRing<'a, R: Ring> {
    pub(super) question: &'a Question<'a>,
    pub(super) ring: R,
    /// A coefficient in the ring.
    pub(super) element: &'a dyn Fn(&Polynomial) -> R::Element,
    /// The change of each new coefficient: none, or rounding.
    pub(super) tidy: &'a dyn Fn(&R::Element) -> R::Element,
}

/// A term of f with its factors: a product of powers of the motion, and its power of omega^2.
struct Factors<R: Ring> {
    coefficient: FourierSeries<R>,
    degree: usize,
    product: SeriesNode,
}

impl<R: Ring> OverRing<'_, R> {
    /// Computes the orders, those that are reached if it is interrupted.
    ///
    /// # Errors
    /// [`ModeError::InternalResonance`].
    pub(super) fn expand(
        &self,
        inverse_of: &mut dyn FnMut(usize) -> Option<HarmonicInverse>,
    ) -> Result<Expansion<R>, ModeError> {
        let ring = &self.ring;
        let count = self.question.force.len();
        let vector = |entries: &[Polynomial]| -> Vec<R::Element> {
            entries.iter().map(self.element).collect()
        };
        let rows = |rows: &[Vec<Polynomial>]| -> Vec<Vec<R::Element>> {
            rows.iter().map(|row| vector(row)).collect()
        };
        let basis = self.question.basis;
        let (shape, left) = (vector(&basis.shape), vector(&basis.left));
        let [coordinates, projection, mass] =
            [&basis.coordinates, &basis.projection, &basis.mass].map(|of| rows(of));
        let mut convolutions = Convolutions::new(ring.clone());
        let leaves: Vec<[SeriesNode; 3]> =
            (0..count).map(|_| [(); 3].map(|()| convolutions.leaf())).collect();
        let square = convolutions.leaf();
        let terms = self.factors(&mut convolutions, &leaves, square);
        let first: Vec<FourierSeries<R>> = shape
            .iter()
            .map(|entry| {
                let wave = FourierSeries::cos(ring.clone(), 1);
                FourierSeries::constant(ring.clone(), entry.clone()).product(&wave)
            })
            .collect();
        let mut found = Expansion {
            frequency_squared: vec![(self.element)(self.question.square)],
            motion: vec![self.applied(&coordinates, &first)],
            steps: vec![],
        };
        let mut unknowns = vec![first];
        let mut inverses: Vec<Option<HarmonicInverse>> = Vec::new();
        self.question.supervision.progress.begin(self.question.order);
        for order in 2..=self.question.order + 1 {
            if order > 2 && self.question.supervision.interrupt.is_requested() {
                break;
            }
            // The last order of all series is that of q_(n-1) and W_(n-2).
            for (leaf, series) in leaves.iter().zip(&found.motion[order - 2]) {
                let velocity = series.derivative();
                let acceleration = velocity.derivative();
                for (leaf, series) in leaf.iter().zip([series.clone(), velocity, acceleration]) {
                    convolutions.push(*leaf, series);
                }
            }
            let last = found.frequency_squared[order - 2].clone();
            convolutions.push(square, FourierSeries::constant(ring.clone(), last));
            convolutions.advance(order - 2);
            let right = self.right_side(
                order,
                &terms,
                &convolutions,
                &found,
                &unknowns,
                [&projection, &mass],
            );
            let highest = right.iter().map(FourierSeries::highest_harmonic).max().unwrap_or(0);
            let mut cosines = vec![vec![ring.zero(); highest.max(1) + 1]; count];
            for harmonic in 0..=highest.max(1) {
                let force: Vec<R::Element> =
                    right.iter().map(|series| series.cosine(harmonic).mean().0).collect();
                if harmonic == 1 {
                    // What W balances is along M v, which the inverse of this harmonic passes over.
                    let mut secular = self.dot(&left, &force);
                    ring.negate(&mut secular);
                    found.frequency_squared.push((self.tidy)(&secular));
                }
                if force.iter().all(|entry| ring.is_certainly_zero(entry)) {
                    continue;
                }
                if inverses.len() <= harmonic {
                    inverses.resize(harmonic + 1, None);
                }
                if inverses[harmonic].is_none() {
                    inverses[harmonic] = inverse_of(harmonic);
                }
                let Some(inverse) = &inverses[harmonic] else {
                    return Err(ModeError::NotReal);
                };
                self.check_resonance(inverse, &force, harmonic, order)?;
                for (row, cosines) in inverse.entries.iter().zip(&mut cosines) {
                    cosines[harmonic] = (self.tidy)(&self.dot(&vector(row), &force));
                }
            }
            if self.question.amplitude == AmplitudeConvention::Initial {
                self.move_start(&mut cosines, &shape, &coordinates);
            }
            let next: Vec<FourierSeries<R>> = cosines
                .into_iter()
                .map(|cosines| FourierSeries::from_parts(ring.clone(), cosines, vec![]))
                .collect();
            found.motion.push(self.applied(&coordinates, &next));
            if self.question.steps {
                found.steps.push(ExpansionStep { right_sides: right, unknowns: next.clone() });
            }
            unknowns.push(next);
            self.question.supervision.progress.advance();
        }
        Ok(found)
    }

    /// The products of all terms, required as far as the highest order needs them.
    fn factors(
        &self,
        convolutions: &mut Convolutions<R>,
        leaves: &[[SeriesNode; 3]],
        square: SeriesNode,
    ) -> Vec<Vec<Factors<R>>> {
        let mut factor = |term: &ForceTerm| {
            let mut nodes: Vec<SeriesNode> = term
                .powers
                .iter()
                .map(|(coordinate, primes, exponent)| {
                    convolutions.power(leaves[*coordinate][*primes], *exponent)
                })
                .collect();
            let rates = u32::try_from(term.rates()).unwrap_or(u32::MAX);
            if rates > 0 {
                nodes.push(convolutions.power(square, rates));
            }
            let product =
                nodes.into_iter().reduce(|left, right| convolutions.product(left, right))?;
            let degree = term.degree();
            if let Some(needed) = (self.question.order + 1).checked_sub(degree) {
                convolutions.require(product, needed);
            }
            let coefficient = (self.element)(&term.coefficient);
            let coefficient = FourierSeries::constant(self.ring.clone(), coefficient);
            Some(Factors { coefficient, degree, product })
        };
        self.question
            .force
            .iter()
            .map(|terms| terms.iter().filter_map(&mut factor).collect())
            .collect()
    }

    /// `r_n`, of each unknown, without what `W_(n-1)` adds.
    fn right_side(
        &self,
        order: usize,
        terms: &[Vec<Factors<R>>],
        convolutions: &Convolutions<R>,
        found: &Expansion<R>,
        unknowns: &[Vec<FourierSeries<R>>],
        [projection, mass]: [&[Vec<R::Element>]; 2],
    ) -> Vec<FourierSeries<R>> {
        let force = |terms: &Vec<Factors<R>>| {
            let known = terms.iter().filter_map(|term| {
                let own = order.checked_sub(term.degree)?;
                Some((-1, &term.coefficient, convolutions.order(term.product, own)?))
            });
            sum_of_products(&self.ring, &known.collect::<Vec<_>>())
        };
        let forces: Vec<FourierSeries<R>> = terms.iter().map(force).collect();
        let mut right = self.applied(projection, &forces);
        for lower in 1..order.saturating_sub(1) {
            let square = &found.frequency_squared[lower];
            if self.ring.is_certainly_zero(square) {
                continue;
            }
            let scaled: Vec<Vec<R::Element>> = mass
                .iter()
                .map(|row| row.iter().map(|entry| self.ring.product(entry, square)).collect())
                .collect();
            let inertia = self.applied(&scaled, &unknowns[order - lower - 1]);
            for (sum, inertia) in right.iter_mut().zip(inertia) {
                *sum = sum.difference(&inertia.derivative().derivative());
            }
        }
        right
    }

    /// `rows * vector`.
    fn applied(
        &self,
        rows: &[Vec<R::Element>],
        vector: &[FourierSeries<R>],
    ) -> Vec<FourierSeries<R>> {
        let constant =
            |entry: &R::Element| FourierSeries::constant(self.ring.clone(), entry.clone());
        let row = |row: &Vec<R::Element>| {
            let factors: Vec<FourierSeries<R>> = row.iter().map(constant).collect();
            let products = factors.iter().zip(vector).map(|(factor, series)| (1, factor, series));
            sum_of_products(&self.ring, &products.collect::<Vec<_>>())
        };
        rows.iter().map(row).collect()
    }

    /// Refuses a force along a mode whose frequency this harmonic has.
    fn check_resonance(
        &self,
        inverse: &HarmonicInverse,
        force: &[R::Element],
        harmonic: usize,
        order: usize,
    ) -> Result<(), ModeError> {
        let Some((other, against)) = &inverse.resonant else { return Ok(()) };
        let is_zero = |left: &Vec<Polynomial>| {
            let left: Vec<R::Element> = left.iter().map(self.element).collect();
            self.ring.is_certainly_zero(&(self.tidy)(&self.dot(&left, force)))
        };
        match against.iter().all(is_zero) {
            true => Ok(()),
            false => Err(ModeError::InternalResonance {
                number: self.question.number,
                other: other + 1,
                ratio: harmonic,
                order,
            }),
        }
    }

    /// Moves the amplitude along the mode until its first coordinate starts from zero at this order.
    fn move_start(
        &self,
        cosines: &mut [Vec<R::Element>],
        shape: &[R::Element],
        coordinates: &[Vec<R::Element>],
    ) {
        let ring = &self.ring;
        let moves = |row: &&Vec<R::Element>| !ring.is_certainly_zero(&self.dot(row, shape));
        let Some(moving) = coordinates.iter().find(moves) else { return };
        let starts: Vec<R::Element> = cosines
            .iter()
            .map(|cosines| {
                let mut start = ring.zero();
                cosines.iter().for_each(|coefficient| ring.accumulate(&mut start, coefficient));
                start
            })
            .collect();
        let mut start = self.dot(moving, &starts);
        ring.negate(&mut start);
        for (cosines, entry) in cosines.iter_mut().zip(shape) {
            let change = ring.product(&start, entry);
            ring.add(&mut cosines[1], change);
        }
    }

    fn dot(&self, left: &[R::Element], right: &[R::Element]) -> R::Element {
        let mut sum = self.ring.zero();
        for (one, other) in left.iter().zip(right) {
            if !self.ring.is_certainly_zero(one) && !self.ring.is_certainly_zero(other) {
                self.ring.add(&mut sum, self.ring.product(one, other));
            }
        }
        sum
    }
}
