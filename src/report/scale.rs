//! Scales: where on an axis a number stands, and which numbers an axis names.

use super::ticks::{Tick, around_zero_ticks, linear_ticks, logarithmic_factors, logarithmic_ticks, nice_step};

/// A scale between two different finite numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Scale {
    /// Equal distances are equal differences.
    Linear { from: f64, to: f64 },
    /// Equal distances are equal ratios; both ends are positive.
    Logarithmic { from: f64, to: f64 },
    /// Equal differences around zero, as far as `linear`, and equal ratios beyond it, on both sides.
    AroundZero { linear: f64, from: f64, to: f64 },
}

impl Scale {
    /// A linear scale over the finite ones of these numbers; a single number gets room on both sides.
    pub(super) fn linear_over(values: impl IntoIterator<Item = f64>) -> Option<Self> {
        let (from, to) = extent(values)?;
        let room = if to > from { 0.0 } else { from.abs().max(1.0) / 2.0 };
        Some(Self::Linear { from: from - room, to: to + room })
    }

    /// The same scale with a share of its length added on both sides.
    pub(super) fn widened(self, share: f64) -> Self {
        match self {
            Self::Linear { from, to } => {
                let room = (to - from) * share;
                Self::Linear { from: from - room, to: to + room }
            }
            Self::Logarithmic { from, to } => {
                let factor = (to / from).powf(share);
                Self::Logarithmic { from: from / factor, to: to * factor }
            }
            Self::AroundZero { .. } => self,
        }
    }

    /// The same linear scale, reaching down or up to a number.
    pub(super) fn including(self, value: f64) -> Self {
        match self {
            Self::Linear { from, to } => Self::Linear { from: from.min(value), to: to.max(value) },
            Self::Logarithmic { .. } | Self::AroundZero { .. } => self,
        }
    }

    /// The scale for colours: logarithmic where all numbers are positive and the largest is more than four times the
    /// ninth decile, so that a mirror peak does not hide everything else; otherwise linear.
    pub(super) fn for_colours(values: &[f64]) -> Option<Self> {
        let mut sorted: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
        sorted.sort_by(f64::total_cmp);
        let (first, last) = (*sorted.first()?, *sorted.last()?);
        let ninth_decile = sorted[(sorted.len() - 1) * 9 / 10];
        if first > 0.0 && last > 4.0 * ninth_decile {
            return Some(Self::Logarithmic { from: first, to: last });
        }
        Self::linear_over(sorted)
    }

    /// The same scale, reaching up to the next number that about `count` ticks name, so that the highest value has a tick
    /// at its height or just above.
    pub(super) fn ending_on_tick(self, count: usize) -> Self {
        // A longer scale may have wider steps; it settles after one or two.
        let mut scale = self;
        for _ in 0..4 {
            scale = scale.reaching_next_tick(count);
        }
        scale
    }

    fn reaching_next_tick(self, count: usize) -> Self {
        match self {
            Self::Linear { from, to } => {
                let step = nice_step((to - from) / count.max(1) as f64);
                let next = (to / step - 1e-9).ceil() * step;
                if next.is_finite() { Self::Linear { from, to: next.max(to) } } else { self }
            }
            Self::Logarithmic { from, to } => {
                let decade = to.log10().floor() as i32;
                let factors = logarithmic_factors(from, to);
                let powers = (decade..=decade + 1).map(|decade| 10f64.powi(decade));
                let next = powers
                    .flat_map(|power| factors.iter().map(move |factor| factor * power))
                    .find(|tick| *tick >= to * (1.0 - 1e-9) && tick.is_finite());
                Self::Logarithmic { from, to: next.map_or(to, |next| next.max(to)) }
            }
            Self::AroundZero { .. } => self,
        }
    }

    /// Where a number stands: 0 at `from`, 1 at `to`.
    pub(super) fn position(&self, value: f64) -> f64 {
        match *self {
            Self::Linear { from, to } => (value - from) / (to - from),
            Self::Logarithmic { from, to } => (value / from).ln() / (to / from).ln(),
            Self::AroundZero { linear, from, to } => {
                let at = |value: f64| (value / linear).asinh();
                (at(value) - at(from)) / (at(to) - at(from))
            }
        }
    }

    /// The number at a position.
    pub(super) fn value(&self, position: f64) -> f64 {
        match *self {
            Self::Linear { from, to } => from + position * (to - from),
            Self::Logarithmic { from, to } => from * (to / from).powf(position),
            Self::AroundZero { linear, from, to } => {
                let (low, high) = ((from / linear).asinh(), (to / linear).asinh());
                linear * (low + position * (high - low)).sinh()
            }
        }
    }

    /// What a reader must know of the scale beside its numbers.
    pub(super) fn kind(&self) -> &'static str {
        match self {
            Self::Linear { .. } => "",
            Self::Logarithmic { .. } => ", logarithmic",
            Self::AroundZero { .. } => ", logarithmic away from zero",
        }
    }

    /// About `count` named numbers.
    pub(super) fn ticks(&self, count: usize) -> Vec<Tick> {
        match *self {
            Self::Linear { from, to } => linear_ticks(from, to, count),
            Self::Logarithmic { from, to } => logarithmic_ticks(from, to),
            Self::AroundZero { linear, from, to } => around_zero_ticks(linear, from, to),
        }
    }
}

/// Ticks nearer to each other than this share of a scale have no room for their labels.
const LABEL_ROOM: f64 = 0.08;

impl Scale {
    /// About `count` named numbers, and the ends where no tick is near: of a colour bar a reader wants the extremes.
    pub(super) fn ticks_with_ends(&self, count: usize) -> Vec<Tick> {
        let mut ticks = self.ticks(count);
        for (end, value) in [(0.0, self.value(0.0)), (1.0, self.value(1.0))] {
            let is_free = ticks.iter().all(|tick| (self.position(tick.value) - end).abs() > LABEL_ROOM);
            if is_free {
                ticks.push(Tick { value, label: super::html::significant(value, 3) });
            }
        }
        ticks
    }

    /// At most about `most` of these numbers, as evenly as they lie: that nearest to 0, and outwards from it on both
    /// sides each next one that has room.
    pub(super) fn ticks_among(&self, numbers: &[f64], most: usize) -> Vec<Tick> {
        let room = 1.0 / most.max(1) as f64;
        let by_size = |a: &usize, b: &usize| numbers[*a].abs().total_cmp(&numbers[*b].abs());
        let Some(middle) = (0..numbers.len()).min_by(by_size) else { return Vec::new() };
        let outwards = |chosen: &mut Vec<f64>, number: f64| {
            let last = chosen.last().copied().unwrap_or(numbers[middle]);
            if (self.position(number) - self.position(last)).abs() >= room - 1e-9 {
                chosen.push(number);
            }
        };
        let (mut up, mut down) = (Vec::new(), Vec::new());
        numbers[middle..].iter().for_each(|number| outwards(&mut up, *number));
        numbers[..middle].iter().rev().for_each(|number| outwards(&mut down, *number));
        let chosen = down.into_iter().rev().chain([numbers[middle]]).chain(up);
        chosen.map(|value| Tick { value, label: angle_label(value) }).collect()
    }
}

/// An angle to a hundredth of a degree, without needless zeros.
fn angle_label(degrees: f64) -> String {
    let rounded = (degrees * 100.0).round() / 100.0;
    if rounded == 0.0 { "0".to_owned() } else { rounded.to_string().replacen('-', "\u{2212}", 1) }
}

/// Smallest and largest of the finite numbers.
pub(super) fn extent(values: impl IntoIterator<Item = f64>) -> Option<(f64, f64)> {
    values.into_iter().filter(|value| value.is_finite()).fold(None, |extent, value| {
        let (low, high) = extent.unwrap_or((value, value));
        Some((value.min(low), value.max(high)))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(scale: Scale) -> Vec<String> {
        scale.ticks(5).into_iter().map(|tick| tick.label).collect()
    }

    #[test]
    fn ticks_are_round_numbers_with_the_decimals_they_need() {
        assert_eq!(labels(Scale::Linear { from: 0.0, to: 1.0 }), ["0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(labels(Scale::Linear { from: -80.0, to: 80.0 }), ["\u{2212}50", "0", "50"]);
        assert_eq!(labels(Scale::Linear { from: 0.95, to: 1.05 }), ["0.96", "0.98", "1.00", "1.02", "1.04"]);
        assert_eq!(labels(Scale::Linear { from: 0.0, to: 5e-7 })[1], "1·10⁻⁷");
        assert_eq!(labels(Scale::Logarithmic { from: 0.15, to: 6.0 }), ["0.2", "0.5", "1", "2", "5"]);
    }

    #[test]
    fn a_scale_reaches_up_to_a_tick_of_its_own() {
        let scales = [
            (Scale::Logarithmic { from: 0.16, to: 4.4 }, "5"),
            (Scale::Logarithmic { from: 0.004, to: 3.9 }, "10"),
            (Scale::Logarithmic { from: 0.2, to: 5.0 }, "5"),
            (Scale::Linear { from: 0.0, to: 1.37 }, "1.5"),
            (Scale::Linear { from: 0.3, to: 3.3 }, "4"),
        ];
        for (scale, top) in scales {
            let reaching = scale.ending_on_tick(6);
            let ticks = reaching.ticks(6);
            let last = ticks.last().unwrap();
            assert_eq!(last.label, top, "{reaching:?}");
            assert!((reaching.position(last.value) - 1.0).abs() < 1e-9, "{reaching:?}");
        }
    }

    #[test]
    fn the_ends_of_a_colour_bar_are_named_where_no_tick_is_near() {
        let names = |scale: Scale| scale.ticks_with_ends(8).into_iter().map(|tick| tick.label).collect::<Vec<_>>();
        assert_eq!(names(Scale::Logarithmic { from: 0.19, to: 4.6 }), ["0.2", "0.5", "1", "2", "4.60"]);
        assert_eq!(names(Scale::Logarithmic { from: 0.19, to: 5.2 }), ["0.2", "0.5", "1", "2", "5"]);
        assert_eq!(names(Scale::Linear { from: -2.9, to: 2.9 }).len(), 7);
    }

    #[test]
    fn ticks_among_angles_are_measured_angles() {
        let names = |step: i32, count: i32| {
            let angles: Vec<f64> = (-count..=count).map(|k| f64::from(k * step)).collect();
            let end = f64::from(step) * (f64::from(count) + 0.5);
            let ticks = Scale::Linear { from: -end, to: end }.ticks_among(&angles, 12);
            ticks.into_iter().map(|tick| tick.value).collect::<Vec<_>>()
        };
        assert_eq!(names(15, 5), [-75.0, -60.0, -45.0, -30.0, -15.0, 0.0, 15.0, 30.0, 45.0, 60.0, 75.0]);
        assert_eq!(names(10, 8), [-80.0, -60.0, -40.0, -20.0, 0.0, 20.0, 40.0, 60.0, 80.0]);
        assert_eq!(Scale::Linear { from: 0.0, to: 1.0 }.ticks_among(&[], 12), []);
    }

    #[test]
    fn one_value_or_none_is_no_trouble() {
        assert_eq!(Scale::linear_over([f64::NAN]), None);
        assert_eq!(Scale::for_colours(&[]), None);
        let one = Scale::for_colours(&[0.0]).unwrap();
        assert!(one.position(0.0).is_finite() && !one.ticks(5).is_empty());
    }
}
