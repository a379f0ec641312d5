"""Fitted models: fits, files, batches of samples, and the loop that closes over a hand."""
from __future__ import annotations

import json
import os
from typing import Callable, Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._library import (Error, Handle, Limits, Progress, RecordingStruct, Sensor, as_bytes, call, expect, library,
                       new_stream, number)
from ._recordings import as_recording


class Model(Handle):
    """A fitted force model: from `load` or `fit`. Immutable; threads may share it."""

    def __init__(self, handle: int):
        super().__init__(handle, library().palpate_model_free)

    def __repr__(self) -> str:
        return "<palpate.Model %s of %s>" % (self.name, ", ".join(self.feature_names))

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
        """The output of ``palpate fit --json``; empty for a model from `load`."""
        return json.loads(library().palpate_model_report(self._handle) or b"{}")

    def render(self, time_s: ArrayLike, position_m: ArrayLike, velocity_m_per_s: ArrayLike | None = None,
               acceleration_m_per_s2: ArrayLike | None = None,
               sensor: Sensor | float | None = None) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """The forces along a motion: the tick of the live loop, bit for bit those of ``palpate replay``.

        Parameters
        ----------
        time_s, position_m : array_like, shape (n,)
            In s and m, in order. The filters begin at rest.
        velocity_m_per_s, acceleration_m_per_s2 : array_like, shape (n,), optional
            Measured velocity and acceleration.
        sensor : Sensor or float, optional
            A number is the step of an encoder [m], 0: that of the recordings. By default identified as ``palpate
            replay`` does.

        Returns
        -------
        force_N, bound_N : ndarray, shape (n,)
            The force, 0 out of contact and at a sample that is not finite or not later than the last one (`Error` if
            that are more than half of them, or their type has coarse steps), and the 95 % bound on its error, NaN if
            the model has none.
        """
        return self._replay((time_s, position_m, velocity_m_per_s, acceleration_m_per_s2), sensor)[:2]

    def features(self, time_s: ArrayLike, position_m: ArrayLike, velocity_m_per_s: ArrayLike | None = None,
                 acceleration_m_per_s2: ArrayLike | None = None,
                 sensor: Sensor | float | None = None) -> NDArray[np.float64]:
        """The feature vectors along a motion, out of contact too: shape (n, d), a column for each of `feature_names`.
        Parameters as for `render`."""
        return self._replay((time_s, position_m, velocity_m_per_s, acceleration_m_per_s2), sensor)[2]

    def _replay(self, columns, sensor):
        names = ("time_s", "position_m", "velocity_m_per_s", "acceleration_m_per_s2")
        motion = RecordingStruct.of(dict(zip(names, columns)))
        _check_times(motion.arrays["time_s"], np.asarray(columns[0]).dtype)
        if sensor is None:
            sensor = Sensor()
            library().palpate_sensor_of(motion, sensor)
        elif isinstance(sensor, Sensor):  # a channel without a column is not measured
            sensor = Sensor(sensor.encoder_step_m, sensor.position_noise_m,
                            sensor.velocity_noise_m_per_s if columns[2] is not None else 0.0,
                            sensor.acceleration_noise_m_per_s2 if columns[3] is not None else 0.0)
        force_N, bound_N = np.empty(motion.size), np.empty(motion.size)
        features = np.empty((motion.size, library().palpate_model_feature_count(self._handle)))
        stream = new_stream(self._handle, sensor)
        library().palpate_stream_replay(stream, motion, *(a.ctypes.data for a in (force_N, bound_N, features)))
        library().palpate_stream_free(stream)
        return force_N, bound_N, features

    def save(self, path: str | os.PathLike, overwrite: bool = False) -> None:
        """Writes the model file. Raises `Error` if it exists, unless `overwrite`, or cannot be written."""
        call("palpate_model_save", self._handle, as_bytes("path", path), int(overwrite))


def _check_times(time_s, dtype):
    """Refuses times that would give 0 N without a word."""
    steps = np.diff(time_s)
    stand = int(np.count_nonzero(~(steps > 0.0)))
    coarse = dtype.kind == "f" and dtype.itemsize < 8
    if stand > 0 and (coarse or 2 * stand > len(steps)):
        raise Error("time_s: found %d of %d samples that are not later than the one before, expected increasing seconds"
                    % (stand, len(time_s)) + ("; %s cannot tell such times apart, use float64" % dtype if coarse else ""))


def load(path: str | os.PathLike) -> Model:
    """Reads a model file. Raises `Error`: no such file, not a model, damaged."""
    return Model(call("palpate_model_load", as_bytes("path", path)))


def fit(recordings: object, method: str = "trend+greedy", centres: int | None = None, *,
        progress: Callable[[float], object] | None = None, **options: object) -> Model:
    """Fits one model to all recordings together: ``palpate fit``, with its options and defaults.

    Parameters
    ----------
    recordings : list of recordings, or one
        Each a `Recording`, a structured array or table with its columns, or the path of a file.
    method : str
        ``direct``, ``voxel``, ``random``, ``kdtree`` or ``greedy``: a method on the measured force, as Hoever & Harders
        (2009); ``trend``; ``trend+direct`` ... ``trend+greedy``: the trend and a correction. A number of centres may
        follow: ``greedy-40``.
    centres : int, optional
        Of random, kdtree and greedy, 1 to 2000 [100].
    candidates : int or "all", optional
        Of greedy: sites tried per step [100].
    features : str or list of str, optional
        ``auto``, ``scene`` (those of 2009), or a list such as ``["depth", "velocity", "maxwell:0.17"]`` [auto].
    kernel : str, optional
        ``auto``, ``cubic``, ``linear`` or ``thin-plate`` [auto].
    grid : str or list of int, optional
        Of voxel: nodes per feature, e.g. ``[25, 11, 11, 11]``.
    seed : int, optional
        Of random, kdtree and greedy, alone or after ``trend+`` [1].
    progress : callable, optional
        Called from time to time with the finished fraction; if it returns False, the fit ends.

    Returns
    -------
    Model
        With the figures of the fit in its `report`.

    Raises
    ------
    Error
        A recording is not usable (``palpate check``), an option is out of its range, the fit was stopped.
    """
    listed = [as_recording(one) for one in (recordings if isinstance(recordings, (list, tuple)) else [recordings])]
    structs = [RecordingStruct.of({name: one[name] for name in one.dtype.names}, one.name) for one in listed]
    words = []
    for name, value in {"method": method, "centres": centres, **options}.items():
        joined = ("x" if name == "grid" else ",").join(map(str, value)) if np.ndim(value) else value
        if any(len(str(word).split()) != 1 for word in (name, joined)) or "=" in name + str(joined):
            raise Error("%s: found %r, expected one word without blanks and \"=\"" % (name, value))
        words += [] if value is None else ["%s=%s" % (name, joined)]
    failure = []

    def report(fraction, _):
        # An exception, Control-C among them, stops the fit and is raised after it.
        try:
            return int(progress is None or progress(fraction) is not False)
        except BaseException as error:  # pylint: disable=broad-except
            failure.append(error)
            return 0

    try:
        return Model(call("palpate_fit", (RecordingStruct * len(structs))(*structs), len(structs),
                          as_bytes("options", " ".join(words)), Progress(report), None))
    except Error as error:
        raise (failure or [error])[0] from None


class Stream(Handle):
    """One tool in one material: palpate_stream of palpate.h. One thread at a time. The model may be deleted before.

    `sensor`: a `Sensor`, or the step of an encoder [m]; 0, the default, is the sensor of the model's recordings, and
    ``Sensor()`` that of exact positions. `after`: the recording of the same rig that the stream continues, whose press
    the material remembers; by default it is at rest.
    """

    def __init__(self, model: Model, sensor: Sensor | float = 0, after: object = None):
        self._library = library()
        super().__init__(new_stream(expect("model", model, Model)._handle, sensor), self._library.palpate_stream_free)
        if after is not None:
            before = as_recording(after)
            call("palpate_stream_start_after", self._handle,
                 RecordingStruct.of({name: before[name] for name in before.dtype.names}, before.name))

    def force(self, time_s: float, position_m: float) -> float:
        """Takes the next sample and returns the force of the material [N]; 0 if it is refused (`accepted`). For a hand
        use `Limiter.render`."""
        return self._library.palpate_stream_force(self._handle, number("time_s", time_s),
                                                  number("position_m", position_m))

    def bound(self) -> float:
        """The 95 % bound on the error of the force at the last accepted sample [N]; NaN if the model has none."""
        return self._library.palpate_stream_predicted_error(self._handle)

    def reset(self) -> None:
        """Begins a new stream, at any time."""
        self._library.palpate_stream_reset(self._handle)

    @property
    def accepted(self) -> bool:
        """Whether the last sample was taken: it was finite, and later than the one before."""
        return self._library.palpate_stream_accepted(self._handle) != 0

    @property
    def out_of_domain(self) -> bool:
        """Whether the last accepted sample was out of the domain of the recordings."""
        return self._library.palpate_stream_out_of_domain(self._handle) != 0


class Limiter(Handle):
    """The stages before an actuator: palpate_limiter of palpate.h. One thread at a time.

    `lag_s`: of the force behind the motion, for `render`: transport, waits, half the time for which a force is held.
    The others are fields of palpate_limits: largest_N [10], fastest_N_per_s [2000], ramp_s after a start or a stop
    [0.3], continuous_N [no thermal limit], thermal_time_s [10], stale_after_s [0.01], stop_s [0.01].
    """

    def __init__(self, *, lag_s: float = 0.0, **limits: float):
        given = Limits()
        library().palpate_limits_default(given)
        names = [name for name, _ in Limits._fields_]
        for name, value in limits.items():
            if name not in names:
                raise Error("found the limit %r, expected lag_s, %s" % (name, ", ".join(names)))
            setattr(given, name, number(name, value))
        self._library = library()
        super().__init__(call("palpate_limiter_new", given), self._library.palpate_limiter_free)
        self.set_lag(lag_s)

    def render(self, stream: Stream, time_s: float, position_m: float, step_s: float) -> float:
        """The force on a hand [N]: takes the next sample into the stream, then applies stability limit, passivity
        controller and limiter. `step_s`: since the last call. A limiter belongs to one stream."""
        return self._library.palpate_limiter_render(self._handle, expect("stream", stream, Stream)._handle,
                                                    number("time_s", time_s), number("position_m", position_m),
                                                    number("step_s", step_s))

    def set_lag(self, lag_s: float) -> None:
        """Sets `lag_s`, for a lag that changes. Raises `Error`: below 0 or not finite."""
        if self._library.palpate_limiter_set_lag(self._handle, number("lag_s", lag_s)) != 0:
            raise Error("lag_s: found %r, expected 0 or more" % lag_s)

    def acted(self, sampled_s: float) -> None:
        """For a device that reports which command acts, before each `render`: the force that acted at the sample to
        come was computed from the sample of the time `sampled_s`; NaN: not known. The limiter measures its lag so."""
        self._library.palpate_limiter_acted(self._handle, number("sampled_s", sampled_s))

    def force(self, commanded_N: float, step_s: float, sample_age_s: float = 0.0) -> float:
        """The limiter alone: the force to render instead of `commanded_N`, always finite [N]."""
        return self._library.palpate_limiter_force(self._handle, number("commanded_N", commanded_N),
                                                   number("step_s", step_s), number("sample_age_s", sample_age_s))

    def stop(self) -> None:
        """The next force goes towards 0; to be called once per tick while a fault lasts."""
        self._library.palpate_limiter_stop(self._handle)

    @property
    def stiffness_share(self) -> float:
        """The part of the model's force that stability leaves with the lag of the loop; 1: all. Below 0.95
        flag 128 is set."""
        return self._library.palpate_limiter_stiffness_share(self._handle)

    @property
    def flags(self) -> int:
        """Bits PALPATE_LIMIT_... of palpate.h: what the limiter did to the last force."""
        return self._library.palpate_limiter_flags(self._handle)
