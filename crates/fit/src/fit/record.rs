//! Measured records from text: CSV, tables with tabs, semicolons or blanks, with or without a head.
//!
//! A line is one sample. Lines that begin with `#` or `%` are comments. The first line whose cells are no numbers is the head; a unit
//! in it, such as `t (ms)` or `angle [deg]`, converts times to seconds and angles to radians. Empty cells and `NaN` are gaps. Equal times in
//! succession are averaged.

use thiserror::Error;

use crate::fit::motion::Quantity;

/// A record of one quantity at increasing times.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Record {
    /// Increasing times.
    pub times: Vec<f64>,
    /// The observed values.
    pub values: Vec<f64>,
    /// The observed quantity.
    pub quantity: Quantity,
    /// Whether the values are angles in radians.
    pub is_angle: bool,
}

/// A record serves where several may be given.
impl AsRef<[Self]> for Record {
    fn as_ref(&self) -> &[Self] {
        std::slice::from_ref(self)
    }
}

/// The columns to read, and their content.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReadOptions {
    /// The column of time, by its name or its number from 1; otherwise the one called `t` or `time`, or the first.
    pub time: Option<String>,
    /// The columns of values, each a record; otherwise the first that is not the time.
    pub values: Vec<String>,
    /// The observed quantity.
    pub quantity: Quantity,
    /// Whether the values are angles; also if the head names degrees or radians.
    pub is_angle: bool,
}

/// A record as it was read.
#[derive(Clone, Debug, PartialEq)]
pub struct ReadRecord {
    /// The record.
    pub record: Record,
    /// The name of its column.
    pub name: String,
    /// The line of each sample, from 1.
    pub lines: Vec<usize>,
    /// The lines without a value.
    pub missing: Vec<usize>,
    /// The lines whose time repeats that of the line before; their values were averaged.
    pub repeated: Vec<usize>,
}

/// The reason why a record cannot be read.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ReadError {
    /// There are no samples.
    #[error("there are no lines with numbers")]
    Empty,
    /// There is only one column.
    #[error("line {line}: there is one column only")]
    OneColumn {
        /// The line.
        line: usize,
    },
    /// A cell is not a number.
    #[error("line {line}: `{text}` in the column `{column}` is not a number")]
    NotANumber {
        /// The line.
        line: usize,
        /// The name of the column.
        column: String,
        /// The text of the cell.
        text: String,
    },
    /// A line has too few cells.
    #[error(
        "line {line}: the column `{column}` is number {needed}, but the cells end at number {found}"
    )]
    Short {
        /// The line.
        line: usize,
        /// The number of cells.
        found: usize,
        /// The name of the column.
        column: String,
        /// The number of the column.
        needed: usize,
    },
    /// There is no column of this name or number.
    #[error("there is no column `{wanted}`; the columns are {columns}")]
    NoColumn {
        /// The column asked for.
        wanted: String,
        /// The names of the columns.
        columns: String,
    },
    /// The time runs back.
    #[error("line {line}: the time runs back from {before} to {now}")]
    TimeRunsBack {
        /// The line.
        line: usize,
        /// The time of the line before.
        before: f64,
        /// The time of this line.
        now: f64,
    },
}

impl ReadError {
    /// A way forward.
    pub fn help(&self) -> &'static str {
        match self {
            Self::Empty => "write a line for each sample: time, value",
            Self::OneColumn { .. } => "write the time of each sample in a column before its value",
            Self::NotANumber { .. } => {
                "correct the cell, leave it empty, or begin the line with `#` if it is a comment"
            }
            Self::Short { .. } => "complete the line, or leave it out",
            Self::NoColumn { .. } => "name a column of the head, or give its number from 1",
            Self::TimeRunsBack { .. } => {
                "sort the lines by time; if a second record begins here, put it into a file of its own"
            }
        }
    }
}

/// The units that are converted, with their factors to seconds or radians.
const UNITS: [(&str, f64, bool); 11] = [
    ("s", 1.0, false),
    ("sec", 1.0, false),
    ("ms", 1e-3, false),
    ("us", 1e-6, false),
    ("µs", 1e-6, false),
    ("min", 60.0, false),
    ("deg", std::f64::consts::PI / 180.0, true),
    ("°", std::f64::consts::PI / 180.0, true),
    ("degrees", std::f64::consts::PI / 180.0, true),
    ("rad", 1.0, true),
    ("radians", 1.0, true),
];

/// Reads records.
///
/// # Errors
/// [`ReadError`].
///
/// ```
/// use lindstedt_fit::fit::record::{ReadOptions, read};
///
/// let text = "t (ms), angle [deg]\n0, 90\n10, 45\n20,\n30, -45\n";
/// let records = read(text, &ReadOptions::default())?;
/// assert_eq!(records[0].record.times, [0.0, 0.01, 0.03]);
/// assert!(records[0].record.is_angle && (records[0].record.values[1] - 0.7854).abs() < 1e-4);
/// assert_eq!(records[0].missing, [4]);
/// # Ok::<(), lindstedt_fit::fit::record::ReadError>(())
/// ```
pub fn read(text: &str, options: &ReadOptions) -> Result<Vec<ReadRecord>, ReadError> {
    let table = Table::new(text)?;
    let names = &table.names;
    if let ([_], Some((line, _))) = (names.as_slice(), table.rows.first()) {
        return Err(ReadError::OneColumn { line: *line });
    }
    let is_time = |name: &String| ["t", "time"].contains(&bare(name).to_lowercase().as_str());
    let time = match &options.time {
        Some(wanted) => table.column(wanted)?,
        None => names.iter().position(is_time).unwrap_or(0),
    };
    let values = match options.values.is_empty() {
        true => vec![(0..names.len()).find(|column| *column != time).unwrap_or(1)],
        false => {
            options.values.iter().map(|wanted| table.column(wanted)).collect::<Result<_, _>>()?
        }
    };
    values.into_iter().map(|value| table.record(time, value, options)).collect()
}

/// A column of numbers, in any order.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Its name, with its unit.
    pub name: String,
    /// The numbers; those of units that are converted are in seconds or radians.
    pub values: Vec<f64>,
}

/// Reads columns of numbers, such as amplitudes and frequencies, or times of impacts: those of these names or
/// numbers from 1, or else the first ones, as many as there are up to `most`. Lines with an empty cell are left out.
///
/// # Errors
/// [`ReadError`].
///
/// ```
/// use lindstedt_fit::fit::record::read_columns;
///
/// let columns = read_columns("A, f (Hz)\n2, 1.5\n1, 1.6\n", &[], 3)?;
/// assert_eq!((columns.len(), columns[1].name.as_str()), (2, "f (Hz)"));
/// assert_eq!(columns[0].values, [2.0, 1.0]);
/// # Ok::<(), lindstedt_fit::fit::record::ReadError>(())
/// ```
pub fn read_columns(text: &str, wanted: &[String], most: usize) -> Result<Vec<Column>, ReadError> {
    let table = Table::new(text)?;
    let places: Vec<usize> = match wanted {
        [] => (0..table.names.len().min(most)).collect(),
        wanted => wanted.iter().map(|own| table.column(own)).collect::<Result<_, _>>()?,
    };
    let mut columns: Vec<Column> = places
        .iter()
        .map(|place| Column { name: table.names[*place].clone(), values: vec![] })
        .collect();
    for row in &table.rows {
        let cells = places.iter().map(|place| table.cell(row, *place));
        let cells = cells.collect::<Result<Vec<Option<f64>>, _>>()?;
        if cells.iter().any(Option::is_none) {
            continue;
        }
        for ((column, cell), place) in
            columns.iter_mut().zip(cells.into_iter().flatten()).zip(&places)
        {
            let factor = unit(&table.names[*place]).map_or(1.0, |(factor, _)| factor);
            column.values.push(cell * factor);
        }
    }
    match columns.first().is_none_or(|column| column.values.is_empty()) {
        true => Err(ReadError::Empty),
        false => Ok(columns),
    }
}

/// The cells of a text.
struct Table<'a> {
    names: Vec<String>,
    rows: Vec<(usize, Vec<&'a str>)>,
    has_decimal_comma: bool,
}

impl<'a> Table<'a> {
    fn new(text: &'a str) -> Result<Self, ReadError> {
        let lines = text.lines().zip(1..).map(|(line, number)| (number, line.trim()));
        let is_comment = |line: &str| line.is_empty() || line.starts_with(['#', '%']);
        let lines: Vec<(usize, &str)> = lines.filter(|(_, line)| !is_comment(line)).collect();
        let (_, first) = *lines.last().ok_or(ReadError::Empty)?;
        let separator = [';', '\t', ','].into_iter().find(|separator| first.contains(*separator));
        // With semicolons or tabs between the cells a comma is a decimal point.
        let has_decimal_comma =
            separator.is_some_and(|separator| separator != ',') && first.contains(',');
        let cells = |line: &'a str| -> Vec<&'a str> {
            match separator {
                Some(separator) => line.split(separator).map(str::trim).collect(),
                None => line.split_whitespace().collect(),
            }
        };
        let mut rows: Vec<(usize, Vec<&str>)> =
            lines.iter().map(|(number, line)| (*number, cells(line))).collect();
        let is_head = |row: &(usize, Vec<&str>)| {
            row.1.iter().all(|cell| number(cell, has_decimal_comma).is_none())
        };
        let mut names: Vec<String> = vec![];
        if rows.first().is_some_and(is_head) {
            for name in rows.remove(0).1.iter().map(|name| name.trim_matches('"')) {
                // Between blanks a unit in brackets belongs to the name before it.
                match names.last_mut() {
                    Some(before) if separator.is_none() && name.starts_with(['(', '[']) => {
                        *before += " ";
                        *before += name;
                    }
                    _ => names.push(name.to_owned()),
                }
            }
        }
        let Some((_, row)) = rows.first() else { return Err(ReadError::Empty) };
        let width = row.len().max(names.len());
        names.extend((names.len()..width).map(|column| format!("{}", column + 1)));
        Ok(Self { names, rows, has_decimal_comma })
    }

    fn column(&self, wanted: &str) -> Result<usize, ReadError> {
        let by_name = |name: &String| name == wanted || bare(name) == wanted;
        let by_number = wanted.parse::<usize>().ok().and_then(|number| number.checked_sub(1));
        let by_number = by_number.filter(|column| *column < self.names.len());
        self.names.iter().position(by_name).or(by_number).ok_or_else(|| ReadError::NoColumn {
            wanted: wanted.to_owned(),
            columns: self.names.join(", "),
        })
    }

    /// The number in a cell of a line; `None` if it is empty.
    fn cell(
        &self,
        (line, cells): &(usize, Vec<&str>),
        column: usize,
    ) -> Result<Option<f64>, ReadError> {
        let text = cells.get(column).copied().ok_or_else(|| ReadError::Short {
            line: *line,
            found: cells.len(),
            column: self.names[column].clone(),
            needed: column + 1,
        })?;
        if text.is_empty() || text.eq_ignore_ascii_case("nan") {
            return Ok(None);
        }
        let found = number(text, self.has_decimal_comma).filter(|own| own.is_finite());
        found.map(Some).ok_or_else(|| ReadError::NotANumber {
            line: *line,
            column: self.names[column].clone(),
            text: text.to_owned(),
        })
    }

    fn record(
        &self,
        time: usize,
        value: usize,
        options: &ReadOptions,
    ) -> Result<ReadRecord, ReadError> {
        let name = self.names[value].clone();
        let time_factor = unit(&self.names[time]).filter(|(_, is_angle)| !is_angle);
        let time_factor = time_factor.map_or(1.0, |(factor, _)| factor);
        let value_unit = unit(&name).filter(|(_, is_angle)| *is_angle);
        let is_angle = options.is_angle || value_unit.is_some();
        let value_factor = value_unit.map_or(1.0, |(factor, _)| factor);
        let record = Record { quantity: options.quantity, is_angle, ..Record::default() };
        let mut read =
            ReadRecord { record, name, lines: vec![], missing: vec![], repeated: vec![] };
        let mut equal = 1.0;
        for row in &self.rows {
            let (line, _) = row;
            let (Some(now), Some(own)) = (self.cell(row, time)?, self.cell(row, value)?) else {
                read.missing.push(*line);
                continue;
            };
            let (now, own) = (now * time_factor, own * value_factor);
            let Record { times, values, .. } = &mut read.record;
            match (times.last(), values.last_mut()) {
                (Some(before), _) if now < *before => {
                    return Err(ReadError::TimeRunsBack { line: *line, before: *before, now });
                }
                (Some(before), Some(last)) if now == *before => {
                    equal += 1.0;
                    *last += (own - *last) / equal;
                    read.repeated.push(*line);
                }
                _ => {
                    equal = 1.0;
                    times.push(now);
                    values.push(own);
                    read.lines.push(*line);
                }
            }
        }
        if read.record.times.is_empty() { Err(ReadError::Empty) } else { Ok(read) }
    }
}

fn number(text: &str, has_decimal_comma: bool) -> Option<f64> {
    let text = text.trim_matches('"');
    match has_decimal_comma {
        true => text.replace(',', ".").parse().ok(),
        false => text.parse().ok(),
    }
}

/// A name without its unit.
fn bare(name: &str) -> &str {
    name.split(['(', '[', '/']).next().unwrap_or(name).trim()
}

/// The factor of a unit in brackets, or after a slash, and whether it is one of angle.
fn unit(name: &str) -> Option<(f64, bool)> {
    let from = name.find(['(', '[', '/'])?;
    let text = name[from + 1..].trim_end_matches([')', ']']).trim();
    UNITS.iter().find(|(unit, ..)| *unit == text).map(|(_, factor, is_angle)| (*factor, *is_angle))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn error(text: &str, options: &ReadOptions) -> ReadError {
        read(text, options).unwrap_err()
    }

    #[test]
    fn formats_of_tables_are_recognised() {
        let usual = ReadOptions::default();
        for text in [
            "0,1\n1,2\n",
            "0\t1\n1\t2",
            "# made by hand\n0 1\n\n1  2\n",
            "0;1,0\n1;2,0\n",
            "t (s) x [m]\n0 1\n1 2\n",
        ] {
            let found = read(text, &usual).unwrap();
            assert_eq!(found[0].record.values, [1.0, 2.0], "{text}");
        }
        let text = "x;time (min);y\n1;0;5\n2;1;6\n3;1;8\n";
        let both = ReadOptions { values: vec!["x".into(), "3".into()], ..usual };
        let found = read(text, &both).unwrap();
        assert_eq!(found[0].record.times, [0.0, 60.0]);
        assert_eq!((found[1].name.as_str(), found[1].record.values.clone()), ("y", vec![5.0, 7.0]));
        assert_eq!(found[1].repeated, [4]);
    }

    #[test]
    fn mistakes_are_named_with_their_lines() {
        let usual = ReadOptions::default();
        assert_eq!(error("# nothing\n", &usual), ReadError::Empty);
        assert_eq!(error("1\n2\n", &usual), ReadError::OneColumn { line: 1 });
        let found = error("t,x\n0,1\n1,a\n", &usual);
        assert_eq!(found.to_string(), "line 3: `a` in the column `x` is not a number");
        assert_eq!(
            error("0,1\n2,1\n1,1\n", &usual).to_string(),
            "line 3: the time runs back from 2 to 1"
        );
        assert!(matches!(error("0,1\n1\n2,3", &usual), ReadError::Short { line: 2, .. }));
        let wanted = ReadOptions { values: vec!["z".into()], ..usual };
        assert_eq!(
            error("t,x\n0,1\n", &wanted).to_string(),
            "there is no column `z`; the columns are t, x"
        );
    }
}
