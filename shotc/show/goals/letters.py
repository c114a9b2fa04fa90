"""Legibility of letters: how many lights they need, how high they must be, and when an outline is better."""

from __future__ import annotations

from math import ceil

from shotc.diag.model import Diagnostic
from shotc.ir.mission import MissionIR
from shotc.ir.show import Fleet, Lettering, Picture
from shotc.rounding import at_most
from shotc.show.geom.sizes import enlarged, size_words
from shotc.show.goals.body import Fill
from shotc.show.goals.faults import apart, place_of
from shotc.show.goals.flat import FlatBody
from shotc.show.goals.spaced import SpacingTask

LETTER_LIGHTS = 5
"""Least lights in the height of a letter, as in the smallest pixel fonts."""
SMALL_LETTER_RATIO = 0.7
"""Height of small letters over that of capitals in most fonts."""
RESOLVED_RATIO = 1.5
"""Distance of lights on an outline, in widths of its strokes, at which both sides of a stroke are
distinct.
"""


def lights_needed(source: Lettering, body: FlatBody, fill: Fill) -> int:
    """Return the number of lights that a text needs: spaced along its strokes as in a letter five lights
    high.

    On an outline the lights are nearer, if both sides of a stroke would not be distinct otherwise.
    """
    return ceil(_strokes(body, fill) / _step(source, body, fill))


def too_few_lights(
    mission: MissionIR, picture: Picture, strokes: tuple[FlatBody, Fill], numbers: tuple[int, int | None]
) -> Diagnostic:
    """Return D057, a warning on a fleet too small for a text.

    numbers : of drones, and a sufficient number, if there is one
    """
    source, (body, fill), (number, enough) = picture.source, strokes, numbers
    assert isinstance(source, Lettering)
    length = _strokes(body, fill)
    note = (
        f"its {'edges' if fill == 'outline' else 'strokes'} are {length:.0f} m long, so its lights are "
        f"{length / number:.1f} m apart; these letters need one every {_step(source, body, fill):.1f} m"
    )
    remedies = [
        "make it larger, with more drones"
        if enough is None
        else f"use {enough} drones (`count: {enough}`) or more"
    ]
    if fill == "outline" and number >= lights_needed(source, body, "volume"):
        remedies.append("leave `fill` out")
    message = f"{number} drones are too few to read `{source.text[:40]}`"
    help_ = ", or ".join([*remedies, "fewer letters"])
    return Diagnostic("D057", message, (place_of(mission, picture),), (note,), help_)


def too_small(
    mission: MissionIR, fleet: Fleet, picture: Picture, seen: float, setting: SpacingTask
) -> Diagnostic | None:
    """Return D063, a warning on letters so low that lights within a stroke and between strokes are equally
    near.

    seen : apparent distance of lights, in the metric of the fleet, metres
    """
    source = picture.source
    if not isinstance(source, Lettering):
        return None
    share = SMALL_LETTER_RATIO if any(letter.islower() for letter in source.text) else 1.0
    needed = (LETTER_LIGHTS - 1) * seen / setting.stretch / share
    if source.height >= needed * (1.0 - 1e-9):
        return None
    notes = (
        apart(setting),
        f"{'small ' if share < 1.0 else ''}letters need {LETTER_LIGHTS} lights in their height",
    )
    larger = enlarged(picture, needed / source.height, mission.lowest(source.centre, fleet.radius))
    message = f"letters {source.height:.4g} m high are too small to be read"
    help_ = f"make them larger (`{size_words(source, larger.source)}`)"
    closer = source.height / needed * fleet.apart.across - fleet.apart.margin
    if closer >= 2 * fleet.radius:
        help_ += f", or keep a `separation` of {at_most(closer)} m"
    return Diagnostic("D063", message, (place_of(mission, picture, "height"),), notes, help_)


def _step(source: Lettering, body: FlatBody, fill: Fill) -> float:
    """Return the largest distance of lights along strokes or edges, metres."""
    step = source.height / (LETTER_LIGHTS - 1)
    return min(step, RESOLVED_RATIO * body.stroke) if fill == "outline" else step


def _strokes(body: FlatBody, fill: Fill) -> float:
    """Return the length along which lights stand: all edges, or the strokes between them, metres."""
    return body.outlines * (1.0 if fill == "outline" else 0.5)
