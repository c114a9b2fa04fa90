"""Check the lights between pictures: an even fade from each to the next, and dark on the way up and down.

A recorded flight has the lights of its file, and so have the ways beside it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.ir.light_colors import faded_colors, shown_share
from shotc.ir.light_paints import FULL_LEVEL
from shotc.ir.trajectory import Claim
from shotc.passes.verify.claims import Limit, WorstValue, held
from shotc.passes.verify.fleets.effects.stays import SAME_S, Stay, dark_from, dark_until
from shotc.passes.verify.fleets.flight import FleetFlight
from shotc.passes.verify.fleets.lights import COLOR_LEVELS


class _Knots(NamedTuple):
    """Times (T,) between which lights are linear, and whether they are dark, or those of a file, at each."""

    times: Array
    dark: tuple[bool, ...]
    filed: tuple[bool, ...]


def fades(flight: FleetFlight, stays: Sequence[Stay]) -> Iterator[Claim]:
    """Yield the claim on the lights of a fleet while no picture stands.

    stays : its pictures, in its order
    """
    if not stays:
        return
    knots = _knots(flight, stays)
    times = np.array([*_dark_times(knots), *_added(flight, knots)])
    if not len(times):
        return
    off = _off(flight, knots, times)
    drone, k = (int(i) for i in np.unravel_index(int(off.argmax()), off.shape))
    time = float(times[k])
    stay = next((stay for stay in stays if stay.start >= time), stays[-1])
    limit = Limit("light between pictures", COLOR_LEVELS, "", stay.display.path, shot=stay.display.id)
    x, y, z = (float(c) for c in flight.at(time)[drone])
    worst = WorstValue(float(off[drone, k]), time, "exact", (x, y, z))
    yield held(flight.fleet.name, limit, worst, (flight.names[drone],))


def _knots(flight: FleetFlight, stays: Sequence[Stay]) -> _Knots:
    """Return the times at which frames begin and end to stand, and the dark times before and after them."""
    begin, end = float(flight.track.breaks[0]), float(flight.track.breaks[-1])
    frames = [(t, stay.is_recorded) for stay in stays for s in stay.frames for t in (s.start, s.end)]
    times = [begin, dark_until(flight), *(t for t, _ in frames), dark_from(flight), end]
    dark = (True, True, *(False for _ in frames), True, True)
    filed = (frames[0][1], frames[0][1], *(is_filed for _, is_filed in frames), frames[-1][1], frames[-1][1])
    return _Knots(np.array(times), dark, filed)


def _dark_times(knots: _Knots) -> list[float]:
    """Return the times at which all lights are to be dark."""
    return [
        t
        for t, dark, filed in zip(knots.times.tolist(), knots.dark, knots.filed, strict=True)
        if dark and not filed
    ]


def _added(flight: FleetFlight, knots: _Knots) -> list[float]:
    """Return the times of the lights that belong to no picture; recorded flights have times of their own."""
    filed, last = np.array(knots.filed), len(knots.times) - 1
    added = []
    for t in flight.track.lights.times.tolist():
        after = min(int(np.searchsorted(knots.times, t)), last)
        free = filed[after] or filed[max(after - 1, 0)]
        if not free and np.abs(knots.times - t).min() > SAME_S:
            added.append(t)
    return added


def _off(flight: FleetFlight, knots: _Knots, times: Array) -> Array:
    """Return how far lights are from an even fade at times (k,), levels, shape (n, k).

    With effects, a time of the lights that belongs to no picture has a look of its own, which none asks for.
    """
    lights = flight.track.lights
    colors = faded_colors(lights, times).astype(np.float64)
    wanted = _between(faded_colors(lights, knots.times).astype(np.float64), knots, times)
    off = np.abs(colors - wanted).max(axis=2)
    if not lights.looks:
        return np.asarray(off)
    dark = np.array(_dark_times(knots))
    strange = np.array([not (len(dark) and (dark == t).any()) for t in times.tolist()])
    shown = FULL_LEVEL * shown_share(lights, times)
    return np.asarray(np.maximum(off, np.where(strange, FULL_LEVEL, shown)))


def _between(colors: Array, knots: _Knots, times: Array) -> Array:
    """Return the colours (n, k, 3) at times (k,) of a fade between those at knots, (n, T, 3)."""
    colors = np.where(np.array(knots.dark)[:, None], 0.0, colors)
    after = np.clip(np.searchsorted(knots.times, times), 1, len(knots.times) - 1)
    start, end = knots.times[after - 1], knots.times[after]
    share = np.clip((times - start) / np.maximum(end - start, 1e-12), 0.0, 1.0)[:, None]
    return np.asarray(colors[:, after - 1] * (1.0 - share) + colors[:, after] * share)
