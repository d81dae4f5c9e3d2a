//! The normal form of a map where a pair of multipliers passes the unit circle.
//!
//! ```text
//! P(z) = A z + B(z, z)/2 + C(z, z, z)/6 + ...,      A q = e^(i theta) q,   A^T p = e^(-i theta) p,   p^H q = 1
//! w -> e^(i theta) w (1 + d w w^*) + ...
//! Re d = 1/2 Re e^(-i theta) p^H (C(q, q, q^*) + 2 B(q, (1 - A)^(-1) B(q, q^*)) + B(q^*, (e^(2 i theta) - A)^(-1) B(q, q)))
//! ```
//!
//! Where Re d is negative, an attracting closed curve comes off on the side on which the fixed point
//! repels (Y. A. Kuznetsov, *Elements of Applied Bifurcation Theory*, Springer 2004, sections 4.7
//! and 5.4). In: the map as a closure and its derivative at the fixed point. B and C are taken from central
//! differences along real directions, some fifty values of the map for each step size.

use nalgebra::{DMatrix, DVector};
use num_complex::Complex;

/// The cubic term of a map at a pair of multipliers on the unit circle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CubicTerm {
    /// The real part of d, for an eigenvector q of length one.
    Coefficient(f64),
    /// The multipliers are roots of one of an order up to four: terms of lower order decide too.
    StrongResonance,
}

type ComplexVector = DVector<Complex<f64>>;

/// The map near its fixed point, in coordinates that are zero there; `None` where it has no value.
pub type LocalMap<'a> = dyn Fn(&DVector<f64>) -> Option<DVector<f64>> + 'a;

/// The cubic term of a map, with this derivative at its fixed point, at the pair of multipliers near
/// this one. The coordinates are to be of the size one where the map is no longer linear. `None` if no
/// `agreeing` consecutive step sizes, two at least, give the same coefficient, as where the map is not smooth:
/// a term `abs(z)^p` of p < 3 in it has differences that grow without bound.
///
/// ```
/// # use lindstedt_numeric as lindstedt;
/// use lindstedt::numeric::normal_form::{CubicTerm, cubic_term};
/// use nalgebra::{DMatrix, DVector};
/// use num_complex::Complex;
///
/// // A turn by one radian, shortened by the square of the distance: w -> e^i w (1 - w w^*/2), where
/// // abs(z)^2 = 2 w w^*.
/// let (sine, cosine) = 1.0_f64.sin_cos();
/// let turn = DMatrix::from_row_slice(2, 2, &[cosine, -sine, sine, cosine]);
/// let map = |z: &DVector<f64>| Some(&turn * z * (1.0 - 0.25 * z.norm_squared()));
/// let Some(CubicTerm::Coefficient(found)) = cubic_term(&map, &turn, Complex::from_polar(1.0, 1.0), 2) else {
///     return Err("none");
/// };
/// assert!((found + 0.5).abs() < 1e-6);
/// # Ok::<(), &str>(())
/// ```
pub fn cubic_term(
    map: &LocalMap,
    derivative: &DMatrix<f64>,
    multiplier: Complex<f64>,
    agreeing: usize,
) -> Option<CubicTerm> {
    /// Distance from one of a power of the multiplier, below which it counts as a root of one.
    const RESONANT: f64 = 0.01;
    /// Steps of the differences, each half of the one before.
    const FIRST_STEP: f64 = 0.02;
    const HALVINGS: i32 = 5;
    /// Relative difference of two coefficients below which they are the same.
    const SAME: f64 = 0.1;
    let one = Complex::from(1.0);
    let turn = multiplier / multiplier.norm();
    if (1..=4).any(|order| (turn.powi(order) - one).norm() < RESONANT) {
        return Some(CubicTerm::StrongResonance);
    }
    let vectors = Eigenvectors::new(derivative, turn)?;
    let centre = map(&DVector::zeros(derivative.nrows()))?;
    let (mut before, mut alike) = (f64::NAN, 1);
    for halving in 0..=HALVINGS {
        let step = FIRST_STEP * 0.5_f64.powi(halving);
        let differences = Differences { map, step, centre: centre.clone() };
        let now = coefficient(&differences, derivative, &vectors, turn)?;
        let same = (now - before).abs() < SAME * now.abs().min(before.abs());
        alike = if same { alike + 1 } else { 1 };
        if alike >= agreeing.max(2) {
            return Some(CubicTerm::Coefficient(now));
        }
        before = now;
    }
    None
}

/// The eigenvectors of a pair of multipliers.
struct Eigenvectors {
    /// q, of length one.
    right: ComplexVector,
    /// p, with p^H q = 1.
    left: ComplexVector,
}

impl Eigenvectors {
    fn new(derivative: &DMatrix<f64>, turn: Complex<f64>) -> Option<Self> {
        let right = eigenvector(derivative, turn)?;
        let left = eigenvector(&derivative.transpose(), turn.conj())?;
        let product = left.dotc(&right);
        let left = left / product.conj();
        left.iter().all(|value| value.is_finite()).then_some(Self { right, left })
    }
}

/// The eigenvector of length one whose eigenvalue is nearest to a number, by inverse iteration.
fn eigenvector(matrix: &DMatrix<f64>, eigenvalue: Complex<f64>) -> Option<ComplexVector> {
    const ITERATIONS: usize = 4;
    /// Distance of the shift from the eigenvalue, so that the equations are not singular.
    const ASIDE: f64 = 1e-9;
    let n = matrix.nrows();
    let factors = shifted(matrix, eigenvalue * (1.0 + ASIDE)).lu();
    // No direction is at right angles to this one by symmetry.
    let mut vector = ComplexVector::from_fn(n, |i, _| {
        Complex::new(1.0 + 0.3 * i as f64, 0.7 - 0.2 * (i as f64).sqrt())
    });
    for _ in 0..ITERATIONS {
        vector = factors.solve(&vector)?;
        let length = vector.norm();
        if !(length > 0.0 && length.is_finite()) {
            return None;
        }
        vector /= Complex::from(length);
    }
    Some(vector)
}

/// A number times the unit matrix, less a matrix.
fn shifted(matrix: &DMatrix<f64>, number: Complex<f64>) -> DMatrix<Complex<f64>> {
    let n = matrix.nrows();
    DMatrix::from_fn(n, n, |i, j| {
        let own = if i == j { number } else { Complex::from(0.0) };
        own - matrix[(i, j)]
    })
}

/// Second and third derivatives of a map at its fixed point, by central differences.
struct Differences<'a> {
    map: &'a LocalMap<'a>,
    step: f64,
    /// The image of the fixed point.
    centre: DVector<f64>,
}

impl Differences<'_> {
    /// The image of the point at this many steps in a direction of length one.
    fn image(&self, direction: &DVector<f64>, steps: f64) -> Option<DVector<f64>> {
        (self.map)(&(direction * (steps * self.step)))
    }

    /// B(u, u).
    fn second(&self, direction: &DVector<f64>) -> Option<DVector<f64>> {
        let length = direction.norm();
        if length == 0.0 {
            return Some(DVector::zeros(direction.len()));
        }
        let unit = direction / length;
        let sum = self.image(&unit, 1.0)? + self.image(&unit, -1.0)? - &self.centre * 2.0;
        Some(sum * (length / self.step).powi(2))
    }

    /// C(u, u, u).
    fn third(&self, direction: &DVector<f64>) -> Option<DVector<f64>> {
        let length = direction.norm();
        if length == 0.0 {
            return Some(DVector::zeros(direction.len()));
        }
        let unit = direction / length;
        let far = self.image(&unit, 2.0)? - self.image(&unit, -2.0)?;
        let near = self.image(&unit, 1.0)? - self.image(&unit, -1.0)?;
        Some((far - near * 2.0) * (0.5 * (length / self.step).powi(3)))
    }

    /// B(u, v) of real directions.
    fn real_bilinear(&self, one: &DVector<f64>, other: &DVector<f64>) -> Option<DVector<f64>> {
        let [length, width] = [one, other].map(DVector::norm);
        if length * width == 0.0 {
            return Some(DVector::zeros(one.len()));
        }
        let (one, other) = (one / length, other / width);
        let product = self.second(&(&one + &other))? - self.second(&(&one - &other))?;
        Some(product * (0.25 * length * width))
    }

    /// B(u, v).
    fn bilinear(&self, one: &ComplexVector, other: &ComplexVector) -> Option<ComplexVector> {
        let [(a, b), (c, d)] = [one, other].map(parts);
        let real = self.real_bilinear(&a, &c)? - self.real_bilinear(&b, &d)?;
        let imaginary = self.real_bilinear(&a, &d)? + self.real_bilinear(&b, &c)?;
        Some(real.zip_map(&imaginary, Complex::new))
    }

    /// C(q, q, q^*).
    fn cubic(&self, vector: &ComplexVector) -> Option<ComplexVector> {
        let (a, b) = parts(vector);
        let (aaa, bbb) = (self.third(&a)?, self.third(&b)?);
        let (sum, difference) = (self.third(&(&a + &b))?, self.third(&(&a - &b))?);
        let aab = (&sum - &difference - &bbb * 2.0) / 6.0;
        let abb = (&sum + &difference - &aaa * 2.0) / 6.0;
        Some((aaa + abb).zip_map(&(aab + bbb), Complex::new))
    }
}

/// The real and the imaginary part.
fn parts(vector: &ComplexVector) -> (DVector<f64>, DVector<f64>) {
    (vector.map(|value| value.re), vector.map(|value| value.im))
}

/// The real part of d from these derivatives.
fn coefficient(
    derivatives: &Differences,
    derivative: &DMatrix<f64>,
    Eigenvectors { right, left }: &Eigenvectors,
    turn: Complex<f64>,
) -> Option<f64> {
    let one = Complex::from(1.0);
    let conjugate = right.conjugate();
    let mean = shifted(derivative, one).lu().solve(&derivatives.bilinear(right, &conjugate)?)?;
    let twice = shifted(derivative, turn * turn).lu();
    let twice = twice.solve(&derivatives.bilinear(right, right)?)?;
    let sum = derivatives.cubic(right)?
        + derivatives.bilinear(right, &mean)? * Complex::from(2.0)
        + derivatives.bilinear(&conjugate, &twice)?;
    let found = 0.5 * (turn.conj() * left.dotc(&sum)).re;
    found.is_finite().then_some(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A map with a corner at its fixed point has no cubic term, one with a corner beside it has that of
    /// its side, and one with half of a cubic term on one side has, on average, half of it.
    #[test]
    fn a_corner_at_the_fixed_point_has_no_cubic_term() {
        let (sine, cosine) = 1.0_f64.sin_cos();
        let turn = DMatrix::from_row_slice(2, 2, &[cosine, -sine, sine, cosine]);
        let multiplier = Complex::from_polar(1.0, 1.0);
        for (power, corner, expected) in
            [(1.0, 0.0, None), (1.5, 0.0, None), (2.0, 0.0, Some(-0.65)), (1.0, 0.3, Some(-0.5))]
        {
            let map = |z: &DVector<f64>| {
                let beyond = (z[0] - corner).max(0.0).powf(power);
                Some(&turn * z * (1.0 - 0.25 * z.norm_squared() - 0.3 * beyond))
            };
            let found = cubic_term(&map, &turn, multiplier, 3);
            assert_eq!(found.is_some(), expected.is_some(), "{power} {corner} {found:?}");
            if let (Some(CubicTerm::Coefficient(found)), Some(expected)) = (found, expected) {
                let expected: f64 = expected;
                assert!((found - expected).abs() < 1e-3, "{found} {expected}");
            }
        }
    }

    /// The map `w -> e^(i theta) w + g20 w^2/2 + g11 w w^* + g02 w^*^2/2 + g21 w^2 w^*/2 + k v w`, `v -> m v + l w w^*` has
    /// d by hand (Kuznetsov, equation 4.26; v = l w w^*/(1 - m) on the centre manifold).
    #[test]
    fn quadratic_terms_and_a_decaying_direction_count() {
        let (theta, m, l) = (0.7_f64, -0.4, 0.8);
        let (g20, g11) = (Complex::new(0.3, -0.5), Complex::new(-0.2, 0.6));
        let (g02, g21) = (Complex::new(0.1, 0.4), Complex::new(-0.3, 0.2));
        let k = Complex::new(0.5, 0.25);
        let turn = Complex::from_polar(1.0, theta);
        let by_hand = {
            let back = turn.conj();
            0.5 * (back * g21).re
                - ((1.0 - 2.0 * turn) * back * back / (2.0 * (1.0 - turn)) * g20 * g11).re
                - 0.5 * g11.norm_sqr()
                - 0.25 * g02.norm_sqr()
                + (back * k * l / (1.0 - m)).re
        };
        let map = |z: &DVector<f64>| {
            let (w, v) = (Complex::new(z[0], z[1]), z[2]);
            let other = w.conj();
            let next = turn * w
                + 0.5 * g20 * w * w
                + g11 * w * other
                + 0.5 * g02 * other * other
                + 0.5 * g21 * w * w * other
                + k * v * w;
            Some(DVector::from_vec(vec![next.re, next.im, m * v + l * w.norm_sqr()]))
        };
        let (sine, cosine) = theta.sin_cos();
        let entries = [cosine, -sine, 0.0, sine, cosine, 0.0, 0.0, 0.0, m];
        let derivative = DMatrix::from_row_slice(3, 3, &entries);
        let found = cubic_term(&map, &derivative, turn, 2);
        // An eigenvector of length one: w is the square root of two times its coordinate.
        let Some(CubicTerm::Coefficient(found)) = found else { panic!("{found:?}") };
        assert!((found - 2.0 * by_hand).abs() < 1e-4, "{found} {by_hand}");
        let third = Complex::from_polar(1.0, std::f64::consts::TAU / 3.0);
        assert_eq!(cubic_term(&map, &derivative, third, 2), Some(CubicTerm::StrongResonance));
    }
}
