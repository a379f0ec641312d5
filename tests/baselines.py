"""Standard models of scikit-learn, the baselines of labs.py: what one would fit without Palpate.

GP      a Gaussian process: Matern 3/2 kernel, mean of a cubic polynomial of the depth, at most 1500 rows
forest  100 regression trees (as Cha, Bhardwaj, Park & Choi, AsiaHaptics 2018), at most 3000 rows
ridge   a linear regression on powers of the depth, the memories below, and their products with the depth

All have the same columns: depth, velocity, seven low-passes of the depth, three play operators, and the greatest depth
so far; rows count by 1/JND; and cross-validation over the folds of Palpate's fit, with 600 of the rows, sets what a
manual leaves open. Needs python3-sklearn.
"""
import csv

import numpy
from sklearn.ensemble import RandomForestRegressor
from sklearn.gaussian_process import GaussianProcessRegressor
from sklearn.gaussian_process.kernels import Matern
from sklearn.linear_model import LinearRegression, Ridge
from sklearn.preprocessing import StandardScaler

TIMES_S = 0.01 * 10 ** (numpy.arange(7) / 2)
THRESHOLDS = numpy.array([0.05, 0.15, 0.4])  # of the play operators, relative to the greatest depth
SPEED_S = 0.02  # of the low-pass before the velocity
TUNED_ROWS = 600
UNNOTICED = 0.25  # of the score of a fold, as in models/METHOD.md


def jnd(force):
    return 0.065 + 0.0633 * numpy.abs(force)


class Recording:
    """Time, position from the surface of the model, and force from that of free air, and which samples count, all as in
    `palpate replay`."""

    def __init__(self, path, surface_m=0.0, force_zero_N=0.0):
        with open(path, newline="") as file:
            rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
        self.time, self.position, self.force = (
            numpy.array([float(row[name]) for row in rows]) for name in ("time_s", "position_m", "force_N"))
        self.force -= force_zero_N
        self.recorded_m, self.position = self.position, self.position - surface_m
        self.known = {}  # columns by greatest depth

    def contact(self):
        return self.position > 0.0

    def columns(self, greatest_m):
        """One row a sample; lengths relative to the greatest depth of the training."""
        if greatest_m not in self.known:
            self.known[greatest_m] = self.columns_at(greatest_m)
        return self.known[greatest_m]

    def columns_at(self, greatest_m):
        depths = numpy.maximum(0.0, self.position) / greatest_m
        steps_s = numpy.diff(self.time, prepend=self.time[0] - 1e-3)
        shares = 1.0 - numpy.exp(-steps_s[:, None] / numpy.append(TIMES_S, SPEED_S))
        slow, plays, most = numpy.full(len(TIMES_S) + 1, depths[0]), numpy.zeros(len(THRESHOLDS)), depths[0]
        rows = numpy.empty((len(depths), 2 + len(TIMES_S) + len(THRESHOLDS) + 1))
        for row, depth, share, step_s in zip(rows, depths, shares, steps_s):
            change = share * (depth - slow)
            slow = slow + change
            plays = numpy.minimum(numpy.maximum(plays, depth - THRESHOLDS), depth + THRESHOLDS)
            most = max(most, depth)
            row[:] = [depth, change[-1] / step_s, *slow[:-1], *plays, most]
        return rows

    def strokes(self):
        """The rows of each contact."""
        rows = numpy.flatnonzero(self.contact())
        return numpy.split(rows, numpy.flatnonzero(numpy.diff(rows) > 1) + 1) if len(rows) else []


def folds_of(recordings):
    """A fold for each row in contact: recordings, or pieces of at most a tenth of them."""
    if len(recordings) >= 3:
        return numpy.concatenate([numpy.full(one.contact().sum(), i % 6) for i, one in enumerate(recordings)])
    longest = sum(one.contact().sum() for one in recordings) // 10 + 1
    pieces = [len(stroke[at:at + longest]) for one in recordings for stroke in one.strokes()
              for at in range(0, len(stroke), longest)]
    return numpy.repeat(numpy.arange(len(pieces)) % 5, pieces)


class GaussianProcess:
    ROWS = 1500
    CANDIDATES = [(length, noise) for length in (2.0, 5.0, 12.0) for noise in (0.1, 0.5)]

    def __init__(self, x, y, length, noise):
        self.mean = LinearRegression().fit(self.cubic(x), y, 1.0 / jnd(y) ** 2)
        rest = y - self.mean.predict(self.cubic(x))
        self.scaler = StandardScaler().fit(x)
        kernel = max(rest.std(), 1e-3) ** 2 * Matern(length, "fixed", 1.5)
        self.process = GaussianProcessRegressor(kernel, alpha=(noise * jnd(y)) ** 2, optimizer=None)
        self.process.fit(self.scaler.transform(x), rest)

    def cubic(self, x):
        return x[:, :1] ** [1, 2, 3]

    def predict(self, x):
        return self.mean.predict(self.cubic(x)) + self.process.predict(self.scaler.transform(x))


class Forest:
    ROWS = 3000
    CANDIDATES = [(2,), (8,)]

    def __init__(self, x, y, leaf):
        self.trees = RandomForestRegressor(100, min_samples_leaf=leaf, random_state=1)
        self.trees.fit(x, y, 1.0 / jnd(y) ** 2)

    def predict(self, x):
        return self.trees.predict(x)


class LinearRidge:
    ROWS = 20000
    CANDIDATES = [(10.0 ** decade,) for decade in range(-4, 3)]

    def __init__(self, x, y, penalty):
        self.scaler = StandardScaler().fit(self.terms(x))
        weights = 1.0 / jnd(y) ** 2
        self.line = Ridge(penalty).fit(self.scaler.transform(self.terms(x)), y, weights / weights.mean())

    def terms(self, x):
        return numpy.hstack([x[:, :1] ** numpy.arange(1, 7), x[:, 1:], x[:, :1] * x[:, 1:]])

    def predict(self, x):
        return self.line.predict(self.scaler.transform(self.terms(x)))


KINDS = {"GP": GaussianProcess, "forest": Forest, "ridge": LinearRidge}


class Baseline:
    def __init__(self, kind, recordings, greatest_m):
        self.greatest_m = greatest_m
        x = numpy.concatenate([one.columns(greatest_m)[one.contact()] for one in recordings])
        y = numpy.concatenate([one.force[one.contact()] for one in recordings])
        kept = slice(None, None, -(-len(y) // kind.ROWS))
        x, y, fold = x[kept], y[kept], folds_of(recordings)[kept]

        few = slice(None, None, -(-len(y) // TUNED_ROWS))
        parts = [(few_x[few_fold != k], few_y[few_fold != k], few_x[few_fold == k], few_y[few_fold == k])
                 for few_x, few_y, few_fold in [(x[few], y[few], fold[few])] for k in numpy.unique(few_fold)]

        def score(candidate):
            errors = [(kind(*train, *candidate).predict(left_x) - left_y) / jnd(left_y) for *train, left_x, left_y in parts]
            return sum(numpy.log((one ** 2).mean() + UNNOTICED ** 2) for one in errors)
        self.model = kind(x, y, *min(kind.CANDIDATES, key=score))

    def forces(self, recording):
        return self.model.predict(recording.columns(self.greatest_m))
