"""Find which limits bind a leg, where, and how far one of them alone would have to rise."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise
from math import asin, degrees, inf
from typing import NamedTuple

import numpy as np

from shotc.diag.model import Label
from shotc.geom.bernstein import Array
from shotc.geom.pieces import Mask
from shotc.ir.drone import Drone
from shotc.ir.limits import G_M_S2
from shotc.ir.mission import MissionIR
from shotc.ir.path import Mark, PathLeg
from shotc.planning.timing.flown import usages
from shotc.planning.timing.limits import Ceiling, ceiling_of
from shotc.planning.timing.move import TimedMove, axes_of
from shotc.rounding import up
from shotc.source.file import Span

# Share of a limit above which it binds a piece.
BINDING_SHARE = 0.97
# Factor on a proposed limit, because the path changes slightly with the limits.
BENDING_RATIO = 1.004
# Largest factor of a limit that is proposed; bisection steps for the least one.
HIGHEST_RATIO = 4.0
LIMIT_HALVINGS = 7
# Sine of the steepest tilt that is proposed, 60 deg.
HIGHEST_TILT_SINE = 0.866


@dataclass(frozen=True, slots=True)
class _Shown:
    key: tuple[str, str]
    words: str
    unit: str
    angular: bool = False


_SHOWN = {
    "speed": _Shown(("limits", "speed"), "speed", "m/s"),
    "climb": _Shown(("limits", "climb"), "climb", "m/s"),
    "descent": _Shown(("limits", "descent"), "descent", "m/s"),
    "acceleration": _Shown(("limits", "acceleration"), "acceleration", "m/s^2"),
    "tilt": _Shown(("limits", "tilt"), "tilt", "deg", True),
    "thrust_to_weight": _Shown(("limits", "thrust_to_weight"), "thrust", "times the weight"),
    "jerk": _Shown(("limits", "jerk"), "jerk", "m/s^3"),
    "yaw_rate": _Shown(("limits", "yaw_rate"), "yaw rate", "deg/s", True),
    "yaw_acceleration": _Shown(("limits", "yaw_acceleration"), "yaw acceleration", "deg/s^2", True),
    "gimbal_rate": _Shown(("gimbal", "rate"), "gimbal rate", "deg/s", True),
    "gimbal_acceleration": _Shown(("gimbal", "acceleration"), "gimbal acceleration", "deg/s^2", True),
    "zoom_rate": _Shown(("camera", "zoom_rate"), "zoom rate", "deg/s", True),
}


@dataclass(frozen=True, slots=True)
class KeyframeInterval:
    """The flight time between two neighbouring keyframes, seconds, and how long each limit binds there.

    where : which two, as a phrase
    """

    where: str
    seconds: float
    held: dict[str, float]


@dataclass(frozen=True, slots=True)
class Holdup:
    """The limits that bind moves at full limits.

    stretches : intervals between keyframes where a limit binds, the slowest first
    names : of the limits that bind, the longest first
    """

    stretches: tuple[KeyframeInterval, ...]
    names: tuple[str, ...]


def binding(leg: PathLeg, moves: tuple[TimedMove, ...], ceiling: Ceiling) -> Holdup:
    """Return the limits that bind the moves of a leg."""
    pieces = [_held(move, ceiling) for move in moves]
    marks = sorted(leg.marks, key=lambda m: (m.s, m.index))
    stretches = []
    for a, b in pairwise(marks):
        held: dict[str, float] = {}
        seconds = 0.0
        for each in pieces:
            inside = (each.middle > a.s) & (each.middle < b.s)
            seconds += float(each.seconds[inside].sum())
            for name, where in each.held.items():
                held[name] = held.get(name, 0.0) + float(each.seconds[inside & where].sum())
        stretches.append(
            KeyframeInterval(_where(marks, a, b), seconds, {n: t for n, t in held.items() if t > 0})
        )
    total: dict[str, float] = {}
    for stretch in stretches:
        for name, time in stretch.held.items():
            total[name] = total.get(name, 0.0) + time
    names = tuple(sorted(total, key=lambda name: -total[name]))
    bound = sorted((s for s in stretches if s.held), key=lambda s: -s.seconds)
    return Holdup(tuple(bound), names)


def _where(marks: Sequence[Mark], a: Mark, b: Mark) -> str:
    """Return the keyframes of an interval as a phrase; for generated ones its share of the path."""
    if len({mark.path for mark in marks}) == len(marks):
        return f"from keyframe {a.index + 1} to {b.index + 1}"
    first, whole = marks[0].s, marks[-1].s - marks[0].s or 1.0
    low, high = ((mark.s - first) / whole for mark in (a, b))
    return f"from {low:.0%} to {high:.0%} of its way".replace("%", " %")


class _Pieces(NamedTuple):
    """Pieces of a move: s of their middles, durations in seconds, (P,), and by limit where it binds."""

    middle: Array
    seconds: Array
    held: dict[str, Mask]


def _held(move: TimedMove, ceiling: Ceiling) -> _Pieces:
    profile = move.profile
    limits = axes_of(move.path, (float(profile.s[0]), float(profile.s[-1])), ceiling)
    held: dict[str, Mask] = {}
    for usage in usages(move.curve, limits):
        held[usage.name] = held.get(usage.name, False) | (usage.share > BINDING_SHARE)
    return _Pieces(0.5 * (profile.s[1:] + profile.s[:-1]), np.diff(profile.t), held)


def binding_notes(mission: MissionIR, drone: Drone, holdup: Holdup) -> tuple[str, ...]:
    """Return up to three notes on which limits bind and where."""
    notes = []
    for stretch in holdup.stretches[:3]:
        longest = sorted(stretch.held, key=lambda name: -stretch.held[name])[:2]
        binds = " and ".join(
            f"{shown_limit(mission, drone, name)} for {stretch.held[name]:.1f} s" for name in longest
        )
        notes.append(f"{stretch.where} it takes {stretch.seconds:.1f} s, held back by {binds}")
    return tuple(notes)


def binding_labels(mission: MissionIR, drone: Drone, holdup: Holdup) -> tuple[Label, ...]:
    """Return labels on the limits that bind, at most two, and on the wind if it lowers one."""
    by_span: dict[Span, Label] = {}
    for name in holdup.names[:2]:
        limit = _shown_limit(drone, name)
        label = mission.origins.value((*drone.path, *limit.key), limit.words)
        before = by_span.get(label.span)
        by_span[label.span] = (
            label if before is None else before._replace(text=f"{before.text} and {label.text}")
        )
    labels = tuple(
        label._replace(text=f"{label.text} bind{'' if ' and ' in label.text else 's'}")
        for label in by_span.values()
    )
    if "speed" in holdup.names[:2] and mission.wind > 0:
        words = "takes a part of the speed" if mission.wind_taken else "the wind"
        labels += (mission.origins.value(("world", "wind"), words),)
    return labels


def raises(
    mission: MissionIR, drone: Drone, names: tuple[str, ...], enough: Callable[[Ceiling], bool]
) -> list[str]:
    """Return, for each named limit that is sufficient alone, how far to raise it, as text."""
    full = ceiling_of(drone)
    texts = []
    for name in names:
        factor = _least_factor(partial(_with, enough, full, name))
        if factor is not None and BENDING_RATIO * factor <= _alone(drone, name):
            key = ".".join(_shown_limit(drone, name).key)
            texts.append(f"raise `{key}` to {limit_text(mission, drone, name, factor)}")
    return texts


def _shown_limit(drone: Drone, name: str) -> _Shown:
    """Return how the mission's limit behind a limit of the ceiling is shown."""
    if name != "acceleration":
        return _SHOWN[name]
    bounds = drone.limits.acceleration_bounds
    return _SHOWN[min(bounds, key=lambda bound: bounds[bound])]


def _alone(drone: Drone, name: str) -> float:
    """Return the largest factor of a limit of the ceiling when only one limit of the mission rises."""
    if name != "acceleration":
        return inf
    least, following, _ = sorted(drone.limits.acceleration_bounds.values())
    if _shown_limit(drone, name) is _SHOWN["tilt"]:
        following = min(following, HIGHEST_TILT_SINE * G_M_S2)
    return following / least


def _with(enough: Callable[[Ceiling], bool], full: Ceiling, name: str, factor: float) -> bool:
    return enough(replace(full, **{name: factor * getattr(full, name)}))


def _least_factor(enough: Callable[[float], bool]) -> float | None:
    low, high = 1.0, HIGHEST_RATIO
    if not enough(high):
        return None
    for _ in range(LIMIT_HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if enough(middle) else (middle, high)
    return high


def shown_limit(mission: MissionIR, drone: Drone, name: str) -> str:
    """Return a limit with its name, and the part that the wind takes."""
    wind = ""
    if name == "speed" and mission.wind > 0:
        wind = f" less {mission.wind:.2f} m/s of wind" if mission.wind_taken else " in the wind"
    return f"{_shown_limit(drone, name).words} {limit_text(mission, drone, name)}{wind}"


def limit_text(mission: MissionIR, drone: Drone, name: str, factor: float = 1.0) -> str:
    """Return a limit in the mission's unit, multiplied by a factor and then rounded up."""
    limit = _shown_limit(drone, name)
    value = factor * getattr(ceiling_of(drone), name)
    if factor == 1.0:
        return f"{_written(mission, limit, value):.2f} {limit.unit}"
    return f"{up(_written(mission, limit, value, BENDING_RATIO)):.2f} {limit.unit}"


def _written(mission: MissionIR, shown: _Shown, value: float, share: float = 1.0) -> float:
    """Return a limit of the ceiling, SI, as the number written in the mission, times a factor."""
    if shown is _SHOWN["tilt"]:
        return degrees(asin(share * value / G_M_S2))
    if shown is _SHOWN["thrust_to_weight"]:
        return 1.0 + share * value / G_M_S2
    value = degrees(value) if shown.angular else value
    return share * (value + mission.wind_taken if shown is _SHOWN["speed"] else value)
