"""Recordings as structured arrays, their sensor, contact and folds."""
import ctypes
import dataclasses
from typing import Optional, Sequence, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._library import CheckStruct, Error, SensorStruct, address, call, doubles, library, path_bytes

REQUIRED = ("time_s", "position_m", "force_N")
OPTIONAL = ("velocity_m_per_s", "acceleration_m_per_s2")
_FINDINGS_BYTES = 16384


class Recording(np.ndarray):
    """A recording: a structured array, one row a sample, with a name.

    The fields are ``time_s``, ``position_m`` (along the inward normal, 0 at the undisturbed surface) and
    ``force_N`` (positive when the material pushes the tool out); ``velocity_m_per_s`` and
    ``acceleration_m_per_s2`` where they were measured. Slices are recordings too.

    Attributes
    ----------
    name : str
        Kept in models that are fitted to it; of a file its name without folder and ending.
    """

    name: str = "recording"

    def __array_finalize__(self, source):
        if source is not None:
            self.name = getattr(source, "name", "recording")


def make_recording(time_s: ArrayLike, position_m: ArrayLike, force_N: ArrayLike,
                   velocity_m_per_s: Optional[ArrayLike] = None, acceleration_m_per_s2: Optional[ArrayLike] = None,
                   name: str = "recording") -> Recording:
    """Joins columns to a recording.

    Parameters
    ----------
    time_s, position_m, force_N : array_like, shape (n,)
        Time [s], strictly increasing; position [m], inward; force [N], outward.
    velocity_m_per_s, acceleration_m_per_s2 : array_like, shape (n,), optional
        Measured velocity and acceleration.
    name : str
        Kept in models that are fitted to it.

    Returns
    -------
    Recording

    Raises
    ------
    Error
        A column has another length, or is not of numbers.
    """
    columns = {"time_s": doubles("time_s", time_s)}
    more = zip((*REQUIRED[1:], *OPTIONAL), (position_m, force_N, velocity_m_per_s, acceleration_m_per_s2))
    for column, values in more:
        if values is not None:
            columns[column] = doubles(column, values, columns["time_s"].shape)
    recording = np.empty(len(columns["time_s"]), [(column, np.float64) for column in columns]).view(Recording)
    for column, values in columns.items():
        recording[column] = values
    recording.name = name
    return recording


def read_recording(path: str) -> Recording:
    """Reads a recording file (CSV; see the manual for its columns).

    Parameters
    ----------
    path : str or path-like

    Returns
    -------
    Recording

    Raises
    ------
    Error
        With file, line and column, what was found and what was expected.
    """
    handle = call("palpate_recording_load", path_bytes(path))
    try:
        count = library().palpate_recording_row_count(handle)
        rows = ctypes.cast(library().palpate_recording_rows(handle), ctypes.POINTER(ctypes.c_double))
        table = np.ctypeslib.as_array(rows, (count, len(REQUIRED) + len(OPTIONAL)))
        return make_recording(*table[:, :3].T,
                              table[:, 3] if library().palpate_recording_has_velocity(handle) else None,
                              table[:, 4] if library().palpate_recording_has_acceleration(handle) else None,
                              library().palpate_recording_name(handle).decode(errors="surrogateescape"))
    finally:
        library().palpate_recording_free(handle)


def as_recording(recording: Union[str, np.ndarray]) -> Recording:
    """A recording from a path, a structured array, or anything with columns of these names."""
    if isinstance(recording, Recording):
        return recording
    if not hasattr(recording, "__getitem__") or isinstance(recording, (str, bytes)):
        return read_recording(recording)
    names = getattr(getattr(recording, "dtype", None), "names", None)
    if names is None:
        names = getattr(recording, "columns", None)  # a pandas.DataFrame
    if names is None or not set(REQUIRED) <= set(names):
        found = type(recording).__name__ if names is None else "columns " + ", ".join(map(str, names))
        raise Error("recording: found %s, expected a path or columns %s" % (found, ", ".join(REQUIRED)))
    return make_recording(*(recording[name] for name in REQUIRED),
                          **{name: recording[name] for name in OPTIONAL if name in names})


def motion_of(recording: Recording) -> dict:
    """The columns of a motion, as the arguments of `Model.render`."""
    return {name: recording[name] for name in recording.dtype.names if name in (*REQUIRED[:2], *OPTIONAL)}


def as_recordings(recordings: object) -> list:
    """A list of recordings from one, or from a sequence of them."""
    if isinstance(recordings, (list, tuple)):
        return [as_recording(one) for one in recordings]
    return [as_recording(recordings)]


def import_table(table: str, recording: str, overwrite: bool = False) -> None:
    """Turns a table of another program into a recording file: ``palpate import`` with its guesses.

    Parameters
    ----------
    table, recording : str or path-like
        The file to read and the file to write.
    overwrite : bool
        Replace an existing file.

    Raises
    ------
    Error
        Something cannot be determined; the recording exists.
    """
    call("palpate_import", path_bytes(table), path_bytes(recording), int(overwrite))


@dataclasses.dataclass(frozen=True)
class Check:
    """The result of `check`.

    Attributes
    ----------
    verdict : str
        ``usable``, ``care`` or ``unusable``.
    noise_floor_within_jnd : float
        Share of the samples in contact that a perfect model would have within the JND, 0 to 1.
    surface_offset_m, force_zero_N : float
        To be subtracted from the positions and the forces.
    findings : list of str
        ``severity code: text; advice``, in order of severity.
    """

    verdict: str
    noise_floor_within_jnd: float
    surface_offset_m: float
    force_zero_N: float
    findings: Sequence[str]


def check(path: str) -> Check:
    """Checks whether a recording is suitable for a fit: ``palpate check``.

    Parameters
    ----------
    path : str or path-like
        A recording file.

    Returns
    -------
    Check

    Raises
    ------
    Error
        The file is no recording.
    """
    result = CheckStruct()
    findings = ctypes.create_string_buffer(_FINDINGS_BYTES)
    call("palpate_check", path_bytes(path), result, findings, _FINDINGS_BYTES)
    return Check(("unusable", "care", "usable")[result.usable], result.noise_floor_within_jnd, result.surface_offset_m,
                 result.force_zero_N, findings.value.decode(errors="replace").splitlines())


@dataclasses.dataclass(frozen=True)
class Sensor:
    """The sensor of the positions.

    Attributes
    ----------
    encoder_step_m : float
        Step of the positions, 0: not quantised.
    position_noise_m : float
        Standard deviation of the positions in addition to the quantisation.
    velocity_noise_m_per_s, acceleration_noise_m_per_s2 : float
        Standard deviations of the measured channels, > 0 where they are used.
    """

    encoder_step_m: float = 0.0
    position_noise_m: float = 0.0
    velocity_noise_m_per_s: float = 0.0
    acceleration_noise_m_per_s2: float = 0.0


def motion_columns(time_s, position_m, velocity_m_per_s, acceleration_m_per_s2):
    """The four columns of a motion as contiguous doubles; a missing one stays None."""
    time_s = doubles("time_s", time_s)
    return [time_s, *(None if values is None else doubles(name, values, time_s.shape) for name, values in
                      (("position_m", position_m), *zip(OPTIONAL, (velocity_m_per_s, acceleration_m_per_s2))))]


def find_sensor(time_s: ArrayLike, position_m: ArrayLike, velocity_m_per_s: Optional[ArrayLike] = None,
                acceleration_m_per_s2: Optional[ArrayLike] = None) -> Sensor:
    """Identifies the sensor of samples from the first 30,000 of them, as ``palpate replay`` does.

    Parameters
    ----------
    time_s, position_m : array_like, shape (n,)
    velocity_m_per_s, acceleration_m_per_s2 : array_like, shape (n,), optional

    Returns
    -------
    Sensor
    """
    columns = motion_columns(time_s, position_m, velocity_m_per_s, acceleration_m_per_s2)
    found = SensorStruct()
    library().palpate_sensor_of_samples(len(columns[0]), *map(address, columns), found)
    return Sensor(found.encoder_step_m, found.position_noise_m, found.velocity_noise_m_per_s,
                  found.acceleration_noise_m_per_s2)


def in_contact(position_m: ArrayLike, force_N: ArrayLike) -> NDArray[np.bool_]:
    """Selects the samples that error figures are computed over, as ``palpate replay`` does.

    A sample is in contact if its position is above 0, or its measured force is beyond both the JND at 0 N and
    five times its noise.

    Parameters
    ----------
    position_m, force_N : array_like, shape (n,)
        Of one recording, from its beginning.

    Returns
    -------
    ndarray of bool, shape (n,)
    """
    position_m = doubles("position_m", position_m)
    force_N = doubles("force_N", force_N, position_m.shape)
    contact = np.empty(position_m.shape, np.bool_)
    library().palpate_in_contact(len(contact), address(position_m), address(force_N), address(contact))
    return contact


def find_folds(depth_m: Union[ArrayLike, Sequence[ArrayLike]]) -> NDArray[np.int32]:
    """The folds of cross-validation that a fit uses.

    With three recordings or more a fold is made of whole recordings, otherwise of whole contacts; a contact
    with more than a tenth of all samples is cut into pieces in time. Neighbouring samples share their errors,
    so random folds would be optimistic.

    Parameters
    ----------
    depth_m : array_like, shape (n,), or list of them
        Depth of one recording, or of each of several: greater than 0 in contact, e.g. the first column of
        `Model.features`.

    Returns
    -------
    ndarray of int, shape (n,)
        The number of each sample's fold, of all recordings one after the other.
    """
    several = isinstance(depth_m, (list, tuple)) and len(depth_m) > 0 and np.ndim(depth_m[0]) > 0
    parts = [doubles("depth_m", part) for part in (depth_m if several else [depth_m])]
    depth_m = np.concatenate(parts)
    recording = np.repeat(np.arange(len(parts), dtype=np.intc), [len(part) for part in parts])
    fold = np.zeros(len(depth_m), np.intc)
    library().palpate_folds(len(depth_m), address(depth_m), address(recording), address(fold))
    return fold
