//! How closely a bound is looked at.

/// How closely a bound is looked at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Detail {
    /// Into about how many patches bodies are cut at most.
    pub(super) patches: usize,
    /// Orders whose colours are told apart at most.
    pub(super) ways: u32,
    /// Orders that are kept before the rest is bounded, at most; 0: all of them by their largest anywhere.
    pub(super) orders: usize,
    /// Factors times boxes of factors that are looked at in a region, at most, and in how many regions.
    pub(super) boxes: usize,
    pub(super) closer: usize,
    /// How often a patch is cut further at most, and how often any of them.
    pub(super) depth: u32,
    pub(super) splits: usize,
}

impl Detail {
    /// As closely as is of use.
    pub(super) const FULL: Self =
        Self { patches: usize::MAX, ways: 8, orders: 64, boxes: 6000, closer: usize::MAX, depth: 3, splits: 200 };

    /// For bounds that decide, of a picture of so many rays: they may take as long as a small picture does, and of a large one a part.
    pub(super) fn deciding(rays: f64) -> Self {
        let part = rays / 40.0;
        let times = |each: f64, least: usize, most: usize| ((part / each) as usize).clamp(least, most);
        Self {
            patches: ((part / 10.0).sqrt() as usize).max(120),
            ways: 4,
            orders: 16,
            boxes: 3000,
            closer: times(4000.0, 40, 400),
            depth: 3,
            splits: times(8000.0, 10, 200),
        }
    }

    /// For bounds that are only told, and must not take longer than a small part of a picture of so many rays.
    pub(super) fn telling(rays: f64, bodies: usize) -> Self {
        // A pair of patches takes as long as 10 rays in all, a factor of a box as long as 5.
        let part = rays / 800.0;
        let patches = (part / 10.0).sqrt() as usize;
        Self {
            patches,
            // Where not even the bodies can be told apart, how light goes from one to another is not asked.
            ways: u32::from(patches >= 4 * bodies),
            orders: 0,
            boxes: (part / 100.0).min(1000.0) as usize,
            closer: 2,
            depth: 0,
            splits: 0,
        }
    }
}
