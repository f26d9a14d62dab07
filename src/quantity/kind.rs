//! The type of a measured quantity, with everything that is needed to know what its numbers mean.

use std::fmt;
use std::str::FromStr;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A name that the standard does not define.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("unknown {what} `{found}`; expected one of: {expected}")]
pub struct UnknownName {
    /// What was being read.
    pub what: &'static str,
    /// What was found.
    pub found: String,
    /// What is allowed.
    pub expected: String,
}

/// A closed list of names: one table gives the spelling in files, in messages and in `FromStr`.
macro_rules! named {
    ($(#[$meta:meta])* $name:ident, $what:literal { $($(#[$variant_meta:meta])* $variant:ident = $text:literal,)+ }) => {
        $(#[$meta])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
        pub enum $name { $($(#[$variant_meta])* #[serde(rename = $text)] $variant,)+ }

        impl $name {
            /// Every member, in the order of the standard.
            pub const ALL: &'static [Self] = &[$(Self::$variant,)+];

            /// The name in files, CSV, JSON and messages.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self { $(Self::$variant => $text,)+ }
            }
        }

        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.pad(self.name())
            }
        }

        impl std::str::FromStr for $name {
            type Err = $crate::quantity::UnknownName;

            fn from_str(text: &str) -> Result<Self, $crate::quantity::UnknownName> {
                Self::ALL.iter().copied().find(|member| member.name() == text).ok_or_else(|| $crate::quantity::UnknownName {
                    what: $what,
                    found: text.to_owned(),
                    expected: [$($text,)+].join(", "),
                })
            }
        }
    };
}
pub(crate) use named;

named! {
    /// What a number is.
    QuantityKind, "quantity" {
        /// Radiance per wavelength.
        SpectralRadiance = "spectral-radiance",
        /// Irradiance per wavelength.
        SpectralIrradiance = "spectral-irradiance",
        /// Radiance summed over a band.
        BandRadiance = "band-radiance",
        /// Radiance weighted with V(lambda) and 683 lm/W.
        Luminance = "luminance",
        /// A spectrum known up to a factor.
        RelativeSpectrum = "relative-spectrum",
        /// Ratio to the perfect diffuser at the emission wavelength.
        RadianceFactor = "radiance-factor",
        /// The same after V(lambda): ratio of sums.
        LuminanceFactor = "luminance-factor",
        /// The same over a band: ratio of sums.
        BandRadianceFactor = "band-radiance-factor",
        /// Density S_l(em, ex), normalised at the excitation wavelength.
        BispectralLuminescentRadianceFactor = "bispectral-luminescent-radiance-factor",
        /// Reflected radiance factor on the diagonal, S_l times an emission width elsewhere.
        DonaldsonMatrix = "donaldson-matrix",
        /// Bidirectional reflectance distribution function.
        Brdf = "brdf",
        /// Bispectral bidirectional reflectance and reradiation distribution function.
        Brrdf = "brrdf",
        /// The source does not say.
        Unstated = "unstated",
    }
}

impl QuantityKind {
    /// The unit in the form that CF and UDUNITS read; `unstated` where the quantity is.
    #[must_use]
    pub const fn unit(self) -> &'static str {
        match self {
            Self::SpectralRadiance => "W m-2 sr-1 nm-1",
            Self::SpectralIrradiance => "W m-2 nm-1",
            Self::BandRadiance => "W m-2 sr-1",
            Self::Luminance => "cd m-2",
            Self::RelativeSpectrum
            | Self::RadianceFactor
            | Self::LuminanceFactor
            | Self::BandRadianceFactor
            | Self::DonaldsonMatrix => "1",
            Self::BispectralLuminescentRadianceFactor => "nm-1",
            Self::Brdf => "sr-1",
            Self::Brrdf => "sr-1 nm-1",
            Self::Unstated => "unstated",
        }
    }

    /// True for a ratio to a reference diffuser, whose meaning depends on the reference.
    #[must_use]
    pub const fn is_factor(self) -> bool {
        matches!(self, Self::RadianceFactor | Self::LuminanceFactor | Self::BandRadianceFactor)
    }
}

named! {
    /// Which part of the radiated light a quantity holds.
    Part, "part" {
        /// Reflected at the wavelength of incidence.
        Elastic = "elastic",
        /// Emitted at another wavelength.
        Luminescent = "luminescent",
        /// Both, not separated.
        Total = "total",
        /// The source does not say.
        Unstated = "unstated",
    }
}

named! {
    /// The wavelength at which a ratio is normalised.
    NormalisedAt, "normalised-at" {
        /// At the emission wavelength.
        Emission = "emission",
        /// At the excitation wavelength.
        Excitation = "excitation",
        /// Not a ratio.
        None = "none",
        /// The source does not say.
        Unstated = "unstated",
    }
}

named! {
    /// What is counted.
    Basis, "basis" {
        /// Energy.
        Energy = "energy",
        /// Photons.
        Photon = "photon",
        /// The source does not say.
        Unstated = "unstated",
    }
}

/// A text form that is also the JSON form.
macro_rules! as_text {
    ($name:ident) => {
        impl From<$name> for String {
            fn from(value: $name) -> Self {
                value.to_string()
            }
        }

        impl TryFrom<String> for $name {
            type Error = UnknownName;

            fn try_from(text: String) -> Result<Self, UnknownName> {
                text.parse()
            }
        }
    };
}

/// In which geometry the reference diffuser was measured.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(into = "String", try_from = "String")]
#[schemars(with = "String")]
pub enum Reference {
    /// In the geometry of each sample value: a Lambertian factor is a constant.
    SameGeometry,
    /// In one geometry: a Lambertian factor follows cos(theta_i).
    FixedGeometry {
        /// Polar angle of incidence at the reference, degrees.
        theta_i_deg: f64,
        /// Polar angle of viewing at the reference, degrees.
        theta_v_deg: f64,
    },
    /// No reference: radiance.
    None,
    /// The source does not say.
    Unstated,
}

impl fmt::Display for Reference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::SameGeometry => f.write_str("same-geometry"),
            Self::FixedGeometry { theta_i_deg, theta_v_deg } => {
                write!(f, "fixed-geometry({theta_i_deg},{theta_v_deg})")
            }
            Self::None => f.write_str("none"),
            Self::Unstated => f.write_str("unstated"),
        }
    }
}

impl FromStr for Reference {
    type Err = UnknownName;

    fn from_str(text: &str) -> Result<Self, UnknownName> {
        let unknown = || UnknownName {
            what: "reference",
            found: text.to_owned(),
            expected: "same-geometry, fixed-geometry(theta_i,theta_v) in degrees from -90 to 90, none, unstated"
                .to_owned(),
        };
        match text {
            "same-geometry" => Ok(Self::SameGeometry),
            "none" => Ok(Self::None),
            "unstated" => Ok(Self::Unstated),
            _ => {
                let inner = text.strip_prefix("fixed-geometry(").and_then(|rest| rest.strip_suffix(')'));
                let (first, second) = inner.and_then(|inner| inner.split_once(',')).ok_or_else(unknown)?;
                let angle = |text: &str| {
                    text.trim().parse::<f64>().ok().filter(|angle| (-90.0..=90.0).contains(angle)).ok_or_else(unknown)
                };
                Ok(Self::FixedGeometry { theta_i_deg: angle(first)?, theta_v_deg: angle(second)? })
            }
        }
    }
}
as_text!(Reference);

/// Under which light the reference was measured.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(into = "String", try_from = "String")]
#[schemars(with = "String")]
pub enum ReferenceLight {
    /// Under the light that the sample was measured under.
    Same,
    /// Under a light of the file, by its id.
    Light(String),
    /// The source does not say.
    Unstated,
}

impl fmt::Display for ReferenceLight {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Same => f.write_str("same"),
            Self::Light(id) => f.write_str(id),
            Self::Unstated => f.write_str("unstated"),
        }
    }
}

impl FromStr for ReferenceLight {
    type Err = UnknownName;

    fn from_str(text: &str) -> Result<Self, UnknownName> {
        match text {
            "same" => Ok(Self::Same),
            "unstated" => Ok(Self::Unstated),
            "" => Err(UnknownName {
                what: "reference-light",
                found: String::new(),
                expected: "same, unstated, or the id of a light in the file".to_owned(),
            }),
            id => Ok(Self::Light(id.to_owned())),
        }
    }
}
as_text!(ReferenceLight);

/// A typed quantity: what the numbers of a measurement mean.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub struct Quantity {
    /// What a number is; gives the unit.
    #[serde(rename = "quantity")]
    pub kind: QuantityKind,
    /// Which part of the radiated light.
    pub part: Part,
    /// The wavelength at which a ratio is normalised.
    pub normalised_at: NormalisedAt,
    /// Energy or photons.
    pub basis: Basis,
    /// In which geometry the reference was measured.
    pub reference: Reference,
    /// Under which light the reference was measured.
    pub reference_light: ReferenceLight,
    /// Certified radiance factor of the reference, dimensionless: none, one number, or one per emission wavelength.
    /// The values are already multiplied by it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub certified_factor: Vec<f64>,
}

impl Quantity {
    /// A quantity that is not a ratio to a reference: radiance, irradiance.
    #[must_use]
    pub fn absolute(kind: QuantityKind, part: Part) -> Self {
        Self {
            kind,
            part,
            normalised_at: NormalisedAt::None,
            basis: Basis::Energy,
            reference: Reference::None,
            reference_light: ReferenceLight::Same,
            certified_factor: Vec::new(),
        }
    }

    /// A quantity of which only the kind is known.
    #[must_use]
    pub fn unstated(kind: QuantityKind) -> Self {
        Self {
            kind,
            part: Part::Unstated,
            normalised_at: NormalisedAt::Unstated,
            basis: Basis::Unstated,
            reference: Reference::Unstated,
            reference_light: ReferenceLight::Unstated,
            certified_factor: Vec::new(),
        }
    }

    /// The names of the fields that the source did not state.
    #[must_use]
    pub fn unstated_fields(&self) -> Vec<&'static str> {
        [
            ("quantity", self.kind == QuantityKind::Unstated),
            ("part", self.part == Part::Unstated),
            ("normalised-at", self.normalised_at == NormalisedAt::Unstated),
            ("basis", self.basis == Basis::Unstated),
            ("reference", self.reference == Reference::Unstated),
            ("reference-light", self.reference_light == ReferenceLight::Unstated),
        ]
        .into_iter()
        .filter_map(|(name, unstated)| unstated.then_some(name))
        .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_reads_back() {
        for kind in QuantityKind::ALL {
            assert_eq!(kind.name().parse::<QuantityKind>().as_ref(), Ok(kind));
            assert_eq!(serde_json::to_string(kind).unwrap(), format!("\"{kind}\""));
        }
        let reference = Reference::FixedGeometry { theta_i_deg: 0.5, theta_v_deg: -45.0 };
        assert_eq!(reference.to_string(), "fixed-geometry(0.5,-45)");
        assert_eq!(reference.to_string().parse(), Ok(reference));
    }

    #[test]
    fn an_unknown_name_says_what_is_allowed() {
        let error = "reflectance".parse::<QuantityKind>().unwrap_err();
        assert!(error.to_string().contains("radiance-factor"), "{error}");
        assert!("fixed-geometry(0)".parse::<Reference>().is_err());
        assert!("fixed-geometry(0,95)".parse::<Reference>().is_err());
    }
}
