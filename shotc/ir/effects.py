"""Effects of lights as a mission asks for them, resolved. Plain Python, no numpy; part of MissionIR.

An effect gives every light a colour and a weight at every moment, by where it is, by its number or by the
time, and is laid over what is below it in its stack.
"""

from typing import Literal, NamedTuple

from shotc.ir.limits import Vec3
from shotc.ir.origin import KeyPath

Color = tuple[int, int, int]

LIGHT_RATE = 25.0
"""Moments a second at which effects are evaluated, Hz; between two of them lights change evenly."""

LEAST_PERIOD = 5.0 / LIGHT_RATE
"""Seconds of the shortest cycle of an effect: below it too few moments show it."""

LEAST_PASS = 2.0 / LIGHT_RATE
"""Seconds for which a band of light lies on a light, at least: else some moments miss it."""

Way = Literal[
    "up", "down", "east", "west", "north", "south", "right", "left", "away", "near", "out", "in", "index"
]
"""Where an effect goes: along an axis, as the audience sees it, from a middle, or by the drones' numbers."""

RampWay = Literal[Way, "time"]

Blend = Literal["mix", "add", "multiply", "screen", "lighten", "darken"]

Over = Literal["both", "hold", "transition", "display"]
"""When an effect of a picture counts: with its colours, while it stands, or on the way to it; or that it is
one of a whole display."""

Fit = Literal["cover", "contain", "stretch"]


class Fade(NamedTuple):
    """All lights change to a colour, or from it; seconds : how long it takes, None for as long as it can."""

    color: Color
    to: bool
    seconds: float | None


class Ramp(NamedTuple):
    """Colours that run into each other; at : where each of them is, from 0 to 1, rising.

    along : None by the time; center : p_W from which `out` and `in` count, None for the picture's middle
    period : seconds in which the colours go once past a light, over and over, or None
    """

    colors: tuple[Color, ...]
    at: tuple[float, ...]
    along: Way | None
    center: Vec3 | None
    period: float | None


class Chase(NamedTuple):
    """A band of light that goes through the picture once a period; length : of it, as a share of the way."""

    color: Color
    along: Way
    center: Vec3 | None
    period: float
    length: float


class Sparkle(NamedTuple):
    """Lights that light up by chance; share : of them that do at any moment; period : seconds of one."""

    color: Color
    share: float
    period: float


class Image(NamedTuple):
    """A picture file thrown onto the lights from where the audience is; period : seconds of all its frames,
    None as the file says.
    """

    file: str
    fit: Fit
    period: float | None


Paint = Fade | Ramp | Chase | Sparkle | Image


class Mark(NamedTuple):
    """A moment of a display: seconds after its first picture stands, a picture of it, from 0, or a time, s.

    time : on the mission's clock, where a beat of the music says it
    """

    seconds: float | None
    picture: int | None
    time: float | None = None


class Effect(NamedTuple):
    """One effect of a stack.

    opacity : how much of it is seen, 0 to 1; fade_in, fade_out : seconds in which it comes and goes
    since, until : of one over a display; None for the whole display
    """

    paint: Paint
    blend: Blend
    opacity: float
    fade_in: float
    fade_out: float
    over: Over
    since: Mark | None
    until: Mark | None
    path: KeyPath
