"""Check that a plan has the effects of lights that its mission asks for: all of them, each as it is written.

A colour is a function of the light's number, its position and the time, by the layers of the plan. The layers
that the mission asks for are derived from its text and from the places and times of the flight, and compared
one by one. So the claims hold for every drone at every instant.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import zip_longest
from math import inf
from typing import NamedTuple

from shotc.ir.effects import Image
from shotc.ir.fleet import Lights
from shotc.ir.light_layers import Layer
from shotc.ir.light_paints import FULL_LEVEL
from shotc.ir.show import Display
from shotc.ir.tolerances import ON_TIME_S
from shotc.ir.trajectory import Claim
from shotc.passes.verify.claims import Limit, WorstValue, held
from shotc.passes.verify.fleets.effects.asked import AskedEffect, asked_effects
from shotc.passes.verify.fleets.effects.paints import PaintError, paint_error
from shotc.passes.verify.fleets.effects.stays import SAME_S, Stay
from shotc.passes.verify.fleets.flight import FleetFlight
from shotc.passes.verify.fleets.lights import COLOR_LEVELS

OFF_PLACE_SHARE = 1e-3
"""Largest error of the place of an effect, as a share of its picture: rounding."""


class _Compared(NamedTuple):
    """An effect of the mission, and how far its layer is from it; None if the plan has no such layer."""

    asked: AskedEffect
    error: PaintError | None


class _Comparison(NamedTuple):
    """All effects of a fleet, and how many layers of the plan are not asked for."""

    effects: tuple[_Compared, ...]
    strange: int


class _Measure(NamedTuple):
    """One kind of error, with its limit."""

    name: str
    unit: str
    limit: float
    value: Callable[[PaintError], float]


def effects(flight: FleetFlight, stays: Sequence[Stay]) -> Iterator[Claim]:
    """Yield claims on the effects of all displays of a fleet; stays : its pictures, in its order."""
    if not stays:
        return
    compared = _compared(flight, stays)
    for display in {stay.display.id: stay.display for stay in stays}.values():
        mine = [one for one in compared.effects if one.asked.display is display]
        extra = compared.strange if display is stays[-1].display else 0
        if mine or extra:
            yield _count(flight, display, [one.asked for one in mine if one.error is None], extra)
            yield from _errors(flight, display, mine)
            yield from _of_files(flight, display, mine)


def _compared(flight: FleetFlight, stays: Sequence[Stay]) -> _Comparison:
    """Return how far the layers of a plan are from the effects of its mission."""
    asked, lights, drones = asked_effects(flight, stays), flight.track.lights, len(flight.pads)
    pairs = [
        (stack, layers)
        for stay, stack in zip(stays, asked.within, strict=True)
        for layers in _stacks(lights, stay)
    ]
    # Without looks no effect is shown, whatever lies above them.
    pairs.append((asked.over, lights.over if lights.looks else ()))
    found = [
        _Compared(one, None if layer is None else _error(one, layer, drones))
        for stack, layers in pairs
        for one, layer in zip_longest(stack, layers[: len(stack)])
    ]
    return _Comparison(tuple(found), sum(max(len(layers) - len(stack), 0) for stack, layers in pairs))


def _stacks(lights: Lights, stay: Stay) -> Iterator[tuple[Layer, ...]]:
    """Yield the different stacks of layers that a plan has over a picture while it stands.

    A time of the picture that belongs to no look has none.
    """
    if stay.is_recorded:
        looks = _inside(lights, (stay.start, stay.end))
    else:
        looks = {look for s in stay.frames for look in _throughout(lights, (s.start, s.end))}
    stacks = (lights.looks[look].layers if lights.looks and look >= 0 else () for look in sorted(looks))
    yield from dict.fromkeys(stacks)


def _inside(lights: Lights, span: tuple[float, float]) -> set[int]:
    """Return the looks at the times of the lights that lie in a span."""
    inside = (lights.times > span[0] - SAME_S) & (lights.times < span[1] + SAME_S)
    return {look for look, here in zip(lights.of, inside, strict=False) if here} or {-1}


def _throughout(lights: Lights, span: tuple[float, float]) -> set[int]:
    """Return the looks from a time to a time; -1 too where a look does not begin and end with them."""
    ends = all((abs(lights.times - t) < SAME_S).any() for t in span)
    return _inside(lights, span) | (set() if ends else {-1})


def _error(asked: AskedEffect, layer: Layer, drones: int) -> PaintError | None:
    """Return how far a layer is from an effect, its paint and its times; None if it is another one."""
    error = paint_error(asked, layer.paint, drones) if layer.blend == asked.effect.blend else None
    if error is None or inf in error:
        return None
    opacity = FULL_LEVEL * abs(layer.opacity - asked.effect.opacity)
    late = max(abs(one - other) for one, other in zip(layer.span, asked.span, strict=True))
    return PaintError(max(error.levels, opacity), max(error.seconds, late), error.share)


def _count(flight: FleetFlight, display: Display, lacking: Sequence[AskedEffect], extra: int) -> Claim:
    """Return the claim that every effect is there, and no other."""
    path = lacking[0].effect.path if lacking else display.path
    limit = Limit("effects not as asked", 0.0, "", path, shot=display.id)
    time = lacking[0].span.starts if lacking else None
    return held(flight.fleet.name, limit, WorstValue(float(len(lacking) + extra), time, "exact"))


_MEASURES = (
    _Measure("effect off its colours", "", COLOR_LEVELS, lambda error: error.levels),
    _Measure("effect off its times", "s", ON_TIME_S, lambda error: error.seconds),
    _Measure("effect off its place", "", OFF_PLACE_SHARE, lambda error: error.share),
)


def _errors(flight: FleetFlight, display: Display, compared: Sequence[_Compared]) -> Iterator[Claim]:
    """Yield the claims on the colours, the times and the places of effects, the worst of each."""
    measured = [(one.asked, one.error) for one in compared if one.error is not None]
    if not measured:
        return
    for measure in _MEASURES:
        worst, error = max(measured, key=lambda entry: measure.value(entry[1]))
        limit = Limit(measure.name, measure.limit, measure.unit, worst.effect.path, shot=display.id)
        yield held(flight.fleet.name, limit, WorstValue(measure.value(error), worst.span.starts, "exact"))


def _of_files(flight: FleetFlight, display: Display, compared: Sequence[_Compared]) -> Iterator[Claim]:
    """Yield the claim that counts images, whose pixels are in a file that a plan does not hold."""
    images = {one.asked.effect.path for one in compared if isinstance(one.asked.effect.paint, Image)}
    if images:
        limit = Limit("effects of a file", float(len(images)), "", display.path, shot=display.id)
        yield held(flight.fleet.name, limit, WorstValue(float(len(images)), None, "exact"))
