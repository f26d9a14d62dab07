//! How closely a bound is looked at.

/// How closely a bound is looked at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Detail {
    /// Into about how many patches bodies are cut at most.
    pub(super) patches: usize,
    /// Orders whose colours are told apart at most.
    pub(super) ways: u32,
    /// Orders that are kept before the rest is bounded, at most.
    pub(super) orders: usize,
    /// Factors times boxes of factors that are looked at, at most.
    pub(super) boxes: usize,
    /// How often a patch is cut further at most, and how often any of them.
    pub(super) depth: u32,
    pub(super) splits: usize,
}

impl Detail {
    /// For bounds that decide.
    pub(super) const FULL: Self = Self { patches: usize::MAX, ways: 8, orders: 64, boxes: 6000, depth: 3, splits: 200 };

    /// For bounds that are only told, and must not take longer than a small part of a picture of so many rays. What takes long is
    /// looked at in this order: pairs of patches, and boxes of factors.
    pub(super) fn worth(rays: f64) -> Self {
        // A pair of patches takes as long as 10 rays in all, a factor of a box as long as 5, of which a bound takes about 50 times as
        // many as one look; each has a part in 400 of the picture.
        let part = rays / 400.0;
        Self {
            patches: (part / 10.0).sqrt() as usize,
            ways: 1,
            orders: 2,
            boxes: (part / 250.0) as usize,
            depth: 0,
            splits: 0,
        }
    }
}
