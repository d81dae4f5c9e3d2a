//! Random forces: a sum of terms that knows its text, its value without cancellation, its Taylor
//! series and where it turns fast. Nothing here uses the program.
//!
//! A force is made without dimensions, `g(y)`; what the program sees is
//! `10^(rate + length) g(x/10^length)`, whose frequencies are `10^(rate/2)` times as large at
//! amplitudes `10^length` times as large.

use std::collections::BTreeMap;

/// A decimal number, exact as text.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Number {
    pub mantissa: i64,
    pub exponent: i32,
    value: f64,
}

impl Number {
    pub fn new(mantissa: i64, exponent: i32) -> Self {
        let value = format!("{mantissa}e{exponent}").parse().expect("a number");
        Self { mantissa, exponent, value }
    }

    pub fn value(self) -> f64 {
        self.value
    }

    pub fn times_ten_to(self, power: i32) -> Self {
        Self::new(self.mantissa, self.exponent + power)
    }

    /// As a person would type it where that is short.
    pub fn text(self) -> String {
        let value = self.value;
        let plain = format!("{value}");
        if plain.len() <= 9 && plain.parse() == Ok(value) {
            plain
        } else {
            format!("{}e{}", self.mantissa, self.exponent)
        }
    }
}

/// What a coefficient multiplies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// `1`
    Constant,
    /// `x^n`
    Power(u32),
    /// `sgn(x) |x|^(p/q)`
    SignedPower(u32, u32),
    /// `sin(b x)`
    Sine(Number),
    /// `cos(b x)`
    Cosine(Number),
    /// `sinh(b x)`
    Sinh(Number),
    /// `tanh(b x)`
    Tanh(Number),
    /// `atan(b x)`
    Arctangent(Number),
    /// `exp(b x) - 1`
    Exponential(Number),
    /// `x/(1 + b x^2)`
    Saturating(Number),
    /// `x^3/(1 + b x^2)`
    Stiffening(Number),
    /// `x/(d - x)^2`
    Gap(Number),
    /// `1/(d - x) - 1/d`
    Pole(Number),
    /// `max(x - d, 0)`
    Barrier(Number),
    /// `(x - d) H(x - d)`
    Step(Number),
    /// `max(x - d, 0) + min(x + d, 0)`
    Walls(Number),
    /// `(x - d) exp(-s (x - d)^2)`
    Bump(Number, Number),
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Term {
    pub coefficient: Number,
    pub shape: Shape,
    /// A parameter that stands for the coefficient.
    pub name: Option<&'static str>,
}

#[derive(Clone, Debug)]
pub struct Force {
    pub terms: Vec<Term>,
    /// Power of ten of a length.
    pub length: i32,
    /// Power of ten of omega^2.
    pub rate: i32,
}

impl Force {
    /// The equation, and the values of its parameters.
    pub fn equation(&self) -> (String, BTreeMap<&'static str, Number>) {
        let mut text = "x''".to_owned();
        let mut values = BTreeMap::new();
        for term in &self.terms {
            let coefficient =
                term.coefficient.times_ten_to(term.power_of_ten(self.length, self.rate));
            let shape = term.shape.text(self.length);
            match term.name {
                Some(name) => {
                    values.insert(name, coefficient);
                    text += &format!(" + {name}*{shape}");
                }
                None if coefficient.mantissa < 0 => {
                    let size = Number::new(-coefficient.mantissa, coefficient.exponent);
                    text += &format!(" - {}*{shape}", size.text());
                }
                None => text += &format!(" + {}*{shape}", coefficient.text()),
            }
        }
        (text.replace("+ 1*", "+ ").replace("- 1*", "- ") + " = 0", values)
    }

    /// `g(origin + y) - g(origin)`, without cancellation where that is easy.
    pub fn rise(&self, origin: f64, y: f64) -> f64 {
        self.terms.iter().map(|term| term.coefficient.value() * term.shape.rise(origin, y)).sum()
    }

    pub fn value(&self, x: f64) -> f64 {
        self.terms.iter().map(|term| term.coefficient.value() * term.shape.value(x)).sum()
    }

    /// The sum of the sizes of the terms.
    pub fn size(&self, x: f64) -> f64 {
        self.terms.iter().map(|term| (term.coefficient.value() * term.shape.value(x)).abs()).sum()
    }

    pub fn slope(&self, x: f64) -> f64 {
        self.terms.iter().map(|term| term.coefficient.value() * term.shape.slope(x)).sum()
    }

    /// Taylor coefficients about `origin`; `None` where there are none.
    pub fn taylor(&self, origin: f64, degree: usize) -> Option<Vec<f64>> {
        let mut sum = vec![0.0; degree + 1];
        for term in &self.terms {
            let series = term.shape.taylor(origin, degree)?;
            for (total, value) in sum.iter_mut().zip(series) {
                *total += term.coefficient.value() * value;
            }
        }
        Some(sum)
    }

    /// Places where the force has a corner or turns fast.
    pub fn places(&self) -> Vec<f64> {
        self.terms.iter().flat_map(|term| term.shape.places()).collect()
    }

    /// The interval about `origin` on which the force is finite.
    pub fn domain(&self, origin: f64) -> (f64, f64) {
        let poles = self.terms.iter().filter_map(|term| match term.shape {
            Shape::Gap(d) | Shape::Pole(d) => Some(d.value()),
            _ => None,
        });
        poles.fold((f64::NEG_INFINITY, f64::INFINITY), |(low, high), pole| {
            if pole > origin { (low, high.min(pole)) } else { (low.max(pole), high) }
        })
    }

    /// Whether every term is odd about zero.
    pub fn is_odd(&self) -> bool {
        self.terms.iter().all(|term| term.shape.is_odd())
    }

    pub fn has_corners(&self) -> bool {
        self.terms.iter().any(|term| {
            matches!(
                term.shape,
                Shape::SignedPower(..) | Shape::Barrier(_) | Shape::Step(_) | Shape::Walls(_)
            )
        })
    }

    /// The degree, where the force is a polynomial.
    pub fn degree(&self) -> Option<usize> {
        let degree = |term: &Term| match term.shape {
            Shape::Constant => Some(0),
            Shape::Power(n) => Some(n as usize),
            _ => None,
        };
        self.terms.iter().map(degree).try_fold(0, |most, degree| Some(most.max(degree?)))
    }
}

impl Term {
    /// The power of ten that goes with the coefficient when lengths and omega^2 are scaled.
    fn power_of_ten(&self, length: i32, rate: i32) -> i32 {
        rate + match self.shape {
            Shape::Power(n) => length * (1 - n as i32),
            Shape::SignedPower(p, q) => length - length * p as i32 / q as i32,
            Shape::Stiffening(_) => -2 * length,
            Shape::Gap(_) | Shape::Pole(_) => 2 * length,
            Shape::Saturating(_)
            | Shape::Barrier(_)
            | Shape::Step(_)
            | Shape::Walls(_)
            | Shape::Bump(..) => 0,
            _ => length,
        }
    }
}

fn product(a: &[f64], b: &[f64]) -> Vec<f64> {
    let coefficient = |n: usize| (0..=n).map(|k| a[k] * b[n - k]).sum();
    (0..a.len()).map(coefficient).collect()
}

fn quotient(a: &[f64], b: &[f64]) -> Vec<f64> {
    let mut result = vec![0.0; a.len()];
    for n in 0..a.len() {
        let sum: f64 = (0..n).map(|k| result[k] * b[n - k]).sum();
        result[n] = (a[n] - sum) / b[0];
    }
    result
}

/// The series of `exp` of a series.
fn exponential(inside: &[f64]) -> Vec<f64> {
    let mut result = vec![inside[0].exp(); inside.len()];
    for n in 1..inside.len() {
        let sum: f64 = (1..=n).map(|k| k as f64 * inside[k] * result[n - k]).sum();
        result[n] = sum / n as f64;
    }
    result
}

/// The series of a function whose derivative has the series `slope`.
fn integral(value: f64, slope: &[f64]) -> Vec<f64> {
    let mut result = vec![value; slope.len()];
    for n in 1..slope.len() {
        result[n] = slope[n - 1] / n as f64;
    }
    result
}

impl Shape {
    fn text(self, length: i32) -> String {
        let inverse = |b: Number| {
            let text = b.times_ten_to(-length).text();
            if text == "1" { "x".to_owned() } else { format!("{text}*x") }
        };
        let long = |d: Number| d.times_ten_to(length).text();
        let squared = |b: Number| b.times_ten_to(-2 * length).text();
        match self {
            Self::Constant => "1".to_owned(),
            Self::Power(1) => "x".to_owned(),
            Self::Power(n) => format!("x^{n}"),
            Self::SignedPower(2, 1) => "x*abs(x)".to_owned(),
            Self::SignedPower(p, q) if p % 2 == 1 && q % 2 == 1 => format!("x^({p}/{q})"),
            Self::SignedPower(p, q) => format!("sgn(x)*abs(x)^({p}/{q})"),
            Self::Sine(b) => format!("sin({})", inverse(b)),
            Self::Cosine(b) => format!("cos({})", inverse(b)),
            Self::Sinh(b) => format!("sinh({})", inverse(b)),
            Self::Tanh(b) => format!("tanh({})", inverse(b)),
            Self::Arctangent(b) => format!("atan({})", inverse(b)),
            Self::Exponential(b) => format!("(exp({}) - 1)", inverse(b)),
            Self::Saturating(b) => format!("x/(1 + {}*x^2)", squared(b)),
            Self::Stiffening(b) => format!("x^3/(1 + {}*x^2)", squared(b)),
            Self::Gap(d) => format!("x/({} - x)^2", long(d)),
            Self::Pole(d) => format!("(1/({d} - x) - 1/{d})", d = long(d)),
            Self::Barrier(d) => format!("max(x - {}, 0)", long(d)),
            Self::Step(d) => format!("(x - {d})*H(x - {d})", d = long(d)),
            Self::Walls(d) => format!("(max(x - {d}, 0) + min(x + {d}, 0))", d = long(d)),
            Self::Bump(d, s) => {
                let size = long(Number::new(d.mantissa.abs(), d.exponent));
                let from = match d.mantissa {
                    0 => "x".to_owned(),
                    1.. => format!("(x - {size})"),
                    _ => format!("(x + {size})"),
                };
                format!("{from}*exp(-{}*{from}^2)", squared(s))
            }
        }
    }

    fn value(self, x: f64) -> f64 {
        match self {
            Self::Constant => 1.0,
            Self::Power(n) => x.powi(n as i32),
            Self::SignedPower(p, q) => x.abs().powf(f64::from(p) / f64::from(q)).copysign(x),
            Self::Sine(b) => (b.value() * x).sin(),
            Self::Cosine(b) => (b.value() * x).cos(),
            Self::Sinh(b) => (b.value() * x).sinh(),
            Self::Tanh(b) => (b.value() * x).tanh(),
            Self::Arctangent(b) => (b.value() * x).atan(),
            Self::Exponential(b) => (b.value() * x).exp_m1(),
            Self::Saturating(b) => x / (1.0 + b.value() * x * x),
            Self::Stiffening(b) => x.powi(3) / (1.0 + b.value() * x * x),
            Self::Gap(d) => x / (d.value() - x).powi(2),
            Self::Pole(d) => x / (d.value() * (d.value() - x)),
            Self::Barrier(d) | Self::Step(d) => (x - d.value()).max(0.0),
            Self::Walls(d) => (x - d.value()).max(0.0) + (x + d.value()).min(0.0),
            Self::Bump(d, s) => {
                let y = x - d.value();
                y * (-s.value() * y * y).exp()
            }
        }
    }

    fn rise(self, origin: f64, y: f64) -> f64 {
        if origin == 0.0 {
            return self.value(y) - self.value(0.0);
        }
        match self {
            Self::Constant => 0.0,
            Self::Power(n) => {
                let x = origin + y;
                let mean = |k: u32| x.powi(k as i32) * origin.powi((n - 1 - k) as i32);
                y * (0..n).map(mean).sum::<f64>()
            }
            Self::Sine(b) => {
                2.0 * (b.value() * (origin + 0.5 * y)).cos() * (0.5 * b.value() * y).sin()
            }
            Self::Cosine(b) => {
                -2.0 * (b.value() * (origin + 0.5 * y)).sin() * (0.5 * b.value() * y).sin()
            }
            Self::Exponential(b) => (b.value() * origin).exp() * (b.value() * y).exp_m1(),
            _ => self.value(origin + y) - self.value(origin),
        }
    }

    fn slope(self, x: f64) -> f64 {
        match self {
            Self::Constant => 0.0,
            Self::Power(n) => f64::from(n) * x.powi(n as i32 - 1),
            Self::SignedPower(p, q) => {
                let power = f64::from(p) / f64::from(q);
                power * x.abs().powf(power - 1.0)
            }
            Self::Sine(b) => b.value() * (b.value() * x).cos(),
            Self::Cosine(b) => -b.value() * (b.value() * x).sin(),
            Self::Sinh(b) => b.value() * (b.value() * x).cosh(),
            Self::Tanh(b) => b.value() / (b.value() * x).cosh().powi(2),
            Self::Arctangent(b) => b.value() / (1.0 + (b.value() * x).powi(2)),
            Self::Exponential(b) => b.value() * (b.value() * x).exp(),
            Self::Saturating(b) => {
                let square = b.value() * x * x;
                (1.0 - square) / (1.0 + square).powi(2)
            }
            Self::Stiffening(b) => {
                let square = b.value() * x * x;
                x * x * (3.0 + square) / (1.0 + square).powi(2)
            }
            Self::Gap(d) => (d.value() + x) / (d.value() - x).powi(3),
            Self::Pole(d) => (d.value() - x).powi(-2),
            Self::Barrier(d) | Self::Step(d) => f64::from(u8::from(x > d.value())),
            Self::Walls(d) => f64::from(u8::from(x.abs() > d.value())),
            Self::Bump(d, s) => {
                let square = s.value() * (x - d.value()).powi(2);
                (1.0 - 2.0 * square) * (-square).exp()
            }
        }
    }

    fn taylor(self, x: f64, degree: usize) -> Option<Vec<f64>> {
        let constant = |value: f64| {
            let mut series = vec![0.0; degree + 1];
            series[0] = value;
            series
        };
        let linear = |b: f64, offset: f64| {
            let mut series = constant(b * x + offset);
            if degree > 0 {
                series[1] = b;
            }
            series
        };
        let scaled = |series: &[f64], factor: f64| {
            series.iter().map(|value| value * factor).collect::<Vec<_>>()
        };
        let sum = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a + b).collect::<Vec<_>>();
        let one = constant(1.0);
        let identity = linear(1.0, 0.0);
        Some(match self {
            Self::Constant => one,
            Self::Power(n) => (0..n).fold(one, |power, _| product(&power, &identity)),
            Self::SignedPower(..) => return None,
            Self::Sine(b) | Self::Cosine(b) => {
                let (b, turn) = (b.value(), if matches!(self, Self::Cosine(_)) { 1 } else { 0 });
                let (sine, cosine) = (b * x).sin_cos();
                let values = [sine, cosine, -sine, -cosine];
                let mut factor = 1.0;
                let coefficient = |n: usize| {
                    if n > 0 {
                        factor *= b / n as f64;
                    }
                    factor * values[(n + turn) % 4]
                };
                (0..=degree).map(coefficient).collect()
            }
            Self::Sinh(b) => {
                let up = exponential(&linear(b.value(), 0.0));
                let down = exponential(&linear(-b.value(), 0.0));
                scaled(&sum(&up, &scaled(&down, -1.0)), 0.5)
            }
            Self::Tanh(b) => {
                // y' = b (1 - y^2)
                let mut series = constant((b.value() * x).tanh());
                for n in 1..=degree {
                    let square: f64 = (0..n).map(|k| series[k] * series[n - 1 - k]).sum();
                    series[n] = b.value() * (f64::from(u8::from(n == 1)) - square) / n as f64;
                }
                series
            }
            Self::Arctangent(b) => {
                let inside = linear(b.value(), 0.0);
                let below = sum(&one, &product(&inside, &inside));
                integral((b.value() * x).atan(), &quotient(&constant(b.value()), &below))
            }
            Self::Exponential(b) => {
                let mut series = exponential(&linear(b.value(), 0.0));
                series[0] -= 1.0;
                series
            }
            Self::Saturating(b) => {
                let below = sum(&one, &scaled(&product(&identity, &identity), b.value()));
                quotient(&identity, &below)
            }
            Self::Stiffening(b) => {
                let square = product(&identity, &identity);
                quotient(&product(&square, &identity), &sum(&one, &scaled(&square, b.value())))
            }
            Self::Pole(d) => {
                quotient(&scaled(&identity, d.value().recip()), &linear(-1.0, d.value()))
            }
            Self::Gap(d) => {
                let gap = linear(-1.0, d.value());
                quotient(&identity, &product(&gap, &gap))
            }
            Self::Barrier(d) | Self::Step(d) if x < d.value() => constant(0.0),
            Self::Barrier(d) | Self::Step(d) if x > d.value() => linear(1.0, -d.value()),
            Self::Walls(d) if x.abs() < d.value() => constant(0.0),
            Self::Barrier(_) | Self::Step(_) | Self::Walls(_) => return None,
            Self::Bump(d, s) => {
                let from = linear(1.0, -d.value());
                product(&from, &exponential(&scaled(&product(&from, &from), -s.value())))
            }
        })
    }

    fn places(self) -> Vec<f64> {
        let around = |middle: f64, width: f64| {
            let side = [0.0, 0.5, 1.0, 2.0, 3.0, 4.5, 6.0, 9.0, 20.0, 60.0];
            side.iter().flat_map(|&n| [middle - n * width, middle + n * width]).collect()
        };
        match self {
            Self::SignedPower(..) => vec![0.0],
            Self::Barrier(d) | Self::Step(d) => vec![d.value()],
            Self::Walls(d) => vec![-d.value(), d.value()],
            Self::Bump(d, s) => around(d.value(), s.value().sqrt().recip()),
            Self::Tanh(b) | Self::Arctangent(b) | Self::Exponential(b) | Self::Sinh(b) => {
                around(0.0, b.value().recip())
            }
            Self::Saturating(b) | Self::Stiffening(b) => around(0.0, b.value().sqrt().recip()),
            Self::Gap(d) | Self::Pole(d) => {
                let side = [0.3, 0.1, 0.03, 0.01, 3e-3, 1e-3, 1e-4, 1e-5];
                side.iter().flat_map(|n| [d.value() * (1.0 - n), d.value() * (1.0 + n)]).collect()
            }
            _ => vec![],
        }
    }

    fn is_odd(self) -> bool {
        match self {
            Self::Power(n) => n % 2 == 1,
            Self::Bump(d, _) => d.mantissa == 0,
            Self::Constant
            | Self::Cosine(_)
            | Self::Exponential(_)
            | Self::Gap(_)
            | Self::Pole(_)
            | Self::Barrier(_)
            | Self::Step(_) => false,
            _ => true,
        }
    }
}
