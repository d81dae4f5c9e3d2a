//! Laws of measured motions, from the record to the table of laws.
//!
//! Each file uses only those above it, but that `closed_forms` gives a law its backbone and a prepared record knows the errors of an
//! answer:
//!
//! - `laws`: the laws of the list, springs with losses, and equations of one's own: [`laws::Law`]
//! - `powers`: powers with an unknown exponent, rounded near zero
//! - `polynomial`: polynomials fitted to a few samples, medians, regressions
//! - `spikes`: single wrong samples, found before any law
//! - `turning_points`: turning points by local fits: [`turning_points::Swings`]
//! - `least_squares`: the method of Levenberg and Marquardt, covariances, flat directions
//! - `backbone`: frequency and damping against amplitude, without a law
//! - `closed_forms`: maps of half swings in closed form, fitted to turning points
//! - `motion`: the integrated motion with its derivatives: [`motion::MotionSolver`]
//! - `fit_coordinates`: coordinates in which the valley of a fit is straight
//! - `sample_fit`: a law fitted to all samples
//! - `whiteness`: whether what is left over is noise
//! - `integration`: displacements from velocities and accelerations
//! - `record`: records from text: [`record::read`]
//! - `quality`: gaps, steps, saturation, where a decay begins
//! - `equation_error`: a start of the parameters from accelerations
//! - `nested`: laws within laws, which fit no better
//! - `fitted_record`: a record made ready for a fit
//! - `answer`: the laws of records, ordered, with what is excluded: [`answer::fit`]
//! - `impacts`: restitution from times of impacts: [`impacts::fit_impacts`]
//! - `tables`: laws of tables of frequencies: [`tables::fit_table`]
//! - `response`: laws of driven oscillators from their amplitude against frequency: [`response::fit_response`]

pub mod answer;
pub mod backbone;
mod closed_forms;
mod equation_error;
mod fit_coordinates;
pub mod fitted_record;
pub mod impacts;
mod integration;
pub mod laws;
mod least_squares;
pub mod motion;
mod nested;
mod polynomial;
mod powers;
pub mod quality;
pub mod record;
pub mod response;
pub mod sample_fit;
mod spikes;
pub mod tables;
pub mod turning_points;
pub mod whiteness;
