//! The list of rules.

use super::Context;
use super::finding::{Finder, Severity};
use super::rules::{bytes, digest, flags, geometry, model, quantity, reference, structure, uncertainty, wavelength};

/// A rule.
#[derive(Debug)]
pub struct Rule {
    /// Stable id, `bbrf:VERSION:GROUP.NAME`.
    pub id: &'static str,
    /// Short alias.
    pub alias: &'static str,
    /// How grave a finding is, unless the caller grades it otherwise.
    pub severity: Severity,
    /// Why the rule is there.
    pub rationale: &'static str,
    /// An example of a violation.
    pub example: &'static str,
    /// What to do about it.
    pub repair: &'static str,
    /// The check.
    pub check: fn(&Context<'_>, &mut Finder),
}

impl Rule {
    /// Collects what this rule finds.
    pub(super) fn finder(&'static self) -> Finder {
        Finder::new(self)
    }
}

/// The rule of an id, an id without its version prefix, or an alias.
#[must_use]
pub fn rule(name: &str) -> Option<&'static Rule> {
    RULES.iter().find(|rule| {
        rule.id == name || rule.alias.eq_ignore_ascii_case(name) || rule.id.rsplit(':').next() == Some(name)
    })
}

use Severity::{Error, Info, Warning};

macro_rules! rules {
    ($($alias:literal $id:literal $severity:ident $check:expr, $rationale:literal, $example:literal, $repair:literal;)+) => {
        /// Every rule, in the order in which findings are listed.
        pub static RULES: &[Rule] = &[$(Rule {
            id: concat!("bbrf:1.0:", $id),
            alias: $alias,
            severity: $severity,
            rationale: $rationale,
            example: $example,
            repair: $repair,
            check: $check,
        },)+];
    };
}

#[rustfmt::skip]
rules! {
    "BB0001" "structure.hdf5" Error structure::hdf5,
        "Only an undamaged HDF5 file can be trusted in any part.", "a file that was cut short",
        "Fetch the file again, or restore it from a copy.";
    "BB0002" "structure.version-stated" Error structure::version_stated,
        "A reader must know which version of the standard it reads.", "an HDF5 file without `bbrf_version`",
        "State `bbrf_version` on the root group, or use a file of this standard.";
    "BB0003" "structure.major-version" Error structure::major_version,
        "Another major version may give the same names other meanings.", "`bbrf_version` = 2.0",
        "Use a bbrf that knows this version.";
    "BB0004" "structure.minor-version" Warning structure::minor_version,
        "A later minor version may hold content that this program does not check.", "`bbrf_version` = 1.7",
        "Use a newer bbrf to check everything.";
    "BB0005" "structure.conventions" Warning structure::conventions,
        "Other programs recognise the standard by `Conventions`.", "`Conventions` = CF-1.11",
        "Set `Conventions` on the root group.";
    "BB0006" "structure.complete" Error structure::complete,
        "What the standard requires must be there.", "a measurement without `value_flag`",
        "Add what is missing, or write the file again from its source.";
    "BB0007" "structure.readable" Error structure::readable,
        "Every name has one type and form.", "`role` = specimen",
        "Store it as the table of the standard has it.";
    "BB0008" "structure.shapes" Error structure::shapes,
        "Values, uncertainties and flags have a row for each acquisition and a column for each emission value.",
        "272 acquisitions and a `value` of 271 rows", "Write the arrays again with one shape.";
    "BB0009" "structure.attributes" Error structure::attributes,
        "Attributes that follow from the rest of the file (flag meanings, coordinates) must agree with it.",
        "`flag_meanings` in another order than the bits", "Write the file again with the attributes of the standard.";
    "BB0010" "structure.unknown" Info structure::unknown,
        "Content that the standard does not know is kept but not checked.", "a dataset `temperature`",
        "Nothing, if it is meant to be there.";
    "BB0011" "structure.bytes" Error bytes::written,
        "Damage between the values, in what HDF5 finds them by, may be seen by another HDF5 library only.",
        "one changed bit in the index of the chunks of `value`",
        "Fetch the file again, or restore it from a copy; writing this document again also mends it.";

    "BB0101" "digest.object" Error digest::object,
        "A digest that disagrees means damage or a change by hand.", "one changed bit in `value`",
        "Fetch the file again; if the change is meant, write the file again with its digests.";
    "BB0102" "digest.document" Error digest::document,
        "The digest of the document identifies its content.", "a measurement that was taken out",
        "Fetch the file again; if the change is meant, write the file again with its digests.";
    "BB0103" "digest.missing" Error digest::missing,
        "Without a digest damage cannot be seen.", "a dataset without `sha256`",
        "Write the file again with its digests.";

    "BB0201" "quantity.units" Error quantity::units,
        "The quantity gives the unit; a second, other statement makes both doubtful.",
        "a radiance factor in W m-2 sr-1 nm-1", "Find out which of the two is right, and state that.";
    "BB0202" "quantity.other-units" Error quantity::other_units,
        "Coordinates and uncertainties have fixed units.", "`theta_i` in radians",
        "Convert to the unit of the standard.";
    "BB0203" "quantity.unstated" Warning quantity::unstated,
        "A field that is unstated leaves room for two readings of the same number.", "`reference` = unstated",
        "Ask whoever measured, and state it.";
    "BB0204" "quantity.certified-factor" Error quantity::certified_factor,
        "The certified factor is one number, or one for each emission value.", "3 factors on 101 wavelengths",
        "Interpolate the certificate to the emission axis, or give one number.";

    "BB0301" "wavelength.positive" Error wavelength::positive,
        "A wavelength is a positive number.", "0 nm", "Correct the axis.";
    "BB0302" "wavelength.ascending" Error wavelength::ascending,
        "Interpolation and integration need an ascending axis.", "380, 388, 384 nm", "Sort the axis and the values with it.";
    "BB0303" "wavelength.bandpass-length" Error wavelength::bandpass_length,
        "The bandpass is one number, or one for each wavelength.", "2 widths on 101 wavelengths", "Give one, or all.";
    "BB0304" "wavelength.bandpass-unstated" Warning wavelength::bandpass_unstated,
        "Bandpass and step are different numbers; without the bandpass densities cannot be compared.",
        "no `wavelength_emission_fwhm`", "State the bandpass from the data sheet of the instrument.";

    "BB0401" "geometry.polar-range" Error geometry::polar_range,
        "Measured directions lie above the surface.", "theta_v = -45 degrees",
        "Convert signed angles to a polar angle and an azimuth.";
    "BB0402" "geometry.azimuth-range" Error geometry::azimuth_range,
        "One direction has one azimuth.", "phi_v = 360 degrees", "Reduce the azimuth to 0 up to 360 degrees.";
    "BB0403" "geometry.unknown" Warning geometry::unknown,
        "A value without its geometry can neither be fitted nor compared.", "a spectrum without angles",
        "State the geometry of each row.";
    "BB0404" "geometry.retro" Warning geometry::retro,
        "In the retro direction the detector would stand before the source.", "a value at theta_v = -theta_i",
        "Check the sign convention of the angles; flag the gap as not measured by design.";

    "BB0501" "flag.unknown-bits" Warning flags::unknown_bits,
        "A bit without a meaning cannot be acted upon.", "flag 0x8000", "Use the bits in `flag_masks`.";
    "BB0502" "flag.nan-without-reason" Error flags::nan_without_reason,
        "Missing is never one NaN: it says why.", "NaN with flag 0",
        "Set the flag: not measured, by design, invalid, below detection or saturated.";
    "BB0503" "flag.infinite" Error flags::infinite,
        "No instrument measures infinity; it is the trace of a division by zero.", "inf where the white reference is dark",
        "Replace it by NaN with its reason.";
    "BB0504" "flag.value-not-measured" Warning flags::value_not_measured,
        "A value and the statement that there is none exclude each other.", "0.31 with not-measured-by-design",
        "Store NaN, or flag the value as interpolated.";

    "BB0601" "uncertainty.missing" Warning uncertainty::missing,
        "A value without uncertainty can neither be weighted nor judged.", "no `value_u`",
        "Repeat readings, or take the uncertainty from the data sheet.";
    "BB0602" "uncertainty.negative" Error uncertainty::negative,
        "A standard uncertainty is a width.", "-0.01", "Correct it; use NaN where it is unknown.";
    "BB0603" "uncertainty.shared" Error uncertainty::shared,
        "A shared component is one relative width, or one for each emission value.", "2 numbers on 101 wavelengths",
        "Give one, or all, of zero or more.";

    "BB0701" "reference.dangling" Error reference::dangling,
        "What is referred to must be in the file.", "a measurement of sample `a` in a file without it",
        "Add the part, or remove the reference.";
    "BB0702" "reference.light" Error reference::light,
        "The light of the reference is named to be looked up.", "`reference_light` = d65, and no such light",
        "Add the light, or state `same` or `unstated`.";
    "BB0703" "reference.excitation" Error reference::excitation,
        "Rows refer to excitation states by their index.", "index 3 of 2 states", "Correct the index.";

    "BB0801" "model.data-changed" Warning model::data_changed,
        "A fit describes the data it was made of.", "a measurement edited after the fit", "Fit again.";
    "BB0802" "model.covariance-symmetric" Error model::covariance_symmetric,
        "A covariance is symmetric.", "cov[0,1] = 1e-5, cov[1,0] = 2e-5", "Fit again, or store the whole matrix.";
    "BB0803" "model.covariance-diagonal" Error model::covariance_diagonal,
        "A variance is not negative.", "cov[0,0] = -1e-6", "Fit again.";
    "BB0804" "model.covariance-parameters" Error model::covariance_parameters,
        "Each row of the covariance belongs to a named parameter.", "4 names for 3 rows", "Name every row.";
    "BB0805" "model.parameter-bounds" Error model::parameter_bounds,
        "Outside its bounds a parameter has no meaning.", "roughness = -0.05", "Fit again within the bounds.";
    "BB0806" "model.not-converged" Warning model::not_converged,
        "A fit that did not converge is no minimum.", "`converged` = 0", "Fit again, or leave the model out.";
}
