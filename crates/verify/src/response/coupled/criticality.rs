//! Whether the motions that come off at a bifurcation are stable beside it.
//!
//! ```text
//! branch point        motions on one side alone: a pitchfork
//! period doubling     P(P(y; p); p) = y  near the orbit, in the direction of the multiplier -1
//! ```
//!
//! A motion of the new kind is followed a little way from the bifurcation. Where it stands on the side
//! on which the old motion is unstable, it has taken over the stability: the bifurcation is
//! supercritical.

use nalgebra::{DMatrix, DVector};

use super::equilibria::null_vector;
use super::problem::{Anchor, CoupledProblem, Kind, Orbit, Orbits, Travel, monodromy};
use crate::numeric::orbit_branch::{OrbitEquations, PeriodImage};
use crate::response::Criticality;
use crate::response::bifurcation::BifurcationKind;

/// Distance of the new motion from the bifurcation, in the sizes of the states.
const APART: f64 = 0.01;

impl CoupledProblem<'_> {
    /// The criticality of a bifurcation between two orbits of a branch; `None` where it is not known.
    pub(super) fn criticality(
        &self,
        kind: BifurcationKind,
        at: &Orbit,
        [from, to]: [&Orbit; 2],
        orbits: &Orbits,
        scale: &[f64],
    ) -> Option<Criticality> {
        let stable = |orbit: &Orbit| Some(self.is_stable(&self.multipliers(orbit)?));
        let [before, after] = [stable(from)?, stable(to)?];
        let here = at.parameter();
        if before == after || (from.parameter() - here) * (to.parameter() - here) >= 0.0 {
            return None;
        }
        let unstable = if before { to } else { from };
        let side = match kind {
            BifurcationKind::BranchPoint => {
                let beside = orbits.beside_crossing(at);
                let sides: Vec<f64> =
                    beside.iter().map(|orbit| (orbit.parameter() - here).signum()).collect();
                match sides.as_slice() {
                    [one, other] if one == other => *one,
                    _ => return None,
                }
            }
            BifurcationKind::PeriodDoubling => {
                (self.doubled(at, scale)?.parameter() - here).signum()
            }
            _ => return None,
        };
        Some(match side == (unstable.parameter() - here).signum() {
            true => Criticality::Supercritical,
            false => Criticality::Subcritical,
        })
    }

    /// A motion of twice the period near one with the multiplier -1; of driven systems.
    fn doubled(&self, at: &Orbit, scale: &[f64]) -> Option<Orbit> {
        if !matches!(self.kind, Kind::Driven(_)) {
            return None;
        }
        let n = self.states.len();
        let direction = null_vector(monodromy(at, n) + DMatrix::identity(n, n))?;
        let sizes = self.sizes(&at.kept, scale, &at.unknowns);
        let mut along = DVector::zeros(n + 1);
        for i in 0..n {
            along[i] = direction[i] / sizes[i];
        }
        let along = along.normalize();
        let guess = &at.unknowns + (&along * APART).component_mul(&sizes);
        self.with_orbits(scale, Anchor::NONE, |orbits| {
            let twice = |start: &DVector<f64>, parameter: f64| {
                let first = (orbits.map)(start, parameter)?;
                let second = (orbits.map)(&first.end, parameter)?;
                Some(PeriodImage {
                    by_start: &second.by_start * &first.by_start,
                    by_parameter: &second.by_start * &first.by_parameter + &second.by_parameter,
                    ..second
                })
            };
            let keep = |_: &DVector<f64>, image: &PeriodImage<Travel>| image.path.clone();
            let sizes_of = |_: &Orbit| sizes.clone();
            let equations =
                OrbitEquations { map: &twice, smooth: self.smooth, keep: &keep, sizes: &sizes_of };
            equations.orbit_along(&guess, &along, &sizes)
        })
    }
}
