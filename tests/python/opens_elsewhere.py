"""Opens a file in h5py, netCDF4 and xarray (both engines), compares it with what the test expects, and copies it
through netCDF4.

usage: opens_elsewhere.py FILE EXPECTED.json COPY
"""

import json
import sys
import warnings

import h5py
import netCDF4
import numpy as np
import xarray as xr

warnings.simplefilter("ignore", xr.SerializationWarning)


def text(value):
    return value.decode("utf-8") if isinstance(value, bytes) else str(value)


def check(what, found, expected):
    if found != expected:
        sys.exit(f"{what}: found {found!r}; expected {expected!r}")


def check_numbers(what, found, expected):
    found = np.asarray(np.ma.filled(found, np.nan) if np.ma.isMaskedArray(found) else found, dtype=float)
    expected = np.array([[np.nan if x is None else x for x in row] for row in expected], dtype=float)
    if found.shape != expected.shape or not np.array_equal(found, expected, equal_nan=True):
        sys.exit(f"{what}: found {found}; expected {expected}")


def with_h5py(path, expected):
    with h5py.File(path) as file:
        check("h5py title", text(file.attrs["title"]), expected["title"])
        check("h5py conventions", text(file.attrs["Conventions"]), "CF-1.11 BBRF-1.0")
        group = file["measurement/scan"]
        value = group["value"]
        check_numbers("h5py value", value[...], expected["values"])
        check("h5py units", text(value.attrs["units"]), expected["units"])
        check("h5py theta_i units", text(group["theta_i"].attrs["units"]), "degree")
        scales = [axis.keys()[0] for axis in value.dims]
        check("h5py scales", scales, ["acquisition", "wavelength_emission"])
        check("h5py scale attached", list(value.dims[1][0][...]), expected["wavelengths"])
        check("h5py filters", (value.compression, value.shuffle, value.fletcher32), ("gzip", True, True))
        check("h5py flags", group["value_flag"].dtype, np.dtype("uint16"))
        check("h5py fill value", bool(np.isnan(value.fillvalue)), True)
        check("h5py time", text(file["measurement/raw/time"][0]), "2026-11-22T03:01:40Z")
        json.loads(file["provenance/receipts"][()])


def with_netcdf4(path, expected):
    with netCDF4.Dataset(path) as file:
        check("netCDF4 title", file.title, expected["title"])
        group = file["measurement"]["scan"]
        value = group["value"]
        check("netCDF4 dimensions", value.dimensions, ("acquisition", "wavelength_emission"))
        check("netCDF4 units", value.units, expected["units"])
        check_numbers("netCDF4 value", value[...], expected["values"])
        check("netCDF4 coordinates", value.coordinates, "theta_i phi_i theta_v phi_v")
        check("netCDF4 empty text", file["sample"]["paint"].material, "")
        check("netCDF4 time", file["measurement"]["raw"]["time"][0], "2026-11-22T03:01:40Z")


def check_measurement(engine, data, expected):
    value = data["value"]
    check(f"{engine} units", text(value.attrs["units"]), expected["units"])
    check_numbers(f"{engine} value", value.values, expected["values"])
    check(f"{engine} coordinates", sorted(value.coords), sorted(expected["coordinates"]))
    check(f"{engine} angle", float(value.coords["theta_i"][0]), expected["theta_i"])
    check(f"{engine} wavelengths", list(value.coords["wavelength_emission"].values), expected["wavelengths"])
    flag = data["value_flag"]
    check(f"{engine} masks", [int(mask) for mask in flag.attrs["flag_masks"]], expected["flag_masks"])
    check(f"{engine} meanings", text(flag.attrs["flag_meanings"]), expected["flag_meanings"])
    check(f"{engine} flags", flag.values.tolist(), expected["flags"])
    check(f"{engine} ancillary", text(value.attrs["ancillary_variables"]), "value_flag value_u")


def with_xarray(path, expected):
    for engine in ["netcdf4", "h5netcdf"]:
        with xr.open_dataset(path, group="/measurement/scan", engine=engine) as data:
            check_measurement(engine, data, expected)
        with xr.open_datatree(path, engine=engine) as tree:
            check_measurement(f"{engine} tree", tree["measurement/scan"], expected)
            check(f"{engine} root", text(tree.attrs["title"]), expected["title"])


def copy_group(source, target):
    for name in source.ncattrs():
        target.setncattr(name, source.getncattr(name))
    for name, dimension in source.dimensions.items():
        target.createDimension(name, len(dimension))
    for name, variable in source.variables.items():
        fill = variable.getncattr("_FillValue") if "_FillValue" in variable.ncattrs() else None
        copy = target.createVariable(name, variable.dtype, variable.dimensions, fill_value=fill)
        for attribute in variable.ncattrs():
            if attribute != "_FillValue":
                copy.setncattr(attribute, variable.getncattr(attribute))
        for array in (variable, copy):
            array.set_auto_maskandscale(False)
        copy[...] = variable[...]
    for name, group in source.groups.items():
        copy_group(group, target.createGroup(name))


def main():
    path, expected_path, copy = sys.argv[1:]
    with open(expected_path, encoding="utf-8") as file:
        expected = json.load(file)
    with_h5py(path, expected)
    with_netcdf4(path, expected)
    with_xarray(path, expected)
    with netCDF4.Dataset(path) as source, netCDF4.Dataset(copy, "w") as target:
        copy_group(source, target)
    # Appending needs the creation order, without which netCDF opens a file read-only.
    with netCDF4.Dataset(path, "a") as file:
        file.setncattr("history", "appended")
    print("opened in h5py", h5py.__version__, "netCDF4", netCDF4.__version__, "xarray", xr.__version__)


main()
