//! The elliptic functions of Jacobi, `sn`, `cn` and `dn`, of a real argument and a parameter
//! `m = k^2` up to one.
//!
//! References: M. Abramowitz, I. A. Stegun, *Handbook of Mathematical Functions*, Dover 1972, 16.4
//! (the arithmetic-geometric mean) and 16.10 (negative parameters); NIST Digital Library of
//! Mathematical Functions 22.20.
//!
//! ```text
//! a_0 = 1, b_0 = sqrt(1 - m),  a_n = (a_(n-1) + b_(n-1))/2,  b_n = sqrt(a_(n-1) b_(n-1)),  c_n = (a_(n-1) - b_(n-1))/2
//! phi_N = 2^N a_N u,  sin(2 phi_(n-1) - phi_n) = (c_n/a_n) sin(phi_n):     sn = sin(phi_0), cn = cos(phi_0)
//! m < 0, p = -m/(1 - m), v = u sqrt(1 - m):     sn(u, m) = sn(v, p)/(dn(v, p) sqrt(1 - m)), cn = cn(v, p)/dn(v, p), dn = 1/dn(v, p)
//! ```

/// Steps after which the means of `1` and `1e-8` agree to all digits, as do those of all larger
/// numbers.
const STEPS: usize = 8;

/// `sn(u, m)`, `cn(u, m)` and `dn(u, m)`; NaN for `m > 1`. Close to `m = 1` they hold for all `u`,
/// where `ellpj` of the Cephes library holds only below a quarter period.
pub(super) fn jacobi(u: f64, m: f64) -> [f64; 3] {
    if m < 0.0 {
        let scale = (1.0 - m).sqrt();
        let [sn, cn, dn] = jacobi(u * scale, -m / (1.0 - m));
        return [sn / (dn * scale), cn / dn, dn.recip()];
    }
    if m == 1.0 {
        return [u.tanh(), u.cosh().recip(), u.cosh().recip()];
    }
    let complement = 1.0 - m;
    let (mut a, mut b) = (1.0, complement.sqrt());
    let mut ratios = [0.0; STEPS];
    for ratio in &mut ratios {
        *ratio = (a - b) / (a + b);
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    let first = f64::from(1_u32 << STEPS) * a * u;
    let phi =
        ratios.iter().rev().fold(first, |phi, ratio| 0.5 * (phi + (ratio * phi.sin()).asin()));
    let (sn, cn) = phi.sin_cos();
    [sn, cn, (cn * cn + complement * sn * sn).sqrt()]
}

#[cfg(test)]
mod tests {
    use super::jacobi;
    use lindstedt_numeric::numeric::ode::quadrature::integrate_smooth;

    /// `u = int_0^phi dt/sqrt(1 - m sin^2 t)`, `sn = sin phi` (NIST Digital Library of Mathematical
    /// Functions 22.15).
    #[test]
    fn they_invert_the_integral() {
        for m in [-400.0, -3.0, -0.5, 0.0, 1e-12, 0.3, 0.5, 0.9, 0.99, 0.999_999] {
            // Near m = 1 the integrand has a narrow peak at pi/2, over which the quadrature does
            // not come.
            let far = if m < 0.999 { vec![4.0] } else { vec![] };
            for phi in [-0.7_f64, 0.2, 1.0, 1.5].into_iter().chain(far) {
                let rate = |t: f64| (1.0 - m * t.sin().powi(2)).sqrt().recip();
                let u = integrate_smooth(rate, 0.0, phi, 1e-14).unwrap().0;
                let [sn, cn, dn] = jacobi(u, m);
                let scale = 1e-13 * (1.0 + u.abs()) * (1.0 + m.abs().sqrt());
                assert!(
                    (sn - phi.sin()).abs() < scale && (cn - phi.cos()).abs() < scale,
                    "{m} {phi}: {sn} {cn}"
                );
                assert!(
                    (dn - rate(phi).recip()).abs() < scale * (1.0 + m.abs().sqrt()),
                    "{m} {phi}: {dn}"
                );
            }
        }
    }

    #[test]
    fn at_the_separatrix_they_are_hyperbolic_and_beyond_it_nothing() {
        let [sn, cn, dn] = jacobi(0.8, 1.0);
        let near = jacobi(0.8, 1.0 - 1e-13);
        for (exact, near) in [sn, cn, dn].into_iter().zip(near) {
            assert!((exact - near).abs() < 1e-12);
        }
        assert_eq!(sn, 0.8_f64.tanh());
        assert!(jacobi(0.8, 1.5).iter().all(|value| value.is_nan()));
        assert!(
            jacobi(f64::NAN, 0.5).iter().all(|value| value.is_nan())
                && jacobi(0.5, f64::NAN)[0].is_nan()
        );
    }
}
