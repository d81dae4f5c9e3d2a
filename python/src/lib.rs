//! The commands of the program for Python, in process: `run(words, input, watch)`.
//!
//! In: the words of a command, as the program takes them. Out: its result as text, most often a
//! JSON document, from which `lindstedt/` makes dataclasses. All else that Python adds, arrays,
//! frames, pictures, is Python.

use std::ffi::OsString;

use lindstedt::cli::{self, CallFailure};
use pyo3::prelude::*;

/// The result of a command: its text, its notes, its text in other formats where the work took
/// long, whether its verdict is a pass, whether it is a part only.
type Result = (String, Vec<String>, Vec<(&'static str, String)>, Option<bool>, bool);

/// Runs a command with the interpreter lock released.
///
/// `words` are those of a command line, `input` is the text that `-` stands for, and `watch` is
/// called every 50 ms with the parts done and all of them.
#[pyfunction]
#[pyo3(signature = (words, input = None, watch = None))]
fn run(
    py: Python<'_>,
    words: Vec<String>,
    input: Option<String>,
    watch: Option<Py<PyAny>>,
) -> PyResult<Result> {
    let mut raised = None;
    let mut look = |done: u64, all: u64| {
        let looked = Python::attach(|py| {
            py.check_signals()?;
            match &watch {
                Some(watch) => watch.call1(py, (done, all)).map(drop),
                None => Ok(()),
            }
        });
        looked.map_err(|error| raised = Some(error)).is_ok()
    };
    let result = py.detach(|| cli::call(words, input, &mut look));
    match (raised, result) {
        (Some(error), _) => Err(error),
        (None, Ok(result)) => {
            Ok((result.text, result.notes, result.forms, result.passed, result.partial))
        }
        (None, Err(failure)) => Err(exception(py, failure)),
    }
}

/// Reads the equation of a problem: its text in the grammar, its coordinate, its parameters.
#[pyfunction]
#[pyo3(signature = (problem, input = None))]
fn read(
    py: Python<'_>,
    problem: &str,
    input: Option<String>,
) -> PyResult<(String, String, Vec<String>)> {
    let read = py.detach(|| cli::read_equation(problem, input));
    let read = read.map_err(|failure| exception(py, failure))?;
    Ok((read.equation, read.coordinate, read.parameters))
}

/// The commands with their arguments, as JSON.
#[pyfunction]
fn commands() -> String {
    cli::commands()
}

/// The exception of a failure, of a class in `lindstedt/errors.py`.
fn exception(py: Python<'_>, failure: CallFailure) -> PyErr {
    let CallFailure { code, kind, message, term } = failure;
    let made = || -> PyResult<Bound<'_, PyAny>> {
        let class = py.import("lindstedt.errors")?.getattr("from_failure")?;
        class.call1((code, kind, message, term))
    };
    match made() {
        Ok(error) => PyErr::from_value(error),
        Err(error) => error,
    }
}

/// Runs the program with the words of the command line, and returns its exit code.
#[pyfunction]
fn main(py: Python<'_>, words: Vec<OsString>) -> u8 {
    py.detach(|| cli::main(words))
}

#[pymodule]
fn _lindstedt(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(run, module)?)?;
    module.add_function(wrap_pyfunction!(read, module)?)?;
    module.add_function(wrap_pyfunction!(commands, module)?)?;
    module.add_function(wrap_pyfunction!(main, module)?)
}
