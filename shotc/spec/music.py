"""The music of a show in the language, and times in seconds, beats or bars."""

from typing import Annotated, Any, ClassVar

from pydantic import Field
from pydantic.json_schema import JsonSchemaValue

from shotc.spec.fields import NonNegativeDuration, RelativePath
from shotc.spec.fieldtypes import FieldType, Integer
from shotc.spec.model import Model, OneOf
from shotc.spec.pydantic_faults import fault
from shotc.spec.quantities import Quantity
from shotc.spec.shorthand import QuantityModel
from shotc.units import clip, describe

MOST_BEATS = 20_000
SLOWEST_BPM, FASTEST_BPM = 20.0, 400.0
"""Beats a minute."""


class NumberType(FieldType):
    """A number without a unit between ``low`` and ``high``, inclusive; noun : in messages."""

    def __init__(self, label: str, low: float, high: float, noun: str) -> None:
        self.label = label
        self.low = low
        self.high = high
        self.noun = noun

    def read(self, value: Any) -> float:
        """Return the number. Raise a fault if it is out of range."""
        bounds = f"give {self.low:g} to {self.high:g}"
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise fault("wrong-type", f"expected a number, {self.noun}, got {describe(value)}", bounds)
        if not self.low <= value <= self.high:
            raise fault("out-of-range", f"`{clip(str(value))}` is out of range for {self.noun}", bounds)
        return float(value)

    def schema(self) -> JsonSchemaValue:
        """Return a number schema."""
        return {"type": "number", "minimum": self.low, "maximum": self.high}


Tempo = Annotated[float, NumberType("Tempo", SLOWEST_BPM, FASTEST_BPM, "beats a minute")]
Beat = Annotated[float, NumberType("Beat", 1.0, MOST_BEATS, "a beat, counted from 1")]
Bar = Annotated[float, NumberType("Bar", 1.0, MOST_BEATS, "a bar, counted from 1")]
PerBar = Annotated[int, Integer("BeatsPerBar", 1, 32)]


class MusicSpec(Model):
    """The music of a show."""

    exclusive: ClassVar[tuple[OneOf, ...]] = (
        OneOf((("tempo",), ("tempo", "first_beat"), ("beats",), ("beats_file",)), required=False),
    )

    file: RelativePath | None = Field(
        default=None, description="the song: MP3 is carried to show files; WAV, FLAC, OGG and M4A are timed"
    )
    start: NonNegativeDuration = Field(default=0.0, description="when it begins on the mission's clock")
    tempo: Tempo | None = Field(default=None, description="beats a minute, where they are even")
    first_beat: NonNegativeDuration | None = Field(
        default=None, description="when the first of even beats falls in the song; 0 by default"
    )
    beats: tuple[NonNegativeDuration, ...] = Field(
        default=(), max_length=MOST_BEATS, description="when every beat falls in the song, in order"
    )
    beats_file: RelativePath | None = Field(
        default=None,
        description="a text file of them, a beat a line: seconds first, as in labels of Audacity",
    )
    beats_per_bar: PerBar = Field(default=4, description="beats in a bar")


class MomentSpec(QuantityModel):
    """A time of a show: mission time in seconds, a beat of its music, or a bar."""

    SHORT: ClassVar = ("time", Quantity("NonNegativeDuration", "duration", 0.0))
    exclusive: ClassVar[tuple[OneOf, ...]] = (OneOf((("time",), ("beat",), ("bar",), ("bar", "beat"))),)

    time: NonNegativeDuration | None = Field(default=None, description="seconds of the mission's clock")
    beat: Beat | None = Field(
        default=None, description="a beat of the music, counted from 1; beside `bar`, in that bar"
    )
    bar: Bar | None = Field(default=None, description="a bar of the music, counted from 1")
