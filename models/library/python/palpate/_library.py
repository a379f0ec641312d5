"""The C library of the package: its location, its functions, and the conversion of arrays for it."""
import ctypes
import functools
import os
import pathlib

import numpy as np

ABI_VERSION = 2
_ERROR_BYTES = 4096
_NAME = "libpalpate_fit.so"


class Error(Exception):
    """A file, an array or an option is not valid.

    The text has the value found, the value expected and advice.
    """


class SensorStruct(ctypes.Structure):
    _fields_ = [("encoder_step_m", ctypes.c_double), ("position_noise_m", ctypes.c_double),
                ("velocity_noise_m_per_s", ctypes.c_double), ("acceleration_noise_m_per_s2", ctypes.c_double),
                ("has_velocity", ctypes.c_int), ("has_acceleration", ctypes.c_int)]


class CheckStruct(ctypes.Structure):
    _fields_ = [("usable", ctypes.c_int), ("noise_floor_within_jnd", ctypes.c_double),
                ("surface_offset_m", ctypes.c_double), ("force_zero_N", ctypes.c_double)]


Progress = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_double, ctypes.c_void_p)


class FitOptionsStruct(ctypes.Structure):
    _fields_ = [("method", ctypes.c_char_p), ("centres", ctypes.c_int), ("candidates", ctypes.c_char_p),
                ("kernel", ctypes.c_char_p), ("weighting", ctypes.c_char_p), ("reduction", ctypes.c_char_p),
                ("recipe", ctypes.c_char_p), ("features", ctypes.c_char_p), ("relaxation", ctypes.c_char_p),
                ("surface", ctypes.c_char_p), ("grid", ctypes.c_char_p), ("seed", ctypes.c_ulonglong),
                ("scene", ctypes.c_char_p), ("scene_features", ctypes.c_char_p), ("jnd_offset_N", ctypes.c_double),
                ("jnd_weber_fraction", ctypes.c_double), ("overwrite", ctypes.c_int), ("progress", Progress),
                ("context", ctypes.c_void_p)]


_HANDLE, _TEXT, _INT, _SIZE, _DOUBLE = (ctypes.c_void_p, ctypes.c_char_p, ctypes.c_int, ctypes.c_size_t,
                                        ctypes.c_double)
_ARRAY = ctypes.c_void_p  # of doubles, contiguous; None: NULL
_SENSOR = ctypes.POINTER(SensorStruct)
_MESSAGE = [ctypes.c_char_p, ctypes.c_size_t]

_SIGNATURES = {
    "palpate_abi_version": (_INT, []),
    "palpate_model_load": (_HANDLE, [_TEXT, *_MESSAGE]),
    "palpate_model_free": (None, [_HANDLE]),
    "palpate_model_name": (_TEXT, [_HANDLE]),
    "palpate_model_report": (_TEXT, [_HANDLE]),
    "palpate_model_save": (_INT, [_HANDLE, _TEXT, _INT, *_MESSAGE]),
    "palpate_model_export_c": (_INT, [_HANDLE, _DOUBLE, _INT, _TEXT, _INT, *_MESSAGE]),
    "palpate_model_feature_count": (_SIZE, [_HANDLE]),
    "palpate_model_feature_name": (_TEXT, [_HANDLE, _SIZE]),
    "palpate_model_evaluate": (_INT, [_HANDLE, _SIZE, *[_ARRAY] * 5]),
    "palpate_jnd_N": (_DOUBLE, [_HANDLE, _DOUBLE]),
    "palpate_stream_new_with_sensor": (_HANDLE, [_HANDLE, _SENSOR, *_MESSAGE]),
    "palpate_stream_free": (None, [_HANDLE]),
    "palpate_stream_forces_with_motion": (_INT, [_HANDLE, _SIZE, *[_ARRAY] * 7]),
    "palpate_sensor_of_samples": (_INT, [_SIZE, *[_ARRAY] * 4, _SENSOR]),
    "palpate_in_contact": (_INT, [_SIZE, *[_ARRAY] * 3]),
    "palpate_recording_load": (_HANDLE, [_TEXT, *_MESSAGE]),
    "palpate_recording_new": (_HANDLE, [_TEXT, _SIZE, *[_ARRAY] * 6, *_MESSAGE]),
    "palpate_recording_free": (None, [_HANDLE]),
    "palpate_recording_name": (_TEXT, [_HANDLE]),
    "palpate_recording_has_velocity": (_INT, [_HANDLE]),
    "palpate_recording_has_acceleration": (_INT, [_HANDLE]),
    "palpate_recording_row_count": (_SIZE, [_HANDLE]),
    "palpate_recording_rows": (_ARRAY, [_HANDLE]),
    "palpate_import": (_INT, [_TEXT, _TEXT, _INT, *_MESSAGE]),
    "palpate_check": (_INT, [_TEXT, ctypes.POINTER(CheckStruct), _TEXT, _SIZE, *_MESSAGE]),
    "palpate_fit_options_default": (None, [ctypes.POINTER(FitOptionsStruct)]),
    "palpate_fit_recordings": (_HANDLE, [ctypes.POINTER(_HANDLE), _SIZE, ctypes.POINTER(FitOptionsStruct), *_MESSAGE]),
    "palpate_folds": (_INT, [_SIZE, *[_ARRAY] * 3]),
}


def source_tree():
    """The source tree that this file is in, or None for an installed package."""
    folder = pathlib.Path(__file__).resolve().parents[4]
    return folder if (folder / "models" / "library" / "palpate" / "palpate.h").is_file() else None


def assets():
    """The folder of the scenes: that of the source tree, or the one installed beside the package."""
    tree = source_tree()
    return tree / "assets" if tree else pathlib.Path(__file__).resolve().parents[4] / "share" / "palpate"


@functools.lru_cache(maxsize=None)
def library():
    """The loaded library: PALPATE_LIBRARY, else that of the source tree's build, else the installed one."""
    tree = source_tree()
    path = os.environ.get("PALPATE_LIBRARY") or (
        str(tree / "build" / "models" / "library" / _NAME) if tree else "%s.%d" % (_NAME, ABI_VERSION))
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
    if result is None or result == -1:
        text = message.value.decode(errors="replace")
        raise Error(text.replace("pass --force to", "pass overwrite=True to"))
    return result


def path_bytes(path):
    try:
        return os.fsencode(path)
    except TypeError:
        raise Error("path: found %s, expected the name of a file" % type(path).__name__) from None


def doubles(name, values, shape=(None,)):
    """`values` as contiguous doubles of `shape`, in which None stands for any length."""
    array = np.asarray(values)
    if array.dtype.kind not in "fiu":
        raise Error("%s: found dtype %s, expected numbers" % (name, array.dtype))
    if array.ndim != len(shape) or any(want not in (None, have) for want, have in zip(shape, array.shape)):
        expected = str(tuple("any" if want is None else want for want in shape)).replace("'", "")
        raise Error("%s: found shape %s, expected %s" % (name, array.shape, expected))
    return np.ascontiguousarray(array, dtype=np.float64)


def address(array):
    """The address of an array for an argument of the library; NULL for None."""
    return None if array is None else array.ctypes.data
