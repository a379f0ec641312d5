"""Two trivial force models, the baselines of labs.py. Both use depths and forces only.

bins   the median force of 60 depths and two directions of motion, linear between them
ridge  a ridge regression on a polynomial of the depth, low-passed depths, play operators with thresholds up to
       half of the depth, and the greatest depth so far; rows weighted by 1/JND
"""
import csv

import numpy

DEPTHS = 60
DEGREE = 6
TIMES_S = numpy.array([0.03, 0.1, 0.3, 1.0, 3.0, 10.0])
THRESHOLDS = 0.5 / 2.0 ** numpy.arange(6)  # relative to the greatest depth
RIDGE = 1e-4  # relative to the sum of squares of a column
MOST_ROWS = 20000  # for training; longer recordings are thinned evenly
DIRECTION = 0.005  # a reversal by this share of the greatest depth changes the direction of motion
SHIFTS = numpy.linspace(-1.0, 1.0, 41)


def jnd(force):
    return 0.065 + 0.0633 * numpy.abs(force)


class Recording:
    """Time, position and force of one file, and which samples are in contact (models/METHOD.md)."""

    def __init__(self, path):
        with open(path, newline="") as file:
            rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
        self.time, self.position, self.force = (
            numpy.array([float(row[name]) for row in rows]) for name in ("time_s", "position_m", "force_N"))

    def contact(self, surface=0.0):
        return (self.position > surface) | (numpy.abs(self.force) > 0.065)


def play(values, state, threshold):
    return numpy.minimum(numpy.maximum(state, values - threshold), values + threshold)


class Bins:
    def __init__(self, recordings):
        self.greatest = max(one.position.max() for one in recordings)
        kept = [one.contact() for one in recordings]
        position = numpy.concatenate([one.position[rows] for one, rows in zip(recordings, kept)])
        force = numpy.concatenate([one.force[rows] for one, rows in zip(recordings, kept)])
        inward = numpy.concatenate([self.inward(one)[rows] for one, rows in zip(recordings, kept)])
        edges = numpy.linspace(position.min(), position.max(), DEPTHS + 1)
        found = numpy.clip(numpy.searchsorted(edges, position) - 1, 0, DEPTHS - 1)
        self.lines = {}
        for way in (False, True):
            filled = [bin for bin in range(DEPTHS) if numpy.any((found == bin) & (inward == way))]
            medians = [numpy.median(force[(found == bin) & (inward == way)]) for bin in filled]
            self.lines[way] = ((edges[filled] + edges[numpy.add(filled, 1)]) / 2, medians) if filled else ([0.0], [0.0])

    def inward(self, recording):
        """For each sample, whether the last motion was inward."""
        state, way, ways = recording.position[0], True, []
        for value in recording.position:
            moved = play(value, state, DIRECTION * self.greatest)
            way = moved > state if moved != state else way
            state = moved
            ways.append(way)
        return numpy.array(ways)

    def forces(self, recording, shifts):
        """Samples x shifts."""
        inward = self.inward(recording)[:, None]
        depth = recording.position[:, None] - shifts
        return numpy.where(inward, numpy.interp(depth, *self.lines[True]), numpy.interp(depth, *self.lines[False]))


class Ridge:
    def __init__(self, recordings):
        self.greatest = max(one.position.max() for one in recordings)
        columns, force = [], []
        for one in recordings:
            chosen = numpy.flatnonzero(one.contact())
            chosen = chosen[::max(1, len(recordings) * len(chosen) // MOST_ROWS)]
            columns.append(numpy.concatenate(list(self.columns(one, numpy.zeros(1))))[chosen, :, 0])
            force.append(one.force[chosen])
        columns, force = numpy.concatenate(columns), numpy.concatenate(force)
        weighted = columns / jnd(force)[:, None]
        scale = numpy.sqrt((weighted ** 2).sum(axis=0)) + 1e-12
        weighted = numpy.vstack([weighted / scale, numpy.sqrt(RIDGE) * numpy.eye(len(scale))])
        target = numpy.concatenate([force / jnd(force), numpy.zeros(len(scale))])
        self.weights = numpy.linalg.lstsq(weighted, target, rcond=None)[0] / scale

    def columns(self, recording, shifts):
        """Blocks of samples x columns x shifts."""
        depths = numpy.maximum(0.0, recording.position[:, None] - shifts) / self.greatest
        shares = 1.0 - numpy.exp(-numpy.diff(recording.time, prepend=recording.time[0])[:, None] / TIMES_S)
        slow, plays, greatest = numpy.tile(depths[0], (len(TIMES_S), 1)), numpy.zeros((len(THRESHOLDS), len(shifts))), depths[0]
        for begin in range(0, len(depths), 1000):
            block = depths[begin:begin + 1000]
            states = []
            for depth, share in zip(block, shares[begin:begin + 1000]):
                slow = slow + share[:, None] * (depth - slow)
                plays = play(depth, plays, THRESHOLDS[:, None])
                greatest = numpy.maximum(greatest, depth)
                states.append(numpy.vstack([slow, plays, greatest]))
            states = numpy.array(states)
            powers = block[:, None, :] ** numpy.arange(DEGREE + 1)[:, None]
            yield numpy.concatenate([powers, states, states * block[:, None, :]], axis=1)

    def forces(self, recording, shifts):
        return numpy.concatenate([numpy.einsum("rcs,c->rs", block, self.weights)
                                  for block in self.columns(recording, shifts)])


KINDS = {"bins": Bins, "ridge": Ridge}


def figures(model, recording):
    """Errors as recorded, and with the surface of the test moved to the minimum of the mean error over the JND.
    The moved figures are fitted to the forces of the test, as those of `palpate replay` are."""
    def errors(shift, forces):
        rows = recording.contact(shift)
        return (numpy.abs(forces - recording.force) / jnd(recording.force))[rows]

    def best(shifts):
        forces = model.forces(recording, shifts)
        costs = [errors(shift, column).mean() for shift, column in zip(shifts, forces.T)]
        at = int(numpy.argmin(costs))
        return shifts[at], errors(shifts[at], forces[:, at])

    recorded = errors(0.0, model.forces(recording, numpy.zeros(1))[:, 0])
    coarse = 0.25 * model.greatest * SHIFTS
    shift, _ = best(coarse)
    shift, moved = best(shift + (coarse[1] - coarse[0]) * SHIFTS)
    within = lambda some: 100 * float((some <= 1.0).mean())
    return {"share": within(recorded), "moved": within(moved), "p99": float(numpy.quantile(recorded, 0.99)),
            "worst": float(recorded.max()), "held": None, "offset_m": float(shift)}
