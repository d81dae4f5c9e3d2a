//! The values that one parameter takes in a sweep.
//!
//! In: `gamma=1e4:1e9:50:log`, equal ratios; `zeta=0.01:0.05:9`, equal steps;
//! `zeta=0.01,0.02,0.05`, these values. Out: an [`Axis`], whose values are finite and all
//! different, for two motions of a sweep are never the same.
//!
//! ```text
//! linear         from + (to - from) k/(n - 1)                           k = 0, 1, ..., n - 1
//! logarithmic    from (to/from)^(k/(n - 1))                             from, to of one sign, not zero
//! ```

use std::str::FromStr;

use thiserror::Error;

use super::MOST_MOTIONS;
use crate::spelling::nearest;

/// The spacing of the values of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Spacing {
    /// Equal steps.
    Linear,
    /// Equal ratios.
    Logarithmic,
    /// As they are listed.
    List,
}

impl Spacing {
    /// Every spacing.
    pub const ALL: [Self; 3] = [Self::Linear, Self::Logarithmic, Self::List];

    /// `linear`, `logarithmic` or `list`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Linear => "linear",
            Self::Logarithmic => "logarithmic",
            Self::List => "list",
        }
    }
}

/// A parameter and the values it takes.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    name: String,
    spacing: Spacing,
    values: Vec<f64>,
}

/// The reason why a text is not an axis.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum AxisError {
    /// Neither a range nor a list.
    #[error(
        "`{0}` should be NAME=from:to:count, such as zeta=0.01:0.05:9; NAME=from:to:count:log for equal ratios; or a list \
         NAME=a,b,c"
    )]
    Form(String),
    /// Neither linear nor logarithmic.
    #[error("`{name}` is no spacing: after the count stands `log` for equal ratios, or `lin`{}", suggestion(.nearest))]
    Spacing {
        /// The value given.
        name: String,
        /// The most similar known name.
        nearest: Option<&'static str>,
    },
    /// A value that is not a finite number.
    #[error("`{0}` is no finite number")]
    Number(String),
    /// Ends whose difference overflows.
    #[error(
        "from {from} to {to} is further than numbers reach: bring the ends together, or write `:log`"
    )]
    Wide {
        /// The first value.
        from: f64,
        /// The last value.
        to: f64,
    },
    /// Equal ratios that lead through zero.
    #[error(
        "a logarithmic axis goes from {from} to {to}, but needs two ends of one sign, neither of them zero: begin beyond \
         zero, or leave out `:log`"
    )]
    NoRatio {
        /// The first value.
        from: f64,
        /// The last value.
        to: f64,
    },
    /// A count outside its range.
    #[error("the count `{0}` should be a whole number from 2 to {MOST_MOTIONS}")]
    Count(String),
    /// A value that comes twice.
    #[error("`{name}` takes the value {value} twice: two motions would be the same")]
    Twice {
        /// The name of the parameter.
        name: String,
        /// The value.
        value: f64,
    },
}

fn suggestion(nearest: &Option<&str>) -> String {
    nearest.map_or_else(String::new, |name| format!(": did you mean `{name}`?"))
}

impl Axis {
    /// An axis of `count` values with equal steps, both ends included.
    ///
    /// # Errors
    /// [`AxisError`], for ends that are not finite or one and the same, and for a count below 2 or
    /// beyond [`MOST_MOTIONS`].
    pub fn linear(name: &str, from: f64, to: f64, count: usize) -> Result<Self, AxisError> {
        let span = to - from;
        if from.is_finite() && to.is_finite() && !span.is_finite() {
            return Err(AxisError::Wide { from, to });
        }
        Self::range(name, Spacing::Linear, [from, to], count, |part| from + span * part)
    }

    /// An axis of `count` values with equal ratios, both ends included.
    ///
    /// # Errors
    /// As [`Axis::linear`]; ends that are zero, or of different signs.
    ///
    /// ```
    /// # use lindstedt_impact as lindstedt;
    /// use lindstedt::impact::sweep::Axis;
    ///
    /// assert_eq!(Axis::logarithmic("gamma", 1e4, 1e6, 3)?.values(), [1e4, 1e5, 1e6]);
    /// assert!(Axis::logarithmic("speed", -1.0, 1.0, 3).is_err());
    /// # Ok::<(), lindstedt::impact::sweep::AxisError>(())
    /// ```
    pub fn logarithmic(name: &str, from: f64, to: f64, count: usize) -> Result<Self, AxisError> {
        if from == 0.0 || to == 0.0 || from.signum() != to.signum() {
            return Err(AxisError::NoRatio { from, to });
        }
        // Powers of ten stay exact.
        let (first, last) = (from.abs().log10(), to.abs().log10());
        let value = |part: f64| from.signum() * 10_f64.powf(first + (last - first) * part);
        Self::range(name, Spacing::Logarithmic, [from, to], count, value)
    }

    fn range(
        name: &str,
        spacing: Spacing,
        [from, to]: [f64; 2],
        count: usize,
        value: impl Fn(f64) -> f64,
    ) -> Result<Self, AxisError> {
        if !(2..=MOST_MOTIONS).contains(&count) {
            return Err(AxisError::Count(count.to_string()));
        }
        let last = count - 1;
        let values = (0..count).map(|index| match index {
            0 => from,
            index if index == last => to,
            index => value(index as f64 / last as f64),
        });
        Self::new(name, spacing, values.collect())
    }

    /// These values, in this order.
    ///
    /// # Errors
    /// [`AxisError`], for values that are not finite or come twice, and for fewer than two or more
    /// than [`MOST_MOTIONS`].
    ///
    /// ```
    /// # use lindstedt_impact as lindstedt;
    /// use lindstedt::impact::sweep::{Axis, Spacing};
    ///
    /// let axis: Axis = "zeta=0.01,0.02,0.05".parse()?;
    /// assert_eq!(axis, Axis::list("zeta", vec![0.01, 0.02, 0.05])?);
    /// assert_eq!((axis.name(), axis.spacing()), ("zeta", Spacing::List));
    /// # Ok::<(), lindstedt::impact::sweep::AxisError>(())
    /// ```
    pub fn list(name: &str, values: Vec<f64>) -> Result<Self, AxisError> {
        match (2..=MOST_MOTIONS).contains(&values.len()) {
            true => Self::new(name, Spacing::List, values),
            false => Err(AxisError::Count(values.len().to_string())),
        }
    }

    fn new(name: &str, spacing: Spacing, values: Vec<f64>) -> Result<Self, AxisError> {
        if let Some(value) = values.iter().find(|value| !value.is_finite()) {
            return Err(AxisError::Number(value.to_string()));
        }
        let mut sorted = values.clone();
        sorted.sort_by(f64::total_cmp);
        if let Some(pair) = sorted.windows(2).find(|pair| pair[0] == pair[1]) {
            return Err(AxisError::Twice { name: name.to_owned(), value: pair[1] });
        }
        Ok(Self { name: name.to_owned(), spacing, values })
    }

    /// The name of the parameter, such as that of a [`Parameter`](crate::impact::Parameter).
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The spacing of the values.
    pub fn spacing(&self) -> Spacing {
        self.spacing
    }

    /// The values, in order: two or more, finite, no two of them equal.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The first value and the last.
    pub fn ends(&self) -> [f64; 2] {
        [self.values[0], self.values[self.values.len() - 1]]
    }
}

impl FromStr for Axis {
    type Err = AxisError;

    fn from_str(text: &str) -> Result<Self, AxisError> {
        let form = || AxisError::Form(text.to_owned());
        let (name, values) = text.split_once('=').ok_or_else(form)?;
        let name = Some(name.trim()).filter(|name| !name.is_empty()).ok_or_else(form)?;
        let number = |text: &str| match text.trim().parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            _ => Err(AxisError::Number(text.trim().to_owned())),
        };
        if values.contains(',') && !values.contains(':') {
            return Self::list(name, values.split(',').map(number).collect::<Result<_, _>>()?);
        }
        let parts: Vec<&str> = values.split(':').map(str::trim).collect();
        let (from, to, count, spacing) = match parts[..] {
            [from, to, count] => (from, to, count, "lin"),
            [from, to, count, spacing] => (from, to, count, spacing),
            _ => return Err(form()),
        };
        let (from, to) = (number(from)?, number(to)?);
        let count = count.parse().map_err(|_| AxisError::Count(count.to_owned()))?;
        match spacing {
            "lin" | "linear" => Self::linear(name, from, to, count),
            "log" | "logarithmic" => Self::logarithmic(name, from, to, count),
            other => Err(AxisError::Spacing {
                name: other.to_owned(),
                nearest: nearest(other, ["log", "lin"]),
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axis(text: &str) -> Result<Axis, AxisError> {
        text.parse()
    }

    #[test]
    fn a_range_is_read_and_ends_where_it_says() {
        let range = axis("zeta=0.01:0.07:4").unwrap();
        assert_eq!((range.name(), range.values().len()), ("zeta", 4));
        assert_eq!(range.ends(), [0.01, 0.07]);
        assert_eq!(axis("zeta=0.01:0.07:4:lin").unwrap(), range);
        assert_eq!(axis(" zeta = 3 , -1,2e0").unwrap().values(), [3.0, -1.0, 2.0]);
        for wrong in [
            "zeta",
            "zeta=1:2",
            "zeta=1",
            "zeta=1,2:3,4",
            "zeta=1:2:3:log:5",
            "=1:2:3",
            "zeta=a:2:3",
            "zeta=1:inf:3",
            "zeta=1,,2",
            "zeta=1:2:1",
            "zeta=1:2:2.5",
            "zeta=1:2:1000001",
            "zeta=-1e308:1e308:3",
        ] {
            assert!(axis(wrong).is_err(), "{wrong}");
        }
        let message = axis("zeta=1:2:3:logg").unwrap_err().to_string();
        assert!(message.contains("did you mean `log`?"), "{message}");
    }

    #[test]
    fn equal_ratios_lead_from_one_end_to_the_other() {
        let decades = axis("gamma=1e-2:1e9:12:log").unwrap();
        for (value, exponent) in decades.values().iter().zip(-2..) {
            assert!((value / 10_f64.powi(exponent) - 1.0).abs() < 1e-15, "{value}");
        }
        let falling = axis("start=-2:-1e-3:7:log").unwrap();
        assert_eq!(falling.ends(), [-2.0, -1e-3]);
        let ratios = falling.values().windows(2).map(|pair| pair[1] / pair[0]);
        for ratio in ratios {
            assert!((ratio / 5e-4_f64.powf(1.0 / 6.0) - 1.0).abs() < 1e-14, "{ratio}");
        }
        for wrong in ["speed=-1:1:3:log", "mu=0:1e5:3:log", "mu=1e5:-0:3:log"] {
            assert!(matches!(axis(wrong), Err(AxisError::NoRatio { .. })), "{wrong}");
        }
    }

    #[test]
    fn no_value_comes_twice() {
        for wrong in
            ["mu=1,2,1", "mu=0,-0", "mu=3:3:2", "mu=3:3:2:log", "mu=1:1.0000000000000002:9"]
        {
            assert!(matches!(axis(wrong), Err(AxisError::Twice { .. })), "{wrong}");
        }
    }
}
