"""The lights of a fleet: off during rise and descent, each frame's colours while it stands, fades in between.

Effects of a picture are applied to its own colours and fade with them. Effects of a transition, a hold or a
whole display are applied on top of all (``ir.light_layers``).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import groupby
from typing import NamedTuple

import numpy as np

from shotc.diag.model import Diagnostic
from shotc.geom.bernstein import Array
from shotc.geom.fleet_spline import places
from shotc.ir.effects import DisplayTime, Effect
from shotc.ir.fleet import Colors, FleetTrajectory, FrameTimes, Lights, Recorded
from shotc.ir.light_layers import Layer, Look
from shotc.ir.mission import MissionIR
from shotc.ir.show import Display
from shotc.show.assignment import faults
from shotc.show.assignment.layers import EffectContext, Times, counts, layer_of
from shotc.show.assignment.order import OrderedFrame
from shotc.show.goals.footage import ImageFrames

SAME_S = 1e-4
"""Seconds, below which two times count as equal."""

Images = Mapping[str, ImageFrames]
"""The images of a mission's effects, by name."""


class StandingFrame(NamedTuple):
    """A frame and its times."""

    scene: OrderedFrame
    shown: FrameTimes


class LitFrame(NamedTuple):
    """A frame with its times, the positions of all drones, (n, 3), m, and the indices of the dark ones."""

    shown: FrameTimes
    places: Array
    spare: tuple[int, ...]


class _Stood(NamedTuple):
    """A picture of a display: its frames, its times, and those of the neighbouring pictures."""

    display: Display
    number: int
    frames: tuple[LitFrame, ...]
    times: Times


class _Stack(NamedTuple):
    """The effects of a fleet: a look for each frame, in their order, and the layers on top of all."""

    looks: tuple[Look, ...]
    over: tuple[Layer, ...]
    faults: tuple[Diagnostic, ...]


class LightRow(NamedTuple):
    """The colours of all lights at a time, (n, 3), and the frame that they belong to, if any."""

    colors: Colors
    of: StandingFrame | None


Rows = Mapping[float, LightRow]
"""Colours by time; lights fade linearly between these times."""


def rows_of(
    dark: tuple[float, float],
    standing: Sequence[StandingFrame],
    recorded: Sequence[tuple[Recorded, float]] = (),
) -> Rows:
    """Return the lights without effects.

    dark : end of the dark time at the start, and beginning of that at the end, seconds; recorded flights may
        light it
    standing : all frames in order
    recorded : flights with lights of their own, and their start times
    """
    known = {flight.display for flight, _ in recorded}
    black = np.zeros_like(standing[0].scene.colors)
    rows = {dark[0]: LightRow(black, None)}
    for one in standing:
        if one.shown.display not in known:
            rows[one.shown.start] = rows[one.shown.end] = LightRow(one.scene.colors, one)
    rows[dark[1]] = LightRow(black, None)
    for flight, origin in recorded:
        first = next(one for one in standing if one.shown.display == flight.display)
        times = [round(origin + t, 9) for t in flight.lights.times.tolist()]
        rows = {t: row for t, row in rows.items() if not times[0] - SAME_S < t < times[-1] + SAME_S}
        colors = np.moveaxis(flight.lights.colors, 1, 0)
        rows |= {t: LightRow(color, first) for t, color in zip(times, colors, strict=True)}
    return {t: rows[t] for t in sorted(rows)}


def with_effects(
    rows: Rows,
    mission: MissionIR,
    standing: Sequence[StandingFrame],
    dark: tuple[float, float],
    images: Images,
) -> tuple[Lights, list[Diagnostic]]:
    """Return the light programme with the effects of its displays, and diagnostics on them."""
    plain = Lights(np.array(list(rows)), np.stack([row.colors for row in rows.values()], axis=1))
    frames = [LitFrame(one.shown, one.scene.places, one.scene.spare) for one in standing]
    stack = _stacked(mission, frames, dark, images)
    if stack is None:
        return plain, []
    number = {(s.display, s.picture, s.index): k for k, s in enumerate(one.shown for one in standing)}
    shown = (None if row.of is None else row.of.shown for row in rows.values())
    of = tuple(-1 if s is None else number[s.display, s.picture, s.index] for s in shown)
    return replace(plain, looks=stack.looks, of=of, over=stack.over), list(stack.faults)


def laid_out_again(mission: MissionIR, flight: FleetTrajectory, images: Images) -> FleetTrajectory:
    """Return a flight with its effects over the places where its drones are while its frames stand.

    Limits and the separation move the drones of an animation, and of a recorded flight, off their goals.
    """
    lights = flight.lights
    if not lights.looks:
        return flight
    at = places(flight.breaks, flight.coef, np.array([shown.start for shown in flight.shown]))
    frames = [
        LitFrame(shown, at[:, k], look.spare)
        for k, (shown, look) in enumerate(zip(flight.shown, lights.looks, strict=True))
    ]
    dark = (float(lights.times[0]), min(float(lights.times[-1]), flight.phases[-1].end))
    stack = _stacked(mission, frames, dark, images)
    assert stack is not None, "a fleet with looks has effects"
    return replace(flight, lights=replace(lights, looks=stack.looks, over=stack.over))


def _stacked(
    mission: MissionIR, frames: Sequence[LitFrame], dark: tuple[float, float], images: Images
) -> _Stack | None:
    """Return the effects over the frames of a fleet; None if it has none."""
    displays = [mission.display(name) for name in dict.fromkeys(one.shown.display for one in frames)]
    if not any(display.every_effect for display in displays):
        return None
    pictures = _pictures(displays, frames, dark)
    faults_of_lights: list[Diagnostic] = []
    looks: list[Look] = []
    over: list[Layer] = []
    for seed, picture in enumerate(pictures):
        layers, later = _of_picture(mission, picture, images, (seed, faults_of_lights))
        over += later
        looks += [Look(layers, one.spare) for one in picture.frames]
    for display in displays:
        over += _of_display(mission, display, pictures, images, faults_of_lights)
    return _Stack(tuple(looks), tuple(over), tuple(faults_of_lights))


def _pictures(
    displays: Sequence[Display], frames: Sequence[LitFrame], dark: tuple[float, float]
) -> list[_Stood]:
    groups = [
        tuple(some) for _, some in groupby(frames, key=lambda one: (one.shown.display, one.shown.picture))
    ]
    known = {display.id: display for display in displays}
    stood = []
    for k, group in enumerate(groups):
        before = groups[k - 1][-1].shown.end if k else dark[0]
        after = groups[k + 1][0].shown.start if k + 1 < len(groups) else dark[1]
        first, last = group[0].shown, group[-1].shown
        times = Times(before, first.start, last.end, after)
        stood.append(_Stood(known[first.display], first.picture, group, times))
    return stood


def _of_picture(
    mission: MissionIR, picture: _Stood, images: Images, known: tuple[int, list[Diagnostic]]
) -> tuple[tuple[Layer, ...], list[Layer]]:
    """Return the effects that fade with a picture's colours, and those on top of all."""
    seed, faults_of_lights = known
    stage = _stage(picture.display, [picture], images)
    with_it: list[Layer] = []
    over: list[Layer] = []
    for k, effect in enumerate(picture.display.pictures[picture.number].effects):
        first, last = counts(effect, picture.times)
        if last <= first:
            faults_of_lights.append(faults.never_seen(mission, effect, _why(effect)))
            continue
        layer = layer_of(effect, stage, picture.times, 100 * seed + k)
        (with_it if effect.over == "both" else over).append(layer)
    return tuple(with_it), over


def _why(effect: Effect) -> str:
    return "the picture is held for no time" if effect.over == "hold" else "there is no way to the picture"


def _of_display(
    mission: MissionIR,
    display: Display,
    pictures: Sequence[_Stood],
    images: Images,
    faults_of_lights: list[Diagnostic],
) -> Iterator[Layer]:
    mine = [picture for picture in pictures if picture.display is display]
    first, last = mine[0].times, mine[-1].times
    number = mission.displays.index(display)
    for k, effect in enumerate(display.effects):
        start = first.departs if effect.since is None else _moment(effect.since, mine, is_end=False)
        end = last.arrives if effect.until is None else _moment(effect.until, mine, is_end=True)
        end = min(end, last.arrives)
        if end <= start:
            reason = f"its last picture is gone {last.arrives - first.start:.1f} s after the first one stands"
            faults_of_lights.append(faults.never_seen(mission, effect, reason))
            continue
        under = [p for p in mine if p.times.start < end and p.times.end > start] or mine
        times = Times(start, start, end, end if effect.until is None else last.arrives)
        yield layer_of(effect, _stage(display, under, images), times, 10_000 * (number + 1) + k)


def _moment(mark: DisplayTime, pictures: Sequence[_Stood], *, is_end: bool) -> float:
    """Return a moment of a display in seconds of mission time."""
    if mark.time is not None:
        return mark.time
    if mark.picture is None:
        assert mark.seconds is not None
        return pictures[0].times.start + mark.seconds
    times = next(p.times for p in pictures if p.number == mark.picture)
    return times.end if is_end else times.start


def _stage(display: Display, pictures: Sequence[_Stood], images: Images) -> EffectContext:
    frames = [one for picture in pictures for one in picture.frames]
    lit = np.concatenate([np.delete(one.places, one.spare, axis=0) for one in frames])
    return EffectContext(lit, display.viewpoint, len(frames[0].places), images)
