//! The motion as a function of time, piece by piece: the polynomials of the Taylor steps, the
//! Runge-Kutta path, or the formulas of a chain.
//!
//! A step of a series has its own variable r: for a given time t(r) = t is solved first, which has
//! one solution because t increases with r. In contact x = x_r + w^2, and the polynomials are those
//! of w.

use super::closed::ClosedForm;
use crate::impact::model::Side;
use crate::impact::polynomial::{crossing_of, value, value_and_slope};
use crate::numeric::ode::Trajectory;
use crate::numeric::ode::quadrature::nodes_and_weights;

/// The mode of the pendulum.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Regime {
    /// Swinging freely.
    Free,
    /// Pressing into a barrier.
    Contact(Side),
    /// Leaving a barrier faster than the barrier returns: inside it, but without force.
    Detached(Side),
    /// Held by dry friction.
    Stuck,
}

impl Regime {
    /// One word, for tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Free => "free",
            Self::Contact(_) => "contact",
            Self::Detached(_) => "detached",
            Self::Stuck => "stuck",
        }
    }
}

/// A stretch of time in one regime, from knot to knot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathSegment {
    /// Time of its start.
    pub start: f64,
    /// Time of its end.
    pub end: f64,
    /// The mode of the pendulum in it.
    pub regime: Regime,
    form: Representation,
}

impl PathSegment {
    /// The formula of this stretch; `None` unless it belongs to a chain.
    pub fn closed_form(&self) -> Option<ClosedForm> {
        match self.form {
            Representation::Closed(form) => Some(form),
            _ => None,
        }
    }
}

/// The representation of x and x'.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Representation {
    /// Coefficients of x or w, x' and t - start, as many as `terms` says, from this index of the
    /// pool on; the series ends at `length`.
    Series {
        offset: usize,
        terms: [usize; 3],
        length: f64,
        /// In contact: the barrier and the sign of its side.
        behind: Option<[f64; 2]>,
    },
    /// A constant position.
    Constant { x: f64 },
    /// The Runge-Kutta trajectory holds the motion; in contact it counts from the barrier.
    Judged { origin: f64, sign: f64 },
    /// A formula.
    Closed(ClosedForm),
}

/// The whole motion.
#[derive(Debug, Clone)]
pub struct SimulationPath {
    pieces: Vec<PathSegment>,
    pool: Vec<f64>,
    judge: Option<Trajectory>,
}

/// A point of the motion inside a piece.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::impact) struct QuadratureNode {
    pub(in crate::impact) t: f64,
    pub(in crate::impact) x: f64,
    pub(in crate::impact) velocity: f64,
    /// Depth inside the barrier, with more digits than x has.
    pub(in crate::impact) depth: f64,
    /// dt at this point, for an integral over time.
    pub(in crate::impact) weight: f64,
}

impl SimulationPath {
    pub(in crate::impact) fn new() -> Self {
        Self { pieces: Vec::new(), pool: Vec::new(), judge: None }
    }

    pub(in crate::impact) fn judged(judge: Trajectory) -> Self {
        Self { judge: Some(judge), ..Self::new() }
    }

    /// Displacement (rad) and velocity at a time; `None` outside the time covered.
    pub fn phase_point_at(&self, t: f64) -> Option<(f64, f64)> {
        let last = self.pieces.last()?;
        if !(self.pieces.first()?.start..=last.end).contains(&t) {
            return None;
        }
        let index = self.pieces.partition_point(|piece| piece.start <= t).checked_sub(1)?;
        let piece = self.pieces.get(index)?;
        let node = self.node_at(piece, t);
        Some((node.x, node.velocity))
    }

    /// The stretches of time, in order.
    pub fn pieces(&self) -> &[PathSegment] {
        &self.pieces
    }

    /// The regime in force at a time; `None` outside the time covered.
    pub fn regime_at(&self, t: f64) -> Option<Regime> {
        let last = self.pieces.last()?;
        if t > last.end {
            return None;
        }
        let index = self.pieces.partition_point(|piece| piece.start <= t).checked_sub(1)?;
        Some(self.pieces.get(index)?.regime)
    }

    /// `(t, x, x')` at the ends of the pieces and at `between` times inside each, equally spaced in
    /// the variable of the piece, so that a contact gets as many as a swing.
    pub fn points(&self, between: usize) -> impl Iterator<Item = (f64, f64, f64)> + '_ {
        let inside = move |piece: &PathSegment| {
            let piece = *piece;
            (0..=between).map(move |index| {
                let node = self.node(&piece, index as f64 / (between + 1) as f64);
                (node.t, node.x, node.velocity)
            })
        };
        let last = self.pieces.last().map(|piece| {
            let node = self.node(piece, 1.0);
            (piece.end, node.x, node.velocity)
        });
        self.pieces.iter().flat_map(inside).chain(last)
    }

    /// Appends a step of a series that ends at `length`: x, x' and t - start, in contact w instead
    /// of x, behind a barrier.
    pub(in crate::impact) fn push_series(
        &mut self,
        span: [f64; 2],
        (regime, barrier): (Regime, Option<f64>),
        length: f64,
        series: [&[f64]; 3],
    ) {
        let offset = self.pool.len();
        for coefficients in series {
            self.pool.extend_from_slice(coefficients);
        }
        let behind = match (regime, barrier) {
            (Regime::Contact(side), Some(barrier)) => Some([barrier, side.sign()]),
            _ => None,
        };
        let form =
            Representation::Series { offset, terms: series.map(<[f64]>::len), length, behind };
        self.push(span, regime, form);
    }

    pub(in crate::impact) fn push_closed(
        &mut self,
        span: [f64; 2],
        regime: Regime,
        form: ClosedForm,
    ) {
        self.push(span, regime, Representation::Closed(form));
    }

    /// Appends another path of power series, whose clock begins at this time.
    pub(in crate::impact) fn extend(&mut self, other: &Self, from: f64) {
        let shift = self.pool.len();
        self.pool.extend_from_slice(&other.pool);
        self.pieces.extend(other.pieces.iter().map(|piece| {
            let mut piece = *piece;
            piece.start += from;
            piece.end += from;
            if let Representation::Series { offset, .. } = &mut piece.form {
                *offset += shift;
            }
            piece
        }));
    }

    pub(in crate::impact) fn push_rest(&mut self, span: [f64; 2], x: f64) {
        self.push(span, Regime::Stuck, Representation::Constant { x });
    }

    pub(in crate::impact) fn judged_phase(&self, t: f64) -> Option<usize> {
        self.judge.as_ref()?.phase_at(t)
    }

    /// Appends a step of Runge-Kutta, whose coordinate is counted from `origin` in the direction of
    /// `sign`.
    pub(in crate::impact) fn push_judged(
        &mut self,
        span: [f64; 2],
        regime: Regime,
        [origin, sign]: [f64; 2],
    ) {
        self.push(span, regime, Representation::Judged { origin, sign });
    }

    fn push(&mut self, [start, end]: [f64; 2], regime: Regime, form: Representation) {
        self.pieces.push(PathSegment { start, end, regime, form });
    }

    /// Points and weights of a quadrature over a part of a piece, from one fraction of it to
    /// another: exact to rounding where the motion is a power series that converges over it.
    pub(in crate::impact) fn quadrature(
        &self,
        piece: &PathSegment,
        [from, to]: [f64; 2],
    ) -> impl Iterator<Item = QuadratureNode> + '_ {
        let piece = *piece;
        nodes_and_weights(from, to).map(move |(fraction, weight)| {
            let node = self.node(&piece, fraction);
            QuadratureNode { weight: weight * node.weight, ..node }
        })
    }

    fn series(&self, mut offset: usize, terms: [usize; 3]) -> [&[f64]; 3] {
        terms.map(|terms| {
            let coefficients = self.pool.get(offset..offset + terms).unwrap_or_default();
            offset += terms;
            coefficients
        })
    }

    /// The point at a fraction of the piece, counted in the variable of the piece.
    pub(in crate::impact) fn node(&self, piece: &PathSegment, fraction: f64) -> QuadratureNode {
        let length = piece.end - piece.start;
        match piece.form {
            Representation::Series { offset, terms, length, behind } => {
                let u = fraction * length;
                let [place, velocity, time] = self.series(offset, terms);
                let (place, velocity) = (value(place, u), value(velocity, u));
                let (time, pace) = value_and_slope(time, u);
                let node = QuadratureNode {
                    t: piece.start + time,
                    x: place,
                    velocity,
                    depth: 0.0,
                    weight: pace * length,
                };
                match behind {
                    None => node,
                    Some([barrier, sign]) => QuadratureNode {
                        x: barrier + sign * place * place,
                        velocity: sign * velocity,
                        depth: place * place,
                        ..node
                    },
                }
            }
            _ => QuadratureNode {
                weight: length,
                ..self.node_at(piece, piece.start + fraction * length)
            },
        }
    }

    fn node_at(&self, piece: &PathSegment, t: f64) -> QuadratureNode {
        let node =
            |x: f64, velocity: f64| QuadratureNode { t, x, velocity, depth: 0.0, weight: 0.0 };
        match piece.form {
            Representation::Series { offset, terms, length, .. } => {
                let [_, _, time] = self.series(offset, terms);
                let wanted = t - piece.start;
                let u = match wanted {
                    _ if wanted <= 0.0 => 0.0,
                    _ if t >= piece.end => length,
                    _ => crossing_of(|u| value(time, u) - wanted, 0.0, length),
                };
                QuadratureNode { t, ..self.node(piece, u / length) }
            }
            Representation::Constant { x } => node(x, 0.0),
            Representation::Closed(form) => {
                let (x, velocity) = form.phase_point_at(t - piece.start);
                let depth = match (form, piece.regime) {
                    (ClosedForm::Contact { barrier, .. }, Regime::Contact(side)) => {
                        (side.sign() * (x - barrier)).max(0.0)
                    }
                    _ => 0.0,
                };
                QuadratureNode { depth, ..node(x, velocity) }
            }
            Representation::Judged { origin, sign } => {
                // The end of a step may be the beginning of another phase, with another coordinate.
                let inside = t.clamp(piece.start, piece.end.next_down().max(piece.start));
                let (value, velocity) = self
                    .judge
                    .as_ref()
                    .and_then(|path| path.phase_point_at(inside))
                    .unwrap_or((0.0, 0.0));
                QuadratureNode {
                    depth: if matches!(piece.regime, Regime::Contact(_)) {
                        value.max(0.0)
                    } else {
                        0.0
                    },
                    ..node(origin + sign * value, sign * velocity)
                }
            }
        }
    }
}
