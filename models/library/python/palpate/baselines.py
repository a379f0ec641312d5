"""Two simple estimators to compare with a fit.

`Bins` and `Ridge` are estimators on the columns of `features` (for `palpate.cross_validate`); `bins` and `ridge`
take training recordings and return the forces of a test recording.
"""
from typing import Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._models import jnd_N
from ._recordings import as_recording, as_recordings

DIRECTION_TIME_S = 0.02
LOWPASS_TIMES_S = (0.03, 0.1, 0.3, 1.0, 3.0)
PLAY_SHARES = (0.01, 0.02, 0.05, 0.1, 0.2, 0.35, 0.5)  # thresholds over the greatest depth
POWERS = 5
BINS = 60
PENALTY = 1e-6  # of a standardised column, over the number of samples


def features(recording: object, depth_m: Optional[float] = None) -> NDArray[np.float64]:
    """The inputs of the estimators at each sample.

    Parameters
    ----------
    recording : recording
    depth_m : float, optional
        Greatest depth of the training, to which thresholds are set [that of the recording].

    Returns
    -------
    ndarray, shape (n, d)
        Depth; its low-pass with 20 ms, whose difference to the depth has the sign of the direction; further
        low-passes; play operators with thresholds up to half of ``depth_m``; the greatest depth so far.
    """
    recording = as_recording(recording)
    depth = np.maximum(recording["position_m"], 0.0)
    depth_m = float(depth.max()) if depth_m is None else depth_m
    step_s = np.diff(recording["time_s"], prepend=recording["time_s"][0])
    decay = np.exp(-step_s[:, None] / np.array((DIRECTION_TIME_S, *LOWPASS_TIMES_S)))
    thresholds = depth_m * np.array(PLAY_SHARES)
    slow = np.empty(decay.shape)
    play = np.empty((len(depth), len(thresholds)))
    slow_now, play_now = np.full(decay.shape[1], depth[0]), np.zeros(len(thresholds))
    for i, now in enumerate(depth):
        slow_now = slow[i] = now + (slow_now - now) * decay[i]
        play_now = play[i] = np.minimum(np.maximum(play_now, now - thresholds), now + thresholds)
    return np.column_stack((depth, slow, play, np.maximum.accumulate(depth)))


class Bins:
    """The median force in 60 bins of the depth, separately for loading and unloading."""

    def fit(self, columns: ArrayLike, force_N: ArrayLike) -> "Bins":
        columns, force_N = np.asarray(columns), np.asarray(force_N)
        self.depth_m = max(float(columns[:, 0].max()), 1e-12)
        self.tables = []
        number, inward = self._places(columns)
        for way in (True, False):
            chosen = inward == way if (inward == way).any() else np.ones(len(inward), bool)
            filled = np.unique(number[chosen])
            medians = [np.median(force_N[chosen & (number == one)]) for one in filled]
            self.tables.append(np.interp(np.arange(BINS), filled, medians))
        return self

    def predict(self, columns: ArrayLike) -> NDArray[np.float64]:
        number, inward = self._places(np.asarray(columns))
        return np.where(inward, self.tables[0][number], self.tables[1][number])

    def _places(self, columns):
        number = np.minimum((columns[:, 0] * (BINS / self.depth_m)).astype(int), BINS - 1)
        return number, columns[:, 0] >= columns[:, 1]


class Ridge:
    """Ridge regression on powers of the depth and on all other columns, with errors divided by the JND."""

    def fit(self, columns: ArrayLike, force_N: ArrayLike) -> "Ridge":
        columns, force_N = np.asarray(columns), np.asarray(force_N)
        self.depth_m = max(float(columns[:, 0].max()), 1e-12)
        table = self._table(columns)
        self.mean, self.scale = table.mean(0), np.maximum(table.std(0), 1e-12)
        design = np.column_stack((np.ones(len(table)), (table - self.mean) / self.scale))
        weight = 1.0 / jnd_N(force_N)
        weighted = design * weight[:, None]
        normal = weighted.T @ weighted
        penalty = np.full(len(normal), PENALTY * float(np.sum(weight ** 2)))
        penalty[0] = 0.0
        self.coefficients = np.linalg.solve(normal + np.diag(penalty), weighted.T @ (force_N * weight))
        self.limits_N = min(0.0, float(force_N.min())), 1.2 * float(force_N.max())
        return self

    def predict(self, columns: ArrayLike) -> NDArray[np.float64]:
        table = (self._table(np.asarray(columns)) - self.mean) / self.scale
        return np.clip(self.coefficients[0] + table @ self.coefficients[1:], *self.limits_N)

    def _table(self, columns):
        depth = columns[:, :1] / self.depth_m
        return np.hstack((depth ** np.arange(1, POWERS + 1), columns[:, 1:] / self.depth_m))


def bins(train: object, test: object) -> NDArray[np.float64]:
    """The forces of `Bins` along a recording.

    Parameters
    ----------
    train : list of recordings, or one
    test : recording

    Returns
    -------
    ndarray, shape (n,)
        One force [N] for each row of ``test``; 0 out of contact.
    """
    return _forces(Bins(), train, test)


def ridge(train: object, test: object) -> NDArray[np.float64]:
    """The forces of `Ridge` along a recording; see `bins`."""
    return _forces(Ridge(), train, test)


def _forces(estimator, train, test):
    train, test = as_recordings(train), as_recording(test)
    force_N = np.concatenate([one["force_N"] for one in train])
    depth_m = max(float(one["position_m"].max()) for one in train)
    columns = np.vstack([features(one, depth_m) for one in train])
    contact = columns[:, 0] > 0.0
    estimator.fit(columns[contact], force_N[contact])
    columns = features(test, depth_m)
    return np.where(columns[:, 0] > 0.0, estimator.predict(columns), 0.0)
