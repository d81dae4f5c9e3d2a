//! The motion as a function of time, piece by piece: the polynomials of the Taylor steps, the Runge-Kutta path, or the formulas of a
//! chain.
//!
//! In contact a piece is a polynomial in s with dt = w ds, x = x_r + w^2: to ask for a time is to solve t(s) = t first,
//! which has one solution because t rises with s.

use super::closed::ClosedForm;
use crate::impact::model::Side;
use crate::impact::polynomial::{crossing_of, value};
use crate::numeric::ode::Trajectory;
use crate::numeric::ode::quadrature::nodes_and_weights;

/// What the pendulum is doing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Regime {
    /// Swinging freely.
    Free,
    /// Pressing into a barrier.
    Contact(Side),
    /// Leaving a barrier faster than the barrier comes back: inside it, but without force.
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
pub struct Piece {
    /// Where it begins.
    pub start: f64,
    /// Where it ends.
    pub end: f64,
    /// What happens there.
    pub regime: Regime,
    form: Representation,
}

impl Piece {
    /// The formula of this stretch, where it has one: in a chain.
    pub fn closed_form(&self) -> Option<ClosedForm> {
        match self.form {
            Representation::Closed(form) => Some(form),
            _ => None,
        }
    }
}

/// How x and x' are kept.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Representation {
    /// Coefficients of x and x' in (t - start)/unit, from this place of the pool on.
    Time { offset: usize, terms: usize, unit: f64 },
    /// Coefficients of w, x' and t - start in s/unit; the series ends at `length`.
    Regularised {
        offset: usize,
        terms: usize,
        length: f64,
        barrier: f64,
        sign: f64,
        unit: f64,
    },
    /// Not moving.
    Constant { x: f64 },
    /// See the trajectory of Runge and Kutta; in contact it counts from the barrier.
    Judged { origin: f64, sign: f64 },
    /// A formula.
    Closed(ClosedForm),
}

/// The whole motion.
#[derive(Debug, Clone)]
pub struct Path {
    pieces: Vec<Piece>,
    pool: Vec<f64>,
    judge: Option<Trajectory>,
}

/// A point of the motion inside a piece.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::impact) struct Node {
    pub(in crate::impact) t: f64,
    pub(in crate::impact) x: f64,
    pub(in crate::impact) velocity: f64,
    /// How far inside the barrier, more exactly than x tells.
    pub(in crate::impact) depth: f64,
    /// dt at this point, for an integral over time.
    pub(in crate::impact) weight: f64,
}

impl Path {
    pub(in crate::impact) fn new() -> Self {
        Self {
            pieces: Vec::new(),
            pool: Vec::new(),
            judge: None,
        }
    }

    pub(in crate::impact) fn judged(judge: Trajectory) -> Self {
        Self {
            judge: Some(judge),
            ..Self::new()
        }
    }

    /// Displacement (rad) and velocity at a time; nothing outside the time covered.
    pub fn at(&self, t: f64) -> Option<(f64, f64)> {
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
    pub fn pieces(&self) -> &[Piece] {
        &self.pieces
    }

    /// The regime in force at a time; nothing outside the time covered.
    pub fn regime_at(&self, t: f64) -> Option<Regime> {
        let last = self.pieces.last()?;
        if t > last.end {
            return None;
        }
        let index = self.pieces.partition_point(|piece| piece.start <= t).checked_sub(1)?;
        Some(self.pieces.get(index)?.regime)
    }

    /// `(t, x, x')` at the ends of the pieces and at `between` times inside each, equally spaced in the variable of
    /// the piece, so that a contact gets as many as a swing.
    pub fn points(&self, between: usize) -> impl Iterator<Item = (f64, f64, f64)> + '_ {
        let inside = move |piece: &Piece| {
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

    pub(in crate::impact) fn push_flight(
        &mut self,
        span: [f64; 2],
        regime: Regime,
        unit: f64,
        x: &[f64],
        velocity: &[f64],
    ) {
        let offset = self.pool.len();
        self.pool.extend_from_slice(x);
        self.pool.extend_from_slice(velocity);
        let terms = x.len();
        self.push(span, regime, Representation::Time { offset, terms, unit });
    }

    pub(in crate::impact) fn push_contact(
        &mut self,
        span: [f64; 2],
        (side, barrier): (Side, f64),
        length: f64,
        unit: f64,
        [w, velocity, time]: [&[f64]; 3],
    ) {
        let offset = self.pool.len();
        self.pool.extend_from_slice(w);
        self.pool.extend_from_slice(velocity);
        self.pool.extend_from_slice(time);
        let form = Representation::Regularised {
            offset,
            terms: w.len(),
            length,
            barrier,
            sign: side.sign(),
            unit,
        };
        self.push(span, Regime::Contact(side), form);
    }

    pub(in crate::impact) fn push_closed(&mut self, span: [f64; 2], regime: Regime, form: ClosedForm) {
        self.push(span, regime, Representation::Closed(form));
    }

    /// Goes on with another path of power series, whose clock begins at this time.
    pub(in crate::impact) fn extend(&mut self, other: &Self, from: f64) {
        let shift = self.pool.len();
        self.pool.extend_from_slice(&other.pool);
        self.pieces.extend(other.pieces.iter().map(|piece| {
            let mut piece = *piece;
            piece.start += from;
            piece.end += from;
            if let Representation::Time { offset, .. } | Representation::Regularised { offset, .. } = &mut piece.form {
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

    /// A step of the judge, whose coordinate is counted from `origin` in the direction of `sign`.
    pub(in crate::impact) fn push_judged(&mut self, span: [f64; 2], regime: Regime, [origin, sign]: [f64; 2]) {
        self.push(span, regime, Representation::Judged { origin, sign });
    }

    fn push(&mut self, [start, end]: [f64; 2], regime: Regime, form: Representation) {
        self.pieces.push(Piece {
            start,
            end,
            regime,
            form,
        });
    }

    /// Points and weights of a quadrature over a part of a piece, from one fraction of it to another: exact to rounding where
    /// the motion is a power series that converges over it.
    pub(in crate::impact) fn quadrature(&self, piece: &Piece, [from, to]: [f64; 2]) -> impl Iterator<Item = Node> + '_ {
        let piece = *piece;
        nodes_and_weights(from, to).map(move |(fraction, weight)| {
            let node = self.node(&piece, fraction);
            Node {
                weight: weight * node.weight,
                ..node
            }
        })
    }

    fn slice(&self, offset: usize, terms: usize) -> &[f64] {
        self.pool.get(offset..offset + terms).unwrap_or_default()
    }

    /// The point at a fraction of the piece, counted in the variable of the piece.
    pub(in crate::impact) fn node(&self, piece: &Piece, fraction: f64) -> Node {
        let length = piece.end - piece.start;
        match piece.form {
            Representation::Regularised {
                offset,
                terms,
                length,
                barrier,
                sign,
                unit,
            } => {
                let s = fraction * length;
                let w = value(self.slice(offset, terms), s);
                let velocity = value(self.slice(offset + terms, terms), s);
                let time = value(self.slice(offset + 2 * terms, terms), s);
                Node {
                    t: piece.start + time,
                    x: barrier + sign * w * w,
                    velocity: sign * velocity,
                    depth: w * w,
                    weight: w * length * unit,
                }
            }
            _ => Node {
                weight: length,
                ..self.node_at(piece, piece.start + fraction * length)
            },
        }
    }

    fn node_at(&self, piece: &Piece, t: f64) -> Node {
        let node = |x: f64, velocity: f64| Node {
            t,
            x,
            velocity,
            depth: 0.0,
            weight: 0.0,
        };
        match piece.form {
            Representation::Time { offset, terms, unit } => {
                let u = (t - piece.start) / unit;
                node(
                    value(self.slice(offset, terms), u),
                    value(self.slice(offset + terms, terms), u),
                )
            }
            Representation::Regularised {
                offset, terms, length, ..
            } => {
                let time = self.slice(offset + 2 * terms, terms);
                let wanted = t - piece.start;
                let s = match wanted {
                    _ if wanted <= 0.0 => 0.0,
                    _ if t >= piece.end => length,
                    _ => crossing_of(|s| value(time, s) - wanted, 0.0, length),
                };
                self.node(piece, s / length)
            }
            Representation::Constant { x } => node(x, 0.0),
            Representation::Closed(form) => {
                let (x, velocity) = form.at(t - piece.start);
                let depth = match (form, piece.regime) {
                    (ClosedForm::Contact { barrier, .. }, Regime::Contact(side)) => {
                        (side.sign() * (x - barrier)).max(0.0)
                    }
                    _ => 0.0,
                };
                Node {
                    depth,
                    ..node(x, velocity)
                }
            }
            Representation::Judged { origin, sign } => {
                // The end of a step may be the beginning of another phase, with another coordinate.
                let inside = t.clamp(piece.start, piece.end.next_down().max(piece.start));
                let (value, velocity) = self
                    .judge
                    .as_ref()
                    .and_then(|path| path.at(inside))
                    .unwrap_or((0.0, 0.0));
                Node {
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
