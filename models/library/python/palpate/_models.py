"""Fitted models: fits, files, batches of samples."""
import ctypes
import dataclasses
import json
import os
import pathlib
from typing import Callable, Mapping, Optional, Sequence, Tuple, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._library import (Error, FitOptionsStruct, Progress, SensorStruct, address, assets, call, doubles, library,
                       path_bytes)
from ._recordings import OPTIONAL, REQUIRED, Recording, Sensor, as_recordings, find_sensor, motion_columns


@dataclasses.dataclass(frozen=True)
class Evaluation:
    """A model at feature vectors; every array has one value a vector.

    Attributes
    ----------
    force_N : ndarray
        ``trend_N + correction_N``, within the model's limits.
    bound_N : ndarray
        The 95 % bound on the error; NaN if the model has none.
    trend_N, correction_N : ndarray
        The viscoelastic trend, and the correction of it.
    outside : ndarray of bool
        The vector is out of the domain of the recordings.
    """

    force_N: NDArray[np.float64]
    bound_N: NDArray[np.float64]
    trend_N: NDArray[np.float64]
    correction_N: NDArray[np.float64]
    outside: NDArray[np.bool_]


class Model:
    """A fitted force model: from `load` or `fit`. Immutable; threads may share it."""

    def __init__(self, handle: int):
        self._handle = handle
        self._free = library().palpate_model_free

    def __del__(self):
        if getattr(self, "_handle", None):
            self._free(self._handle)

    def __repr__(self) -> str:
        return "<palpate.Model %s of %s>" % (self.name, ", ".join(self.feature_names))

    def __reduce__(self):
        raise Error("a model cannot be pickled; save it to a file")

    @property
    def name(self) -> str:
        """E.g. ``greedy-100``."""
        return library().palpate_model_name(self._handle).decode()

    @property
    def feature_names(self) -> Sequence[str]:
        """The names of the features that the force depends on, in the order of `features`."""
        count = library().palpate_model_feature_count(self._handle)
        return [library().palpate_model_feature_name(self._handle, index).decode() for index in range(count)]

    @property
    def report(self) -> Mapping[str, object]:
        """The output of ``palpate fit --json`` for a model from `fit`; empty for one from `load`."""
        return json.loads(library().palpate_model_report(self._handle) or b"{}")

    def render(self, time_s: ArrayLike, position_m: ArrayLike, velocity_m_per_s: Optional[ArrayLike] = None,
               acceleration_m_per_s2: Optional[ArrayLike] = None,
               sensor: Optional[Sensor] = None) -> Tuple[NDArray[np.float64], NDArray[np.float64]]:
        """The forces along a motion: the tick of the live loop, bit for bit those of ``palpate replay``.

        Parameters
        ----------
        time_s, position_m : array_like, shape (n,)
            Times [s] and positions [m] of the samples, in order. The filters begin at rest.
        velocity_m_per_s, acceleration_m_per_s2 : array_like, shape (n,), optional
            Measured velocity and acceleration.
        sensor : Sensor, optional
            By default identified from the samples (`find_sensor`), as ``palpate replay`` does.

        Returns
        -------
        force_N : ndarray, shape (n,)
            0 out of contact, and at a sample that is not finite or not later than the last one.
        bound_N : ndarray, shape (n,)
            The 95 % bound on the error; 0 out of contact, NaN if the model has none.
        """
        force_N, bound_N, _ = self._run(time_s, position_m, velocity_m_per_s, acceleration_m_per_s2, sensor, True)
        return force_N, bound_N

    def features(self, time_s: ArrayLike, position_m: ArrayLike, velocity_m_per_s: Optional[ArrayLike] = None,
                 acceleration_m_per_s2: Optional[ArrayLike] = None,
                 sensor: Optional[Sensor] = None) -> NDArray[np.float64]:
        """The feature vectors along a motion, out of contact too; SI units.

        Parameters
        ----------
        time_s, position_m, velocity_m_per_s, acceleration_m_per_s2, sensor
            As for `render`.

        Returns
        -------
        ndarray, shape (n, d)
            One column for each of `feature_names`.
        """
        return self._run(time_s, position_m, velocity_m_per_s, acceleration_m_per_s2, sensor, False)[2]

    def evaluate(self, features: ArrayLike) -> Evaluation:
        """The model at feature vectors, in contact.

        Parameters
        ----------
        features : array_like, shape (n, d)
            As from `features`.

        Returns
        -------
        Evaluation
        """
        width = library().palpate_model_feature_count(self._handle)
        features = doubles("features", features, (None, width))
        force_N, bound_N, trend_N = (np.empty(len(features)) for _ in range(3))
        outside = np.empty(len(features), np.bool_)
        library().palpate_model_evaluate(self._handle, len(features), address(features), address(force_N),
                                         address(bound_N), address(trend_N), address(outside))
        return Evaluation(force_N, bound_N, trend_N, force_N - trend_N, outside)

    def jnd_N(self, force_N: ArrayLike) -> NDArray[np.float64]:
        """The just noticeable difference at each force, by the model's line.

        Parameters
        ----------
        force_N : array_like

        Returns
        -------
        ndarray
        """
        return _jnd_N(self._handle, force_N)

    def save(self, path: str, overwrite: bool = False) -> None:
        """Writes the model file.

        Parameters
        ----------
        path : str or path-like
        overwrite : bool
            Replace an existing file.

        Raises
        ------
        Error
            The file exists, or cannot be written.
        """
        call("palpate_model_save", self._handle, path_bytes(path), int(overwrite))

    def export_c(self, path: str, encoder_step_m: float = 0.0, single_precision: bool = False,
                 overwrite: bool = False) -> None:
        """Writes the model as one self-contained C99 file.

        Parameters
        ----------
        path : str or path-like
        encoder_step_m : float
            Step of the positions; 0: that of the model's recordings.
        single_precision : bool
            ``float`` instead of ``double``.
        overwrite : bool
            Replace an existing file.

        Raises
        ------
        Error
            The file exists, or cannot be written.
        """
        call("palpate_model_export_c", self._handle, encoder_step_m, int(single_precision), path_bytes(path),
             int(overwrite))

    def _run(self, time_s, position_m, velocity_m_per_s, acceleration_m_per_s2, sensor, forces):
        columns = motion_columns(time_s, position_m, velocity_m_per_s, acceleration_m_per_s2)
        if sensor is None:
            sensor = find_sensor(*columns)
        count = len(columns[0])
        force_N, bound_N = (np.empty(count) if forces else None for _ in range(2))
        features = None if forces else np.empty((count, library().palpate_model_feature_count(self._handle)))
        spec = SensorStruct(*dataclasses.astuple(sensor), *(int(column is not None) for column in columns[2:]))
        stream = call("palpate_stream_new_with_sensor", self._handle, spec)
        try:
            library().palpate_stream_forces_with_motion(stream, count, *map(address, columns), address(force_N),
                                                        address(bound_N), address(features))
        finally:
            library().palpate_stream_free(stream)
        return force_N, bound_N, features


def load(path: str) -> Model:
    """Reads a model file.

    Parameters
    ----------
    path : str or path-like

    Returns
    -------
    Model

    Raises
    ------
    Error
        No such file, not a model, damaged.
    """
    return Model(call("palpate_model_load", path_bytes(path)))


def fit(recordings: object, method: str = "greedy", centres: int = 100, *, candidates: Union[int, str, None] = None,
        kernel: Optional[str] = None, weighting: Optional[str] = None, reduction: Optional[str] = None,
        recipe: Optional[str] = None, features: Union[str, Sequence[str], None] = None,
        relaxation: Union[str, Sequence[float], None] = None, surface: Optional[str] = None,
        grid: Union[str, Sequence[int], None] = None, scene: Optional[str] = None, seed: int = 1,
        progress: Optional[Callable[[float], object]] = None) -> Model:
    """Fits one model to all recordings together: ``palpate fit``, with its options and defaults.

    Parameters
    ----------
    recordings : list of recordings, or one
        Each a `Recording`, a structured array or table with its columns, or the path of a file.
    method : str
        ``trend``, ``direct``, ``voxel``, ``random``, ``kdtree`` or ``greedy``.
    centres : int
        Of random, kdtree and greedy, 1 to 2000.
    candidates : int or "all", optional
        Of greedy: sites tried per step [100].
    kernel : str, optional
        ``cubic``, ``linear``, ``thin-plate`` or ``quintic`` [cubic].
    weighting : str, optional
        Weight of an error: ``jnd``, ``relative`` or ``none`` [jnd].
    reduction : str, optional
        Samples that become sites: ``coverage``, ``force`` or ``none`` [coverage].
    recipe : str, optional
        ``paper-2009``: the recipe of Hoever & Harders (2009).
    features : str or list of str, optional
        ``auto``, ``scene``, or a list such as ``["depth", "velocity", "maxwell:0.17"]`` [auto].
    relaxation : str or list of float, optional
        Relaxation times of the scene's features: ``scene``, ``auto``, or times [s].
    surface : str, optional
        Surface of each recording: ``auto`` (estimated) or ``recorded`` (at 0) [auto].
    grid : str or list of int, optional
        Of voxel: nodes per feature, e.g. ``[25, 11, 11, 11]``.
    scene : str, optional
        Name or file of the scene that gives the features and the JND line [silicone_block].
    seed : int
        Of random and greedy.
    progress : callable, optional
        Called from time to time with the finished fraction; if it returns False, the fit ends.

    Returns
    -------
    Model
        With the figures of the fit in its `report`.

    Raises
    ------
    Error
        A recording is not usable (`check`), an option is out of its range, the fit was stopped.
    """
    recordings = as_recordings(recordings)
    return fit_without([None] * len(recordings), recordings, method, centres, candidates=candidates, kernel=kernel,
                       weighting=weighting, reduction=reduction, recipe=recipe, features=features,
                       relaxation=relaxation, surface=surface, grid=grid, scene=scene, seed=seed, progress=progress)


def fit_without(left_out, recordings, method="greedy", centres=100, *, candidates=None, kernel=None, weighting=None,
                reduction=None, recipe=None, features=None, relaxation=None, surface=None, grid=None, scene=None,
                seed=1, progress=None):
    """`fit` of recordings without the rows of some masks, each None or an array of bool."""
    options = FitOptionsStruct()
    library().palpate_fit_options_default(options)
    chosen = {"method": method, "candidates": candidates, "kernel": kernel, "weighting": weighting,
              "reduction": reduction, "recipe": recipe, "features": _joined(features, ","),
              "relaxation": _joined(relaxation, ","), "surface": surface, "grid": _joined(grid, "x"),
              **_scene_options(scene)}
    for name, value in chosen.items():
        if value is not None:
            setattr(options, name, value if isinstance(value, float) else str(value).encode())
    options.centres, options.seed = _whole("centres", centres), _whole("seed", seed)
    failure = []
    options.progress = Progress(_careful(progress, failure))
    handles = []
    try:
        handles += map(_new_recording, recordings, left_out)
        model = call("palpate_fit_recordings", (ctypes.c_void_p * len(handles))(*handles), len(handles), options)
    except Error:
        if failure:
            raise failure[0] from None
        raise
    finally:
        for handle in handles:
            library().palpate_recording_free(handle)
    return Model(model)


def within_jnd(force_N: ArrayLike, measured_N: ArrayLike, in_contact: Optional[ArrayLike] = None,
               jnd_N: Optional[ArrayLike] = None) -> float:
    """The share of the samples in contact with an error of at most one JND.

    Parameters
    ----------
    force_N, measured_N : array_like, shape (n,)
        Forces of a model, and measured forces.
    in_contact : array_like of bool, shape (n,), optional
        The samples in contact; `palpate.in_contact` gives those of ``palpate replay``. By default those
        with a force of the model, or with a measured force above the JND at 0 N.
    jnd_N : array_like, shape (n,), optional
        The JND at each measured force, e.g. `Model.jnd_N` [0.065 N + 0.0633 \\|measured_N\\|].

    Returns
    -------
    float
        0 to 1; NaN without a sample in contact.
    """
    force_N = doubles("force_N", force_N)
    measured_N = doubles("measured_N", measured_N, force_N.shape)
    thresholds_N = doubles("jnd_N", _jnd_N(None, measured_N) if jnd_N is None else jnd_N, force_N.shape)
    if in_contact is None:
        in_contact = (force_N != 0.0) | (np.abs(measured_N) > _jnd_N(None, 0.0))
    counts = np.asarray(in_contact)
    if counts.dtype != np.bool_ or counts.shape != force_N.shape:
        raise Error("in_contact: found dtype %s and shape %s, expected bool and %s"
                    % (counts.dtype, counts.shape, force_N.shape))
    within = np.abs(force_N - measured_N) <= thresholds_N
    return float(np.mean(within[counts])) if counts.any() else float("nan")


def jnd_N(force_N: ArrayLike) -> NDArray[np.float64]:
    """The just noticeable difference at each force: 0.065 N + 0.0633 \\|force_N\\|, Hoever & Harders (2009).

    Parameters
    ----------
    force_N : array_like

    Returns
    -------
    ndarray
    """
    return _jnd_N(None, force_N)


def _jnd_N(handle, force_N):
    # Two points define the line.
    offset_N, at_one_N = (library().palpate_jnd_N(handle, at) for at in (0.0, 1.0))
    return offset_N + (at_one_N - offset_N) * np.abs(np.asarray(force_N, dtype=np.float64))


def _new_recording(recording: Recording, left_out: Optional[NDArray[np.bool_]]) -> int:
    columns = [np.ascontiguousarray(recording[name]) if name in recording.dtype.names else None
               for name in (*REQUIRED, *OPTIONAL)]
    return call("palpate_recording_new", recording.name.encode(errors="surrogateescape"), len(recording),
                *map(address, columns), address(left_out))


def _joined(values, separator):
    if values is None or isinstance(values, str):
        return values
    try:
        return separator.join(str(value) for value in values)
    except TypeError:
        raise Error("found %r, expected a text or a list" % (values,)) from None


def _whole(name, value):
    if isinstance(value, bool) or not isinstance(value, (int, np.integer)) or not 0 <= value < 2 ** 31:
        raise Error("%s: found %r, expected a whole number of 0 or more" % (name, value))
    return int(value)


def _careful(progress, failure):
    """A callback whose exceptions, Control-C among them, stop the fit and are raised after it."""
    def report(fraction, _):
        try:
            return int(progress is None or progress(fraction) is not False)
        except BaseException as error:  # pylint: disable=broad-except
            failure.append(error)
            return 0
    return report


def _scene_options(scene):
    if scene is None:
        return {}
    folder = assets() / "scenes"
    path = pathlib.Path(scene) if os.path.sep in str(scene) else folder / (str(scene) + ".json")
    try:
        content = json.loads(path.read_text())
        features = [one["kind"] + (":%r" % one["relaxation_time_s"] if "relaxation_time_s" in one else "")
                    for one in content["features"]]
        line = content["jnd"]
        return {"scene": content["name"], "scene_features": ",".join(features),
                "jnd_offset_N": float(line["offset_N"]), "jnd_weber_fraction": float(line["weber_fraction"])}
    except (OSError, ValueError, KeyError, TypeError) as error:
        known = ", ".join(sorted(one.stem for one in folder.glob("*.json"))) or "none in " + str(folder)
        raise Error("scene: found %r (%s), expected a scene's file or one of: %s" % (scene, error, known)) from None
