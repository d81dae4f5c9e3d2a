//! Lists of [short series](super), which an expansion allocates once.

use super::{FixedWidth, Header, ShortSeries};

/// Series one after the other, with all their numerators in one piece of memory.
#[derive(Clone, Debug)]
pub struct ShortSeriesList<W = i128> {
    /// Each series, and the range of its numerators.
    series: Vec<(Header<W>, [usize; 2])>,
    numerators: Vec<W>,
}

impl<W> Default for ShortSeriesList<W> {
    fn default() -> Self {
        Self { series: vec![], numerators: vec![] }
    }
}

impl<W: FixedWidth> ShortSeriesList<W> {
    /// An empty list with room for so many series and numerators.
    pub fn with_capacity(series: usize, numerators: usize) -> Self {
        Self { series: Vec::with_capacity(series), numerators: Vec::with_capacity(numerators) }
    }

    /// Number of series.
    pub fn len(&self) -> usize {
        self.series.len()
    }

    /// Whether there are no series.
    pub fn is_empty(&self) -> bool {
        self.series.is_empty()
    }

    /// The series at a place; `None` beyond the last.
    pub fn get(&self, index: usize) -> Option<ShortSeries<'_, W>> {
        (index < self.len()).then(|| self.known(index))
    }

    /// The series at a place that there is.
    #[inline]
    pub(super) fn known(&self, index: usize) -> ShortSeries<'_, W> {
        let (header, [start, end]) = self.series[index];
        ShortSeries { header, numerators: &self.numerators[start..end] }
    }

    /// Appends a series.
    pub fn push(&mut self, series: ShortSeries<W>) {
        let start = self.numerators.len();
        self.numerators.extend(series.numerators);
        self.series.push((series.header, [start, self.numerators.len()]));
    }

    /// Replaces the last series.
    pub fn replace_last(&mut self, series: ShortSeries<W>) {
        if let Some((_, [start, _])) = self.series.pop() {
            self.numerators.truncate(start);
        }
        self.push(series);
    }
}

impl ShortSeriesList {
    /// Sets the first series of another list, at most so many.
    pub fn set_beginning(&mut self, narrow: &ShortSeriesList<i64>, count: usize) {
        self.series.clear();
        self.numerators.clear();
        for index in 0..count.min(narrow.len()) {
            let series = narrow.known(index);
            let start = self.numerators.len();
            self.numerators.extend(series.numerators.iter().map(|own| i128::from(*own)));
            let Header { wave, harmonics, denominator, largest } = series.header;
            let header = Header { wave, harmonics, denominator: denominator.into(), largest };
            self.series.push((header, [start, self.numerators.len()]));
        }
    }
}
