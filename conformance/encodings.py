"""Copies of a file in every encoding that the standard allows, and in those that some program cannot read.

    python encodings.py CLEAN.bbrf FOLDER [NAME ...]

Prints one line for each copy: its name, `same` where the document's digest must be unchanged, and the rule that must
name the encoding (`-` for none). Needs h5py alone.
"""

import sys
from pathlib import Path

import h5py
import numpy as np

FOREIGN = {"DIMENSION_LIST", "REFERENCE_LIST", "CLASS", "NAME"}


def copy_attributes(source, target, change):
    for name in source.attrs:
        if name in FOREIGN:
            continue
        kind, value = source.attrs.get_id(name).dtype, source.attrs[name]
        text = h5py.check_string_dtype(kind)
        if text and change.get("variable_strings"):
            text_of = lambda item: item.decode() if isinstance(item, bytes) else str(item)
            target.attrs[name] = text_of(value) if np.ndim(value) == 0 else [text_of(item) for item in value]
            continue
        if text is None and change.get("big_endian"):
            kind = kind.newbyteorder(">")
        shape = source.attrs.get_id(name).shape
        # h5py gives texts as str; the bytes go back with the type that they had.
        raw = np.asarray(value, dtype=object) if text else value
        if text:
            encode = lambda item: item.encode() if isinstance(item, str) else item
            raw = encode(value) if np.ndim(value) == 0 else np.array([encode(item) for item in value], dtype=f"S{kind.itemsize}")
            target.attrs.create(name, np.array(raw, dtype=f"S{kind.itemsize}"), shape=shape, dtype=kind)
        else:
            target.attrs.create(name, raw, shape=shape, dtype=kind)


def copy_dataset(source, group, name, change):
    kind, data = source.dtype, source[()]
    if change.get("big_endian") and kind.kind in "iuf":
        kind = kind.newbyteorder(">")
    options = {}
    if source.shape and source.size:
        options = dict(change.get("storage", dict(chunks=True, shuffle=True, compression="gzip", fletcher32=True)))
    target = group.create_dataset(name, shape=source.shape, dtype=kind, track_order=change.get("order", True), **options)
    if source.size:
        target[()] = data
    copy_attributes(source, target, change)
    return target


def copy_group(source, target, change):
    copy_attributes(source, target, change)
    for name in source:
        if isinstance(source[name], h5py.Dataset):
            copy_dataset(source[name], target, name, change)
    for name in source:
        if not isinstance(source[name], h5py.Dataset) or change.get("scales") is False:
            continue
        if source[name].is_scale:
            target[name].make_scale(name)
    for name in source:
        if isinstance(source[name], h5py.Dataset) and change.get("scales") is not False:
            for axis, dimension in enumerate(source[name].dims):
                for scale in dimension.values():
                    target[name].dims[axis].attach_scale(target[scale.name.rsplit("/", 1)[-1]])
    for name in source:
        if isinstance(source[name], h5py.Group):
            child = target.create_group(name, track_order=change.get("order", True))
            copy_group(source[name], child, change)


def value(file):
    return file["measurement/scan"]


def add_half_float(file):
    file["extension/org.example.goniometer"].create_dataset("half", data=np.ones(3, "f2"), track_order=True)


def add_null(file):
    file["extension/org.example.goniometer"].create_dataset("null", data=h5py.Empty("f8"), track_order=True)


def add_dangling(file):
    value(file)["gone"] = h5py.SoftLink("/nowhere")


def add_external(file):
    value(file)["outside"] = h5py.ExternalLink("other.h5", "/")


def add_variable_length(file):
    kind = h5py.vlen_dtype(np.dtype("f8"))
    data = file["extension/org.example.goniometer"].create_dataset("ragged", (2,), dtype=kind, track_order=True)
    data[0], data[1] = [1.0], [1.0, 2.0]


def add_reference(file):
    value(file).attrs["best"] = file["sample/paint"].ref


def add_enumeration(file):
    file["extension/org.example.goniometer"].attrs["warm"] = True


def add_compound(file):
    file["extension/org.example.goniometer"].create_dataset("complex", data=np.ones(2, complex), track_order=True)


def wrong_fill(file):
    value(file)["value"].attrs.create("_FillValue", np.float32(np.nan), dtype="f4")


def later_minor(file):
    del file.attrs["bbrf_version"]
    file.attrs.create("bbrf_version", np.bytes_("1.7"), dtype=h5py.string_dtype("utf-8", 3))


# name: (same digest?, rule, copy options, file options, edit of the copy)
ENCODINGS = {
    "as-written": (True, "-", {}, {}, None),
    "contiguous": (True, "-", {"storage": {}}, {}, None),
    "one-row-chunks": (True, "-", {"storage": {"chunks": True}}, {}, None),
    "deflate-9-alone": (True, "-", {"storage": {"chunks": True, "compression": "gzip", "compression_opts": 9}}, {}, None),
    "fletcher-alone": (True, "-", {"storage": {"chunks": True, "fletcher32": True}}, {}, None),
    "bounds-latest": (True, "-", {}, {"libver": "latest"}, None),
    "bounds-earliest": (True, "-", {}, {"libver": "earliest"}, None),
    "bounds-v108": (True, "-", {}, {"libver": ("v108", "v108")}, None),
    "big-endian": (True, "portability.big-endian", {"big_endian": True}, {}, None),
    "variable-strings": (True, "portability.variable-string", {"variable_strings": True}, {}, None),
    "no-creation-order": (True, "portability.creation-order", {"order": False}, {"track_order": False}, None),
    "user-block": (True, "portability.user-block", {}, {"userblock_size": 512}, None),
    "no-scales": (True, "portability.dimension-scale", {"scales": False}, {}, None),
    "lzf": (False, "portability.filter", {"storage": {"chunks": True, "compression": "lzf"}}, {}, None),
    "half-float": (False, "portability.half-float", {}, {}, add_half_float),
    "null-dataspace": (False, "portability.null-dataspace", {}, {}, add_null),
    "dangling-link": (True, "portability.dangling-link", {}, {}, add_dangling),
    "external-link": (False, "structure.hdf5", {}, {}, add_external),
    "variable-length": (False, "portability.variable-length", {}, {}, add_variable_length),
    "reference": (True, "portability.reference", {}, {}, add_reference),
    "enumeration": (False, "portability.enumeration", {}, {}, add_enumeration),
    "compound": (False, "portability.compound", {}, {}, add_compound),
    "fill-value": (True, "portability.fill-value", {}, {}, wrong_fill),
    "later-minor-version": (False, "structure.minor-version", {}, {}, later_minor),
}


def main():
    clean, folder = Path(sys.argv[1]), Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    for name in sys.argv[3:] or ENCODINGS:
        same, rule, change, options, edit = ENCODINGS[name]
        path = folder / f"{name}.bbrf"
        with h5py.File(clean, "r") as source, h5py.File(path, "w", **{"track_order": True, "libver": ("v108", "v110"), **options}) as target:
            copy_group(source, target, change)
            if edit:
                edit(target)
        print(name, "same" if same else "other", rule)


main()
