"""Data-driven haptic rendering in Python: recordings of pressed materials, force models, their error.

    import palpate

    rec = palpate.read_recording("rec.csv")              # structured array, units in the names
    model = palpate.fit([rec], method="greedy", centres=100)     # or palpate.load("model.json")
    force_N, bound_N = model.render(rec["time_s"], rec["position_m"])
    share = palpate.within_jnd(force_N, rec["force_N"])  # of the samples in contact
    u = model.features(rec["time_s"], rec["position_m"])  # columns: model.feature_names
    model.save("model.json")

    stream, limiter = palpate.Stream(model), palpate.Limiter(largest_N=5)    # a loop of your own, 1 kHz
    device.push(limiter.render(stream, time_s, position_m, step_s))

A recording is a `palpate.Recording`: a structured numpy array with the fields time_s, position_m and force_N
(velocity_m_per_s and acceleration_m_per_s2 where they were measured), and a name. `fit` also takes any structured array
or table with these columns, or the path of a file.

Units are SI. Positions run along the inward surface normal, 0 at the undisturbed surface; forces are
positive when the material pushes the tool out. One just noticeable difference (JND) is the
difference that people notice in three of four trials. An invalid file, array or option raises `Error`. Arrays may be of
any numeric type and need not be contiguous. An argument of a wrong type is a `TypeError`, too.

The package loads ``libpalpate_fit``: the one named by the environment variable PALPATE_LIBRARY, else the one that pip
put beside it, else that of the source tree's ``build`` when it is imported from there, else the installed one.
"""
from ._library import Error, Sensor, library
from ._models import Limiter, Model, Stream, fit, load
from ._recordings import Recording, in_contact, jnd_N, make_recording, read_recording, within_jnd

# Without Recording, whose help would be that of all numpy arrays.
__all__ = ["Error", "Limiter", "Model", "Sensor", "Stream", "fit", "in_contact", "jnd_N", "load", "make_recording",
           "read_recording", "within_jnd"]


def __getattr__(name):
    if name == "__version__":  # that of the library, which is loaded only when it is needed
        return library().palpate_version().decode()
    raise AttributeError("module %r has no attribute %r" % (__name__, name))
