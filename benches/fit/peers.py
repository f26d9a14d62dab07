"""SciPy, lmfit and Ceres on the scans that the Rust bench wrote: a vectorised model with its exact Jacobian, random starts.

Usage: peers.py SCANS.json. Prints, per program, the time of a fit and the share of right answers: chi-square within one unit
of chi-square per degree of freedom of the best known, which the bench wrote beside each scan.
"""

import json
import sys
import time

import numpy as np
from scipy.optimize import least_squares

LN2 = np.log(2.0)
LOW = np.array([0, 0, np.log(2e-3), np.log(1e-3)])
HIGH = np.array([np.inf, np.inf, np.log(3), np.log(5)])
SEVERAL = 10


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


class Problem:
    def __init__(self, scan, half):
        self.y, self.w, self.half = np.array(scan["values"]), 1 / np.array(scan["sigma"]), half

    def residual(self, p):
        return (p[0] * self.half["diffuse"] + p[1] * columns(p, self.half)[0] - self.y) * self.w

    def jacobian(self, p):
        shape, by_r, by_m = columns(p, self.half)
        rows = [self.half["diffuse"], shape, p[1] * by_r, p[1] * by_m]
        return np.column_stack([row * self.w for row in rows])


def scipy_lm(problem, starts):
    return 2 * least_squares(problem.residual, starts[0], jac=problem.jacobian, method="lm", x_scale="jac").cost


def trf(problem, start):
    result = least_squares(
        problem.residual, start, jac=problem.jacobian, method="trf", x_scale="jac", bounds=(LOW, HIGH))
    return 2 * result.cost


def scipy_trf(problem, starts):
    return trf(problem, starts[0])


def scipy_trf_several(problem, starts):
    return min(trf(problem, start) for start in starts)


def lmfit_leastsq(problem, starts):
    import lmfit

    names = ["albedo", "intensity", "log_roughness", "log_index"]
    parameters = lmfit.Parameters()
    for name, value, low, high in zip(names, starts[0], LOW, HIGH):
        parameters.add(name, value=value, min=low, max=high)
    values = lambda found: np.array([found[name].value for name in names])
    # Its bounds change the parameters, and with them the Jacobian: it takes differences.
    found = lmfit.minimize(lambda p: problem.residual(values(p)), parameters, method="leastsq")
    return found.chisqr


def make_ceres():
    import pyceres

    class Cost(pyceres.CostFunction):
        def __init__(self, problem):
            super().__init__()
            self.problem = problem
            self.set_num_residuals(len(problem.y))
            self.set_parameter_block_sizes([4])

        def Evaluate(self, parameters, residuals, jacobians):
            p = np.array(parameters[0])
            residuals[:] = self.problem.residual(p)
            if jacobians is not None and jacobians[0] is not None:
                jacobians[0][:] = self.problem.jacobian(p).ravel()
            return bool(np.all(np.isfinite(residuals)))

    def ceres(problem, starts):
        p = np.array(starts[0])
        whole = pyceres.Problem()
        cost = Cost(problem)
        whole.add_residual_block(cost, None, [p])
        for k in range(4):
            whole.set_parameter_lower_bound(p, k, LOW[k])
            if np.isfinite(HIGH[k]):
                whole.set_parameter_upper_bound(p, k, HIGH[k])
        options = pyceres.SolverOptions()
        options.minimizer_progress_to_stdout = False
        options.logging_type = pyceres.LoggingType.SILENT
        options.max_num_iterations = 200
        summary = pyceres.SolverSummary()
        pyceres.solve(options, whole, summary)
        return 2 * summary.final_cost

    return ceres


def run(name, fit, scans, half, starts):
    right, times = 0, []
    for scan, start in zip(scans, starts):
        problem = Problem(scan, half)
        begin = time.perf_counter()
        try:
            with np.errstate(all="ignore"):
                chi_square = fit(problem, start)
        except (ValueError, FloatingPointError, np.linalg.LinAlgError):
            chi_square = np.inf
        times.append(time.perf_counter() - begin)
        right += chi_square <= scan["best"] * (1 + 1 / (len(problem.y) - 4))
    low, median, high = np.percentile(times, [10, 50, 90]) * 1e6
    print(f"   {name}: {median:.0f} us [{low:.0f} .. {high:.0f}]; right {right} of {len(scans)}")


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        data = json.load(file)
    half = {name: np.array(values) for name, values in data["geometry"].items()}
    rng = np.random.default_rng(3)
    shape = (len(data["scans"]), SEVERAL)
    starts = np.stack([
        np.exp(rng.uniform(np.log(0.05), np.log(1.5), shape)), np.exp(rng.uniform(np.log(0.1), np.log(100), shape)),
        rng.uniform(np.log(0.005), np.log(1), shape), rng.uniform(np.log(0.05), np.log(1.5), shape)], axis=-1)
    programs = {
        "SciPy least_squares(lm), one random start": lambda: scipy_lm,
        "SciPy least_squares(trf), one random start": lambda: scipy_trf,
        f"the same, best of {SEVERAL} random starts": lambda: scipy_trf_several,
        "lmfit (leastsq), one random start": lambda: lmfit_leastsq,
        "Ceres (pyceres), one random start": make_ceres,
    }
    for name, make in programs.items():
        try:
            fit = make()
        except ImportError as error:
            print(f"   {name}: not measured ({error})")
            continue
        run(name, fit, data["scans"], half, starts)


main()
