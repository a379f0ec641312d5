"""Writes nnls_scipy.json: solutions of scipy.optimize.nnls.

    python3 tests/golden/nnls_scipy.py > tests/golden/nnls_scipy.json

Each case is min |A x - b|, x >= 0. The file contains the normal equations
A^T A and A^T b (the input of the solver), and scipy's x and residual.
"""

import json

import numpy as np
import scipy
from scipy.optimize import nnls


def main():
    random = np.random.default_rng(1974)
    cases = []
    for rows, columns in ((12, 3), (40, 8), (200, 18), (60, 21)):
        for kind in ("any", "correlated"):
            matrix = random.normal(size=(rows, columns))
            if kind == "correlated":
                matrix = np.abs(matrix) + 2.0 * random.uniform(size=(rows, 1))
            right = matrix @ np.maximum(0.0, random.normal(size=columns)) + 0.3 * random.normal(size=rows)
            x, residual = nnls(matrix, right)
            cases.append({"gram": (matrix.T @ matrix).tolist(), "right_side": (matrix.T @ right).tolist(),
                          "squares": float(right @ right), "x": x.tolist(), "residual": float(residual)})
    print(json.dumps({"scipy": scipy.__version__, "cases": cases}, indent=None, separators=(",", ":")))


if __name__ == "__main__":
    main()
