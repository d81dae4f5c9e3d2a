//! Several polynomials side by side: their values, the number of sign changes of each, and the
//! position of a single one.
//!
//! ```text
//! p(u h) = sum_i b_i C(m,i) u^i (1-u)^(m-i) + tail,  b_i = sum_(k<=i) C(i,k)/C(m,k) c_k h^k,  |tail| <= u^m sum_(k>m) |c_k| h^k
//! changes of sign of p in (0, h) = changes of sign along b_0 ... b_m, less an even number
//! ```
//!
//! The second line holds while the bound of the tail, which belongs to b_m alone, is smaller than
//! b_m: then the numbers 0 and 1 are certain. (S. Bernstein's form and Descartes' rule of signs: R.
//! T. Farouki, *Comput. Aided Geom. Design* 29 (2012) 379.) Every lane is computed as it would be
//! alone: no operation is fused or reordered.

/// The degree of Bernstein's form; higher terms of a series are small on a step that meets its
/// tolerance.
const DEGREE: usize = 8;

/// 1/C(8, k).
const INVERSE_BINOMIALS: [f64; DEGREE + 1] =
    [1.0, 1.0 / 8.0, 1.0 / 28.0, 1.0 / 56.0, 1.0 / 70.0, 1.0 / 56.0, 1.0 / 28.0, 1.0 / 8.0, 1.0];

/// p(u), as even part + u odd part: two short chains of operations instead of a long one.
#[inline(always)]
pub(in crate::impact) fn values<const L: usize>(
    coefficients: &[[f64; L]],
    u: &[f64; L],
) -> [f64; L] {
    let [values] = values_of([coefficients], u);
    values
}

/// Values of several polynomials of the same length: bit for bit those of each alone, and faster,
/// because none waits for another.
#[inline(always)]
pub(in crate::impact) fn values_of<const N: usize, const L: usize>(
    polynomials: [&[[f64; L]]; N],
    u: &[f64; L],
) -> [[f64; L]; N] {
    let (mut even, mut odd, mut square) = ([[0.0; L]; N], [[0.0; L]; N], [0.0; L]);
    for lane in 0..L {
        square[lane] = u[lane] * u[lane];
    }
    let count = polynomials.first().map_or(0, |first| first.len());
    if count % 2 == 1 {
        for (even, coefficients) in even.iter_mut().zip(polynomials) {
            *even = coefficients[count - 1];
        }
    }
    for pair in (0..count / 2).rev() {
        for ((even, odd), coefficients) in even.iter_mut().zip(&mut odd).zip(polynomials) {
            for lane in 0..L {
                even[lane] = even[lane] * square[lane] + coefficients[2 * pair][lane];
                odd[lane] = odd[lane] * square[lane] + coefficients[2 * pair + 1][lane];
            }
        }
    }
    for (even, odd) in even.iter_mut().zip(&odd) {
        for lane in 0..L {
            even[lane] += u[lane] * odd[lane];
        }
    }
    even
}

/// p(u) and p'(u), likewise.
#[inline(always)]
pub(in crate::impact) fn values_and_slopes<const L: usize>(
    coefficients: &[[f64; L]],
    u: &[f64; L],
) -> ([f64; L], [f64; L]) {
    let (pairs, rest) = coefficients.as_chunks::<2>();
    let mut even = rest.first().copied().unwrap_or([0.0; L]);
    let (mut odd, mut even_slope, mut odd_slope, mut square) =
        ([0.0; L], [0.0; L], [0.0; L], [0.0; L]);
    for lane in 0..L {
        square[lane] = u[lane] * u[lane];
    }
    for pair in pairs.iter().rev() {
        for lane in 0..L {
            even_slope[lane] = even_slope[lane] * square[lane] + even[lane];
            odd_slope[lane] = odd_slope[lane] * square[lane] + odd[lane];
            even[lane] = even[lane] * square[lane] + pair[0][lane];
            odd[lane] = odd[lane] * square[lane] + pair[1][lane];
        }
    }
    // The slopes so far are those with respect to u^2.
    for lane in 0..L {
        even_slope[lane] =
            2.0 * u[lane] * (even_slope[lane] + u[lane] * odd_slope[lane]) + odd[lane];
        even[lane] += u[lane] * odd[lane];
    }
    (even, even_slope)
}

/// A bound on |p(u) - p(0)| for 0 <= u <= h.
#[inline(always)]
pub(in crate::impact) fn variations<const L: usize>(
    coefficients: &[[f64; L]],
    h: &[f64; L],
) -> [f64; L] {
    let (mut even, mut odd, mut square) = ([0.0; L], [0.0; L], [0.0; L]);
    for lane in 0..L {
        square[lane] = h[lane] * h[lane];
    }
    let (pairs, rest) = coefficients.get(1..).unwrap_or_default().as_chunks::<2>();
    for coefficient in rest {
        for lane in 0..L {
            odd[lane] = coefficient[lane].abs();
        }
    }
    for pair in pairs.iter().rev() {
        for lane in 0..L {
            odd[lane] = odd[lane] * square[lane] + pair[0][lane].abs();
            even[lane] = even[lane] * square[lane] + pair[1][lane].abs();
        }
    }
    for lane in 0..L {
        odd[lane] = (odd[lane] + even[lane] * h[lane]) * h[lane];
    }
    odd
}

/// One round of sums of neighbours, from this place on: the constant `FIRST` lets the compiler
/// unroll the loop.
#[inline(always)]
fn neighbours<const FIRST: usize, const L: usize>(form: &mut [[f64; L]; DEGREE + 1]) {
    for i in (FIRST..=DEGREE).rev() {
        let below = form[i - 1];
        for (entry, below) in form[i].iter_mut().zip(below) {
            *entry += below;
        }
    }
}

/// Number of sign changes of p, which is not zero at 0, in (0, h): 0 or 1, more if that is not
/// certain.
#[inline(always)]
pub(in crate::impact) fn changes_of_sign<const L: usize>(
    coefficients: &[[f64; L]],
    h: &[f64; L],
) -> [f64; L] {
    let (mut form, mut power, mut tail) = ([[0.0; L]; DEGREE + 1], [1.0; L], [0.0; L]);
    let (low, high) = coefficients.split_at(coefficients.len().min(DEGREE + 1));
    for ((entry, coefficient), inverse) in form.iter_mut().zip(low).zip(INVERSE_BINOMIALS) {
        for lane in 0..L {
            entry[lane] = coefficient[lane] * power[lane] * inverse;
            power[lane] *= h[lane];
        }
    }
    for coefficient in high {
        for lane in 0..L {
            tail[lane] += (coefficient[lane] * power[lane]).abs();
            power[lane] *= h[lane];
        }
    }
    neighbours::<1, L>(&mut form);
    neighbours::<2, L>(&mut form);
    neighbours::<3, L>(&mut form);
    neighbours::<4, L>(&mut form);
    neighbours::<5, L>(&mut form);
    neighbours::<6, L>(&mut form);
    neighbours::<7, L>(&mut form);
    neighbours::<8, L>(&mut form);
    let (mut changes, mut last) = ([0.0; L], [0.0; L]);
    for lane in 0..L {
        last[lane] = if form[0][lane] > 0.0 { 1.0 } else { -1.0 };
    }
    for entry in &form[1..] {
        for lane in 0..L {
            let sign: f64 = if entry[lane] > 0.0 { 1.0 } else { -1.0 };
            let sign = if entry[lane] == 0.0 { last[lane] } else { sign };
            changes[lane] += 0.5 * (sign - last[lane]).abs();
            last[lane] = sign;
        }
    }
    for lane in 0..L {
        let certain = form[DEGREE][lane].abs() > tail[lane];
        changes[lane] = if certain { changes[lane] } else { 2.0 };
    }
    changes
}

/// The point in each active lane at which p - level changes its sign, once between two points with
/// known values of opposite sign: Newton's method with bisection as a safeguard. The other lanes
/// have no meaning.
#[inline(always)]
pub(in crate::impact) fn crossings<const L: usize>(
    coefficients: &[[f64; L]],
    level: &[f64; L],
    (from, start): (&[f64; L], &[f64; L]),
    (to, end): (&[f64; L], &[f64; L]),
    active: &[bool; L],
) -> [f64; L] {
    // A lane is done when its interval is a point, which stays where it is.
    let (mut left, mut right, mut u) = (*from, *to, *from);
    let slope = coefficients.get(1).copied().unwrap_or([0.0; L]);
    for lane in 0..L {
        let chord =
            from[lane] + (to[lane] - from[lane]) * (start[lane] / (start[lane] - end[lane]));
        // At the beginning of the series the parabola with the slope there is a better guess than
        // the chord.
        let bend = (end[lane] - start[lane] - slope[lane] * to[lane]) / (to[lane] * to[lane]);
        let root = (slope[lane] * slope[lane] - 4.0 * bend * start[lane]).sqrt();
        let guess = -2.0 * start[lane] / (slope[lane] + root.copysign(slope[lane]));
        let better = (from[lane] == 0.0) & (guess > from[lane]) & (guess < to[lane]);
        let first = if better { guess } else { chord };
        u[lane] = if active[lane] { first } else { from[lane] };
        right[lane] = if active[lane] { to[lane] } else { from[lane] };
    }
    // Newton's steps converge in a few, halvings in 60. Conditions are evaluated one at a time, so
    // that they are vectorised over the lanes.
    for _ in 0..100 {
        let (sum, slope) = values_and_slopes(coefficients, &u);
        let mut widest = 0.0_f64;
        for lane in 0..L {
            let (here, span) = (u[lane], to[lane] - from[lane]);
            let height = sum[lane] - level[lane];
            let side = height * start[lane].signum();
            let low = if side > 0.0 { here } else { left[lane] };
            let high = if side > 0.0 { right[lane] } else { here };
            let newton = here - height / slope[lane];
            let inside = (newton - low) * (high - newton);
            let next = if inside > 0.0 { newton } else { 0.5 * (low + high) };
            let next = if height == 0.0 { here } else { next };
            // The error of a step of Newton's is about the square of the one before; a bisection
            // step gives no such estimate.
            let error = if inside > 0.0 { (next - here).abs() } else { span };
            let error = if (next - low) * (high - next) > 0.0 { error } else { 0.0 };
            left[lane] = if error <= 1e-8 * span { next } else { low };
            right[lane] = if error <= 1e-8 * span { next } else { high };
            u[lane] = next;
        }
        for lane in 0..L {
            let width = right[lane] - left[lane];
            widest = if width > widest { width } else { widest };
        }
        if widest <= 0.0 {
            break;
        }
    }
    u
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lowest power first: the product of (u - root) over real roots and of (u - re)^2 + im^2 over
    /// pairs, in each lane.
    fn polynomial<const L: usize>(roots: [&[f64]; L], pairs: [&[(f64, f64)]; L]) -> Vec<[f64; L]> {
        let mut coefficients = vec![[0.0; L]; 25];
        for lane in 0..L {
            let mut own = vec![1.0];
            let real = roots[lane].iter().map(|root| vec![-root, 1.0]);
            let complex =
                pairs[lane].iter().map(|(re, im)| vec![re * re + im * im, -2.0 * re, 1.0]);
            for factor in real.chain(complex) {
                let mut next = vec![0.0; own.len() + factor.len() - 1];
                for (i, a) in own.iter().enumerate() {
                    for (j, b) in factor.iter().enumerate() {
                        next[i + j] += a * b;
                    }
                }
                own = next;
            }
            for (coefficient, own) in coefficients.iter_mut().zip(own) {
                coefficient[lane] = own;
            }
        }
        coefficients
    }

    /// None and one are what the roots say, and two close ones are never called none.
    #[test]
    fn changes_of_sign_are_those_of_the_roots() {
        let far = [(3.0, 0.4), (-2.5, 1.0), (-4.0, 3.0)];
        let roots: [&[f64]; 8] = [
            &[],
            &[0.4],
            &[0.4, 1.7],
            &[-0.3, 1.3],
            &[0.9, 1.01],
            &[0.5, 0.5 + 1e-7],
            &[0.2, 0.6],
            &[1.5],
        ];
        let several = polynomial(roots, [&far; 8]);
        let changes = changes_of_sign(&several, &[1.0; 8]);
        for (lane, roots) in roots.iter().enumerate() {
            let inside = roots.iter().filter(|root| (0.0..1.0).contains(*root)).count() as f64;
            // An uncertain number is counted as two, and is examined.
            assert!(changes[lane] == inside || changes[lane] >= 2.0, "{roots:?}: {changes:?}");
        }
        assert_eq!(changes[..5], [0.0, 1.0, 1.0, 0.0, 1.0]);
        // Nothing is certain where there is no number, and where what lies beyond the form is
        // larger than it.
        assert!(changes_of_sign(&[[f64::NAN], [1.0]], &[1.0])[0] >= 2.0);
        let mut long = vec![[0.0]; 20];
        (long[0], long[19]) = ([1.0], [-3.0]);
        assert!(changes_of_sign(&long, &[1.0])[0] >= 2.0);
    }

    /// A crossing is where the root is, and in eight lanes to the last bit what it is in one; what
    /// is not asked for disturbs nothing.
    #[test]
    fn crossings_are_the_roots_in_any_lane() {
        let roots: [f64; 8] = [0.1, 0.25, 0.5, 0.75, 0.9, 0.999, 1e-9, 0.333];
        let real = roots.each_ref().map(std::slice::from_ref);
        let several = polynomial(real, [&[(2.0, 1.0), (-1.5, 0.5)]; 8]);
        let (from, to) = ([0.0; 8], [1.0; 8]);
        let (start, end) = (values(&several, &from), values(&several, &to));
        let all = crossings(&several, &[0.0; 8], (&from, &start), (&to, &end), &[true; 8]);
        let mut some = [true; 8];
        some[3] = false;
        let without = crossings(&several, &[0.0; 8], (&from, &start), (&to, &end), &some);
        for lane in 0..8 {
            assert!((all[lane] - roots[lane]).abs() <= 4e-16, "{} and {}", all[lane], roots[lane]);
            let own: Vec<[f64; 1]> =
                several.iter().map(|coefficient| [coefficient[lane]]).collect();
            let (start, end) = ([start[lane]], [end[lane]]);
            let alone = crossings(&own, &[0.0], (&[0.0], &start), (&[1.0], &end), &[true]);
            assert_eq!(alone[0].to_bits(), all[lane].to_bits());
            assert!(lane == 3 || without[lane].to_bits() == all[lane].to_bits());
        }
    }
}
