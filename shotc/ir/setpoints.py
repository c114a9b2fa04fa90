"""Setpoints: the required appearance of a subject at times of its shot, and between them. Plain Python.

A value changes from one setpoint to the next as the quintic polynomial of minimum jerk, which rests at both
ends and does not overshoot. For sizes the polynomial is in their logarithm, so that the zoom is even on
screen. Bearings turn the shorter way.
"""

from collections.abc import Callable, Sequence
from math import exp, log, remainder, tau
from typing import NamedTuple, TypeVar

from shotc.geom.ease import minimum_jerk
from shotc.geom.vec import Vec2
from shotc.ir.origin import KeyPath

ViewAngles = tuple[float | None, float | None]
_Value = TypeVar("_Value")


class Setpoint(NamedTuple):
    """The required appearance of a subject at a time of its shot.

    time : seconds from the first frame
    place : (u, v) of its centre; size, view : as in ``mission.Subject``; None changes nothing
    """

    time: float
    place: Vec2 | None
    size: float | None
    view: ViewAngles | None
    path: KeyPath


class Asked(NamedTuple):
    """The required appearance of a subject at one time; None is free. place : (u, v) of its centre."""

    place: Vec2 | None
    size: float | None
    view: ViewAngles | None


def required_at(first: Asked, setpoints: Sequence[Setpoint], time: float) -> Asked:
    """Return the required appearance at a time of its shot, seconds; first : that at the first frame."""
    if not setpoints:
        return first
    place = None if first.place is None else _place_at(first.place, setpoints, time)
    size = None if first.size is None else exp(_eased(_sizes(first.size, setpoints), time))
    if first.view is None:
        return Asked(place, size, None)
    azimuth, elevation = first.view
    if azimuth is not None:
        azimuth = _eased(_angles(azimuth, setpoints), time)
    if elevation is not None:
        elevation = _eased(_changes(elevation, setpoints, _elevation), time)
    return Asked(place, size, (azimuth, elevation))


def required_places(first: Vec2, setpoints: Sequence[Setpoint]) -> list[tuple[float, Vec2]]:
    """Return the times, from 0 on, at which a subject has a required place on screen, and these places."""
    return _changes(first, setpoints, lambda setpoint: setpoint.place)


def _place_at(first: Vec2, setpoints: Sequence[Setpoint], time: float) -> Vec2:
    known = required_places(first, setpoints)
    u, v = (_eased([(t, place[k]) for t, place in known], time) for k in range(2))
    return (u, v)


def _sizes(first: float, setpoints: Sequence[Setpoint]) -> list[tuple[float, float]]:
    return [(t, log(size)) for t, size in _changes(first, setpoints, lambda setpoint: setpoint.size)]


def _angles(first: float, setpoints: Sequence[Setpoint]) -> list[tuple[float, float]]:
    """Return unwrapped bearings: each is the nearest equivalent to the one before."""
    known = _changes(first, setpoints, _azimuth)
    turned = known[:1]
    for time, angle in known[1:]:
        before = turned[-1][1]
        turned.append((time, before + remainder(angle - before, tau)))
    return turned


def _changes(
    first: _Value, setpoints: Sequence[Setpoint], of: Callable[[Setpoint], _Value | None]
) -> list[tuple[float, _Value]]:
    changes = [(0.0, first)]
    for setpoint in setpoints:
        value = of(setpoint)
        if value is not None:
            changes.append((setpoint.time, value))
    return changes


def _azimuth(setpoint: Setpoint) -> float | None:
    return None if setpoint.view is None else setpoint.view[0]


def _elevation(setpoint: Setpoint) -> float | None:
    return None if setpoint.view is None else setpoint.view[1]


def _eased(known: Sequence[tuple[float, float]], time: float) -> float:
    """Return the value at a time; it is constant before the first and after the last setpoint."""
    before, value = known[0]
    for after, next_value in known[1:]:
        if time < after:
            x = max(0.0, (time - before) / (after - before))
            return value + minimum_jerk(x) * (next_value - value)
        before, value = after, next_value
    return value
