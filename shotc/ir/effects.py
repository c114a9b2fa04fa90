"""Light effects of a mission, resolved. Plain Python, no numpy; part of MissionIR.

An effect gives every light a colour and a weight at every time, as a function of the drone's position, its
number or the time. It is blended over what is below it in its stack.
"""

from typing import Literal, NamedTuple

from shotc.ir.limits import Vec3
from shotc.ir.origin import KeyPath

Color = tuple[int, int, int]

LIGHT_RATE_HZ = 25.0
"""Rate at which effects are evaluated, Hz; lights are linear between two samples."""

SHORTEST_PERIOD_S = 5.0 / LIGHT_RATE_HZ
"""Shortest cycle of an effect, seconds; a shorter one has too few samples."""

SHORTEST_PASS_S = 2.0 / LIGHT_RATE_HZ
"""Least time for which a band of light covers a drone, seconds; with less, samples can miss it."""

Way = Literal[
    "up", "down", "east", "west", "north", "south", "right", "left", "away", "near", "out", "in", "index"
]
"""The direction of an effect: along an axis, as the audience sees it, from a centre, or by drone numbers."""

RampWay = Literal[Way, "time"]

Blend = Literal["mix", "add", "multiply", "screen", "lighten", "darken"]

Over = Literal["both", "hold", "transition", "display"]
"""When an effect of a picture applies: hold and transition, the hold alone, or the transition alone.
"display" is an effect of a whole display."""

Fit = Literal["cover", "contain", "stretch"]


class Fade(NamedTuple):
    """All lights change to a colour, or from it; seconds : duration, None for the longest possible."""

    color: Color
    to: bool
    seconds: float | None


class Ramp(NamedTuple):
    """A colour gradient; at : position of each colour, from 0 to 1, rising.

    along : direction in space, None for time; center : p_W for `out` and `in`, None for the picture's middle
    period : seconds in which the gradient passes a light once, repeated, or None
    """

    colors: tuple[Color, ...]
    at: tuple[float, ...]
    along: Way | None
    center: Vec3 | None
    period: float | None


class Chase(NamedTuple):
    """A band of light that crosses the picture once a period.

    length : of the band, as a share of the picture
    """

    color: Color
    along: Way
    center: Vec3 | None
    period: float
    length: float


class Sparkle(NamedTuple):
    """Lights that flash at random; share : of the lights that flash at any time; period : of one flash, s."""

    color: Color
    share: float
    period: float


class Image(NamedTuple):
    """A picture file projected onto the lights from the audience.

    period : seconds of all its frames, None for the times in the file
    """

    file: str
    fit: Fit
    period: float | None


Paint = Fade | Ramp | Chase | Sparkle | Image


class DisplayTime(NamedTuple):
    """A time of a display: seconds after its first picture stands, the index of a picture, or ``time``.

    time : mission time, s, if a beat of the music determines it
    """

    seconds: float | None
    picture: int | None
    time: float | None = None


class Effect(NamedTuple):
    """One effect of a stack.

    opacity : 0 to 1; fade_in, fade_out : durations of the fades, seconds
    since, until : bounds of an effect over a display; None for the whole display
    """

    paint: Paint
    blend: Blend
    opacity: float
    fade_in: float
    fade_out: float
    over: Over
    since: DisplayTime | None
    until: DisplayTime | None
    path: KeyPath
