//! The output files: checked before the work begins, replaced as a whole when it is done.
//!
//! A file is written under another name beside its place and then renamed, so that a full disk or
//! an interrupt leaves the old one. `-` is standard output.

use std::fs::OpenOptions;
use std::io::{BufWriter, ErrorKind, Write as _};
use std::path::{Path, PathBuf};

use tempfile::{Builder, NamedTempFile};

use super::{Common, Failure, Format, Writer};

/// Whether a path stands for standard output, or standard input where something is read.
pub(super) fn is_standard(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// The largest number of characters in a line of a file.
pub(super) const OF_FILES: usize = 120;

/// The largest number of characters in a line of the result: the width of the terminal that shows
/// it, or the value of `COLUMNS`; 120 in a file or a pipe.
pub(super) fn width(output: Option<&Path>) -> usize {
    const NARROWEST: usize = 40;
    let asked = std::env::var("COLUMNS").ok().and_then(|text| text.trim().parse().ok());
    let terminal = || {
        let (terminal_size::Width(columns), _) =
            terminal_size::terminal_size_of(std::io::stdout())?;
        output.is_none_or(is_standard).then_some(columns.into())
    };
    asked.or_else(terminal).unwrap_or(OF_FILES).max(NARROWEST)
}

/// Refuses destinations that cannot be written, before any work is done for them.
///
/// # Errors
/// A picture that is no SVG, two results in one place, the input as an output, or a place that
/// cannot be written.
pub(super) fn check(common: &Common, input: Option<&Path>) -> Result<(), Failure> {
    if let Some(picture) = &common.plot {
        let is_svg =
            picture.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("svg"));
        if !is_svg && !is_standard(picture) {
            return Err(Failure::Usage(format!(
                "--plot {} is no SVG file: pictures are drawn as SVG, so name it {}",
                picture.display(),
                picture.with_extension("svg").display()
            )));
        }
    }
    if common.standalone && common.format() != Format::Latex {
        return Err(Failure::Usage(
            "--standalone belongs to --format latex: other formats are whole as they are"
                .to_owned(),
        ));
    }
    let text = common.output.clone().unwrap_or_else(|| PathBuf::from("-"));
    let ending = text.extension().and_then(|ending| ending.to_str());
    if common.format.is_none()
        && let Some((ending, instead)) =
            ending.and_then(|ending| Some((ending, Format::instead_of(ending)?)))
    {
        return Err(Failure::Usage(format!(
            "--output {}: .{ending} files are not written\n  help: {instead}; --format text writes text there",
            text.display()
        )));
    }
    let named: Vec<(&str, &Path)> = std::iter::once(("--output", text.as_path()))
        .chain(common.plot.as_deref().map(|picture| ("--plot", picture)))
        .collect();
    if let [(_, text), (_, picture)] = named[..]
        && is_same_file(text, picture)
    {
        return Err(Failure::Usage(match is_standard(text) {
            true => {
                "the result and the picture cannot both go to standard output: give --output FILE or --plot FILE.svg"
                    .to_owned()
            }
            false => format!(
                "--output and --plot are both {}: give each its own file",
                text.display()
            ),
        }));
    }
    for (option, path) in named {
        if is_standard(path) {
            continue;
        }
        if input.is_some_and(|input| !is_standard(input) && is_same_file(input, path)) {
            return Err(Failure::Usage(format!(
                "{option} {} is the file that is read: it would be overwritten; give another name",
                path.display()
            )));
        }
        writable(path).map_err(Failure::because)?;
    }
    Ok(())
}

/// Writes a result to its place.
///
/// # Errors
/// The error of the operating system, with the name of the file. A closed pipe is not an error.
pub(super) fn write(path: Option<&Path>, result: Writer) -> Result<(), String> {
    match path.filter(|path| !is_standard(path)) {
        Some(path) => replace(path, result),
        None => {
            let mut output = BufWriter::new(std::io::stdout().lock());
            match result(&mut output).and_then(|()| output.flush()) {
                Err(error) if error.kind() != ErrorKind::BrokenPipe => {
                    Err(format!("standard output: {error}"))
                }
                _ => Ok(()),
            }
        }
    }
}

/// The place itself, with links followed, so that two names of one file are known as one.
fn resolved(path: &Path) -> Option<PathBuf> {
    if let Ok(found) = path.canonicalize() {
        return Some(found);
    }
    Some(folder(path).canonicalize().ok()?.join(path.file_name()?))
}

fn folder(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}

/// Whether two paths are one place.
pub(super) fn is_same_file(one: &Path, other: &Path) -> bool {
    one == other || resolved(one).is_some_and(|place| Some(place) == resolved(other))
}

/// Devices and pipes are written as they are; there is nothing to replace.
fn is_special(path: &Path) -> bool {
    path.metadata().is_ok_and(|metadata| !metadata.is_file() && !metadata.is_dir())
}

/// The reason without the name of the temporary file.
fn cannot(path: &Path, error: &std::io::Error) -> String {
    format!("cannot write {}: {}", path.display(), error.kind())
}

fn writable(path: &Path) -> Result<(), String> {
    let refused = |error: std::io::Error| cannot(path, &error);
    if !folder(path).is_dir() {
        return Err(format!(
            "cannot write {}: there is no folder {}",
            path.display(),
            folder(path).display()
        ));
    }
    if path.is_dir() {
        return Err(format!("cannot write {}: it is a folder", path.display()));
    }
    if path.exists() {
        OpenOptions::new().write(true).open(path).map_err(refused)?;
    }
    if is_special(path) {
        return Ok(());
    }
    new_temporary(path).map_err(refused).map(drop)
}

fn replace(path: &Path, result: Writer) -> Result<(), String> {
    let refused = |error: std::io::Error| cannot(path, &error);
    if is_special(path) {
        let mut device =
            BufWriter::new(OpenOptions::new().write(true).open(path).map_err(refused)?);
        return result(&mut device).and_then(|()| device.flush()).map_err(refused);
    }
    let file = new_temporary(path).map_err(refused)?;
    let mut output = BufWriter::new(file.as_file());
    result(&mut output).and_then(|()| output.flush()).map_err(refused)?;
    drop(output);
    file.as_file().sync_data().map_err(refused)?;
    let place = resolved(path).unwrap_or_else(|| path.to_owned());
    file.persist(place).map_err(|error| refused(error.error)).map(drop)
}

/// An empty file beside this place, with the permissions that the file there has, or that a new one
/// gets. It is gone when it is dropped.
fn new_temporary(path: &Path) -> std::io::Result<NamedTempFile> {
    let place = resolved(path).unwrap_or_else(|| path.to_owned());
    let mut builder = Builder::new();
    builder.prefix(".lindstedt-").suffix(".part");
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let file = builder.tempfile_in(folder(&place))?;
    if let Ok(metadata) = place.metadata() {
        file.as_file().set_permissions(metadata.permissions())?;
    }
    Ok(file)
}
