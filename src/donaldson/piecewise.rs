//! Straight lines between points, and exact integrals of them. A spectrum is never sampled where it is to be integrated: a line
//! of mercury between two wavelengths of a matrix is light as well.

/// A function that is straight between its points and not defined outside.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Line {
    nm: Vec<f64>,
    values: Vec<f64>,
}

impl Line {
    /// A line through two points or more, at ascending wavelengths.
    pub(super) fn new(nm: Vec<f64>, values: Vec<f64>) -> Self {
        Self { nm, values }
    }

    /// A triangle of height 1 with these corners, nm. A corner on the peak makes it half a triangle.
    pub(super) fn triangle(low: f64, peak: f64, high: f64) -> Self {
        let corners = [(low, 0.0), (peak, 1.0), (high, 0.0)];
        let kept = corners.into_iter().filter(|(nm, height)| *height > 0.0 || *nm != peak);
        let (nm, values) = kept.unzip();
        Self { nm, values }
    }

    pub(super) fn nm(&self) -> &[f64] {
        &self.nm
    }

    pub(super) fn values(&self) -> &[f64] {
        &self.values
    }

    /// First and last point, nm.
    pub(super) fn range(&self) -> (f64, f64) {
        (self.nm[0], self.nm[self.nm.len() - 1])
    }

    /// The value there; `None` outside.
    pub(super) fn at(&self, nm: f64) -> Option<f64> {
        let (low, high) = self.range();
        if !(low..=high).contains(&nm) {
            return None;
        }
        let after = self.nm.partition_point(|point| *point <= nm).min(self.nm.len() - 1);
        let before = after.saturating_sub(1);
        let width = self.nm[after] - self.nm[before];
        let part = if width > 0.0 { (nm - self.nm[before]) / width } else { 0.0 };
        Some(self.values[before] + part * (self.values[after] - self.values[before]))
    }

    /// The integral of this line times another where both are defined.
    pub(super) fn integral_with(&self, other: &Self) -> f64 {
        let (a, b) = (self.range(), other.range());
        let (low, high) = (a.0.max(b.0), a.1.min(b.1));
        if low >= high {
            return 0.0;
        }
        let mut points = vec![low];
        for line in [self, other] {
            let from = line.nm.partition_point(|point| *point <= low);
            points.extend(line.nm[from..].iter().take_while(|point| **point < high));
        }
        points.push(high);
        points.sort_by(f64::total_cmp);
        let product = |nm: f64| self.at(nm).unwrap_or(0.0) * other.at(nm).unwrap_or(0.0);
        // Simpson's rule is exact for a product of two straight lines.
        let piece = |pair: &[f64]| {
            let middle = (pair[0] + pair[1]) / 2.0;
            (pair[1] - pair[0]) / 6.0 * (product(pair[0]) + 4.0 * product(middle) + product(pair[1]))
        };
        points.windows(2).map(piece).sum()
    }

    /// The average with another line as weight, over where this one is defined; `None` where it is not at the weight's `peak`.
    pub(super) fn average_over(&self, weight: &Self, peak: f64) -> Option<f64> {
        self.at(peak)?;
        let (low, high) = self.range();
        let whole = Self::new(vec![low, high], vec![1.0, 1.0]).integral_with(weight);
        if whole > 0.0 { Some(self.integral_with(weight) / whole) } else { self.at(peak) }
    }
}

/// For each point of an axis the triangle from its neighbour to its neighbour: together they are 1 everywhere between the first
/// and the last point, so that what is shared out with them is neither lost nor counted twice, whatever the steps.
pub(super) fn tents(nm: &[f64]) -> Vec<Line> {
    let last = nm.len().saturating_sub(1);
    (0..nm.len()).map(|k| Line::triangle(nm[k.saturating_sub(1)], nm[k], nm[(k + 1).min(last)])).collect()
}

/// Where a wavelength lies on an ascending axis: the point below and above, and the part of the way; `None` outside.
pub(crate) fn place(axis: &[f64], nm: f64) -> Option<(usize, usize, f64)> {
    let last = axis.len().checked_sub(1)?;
    if !(axis[0]..=axis[last]).contains(&nm) {
        return None;
    }
    let after = axis.partition_point(|point| *point < nm).min(last);
    if axis[after] == nm {
        return Some((after, after, 0.0));
    }
    let before = after.saturating_sub(1);
    Some((before, after, (nm - axis[before]) / (axis[after] - axis[before])))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_between_two_wavelengths_is_shared_out_whole() {
        // 1 nm wide at 405.46 nm, between steps of 10 and of 7 nm.
        let lamp = Line::new(vec![300.0, 404.96, 405.46, 405.96, 800.0], vec![0.0, 0.0, 2.0, 0.0, 0.0]);
        for axis in [[400.0, 410.0, 420.0], [398.0, 405.0, 412.0]] {
            let seen: f64 = tents(&axis).iter().map(|tent| lamp.integral_with(tent)).sum();
            assert!((seen - 1.0).abs() < 1e-12, "{seen}");
        }
    }

    #[test]
    fn integrals_are_exact() {
        let rising = Line::new(vec![0.0, 2.0], vec![0.0, 2.0]);
        let tent = Line::triangle(0.0, 1.0, 2.0);
        assert!((rising.integral_with(&tent) - 1.0).abs() < 1e-15);
        let square = rising.integral_with(&rising);
        assert!((square - 8.0 / 3.0).abs() < 1e-15, "{square}");
        assert_eq!(rising.integral_with(&Line::triangle(3.0, 4.0, 5.0)), 0.0);
        assert_eq!(rising.at(2.0), Some(2.0));
        assert_eq!((rising.at(-0.1), rising.at(2.1)), (None, None));
        // Half of the triangle lies outside: the average is over the half that is known.
        assert_eq!(Line::new(vec![1.0, 5.0], vec![3.0, 3.0]).average_over(&tent, 1.0), Some(3.0));
    }
}
