//! The list of rules.

use super::Context;
use super::finding::{Finder, Severity};
use super::rules::{
    acquisition, albedo, bytes, calibration, digest, factorisation, flags, geometry, light, model, physics,
    portability, provenance, quantity, reference, structure, uncertainty, wavelength,
};

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

/// The clauses of the specification, by the group of their rules: number, group and title.
pub const CLAUSES: &[(u8, &str, &str)] = &[
    (1, "structure", "The file and its parts"),
    (2, "digest", "Digests"),
    (3, "quantity", "Quantities and units"),
    (4, "wavelength", "Wavelengths and bandpass"),
    (5, "geometry", "Directions"),
    (6, "flag", "Missing values"),
    (7, "uncertainty", "Uncertainty"),
    (8, "reference", "References between parts"),
    (9, "model", "Fitted models"),
    (10, "calibration", "Calibration"),
    (11, "acquisition", "Acquisitions"),
    (12, "physics", "What nature does"),
    (13, "portability", "Encoding"),
    (14, "provenance", "Provenance"),
    (15, "light", "Lights"),
    (16, "factorisation", "Factors of matrices"),
];

impl Rule {
    /// The name without the version, `GROUP.NAME`.
    #[must_use]
    pub fn name(&self) -> &'static str {
        self.id.rsplit(':').next().unwrap_or_default()
    }

    /// The group of the rule: the part of its name before the point.
    #[must_use]
    pub fn group(&self) -> &'static str {
        self.name().split('.').next().unwrap_or_default()
    }

    /// The clause of the specification that the rule checks.
    #[must_use]
    pub fn clause(&self) -> u8 {
        CLAUSES.iter().find(|(_, group, _)| *group == self.group()).map_or(0, |clause| clause.0)
    }

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
    "BB0012" "structure.extension-domain" Warning provenance::extension_domain,
        "Names of laboratories collide; names of their domains do not.",
        "`/extension/goniometer`", "Name the group by the reverse domain name of whoever defines it.";
    "BB0013" "structure.description" Info structure::description,
        "No digest covers a description: another sentence may be a better one, or damage.", "`long_name` = azimu",
        "Compare it with a copy of the file.";

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
    "BB0205" "quantity.si-unit" Error quantity::si_unit,
        "Programs take the unit from the numbers, people from the text; both must be one unit.",
        "W m-2 sr-1 nm-1 with a factor of 1", "Write the factor and the exponents of the table of quantities.";
    "BB0206" "quantity.part-of-kind" Error quantity::part_of_kind,
        "A density over emission wavelengths cannot hold the elastic line; that is so for a brrdf, too.",
        "a bispectral luminescent radiance factor of part `total`", "Keep the elastic part in a measurement of its own.";
    "BB0207" "quantity.normalised-at-of-kind" Error quantity::normalised_at_of_kind,
        "Each ratio is defined at one of the two wavelengths.",
        "a radiance factor normalised at the excitation", "State the wavelength that the quantity is defined at, or correct the quantity.";
    "BB0208" "quantity.reference-of-kind" Error quantity::reference_of_kind,
        "A factor is relative to a reference, a radiance and a distribution function are not.",
        "a radiance factor with `reference` = none", "State the geometry of the reference, or correct the quantity.";
    "BB0209" "quantity.certified-factor-range" Error quantity::certified_factor_range,
        "A factor outside is a percentage, or another quantity.",
        "99 instead of 0.99", "Give the factor as a number of about 1.";
    "BB0210" "quantity.donaldson-width" Error quantity::donaldson_width,
        "Off the diagonal a Donaldson matrix contains the emission width of each wavelength, which a band has not.",
        "a matrix with one value for 500 to 620 nm", "Store the values of the wavelengths, or a factor of the band.";

    "BB0301" "wavelength.positive" Error wavelength::positive,
        "A wavelength is a positive number.", "0 nm", "Correct the axis.";
    "BB0302" "wavelength.ascending" Error wavelength::ascending,
        "Interpolation and integration need an ascending axis.", "380, 388, 384 nm", "Sort the axis and the values with it.";
    "BB0303" "wavelength.bandpass-length" Error wavelength::bandpass_length,
        "The bandpass is one number, or one for each wavelength.", "2 widths on 101 wavelengths", "Give one, or all.";
    "BB0304" "wavelength.bandpass-unstated" Warning wavelength::bandpass_unstated,
        "Bandpass and step are different numbers; without the bandpass densities cannot be compared.",
        "no `wavelength_emission_fwhm`", "State the bandpass from the data sheet of the instrument.";
    "BB0305" "wavelength.bandpass-positive" Error wavelength::bandpass_positive,
        "A width is a positive number.",
        "0 nm", "Correct it; leave it out where it is unknown.";
    "BB0306" "wavelength.bandpass-particulars" Info wavelength::bandpass_particulars,
        "Shape and correction of the bandpass decide what a narrow peak means.",
        "`bandpass_correction` = unstated", "State both from the data sheet and the software of the instrument.";
    "BB0307" "wavelength.actual-length" Error wavelength::actual_length,
        "Each nominal wavelength has one actual one.",
        "100 on 101 wavelengths", "Give all, or none.";
    "BB0308" "wavelength.actual-near" Warning wavelength::actual_near,
        "A calibrated centre further off than the next wavelength belongs to that one.",
        "500 nm nominal, 508 nm actual, steps of 4 nm", "Check the calibration and the order of the list.";
    "BB0309" "wavelength.range" Warning wavelength::range,
        "Wavelengths in another unit pass every other check.",
        "0.38 to 0.78", "Convert to nm.";
    "BB0310" "wavelength.band-order" Error wavelength::band_order,
        "A band begins before it ends.",
        "620 to 500 nm", "Exchange the ends.";
    "BB0311" "wavelength.excitation" Error wavelength::excitation,
        "A wavelength and a width are positive numbers.",
        "an excitation of 0 nm", "Correct it; leave it out where it is unknown.";
    "BB0312" "wavelength.excitation-bandpass" Warning wavelength::excitation_bandpass,
        "Without its width an excitation cannot be told from the emission next to it.",
        "365 nm without `excitation_fwhm`", "State the width from the monochromator or the filter.";

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
    "BB0405" "geometry.self-test" Error geometry::self_test,
        "Angles and vectors that disagree show a frame that is turned, mirrored or counted from elsewhere.",
        "an azimuth that turns clockwise", "Find out which frame the angles have, and convert them.";
    "BB0406" "geometry.self-test-row" Error geometry::self_test_row,
        "A self-test vector belongs to a row.",
        "row 300 of 272", "Correct the row.";
    "BB0407" "geometry.self-test-missing" Warning geometry::self_test_missing,
        "Only a second statement of some directions shows a mistaken convention.",
        "no `direction_test_row`", "State the unit vectors of some rows, from where the angles come from.";
    "BB0408" "geometry.grazing" Warning geometry::grazing,
        "At 90 degrees there is neither light on the surface nor surface to see.",
        "a value at theta_i = 90 degrees", "Check the angles; flag the value as not measured.";
    "BB0409" "geometry.footprint" Warning geometry::footprint,
        "The footprint grows as 1/cos(theta_v); beyond the sample the instrument sees its holder.",
        "a spot of 4.2 mm at 80 degrees on a sample of 20 mm", "Leave those rows out, or flag them as invalid.";

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

    "BB0505" "flag.no-value" Warning flags::no_value,
        "A measurement without one usable value says nothing; often its roles or its reference are exchanged.",
        "white and dark exchanged, so that every quotient is missing", "Check which file has which role, and import again.";

    "BB0601" "uncertainty.missing" Warning uncertainty::missing,
        "A value without uncertainty can neither be weighted nor judged.", "no `value_u`",
        "Repeat readings, or take the uncertainty from the data sheet.";
    "BB0602" "uncertainty.negative" Error uncertainty::negative,
        "A standard uncertainty is a width.", "-0.01", "Correct it; use NaN where it is unknown.";
    "BB0603" "uncertainty.shared" Error uncertainty::shared,
        "A shared component is one relative width, or one for each emission value.", "2 numbers on 101 wavelengths",
        "Give one, or all, of zero or more.";
    "BB0604" "uncertainty.coverage" Error uncertainty::coverage,
        "Coverage factor and degrees of freedom are positive, a probability is between 0 and 1.",
        "`coverage_probability` = 95", "Give a probability as 0.95.";
    "BB0605" "uncertainty.student" Warning uncertainty::student,
        "A t distribution is none without its degrees of freedom.",
        "`distribution` = student-t alone", "State the degrees of freedom: readings minus one.";
    "BB0606" "uncertainty.expanded" Warning uncertainty::expanded,
        "A coverage probability without its factor leaves open whether the numbers are expanded.",
        "`coverage_probability` = 0.95 alone", "Divide by the factor, and state it.";
    "BB0607" "uncertainty.of-value" Warning uncertainty::of_value,
        "A value that may be used has an uncertainty.",
        "a value with `value_u` = NaN", "State the uncertainty, or flag the value.";
    "BB0608" "uncertainty.zero" Warning uncertainty::zero,
        "A weight of 1/0 takes over a fit.",
        "`value_u` = 0", "State the uncertainty, or NaN where it is unknown.";
    "BB0609" "uncertainty.infinite" Error uncertainty::infinite,
        "Infinity is the trace of a division by zero.",
        "`value_u` = inf", "Use NaN where the uncertainty is unknown.";

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
    "BB0807" "model.residuals" Warning model::residuals,
        "Stored terms on stored data leave the stored residuals, or one of the three was changed.",
        "`residual_rms` = 0.003 where the terms leave 0.03", "Fit again.";
    "BB0808" "model.complete" Error model::complete,
        "A term without one of its parameters predicts nothing.",
        "a torrance-sparrow term without `roughness`", "Store every parameter of the term.";
    "BB0809" "model.uncertainty" Error model::uncertainty,
        "Each parameter has a standard uncertainty, or NaN where the data cannot tell.",
        "a negative uncertainty", "Fit again.";
    "BB0810" "model.correlation" Error model::correlation,
        "No two quantities are correlated by more than 1.",
        "cov[0,1] = 2 with variances of 1", "Fit again.";
    "BB0811" "model.covariance-names" Error model::covariance_names,
        "A name that two parameters have says nothing about either.",
        "torrance-sparrow.roughness for each of two terms", "Name them as in torrance-sparrow:1.roughness, by the position of the term.";
    "BB0812" "model.albedo" Warning albedo::of_models,
        "Terms without a norm can send back more light than falls in, mostly at flat incidence.",
        "an intensity of 30 at a roughness of 0.3", "Fit again with a normalised distribution; do not let light bounce between such surfaces.";
    "BB0813" "model.donaldson" Error model::donaldson,
        "A model is completed with the two parts of one matrix, on its axes.",
        "the luminescent part of another matrix", "Attach the matrix again: fit --donaldson.";

    "BB0901" "calibration.date-form" Error calibration::date_form,
        "Days are compared with the times of the rows.",
        "`date` = 11/22/26", "Write days as 2026-11-22.";
    "BB0902" "calibration.order" Error calibration::order,
        "A calibration ends after it was made.",
        "expires before its date", "Correct the two days.";
    "BB0903" "calibration.expired" Warning calibration::expired,
        "Beyond its last day nobody vouches for a calibration.",
        "rows of a day after `expires`", "Calibrate again, or state the certificate that held.";
    "BB0904" "calibration.missing" Info calibration::missing,
        "A number is traceable through a chain of calibrations only.",
        "an instrument without `calibration_0`", "State artefact, certificate, day and expiry.";

    "BB1001" "acquisition.time-form" Error acquisition::time_form,
        "A time without its zone is 24 different times.",
        "`22/11/2026 10:00`", "Write times as in 2026-11-22T10:00:00+09:00.";
    "BB1002" "acquisition.time-order" Warning acquisition::time_order,
        "Order and times are two statements of one thing; drift is looked for along it.",
        "row 3 before row 2", "Correct the one that is wrong.";
    "BB1003" "acquisition.order-unique" Warning acquisition::order_unique,
        "Two rows of one number leave their order open.",
        "order 7 twice", "Number the rows as they were taken.";
    "BB1004" "acquisition.exposure" Error acquisition::exposure,
        "An exposure takes time.",
        "0 ms", "Correct it; leave it out where it is unknown.";
    "BB1005" "acquisition.repeats" Error acquisition::repeats,
        "A row averages one reading or more.",
        "`repeats` = 0", "State how many readings were averaged.";
    "BB1006" "acquisition.derivation" Error acquisition::derivation,
        "A derived value is recomputed from the rows that it names.",
        "`numerator_row` of 300 in 272 rows", "Derive the measurement again.";

    "BB1101" "physics.negative" Warning physics::negative,
        "Noise around nothing is negative half the time, but never by many standard uncertainties.",
        "-0.05 with an uncertainty of 0.001", "Check dark signal and stray light; do not clip noise.";
    "BB1102" "physics.anti-stokes" Warning physics::anti_stokes,
        "Emission has less energy than its excitation; what lies below it, outside both bandpasses, is stray light or a second order.",
        "0.02 at 400 nm under 450 nm", "Check stray light and order filters.";
    "BB1103" "physics.energy-balance" Warning physics::energy_balance,
        "No passive surface radiates more energy than it receives.",
        "a row of 1.2", "Check the reference, the width of the emission and the unit.";
    "BB1104" "physics.photon-balance" Warning physics::photon_balance,
        "One photon excites one emission at most.",
        "1.1 photons for each", "Check the reference, the width of the emission and the basis.";
    "BB1105" "physics.reciprocity" Warning physics::reciprocity,
        "The elastic part over cos(theta_i) is the same when source and detector are exchanged (Helmholtz).",
        "0.31 and 0.35 in the two directions", "Check the alignment, the footprint and whether cos(theta_i) is in the values.";
    "BB1106" "physics.symmetry" Warning physics::symmetry,
        "A symmetry that is declared is one of the values.",
        "0.31 left and 0.35 right on an isotropic sample", "Check the zero of the angles, or take the declaration back.";
    "BB1107" "physics.drift" Warning physics::drift,
        "The same geometry again shows what lamp and sample did in between.",
        "0.31, and 0.29 an hour later", "Correct for the drift, or let the lamp warm up.";
    "BB1108" "physics.albedo" Warning albedo::of_measurements,
        "Over all viewing directions a surface reflects at most what falls in.",
        "an elastic factor of 1.2 in every direction", "Check the reference, the footprint and whether cos(theta_i) is in the values.";

    "BB1201" "portability.filter" Warning portability::filter,
        "A filter that a program lacks hides the values from it.",
        "zstd", "Write with shuffle, deflate and fletcher32.";
    "BB1202" "portability.half-float" Warning portability::half_float,
        "netCDF4-python crashes on it.",
        "float16", "Write float32 or float64.";
    "BB1203" "portability.null-dataspace" Warning portability::null_dataspace,
        "netCDF-C crashes on a dimension scale without a dataspace.",
        "a null dataspace", "Write an axis of length 0.";
    "BB1204" "portability.dangling-link" Error portability::dangling_link,
        "One such link makes netCDF-C, h5netcdf and xarray refuse the whole file.",
        "a soft link to what was removed", "Remove the link.";
    "BB1205" "portability.variable-string" Warning portability::variable_string,
        "MATLAB and Octave show it as an unsupported type.",
        "a string as h5py writes it by default", "Write strings of fixed length, UTF-8, padded with NUL.";
    "BB1206" "portability.variable-length" Warning portability::variable_length,
        "xarray with h5netcdf cannot read it.",
        "a ragged array", "Pad, and flag what is padding.";
    "BB1207" "portability.reference" Warning portability::reference,
        "xarray with h5netcdf cannot read the file.",
        "an attribute that is an object reference", "Write the path as text.";
    "BB1208" "portability.creation-order" Info portability::creation_order,
        "netCDF-C opens the file for reading only.",
        "a group made without it", "Create file, groups and datasets with tracked order.";
    "BB1209" "portability.fill-value" Warning portability::fill_value,
        "Older netCDF-C refuses the variable.",
        "a float64 fill value on float32", "Give the fill value the type of the values.";
    "BB1210" "portability.enumeration" Warning portability::enumeration,
        "Programs show different numbers.",
        "a truth value as h5py writes it", "Write uint8, 0 or 1.";
    "BB1211" "portability.compound" Warning portability::compound,
        "Each language reads it in its own way, or not.",
        "complex numbers", "Write one array for each field.";
    "BB1212" "portability.big-endian" Info portability::big_endian,
        "Small readers get the numbers wrong.",
        "numbers of a mainframe", "Write little-endian numbers.";
    "BB1213" "portability.user-block" Warning portability::user_block,
        "Small readers do not find the file behind it.",
        "512 foreign bytes", "Write without a user block.";
    "BB1214" "portability.superblock" Warning portability::superblock,
        "Small readers know versions 0, 2 and 3 only.",
        "version 1", "Write with the bounds of HDF5 1.8 to 1.10.";
    "BB1215" "portability.dimension-scale" Info portability::dimension_scale,
        "Programs invent names and merge axes of one length.",
        "`value` without scales", "Attach a dimension scale to every axis.";

    "BB1301" "provenance.source-digest" Error provenance::source_digest,
        "A digest identifies the source only when it is one.",
        "`sha256` = unknown", "Write the SHA-256 of the source, or leave the input out.";
    "BB1302" "provenance.unfilled" Info provenance::unfilled,
        "What the source did not say is listed, so that a converted file cannot pass as a documented one.",
        "no mark on the sample", "Ask whoever measured, and import again with it.";
    "BB1303" "provenance.origin" Warning provenance::origin,
        "Numbers without an origin cannot be checked.",
        "neither a receipt nor a step", "Import with the tool that keeps a receipt, or add a step by hand.";
    "BB1304" "provenance.license" Info provenance::license,
        "Without a licence nobody may use the data.",
        "no `license`", "State the SPDX identifier of the licence.";

    "BB1401" "light.shape" Error light::shape,
        "Each wavelength of a light has one value and one flag mask.",
        "3 wavelengths and 4 values", "Write the spectrum again with one length.";
    "BB1402" "light.nan-without-reason" Error light::nan_without_reason,
        "Missing is never one NaN: it says why.", "NaN with flag 0",
        "Set the flag: not measured, invalid, below detection or saturated.";
    "BB1403" "light.infinite" Error light::infinite,
        "No instrument measures infinity.", "inf at 400 nm", "Replace it by NaN with its reason.";
    "BB1404" "light.negative" Warning light::negative,
        "Light is not negative; noise around nothing is, by little.",
        "-0.1 in a spectrum with a peak of 1", "Check the dark signal; do not clip noise.";
    "BB1405" "light.no-value" Warning light::no_value,
        "A spectrum without light illuminates nothing.", "0 at every wavelength",
        "Leave the spectrum out, or store the one that was measured.";
    "BB1406" "light.covers-emission" Warning light::covers_emission,
        "What a surface reflects at a wavelength is known for another light only where the spectrum of this one is known there.",
        "a lamp known from 400 to 700 nm, factors from 380 to 780 nm", "Measure the light over the emission axis, or leave the ends of that out.";

    "BB1501" "factorisation.shape" Error factorisation::shape,
        "Factors are spectra on the axes of their group.", "49 excitations and a factor of 48 values",
        "Separate the matrix again.";
    "BB1502" "factorisation.axis" Error factorisation::axis,
        "Excitation wavelengths ascend.", "310 nm after 320 nm", "Separate the matrix again.";
    "BB1503" "factorisation.negative" Error factorisation::negative,
        "Neither absorption nor emission is negative, and no standard uncertainty is.", "-0.01 in an excitation spectrum",
        "Separate the matrix again.";
    "BB1504" "factorisation.data-changed" Warning factorisation::data_changed,
        "Factors describe the matrix that they were made of.", "a matrix edited after its separation",
        "Separate the matrix again.";
}
