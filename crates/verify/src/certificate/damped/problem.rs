//! The equations of a certificate of damped motion as the theorem takes them: a limit cycle or a driven
//! motion of `x'' + g(x) x' + h(x) = 0`, approximately, and the equation and its derivatives along it.
//!
//! The unknowns are the cosines and sines of the coordinates, and `p = 1/omega` of a limit cycle
//! (`theorem.rs`).

use num_traits::Signed as _;

use super::super::force::{NoValue, along_all, is_even, is_odd};
use super::super::fourier_series::{BasisFunction, FourierSeries, WORKING};
use crate::exact::Integer;
use crate::exact::ball::Ball;
use crate::exact::bound::Bound;
use crate::expr::{Expr, ExprError};
use crate::symbol::Symbol;

/// Binary digits of a series that is used only to bound the size of a product.
pub(super) const ROUGH: i32 = 40;

/// Binary digits of a series of which a value is to be known to all digits of the stability.
const WORKING_DIGITS: i32 = 120;

/// The symbols of `cos(Omega t)` and `sin(Omega t)` in a driven force.
pub(super) fn waves_of_drive() -> [Symbol; 2] {
    ["c", "s"].map(Symbol::new)
}

/// A certificate in the form that the theorem takes, of a limit cycle or of a driven motion.
pub(super) struct DampedProblem<'a> {
    /// G, a row for each equation; each row is the derivative of a function of the positions.
    pub(super) damping: Vec<Vec<&'a Expr>>,
    /// h, one for each coordinate, with the symbols of the [drive](waves_of_drive) if there is one.
    pub(super) forces: Vec<&'a Expr>,
    /// The symbols of the coordinates.
    pub(super) coordinates: Vec<Symbol>,
    /// Number of drive periods in one period of the motion; `None` for a limit cycle, of which p is
    /// an unknown.
    pub(super) drive: Option<usize>,
    /// The place of the coordinate whose first harmonic has no sine in a limit cycle, which says
    /// where the cycle begins.
    pub(super) phase: usize,
    /// Whether the motion has odd harmonics alone.
    pub(super) odd: bool,
    /// X, approximately, one series for each coordinate.
    pub(super) motions: Vec<FourierSeries>,
    /// p, of a limit cycle approximately.
    pub(super) reciprocal: Ball,
    /// The last harmonic of the block.
    pub(super) highest: usize,
    /// The entries of the inverse, in units of `2^-inverse_bits`.
    pub(super) inverse: &'a [Vec<Integer>],
    pub(super) inverse_bits: usize,
    /// The weight of p is `2^sigma`, where it is an unknown.
    pub(super) sigma: i32,
}

/// A cosine or a sine of a coordinate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct CoordinateWave {
    pub(super) coordinate: usize,
    pub(super) function: BasisFunction,
}

impl CoordinateWave {
    /// Its harmonic.
    pub(super) const fn harmonic(self) -> usize {
        self.function.harmonic()
    }

    /// The square of its harmonic.
    pub(super) fn squared(self) -> u32 {
        self.function.squared()
    }

    /// The coefficient of this wave in the series of its coordinate.
    pub(super) fn of(self, series: &[FourierSeries]) -> Ball {
        series[self.coordinate].coefficient(self.function)
    }
}

impl DampedProblem<'_> {
    /// Whether p is an unknown.
    pub(super) const fn is_free(&self) -> bool {
        self.drive.is_none()
    }

    /// The step from one harmonic to the next.
    pub(super) const fn step(&self) -> usize {
        if self.odd { 2 } else { 1 }
    }

    /// The cosines and sines of some harmonics, coordinate by coordinate.
    pub(super) fn waves(
        &self,
        harmonics: impl Iterator<Item = usize> + Clone,
    ) -> impl Iterator<Item = CoordinateWave> {
        let functions = harmonics.flat_map(|k| [BasisFunction::Cosine(k), BasisFunction::Sine(k)]);
        let functions = functions.filter(|function| *function != BasisFunction::Sine(0));
        (0..self.coordinates.len()).flat_map(move |coordinate| {
            functions.clone().map(move |function| CoordinateWave { coordinate, function })
        })
    }

    /// The equations of the block. For a limit cycle the sine of the first harmonic comes first:
    /// among the unknowns p takes its place.
    pub(super) fn block(&self) -> Vec<CoordinateWave> {
        let harmonics = (usize::from(self.odd)..=self.highest).step_by(self.step());
        let waves = self.waves(harmonics);
        match self.is_free() {
            true => {
                let phase = self.phase_wave();
                [phase].into_iter().chain(waves.filter(|wave| *wave != phase)).collect()
            }
            false => waves.collect(),
        }
    }

    /// The wave whose coefficient is zero in a limit cycle.
    pub(super) const fn phase_wave(&self) -> CoordinateWave {
        CoordinateWave { coordinate: self.phase, function: BasisFunction::Sine(1) }
    }

    /// The values of an expression along motions of all coordinates.
    pub(super) fn values_along(
        &self,
        expression: &Expr,
        motions: &[FourierSeries],
    ) -> Result<FourierSeries, NoValue> {
        let places = self.coordinates.iter().copied().zip(motions);
        let Some(periods) = self.drive else {
            return along_all(expression, &places.collect::<Vec<_>>());
        };
        let mut wave = vec![Ball::zero(); periods];
        wave.push(WORKING.integer(1));
        let [cosine, sine] = waves_of_drive();
        let own = [
            (cosine, &FourierSeries::exactly(wave.clone(), vec![])),
            (sine, &FourierSeries::exactly(vec![], wave)),
        ];
        along_all(expression, &places.chain(own).collect::<Vec<_>>())
    }

    /// The values of the entries of a matrix along motions of all coordinates.
    pub(super) fn matrix_along<Entry: std::borrow::Borrow<Expr>>(
        &self,
        matrix: &[Vec<Entry>],
        motions: &[FourierSeries],
    ) -> Result<Vec<Vec<FourierSeries>>, NoValue> {
        let entry = |entry: &Entry| self.values_along(entry.borrow(), motions);
        matrix.iter().map(|row| row.iter().map(entry).collect()).collect()
    }

    /// The derivatives of expressions by all coordinates: a row for each.
    pub(super) fn slopes<Entry: std::borrow::Borrow<Expr>>(
        &self,
        expressions: &[Entry],
    ) -> Result<Vec<Vec<Expr>>, ExprError> {
        let row = |expression: &Entry| {
            self.coordinates.iter().map(|name| expression.borrow().differentiate(*name)).collect()
        };
        expressions.iter().map(row).collect()
    }

    /// Whether each row of the damping is the derivative of a function of the positions, as the
    /// theorem takes it: `dG_ij/dq_l = dG_il/dq_j`.
    pub(super) fn has_potential_damping(&self) -> Result<bool, ExprError> {
        for row in &self.damping {
            let slopes = self.slopes(row)?;
            for (j, own) in slopes.iter().enumerate() {
                for (l, slope) in own.iter().enumerate().skip(j + 1) {
                    if !(slope - &slopes[l][j]).expand()?.is_zero() {
                        return Ok(false);
                    }
                }
            }
        }
        Ok(true)
    }

    /// The motions of all coordinates in so many binary digits, and all within this distance of
    /// them.
    pub(super) fn ball(&self, digits: i32, radius: Bound) -> Vec<FourierSeries> {
        let motions = self.motions.iter().cloned();
        motions.map(|motion| motion.shortened(digits).widened(radius)).collect()
    }

    /// p of every motion within this radius: with a drive exactly the one that it gives.
    pub(super) fn reciprocal_within(&self, radius: Bound) -> Ball {
        let mut reciprocal = self.reciprocal.clone();
        if self.is_free() {
            reciprocal.radius += radius.over(Bound::power_of_two(self.sigma).value());
        }
        reciprocal
    }

    /// The coefficients `p G(X)` and `p^2 h'(X)` of the variational equation along every motion
    /// within this radius, from so many binary digits of X; `None` if they have no value.
    pub(super) fn variational(&self, digits: i32, radius: Bound) -> Option<[SeriesMatrix; 2]> {
        let ball = self.ball(digits, radius);
        let slopes = self.slopes(&self.forces).ok()?;
        let damping = self.matrix_along(&self.damping, &ball).ok()?;
        let slopes = self.matrix_along(&slopes, &ball).ok()?;
        let p = FourierSeries::constant(self.reciprocal_within(radius));
        let squared = p.product(&p);
        let times = |factor: &FourierSeries, matrix: Vec<Vec<FourierSeries>>| {
            let row = |row: Vec<FourierSeries>| row.iter().map(|own| factor.product(own)).collect();
            matrix.into_iter().map(row).collect()
        };
        Some([times(&p, damping), times(&squared, slopes)])
    }

    /// `X'` and `p^2 h(X)` at theta = 0 of every motion within this radius of a limit cycle
    /// (`stability.rs`); `None` if they have no value.
    pub(super) fn rates_at_zero(&self, radius: Bound) -> Option<[Vec<Ball>; 2]> {
        let all = |matrix: &SeriesMatrix| largest_column(matrix, FourierSeries::norm);
        let forces_along = |motions: &[FourierSeries]| -> Option<Vec<FourierSeries>> {
            self.forces.iter().map(|force| self.values_along(force, motions).ok()).collect()
        };
        let ball = self.ball(ROUGH, radius);
        let damping = self.matrix_along(&self.damping, &ball).ok()?;
        let slopes = self.matrix_along(&self.slopes(&self.forces).ok()?, &ball).ok()?;
        let own_damping = self.matrix_along(&self.damping, &self.motions).ok()?;
        let own_forces = forces_along(&self.motions)?;
        let velocities: Vec<FourierSeries> =
            self.motions.iter().map(FourierSeries::derivative).collect();
        let [p, within] = [self.reciprocal.clone(), self.reciprocal_within(radius)];
        let squared = FourierSeries::constant(WORKING.product(&p, &p));
        let p_series = FourierSeries::constant(p.clone());
        let (mut defect, mut drags, mut sizes) = (Bound::ZERO, Bound::ZERO, Bound::ZERO);
        for ((row, force), velocity) in own_damping.iter().zip(&own_forces).zip(&velocities) {
            let drag = image_of(row, &velocities);
            let bent = p_series.product(&drag).sum(&squared.product(force));
            defect += velocity.derivative().sum(&bent).norm();
            drags += drag.norm();
            sizes += force.norm();
        }
        let [known, most] = [&p, &within].map(|ball| WORKING.magnitude(ball));
        let change = radius.over(Bound::power_of_two(self.sigma).value());
        let apart = defect
            + most * all(&damping) * radius
            + change * drags
            + most * most * all(&slopes) * radius
            + (most + known) * change * sizes;
        let speeds = velocities.iter().map(|velocity| velocity.clone().widened(apart).at_zero());
        let within = WORKING.product(&within, &within);
        let forces = forces_along(&self.ball(WORKING_DIGITS, radius))?;
        let forces = forces.iter().map(|force| WORKING.product(&within, &force.at_zero()));
        Some([speeds.collect(), forces.collect()])
    }

    /// Whether half a period later the equation is its mirror image, and the motion has odd
    /// harmonics alone.
    pub(super) fn is_odd(&self) -> Result<bool, ExprError> {
        let mut letters = self.coordinates.clone();
        // Half a period of the motion is a whole number of drive periods, or a whole number and a
        // half.
        if self.drive.is_some_and(|periods| periods % 2 == 1) {
            letters.extend(waves_of_drive());
        }
        let waves = self.motions.iter().flat_map(|motion| [&motion.cosines, &motion.sines]);
        let mut even = waves.flat_map(|balls| balls.iter().step_by(2));
        Ok(even.all(Ball::is_zero) && self.is_mirror_image(&letters)?)
    }

    /// Returns whether the equation does not change if all these symbols change their sign.
    pub(super) fn is_mirror_image(&self, letters: &[Symbol]) -> Result<bool, ExprError> {
        for damping in self.damping.iter().flatten() {
            if !is_even(damping, letters)? {
                return Ok(false);
            }
        }
        for force in &self.forces {
            if !is_odd(force, letters)? {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Whether no state of rest and no motion of a shorter period lies within this radius. Always
    /// `true` where p is known, since no such claim is made then.
    pub(super) fn is_distinct(&self, radius: Bound, sigma: Bound) -> bool {
        let first = self.motions[self.phase].cosine(1);
        !self.is_free()
            || self.reciprocal.middle.is_positive()
                && radius.over(sigma.value()).value() < WORKING.distance_from_zero(&self.reciprocal)
                && first.middle.is_positive()
                && radius.value() < WORKING.distance_from_zero(&first)
    }
}

/// A matrix of series: a row for each equation, a column for each coordinate.
pub(super) type SeriesMatrix = Vec<Vec<FourierSeries>>;

/// The largest sum of a bound over a column of a matrix.
pub(super) fn largest_column<Entry>(
    matrix: &[Vec<Entry>],
    bound: impl Fn(&Entry) -> Bound,
) -> Bound {
    let columns = matrix.iter().map(Vec::len).max().unwrap_or(0);
    let column = |column: usize| -> Bound {
        matrix.iter().filter_map(|row| row.get(column)).map(&bound).sum()
    };
    (0..columns).map(column).fold(Bound::ZERO, Bound::max)
}

/// The sum of the products of two lists.
pub(super) fn image_of(row: &[FourierSeries], vector: &[FourierSeries]) -> FourierSeries {
    let parts = row.iter().zip(vector).map(|(entry, own)| entry.product(own));
    let nothing = || FourierSeries::exactly(vec![], vec![]);
    parts.reduce(|sum, part| sum.sum(&part)).unwrap_or_else(nothing)
}
