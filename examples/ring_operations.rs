//! How much algebra an order is: the operations on coefficients that the recursion over whole
//! numbers makes for each order, and how long its coefficients are. `ring_operations W1 20`: W1
//! Duffing, W2 the pendulum, W3 van der Pol.
//!
//! The counts come from a ring that counts and leaves the work to the whole numbers: any ring can
//! stand behind a series.

use std::cell::Cell;
use std::error::Error;
use std::rc::Rc;

use lindstedt::exact::{Integer, Integers, NotInvertible, Ring, factorial};
use lindstedt::method::secular::{
    AmplitudeKind, Detuning, ForceTerm, Scheme, SecularExpansion, expand,
};
use lindstedt::series::FourierSeries;
use lindstedt::solution::AmplitudeConvention;

/// The whole numbers, counted.
#[derive(Clone, Debug, Default, PartialEq)]
struct Counted {
    products: Rc<Cell<u64>>,
    sums: Rc<Cell<u64>>,
    /// Multiplications by one number of a whole series, and greatest common divisors.
    scalings: Rc<Cell<u64>>,
    divisors: Rc<Cell<u64>>,
}

fn count(counter: &Cell<u64>) {
    counter.set(counter.get() + 1);
}

impl Counted {
    fn counts(&self) -> [u64; 4] {
        [&self.products, &self.sums, &self.scalings, &self.divisors].map(|counter| counter.get())
    }
}

impl Ring for Counted {
    type Element = Integer;

    const FIELD: bool = false;

    fn zero(&self) -> Integer {
        Integers.zero()
    }
    fn integer(&self, value: i64) -> Integer {
        Integers.integer(value)
    }
    fn is_certainly_zero(&self, element: &Integer) -> bool {
        Integers.is_certainly_zero(element)
    }
    fn accumulate(&self, sum: &mut Integer, term: &Integer) {
        count(&self.sums);
        Integers.accumulate(sum, term);
    }
    fn negate(&self, element: &mut Integer) {
        Integers.negate(element);
    }
    fn product(&self, left: &Integer, right: &Integer) -> Integer {
        count(&self.products);
        Integers.product(left, right)
    }
    fn scale(&self, element: &mut Integer, factor: i64) {
        count(&self.scalings);
        Integers.scale(element, factor);
    }
    fn scale_by(&self, element: &mut Integer, factor: &Integer) {
        count(&self.scalings);
        Integers.scale_by(element, factor);
    }
    fn divide<'a>(
        &self,
        elements: impl IntoIterator<Item = &'a mut Integer>,
        divisor: &Integer,
    ) -> Result<(), NotInvertible> {
        Integers.divide(elements, divisor)
    }
    fn reduce<'a>(
        &self,
        elements: impl IntoIterator<Item = &'a mut Integer>,
        denominator: &mut Integer,
    ) {
        let elements: Vec<&mut Integer> = elements.into_iter().collect();
        self.divisors.set(self.divisors.get() + elements.len() as u64);
        Integers.reduce(elements, denominator);
    }
    fn inverse(&self, element: &Integer) -> Option<(Integer, Integer)> {
        Integers.inverse(element)
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [work, order] = arguments.as_slice() else {
        return Err("usage: ring_operations W1|W2|W3 ORDER".into());
    };
    let highest: usize = order.parse()?;
    println!(
        "order  products     sums  scalings  divisors  digits of a numerator  of the denominator"
    );
    let mut before = [0; 4];
    for order in 1..=highest {
        // An expansion to one order more counts what that order needs: the recursion is the same up
        // to there.
        let ring = Counted::default();
        let expansion = expanded(&ring, work, order)?;
        let counts = ring.counts();
        let [products, sums, scalings, divisors] =
            std::array::from_fn(|k| counts[k] - before[k].min(counts[k]));
        let last = &expansion.displacement[order];
        let longest = last.numerators().map(Integer::bits).max().unwrap_or(0);
        let denominator = last.mean().1.bits();
        println!(
            "{order:5}  {products:8}  {sums:7}  {scalings:8}  {divisors:8}  {:>21}  {:>18}",
            digits(longest),
            digits(denominator)
        );
        before = counts;
    }
    Ok(())
}

/// Decimal digits of a number of so many binary ones.
fn digits(bits: u64) -> u64 {
    (bits as f64 * std::f64::consts::LOG10_2).ceil() as u64
}

fn expanded(
    ring: &Counted,
    work: &str,
    order: usize,
) -> Result<SecularExpansion<Counted>, Box<dyn Error>> {
    let term = |order, position, velocity, numerator: i64, denominator: &Integer| ForceTerm {
        order,
        position,
        velocity,
        coefficient: FourierSeries::constant(ring.clone(), Integer::from(numerator))
            .over(denominator),
    };
    let one = Integer::from(1);
    let (force, amplitude) = match work {
        "W1" => (vec![term(1, 3, 0, 1, &one)], AmplitudeKind::Free),
        "W2" => {
            let sine = (1..=order).map(|n| {
                let sign = if n.is_multiple_of(2) { 1 } else { -1 };
                term(n, 2 * n as u32 + 1, 0, sign, &factorial(2 * n as u32 + 1))
            });
            (sine.collect(), AmplitudeKind::Free)
        }
        "W3" => (vec![term(1, 2, 1, 4, &one), term(1, 0, 1, -1, &one)], AmplitudeKind::Determined),
        _ => return Err(format!("no work {work}").into()),
    };
    let scheme = Scheme {
        normalisation: AmplitudeConvention::Initial,
        amplitude,
        detuning: Detuning::Acceleration,
    };
    Ok(expand(ring, &force, order, &scheme)?)
}
