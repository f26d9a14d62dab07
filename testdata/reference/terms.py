"""Makes terms.csv: D, G, F, the specular term and its derivatives in 60-digit arithmetic (mpmath).

The formulation is the textbook one with vectors, on purpose another than the code's: at 60 digits its cancellations
cost nothing. Every input is an IEEE double and is taken as exact. Run: python3 terms.py > terms.csv
"""

import random

from gaussian_integral import integral
from mpmath import mp, mpf, asin, atan2, cos, degrees, exp, log, pi, sin, sqrt, tan

mp.dps = 120  # after the import, which sets its own; 60 are left where the textbook form cancels
DISTRIBUTIONS = ["gaussian-half-height", "gaussian", "torrance-sparrow-1967", "beckmann", "trowbridge-reitz"]
NORMS = {}
DENOMINATORS = ["cos-theta-i", "cos-theta-v", "cos-i-cos-v"]


def vector(theta_deg, phi_deg):
    theta, phi = mpf(theta_deg) * pi / 180, mpf(phi_deg) * pi / 180
    return [sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta)]


def distribution(name, phi, r):
    """D, dD/dr and the sum of the absolute values of the terms of dD/dr."""
    if name == "gaussian-half-height":
        u = log(mpf(2)) * (phi / r) ** 2
        d = exp(-u)
        return d, d * 2 * u / r, d * 2 * u / r
    if name == "gaussian":
        u = (phi / r) ** 2
        d = exp(-u)
        return d, d * 2 * u / r, d * 2 * u / r
    if name == "torrance-sparrow-1967":
        u = (degrees(phi) / r) ** 2
        d = exp(-u)
        return d, d * 2 * u / r, d * 2 * u / r
    if name == "gaussian-normalised":
        if r not in NORMS:
            n = integral(r, 0)
            NORMS[r] = (n * r**2, 2 * integral(r, 2) / n)
        u, (norm, slope) = (phi / r) ** 2, NORMS[r]
        d = exp(-u) / norm
        return d, d * (2 * u - slope) / r, d * (2 * u + slope) / r
    if name == "beckmann":
        u = (tan(phi) / r) ** 2
        d = exp(-u) / (pi * r**2 * cos(phi) ** 4)
        return d, d * (2 * u - 2) / r, d * (2 * u + 2) / r
    q = sin(phi) ** 2 + r**2 * cos(phi) ** 2
    d = r**2 / (pi * q**2)
    share = 4 * r**2 * cos(phi) ** 2 / q
    return d, d * (2 - share) / r, d * (2 + share) / r


def fresnel(c, n):
    g = sqrt(n**2 - 1 + c**2)
    a = (g - c) / (g + c)
    b = (c * (g + c) - 1) / (c * (g - c) + 1)
    value = a**2 * (1 + b**2) / 2
    a_g = 2 * c / (g + c) ** 2
    b_g = 2 * c * (1 - c**2) / (c * (g - c) + 1) ** 2
    first, second = a * a_g * (1 + b**2), a**2 * b * b_g
    return value, (first + second) * n / g, (abs(first) + abs(second)) * n / g


def row(ti, pi_, tv, pv, name, denominator, r, n):
    light, view = vector(ti, pi_), vector(tv, pv)
    total = [a + b for a, b in zip(light, view)]
    length = sqrt(sum(x * x for x in total))
    across = sqrt(total[0] ** 2 + total[1] ** 2)
    across = across if across > mpf(10) ** -60 else mpf(0)  # exactly the mirror direction
    phi = atan2(across, total[2])
    cos_phi, c = total[2] / length, length / 2
    ci, cv = light[2], view[2]
    g = min(mpf(1), 2 * cos_phi * cv / c, 2 * cos_phi * ci / c)
    d, d_r, d_r_scale = distribution(name, phi, mpf(r))
    f, f_n, f_n_scale = fresnel(c, mpf(n))
    den = {"cos-theta-i": ci, "cos-theta-v": cv, "cos-i-cos-v": ci * cv}[denominator]
    values = [phi, d, g, f, d * g * f / den, d_r * g * f / den, d_r_scale * g * f / den, d * g * f_n / den,
              d * g * f_n_scale / den]
    inputs = [repr(x) for x in (ti, pi_, tv, pv)] + [name, denominator, repr(r), repr(n)]
    print(",".join(inputs + [mp.nstr(v, 20) for v in values]))


def geometry(rng):
    kind = rng.randrange(6)
    eps = 10.0 ** rng.uniform(-12, 0)
    ti, azimuth = rng.uniform(0.1, 89.5), rng.choice([0.0, 20.1, 77.7, 123.4, 170.3])
    if kind == 0:  # anywhere
        return ti, rng.uniform(0, 359.9), rng.uniform(0.1, 89.5), rng.uniform(0, 359.9)
    if kind == 1:  # next to the mirror direction
        return ti, azimuth + 180.0, ti + rng.choice([0, eps if ti + eps < 90 else -eps]), azimuth + rng.choice([0, eps])
    if kind == 2:  # next to the retro direction
        return ti, azimuth, max(ti - eps, 0.0), azimuth + rng.choice([0, eps])
    if kind == 3:  # incidence grazes
        return 90.0 - eps, azimuth + 180.0, rng.uniform(0, 89), azimuth
    if kind == 4:  # both graze, next to the mirror direction
        return 90.0 - eps, azimuth + 180.0, 90.0 - eps * rng.choice([1.0, 2.0]), azimuth + rng.choice([0, eps])
    return rng.choice([0.0, eps]), azimuth, rng.choice([0.0, eps, 40.0]), rng.uniform(0, 359.9)  # next to the normal


def main():
    rng = random.Random(20260101)
    print("# 60-digit reference values made by terms.py; phi in rad, D and derivatives per unit of the roughness")
    print("theta_i_deg,phi_i_deg,theta_v_deg,phi_v_deg,distribution,denominator,roughness,refractive_index,"
          "phi_rad,D,G,F,term,by_roughness,by_roughness_scale,by_index,by_index_scale")
    for i in range(1500):
        name, denominator = DISTRIBUTIONS[i % 5], DENOMINATORS[(i // 5) % 3]
        r = 10.0 ** rng.uniform(-3, 0.3) * (57.0 if name == "torrance-sparrow-1967" else 1.0)
        n = 1.0 + 10.0 ** rng.choice([rng.uniform(-12, -3), rng.uniform(-1, 0.3)])
        row(*geometry(rng), name, denominator, r, n)
    rng = random.Random(20260103)
    for i in range(150):
        n = 1.0 + 10.0 ** rng.choice([rng.uniform(-12, -3), rng.uniform(-1, 0.3)])
        row(*geometry(rng), "gaussian-normalised", DENOMINATORS[i % 3], 10.0 ** rng.uniform(-3, 0.3), n)


main()
