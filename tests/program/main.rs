//! The program as its users run it: one file a subject, all in one program, so that they share the
//! processor's cores.

mod absorber;
mod audit;
mod catalog;
mod certificates;
mod documents;
mod errors;
mod events;
mod fit;
mod gallery;
mod impact_files;
mod materials;
mod optimize;
mod options;
mod orbits;
#[cfg(feature = "plot")]
mod pages;
#[cfg(feature = "plot")]
mod pictures;
mod programs;
mod responses;
mod shards;
mod shortest;
mod simulate_cli;
mod unread;
mod walls;
mod words;

/// A time limit of less than a nanosecond: it is up before the work begins, on however busy a machine.
const NO_TIME: &str = "1e-10";
