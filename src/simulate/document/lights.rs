//! What lights a scene, as it describes it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::description::one;
use super::place::{NotAScene, Places, Step};
use super::resolve::Resolver;
use crate::donaldson::Light;
use crate::quantity::QuantityKind;
use crate::simulate::source::{Place, Source};
use crate::simulate::vector::unit;

/// A light: one of `towards` (or `theta_deg` and `phi_deg`), `at` and `surround`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("oneOf" = [{"required": ["towards"]}, {"required": ["theta_deg"]}, {"required": ["at"]}, {"required": ["surround"]}]))]
pub struct LightSection {
    /// What warnings call it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// A light of the CIE (`D65`, `A`, `FL2`, ...), a text of two columns (nm, value) or another spectrum that `bbrf import` reads,
    /// `FILE.bbrf#ID`: the irradiance on a plane across the beam; from all around, on a plane that nothing stands before.
    pub spectrum: String,
    /// What the spectrum is multiplied with.
    #[serde(default = "one")]
    pub strength: f64,
    /// Parallel light: the direction to where it comes from.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub towards: Option<[f64; 3]>,
    /// The same by angles: from the z axis, degrees from 0 to 180.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub theta_deg: Option<f64>,
    /// Around the z axis, from x towards y, degrees; 0 where it is not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub phi_deg: Option<f64>,
    /// A point that shines into all directions alike: where it is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at: Option<[f64; 3]>,
    /// The distance from the point at which the irradiance is that of the spectrum, above 0; 1 where it is not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reference_distance: Option<f64>,
    /// True for light from all around, of one radiance.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub surround: bool,
}

impl LightSection {
    pub(super) fn resolve(self, at: Step<'_>, name: String, with: &mut Resolver<'_, '_>) -> Result<Source, NotAScene> {
        let way = [Step::Key("light"), at];
        let given = [self.towards.is_some(), self.theta_deg.is_some(), self.at.is_some(), self.surround];
        with.one_of(&way, given, "`towards`, `theta_deg`, `at` and `surround = true`")?;
        if self.phi_deg.is_some() && self.theta_deg.is_none() {
            return Err(with.error(&way, "phi_deg", "found without `theta_deg`; expected both or neither"));
        }
        if self.reference_distance.is_some() && self.at.is_none() {
            return Err(with.error(
                &way,
                "reference_distance",
                "found without `at`; expected it for a point light only",
            ));
        }
        let place = if let Some(towards) = self.towards {
            Place::Directional(with.direction(&way, "towards", towards)?)
        } else if let Some(theta) = self.theta_deg {
            if !(0.0..=180.0).contains(&theta) {
                return Err(with.error(&way, "theta_deg", format!("found {theta}; expected degrees from 0 to 180")));
            }
            let (theta, phi) = (theta.to_radians(), self.phi_deg.unwrap_or(0.0).to_radians());
            let towards = [theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()];
            Place::Directional(unit(towards).unwrap_or([0.0, 0.0, 1.0]))
        } else if let Some(place) = self.at {
            let distance = self.reference_distance.unwrap_or(1.0);
            Place::Point(place, with.above_0(&way, "reference_distance", distance)?)
        } else {
            Place::Surround
        };
        let strength = with.above_0(&way, "strength", self.strength)?;
        let light = with.library.light(&self.spectrum).map_err(|why| with.error(&way, "spectrum", why))?;
        let light = with.said(&format!("light `{name}`"), light);
        with.note_negative(&format!("light `{name}`"), light.values());
        let light = if strength == 1.0 { light } else { light.scaled(strength) };
        Ok(Source { name, light, place })
    }
}

/// Numbers of different units have no sum: where lights differ, their author says by `strength` what one is beside the other. A 1
/// that is written is such a word, one that is left out is none. The lights of the CIE share a unit, of which a lamp in counts knows
/// nothing.
pub(super) fn check_units(sources: &[Source], spectra: &[String], places: &Places<'_>) -> Result<(), NotAScene> {
    let unwritten = |k: &usize| !places.is_written(&[Step::Key("light"), Step::Item(*k), Step::Key("strength")]);
    let mut loose = (0..sources.len()).filter(unwritten);
    let Some(first) = loose.next() else { return Ok(()) };
    let unit = |k: usize| match sources[k].light.kind() {
        QuantityKind::RelativeSpectrum if Light::named(&spectra[k]).is_some() => "the relative unit of the CIE",
        QuantityKind::RelativeSpectrum => "a relative unit of its own",
        QuantityKind::Unstated => "a unit that is not stated",
        kind => kind.unit(),
    };
    let Some(other) = loose.find(|k| unit(*k) != unit(first)) else { return Ok(()) };
    let problem = format!(
        "found a light in {}, and light `{}` in {}; expected one unit, or a `strength` beside one of them that brings both together \
         (1 if they are so already)",
        unit(other),
        sources[first].name,
        unit(first)
    );
    Err(places.error(&[Step::Key("light"), Step::Item(other), Step::Key("spectrum")], problem))
}
