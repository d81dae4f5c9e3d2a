//! Integrals by Gauss and Legendre on panels that are halved until they agree; roots by bisection;
//! linear equations.

use std::sync::OnceLock;

const NODES: usize = 16;

/// Nodes and weights on [-1, 1], by Newton's iteration on the Legendre polynomial.
fn nodes_and_weights() -> &'static [(f64, f64)] {
    static TABLE: OnceLock<Vec<(f64, f64)>> = OnceLock::new();
    TABLE.get_or_init(|| {
        let node = |i: usize| {
            let mut x = (std::f64::consts::PI * (i as f64 + 0.75) / (NODES as f64 + 0.5)).cos();
            let mut slope = 1.0;
            for _ in 0..20 {
                let (mut before, mut value) = (1.0, x);
                for n in 1..NODES {
                    let next =
                        ((2 * n + 1) as f64 * x * value - n as f64 * before) / (n + 1) as f64;
                    (before, value) = (value, next);
                }
                slope = NODES as f64 * (x * value - before) / (x * x - 1.0);
                x -= value / slope;
            }
            (x, 2.0 / ((1.0 - x * x) * slope * slope))
        };
        (0..NODES).map(node).collect()
    })
}

/// The integral of `f` and that of its size over one panel.
fn panel(f: &dyn Fn(f64) -> f64, from: f64, to: f64) -> (f64, f64) {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let (mut sum, mut size) = (0.0, 0.0);
    for (x, w) in nodes_and_weights() {
        let value = w * f(middle + half * x);
        sum += value;
        size += value.abs();
    }
    (sum * half, size * half.abs())
}

/// Panels from the first to the last of `places`, ascending, on each of which one rule is as good
/// as two on its halves.
fn panels(f: &dyn Fn(f64) -> f64, places: &[f64], tolerance: f64) -> Option<Vec<(f64, f64, f64)>> {
    const MOST: usize = 4000;
    let mut open: Vec<(f64, f64, (f64, f64), u32)> = places
        .windows(2)
        .rev()
        .filter(|pair| pair[1] > pair[0])
        .map(|pair| (pair[0], pair[1], panel(f, pair[0], pair[1]), 0))
        .collect();
    let mut size: f64 = open.iter().map(|panel| panel.2.1).sum();
    let mut done: Vec<(f64, f64, f64)> = Vec::new();
    while let Some((from, to, whole, depth)) = open.pop() {
        let middle = 0.5 * (from + to);
        let (left, right) = (panel(f, from, middle), panel(f, middle, to));
        let change = (left.0 + right.0 - whole.0).abs();
        let here = left.1 + right.1;
        size = size.max(here);
        if !change.is_finite() || depth > 60 || open.len() + done.len() > MOST {
            return None;
        }
        if change <= tolerance * size
            || change <= 16.0 * f64::EPSILON * here
            || middle == from
            || middle == to
        {
            done.push((from, to, left.0 + right.0));
        } else {
            open.push((middle, to, right, depth + 1));
            open.push((from, middle, left, depth + 1));
        }
    }
    Some(done)
}

/// The integral from the first to the last of `places`, which are ascending and hold every place
/// where `f` may turn fast; `None` where it does not settle to `tolerance` of the integral of
/// `|f|`.
pub fn integrate(f: &dyn Fn(f64) -> f64, places: &[f64], tolerance: f64) -> Option<f64> {
    Some(panels(f, places, tolerance)?.iter().map(|panel| panel.2).sum())
}

/// The integrals of one function from any place to either end of an interval.
pub struct Integrals<'a> {
    f: &'a dyn Fn(f64) -> f64,
    panels: Vec<(f64, f64, f64)>,
    /// Up to the left edge of each panel, and from its right edge on.
    before: Vec<f64>,
    after: Vec<f64>,
}

impl<'a> Integrals<'a> {
    pub fn new(f: &'a dyn Fn(f64) -> f64, places: &[f64], tolerance: f64) -> Option<Self> {
        let panels = panels(f, places, tolerance)?;
        let sums = |values: &mut dyn Iterator<Item = f64>| {
            let mut sum = 0.0;
            values
                .map(|value| {
                    sum += value;
                    sum - value
                })
                .collect::<Vec<f64>>()
        };
        let before = sums(&mut panels.iter().map(|panel| panel.2));
        let mut after = sums(&mut panels.iter().rev().map(|panel| panel.2));
        after.reverse();
        Some(Self { f, panels, before, after })
    }

    fn holding(&self, x: f64) -> usize {
        self.panels.partition_point(|panel| panel.1 < x).min(self.panels.len() - 1)
    }

    /// The integral from the left end to `x`.
    pub fn up_to(&self, x: f64) -> f64 {
        let k = self.holding(x);
        self.before[k] + panel(self.f, self.panels[k].0, x).0
    }

    /// The integral from `x` to the right end.
    pub fn beyond(&self, x: f64) -> f64 {
        let k = self.holding(x);
        self.after[k] + panel(self.f, x, self.panels[k].1).0
    }
}

/// The place between `low` and `high` where `f` changes its sign, to the last digit.
pub fn bisect(f: &dyn Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    let sign = f(low) > 0.0;
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if middle == low || middle == high {
            break;
        }
        if (f(middle) > 0.0) == sign {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

/// The solution of linear equations by elimination with the largest pivot; `None` where they are
/// singular to rounding.
pub fn solve(mut rows: Vec<Vec<f64>>) -> Option<Vec<f64>> {
    let count = rows.len();
    for column in 0..count {
        let size = |row: &Vec<f64>| {
            row.iter().take(count).fold(0.0, |most: f64, value| most.max(value.abs()))
        };
        let pivot = (column..count).max_by(|&a, &b| {
            let share = |i: usize| rows[i][column].abs() / size(&rows[i]).max(f64::MIN_POSITIVE);
            share(a).total_cmp(&share(b))
        })?;
        rows.swap(column, pivot);
        let lead = rows[column][column];
        if !lead.is_finite() || lead.abs() <= 1e-13 * size(&rows[column]) {
            return None;
        }
        for i in 0..count {
            if i == column {
                continue;
            }
            let factor = rows[i][column] / lead;
            let pivot = rows[column].clone();
            for (value, above) in rows[i].iter_mut().zip(pivot) {
                *value -= factor * above;
            }
        }
    }
    let value = |i: usize| rows[i][count] / rows[i][i];
    Some((0..count).map(value).collect())
}
