//! Why a value is missing or may not be used: a bit mask per value, spelled as CF flags on disk.

use serde::{Deserialize, Serialize};

/// One reason. The first six are the reasons for a missing or unusable value; the others are kept with the value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Flag {
    /// Left out by design: the retro gap, where the detector would stand before the source.
    NotMeasuredByDesign,
    /// Planned, but no record was found.
    NotMeasured,
    /// Measured, and the instrument or the importer refused it.
    Invalid,
    /// On the instrument's floor: an upper bound, not a value.
    BelowDetection,
    /// The detector was overloaded: a lower bound, not a value.
    Saturated,
    /// Drawn between measured values; never fitted.
    Interpolated,
    /// The instrument reported a low light level.
    LowLight,
    /// The instrument reported noise.
    Noisy,
    /// The instrument reported a low battery.
    BatteryLow,
    /// Identical to the spectrum before it: the instrument may have repeated an old buffer.
    StaleBuffer,
}

impl Flag {
    /// All flags, in the order of their bits.
    pub const ALL: [Self; 10] = [
        Self::NotMeasuredByDesign,
        Self::NotMeasured,
        Self::Invalid,
        Self::BelowDetection,
        Self::Saturated,
        Self::Interpolated,
        Self::LowLight,
        Self::Noisy,
        Self::BatteryLow,
        Self::StaleBuffer,
    ];

    /// The bit of this flag.
    #[must_use]
    pub const fn bit(self) -> u16 {
        1 << (self as u16)
    }

    /// The name in files (`flag_meanings`), CSV and messages.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::NotMeasuredByDesign => "not-measured-by-design",
            Self::NotMeasured => "not-measured",
            Self::Invalid => "invalid",
            Self::BelowDetection => "below-detection",
            Self::Saturated => "saturated",
            Self::Interpolated => "interpolated",
            Self::LowLight => "low-light",
            Self::Noisy => "noisy",
            Self::BatteryLow => "battery-low",
            Self::StaleBuffer => "stale-buffer",
        }
    }

    /// The flag of that name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|flag| flag.name() == name)
    }

    /// True where a value with this flag must not enter a fit as a value.
    #[must_use]
    pub const fn excludes_from_fit(self) -> bool {
        !matches!(self, Self::LowLight | Self::Noisy | Self::BatteryLow)
    }

    /// True where this flag explains a value that is not there (NaN).
    #[must_use]
    pub const fn explains_absence(self) -> bool {
        (self as u16) <= (Self::Saturated as u16)
    }
}

/// The set of flags of one value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(transparent)]
pub struct Flags(pub u16);

impl Flags {
    /// No flag: an ordinary value.
    pub const NONE: Self = Self(0);

    /// The set with one flag more.
    #[must_use]
    pub const fn with(self, flag: Flag) -> Self {
        Self(self.0 | flag.bit())
    }

    /// The flags of either set.
    #[must_use]
    pub const fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// True where the set has this flag.
    #[must_use]
    pub const fn contains(self, flag: Flag) -> bool {
        self.0 & flag.bit() != 0
    }

    /// The flags in the order of their bits; bits that the standard does not know are passed over.
    pub fn iter(self) -> impl Iterator<Item = Flag> {
        Flag::ALL.into_iter().filter(move |flag| self.contains(*flag))
    }

    /// True where none of the flags keeps the value out of a fit.
    #[must_use]
    pub fn may_be_fitted(self) -> bool {
        self.iter().all(|flag| !flag.excludes_from_fit())
    }

    /// True where a flag says why there is no value.
    #[must_use]
    pub fn explains_absence(self) -> bool {
        // The reasons are the lowest bits.
        self.0 & ((Flag::Saturated.bit() << 1) - 1) != 0
    }

    /// Bits that the standard does not define.
    #[must_use]
    pub fn unknown_bits(self) -> u16 {
        self.0 & !Flag::ALL.iter().fold(0, |mask, flag| mask | flag.bit())
    }
}
