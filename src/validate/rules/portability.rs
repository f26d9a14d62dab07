//! Who can open it? Legal HDF5 that some program cannot read, with the program. The evidence is an experiment with h5py
//! 3.16, netCDF-C 4.10, xarray 2026.9 and h5netcdf 1.8, and the issue lists of MATLAB, SOFA and libmysofa users.

use super::super::Context;
use super::super::finding::Finder;
use crate::container::Construct;
use crate::dataset::Place;

/// Reports every place of a kind of construct.
fn each(context: &Context<'_>, found: &mut Finder, expected: &str, says: impl Fn(&Construct) -> Option<String>) {
    each_at(context, found, expected, |_, construct| says(construct));
}

/// The same where the place matters.
fn each_at(
    context: &Context<'_>,
    found: &mut Finder,
    expected: &str,
    says: impl Fn(&str, &Construct) -> Option<String>,
) {
    for (path, construct) in &context.inspection.unusual {
        if let Some(what) = says(path, construct) {
            found.add(Place::path(path), what, expected);
        }
    }
}

pub(in super::super) fn filter(context: &Context<'_>, found: &mut Finder) {
    each(context, found, "shuffle, deflate and fletcher32 only", |construct| match construct {
        Construct::Filter(4) => Some("szip, which many builds of HDF5 lack".to_owned()),
        Construct::Filter(32000) => Some("lzf, which netCDF-C and MATLAB cannot read".to_owned()),
        Construct::Filter(32001) => Some("blosc, which MATLAB cannot read and h5py only with a plugin".to_owned()),
        Construct::Filter(32015) => Some("zstd, which h5py reads only with a plugin".to_owned()),
        Construct::Filter(number) => Some(format!("filter {number}, which readers lack without a plugin")),
        _ => None,
    });
}

pub(in super::super) fn half_float(context: &Context<'_>, found: &mut Finder) {
    each(context, found, "float32 or float64", |construct| {
        (*construct == Construct::HalfFloat).then(|| "float16, on which netCDF4-python crashes".to_owned())
    });
}

pub(in super::super) fn null_dataspace(context: &Context<'_>, found: &mut Finder) {
    each(context, found, "an axis of length 0", |construct| {
        let what = "a null dataspace; netCDF-C crashes on a dimension scale of this kind, and h5netcdf fails";
        (*construct == Construct::NullDataspace).then(|| what.to_owned())
    });
}

pub(in super::super) fn dangling_link(context: &Context<'_>, found: &mut Finder) {
    each(context, found, "a link to what is in the file", |construct| match construct {
        Construct::DanglingLink(target) => Some(format!(
            "a soft link to `{target}`, which is not there; netCDF-C, h5netcdf and xarray then refuse the whole file"
        )),
        _ => None,
    });
}

pub(in super::super) fn variable_string(context: &Context<'_>, found: &mut Finder) {
    each(context, found, "a string of fixed length", |construct| {
        let what = "a string of variable length, which MATLAB and Octave show as an unsupported type";
        (*construct == Construct::VariableString).then(|| what.to_owned())
    });
}

pub(in super::super) fn variable_length(context: &Context<'_>, found: &mut Finder) {
    each(context, found, "an array with its flags", |construct| {
        let what = "a sequence of variable length, which xarray with h5netcdf cannot read";
        (*construct == Construct::VariableLength).then(|| what.to_owned())
    });
}

pub(in super::super) fn reference(context: &Context<'_>, found: &mut Finder) {
    each(context, found, "the path or identifier as text", |construct| {
        let what = "an object reference, which xarray with h5netcdf cannot read";
        (*construct == Construct::Reference).then(|| what.to_owned())
    });
}

pub(in super::super) fn creation_order(context: &Context<'_>, found: &mut Finder) {
    each(context, found, "tracked creation order", |construct| {
        let what = "no creation order; netCDF-C opens such a file for reading only";
        (*construct == Construct::NoCreationOrder).then(|| what.to_owned())
    });
}

pub(in super::super) fn fill_value(context: &Context<'_>, found: &mut Finder) {
    each(context, found, "a `_FillValue` of the type of the values", |construct| {
        let what = "a `_FillValue` of another type than the values; older netCDF-C refuses the variable";
        (*construct == Construct::FillValueType).then(|| what.to_owned())
    });
}

pub(in super::super) fn enumeration(context: &Context<'_>, found: &mut Finder) {
    each(context, found, "uint8, 0 or 1", |construct| {
        let what = "an enumeration, as h5py writes truth values; netCDF-C shows other numbers than h5py";
        (*construct == Construct::Enumeration).then(|| what.to_owned())
    });
}

pub(in super::super) fn compound(context: &Context<'_>, found: &mut Finder) {
    each(context, found, "one array for each field", |construct| match construct {
        Construct::Compound(kind) => {
            Some(format!("a {kind} type, which R, Julia and MATLAB read each in their own way"))
        }
        _ => None,
    });
}

pub(in super::super) fn big_endian(context: &Context<'_>, found: &mut Finder) {
    each(context, found, "little-endian numbers", |construct| {
        let what = "big-endian numbers, which small readers without libhdf5 get wrong";
        (*construct == Construct::BigEndian).then(|| what.to_owned())
    });
}

pub(in super::super) fn user_block(context: &Context<'_>, found: &mut Finder) {
    each(context, found, "a file that begins with the HDF5 signature", |construct| match construct {
        Construct::UserBlock(bytes) => Some(format!("{bytes} bytes before the file, which small readers do not skip")),
        _ => None,
    });
}

pub(in super::super) fn superblock(context: &Context<'_>, found: &mut Finder) {
    each(context, found, "superblock version 0, 2 or 3", |construct| match construct {
        Construct::Superblock(version) => {
            Some(format!("superblock version {version}, which libmysofa and others refuse"))
        }
        _ => None,
    });
}

pub(in super::super) fn dimension_scale(context: &Context<'_>, found: &mut Finder) {
    each_at(context, found, "a dimension scale on every axis", |path, construct| match construct {
        // What a laboratory adds is kept as it is, without scales.
        Construct::NoScale(_) if path.starts_with("/extension/") => None,
        Construct::NoScale(axes) => {
            Some(format!("{axes} axes without a scale; netCDF-C and xarray invent names and merge axes of one length"))
        }
        _ => None,
    });
}
