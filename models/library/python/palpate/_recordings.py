"""Recordings as structured arrays, and the error of a model along them."""
from __future__ import annotations

import os

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._library import COLUMNS, REQUIRED, Error, RecordingStruct, WrongType, as_bytes, call, doubles, library

# Hoever & Harders (2009).
_JND_OFFSET_N, _JND_WEBER_FRACTION = 0.065, 0.0633


class Recording(np.ndarray):
    """A recording: a structured array, one row a sample. Slices are recordings too.

    The fields are ``time_s``, ``position_m`` (along the inward normal, 0 at the undisturbed surface) and
    ``force_N`` (positive when the material pushes the tool out); ``velocity_m_per_s`` and
    ``acceleration_m_per_s2`` where they were measured. Models keep its `name`, that of its file.
    """

    name: str = "recording"

    def __array_finalize__(self, source):
        self.name = getattr(source, "name", "recording")


def make_recording(time_s: ArrayLike, position_m: ArrayLike, force_N: ArrayLike,
                   velocity_m_per_s: ArrayLike | None = None, acceleration_m_per_s2: ArrayLike | None = None,
                   name: str = "recording") -> Recording:
    """Joins columns of shape (n,) to a recording: time [s], strictly increasing; position [m], inward; force [N],
    outward; measured velocity and acceleration, if there are any.

    Raises `Error` if a column has another length, or is not of numbers.
    """
    given = dict(zip(COLUMNS, (time_s, position_m, force_N, velocity_m_per_s, acceleration_m_per_s2)))
    return _recording(RecordingStruct.of(given, name))


def read_recording(path: str | os.PathLike) -> Recording:
    """Reads a recording file (CSV; see the manual for its columns).

    Raises `Error` with file, line and column, what was found and what was expected.
    """
    loaded = call("palpate_recording_load", as_bytes("path", path))
    try:
        return _recording(loaded.contents)
    finally:
        library().palpate_recording_free(loaded)


def _recording(struct):
    columns = {name: np.ctypeslib.as_array(getattr(struct, name), (struct.size,)) for name in COLUMNS
               if getattr(struct, name)}
    recording = np.empty(struct.size, [(name, np.float64) for name in columns]).view(Recording)
    for name, values in columns.items():
        recording[name] = values
    recording.name = struct.name.decode(errors="surrogateescape")
    return recording


def as_recording(given: object) -> Recording:
    """A recording from a path, a structured array, or anything with columns of these names."""
    if isinstance(given, Recording):
        return given
    if isinstance(given, (str, os.PathLike)):
        return read_recording(given)
    columns = {}
    for name in COLUMNS:
        try:
            columns[name] = given[name]
        except (IndexError, KeyError, TypeError, ValueError):
            if name in REQUIRED:
                raise WrongType("recording: found %s without %s, expected a path or columns %s"
                            % (type(given).__name__, name, ", ".join(REQUIRED))) from None
    return make_recording(**columns)


def in_contact(position_m: ArrayLike, force_N: ArrayLike) -> NDArray[np.bool_]:
    """The samples over which ``palpate replay`` computes errors: a position above 0, or a measured force beyond both
    the JND at 0 N and five times its noise."""
    recording = RecordingStruct.of({"position_m": position_m, "force_N": force_N})
    contact = np.empty(recording.size, np.bool_)
    library().palpate_in_contact(recording, contact.ctypes.data)
    return contact


def within_jnd(force_N: ArrayLike, measured_N: ArrayLike, in_contact: ArrayLike | None = None) -> float:
    """The share of the samples in contact with an error of at most one JND, 0 to 1; NaN without contact.

    Forces of a model, and measured forces, are of shape (n,) and finite. `in_contact` selects samples;
    `palpate.in_contact` gives those of ``palpate replay``. By default those with a force of the model, or with a
    measured force above the JND at 0 N.
    """
    force_N, measured_N = doubles("force_N", force_N), doubles("measured_N", measured_N)
    if force_N.shape != measured_N.shape:
        raise Error("measured_N: found %d values, expected %d as of force_N" % (len(measured_N), len(force_N)))
    for name, values in (("force_N", force_N), ("measured_N", measured_N)):
        wrong = int(np.count_nonzero(~np.isfinite(values)))
        if wrong:
            raise Error("%s: found %d of %d values that are not finite, expected numbers; leave those samples out"
                        % (name, wrong, len(values)))
    if in_contact is None:
        in_contact = (force_N != 0.0) | (np.abs(measured_N) > _JND_OFFSET_N)
    counts = np.asarray(in_contact)
    if counts.dtype != np.bool_ or counts.shape != force_N.shape:
        raise Error("found %d forces, %d measured forces and in_contact of dtype %s and shape %s, expected equal sizes "
                    "and bool" % (len(force_N), len(measured_N), counts.dtype, counts.shape))
    within = np.abs(force_N - measured_N) <= jnd_N(measured_N)
    return float(np.mean(within[counts])) if counts.any() else float("nan")


def jnd_N(force_N: ArrayLike) -> NDArray[np.float64]:
    """The just noticeable difference at each force: 0.065 N + 0.0633 \\|force_N\\|, Hoever & Harders (2009)."""
    return _JND_OFFSET_N + _JND_WEBER_FRACTION * np.abs(np.asarray(force_N, dtype=np.float64))
