//! The surfaces on which a motion sticks, and the sides of the rates that hold it there.
//!
//! ```text
//! A s = -g(s = 0),    A = g_s,    |s_i| <= 1        g_i = du_i/dt, of surfaces with independent normals
//! ```
//!
//! More surfaces may hold than have independent normals, as of two bodies on the floor and on each other:
//! sides that the rates leave undetermined are then tied to one size.

use nalgebra::{DMatrix, DVector};

use super::{EventRun, ROUNDING, SlidingStop, UNSEEN};
use crate::response::coupled::surfaces::JumpSurfaces;
use crate::trajectory::shares_of_one_size;

/// The surfaces on which a motion sticks.
#[derive(Clone, Debug, Default)]
pub(super) struct Held {
    /// The surfaces with independent normals, whose du/dt is zero: an equation each.
    pub(super) rows: Vec<usize>,
    /// The surfaces whose sides are the unknowns, as many.
    pub(super) unknowns: Vec<usize>,
    /// The other surfaces: each has the side of an unknown one, the second number counts which, times a
    /// sign.
    pub(super) tied: Vec<(usize, usize, f64)>,
}

impl Held {
    pub(super) fn is_empty(&self) -> bool {
        self.unknowns.is_empty()
    }

    /// The normal and the unknown side of a single surface; `None` of several.
    pub(super) fn single(&self) -> Option<[usize; 2]> {
        match (self.rows.as_slice(), self.unknowns.as_slice()) {
            ([row], [unknown]) if self.tied.is_empty() => Some([*row, *unknown]),
            _ => None,
        }
    }

    pub(super) fn contains(&self, index: usize) -> bool {
        self.unknowns.contains(&index) || self.tied.iter().any(|(own, ..)| *own == index)
    }

    pub(super) fn all(&self) -> Vec<usize> {
        self.unknowns.iter().copied().chain(self.tied.iter().map(|(own, ..)| *own)).collect()
    }

    /// The columns of a matrix that go with the unknown sides, those of tied sides added; `first` is the
    /// column of the first surface.
    pub(super) fn columns(
        &self,
        matrix: &DMatrix<f64>,
        first: usize,
        rows: &[usize],
    ) -> DMatrix<f64> {
        let mut found = DMatrix::from_fn(rows.len(), self.unknowns.len(), |i, j| {
            matrix[(rows[i], first + self.unknowns[j])]
        });
        for (own, lead, sign) in &self.tied {
            for (i, row) in rows.iter().enumerate() {
                found[(i, *lead)] += sign * matrix[(*row, first + own)];
            }
        }
        found
    }

    /// Writes the sides of the unknown surfaces, and of those tied to them.
    pub(super) fn write(&self, shares: &[f64], sides: &mut [f64]) {
        for (index, share) in self.unknowns.iter().zip(shares) {
            sides[*index] = *share;
        }
        for (own, lead, sign) in &self.tied {
            sides[*own] = sign * shares[*lead];
        }
    }
}

/// The sides of the surfaces that hold, in the arguments, so that du/dt is zero on all of them;
/// `None` if these equations are singular.
pub(super) fn set_shares(
    surfaces: &JumpSurfaces,
    arguments: &mut [f64],
    held: &Held,
) -> Option<()> {
    if held.is_empty() {
        return Some(());
    }
    let first = surfaces.states + 2;
    if let Some([row, unknown]) = held.single() {
        let (mut rise, mut by_side) = (0.0, 0.0);
        arguments[first + unknown] = 0.0;
        surfaces.rises.visit(arguments, |place, value| match place {
            (i, 0) if i == row => rise = value,
            (i, j) if i == row && j == 1 + unknown => by_side = value,
            _ => {}
        });
        arguments[first + unknown] = -rise / by_side;
        return (by_side != 0.0).then_some(());
    }
    held.write(&vec![0.0; held.unknowns.len()], &mut arguments[first..]);
    let rises = surfaces.rises.at(arguments);
    let matrix = held.columns(&rises, 1, &held.rows);
    let right = DVector::from_fn(held.rows.len(), |i, _| -rises[(held.rows[i], 0)]);
    let shares = solved(matrix, right)?;
    held.write(shares.as_slice(), &mut arguments[first..]);
    Some(())
}

/// The solution of linear equations; `None` if they are singular.
pub(super) fn solved(matrix: DMatrix<f64>, right: DVector<f64>) -> Option<DVector<f64>> {
    /// Ratio of a pivot to the largest entry below which the equations are singular.
    const SINGULAR: f64 = 1e-10;
    if matrix.nrows() == 1 {
        return (matrix[(0, 0)] != 0.0).then(|| right / matrix[(0, 0)]);
    }
    let largest = matrix.amax();
    let factors = matrix.full_piv_lu();
    let pivots = factors.u().diagonal();
    let is_regular = pivots.iter().all(|pivot| pivot.abs() > SINGULAR * largest);
    if is_regular { factors.solve(&right) } else { None }
}

impl EventRun<'_> {
    /// Whether the rates on both sides of a surface can lead back to it.
    pub(super) fn can_hold(&self, index: usize) -> bool {
        self.surfaces.holds[index] && self.surfaces.rises.at(&self.here())[(index, 1 + index)] < 0.0
    }

    /// Finds those of these surfaces, on all of which the motion is, that hold, and the sides of the
    /// others: each is released to the side to which the force leads that would be needed beyond its
    /// bound. The side of the surface that was `hit` is at its bound, unless others take over.
    pub(super) fn find_held(
        &mut self,
        on: Vec<usize>,
        hit: Option<usize>,
    ) -> Result<(), SlidingStop> {
        let first = self.surfaces.states + 2;
        let mut holding = on.clone();
        for _ in 0..=2 * on.len() {
            self.tie(&holding)?;
            let mut arguments = self.here();
            if set_shares(self.surfaces, &mut arguments, &self.held).is_none() {
                return Err(SlidingStop::Undetermined(holding[0]));
            }
            if arguments.iter().any(|value| value.is_nan()) {
                return Err(SlidingStop::NoValue);
            }
            let share = |index: usize| arguments[first + index];
            let group = |lead: usize| {
                let tied = self.held.tied.iter().filter(move |(_, own, _)| *own == lead);
                tied.map(|(own, ..)| *own).chain([self.held.unknowns[lead]])
            };
            let is_beyond = |lead: &usize| {
                let is_hit = hit.is_some_and(|hit| group(*lead).any(|index| index == hit));
                let bound = if is_hit { 1.0 - ROUNDING } else { 1.0 };
                share(self.held.unknowns[*lead]).abs() > bound
            };
            let size = |lead: usize| share(self.held.unknowns[lead]).abs();
            let worst = (0..self.held.unknowns.len())
                .filter(is_beyond)
                .max_by(|one, other| size(*one).total_cmp(&size(*other)));
            if let Some(lead) = worst {
                let released: Vec<usize> = group(lead).collect();
                for index in &released {
                    self.sides[*index] = share(*index).signum();
                }
                holding.retain(|index| !released.contains(index));
                continue;
            }
            self.sides.copy_from_slice(&arguments[first..]);
            // One that was released may be held back once others are.
            let rises = self.surfaces.rises.at(&arguments);
            let returns = on.iter().copied().find(|index| {
                let jump = rises[(*index, 1 + index)].abs();
                !self.held.contains(*index)
                    && self.sides[*index] * rises[(*index, 0)] < -ROUNDING * jump
            });
            match returns {
                Some(index) => holding.push(index),
                None => return Ok(()),
            }
        }
        Err(SlidingStop::Undetermined(on[0]))
    }

    /// The surfaces of this list whose normals are independent of the normals before them.
    pub(super) fn independent(&self, surfaces: &[usize]) -> Vec<usize> {
        let normals = self.surfaces.normals.at(&self.here());
        let mut directions: Vec<DVector<f64>> = Vec::new();
        let mut is_independent = |index: &usize| {
            let part = |k: usize, _: usize| normals[(*index, k)] * self.sizes[k];
            let normal = DVector::from_fn(self.surfaces.states, part);
            let along = |left: DVector<f64>, known: &DVector<f64>| &left - known * known.dot(&left);
            let left = directions.iter().fold(normal.clone(), along);
            let own = left.norm() > ROUNDING * normal.norm();
            if own {
                directions.push(left.normalize());
            }
            own
        };
        surfaces.iter().copied().filter(|index| is_independent(index)).collect()
    }

    /// Adds to surfaces on which the motion is those on which it must then be too, as between two bodies
    /// that are both at rest.
    pub(super) fn with_dependent(&self, mut on: Vec<usize>) -> Vec<usize> {
        const NEAR: f64 = 10.0 * UNSEEN;
        let count = self.independent(&on).len();
        for index in 0..self.sides.len() {
            let is_near = || self.height(index).abs() <= NEAR * self.size_of_height(index);
            if on.contains(&index) || !self.can_hold(index) || !is_near() {
                continue;
            }
            on.push(index);
            if self.independent(&on).len() > count {
                on.pop();
            }
        }
        on
    }

    /// Holds the motion on these surfaces, with ties between the sides that the rates leave
    /// undetermined.
    pub(super) fn tie(&mut self, holding: &[usize]) -> Result<(), SlidingStop> {
        let n = self.surfaces.states;
        let rows = self.independent(holding);
        self.held = Held { rows, unknowns: holding.to_vec(), tied: vec![] };
        if self.held.rows.len() == holding.len() {
            return Ok(());
        }
        let undetermined = || SlidingStop::Undetermined(holding[0]);
        let mut arguments = self.here();
        for index in holding {
            arguments[n + 2 + index] = 0.0;
        }
        let rises = self.surfaces.rises.at(&arguments);
        let row = |index: &usize| holding.iter().map(|other| rises[(*index, 1 + other)]).collect();
        let matrix: Vec<Vec<f64>> = holding.iter().map(row).collect();
        let right: Vec<f64> = holding.iter().map(|index| -rises[(*index, 0)]).collect();
        let groups = shares_of_one_size(&matrix, &right).ok_or_else(undetermined)?;
        let mut tied: Vec<(usize, usize, f64)> = Vec::new();
        for group in groups {
            let Some(((lead, first), others)) = group.split_first() else { continue };
            tied.extend(others.iter().map(|(own, sign)| (*own, *lead, (sign * first) as f64)));
        }
        let is_tied = |place: usize| tied.iter().any(|(own, ..)| *own == place);
        let leads: Vec<usize> = (0..holding.len()).filter(|place| !is_tied(*place)).collect();
        let number = |lead: usize| leads.iter().position(|place| *place == lead);
        let mut numbered = Vec::new();
        for (own, lead, sign) in &tied {
            numbered.push((holding[*own], number(*lead).ok_or_else(undetermined)?, *sign));
        }
        self.held.tied = numbered;
        self.held.unknowns = leads.into_iter().map(|place| holding[place]).collect();
        match self.held.unknowns.len() == self.held.rows.len() {
            true => Ok(()),
            false => Err(undetermined()),
        }
    }

    /// Computes the sides of the surfaces that hold where the motion is.
    pub(super) fn refresh(&mut self) -> Result<(), SlidingStop> {
        let mut arguments = self.here();
        set_shares(self.surfaces, &mut arguments, &self.held)
            .ok_or_else(|| SlidingStop::Undetermined(self.held.unknowns[0]))?;
        self.sides.copy_from_slice(&arguments[self.surfaces.states + 2..]);
        Ok(())
    }
}
