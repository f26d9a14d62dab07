"""Reads a bbrf file and checks every digest in it: python read_bbrf.py FILE.bbrf. Needs h5py and numpy alone.

`read(path)` gives the document's attributes and its measurements with values, units, flags, geometry and uncertainties.
"""

import hashlib
import json
import sys

import h5py
import numpy as np

UNDIGESTED = {"DIMENSION_LIST", "REFERENCE_LIST", "CLASS", "NAME", "_FillValue", "_NCProperties", "sha256", "digest",
              "Conventions", "bbrf_version", "long_name"}
QUANTITY = ("quantity", "units", "part", "normalised_at", "basis", "reference", "reference_light")


class Damaged(Exception):
    """Content that does not have its digest, with the paths."""


def text(value):
    return value.decode() if isinstance(value, bytes) else str(value)


def uint64(number):
    return int(number).to_bytes(8, "little")


def digested_text(content):
    return uint64(len(content.encode())) + content.encode()


def digested(values, kind, shape):
    """Type, shape and values of an array as the digest takes them (clause 2)."""
    shape = b"".join(map(uint64, (len(shape), *shape)))
    if kind.kind in "SO":
        return digested_text("string") + shape + b"".join(digested_text(text(item)) for item in np.ravel(values))
    return digested_text(kind.name) + shape + np.asarray(values, dtype=kind.newbyteorder("<")).tobytes()


def sha256(target):
    """The digest of a group or dataset."""
    content = digested_text("group")
    if isinstance(target, h5py.Dataset):
        content = digested_text("dataset") + digested(target[()], target.dtype, target.shape)
    for name in sorted(target.attrs, key=str.encode):
        if name not in UNDIGESTED and not name.startswith("_Netcdf4"):
            stored, value = target.attrs.get_id(name), target.attrs[name]
            shape = () if np.size(value) == 1 else stored.shape  # netCDF makes an array of every number
            content += digested_text(name) + digested(value, stored.dtype, shape)
    return hashlib.sha256(content).hexdigest()


def check_digests(file):
    """The digest of the document; raises `Damaged` where one does not agree."""
    objects = {"/": file}
    file.visititems(lambda path, target: objects.update({f"/{path}": target}))
    signed = {path: text(target.attrs["sha256"]) for path, target in objects.items() if "sha256" in target.attrs}
    wrong = [path for path in signed if sha256(objects[path]) != signed[path]]
    lines = "".join(f"{signed[path]} {path}\n" for path in sorted(signed, key=str.encode))
    document = "sha256:" + hashlib.sha256(lines.encode()).hexdigest()
    if wrong or document != text(file.attrs.get("digest", "")):
        raise Damaged(", ".join(wrong) or "/@digest")
    return document


def flag_names(dataset):
    """The names of the flags of each value."""
    names, masks = text(dataset.attrs["flag_meanings"]).split(), dataset.attrs["flag_masks"]
    return lambda flags: [name for name, mask in zip(names, masks) if flags & mask]


def measurement(group):
    value = group["value"]
    components = (group[f"value_u_shared_{k}"] for k in range(len(group)) if f"value_u_shared_{k}" in group)
    return {
        "role": text(group.attrs["role"]),
        **{name: text(value.attrs[name]) for name in QUANTITY},
        "value": value[...],
        "flag": group["value_flag"][...],
        "flag_names": flag_names(group["value_flag"]),
        "geometry": np.stack([group[name][...] for name in ("theta_i", "phi_i", "theta_v", "phi_v")], axis=-1),
        "has_geometry": (group["stated"][...] & 1).astype(bool),
        "wavelength_nm": group["wavelength_emission"][...] if "wavelength_emission" in group else None,
        "uncertainty": group["value_u"][...] if "value_u" in group else None,
        "shared": [(text(part.attrs["cause"]), text(part.attrs["correlated_over"]), part[...]) for part in components],
    }


def read(path):
    """The document of a file; refuses another major version and damaged content."""
    with h5py.File(path) as file:
        version = file.attrs.get("bbrf_version")
        if not isinstance(version, (str, bytes)) or text(version)[:2] != "1." or not text(version)[2:].isdigit():
            raise ValueError(f"version {version}; expected 1.x")
        if text(version) != "1.0":
            print(f"version {text(version)} is newer than this reader; what it adds is not read", file=sys.stderr)
        digest = check_digests(file)
        groups = file["measurement"].items() if "measurement" in file else []
        groups = sorted(groups, key=lambda item: item[1].attrs["position"])
        stated = [name for name in ("title", "license", "citation", "contact") if name in file.attrs]
        return {"digest": digest, **{name: text(file.attrs[name]) for name in stated},
                "measurements": {name: measurement(group) for name, group in groups}}


def plain(value):
    """Arrays as lists with null for NaN, for JSON."""
    if isinstance(value, np.ndarray):
        return [plain(item) for item in value]
    return None if isinstance(value, np.floating) and np.isnan(value) else value.item()


if __name__ == "__main__":
    document = read(sys.argv[1])
    for scan in document["measurements"].values():
        scan["flag_names"] = sorted({name for flags in scan["flag"].flat for name in scan["flag_names"](flags)})
    print(json.dumps(document, default=plain, indent=1))
