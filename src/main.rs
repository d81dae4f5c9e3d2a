//! The command-line program; see `lindstedt --help`.

mod cli;

fn main() -> std::process::ExitCode {
    cli::run()
}
