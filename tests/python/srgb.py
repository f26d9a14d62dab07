"""Encodes XYZ as sRGB with colour-science: the oracle of tests/image_png.rs.

Reads JSON {"white": XYZ, "xyz": [XYZ...]}; prints red, green and blue of all pixels, from 0 to 1 and not rounded.
"""

import json
import sys
import warnings

warnings.simplefilter("ignore")

import colour  # noqa: E402
import numpy as np  # noqa: E402

given = json.load(sys.stdin)
xyz, white = np.array(given["xyz"], dtype=float), np.array(given["white"])
space = colour.RGB_COLOURSPACES["sRGB"]
d65 = colour.xy_to_XYZ(space.whitepoint)
adapted = colour.adaptation.chromatic_adaptation_VonKries(xyz / white[1], white / white[1], d65, transform="Bradford")
primaries = colour.normalised_primary_matrix(space.primaries, space.whitepoint)
linear = np.clip(adapted @ np.linalg.inv(primaries).T, 0, 1)
json.dump(space.cctf_encoding(linear).ravel().tolist(), sys.stdout)
