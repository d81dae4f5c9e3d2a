//! The energy balance: the work of each force that is not conservative, integrated along the
//! motion.
//!
//! ```text
//! W_viscous = -int 2 zeta x'^2 dt          W_friction   = -int alpha sgn(x') x' dt
//! W_contact = -int mu d'^2 d^(3/2) dt      W_excitation =  int beta sin(Omega t/omega) cos x x' dt
//! residual  = E(t) - E(0) - (W_viscous + W_friction + W_contact + W_excitation)
//! ```
//!
//! The forces are those of the model, the motion is the computed one, the integrals are
//! quadratures: a motion that does not satisfy the equation leaves a residual. Where a barrier lets
//! go because it would have to pull, the energy still stored in it counts as lost to its damping.

use super::Simulation;
use super::path::{QuadratureNode, Regime};
use crate::impact::hertz;
use crate::impact::model::{Friction, Side};

/// The most points inside one step.
const MOST_PARTS: f64 = 1e4;

/// Energies and works, in units of m g L.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct EnergyBook {
    /// The energy at the start.
    pub start: f64,
    /// The energy at the end.
    pub end: f64,
    /// Work of viscous damping, never positive.
    pub viscous: f64,
    /// Work of dry friction, never positive.
    pub friction: f64,
    /// Work of the damping in the contacts.
    pub contact: f64,
    /// Work of the moving pivot.
    pub excitation: f64,
    /// The largest |E(t) - E(0) - works| at any knot, relative to the largest energy met.
    pub residual: f64,
}

impl EnergyBook {
    fn works(&self) -> f64 {
        self.viscous + self.friction + self.contact + self.excitation
    }
}

/// Energy and works up to a knot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EnergyPoint {
    /// Time.
    pub t: f64,
    /// Energy then, units of m g L.
    pub energy: f64,
    /// Works until then; [`EnergyBook::residual`] is the signed difference in these.
    pub book: EnergyBook,
}

impl Simulation {
    /// Energy and the work of each force over the whole run.
    pub fn energy(&self) -> EnergyBook {
        let mut largest = 0.0_f64;
        let mut worst = 0.0_f64;
        let mut total = EnergyBook::default();
        self.energy_points(f64::INFINITY, |point| {
            largest = largest.max(point.energy);
            worst = worst.max(point.book.residual.abs());
            total = point.book;
        });
        total.residual = if worst == 0.0 { 0.0 } else { worst / largest };
        total
    }

    /// Energy and works knot by knot, and, between knots that lie further apart than `longest`, in
    /// units of 1/omega, at points in between.
    pub fn energy_points(&self, longest: f64, mut each: impl FnMut(EnergyPoint)) {
        let model = &self.model;
        let start = model.energy(self.start.x, self.start.velocity);
        let mut book = EnergyBook { start, end: start, ..EnergyBook::default() };
        each(EnergyPoint { t: 0.0, energy: start, book });
        for piece in self.path.pieces() {
            let parts = ((piece.end - piece.start) / longest).ceil().clamp(1.0, MOST_PARTS) as u32;
            let stored = |fraction: f64| {
                let node = self.path.node(piece, fraction);
                (model.elastic_energy(self.depth(piece.regime, &node)), node)
            };
            for part in 0..parts {
                let span = [part, part + 1].map(|end| f64::from(end) / f64::from(parts));
                for node in self.path.quadrature(piece, span) {
                    let v = node.velocity;
                    book.viscous -= node.weight * 2.0 * model.zeta * v * v;
                    let direction = if piece.regime == Regime::Stuck { 0.0 } else { v.signum() };
                    let dry = match model.friction {
                        Friction::Exact => model.alpha * direction * v,
                        Friction::Arctangent => -(model.damping(v, 0.0) + 2.0 * model.zeta * v) * v,
                    };
                    book.friction -= node.weight * dry;
                    book.excitation +=
                        node.weight * (model.field(node.t, node.x) + node.x.sin()) * v;
                    if let Regime::Contact(_) = piece.regime {
                        // mu d' d^(3/2), times d' dt.
                        book.contact -= hertz::force(node.weight * model.mu * v * v, node.depth);
                    }
                }
                let (last, end) = stored(span[1]);
                if let Regime::Detached(_) = piece.regime {
                    book.contact += last - stored(span[0]).0;
                }
                book.end = model.swing_energy(end.x, end.velocity) + last;
                book.residual = book.end - start - book.works();
                each(EnergyPoint {
                    t: if part + 1 == parts { piece.end } else { end.t },
                    energy: book.end,
                    book,
                });
            }
        }
    }

    fn depth(&self, regime: Regime, node: &QuadratureNode) -> f64 {
        let inside = |side: Side| {
            let barrier = self.model.barrier(side).unwrap_or(node.x);
            (side.sign() * (node.x - barrier)).max(0.0)
        };
        match regime {
            Regime::Contact(side) if node.depth == 0.0 => inside(side),
            Regime::Contact(_) => node.depth,
            Regime::Detached(side) => inside(side),
            Regime::Stuck => self.model.depth(node.x).map_or(0.0, |(_, depth)| depth),
            Regime::Free => 0.0,
        }
    }
}
