//! The formats of results: their names, their endings, and those of each command.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};

use crate::export::code::Language;

/// The formats of a command beside those of every command.
#[derive(Clone, Copy)]
pub(super) enum Formats {
    /// Pictures and programs.
    Programs,
    /// Pictures, tables of comma-separated values and programs.
    ProgramsAndTables,
    /// Pictures.
    Pictures,
    /// Pictures and tables of comma-separated values.
    PicturesAndTables,
    /// Pictures, tables of comma-separated values and problem files.
    PicturesTablesAndProblems,
    /// No formats beside those of every result.
    Words,
    /// A single format, whatever the file is called: there is no `--format`.
    One,
}

impl Formats {
    /// The formats that the help lists beside those of every command.
    pub(super) fn listed(self) -> Vec<Format> {
        match self {
            Self::Programs | Self::ProgramsAndTables => {
                let mut formats = vec![Format::Svg];
                formats.extend(matches!(self, Self::ProgramsAndTables).then_some(Format::Csv));
                formats.extend(Language::ALL.map(Format::Code));
                formats
            }
            Self::Pictures => vec![Format::Svg],
            Self::PicturesAndTables => vec![Format::Svg, Format::Csv],
            Self::PicturesTablesAndProblems => vec![Format::Svg, Format::Csv, Format::Toml],
            Self::Words | Self::One => vec![],
        }
    }
}

/// The format of a result.
#[derive(Clone, Copy, Default, PartialEq, Eq)]
pub(super) enum Format {
    #[default]
    Text,
    Latex,
    Json,
    Csv,
    Svg,
    Html,
    Toml,
    Code(Language),
}

impl Format {
    /// The formats of every command that has a result.
    pub(super) const OF_ALL: [Self; 4] = [Self::Text, Self::Latex, Self::Json, Self::Html];

    /// All of them.
    pub(super) fn all() -> impl Iterator<Item = Self> {
        let programs = Language::ALL.map(Self::Code);
        Self::OF_ALL.into_iter().chain([Self::Svg, Self::Csv, Self::Toml]).chain(programs)
    }

    /// What the names of its files end in beside the name of the format itself.
    pub(super) fn endings(self) -> &'static [&'static str] {
        match self {
            Self::Text => &["txt"],
            Self::Latex => &["tex"],
            Self::Html => &["htm"],
            Self::Code(Language::Rust) => &["rs"],
            Self::Code(Language::Python) => &["py"],
            Self::Code(Language::Julia) => &["jl"],
            Self::Code(Language::Matlab) => &["m"],
            Self::Json | Self::Csv | Self::Svg | Self::Toml | Self::Code(Language::C) => &[],
        }
    }

    /// The format of files whose names end so; `None` for an unknown one.
    pub(super) fn of_ending(ending: &str) -> Option<Self> {
        let ending = ending.to_ascii_lowercase();
        // A file called `x.rust` or `x.latex` is none of ours.
        let is_ending = |format: &Self| match format.endings() {
            [] => format.name() == ending,
            endings => {
                endings.contains(&ending.as_str()) || *format == Self::Html && ending == "html"
            }
        };
        Self::all().find(is_ending)
    }

    /// Advice for a file with this ending, of a kind that is not written here.
    pub(super) fn instead_of(ending: &str) -> Option<&'static str> {
        Some(match ending.to_ascii_lowercase().as_str() {
            "pdf" => "write .html and print it, or .tex",
            "png" | "jpg" | "jpeg" => "write .svg, which converts to it",
            "xls" | "xlsx" | "ods" => "write .csv",
            "doc" | "docx" => "write .html or .tex",
            "nb" | "ipynb" => "write .py or .json",
            _ => return None,
        })
    }

    /// The name on the command line.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Text => "text",
            Self::Latex => "latex",
            Self::Json => "json",
            Self::Csv => "csv",
            Self::Svg => "svg",
            Self::Html => "html",
            Self::Toml => "toml",
            Self::Code(language) => language.name(),
        }
    }
}

/// Reads a format. Help lists those of every command and these; a command refuses all others with
/// the reason.
pub(super) fn format_parser(
    listed: impl IntoIterator<Item = Format>,
) -> impl TypedValueParser<Value = Format> {
    let listed: Vec<Format> = Format::OF_ALL.into_iter().chain(listed).collect();
    let values = Format::all().map(|format| {
        let endings = format.endings().iter().copied();
        PossibleValue::new(format.name()).aliases(endings).hide(!listed.contains(&format))
    });
    let unknown = || "no format of this name".to_owned();
    PossibleValuesParser::new(values).try_map(move |name| {
        let is_meant =
            |format: &Format| format.name() == name || format.endings().contains(&name.as_str());
        Format::all().find(is_meant).ok_or_else(unknown)
    })
}
