"""A loop that closes over a hand: a stream of samples, and the stages before an actuator."""
from __future__ import annotations

from ._library import Error, Handle, Limits, Sensor, call, expect, library, new_stream, number
from ._models import Model


class Stream(Handle):
    """One tool in one material: palpate_stream of palpate.h. One thread at a time.

    Parameters
    ----------
    model : Model
        May be deleted before the stream.
    sensor : Sensor or float, optional
        A number is the step of an encoder [m]. 0, the default: the sensor of the model's recordings. Of exact
        positions: ``Sensor()``.
    """

    def __init__(self, model: Model, sensor: Sensor | float = 0):
        self._library = library()
        super().__init__(new_stream(expect("model", model, Model)._handle, sensor), self._library.palpate_stream_free)

    def force(self, time_s: float, position_m: float) -> float:
        """Takes the next sample and returns the force of the material [N]; 0 if the sample is refused (see `accepted`).

        For a hand use `Limiter.render`.
        """
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

    Parameters
    ----------
    lag_s : float, optional
        The lag of the force behind the motion, for `render`: transport, waits, half the time for which a force is held.
        At least 1.5 times the interval between calls is assumed.
    largest_N, fastest_N_per_s, ramp_s, continuous_N, thermal_time_s, stale_after_s, stop_s : float, optional
        Fields of palpate_limits: peak [10], rate of change [2000], ramp after a start or a stop [0.3], thermal limit
        [none], largest age of a sample [0.01], time of a stop [0.01].
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

    def force(self, commanded_N: float, step_s: float, sample_age_s: float = 0.0) -> float:
        """The limiter alone: the force to render instead of `commanded_N`, always finite [N]."""
        return self._library.palpate_limiter_force(self._handle, number("commanded_N", commanded_N),
                                                   number("step_s", step_s), number("sample_age_s", sample_age_s))

    def stop(self) -> None:
        """The next force goes towards 0; to be called once per tick while a fault lasts."""
        self._library.palpate_limiter_stop(self._handle)

    @property
    def stiffness_share(self) -> float:
        """The part of the model's force that stability leaves with the lag of the loop; 1: all. Below 0.95 the material
        is noticeably softer than the model (flag 128)."""
        return self._library.palpate_limiter_stiffness_share(self._handle)

    @property
    def flags(self) -> int:
        """Bits PALPATE_LIMIT_... of palpate.h: what the limiter did to the last force."""
        return self._library.palpate_limiter_flags(self._handle)
