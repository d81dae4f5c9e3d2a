//! `lindstedt collect FILES`.

use std::io::Read as _;
use std::path::{Path, PathBuf};

use clap::Args;

use crate::export::json::shard::{JoinedLines, JoinedStudy, Shard, ShardError};

use super::answer::command_text;
use super::files::{is_same_file, is_standard};
use super::{Common, Failure, Outcome, VERSION, Work, find_work, session, text_writer};

/// The result of a study from the lines of its shards, as the undivided command prints it
#[derive(Args)]
#[command(mut_arg("tolerance", super::no_verdict))]
pub struct CollectArguments {
    /// The files of lines that --shard wrote, in any order; - for standard input
    #[arg(required = true)]
    pub files: Vec<PathBuf>,
    /// Print the shards that are to run again (3/64), one in a line, and join nothing
    #[arg(long)]
    missing: bool,
    #[command(flatten)]
    pub common: Common,
}

impl Work for CollectArguments {
    fn common(&self) -> Common {
        self.common.clone()
    }

    fn run(&self) -> Result<Outcome, Failure> {
        run(self)
    }
}

/// The most shards that a message lists.
const MOST_LISTED: usize = 8;

fn run(arguments: &CollectArguments) -> Result<Outcome, Failure> {
    let common = &arguments.common;
    if common.tolerance.is_some() {
        return Err(Failure::Usage(
            "--tolerance is an option of the command that was split: leave it out".to_owned(),
        ));
    }
    let written = [&common.output, &common.plot].into_iter().flatten();
    for path in written.filter(|path| !is_standard(path)) {
        if arguments.files.iter().any(|file| is_same_file(file, path)) {
            return Err(Failure::Usage(format!(
                "{} is a file that is read: it would be overwritten; give another name",
                path.display()
            )));
        }
    }
    let mut lines = JoinedLines::default();
    for file in &arguments.files {
        lines.add(&file.to_string_lossy(), &read(file)?).map_err(refused)?;
    }
    let study = lines.study().map_err(refused)?;
    if arguments.missing {
        let shards = study.missing_shards().into_iter().map(|shard| format!("{shard}\n"));
        return Ok(Outcome {
            result: text_writer(shards.collect()),
            picture: None,
            note: None,
            verdict: None,
            partial: false,
        });
    }
    if study.study.version != VERSION {
        return Err(Failure::because(format!(
            "the lines are by version {}, and this is {VERSION}: the same bits need the same version",
            study.study.version
        )));
    }
    check_whole(&study)?;
    joined(study, common)
}

/// Reads a file to its end; a letter that is cut off at its end is replaced.
fn read(path: &Path) -> Result<String, Failure> {
    let mut bytes = Vec::new();
    let read = match is_standard(path) {
        true if session::current().is_call() => {
            return Ok(session::current().take_input().unwrap_or_default());
        }
        true => std::io::stdin().lock().read_to_end(&mut bytes),
        false => std::fs::File::open(path).and_then(|mut file| file.read_to_end(&mut bytes)),
    };
    read.map_err(|error| Failure::because(format!("cannot read {}: {error}", path.display())))?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

fn refused(error: ShardError) -> Failure {
    let help = match &error {
        ShardError::Mixed { .. } => {
            Some("join the files of one study, by one version of the program")
        }
        ShardError::Disagree { .. } => Some(
            "one of the two is damaged, or by another build: leave one file out, and run its shard again",
        ),
        _ => None,
    };
    Failure::refused(&error, help.map(str::to_owned))
}

/// Refuses a study of which points are missing, with the commands that compute them.
fn check_whole(study: &JoinedStudy) -> Result<(), Failure> {
    let missing = study.missing().len();
    if missing == 0 {
        return Ok(());
    }
    let shards = study.missing_shards();
    let mut message = format!("{missing} of {} points are missing", study.study.total);
    for torn in study.torn.iter().take(MOST_LISTED) {
        message += &format!("\n  note: {torn} is cut off");
    }
    message += "\n  help: run again, and collect all files:";
    for shard in shards.iter().take(MOST_LISTED) {
        message += &format!("\n    {}", command_of(study, *shard));
    }
    if shards.len() > MOST_LISTED {
        message += &format!(
            "\n    and {} other shards, which --missing lists",
            shards.len() - MOST_LISTED
        );
    }
    Err(Failure::because(message))
}

/// The command of a shard, with the file that its lines belong in.
fn command_of(study: &JoinedStudy, shard: Shard) -> String {
    let mut words = study.study.command.clone();
    words.insert(1, format!("--shard={shard}"));
    let own = study.shards.iter().find(|(other, _)| *other == shard);
    let file = own.map(|(_, file)| file.clone()).or_else(|| {
        // The name of another shard, with the number of this one.
        let (other, file) = study.shards.first()?;
        let path = Path::new(file);
        let is_number = path.file_stem()?.to_str()? == other.number().to_string();
        let name = format!("{}.{}", shard.number(), path.extension()?.to_str()?);
        is_number.then(|| path.with_file_name(name).to_string_lossy().into_owned())
    });
    let into = file.filter(|file| file != "-").map(|file| format!(" > {file}"));
    command_text(&words) + &into.unwrap_or_default()
}

/// Runs the command with the rows that are known.
fn joined(study: JoinedStudy, common: &Common) -> Result<Outcome, Failure> {
    let session = session::current();
    let asked = study.study.clone();
    let rows = study.rows().unwrap_or_default();
    let mut words = asked.command.clone();
    // The text of the file comes with the lines, and the file may have changed or be elsewhere.
    if asked.file.is_some()
        && let Some(place) = words.last_mut()
    {
        *place = "-".to_owned();
    }
    let path = |option: &str, path: &Option<PathBuf>| {
        path.as_ref().map(|path| format!("--{option}={}", path.display()))
    };
    let handed_on = [
        Some(format!("--format={}", common.format().name())),
        path("output", &common.output),
        path("plot", &common.plot),
        common.standalone.then(|| "--standalone".to_owned()),
    ];
    words.splice(1..1, handed_on.into_iter().flatten());
    let (command, work) = find_work(&words)?;
    command.check_format(common.format())?;
    session.repeat(asked.command, asked.file, rows);
    work.run()
}
