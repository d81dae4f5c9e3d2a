//! Table 1 of the paper, recomputed, and the value of pi with which its digits were computed.
//!
//! The printed digits in [`SPEEDS`] serve only for comparison, and for the range of pi that they
//! allow. They are read from Table 1 of the paper as it is printed, signs and number of digits
//! included.

use std::f64::consts::PI;

use crate::impact::STEEPNESS;
use crate::impact::friction::{FrictionStudy, SpeedRow, arctangent, arctangent_error};

/// The printed entries of one speed: the arctangent and its error in per cent.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PrintedSpeed {
    /// (2/pi) atan(100 x').
    pub value: &'static str,
    /// The error in per cent.
    pub error: &'static str,
}

/// The speeds of Table 1, each with its printed entries.
pub const SPEEDS: [(f64, PrintedSpeed); 11] = [
    (-5.0, PrintedSpeed { value: "-0.99923", error: "0.07667" }),
    (-4.0, PrintedSpeed { value: "-0.99891", error: "0.10851" }),
    (-3.0, PrintedSpeed { value: "-0.99838", error: "0.16159" }),
    (-2.0, PrintedSpeed { value: "-0.99732", error: "0.26775" }),
    (-1.0, PrintedSpeed { value: "-0.99414", error: "0.58620" }),
    (0.0, PrintedSpeed { value: "0.00000", error: "0.00000" }),
    (1.0, PrintedSpeed { value: "+0.99413", error: "0.58620" }),
    (2.0, PrintedSpeed { value: "+0.99732", error: "0.267747" }),
    (3.0, PrintedSpeed { value: "+0.99838", error: "0.161592" }),
    (4.0, PrintedSpeed { value: "+0.99891", error: "0.108514" }),
    (5.0, PrintedSpeed { value: "+0.99923", error: "0.076667" }),
];

/// The values of pi that are tried: short decimals, fractions, and pi itself.
const TRIED: [&str; 11] =
    ["3", "3.1", "22/7", "3.14", "3.141", "3.142", "3.1415", "3.1416", "3.14159", "355/113", "pi"];

/// The value of such a name: a decimal, a fraction, or pi itself.
fn value_of(name: &str) -> f64 {
    let (above, below) = name.split_once('/').unwrap_or((name, "1"));
    match (above.parse::<f64>(), below.parse::<f64>()) {
        (Ok(above), Ok(below)) => above / below,
        _ => PI,
    }
}

/// Whether a number has the printed digits if it is rounded, and if it is cut off.
fn has_digits(printed: &str, number: f64) -> [bool; 2] {
    let wanted = printed.trim_start_matches('+');
    let decimals = wanted.split_once('.').map_or(0, |(_, digits)| digits.len());
    let unit = 10_f64.powi(decimals as i32);
    [number, (number * unit).trunc() / unit].map(|number| {
        // A zero is printed without a sign.
        let written = format!("{number:.decimals$}");
        written == wanted || number == 0.0 && written.trim_start_matches('-') == wanted
    })
}

/// A printed number, and whether a computed number gives its digits with some pi.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PrintedDigits {
    /// The entry as it is printed.
    pub printed: &'static str,
    /// Whether its digits are those of the rounded number.
    pub rounded: bool,
    /// Whether its digits are those of the number cut off.
    pub cut: bool,
}

impl PrintedDigits {
    fn new(printed: &'static str, number: f64) -> Self {
        let [rounded, cut] = has_digits(printed, number);
        Self { printed, rounded, cut }
    }

    /// `rounded`, `cut`, `either` or `neither`.
    pub fn treatment(self) -> &'static str {
        match (self.rounded, self.cut) {
            (true, true) => "either",
            (true, false) => "rounded",
            (false, true) => "cut",
            (false, false) => "neither",
        }
    }
}

/// A row of the table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TableRow {
    /// The two laws at its speed.
    pub laws: SpeedRow,
    /// The printed value and error at a speed of the paper, compared with those by the best pi;
    /// `None` at any other speed.
    pub printed: Option<[PrintedDigits; 2]>,
}

/// The number of printed entries that one value of pi reproduces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PiReading {
    /// The value as it is written, `22/7`.
    pub name: &'static str,
    /// The value.
    pub value: f64,
    /// Number of entries that it reproduces rounded.
    pub rounded: usize,
    /// Number of entries that it reproduces cut off.
    pub cut: usize,
    /// Number of entries that it reproduces in one of the two ways.
    pub either: usize,
}

impl PiReading {
    fn new(name: &'static str, value: f64) -> Self {
        let entries: Vec<PrintedDigits> =
            SPEEDS.iter().flat_map(|(speed, printed)| entries(*speed, printed, value)).collect();
        let count = |wanted: fn(&PrintedDigits) -> bool| {
            entries.iter().filter(|entry| wanted(entry)).count()
        };
        Self {
            name,
            value,
            rounded: count(|entry| entry.rounded),
            cut: count(|entry| entry.cut),
            either: count(|entry| entry.rounded || entry.cut),
        }
    }

    /// The limit of the arctangent at high speed with this value, 1 with pi itself.
    pub fn limit(&self) -> f64 {
        PI / self.value
    }

    /// The speed beyond which the arctangent is larger than 1, if there is one; `None` otherwise.
    pub fn exceeds_from(&self) -> Option<f64> {
        (self.value < PI).then(|| (0.5 * self.value).tan() / STEEPNESS)
    }
}

fn entries(speed: f64, printed: &PrintedSpeed, pi: f64) -> [PrintedDigits; 2] {
    [
        PrintedDigits::new(printed.value, arctangent(speed, pi)),
        PrintedDigits::new(printed.error, arctangent_error(speed, pi)),
    ]
}

/// Table 1, recomputed and searched.
#[derive(Debug, Clone, PartialEq)]
pub struct FrictionTable {
    /// The two laws at the paper's speeds, then at those asked for.
    pub rows: Vec<TableRow>,
    /// Every value of pi that was tried.
    pub readings: Vec<PiReading>,
    /// The least and the greatest pi with which every printed entry comes out, rounded or cut off;
    /// `None` if none does.
    pub pi_range: Option<[f64; 2]>,
    best: usize,
}

impl FrictionTable {
    /// Table 1 of the paper, and the speeds of a study that it does not contain.
    ///
    /// ```
    /// use lindstedt::{audit::paper::FrictionTable, impact::friction};
    ///
    /// let table = FrictionTable::from_study(&friction::study(friction::FrictionSetup::default())?);
    /// assert_eq!((table.best().name, table.best().either), ("3.14", table.entries()));
    /// # Ok::<(), friction::FrictionError>(())
    /// ```
    pub fn from_study(study: &FrictionStudy) -> Self {
        let readings: Vec<PiReading> =
            TRIED.map(|name| PiReading::new(name, value_of(name))).into();
        // Among equally good values the first is chosen, which is the shortest.
        let best = (0..readings.len())
            .rev()
            .max_by_key(|index| (readings[*index].either, readings[*index].rounded));
        let best = best.unwrap_or_default();
        let pi = readings[best].value;
        let own = SPEEDS.iter().map(|(speed, printed)| TableRow {
            laws: SpeedRow::new(*speed),
            printed: Some(entries(*speed, printed, pi)),
        });
        let others = study.rows.iter().map(|laws| TableRow { laws: *laws, printed: None });
        Self { rows: own.chain(others).collect(), pi_range: pi_range(), readings, best }
    }

    /// The pi with which most printed entries come out.
    pub fn best(&self) -> &PiReading {
        &self.readings[self.best]
    }

    /// The number of printed entries, values and errors.
    pub fn entries(&self) -> usize {
        2 * SPEEDS.len()
    }
}

/// The values of pi with which every printed entry comes out: each allows a range, since value and
/// error are monotonic in pi.
fn pi_range() -> Option<[f64; 2]> {
    let mut range = [f64::MIN_POSITIVE, f64::MAX];
    for (speed, printed) in SPEEDS.iter().filter(|(speed, _)| *speed != 0.0) {
        let twice = 2.0 * (STEEPNESS * speed.abs()).atan();
        let allowed = |text: &str| -> Option<[f64; 2]> {
            let size = text.trim_start_matches(['+', '-']);
            let unit = 0.1_f64.powi(size.split_once('.')?.1.len() as i32);
            let size: f64 = size.parse().ok()?;
            // The range extends from half a unit below (rounded up) to one unit above (cut off).
            Some([size - 0.5 * unit, size + unit])
        };
        let [least, greatest] = allowed(printed.value)?;
        let by_value = [twice / greatest, twice / least];
        let by_error = allowed(printed.error)?.map(|error| twice / (1.0 - error / 100.0));
        for [least, greatest] in [by_value, by_error] {
            range = [range[0].max(least), range[1].min(greatest)];
        }
    }
    (range[0] <= range[1]).then_some(range)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_rounded_or_cut() {
        assert_eq!(has_digits("+0.99413", 0.994138), [false, true]);
        assert_eq!(has_digits("-0.99414", -0.994138), [true, false]);
        assert_eq!(has_digits("0.00000", -0.0), [true, true]);
        assert_eq!(has_digits("0.5", 0.61), [false, false]);
        assert_eq!(PrintedDigits::new("-0.5", -0.54).treatment(), "either");
    }

    #[test]
    fn the_range_of_pi_is_where_every_entry_comes_out() {
        let [least, greatest] = pi_range().unwrap();
        let all = |pi: f64| PiReading::new("", pi).either == 2 * SPEEDS.len();
        let width = greatest - least;
        assert!(width > 0.0 && width < 1e-6, "{width}");
        for part in [0.01, 0.5, 0.99] {
            assert!(all(least + part * width), "{part}");
        }
        assert!(!all(least - 0.01 * width) && !all(greatest + 0.01 * width));
    }

    #[test]
    fn every_value_tried_is_near_pi() {
        assert!(TRIED.iter().all(|name| (value_of(name) - PI).abs() < 0.2));
        assert_eq!((value_of("22/7"), value_of("pi")), (22.0 / 7.0, PI));
    }

    #[test]
    fn a_short_pi_overshoots() {
        let short = value_of("3.14");
        let reading = PiReading::new("3.14", short);
        let speed = reading.exceeds_from().unwrap();
        assert!((arctangent(speed, short) - 1.0).abs() < 1e-14);
        assert!(
            arctangent(1e9, short) > 1.0005
                && (reading.limit() - arctangent(1e12, short)).abs() < 1e-12
        );
        assert_eq!(PiReading::new("pi", PI).exceeds_from(), None);
    }
}
