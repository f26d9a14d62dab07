"""Predicts colours of fluorescent surfaces from their parts, and with colour-science: the oracle of tests/donaldson_predict.rs.

Reads JSON: {"lights": [{"nm", "values"}], "surfaces": [{"excitation_nm", "emission_nm", "elastic", "density"}]}, density being
[excitation][emission] in nm-1. Prints for each surface, light and observer XYZ, Lab, Luv, whiteness, tint and the CIEDE2000 to
the first light.
"""

import json
import sys
import warnings

warnings.simplefilter("ignore")

import colour  # noqa: E402
import numpy as np  # noqa: E402

NM = np.arange(380, 781)
OBSERVERS = ["CIE 1931 2 Degree Standard Observer", "CIE 1964 10 Degree Standard Observer"]
SHAPE = colour.SpectralShape(380, 780, 1)
CMFS = [colour.MSDS_CMFS[name].copy().align(SHAPE) for name in OBSERVERS]


def integral(f, low, high):
    """Simpson's rule in steps of 0.1 nm: exact for products of lines that bend at whole nanometres."""
    count = 2 * round((high - low) * 5)
    x = np.linspace(low, high, count + 1)
    weight = np.ones(count + 1)
    weight[1:-1:2], weight[2:-1:2] = 4, 2
    return float(np.sum(weight * f(x)) * (high - low) / count / 3)


def shares(surface, light):
    """The integral of the light times the tent of each excitation."""
    centres = np.array(surface["excitation_nm"])
    low, high = max(centres[0], light["nm"][0]), min(centres[-1], light["nm"][-1])
    found = []
    for k in range(len(centres)):
        tent = np.zeros(len(centres))
        tent[k] = 1
        found.append(
            integral(lambda x: np.interp(x, centres, tent) * np.interp(x, light["nm"], light["values"]), low, high)
        )
    return np.array(found)


def predict(surface, light):
    e = np.interp(NM, light["nm"], light["values"])
    emitted = shares(surface, light) @ np.array(surface["density"])
    luminescent = np.interp(NM, surface["emission_nm"], emitted, left=0, right=0)
    elastic = np.interp(NM, surface["emission_nm"], surface["elastic"])
    return e, elastic + luminescent / e


def colours(surface, lights, observer):
    found = []
    for light in lights:
        e, factor = predict(surface, light)
        illuminant = colour.SpectralDistribution(e, NM)
        xyz = colour.colorimetry.sd_to_XYZ_integration(
            colour.SpectralDistribution(factor, NM), CMFS[observer], illuminant
        )
        white = colour.colorimetry.sd_to_XYZ_integration(
            colour.SpectralDistribution(np.ones(len(NM)), NM), CMFS[observer], illuminant
        )
        xy = colour.XYZ_to_xy(white)
        lab = colour.XYZ_to_Lab(xyz / 100, xy)
        # W and T against the white of the light, as CIE 15 has them for the 2 degree observer.
        name = OBSERVERS[observer]
        whiteness = colour.colorimetry.whiteness_CIE2004(colour.XYZ_to_xy(xyz), xyz[1], xy, name)
        found.append(
            {
                "xyz": list(xyz),
                "white": list(white),
                "lab": list(lab),
                "luv": list(colour.XYZ_to_Luv(xyz / 100, xy)),
                "whiteness": list(whiteness),
            }
        )
    for one in found:
        one["de2000"] = float(colour.delta_E(found[0]["lab"], one["lab"], method="CIE 2000"))
    return found


def main():
    given = json.load(sys.stdin)
    print(
        json.dumps(
            [
                [colours(surface, given["lights"], observer) for observer in range(2)]
                for surface in given["surfaces"]
            ]
        )
    )


main()
