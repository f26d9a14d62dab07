"""Makes gaussian_integral.csv: N(w), the integral of exp(-phi^2/w^2) cos(phi) over the hemisphere, and d(ln N)/d(ln w).

60-digit arithmetic (mpmath): adaptive quadrature in pieces of the width, on purpose neither the series nor the rule of
the code. Every width is an IEEE double and is taken as exact. Run: python3 gaussian_integral.py > gaussian_integral.csv
"""

import random

from mpmath import exp, mp, mpf, pi, quad, sin

mp.dps = 60


def integral(w, moment):
    """N / w^2 of the integrand times (phi/w)^moment, over x = phi/w, up to where nothing of 60 digits is left."""
    last = min(pi / 2 / w, 14)
    pieces = [last * k / 12 for k in range(13)]
    # mpmath asks for an absolute error: the integrand must not be small.
    scale = min(w, 1 / w)
    return pi * quad(lambda x: x**moment * exp(-x * x) * sin(2 * w * x) / scale, pieces) * scale / w


def main():
    print("# 60-digit reference values made by gaussian_integral.py; the width in rad")
    print("width,integral,by_log_width")
    rng = random.Random(20260102)
    widths = [1e-150, 1e-12, 1e-6, 0.25, 0.2500000001, 0.3, 1.0, 3.0, 1e6]
    widths += [10.0 ** rng.uniform(-3, 1) for _ in range(190)]
    for width in widths:
        w = mpf(width)
        n = integral(w, 0)
        print(f"{width!r},{mp.nstr(n * w**2, 20)},{mp.nstr(2 * integral(w, 2) / n, 20)}")


if __name__ == "__main__":
    main()
