"""SciPy's least_squares on the scans that the Rust bench wrote: a vectorised model with its exact Jacobian, random starts.

Usage: scipy_fit.py SCANS.json. Prints, per method, the median time of a fit and the share of right answers: chi-square
within one unit of the best known, which the bench wrote beside each scan.
"""

import json
import sys
import time

import numpy as np
from scipy.optimize import least_squares

LN2 = np.log(2.0)


def columns(p, half):
    """Specular shape with its derivatives in ln r and ln(n-1); half: phi, cos_q, sin2_q, masked."""
    r, m = np.exp(p[2]), np.exp(p[3])
    u = LN2 * (half["phi"] / r) ** 2
    d = np.exp(-u)
    c, s2 = half["cos_q"], half["sin2_q"]
    k = m * (2 + m)
    g = np.sqrt(k + c * c)
    a = k / (g + c) ** 2
    below = c * k / (g + c) + 1
    b = (c * g - s2) / below
    f = 0.5 * a * a * (1 + b * b)
    f_g = a * (2 * c / (g + c) ** 2 * (1 + b * b) + a * b * 2 * c * s2 / below**2)
    f_m = f_g * (1 + m) / g * m
    return d * f * half["masked"], 2 * u * d * f * half["masked"], d * f_m * half["masked"]


def run(method, scans, half, starts):
    right, times = 0, []
    for scan, start in zip(scans, starts):
        y, w = np.array(scan["values"]), 1 / np.array(scan["sigma"])

        def residual(p):
            return (p[0] * half["diffuse"] + p[1] * columns(p, half)[0] - y) * w

        def jacobian(p):
            shape, by_r, by_m = columns(p, half)
            return np.column_stack([half["diffuse"] * w, shape * w, p[1] * by_r * w, p[1] * by_m * w])

        extra = {} if method == "lm" else {
            "bounds": ([0, 0, np.log(2e-3), np.log(1e-3)], [np.inf, np.inf, np.log(3), np.log(5)])}
        begin = time.perf_counter()
        try:
            with np.errstate(all="ignore"):
                result = least_squares(residual, start, jac=jacobian, method=method, x_scale="jac", **extra)
            chi_square = 2 * result.cost
        except (ValueError, np.linalg.LinAlgError):
            chi_square = np.inf
        times.append(time.perf_counter() - begin)
        right += chi_square <= scan["best"] + 1
    quartiles = np.percentile(times, [25, 50, 75]) * 1e6
    print(f"SciPy least_squares({method}), random start: {quartiles[1]:.0f} us "
          f"[{quartiles[0]:.0f} .. {quartiles[2]:.0f}], right {right} of {len(scans)}")


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        data = json.load(file)
    half = {name: np.array(values) for name, values in data["geometry"].items()}
    rng = np.random.default_rng(3)
    count = len(data["scans"])
    starts = np.column_stack([
        np.exp(rng.uniform(np.log(0.05), np.log(1.5), count)), np.exp(rng.uniform(np.log(0.1), np.log(100), count)),
        rng.uniform(np.log(0.005), np.log(1), count), rng.uniform(np.log(0.05), np.log(1.5), count)])
    for method in ("lm", "trf"):
        run(method, data["scans"], half, starts)


main()
