//! Steady states of coupled equations: branches of periodic motions of any number of states, with
//! their stability.
//!
//! ```text
//! M(q) q'' + h(q, q', t; p) = 0   ->   y' = F(t, y; p),   y = (q, q'):    P(y; p) = y,  P: the state a period later
//! ```
//!
//! Branches are found by shooting ([`orbit_branch`](crate::numeric::orbit_branch)): a point is the
//! start of a closed orbit, with the derivatives of its map from the variations of the same motion
//! (A. H. Nayfeh and B. Balachandran, *Applied Nonlinear Dynamics*, Wiley 1995, chapters 5 and 6).
//! Every point is judged by the Taylor series of the equations as they were given, in time.
//!
//! - `problem`: the equations with numbers for all parameters but one, and the maps of a period.
//! - `flow`: the motion with its variations by Runge-Kutta; `scaled_rates`: its rates as they are integrated.
//! - `state_jumps`: walls and events; `surfaces`: rates that jump, and where they do; `sliding`: the motion across jumps, with sticking.
//! - `counters`: states that only count, which are left out; `event_modes`: states that change at events alone.
//! - `sections`: the phases at which periods with impacts or events begin.
//! - `starts`: the motions from which branches of a driven system start; `guesses`: those of one
//!   harmonic.
//! - `cycles`: the same for systems that nothing drives; `equilibria`: where these rest.
//! - `modes`: nonlinear normal modes, the free motions without damping.
//! - `changes`: multipliers, and bifurcations between two points of a branch.
//! - `criticality`: whether the motions that come off there are stable.
//! - `curves`: bifurcations in two parameters.
//! - `grazing`: the curves on which a motion touches a wall or the condition of an event.
//! - `judged`: a point of a branch as a steady motion with its error.
//!
//! In: a [`ResponseRequest`] of coupled equations. Out: the same [`ResponseDiagram`] as for one
//! coordinate.

mod branches;
mod changes;
mod counters;
mod criticality;
mod curves;
mod cycles;
mod equilibria;
mod event_modes;
mod flow;
mod grazing;
mod guesses;
mod judged;
mod modes;
mod problem;
mod scaled_rates;
mod sections;
mod sliding;
mod starts;
mod state_jumps;
mod surfaces;
mod wave;

use super::{ResponseDiagram, ResponseError, ResponseRequest};
use crate::coupled::CoupledEquations;
use branches::Known;
use counters::{Counters, RequestWithoutCounters};
use problem::{CoupledProblem, Kind};

/// Computes and verifies all steady states that are found.
///
/// # Errors
/// [`ResponseError`].
pub(super) fn respond(
    question: &ResponseRequest,
    equations: &CoupledEquations,
) -> Result<ResponseDiagram, ResponseError> {
    match RequestWithoutCounters::new(question, equations)? {
        None => respond_without_counters(question, equations, None),
        Some(RequestWithoutCounters { request, equations, counters }) => {
            let names = counters.names.clone();
            let response = respond_without_counters(&request, &equations, Some(counters))?;
            Ok(ResponseDiagram { question: question.clone(), counters: names, ..response })
        }
    }
}

/// The steady states of equations all of whose states belong to the motion, with what counts beside them.
fn respond_without_counters(
    question: &ResponseRequest,
    equations: &CoupledEquations,
    counters: Option<Counters>,
) -> Result<ResponseDiagram, ResponseError> {
    let mut problem = CoupledProblem::new(question, equations)?;
    problem.counters = counters;
    if question.along.is_some() {
        curves::check(&problem)?;
    }
    match problem.kind {
        Kind::Driven(_) => {
            let (response, known) = problem.driven_response()?;
            problem.with_curves(response, equations, &known)
        }
        Kind::SelfExcited => problem.cycle_response(),
        Kind::Free => problem.mode_response(),
    }
}

/// The response of a single coordinate with the curves of its bifurcations in two parameters.
///
/// # Errors
/// [`ResponseError`].
pub(super) fn with_curves(
    response: ResponseDiagram,
    question: &ResponseRequest,
    equations: &CoupledEquations,
) -> Result<ResponseDiagram, ResponseError> {
    let problem = CoupledProblem::new(question, equations)?;
    curves::check(&problem)?;
    let known = problem.driven_branches(false);
    problem.with_curves(response, equations, &known)
}

/// The response of a single coordinate with the criticality of its bifurcations, where it is known.
pub(super) fn with_criticality(
    mut response: ResponseDiagram,
    question: &ResponseRequest,
    equations: &CoupledEquations,
) -> ResponseDiagram {
    let Ok(problem) = CoupledProblem::new(question, equations) else { return response };
    let scale = problem.scale_of(&response);
    for index in 0..response.bifurcations.len() {
        if question.interrupt.is_requested() {
            break;
        }
        let change = response.bifurcations[index];
        if let Some(found) = problem.criticality_among(&response.branches, &change, &scale) {
            response.bifurcations[index].criticality = Some(found);
        }
    }
    response
}

impl CoupledProblem<'_> {
    /// A response with the curves of its bifurcations in two parameters, if a second one is given.
    ///
    /// # Errors
    /// [`ResponseError`].
    fn with_curves(
        &self,
        mut response: ResponseDiagram,
        equations: &CoupledEquations,
        known: &Known,
    ) -> Result<ResponseDiagram, ResponseError> {
        let question = self.question;
        let Some(along) = question.along else { return Ok(response) };
        response.curves = self.curves(equations, known, along)?;
        response.stable_motions = Some(curves::stable_motions(question, equations, along)?);
        response.complete &= !question.interrupt.is_requested();
        Ok(response)
    }
}
