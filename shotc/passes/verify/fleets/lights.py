"""Check the lights of pictures while they stand: their colour, and how many of them shine.

A picture of a file without `color` has the colours of its file, which a plan does not hold: of it only the
number of lights is judged. The lights of a recorded flight are those of its file. Effects lie over these
colours; ``effects`` judges them.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from shotc.geom.bernstein import Array
from shotc.ir.effects import Color
from shotc.ir.fleet import Colors, FrameTimes, Lights
from shotc.ir.light_colors import faded_colors, shown_share
from shotc.ir.light_paints import Levels
from shotc.ir.show import Display, Drawing, Model, Picture, RecordedFlight
from shotc.ir.trajectory import Claim
from shotc.passes.verify.claims import Limit, WorstValue, held
from shotc.passes.verify.fleets.flight import FleetFlight

WHITE: Color = (255, 255, 255)
"""Colour of the lights of a shape for which none is asked."""

BLACK: Color = (0, 0, 0)

COLOR_LEVELS = 1.0
"""Tolerance of each part of a colour, in levels of 255: rounding."""

DARK_SHARE = 0.95
"""Largest share of a fleet that may stay dark in a picture without room for all."""


def asked_color(picture: Picture) -> Color | None:
    """Return the colour that a mission asks for; None where a file has it."""
    if picture.color is None and not isinstance(picture.source, Model | Drawing | RecordedFlight):
        return WHITE
    return picture.color


def shining(flight: FleetFlight, stand: FrameTimes) -> NDArray[np.bool_]:
    """Return which drones show a picture all the while it stands, shape (n,)."""
    colors, shares = _during(flight.track.lights, stand)
    shown = np.any(colors, axis=2) if shares is None else np.asarray(shares == 1.0)
    return np.asarray(np.all(shown, axis=1))


def lights(flight: FleetFlight, display: Display, frames: Sequence[FrameTimes]) -> Iterator[Claim]:
    """Yield claims on the colours of a display's pictures, and on the share of lights that are dark.

    frames : of the display, each of a picture that it has
    """
    drawn = [s for s in frames if not isinstance(display.pictures[s.picture].source, RecordedFlight)]
    if not drawn:
        return
    name, n = flight.fleet.name, len(flight.pads)
    dark = [(1.0 - float(shining(flight, s).sum()) / n, s) for s in drawn if _lights_up(display, s)]
    if dark:
        share, at = max(dark, key=lambda entry: entry[0])
        most = min(DARK_SHARE, 1.0 - 1.0 / n)
        limit = Limit(
            "dark lights of a picture", most, "", display.pictures[at.picture].path, shot=display.id
        )
        yield held(name, limit, WorstValue(share, at.start, "exact"))
    asked = ((asked_color(display.pictures[s.picture]), s) for s in drawn)
    errors = [(_off(flight, s, color), s) for color, s in asked if color is not None]
    if errors:
        off, at = max(errors, key=lambda entry: float(entry[0].max()))
        path = (*display.pictures[at.picture].path, "color")
        limit = Limit("light off its colour", COLOR_LEVELS, "", path, shot=display.id)
        drone = int(off.argmax())
        x, y, z = (float(c) for c in flight.at(at.start)[drone])
        worst = WorstValue(float(off[drone]), at.start, "exact", (x, y, z))
        yield held(name, limit, worst, (flight.names[drone],))


def _lights_up(display: Display, stand: FrameTimes) -> bool:
    """Tell whether a picture is to shine at all."""
    return asked_color(display.pictures[stand.picture]) != BLACK


def _off(flight: FleetFlight, stand: FrameTimes, asked: Color) -> Array:
    """Return how far each light is off its colour while a picture stands, levels, shape (n,).

    A drone that does not show the picture is to be black.
    """
    colors, shares = _during(flight.track.lights, stand)
    shows = np.asarray(np.any(colors, axis=(1, 2)) if shares is None else np.any(shares > 0.0, axis=1))
    wanted = np.where(shows[:, None], np.array(asked, dtype=np.float64), 0.0)
    return np.asarray(np.abs(colors - wanted[:, None]).max(axis=(1, 2)))


def _during(lights: Lights, stand: FrameTimes) -> tuple[Colors, Levels | None]:
    """Return the colours (n, T, 3) without effects at all times that tell them while a picture stands.

    Between these times they are linear. The second value, of a fleet with effects, is each drone's share in
    the picture, (n, T).
    """
    inside = (lights.times > stand.start) & (lights.times < stand.end)
    times = np.concatenate([[stand.start], lights.times[inside], [stand.end]])
    return faded_colors(lights, times), shown_share(lights, times) if lights.looks else None
