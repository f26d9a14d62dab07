"""Makes gaussian_integral.csv: N(w), the integral of exp(-phi^2/w^2) cos(phi) over the hemisphere, and d(ln N)/d(ln w).

Multiple-precision arithmetic (mpmath) and the closed form by the error function of a complex argument, on purpose neither
the series nor the rule of the code. Every width is an IEEE double and is taken as exact.

    python3 gaussian_integral.py > gaussian_integral.csv
    python3 gaussian_integral.py --check     the same by adaptive quadrature, and the largest difference
"""

import random
import sys

from mpmath import erf, erfi, exp, mp, mpc, mpf, pi, quad, sin, sqrt, workdps


def norm(w):
    """N / w^2 and d(ln N)/d(ln w), to 60 digits and more for widths from 0 to 1e8 rad.

    N = pi times the imaginary part of the integral of exp(-phi^2/w^2 + 2 i phi) from 0 to pi/2, and the exponent is
    -(phi/w - i w)^2 - w^2.
    """
    with workdps(160):
        end = pi / 2 / w
        # The Gaussian has ended before pi/2: what is beyond is below 1e-250 of all.
        beyond = exp(-(end**2)) if end < 25 else mpf(0)
        if w < mpf(10) ** -3:
            # pi w F(w), Dawson's F by its series: the form below would lose two digits for each of w.
            over_square, part, k = mpf(0), mpf(1), 1
            while abs(part) > mpf(10) ** -150:
                over_square += pi * part
                part *= -2 * w**2 / (2 * k + 1)
                k += 1
        else:
            ends = erfi(w) + (erf(mpc(end, -w)).imag if end < 25 else 0)
            over_square = pi * sqrt(pi) / 2 * exp(-(w**2)) * ends / w
        by_log_width = 1 - 2 * w**2 + pi * (1 + beyond) / over_square
        return +over_square, +by_log_width


def by_quadrature(w):
    """The same by adaptive quadrature in pieces of the width, over x = phi/w, up to where nothing of 60 digits is left."""

    def integral(moment):
        last = min(pi / 2 / w, 14)
        pieces = [last * k / 12 for k in range(13)]
        # mpmath asks for an absolute error: the integrand must not be small.
        scale = min(w, 1 / w)
        return pi * quad(lambda x: x**moment * exp(-x * x) * sin(2 * w * x) / scale, pieces) * scale / w

    with workdps(60):
        n = integral(0)
        return n, 2 * integral(2) / n


def widths():
    rng = random.Random(20260102)
    some = [1e-150, 1e-12, 1e-6, 0.25, 0.2500000001, 0.3, 1.0, 3.0, 1e6]
    return some + [10.0 ** rng.uniform(-3, 1) for _ in range(190)]


def main():
    mp.dps = 60
    if sys.argv[1:] == ["--check"]:
        pairs = ((norm(mpf(width)), by_quadrature(mpf(width))) for width in widths())
        worst = max(abs(a / b - 1) for first, second in pairs for a, b in zip(first, second))
        print(f"{len(widths())} widths: largest relative difference {mp.nstr(worst, 3)}")
        return
    print("# 60-digit reference values made by gaussian_integral.py; the width in rad")
    print("width,integral,by_log_width")
    for width in widths():
        w = mpf(width)
        over_square, by_log_width = norm(w)
        print(f"{width!r},{mp.nstr(over_square * w**2, 20)},{mp.nstr(by_log_width, 20)}")


if __name__ == "__main__":
    main()
