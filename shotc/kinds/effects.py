"""Light effects in the language."""

from typing import Annotated, ClassVar, Literal

from pydantic import Field

from shotc.ir.effects import SHORTEST_PERIOD_S, Blend, Fit, RampWay, Way
from shotc.spec.colors import LightColor
from shotc.spec.fields import Duration, NonNegativeDuration, Position, PositiveShare, RelativePath, Share
from shotc.spec.fieldtypes import Integer
from shotc.spec.model import Model, OneOf
from shotc.spec.music import Bar, Beat
from shotc.spec.quantities import Quantity
from shotc.spec.shorthand import QuantityModel

MOST_COLORS = 32
MOST_EFFECTS = 32
"""Most effects of one stack."""

Period = Annotated[float, Quantity("LightPeriod", "duration", SHORTEST_PERIOD_S, noun="period of lights")]
FrameNumber = Annotated[int, Integer("FrameNumber", 1, 500)]


class FadeSpec(Model):
    """All lights change to a colour, or from it."""

    exclusive: ClassVar[tuple[OneOf, ...]] = (OneOf((("to",), ("from",))),)

    to: LightColor | None = Field(default=None, description="the colour at its end, which then stays")
    from_: LightColor | None = Field(default=None, alias="from", description="the colour at its beginning")
    time: Duration | None = Field(
        default=None, description="how long it takes: the last of the time for `to`, the first for `from`"
    )


class RampSpec(Model):
    """A colour gradient."""

    colors: tuple[LightColor, ...] = Field(
        min_length=2, max_length=MOST_COLORS, description="two colours or more, in order"
    )
    at: tuple[Share, ...] | None = Field(
        default=None, description="where each colour is, from 0 to 1; evenly spread by default"
    )
    along: RampWay = Field(
        default="up",
        description="where it goes: an axis, right or left as the audience sees it, out from a middle or in, "
        "by the drones' numbers (index), or by the time",
    )
    center: Position | None = Field(
        default=None, description="from where `out` and `in` count; the picture's middle by default"
    )
    period: Period | None = Field(
        default=None, description="time in which the colours move once past every light; still by default"
    )


class ChaseSpec(Model):
    """A band of light that crosses the picture repeatedly."""

    color: LightColor = Field(default=(255, 255, 255), description="colour of the band")
    along: Way = Field(default="right", description="where it goes, as in a ramp")
    center: Position | None = Field(
        default=None, description="from where `out` and `in` count; the picture's middle by default"
    )
    period: Period = Field(description="time in which it goes once through the picture")
    length: PositiveShare = Field(default=0.25, description="length of the band, as a share of the picture")


class SparkleSpec(Model):
    """Lights that flash at random."""

    color: LightColor = Field(default=(255, 255, 255), description="colour of a sparkle")
    share: PositiveShare = Field(default=0.2, description="share of the lights that sparkle at any moment")
    period: Period = Field(default=0.8, description="how long one takes to come and go")


class ImageSpec(Model):
    """An image file or an animated GIF, projected onto the lights from the audience."""

    file: RelativePath = Field(description="a PNG or GIF file")
    fit: Fit = Field(
        default="cover",
        description="cover all lights, lie whole within them (contain), or both (stretch)",
    )
    period: Period | None = Field(
        default=None, description="time of all frames of a GIF, over and over; as the file says by default"
    )


class MarkSpec(QuantityModel):
    """A time of a display."""

    SHORT: ClassVar = ("seconds", Quantity("NonNegativeDuration", "duration", 0.0))
    exclusive: ClassVar[tuple[OneOf, ...]] = (
        OneOf((("seconds",), ("frame",), ("beat",), ("bar",), ("bar", "beat"))),
    )

    seconds: NonNegativeDuration | None = Field(default=None, description="after its first picture stands")
    beat: Beat | None = Field(
        default=None, description="a beat of the music, counted from 1; beside `bar`, in that bar"
    )
    bar: Bar | None = Field(default=None, description="a bar of the music, counted from 1")
    frame: FrameNumber | None = Field(
        default=None, description="a picture by its number, from 1: from when it stands, or until it goes"
    )


class EffectSpec(Model):
    """One effect, blended over what is below it."""

    exclusive: ClassVar[tuple[OneOf, ...]] = (
        OneOf((("fade",), ("ramp",), ("chase",), ("sparkle",), ("image",))),
        OneOf(
            (("fade",), ("fade_in",), ("fade_out",), ("fade_in", "fade_out")),
            required=False,
            help="a fade comes and goes by itself: give it a `time`",
        ),
    )

    fade: FadeSpec | None = Field(default=None, description="all lights change to a colour, or from it")
    ramp: RampSpec | None = Field(default=None, description="colours that run into each other")
    chase: ChaseSpec | None = Field(default=None, description="a band of light that goes through the picture")
    sparkle: SparkleSpec | None = Field(default=None, description="lights that light up by chance")
    image: ImageSpec | None = Field(default=None, description="a PNG, or a GIF that moves")
    blend: Blend = Field(
        default="mix",
        description="how it combines with what is below it: in its place, or channel by channel",
    )
    opacity: Share = Field(default=1.0, description="how much of it is seen")
    fade_in: NonNegativeDuration = Field(default=0.0, description="time in which it comes")
    fade_out: NonNegativeDuration = Field(default=0.0, description="time in which it goes")


class FrameEffectSpec(EffectSpec):
    """One effect of a picture."""

    over: Literal["both", "hold", "transition"] = Field(
        default="both",
        description="while the picture stands, on the way to it, or with its colours, which come and go on "
        "the ways",
    )


class DisplayEffectSpec(EffectSpec):
    """One effect over all pictures of a display."""

    from_: MarkSpec | None = Field(
        default=None, alias="from", description="when it begins: seconds, or {frame: 2}; at once by default"
    )
    until: MarkSpec | None = Field(
        default=None, description="when it ends: seconds, or {frame: 3}; with the display by default"
    )
