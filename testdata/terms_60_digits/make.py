"""D, G, F, the specular term and its derivatives at ordinary and adversarial points, right to 60 digits (mpmath).

The formulation is the textbook one with vectors, on purpose another than the code's: 100 digits are carried, so that its
cancellations cost nothing. Every input is an IEEE double and is taken as exact; angles are in degrees.

    python3 make.py > table.csv            the committed table
    python3 make.py SEED COUNT             as many other points, for a long run (faster with gmpy2 installed)

Columns: inputs; phi in rad; D; G; F; `over`, which is G F over denominator and over what the reference received; the
term D `over`; its derivatives in roughness and index, each followed by the sum of the absolute values of its terms over
the term itself. Intensity is 1. At 90 degrees the limit from inside is meant.
"""

import random
import sys

from gaussian_integral import norm
from mpmath import mp, mpf, atan2, cos, degrees, exp, log, pi, sin, sqrt, tan

mp.dps = 100
DISTRIBUTIONS = [
    "gaussian-half-height", "gaussian", "torrance-sparrow-1967", "gaussian-normalised", "beckmann", "trowbridge-reitz"]
DENOMINATORS = ["cos-theta-i", "cos-theta-v", "cos-i-cos-v"]
REFERENCES = ["none", "same-geometry", "fixed-geometry(45,0)", "fixed-geometry(-8.1,0)", "fixed-geometry(89.9,-45)"]
RAD = pi / 180
LN2 = log(mpf(2))
HEADER = (
    "theta_i_deg,phi_i_deg,theta_v_deg,phi_v_deg,distribution,denominator,reference,roughness,refractive_index,"
    "phi_rad,D,G,F,over,term,by_roughness,by_roughness_terms,by_index,by_index_terms"
)


def polar(theta_deg):
    """Sine and cosine of a polar angle; at 90 degrees from inside."""
    theta = mpf(theta_deg) if theta_deg != 90.0 else mpf(90) - mpf(10) ** -70
    return sin(theta * RAD), cos(theta * RAD)


def distribution(name, phi, r):
    """D, d ln D/dr and the sum of the absolute values of its terms."""
    if name == "beckmann":
        u = (tan(phi) / r) ** 2
        return exp(-u) / (pi * r**2 * cos(phi) ** 4), (2 * u - 2) / r, (2 * u + 2) / r
    if name == "trowbridge-reitz":
        along = (r * cos(phi)) ** 2
        q = sin(phi) ** 2 + along
        return r**2 / (pi * q**2), (2 - 4 * along / q) / r, (2 + 4 * along / q) / r
    if name == "gaussian-normalised":
        u, (over_square, by_log_width) = (phi / r) ** 2, norm(r)
        return exp(-u) / (over_square * r**2), (2 * u - by_log_width) / r, (2 * u + by_log_width) / r
    u = {
        "gaussian-half-height": LN2 * (phi / r) ** 2,
        "gaussian": (phi / r) ** 2,
        "torrance-sparrow-1967": (degrees(phi) / r) ** 2,
    }[name]
    return exp(-u), 2 * u / r, 2 * u / r


def fresnel(c, n):
    """F, dF/dn and the sum of the absolute values of its terms."""
    g = sqrt(n**2 - 1 + c**2)
    a = (g - c) / (g + c)
    b = (c * (g + c) - 1) / (c * (g - c) + 1)
    first = a * 2 * c / (g + c) ** 2 * (1 + b**2)
    second = a**2 * b * 2 * c * (1 - c**2) / (c * (g - c) + 1) ** 2
    return a**2 * (1 + b**2) / 2, (first + second) * n / g, (abs(first) + abs(second)) * n / g


def row(geometry, name, denominator, reference, roughness, index):
    ti, azimuth_i, tv, azimuth_v = geometry
    (si, ci), (sv, cv) = polar(ti), polar(tv)
    # Azimuths that differ by 180 degrees exactly are exactly opposite, not to 100 digits.
    difference = mpf(azimuth_i) - mpf(azimuth_v)
    opposite = abs(difference) == 180
    ux, uy = (mpf(-1), mpf(0)) if opposite else (cos(difference * RAD), sin(difference * RAD))
    across = sqrt((sv + si * ux) ** 2 + (si * uy) ** 2)
    along = ci + cv
    length = sqrt(across**2 + along**2)
    phi, cos_phi, c = atan2(across, along), along / length, length / 2
    g = min(mpf(1), 2 * cos_phi * cv / c, 2 * cos_phi * ci / c)
    r, n = mpf(roughness), mpf(index)
    d, slope, slope_terms = distribution(name, phi, r)
    f, f_n, f_n_terms = fresnel(c, n)
    den = {"cos-theta-i": ci, "cos-theta-v": cv, "cos-i-cos-v": ci * cv}[denominator]
    lit = {"none": mpf(1), "same-geometry": ci}.get(reference)
    if lit is None:
        lit = cos(mpf(float(reference.split("(")[1].split(",")[0])) * RAD)
    over = g * f / den / lit
    if 90.0 in (ti, tv):  # what is left of the way to the limit
        g, over = (x if x > mpf(10) ** -50 else mpf(0) for x in (g, over))
    term = d * over
    values = [phi, d, g, f, over, term, term * slope, slope_terms, term * f_n / f, f_n_terms / f]
    inputs = [repr(x) for x in geometry] + [name, denominator, f'"{reference}"', repr(roughness), repr(index)]
    print(",".join(inputs + [mp.nstr(v, 18) for v in values]))


def azimuths(rng):
    return rng.choice([0.0, 20.1, 77.7, 123.4, 170.3, 179.9999999999999, rng.uniform(0, 180)])


def geometry(rng):
    kind = rng.randrange(9)
    eps = 10.0 ** rng.uniform(-12, 0)
    ti, azimuth = rng.uniform(0.1, 89.5), azimuths(rng)
    side = rng.choice([0.0, eps])
    if kind == 0:  # anywhere
        return ti, rng.uniform(0, 359.9), rng.uniform(0.1, 89.5), rng.uniform(0, 359.9)
    if kind == 1:  # at and next to the mirror direction
        return ti, azimuth + 180.0, ti + rng.choice([0, eps if ti + eps < 90 else -eps]), azimuth + side
    if kind == 2:  # at and next to the retro direction
        return ti, azimuth, max(ti - rng.choice([0, eps]), 0.0), azimuth + side
    if kind == 3:  # incidence grazes
        return 90.0 - eps, azimuth + 180.0, rng.uniform(0, 89), azimuth + side
    if kind == 4:  # viewing grazes
        return rng.uniform(0, 89), azimuth + 180.0, 90.0 - eps, azimuth + side
    if kind == 5:  # both graze, next to the mirror direction
        return 90.0 - eps, azimuth + 180.0, 90.0 - eps * rng.choice([1.0, 2.0]), azimuth + side
    if kind == 6:  # both graze, anywhere, and next to the retro direction
        return 90.0 - eps, azimuth, 90.0 - 10.0 ** rng.uniform(-12, 0), rng.choice([azimuth + side, 180.0 * rng.random()])
    if kind == 7:  # one at 90 degrees
        return rng.choice([(90.0, azimuth + 180.0, ti, azimuth), (ti, azimuth, 90.0, azimuth + side)])
    return rng.choice([0.0, eps]), azimuth, rng.choice([0.0, eps, 40.0]), rng.uniform(0, 359.9)  # next to the normal


def roughness(rng, name, phi_deg):
    """Ordinary; tiny and huge; or such that D is next to the smallest normal number."""
    unit = 57.29577951308232 if name == "torrance-sparrow-1967" else 1.0
    kind = rng.randrange(8)
    if kind < 5:
        return unit * 10.0 ** rng.uniform(-3, 0.3)
    if kind == 5:
        return unit * 10.0 ** rng.uniform(-9, -3)
    if kind == 6:
        return unit * 10.0 ** rng.uniform(0, 6)
    return unit * max(phi_deg, 1e-3) / 57.29577951308232 / rng.uniform(25.0, 27.5)


def main():
    seed, count = (int(sys.argv[1]), int(sys.argv[2])) if len(sys.argv) > 2 else (20260101, 2700)
    rng = random.Random(seed)
    print("# Right to 60 digits, printed to 18; made by make.py")
    print(HEADER)
    for i in range(count):
        name, denominator, reference = DISTRIBUTIONS[i % 6], DENOMINATORS[(i // 6) % 3], REFERENCES[(i // 18) % 5]
        where = [min(angle, 359.9999999999999) for angle in geometry(rng)]
        if reference == "same-geometry" and where[0] == 90.0:
            reference = "none"  # grows without bound
        in_plane = abs(where[0] - where[2]) / 2 if abs(where[1] - where[3]) > 90 else (where[0] + where[2]) / 2
        index = 1.0 + 10.0 ** rng.choice([rng.uniform(-12, -3), rng.uniform(-1, 0.3), rng.uniform(0, 3)])
        row(where, name, denominator, reference, roughness(rng, name, in_plane), index)


main()
