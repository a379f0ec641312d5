"""Writes rbf_scipy.json: fits and values of scipy.interpolate.RBFInterpolator.

    python3 tests/golden/rbf_scipy.py > tests/golden/rbf_scipy.json

scipy solves eq. 4 of Hoever & Harders (2009) by LU, with the smoothing on the
diagonal and the tail's variables shifted and scaled to [-1, 1]; `tail` here is
converted to coefficients of 1, x_1 ... x_d. Its kernels have the sign that makes
them conditionally positive definite (linear -r), and its weights have it too. The
points are short decimals, so that the file stores them exactly.
"""

import json

import numpy as np
import scipy
from scipy.interpolate import RBFInterpolator

KERNELS = {"cubic": ("cubic", 1, 1.0), "linear": ("linear", 0, -1.0),
           "thin-plate": ("thin_plate_spline", 1, 1.0)}


def plain_tail(fit, degree, dimension):
    """Coefficients of 1 for degree 0, of 1, x_1 ... x_d for degree 1."""
    powers = [tuple(row) for row in fit.powers]
    scaled = {power: value for power, value in zip(powers, fit._coeffs[-len(powers):, 0])}
    tail = [scaled[(0,) * dimension]]
    if degree == 1:
        for k in range(dimension):
            unit = tuple(int(j == k) for j in range(dimension))
            slope = scaled[unit] / fit._scale[k]
            tail.append(slope)
            tail[0] -= slope * fit._shift[k]
    return [float(value) for value in tail]


def main():
    random = np.random.default_rng(20091)
    cases = []
    for name, (scipy_name, degree, sign) in KERNELS.items():
        for dimension in (1, 4):
            points = np.round(random.uniform(-1, 1, (60, dimension)), 4)
            forces = np.round(1.5 + np.exp(points[:, 0]) + 0.3 * np.sin(2 * points.sum(axis=1))
                              + 0.05 * random.normal(size=60), 4)
            queries = np.round(random.uniform(-1.2, 1.2, (20, dimension)), 4)
            for smoothing in (0.0, 0.01):
                fit = RBFInterpolator(points, forces, kernel=scipy_name, degree=degree, smoothing=smoothing)
                cases.append({
                    "kernel": name, "smoothing": smoothing, "points": points.tolist(),
                    "forces": forces.tolist(), "queries": queries.tolist(),
                    "weights": [float(sign * w) for w in fit._coeffs[:60, 0]],
                    "tail": plain_tail(fit, degree, dimension),
                    "values": fit(queries).tolist()})
    print(json.dumps({"scipy": scipy.__version__, "cases": cases}, indent=None, separators=(",", ":")))


if __name__ == "__main__":
    main()
