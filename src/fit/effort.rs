//! How much a fit works for its result.

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
