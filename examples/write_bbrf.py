"""Writes a small valid bbrf file from plain arrays: python write_bbrf.py OUT.bbrf. Needs h5py and numpy alone.

A Lambertian sheet at 12 geometries and 5 wavelengths. Every object gets its `sha256`, the root its `digest` (clause 2).
"""

import hashlib
import json
import sys

import h5py
import numpy as np

FLAGS = ("not-measured-by-design not-measured invalid below-detection saturated interpolated low-light noisy "
         "battery-low stale-buffer")
DESCRIPTIONS = {"Conventions", "bbrf_version", "long_name"}


def uint64(number):
    return int(number).to_bytes(8, "little")


def digested_text(text):
    return uint64(len(text.encode())) + text.encode()


def digested(array):
    """Type, shape and values of an array as the digest takes them."""
    is_text = array.dtype.kind == "U"
    values = digested_text(str(array)) if is_text else array.tobytes()
    shape = b"".join(map(uint64, (array.ndim, *array.shape)))
    return digested_text("string" if is_text else array.dtype.name) + shape + values


def encoded(array):
    if array.dtype.kind != "U":
        return array
    text = str(array).encode()
    return np.array(text, dtype=h5py.string_dtype("utf-8", max(1, len(text))))


class Writer:
    def __init__(self, path):
        self.file, self.lines = h5py.File(path, "w", libver=("v108", "v110"), track_order=True), {}

    def describe(self, target, content, attributes):
        for name in sorted(attributes, key=str.encode):
            array = np.asarray(attributes[name])
            target.attrs.create(name, encoded(array), dtype=encoded(array).dtype)
            content += b"" if name in DESCRIPTIONS else digested_text(name) + digested(array)
        self.lines[target.name] = hashlib.sha256(content).hexdigest()
        target.attrs["sha256"] = encoded(np.asarray(self.lines[target.name]))

    def group(self, path, **attributes):
        target = self.file if path == "/" else self.file.create_group(path, track_order=True)
        self.describe(target, digested_text("group"), attributes)

    def dataset(self, path, values, axes=(), is_scale=False, fill=False, **attributes):
        array = np.asarray(values)
        options = {"shuffle": True, "compression": "gzip", "fletcher32": True} if array.ndim else {}
        target = self.file.create_dataset(path, data=encoded(array), dtype=encoded(array).dtype, track_order=True,
                                          fillvalue=np.nan if fill else None, **options)
        if is_scale:
            target.make_scale(path.rsplit("/", 1)[1])
        for axis, scale in enumerate(axes):
            target.dims[axis].attach_scale(target.parent[scale])
        self.describe(target, digested_text("dataset") + digested(array), attributes)

    def close(self):
        lines = "".join(f"{self.lines[path]} {path}\n" for path in sorted(self.lines, key=str.encode))
        self.file.attrs["digest"] = encoded(np.asarray("sha256:" + hashlib.sha256(lines.encode()).hexdigest()))
        self.file.close()


def main(path):
    nm, phi_i, phi_v = np.arange(500.0, 550.0, 10.0), np.full(12, 180.0), np.zeros(12)
    theta_i, theta_v = np.repeat([20.0, 40.0, 60.0], 4), np.tile([0.0, 10.0, 30.0, 50.0], 3)
    value = 0.8 + 1e-3 * np.sin(np.arange(60.0)).reshape(12, 5)
    numbers, axes, row = np.arange(12, dtype="uint32"), ["acquisition", "wavelength_emission"], ["acquisition"]
    unit = {"units": "1", "unit_si_factor": 1.0, "unit_si_exponents": np.zeros(7, "int8")}
    writer, scan = Writer(path), "/measurement/scan"
    writer.group("/", Conventions="CF-1.11 BBRF-1.0", bbrf_version="1.0", title="a white sheet", license="CC0-1.0")
    writer.group("/measurement")
    writer.group(scan, position=np.int32(0), role="sample")
    scales = {"acquisition": 12, "wavelength_emission_fwhm_index": 1, "direction_test": 12, "xyz": 3}
    for name, length in scales.items():
        writer.dataset(f"{scan}/{name}", np.arange(length, dtype="int32"), is_scale=True, units="1")
    writer.dataset(f"{scan}/wavelength_emission", nm, is_scale=True, units="nm")
    writer.dataset(f"{scan}/wavelength_emission_fwhm", [8.0], ["wavelength_emission_fwhm_index"], units="nm",
                   bandpass_shape="triangular", bandpass_correction="uncorrected")
    writer.dataset(f"{scan}/stated", np.full(12, 1, "uint8"), row, flag_masks=(1 << np.arange(5)).astype("uint8"),
                   flag_meanings="geometry excitation time exposure quality_code")
    for name, angles in {"theta_i": theta_i, "phi_i": phi_i, "theta_v": theta_v, "phi_v": phi_v}.items():
        writer.dataset(f"{scan}/{name}", angles, row, units="degree")
    columns = {"excitation": 0 * numbers, "order": numbers, "repeats": 0 * numbers + 1}
    for name, column in columns.items():
        writer.dataset(f"{scan}/{name}", column, row, units="1")
    writer.dataset(f"{scan}/quality_code", np.zeros(12, "int32"), row, units="1")
    writer.dataset(f"{scan}/exposure", np.full(12, np.nan), row, units="ms")  # not stated: NaN
    writer.dataset(f"{scan}/value", value, axes, fill=True, quantity="radiance-factor", part="total",
                   normalised_at="emission", basis="energy", reference="same-geometry", reference_light="same",
                   coordinates="theta_i phi_i theta_v phi_v", ancillary_variables="value_flag value_u", **unit)
    writer.dataset(f"{scan}/value_u", np.full((12, 5), 2e-3), axes, fill=True, evaluation="type-a", **unit)
    writer.dataset(f"{scan}/value_flag", np.zeros((12, 5), "uint16"), axes, flag_meanings=FLAGS,
                   flag_masks=(1 << np.arange(10)).astype("uint16"))
    # Directions a second time; a laboratory takes them from where its angles come from.
    writer.dataset(f"{scan}/direction_test_row", numbers, ["direction_test"], units="1")
    for name, angles in {"incidence": (theta_i, phi_i), "viewing": (theta_v, phi_v)}.items():
        (theta, phi), (cos, sin) = np.radians(angles), (np.cos, np.sin)
        vectors = np.stack([sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta)], axis=-1)
        writer.dataset(f"{scan}/direction_test_{name}", vectors, ["direction_test", "xyz"], units="1")
    writer.group("/provenance")
    for name, content in {"receipts": [], "steps": [{"tool": "write_bbrf.py", "action": "made up"}]}.items():
        writer.dataset(f"/provenance/{name}", json.dumps(content, separators=(",", ":"), ensure_ascii=False))
    writer.close()


if __name__ == "__main__":
    main(sys.argv[1])
