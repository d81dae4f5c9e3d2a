//! The end of a run: the best value has ceased to change, or the generations or evaluations are
//! used up.
//!
//! With B_g the best value up to generation g, w the window:
//!
//! ```text
//! average   |B_(g-w) - B_g|/(w max(1, |B_g|)) <= tolerance                                   MATLAB since R2014a
//! weighted  sum_n (1/2)^n |B_(g-n+1) - B_(g-n)|/max(1, |B_g|), n = 1 .. w, <= tolerance      before
//! ```
//!
//! g is counted from 1, the first generation after the random population, so a window of 50 ends no
//! run before generation 51: a run of exactly 51 generations is one whose best value hardly moved
//! after the first.

/// The measure of the change of the best value over a window of generations.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum StallTest {
    /// The average change.
    #[default]
    Average,
    /// A weighted sum of the changes, in which the last ones count most.
    Weighted,
}

/// The reason why a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum GeneticStop {
    /// The best value has ceased to change.
    Stalled,
    /// The largest number of generations was reached.
    Generations,
    /// The budget of evaluations is spent.
    Budget,
    /// The run was interrupted.
    Interrupted,
}

impl GeneticStop {
    /// Every reason.
    pub const ALL: [Self; 4] = [Self::Stalled, Self::Generations, Self::Budget, Self::Interrupted];

    /// Returns the name of the reason, such as `stalled`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Stalled => "stalled",
            Self::Generations => "generations",
            Self::Budget => "budget",
            Self::Interrupted => "interrupted",
        }
    }

    /// Returns the reason of this name; `None` if there is none.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|stop| stop.name() == name)
    }
}

/// Whether the best values, beginning with that of the random population, have ceased to change.
/// They count as unchanged if no point was feasible over the whole window.
///
/// ```
/// # use lindstedt_numeric as lindstedt;
/// use lindstedt::genetic::{StallTest, has_stalled};
///
/// let still = vec![7.0; 60];
/// let first = (1..60).find(|end| has_stalled(&still[..*end], 50, 1e-6, StallTest::Average));
/// assert_eq!(first, Some(52)); // the random population and 51 generations
/// ```
pub fn has_stalled(best: &[f64], window: usize, tolerance: f64, test: StallTest) -> bool {
    // The random population does not count as a generation.
    let generations = best.get(1..).unwrap_or_default();
    let (Some(first), Some(last)) = (
        window
            .checked_add(1)
            .and_then(|back| generations.len().checked_sub(back))
            .map(|index| generations[index]),
        generations.last(),
    ) else {
        return false;
    };
    if first.is_infinite() && last.is_infinite() {
        return true;
    }
    let scale = last.abs().max(1.0);
    let change = match test {
        StallTest::Average => (first - last).abs() / window as f64,
        StallTest::Weighted => {
            let steps = generations.windows(2).rev().take(window);
            steps.rev().fold(0.0, |sum, pair| 0.5 * (sum + (pair[0] - pair[1]).abs()))
        }
    };
    change / scale <= tolerance
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The best values of a run that halves what is missing to 10 each generation.
    fn coming_down(count: i32) -> Vec<f64> {
        (0..count).map(|generation| 10.0 + 0.5_f64.powi(generation)).collect()
    }

    #[test]
    fn each_test_ends_a_run_where_its_formula_says() {
        let best = coming_down(120);
        let end =
            |window, test| (1..120).find(|end| has_stalled(&best[..*end], window, 1e-6, test));
        // 2^-(g-w)/(10 w) = 1e-6 at g - w = 14.3 for w = 5, and g values stand after the first.
        assert_eq!(end(5, StallTest::Average), Some(15 + 5 + 1));
        // Each of w terms is 2^-n 2^(n-1-g) = 2^-(g+1), over 10: w 2^-(g+1) = 1e-5 at g = 17.9 for
        // w = 5.
        assert_eq!(end(5, StallTest::Weighted), Some(18 + 1));
        // 2^-(g-w)/(10 w) = 1e-6 at g - w = 11 for w = 50.
        assert_eq!(end(50, StallTest::Average), Some(11 + 50 + 1));
    }

    #[test]
    fn a_value_found_late_is_a_change() {
        let mut best = vec![f64::INFINITY; 30];
        best.extend([5.0; 10]);
        assert!(!has_stalled(&best, 20, 1e-6, StallTest::Average));
        assert!(has_stalled(&[f64::INFINITY; 22], 20, 1e-6, StallTest::Average));
        assert!(!has_stalled(&[], 20, 1e-6, StallTest::Weighted));
    }
}
