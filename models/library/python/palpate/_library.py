"""The C library of the package: its location, its functions, and the conversion of arrays for it."""
import ctypes
import functools
import os
import pathlib

import numpy as np

ABI_VERSION = 3
_ERROR_BYTES = 4096
_NAME = "libpalpate_fit.so"

REQUIRED = ("time_s", "position_m", "force_N")
COLUMNS = (*REQUIRED, "velocity_m_per_s", "acceleration_m_per_s2")


class Error(Exception):
    """A file, an array or an option is not valid.

    The text has the value found, the value expected and advice.
    """


class WrongType(Error, TypeError):
    """An argument has a wrong type."""


class Handle:
    """An object of the library, freed with its owner."""

    def __init__(self, handle, free):
        self._handle, self._free = handle, free

    def __del__(self):
        if getattr(self, "_handle", None):
            self._free(self._handle)

    def __reduce__(self):
        raise Error("a palpate.%s cannot be pickled; save the model to a file" % type(self).__name__)


class Sensor(ctypes.Structure):
    """The sensor of the tool.

    Attributes
    ----------
    encoder_step_m : float
        Step of the positions, 0: exact.
    position_noise_m : float
        Standard deviation of the positions in addition to the quantisation.
    velocity_noise_m_per_s, acceleration_noise_m_per_s2 : float
        Standard deviations of the measured channels; 0: not measured.
    """

    _fields_ = [(name, ctypes.c_double) for name in
                ("encoder_step_m", "position_noise_m", "velocity_noise_m_per_s", "acceleration_noise_m_per_s2")]

    def __repr__(self):
        return "Sensor(%s)" % ", ".join("%s=%r" % (name, getattr(self, name)) for name, _ in self._fields_)


def expect(name, given, kind):
    """`given`, an object of this class of the package."""
    if not isinstance(given, kind):
        raise WrongType("%s: found %s, expected a palpate.%s" % (name, type(given).__name__, kind.__name__))
    return given


def number(name, given, expected="a number"):
    """`given` as a float."""
    if isinstance(given, float) or (isinstance(given, (int, np.number)) and not isinstance(given, bool)):
        return float(given)
    raise WrongType("%s: found %s, expected %s" % (name, type(given).__name__, expected))


def new_stream(model_handle, sensor):
    """A handle. `sensor`: a `Sensor`, or the step of an encoder in metres; None or 0: that of the recordings."""
    if isinstance(sensor, Sensor):
        return call("palpate_stream_new_with_sensor", model_handle, sensor)
    step_m = number("sensor", 0 if sensor is None else sensor, "a palpate.Sensor or the encoder's step in metres")
    return call("palpate_stream_new", model_handle, step_m)


class RecordingStruct(ctypes.Structure):
    """A recording in columns; `of` keeps them in `arrays`, so that they live as long as the struct."""

    _fields_ = [("name", ctypes.c_char_p), ("size", ctypes.c_size_t),
                *((column, ctypes.POINTER(ctypes.c_double)) for column in COLUMNS)]

    @classmethod
    def of(cls, columns, name="recording"):
        """`columns`: arrays of one length by their names; None where there is no velocity or acceleration."""
        arrays = {column: doubles(column, values) for column, values in columns.items()
                  if values is not None or column in REQUIRED}
        size = len(arrays["position_m"])
        for column, array in arrays.items():
            if len(array) != size:
                raise Error("%s: found %d values, expected %d as of position_m" % (column, len(array), size))
        struct = cls(as_bytes("name", name), size)
        for column, array in arrays.items():
            setattr(struct, column, array.ctypes.data_as(ctypes.POINTER(ctypes.c_double)))
        struct.arrays = arrays
        return struct


_HANDLE, _TEXT, _INT, _SIZE, _DOUBLE = (ctypes.c_void_p, ctypes.c_char_p, ctypes.c_int, ctypes.c_size_t,
                                        ctypes.c_double)
_ARRAY = ctypes.c_void_p
_RECORDING = ctypes.POINTER(RecordingStruct)
_MESSAGE = [ctypes.c_char_p, ctypes.c_size_t]
Progress = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_double, ctypes.c_void_p)


class Limits(ctypes.Structure):
    """palpate_limits of palpate.h."""

    _fields_ = [(name, ctypes.c_double) for name in
                ("largest_N", "fastest_N_per_s", "ramp_s", "continuous_N", "thermal_time_s", "stale_after_s", "stop_s")]


_SIGNATURES = {
    "palpate_abi_version": (_INT, []),
    "palpate_version": (_TEXT, []),
    "palpate_model_load": (_HANDLE, [_TEXT, *_MESSAGE]),
    "palpate_model_free": (None, [_HANDLE]),
    "palpate_model_name": (_TEXT, [_HANDLE]),
    "palpate_model_report": (_TEXT, [_HANDLE]),
    "palpate_model_save": (_INT, [_HANDLE, _TEXT, _INT, *_MESSAGE]),
    "palpate_model_feature_count": (_SIZE, [_HANDLE]),
    "palpate_model_feature_name": (_TEXT, [_HANDLE, _SIZE]),
    "palpate_recording_load": (_RECORDING, [_TEXT, *_MESSAGE]),
    "palpate_recording_free": (None, [_RECORDING]),
    "palpate_in_contact": (_INT, [_RECORDING, _ARRAY]),
    "palpate_sensor_of": (_INT, [_RECORDING, ctypes.POINTER(Sensor)]),
    "palpate_stream_new_with_sensor": (_HANDLE, [_HANDLE, ctypes.POINTER(Sensor), *_MESSAGE]),
    "palpate_stream_new": (_HANDLE, [_HANDLE, _DOUBLE, *_MESSAGE]),
    "palpate_stream_start_after": (_INT, [_HANDLE, _RECORDING, *_MESSAGE]),
    "palpate_stream_free": (None, [_HANDLE]),
    "palpate_stream_reset": (None, [_HANDLE]),
    "palpate_stream_force": (_DOUBLE, [_HANDLE, _DOUBLE, _DOUBLE]),
    "palpate_stream_accepted": (_INT, [_HANDLE]),
    "palpate_stream_out_of_domain": (_INT, [_HANDLE]),
    "palpate_stream_predicted_error": (_DOUBLE, [_HANDLE]),
    "palpate_stream_replay": (_INT, [_HANDLE, _RECORDING, _ARRAY, _ARRAY, _ARRAY]),
    "palpate_limits_default": (None, [ctypes.POINTER(Limits)]),
    "palpate_limiter_new": (_HANDLE, [ctypes.POINTER(Limits), *_MESSAGE]),
    "palpate_limiter_free": (None, [_HANDLE]),
    "palpate_limiter_render": (_DOUBLE, [_HANDLE, _HANDLE, _DOUBLE, _DOUBLE, _DOUBLE]),
    "palpate_limiter_set_lag": (_INT, [_HANDLE, _DOUBLE]),
    "palpate_limiter_acted": (None, [_HANDLE, _DOUBLE]),
    "palpate_limiter_stiffness_share": (_DOUBLE, [_HANDLE]),
    "palpate_limiter_force": (_DOUBLE, [_HANDLE, _DOUBLE, _DOUBLE, _DOUBLE]),
    "palpate_limiter_stop": (None, [_HANDLE]),
    "palpate_limiter_flags": (ctypes.c_uint, [_HANDLE]),
    "palpate_fit": (_HANDLE, [_RECORDING, _SIZE, _TEXT, Progress, ctypes.c_void_p, *_MESSAGE]),
}


@functools.lru_cache(maxsize=None)
def library():
    """The loaded library: PALPATE_LIBRARY, else the one beside this file (pip), else that of the source tree's build,
    else the installed one."""
    here = pathlib.Path(__file__).resolve()
    tree = here.parents[min(4, len(here.parents) - 1)]
    beside = here.with_name(_NAME)
    in_tree = (tree / "models" / "library" / "palpate" / "palpate.h").is_file()
    path = os.environ.get("PALPATE_LIBRARY") or (str(beside) if beside.is_file() else
        str(tree / "build" / "models" / "library" / _NAME) if in_tree else "%s.%d" % (_NAME, ABI_VERSION))
    try:
        loaded = ctypes.CDLL(path)
        found = loaded.palpate_abi_version()
        functions = {name: getattr(loaded, name) for name in _SIGNATURES} if found == ABI_VERSION else {}
    except (OSError, AttributeError) as error:
        raise Error("found no %s (%s); build it with: cmake --build build --target palpate_fit_shared, or name "
                    "the file in the environment variable PALPATE_LIBRARY" % (_NAME, error)) from None
    if found != ABI_VERSION:
        raise Error("%s: found ABI version %d, expected %d; build it again" % (path, found, ABI_VERSION))
    for name, function in functions.items():
        function.restype, function.argtypes = _SIGNATURES[name]
    return loaded


def call(name, *arguments):
    """Calls a function that can fail. Adds its last two arguments, which receive the error message."""
    message = ctypes.create_string_buffer(_ERROR_BYTES)
    result = getattr(library(), name)(*arguments, message, _ERROR_BYTES)
    if result == -1 or (result != 0 and not result):
        text = message.value.decode(errors="replace")
        raise Error(text.replace("pass --force to", "pass overwrite=True to"))
    return result


def as_bytes(name, text):
    """The bytes of a text or a path, for C, which ends a text at its first zero."""
    try:
        given = os.fsencode(text)
    except TypeError:
        raise WrongType("%s: found %s, expected a text" % (name, type(text).__name__)) from None
    if b"\0" in given:
        raise Error("%s: found a zero byte in %r, expected none" % (name, text))
    return given


def doubles(name, values):
    """`values` as contiguous doubles in one dimension."""
    array = np.asarray(values)
    found = ("None" if values is None else "masked values" if np.ma.is_masked(values) else
             "dtype %s" % array.dtype if array.dtype.kind not in "fiu" else
             "shape %s" % (array.shape,) if array.ndim != 1 else None)
    if found:
        raise WrongType("%s: found %s, expected numbers in one dimension, without a mask" % (name, found))
    return np.ascontiguousarray(array, dtype=np.float64)
