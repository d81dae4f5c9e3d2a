//! The families of orbits in closed form: which wall, how many periods, one impact or symmetric.

use super::equation::{ImpactEquation, ImpactNumbers};
use super::error::OrbitError;
use super::flow::WalledFlow;
use super::multipliers::OrbitStability;
use super::one_impact::{ImpactState, OneImpact};
use super::orbit::{OrbitImpact, OrbitKind};

/// A family of orbits in closed form.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OrbitFamily {
    /// One impact, or symmetric between two walls.
    pub kind: OrbitKind,
    /// The index of the wall.
    pub wall: usize,
    /// The periods of the drive in a period of the orbit.
    pub periods: u32,
}

impl OrbitFamily {
    /// All families of a question with so many periods: symmetric ones first.
    ///
    /// # Errors
    /// A step of algebra that fails.
    pub fn all(
        question: &ImpactEquation,
        [least, greatest]: [u32; 2],
    ) -> Result<Vec<Self>, OrbitError> {
        let symmetric = question.is_symmetric()?;
        let mut families = Vec::new();
        for periods in least..=greatest {
            if symmetric && periods % 2 == 1 {
                families.push(Self { kind: OrbitKind::Symmetric, wall: 0, periods });
            }
            let walls = 0..question.walls.len();
            families.extend(walls.map(|wall| Self { kind: OrbitKind::OneImpact, wall, periods }));
        }
        Ok(families)
    }

    pub(super) fn relation(self, numbers: &ImpactNumbers) -> Option<OneImpact> {
        OneImpact::new(numbers, &numbers.walls[self.wall], self.periods, self.kind)
    }

    pub(super) fn stability(self, relation: &OneImpact, state: &ImpactState) -> OrbitStability {
        OrbitStability::from_multipliers(&relation.multipliers(state, self.kind))
    }

    /// Whether a motion follows a solution.
    pub(super) fn is_admissible(
        self,
        numbers: &ImpactNumbers,
        relation: &OneImpact,
        state: &ImpactState,
    ) -> bool {
        if numbers.walls.len() == 1 {
            return relation.negative_gap(state).is_none();
        }
        let omega = numbers.frequency;
        let impact = OrbitImpact::new(self.wall, state.phase / omega, state.speed, omega);
        WalledFlow::new(numbers).is_some_and(|walled| {
            super::one_impact::obstacle(&walled, &impact, relation.length).is_none()
        })
    }
}

/// The kind of change of orbits at a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OrbitChange {
    /// The motion without impacts grazes the wall.
    Grazing,
    /// Two orbits merge.
    Fold,
    /// A multiplier is -1.
    PeriodDoubling,
    /// A symmetric orbit loses its symmetry.
    SymmetryBreaking,
    /// The orbit itself grazes a wall between its impacts, and ends there.
    SecondImpact,
}

impl OrbitChange {
    /// The name: `grazing`, `fold`, `period-doubling`, `symmetry-breaking` or `second-impact`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Grazing => "grazing",
            Self::Fold => "fold",
            Self::PeriodDoubling => "period-doubling",
            Self::SymmetryBreaking => "symmetry-breaking",
            Self::SecondImpact => "second-impact",
        }
    }

    /// The change where the leg of an orbit of this kind has a multiplier -1.
    pub(super) fn of_minus_one(kind: OrbitKind) -> Self {
        match kind {
            OrbitKind::Symmetric => Self::SymmetryBreaking,
            _ => Self::PeriodDoubling,
        }
    }
}
