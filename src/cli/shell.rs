//! `lindstedt completions SHELL` and `lindstedt man`: what a shell and `man` know of the program.

use std::path::PathBuf;

use clap::Args;
use clap_complete::Shell;

use super::{Common, Failure, Outcome, Work, command_line};

/// Print a script by which a shell completes commands and options
#[derive(Args)]
pub struct CompletionsArguments {
    /// The shell
    shell: Shell,
    /// Write the script to this file instead of standard output; - for standard output
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

impl Work for CompletionsArguments {
    fn common(&self) -> Common {
        Common { output: self.output.clone(), ..Common::default() }
    }

    fn run(&self) -> Result<Outcome, Failure> {
        let mut script = Vec::new();
        clap_complete::generate(self.shell, &mut command_line(), "lindstedt", &mut script);
        Ok(printed(script))
    }
}

/// Print the manual page of the program, or of a command
#[derive(Args)]
pub struct ManArguments {
    /// A command; without it the program
    command: Option<String>,
    /// Write the page to this file instead of standard output; - for standard output
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

impl Work for ManArguments {
    fn common(&self) -> Common {
        Common { output: self.output.clone(), ..Common::default() }
    }

    fn run(&self) -> Result<Outcome, Failure> {
        let program = command_line();
        let (page, title) = match &self.command {
            None => (program, "lindstedt".to_owned()),
            Some(name) => {
                let unknown = || {
                    let help = "lindstedt --help lists them";
                    Failure::Usage(format!("there is no command `{name}`\n  help: {help}"))
                };
                let command = program.find_subcommand(name).ok_or_else(unknown)?.clone();
                (command.bin_name(format!("lindstedt {name}")), format!("lindstedt-{name}"))
            }
        };
        let mut text = Vec::new();
        clap_mangen::Man::new(page).title(title).render(&mut text)?;
        Ok(printed(text))
    }
}

/// A text as it is.
fn printed(text: Vec<u8>) -> Outcome {
    Outcome {
        result: Box::new(move |to| to.write_all(&text)),
        picture: None,
        note: None,
        verdict: None,
        partial: false,
    }
}
