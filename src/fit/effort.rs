//! How much a fit works for its result.

use std::fmt;
use std::str::FromStr;

/// How finely a fit searches and how far it goes down: the knobs that cost time. Less than the default can miss the global
/// minimum; `docs/fit_cost.md` shows what each step buys.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Effort {
    /// Nodes of the starting grid in roughness, from a lobe that the smallest half-vector angle just sees to one of a radian.
    /// At least 1.
    pub roughness_nodes: usize,
    /// Nodes of the starting grid in n - 1, from 0.15 to 1.2. At least 1.
    pub index_nodes: usize,
    /// How many nodes are polished: the best ones that differ in roughness. At least 1.
    pub starts: usize,
    /// A polish ends when the predicted decrease of chi-square is below this share of chi-square per degree of freedom: the
    /// minimum is then the square root of it away, in standard uncertainties.
    pub tolerance: f64,
}

impl Effort {
    /// The same with every number in its range.
    pub(super) fn in_range(self) -> Self {
        Self {
            roughness_nodes: self.roughness_nodes.max(1),
            index_nodes: self.index_nodes.max(1),
            starts: self.starts.max(1),
            // Not a number: as small as rounding lets through.
            tolerance: self.tolerance.max(0.0),
        }
    }
}

/// A text that names no nodes.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("`{0}` are no nodes; expected ROUGHNESSxINDEXxSTARTS, each from 1 to 1000, as 12x3x2")]
pub struct UnknownNodes(String);

/// The nodes of a starting grid and how many of them are polished, as `12x3x2`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Nodes {
    /// As [`Effort::roughness_nodes`].
    pub roughness: usize,
    /// As [`Effort::index_nodes`].
    pub index: usize,
    /// As [`Effort::starts`].
    pub starts: usize,
}

impl FromStr for Nodes {
    type Err = UnknownNodes;

    fn from_str(text: &str) -> Result<Self, UnknownNodes> {
        let number = |text: &str| text.parse::<usize>().ok().filter(|count| (1..=1000).contains(count));
        let numbers: Option<Vec<usize>> = text.split('x').map(number).collect();
        match numbers.as_deref() {
            Some([roughness, index, starts]) => Ok(Self { roughness: *roughness, index: *index, starts: *starts }),
            _ => Err(UnknownNodes(text.to_owned())),
        }
    }
}

impl fmt::Display for Nodes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}x{}x{}", self.roughness, self.index, self.starts)
    }
}

impl Effort {
    /// The effort of these nodes and this tolerance.
    #[must_use]
    pub fn of(nodes: Nodes, tolerance: f64) -> Self {
        Self { roughness_nodes: nodes.roughness, index_nodes: nodes.index, starts: nodes.starts, tolerance }
    }

    /// Its nodes.
    #[must_use]
    pub fn nodes(self) -> Nodes {
        Nodes { roughness: self.roughness_nodes, index: self.index_nodes, starts: self.starts }
    }

    /// The search, as a model states its method; the usual tolerance is not named.
    pub(super) fn in_words(self) -> String {
        let Self { roughness_nodes, index_nodes, tolerance, .. } = self;
        let starts = match self.starts {
            1 => "one start".to_owned(),
            2 => "two starts".to_owned(),
            many => format!("{many} starts"),
        };
        let usual = Self::default().tolerance;
        let tolerance = if tolerance == usual { String::new() } else { format!(" to a tolerance of {tolerance:e}") };
        format!("a {roughness_nodes} x {index_nodes} grid, {starts} polished by Levenberg-Marquardt{tolerance}")
    }
}

impl Default for Effort {
    /// At the global optimum in every scan of every kind that `benches/fit` draws; fewer nodes lose narrow lobes first.
    fn default() -> Self {
        Self { roughness_nodes: 12, index_nodes: 3, starts: 2, tolerance: 1e-8 }
    }
}

/// That many numbers between two positive ones, both included, with equal ratios; a single one is in their middle.
pub(super) fn spaced(low: f64, high: f64, count: usize) -> Vec<f64> {
    let step = (high / low).ln() / (count.max(2) - 1) as f64;
    let first = if count == 1 { (low * high).sqrt() } else { low };
    (0..count).map(|k| first * (step * k as f64).exp()).collect()
}
