"""The effects of lights that a mission asks for, in order, each with its times and the lights below it.

An effect of a picture comes and goes with the picture's colours, or lies on top of all: first those of the
pictures in the order in which they are shown, then those of the displays. One that has no time is left out.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.ir.effects import DisplayTime, Effect, Fade
from shotc.ir.fleet import FrameTimes
from shotc.ir.light_layers import FadeTimes
from shotc.ir.show import Display
from shotc.passes.verify.fleets.effects.stays import Stay
from shotc.passes.verify.fleets.flight import FleetFlight


class EffectTimes(NamedTuple):
    """The times of what an effect belongs to, s: from when it comes, stands, goes, and until it is gone."""

    comes: float
    stands: float
    goes: float
    gone: float


class AskedEffect(NamedTuple):
    """One effect of the mission.

    span : how it comes and goes; begins, ends : its own time, from which its motion counts, s
    places : positions of the lights that it lies over, (k, 3), m
    """

    effect: Effect
    display: Display
    span: FadeTimes
    begins: float
    ends: float
    places: Array


class AskedEffects(NamedTuple):
    """The effects of a fleet: those with the colours of each picture, and those on top of all."""

    within: tuple[tuple[AskedEffect, ...], ...]
    over: tuple[AskedEffect, ...]


def asked_effects(flight: FleetFlight, stays: Sequence[Stay]) -> AskedEffects:
    """Return the effects of a fleet; ``within`` has one stack for each of its pictures."""
    within: list[tuple[AskedEffect, ...]] = []
    over: list[AskedEffect] = []
    for stay in stays:
        stack = [(e, _of_picture(flight, stay, e)) for e in stay.display.pictures[stay.number].effects]
        within.append(tuple(asked for e, asked in stack if asked is not None and e.over == "both"))
        over += [asked for e, asked in stack if asked is not None and e.over != "both"]
    shown = dict.fromkeys(stay.display.id for stay in stays)
    for display in (flight.mission.display(name) for name in shown):
        over += _of_display(flight, display, [stay for stay in stays if stay.display is display])
    return AskedEffects(tuple(within), tuple(over))


def _of_picture(flight: FleetFlight, stay: Stay, effect: Effect) -> AskedEffect | None:
    window = EffectTimes(stay.comes, stay.start, stay.end, stay.goes)
    if effect.over == "transition":
        window = EffectTimes(stay.comes, stay.comes, stay.start, stay.start)
    elif effect.over == "hold":
        window = EffectTimes(stay.start, stay.start, stay.end, stay.end)
    return _asked(flight, effect, window, [stay])


def _of_display(flight: FleetFlight, display: Display, stays: Sequence[Stay]) -> Iterator[AskedEffect]:
    for effect in display.effects:
        gone = stays[-1].goes
        begins = stays[0].comes if effect.since is None else _moment(effect.since, stays, last=False)
        ends = gone if effect.until is None else min(_moment(effect.until, stays, last=True), gone)
        under = [stay for stay in stays if stay.start < ends and stay.end > begins] or stays
        # A colour to which the lights have faded stays for as long as the display does.
        window = EffectTimes(begins, begins, ends, ends if effect.until is None else gone)
        asked = _asked(flight, effect, window, under)
        if asked is not None:
            yield asked


def _moment(mark: DisplayTime, stays: Sequence[Stay], *, last: bool) -> float:
    """Return a time of a display; of a picture its end for ``last``, else its start."""
    if mark.time is not None:
        return mark.time
    if mark.seconds is not None:
        return stays[0].start + mark.seconds
    stay = next((stay for stay in stays if stay.number == mark.picture), stays[-1])
    return stay.end if last else stay.start


def _asked(
    flight: FleetFlight, effect: Effect, window: EffectTimes, under: Sequence[Stay]
) -> AskedEffect | None:
    """Return an effect over the lights of pictures; None if it has no time."""
    with_colors = effect.over == "both"
    first, last = (window.comes, window.gone) if with_colors else (window.stands, window.goes)
    if last <= first:
        return None
    frames = [frame for stay in under for frame in stay.frames]
    places = np.concatenate([_lit_places(flight, frame) for frame in frames])
    span = _span(effect, window)
    return AskedEffect(effect, under[0].display, span, window.stands, window.goes, places)


def _span(effect: Effect, window: EffectTimes) -> FadeTimes:
    """Return when an effect comes and goes."""
    comes, stands, goes, gone = window
    if isinstance(effect.paint, Fade):
        longest = goes - stands
        length = longest if effect.paint.seconds is None else min(effect.paint.seconds, longest)
        if effect.paint.to:
            return FadeTimes(goes - length, goes, gone, gone)
        return FadeTimes(comes, comes, stands, stands + length)
    if effect.over != "both":
        return FadeTimes(stands, stands + effect.fade_in, goes - effect.fade_out, goes)
    # With the colours of its picture it is there on the ways, too, unless it comes or goes by itself.
    rise = (stands, stands + effect.fade_in) if effect.fade_in > 0.0 else (comes, comes)
    fall = (goes - effect.fade_out, goes) if effect.fade_out > 0.0 else (gone, gone)
    return FadeTimes(*rise, *fall)


def _lit_places(flight: FleetFlight, frame: FrameTimes) -> Array:
    """Return the positions of the drones that show a frame, (k, 3), m; of all if all are dark."""
    lights = flight.track.lights
    row = int(np.argmin(np.abs(lights.times - frame.start)))
    look = lights.of[row] if row < len(lights.of) else -1
    spare = lights.looks[look].spare if look >= 0 else ()
    shown = np.delete(flight.at(frame.start), list(spare), axis=0)
    return shown if len(shown) else flight.at(frame.start)
