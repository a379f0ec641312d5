"""scipy's RBFInterpolator for palpate-bench (peer_scipy.cpp starts it).

peer_scipy.py FOLDER REPETITIONS

FOLDER/train.csv   d normalised features, force, remainder, left_out (0 or 1)
FOLDER/test.csv    d normalised features
Selects the setting with the least RMS error on the left-out rows when fitted to
the others. Predictions go to FOLDER/<name>_<target>.csv; stdout gets one JSON
list of {name, target, setting, fit_s, query_s}, medians over REPETITIONS without
imports.
"""

import json
import sys
import time

import numpy as np
from scipy.interpolate import RBFInterpolator

QUERIES = 200  # a repetition

# The cubic kernel with a linear tail, as in Palpate; smoothing 0 interpolates. With
# neighbours, scipy solves a small system at each query.
PEERS = {
    "scipy_all_sites": [dict(kernel="cubic", degree=1, smoothing=s) for s in (0.0, 1e-4, 1e-3, 1e-2)],
    "scipy_50_neighbours": [
        dict(kernel="cubic", degree=1, smoothing=s, neighbors=50) for s in (0.0, 1e-4, 1e-3, 1e-2)
    ],
}


def rms_left_out(points, values, left_out, setting):
    try:
        fitted = RBFInterpolator(points[~left_out], values[~left_out], **setting)
        return np.sqrt(np.mean((fitted(points[left_out]) - values[left_out]) ** 2))
    except np.linalg.LinAlgError:
        return np.inf


def median_query_s(fitted, points):
    times = []
    for point in points[:: max(1, len(points) // QUERIES)][:QUERIES]:
        start = time.perf_counter()
        fitted(point[None, :])
        times.append(time.perf_counter() - start)
    return np.median(times)


def main(folder, repetitions):
    train = np.loadtxt(folder + "/train.csv", delimiter=",", ndmin=2)
    test = np.loadtxt(folder + "/test.csv", delimiter=",", ndmin=2)
    points, left_out = np.ascontiguousarray(train[:, :-3]), train[:, -1] > 0.5
    results = []
    for name, settings in PEERS.items():
        for target, values in (("forces", train[:, -3]), ("remainder", train[:, -2])):
            setting = min(settings, key=lambda s: rms_left_out(points, values, left_out, s))
            fit_s, query_s = [], []
            for _ in range(repetitions):
                start = time.perf_counter()
                fitted = RBFInterpolator(points, values, **setting)
                fit_s.append(time.perf_counter() - start)
                query_s.append(median_query_s(fitted, test))
            np.savetxt(f"{folder}/{name}_{target}.csv", fitted(test), fmt="%.17g")
            text = ", ".join(f"{key} {value}" for key, value in setting.items())
            times = dict(fit_s=np.median(fit_s), query_s=np.median(query_s))
            results.append(dict(name=name, target=target, setting=text, **times))
    print(json.dumps(results))


main(sys.argv[1], int(sys.argv[2]))
