//! Kinds `study` and `point`: a part of a study as lines of JSON, and the lines of all its parts
//! put together.
//!
//! A study is the points of a command: the motions of a sweep, the materials of a table, the runs of
//! a search, the claims of a publication. Shard I of N has every N-th of them, from the I-th on, so
//! that long motions, which often are neighbours, spread over the shards. Its first line is a
//! [`StudyDocument`], which says what is asked; each other line is a [`PointDocument`], which names
//! the study that it belongs to, its place in it, and what came of it. Nothing in the line of a point
//! depends on the split, so that shards of several splits can be put together.
//!
//! ```
//! use lindstedt::export::json::shard::{JoinedLines, Shard, StudyDocument};
//!
//! let [first, second] = ["1/2".parse::<Shard>()?, "2/2".parse()?];
//! assert_eq!(second.indices(5).collect::<Vec<_>>(), [1, 3]);
//! let study = StudyDocument::new("0.1.0", vec!["paper".to_owned()], None, 5, first);
//! let mut lines = study.line()?;
//! for index in first.indices(5) {
//!     lines += &study.point(index, Default::default(), Default::default()).line()?;
//! }
//! let mut joined = JoinedLines::default();
//! joined.add("first.jsonl", &lines)?;
//! let study = joined.study()?;
//! assert_eq!((study.missing(), study.missing_shards()), (vec![1, 3], vec![second]));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use std::collections::BTreeMap;
use std::fmt;
use std::str::FromStr;

#[cfg(feature = "schema")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use thiserror::Error;

use super::{DocumentKind, JsonError};

/// A part of a study: number I of N, counted from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Shard {
    number: usize,
    of: usize,
}

/// The most shards of a study.
pub const MOST_SHARDS: usize = 1_000_000;

/// A text that names no shard.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("expected a shard I/N with I from 1 to N, such as 3/64")]
pub struct NoShard;

impl Shard {
    /// The number of shards that the study is split into.
    pub fn of(self) -> usize {
        self.of
    }

    /// The number of this one, counted from 1.
    pub fn number(self) -> usize {
        self.number
    }

    /// The points of this shard, in order: every N-th of so many, from the I-th on, counted from 0.
    pub fn indices(self, total: usize) -> impl Iterator<Item = usize> {
        (self.number - 1..total).step_by(self.of)
    }

    /// The shard that has this point, of so many shards.
    pub fn with_point(index: usize, of: usize) -> Self {
        Self { number: index % of + 1, of }
    }
}

impl FromStr for Shard {
    type Err = NoShard;

    fn from_str(text: &str) -> Result<Self, NoShard> {
        let (number, of) = text.split_once('/').ok_or(NoShard)?;
        let whole = |text: &str| text.trim().parse::<usize>().map_err(|_| NoShard);
        let shard = Self { number: whole(number)?, of: whole(of)? };
        let exists = shard.of <= MOST_SHARDS && (1..=shard.of).contains(&shard.number);
        exists.then_some(shard).ok_or(NoShard)
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}/{}", self.number, self.of)
    }
}

/// The first line of a shard: the study that its points belong to.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct StudyDocument {
    /// The kind of document.
    pub schema: String,
    /// The identity of the study: a hash of program version, command and file.
    pub study: String,
    /// The version of the program.
    pub version: String,
    /// The words of the command, without those that say how its result is handed on.
    pub command: Vec<String>,
    /// The text of the file that the command reads; null where it reads none.
    pub file: Option<String>,
    /// The shard whose points follow, I/N.
    pub shard: String,
    /// The number of points of the whole study.
    pub total: usize,
}

/// A point of a study, in a line of its own.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct PointDocument {
    /// The kind of document.
    pub schema: String,
    /// The identity of the study that it belongs to.
    pub study: String,
    /// The version of the program.
    pub version: String,
    /// The place of the point in the study, counted from 0.
    pub index: usize,
    /// The number of points of the whole study.
    pub total: usize,
    /// The point, by the names of what varies: the parameters of a sweep, the name of a material,
    /// the number of a run, the name of a claim.
    pub inputs: Map<String, Value>,
    /// The result, with keys that depend on the command.
    pub row: Map<String, Value>,
}

impl StudyDocument {
    /// Describes the study of a command, split so.
    pub fn new(
        version: &str,
        command: Vec<String>,
        file: Option<String>,
        total: usize,
        shard: Shard,
    ) -> Self {
        Self {
            schema: DocumentKind::Study.schema().to_owned(),
            study: identity(version, &command, file.as_deref()),
            version: version.to_owned(),
            command,
            file,
            shard: shard.to_string(),
            total,
        }
    }

    /// The point of this index.
    pub fn point(
        &self,
        index: usize,
        inputs: Map<String, Value>,
        row: Map<String, Value>,
    ) -> PointDocument {
        PointDocument {
            schema: DocumentKind::Point.schema().to_owned(),
            study: self.study.clone(),
            version: self.version.clone(),
            index,
            total: self.total,
            inputs,
            row,
        }
    }

    /// The document as a line, with its line end.
    ///
    /// # Errors
    /// The errors of the writer.
    pub fn line(&self) -> Result<String, JsonError> {
        Ok(serde_json::to_string(self)? + "\n")
    }

    /// Whether the identity is that of what is asked, and the shard exists.
    fn is_consistent(&self) -> bool {
        self.study == identity(&self.version, &self.command, self.file.as_deref())
            && self.shard.parse::<Shard>().is_ok()
    }
}

impl PointDocument {
    /// The document as a line, with its line end.
    ///
    /// # Errors
    /// The errors of the writer.
    pub fn line(&self) -> Result<String, JsonError> {
        Ok(serde_json::to_string(self)? + "\n")
    }
}

/// The hash FNV-1a, 128 bits, of what is asked, as 32 hexadecimal digits. It tells studies apart
/// that differ by mistake; it is no protection against forgery.
fn identity(version: &str, command: &[String], file: Option<&str>) -> String {
    const BASIS: u128 = 0x6c62_272e_07bb_0142_62b8_2175_6295_c58d;
    const PRIME: u128 = 0x0000_0000_0100_0000_0000_0000_0000_013b;
    let parts = std::iter::once(version).chain(command.iter().map(String::as_str)).chain(file);
    // A byte that no text has stands behind each part.
    let bytes = parts.flat_map(|part| part.bytes().chain([0xff]));
    let hash = bytes.fold(BASIS, |hash, byte| (hash ^ u128::from(byte)).wrapping_mul(PRIME));
    format!("{hash:032x}")
}

/// The reason why lines cannot be put together.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum ShardError {
    /// No line says what was asked.
    #[error("there is no line of a shard: `--shard I/N` writes them")]
    NoStudy,
    /// A line of something else.
    #[error("{place}: this is no line of a shard")]
    Foreign {
        /// The file and the line.
        place: String,
    },
    /// Lines of two studies.
    #[error("{place}: this line belongs to another study than {first}: {difference}")]
    Mixed {
        /// The file and the line.
        place: String,
        /// The file and the line of the first study.
        first: String,
        /// The difference.
        difference: String,
    },
    /// Two lines of one point that differ.
    #[error("{place}: point {index} differs from that in {first}")]
    Disagree {
        /// The file and the line.
        place: String,
        /// The point, counted from 0.
        index: usize,
        /// The file and the line of the first.
        first: String,
    },
}

/// A point that was read: its file and line, and what it says.
#[derive(Clone, Debug)]
struct ReadPoint {
    source: usize,
    line: usize,
    point: PointDocument,
}

/// Lines of shards, put together in any order.
#[derive(Clone, Debug, Default)]
pub struct JoinedLines {
    sources: Vec<String>,
    /// The studies, of which there is one in the end, with their places.
    heads: Vec<(StudyDocument, usize, usize)>,
    points: BTreeMap<usize, ReadPoint>,
    torn: Vec<String>,
}

/// A study whose lines were put together.
#[derive(Clone, Debug)]
pub struct JoinedStudy {
    /// The study; its shard is that of the first line.
    pub study: StudyDocument,
    /// The points that are there, by their indices.
    pub points: BTreeMap<usize, PointDocument>,
    /// The shards whose first lines were read, each with its file.
    pub shards: Vec<(Shard, String)>,
    /// The files and lines that are cut off.
    pub torn: Vec<String>,
}

impl JoinedLines {
    /// Adds the lines of a file. A line that is cut off is kept in mind; its point is missing.
    ///
    /// The cost is that of reading the lines.
    ///
    /// # Errors
    /// [`ShardError`]: a line of something else or of another study, or one that contradicts a line
    /// that was read before.
    pub fn add(&mut self, source: &str, text: &str) -> Result<(), ShardError> {
        let number = self.sources.len();
        self.sources.push(source.to_owned());
        for (line, text) in text.lines().enumerate().filter(|(_, text)| !text.trim().is_empty()) {
            let foreign = || ShardError::Foreign { place: self.place(number, line) };
            if let Ok(point) = serde_json::from_str::<PointDocument>(text) {
                let is_point = point.schema == DocumentKind::Point.schema();
                if !is_point || point.index >= point.total {
                    return Err(foreign());
                }
                self.add_point(ReadPoint { source: number, line, point })?;
            } else if let Ok(head) = serde_json::from_str::<StudyDocument>(text) {
                if head.schema != DocumentKind::Study.schema() || !head.is_consistent() {
                    return Err(foreign());
                }
                self.heads.push((head, number, line));
            } else if serde_json::from_str::<Value>(text).is_err() && text.starts_with('{') {
                self.torn.push(self.place(number, line));
            } else {
                return Err(foreign());
            }
        }
        Ok(())
    }

    fn place(&self, source: usize, line: usize) -> String {
        format!("{}, line {}", self.sources[source], line + 1)
    }

    fn add_point(&mut self, read: ReadPoint) -> Result<(), ShardError> {
        let index = read.point.index;
        let Some(known) = self.points.get(&index) else {
            self.points.insert(index, read);
            return Ok(());
        };
        let place = self.place(read.source, read.line);
        let first = self.place(known.source, known.line);
        if (&known.point.study, known.point.total) != (&read.point.study, read.point.total) {
            let difference = "its identity".to_owned();
            return Err(ShardError::Mixed { place, first, difference });
        }
        // As texts, for zeros of both signs are equal as numbers.
        let text = |point: &PointDocument| serde_json::to_string(point).unwrap_or_default();
        match text(&known.point) == text(&read.point) {
            true => Ok(()),
            false => Err(ShardError::Disagree { place, index, first }),
        }
    }

    /// The study that all lines belong to.
    ///
    /// # Errors
    /// [`ShardError`]: no line says what was asked, or lines belong to several studies.
    pub fn study(self) -> Result<JoinedStudy, ShardError> {
        let (study, source, line) = self.heads.first().ok_or(ShardError::NoStudy)?;
        let first = self.place(*source, *line);
        for (other, source, line) in &self.heads {
            if let Some(difference) = difference(study, other) {
                let place = self.place(*source, *line);
                return Err(ShardError::Mixed { place, first, difference });
            }
        }
        let is_other = |read: &&ReadPoint| {
            (&read.point.study, read.point.total) != (&study.study, study.total)
        };
        if let Some(other) = self.points.values().find(is_other) {
            let place = self.place(other.source, other.line);
            return Err(ShardError::Mixed { place, first, difference: "its identity".to_owned() });
        }
        let shard = |(head, source, _): &(StudyDocument, usize, usize)| {
            Some((head.shard.parse().ok()?, self.sources[*source].clone()))
        };
        Ok(JoinedStudy {
            shards: self.heads.iter().filter_map(shard).collect(),
            study: study.clone(),
            points: self.points.into_iter().map(|(index, read)| (index, read.point)).collect(),
            torn: self.torn,
        })
    }
}

/// Returns the difference of two studies in words; `None` if there is none.
fn difference(one: &StudyDocument, other: &StudyDocument) -> Option<String> {
    let versions = || format!("version {} and {}", one.version, other.version);
    let commands = || format!("`{}` and `{}`", one.command.join(" "), other.command.join(" "));
    if one.version != other.version {
        Some(versions())
    } else if one.command != other.command {
        Some(commands())
    } else if one.file != other.file {
        Some("the file that was read has another text".to_owned())
    } else {
        (one.total != other.total).then(|| "the number of points".to_owned())
    }
}

impl JoinedStudy {
    /// The points that are missing, by their indices.
    pub fn missing(&self) -> Vec<usize> {
        (0..self.study.total).filter(|index| !self.points.contains_key(index)).collect()
    }

    /// The shards that have the missing points, by the finest split that was read.
    pub fn missing_shards(&self) -> Vec<Shard> {
        let of = self.shards.iter().map(|(shard, _)| shard.of()).max().unwrap_or(1);
        let mut shards: Vec<Shard> =
            self.missing().into_iter().map(|index| Shard::with_point(index, of)).collect();
        shards.sort_unstable();
        shards.dedup();
        shards
    }

    /// The rows of all points, in order; `None` if one is missing.
    pub fn rows(self) -> Option<Vec<Map<String, Value>>> {
        let total = self.study.total;
        let rows: Vec<_> = self.points.into_values().map(|point| point.row).collect();
        (rows.len() == total).then_some(rows)
    }
}
