//! The command-line program; see `lindstedt --help`.

fn main() -> std::process::ExitCode {
    lindstedt::cli::run()
}
