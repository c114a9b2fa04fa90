"""Field types for heights with a reference: the world's origin, the ground, or a target's foot."""

from functools import partial
from typing import Annotated, Any, NamedTuple

from pydantic import Field
from pydantic.json_schema import JsonSchemaValue

from shotc.ir.ground import Above
from shotc.spec.fieldtypes import FieldType
from shotc.spec.model import Model
from shotc.spec.pydantic_faults import fault, read_each
from shotc.spec.quantities import Quantity, QuantitySpan, Range

_LENGTH = Quantity("Length", "length")


class Altitude(NamedTuple):
    """A camera's height from the first frame of its shot to the last, metres.

    above : its reference: the plane z = 0, the ground below the camera, or the foot of the shot's target at
        that time; None if the mission gives none, which means the target's foot
    """

    first: float
    last: float
    above: Above | None = None

    @property
    def span(self) -> tuple[float, float]:
        """Both ends."""
        return (self.first, self.last)


class AboveGround(NamedTuple):
    """The height of a place above the ground there, metres; stands : whether it is omitted, and so 0."""

    height: float
    stands: bool = False


STANDING = AboveGround(0.0, stands=True)


class HeightRange(NamedTuple):
    """The lowest and the highest height of a zone, metres; ground : whether they are above the ground."""

    low: float
    high: float
    ground: bool = False


class CountedSpec(Model):
    """A height and its reference; the field that contains it reads the height."""

    above: Above = Field(description="what the height counts from")
    height: Any = Field(description="height above that")


class _Counted(FieldType):
    """A height alone, or ``{above, height}``.

    item : type of the height; sources : admissible references
    """

    item: FieldType
    sources: tuple[Above, ...]

    def parts(self, value: Any) -> tuple[Any, Above | None]:
        """Return the height, and its reference if it is written."""
        if not isinstance(value, dict):
            return self.item.read(value), None
        written = CountedSpec.model_validate(value)
        height, above = read_each(
            [
                (("height",), partial(self.item.read, written.height)),
                (("above",), partial(self._known, written.above)),
            ]
        )
        return height, above

    def _known(self, above: Above) -> Above:
        if above not in self.sources:
            known = " or ".join(f"`above: {name}`" for name in self.sources)
            raise fault("wrong-type", f"this height cannot count from the {above}", f"write {known}")
        return above

    def schema(self) -> JsonSchemaValue:
        """Return the schema of both notations."""
        counted = {
            "type": "object",
            "description": "a height, and what it counts from",
            "properties": {"above": {"enum": list(self.sources)}, "height": self.item.reference()},
            "required": ["above", "height"],
            "additionalProperties": False,
        }
        return {"anyOf": [self.item.reference(), counted]}


class AltitudeType(_Counted):
    """A camera's height: one value for a kind with constant height, else also [from, to]."""

    sources = ("target", "ground", "origin")

    def __init__(self, label: str, item: FieldType) -> None:
        self.label = label
        self.item = item

    def read(self, value: Any) -> Altitude:
        """Return the height at both ends, and its reference."""
        if isinstance(value, Altitude):
            return value
        height, above = self.parts(value)
        first, last = height if isinstance(height, tuple) else (height, height)
        return Altitude(first, last, above)


class HeightType(_Counted):
    """The height of a place."""

    label = "Height"
    item = _LENGTH
    sources = ("origin", "ground")

    def read(self, value: Any) -> float | AboveGround:
        """Return z in metres, or a height above the ground."""
        if isinstance(value, AboveGround):
            return value
        height, above = self.parts(value)
        return AboveGround(height) if above == "ground" else float(height)


class HeightRangeType(_Counted):
    """The heights of a zone."""

    label = "HeightRange"
    item = Range("LengthRange", _LENGTH, thick=True)
    sources = ("origin", "ground")

    def read(self, value: Any) -> HeightRange:
        """Return the heights, and whether they are above the ground."""
        if isinstance(value, HeightRange):
            return value
        (low, high), above = self.parts(value)
        return HeightRange(low, high, ground=above == "ground")


class LiftType(_Counted):
    """The height of a target above its track, or above the ground that it follows."""

    label = "Lift"
    item = _LENGTH
    sources = ("ground",)

    def read(self, value: Any) -> float | AboveGround:
        """Return a height above the points of a track, or above the ground below them, metres."""
        if isinstance(value, AboveGround):
            return value
        height, above = self.parts(value)
        return float(height) if above is None else AboveGround(height)


HEIGHT = HeightType()
Lift = Annotated[float | AboveGround, LiftType()]

CameraAltitude = Annotated[Altitude, AltitudeType("CameraAltitude", _LENGTH)]
CameraAltitudeSpan = Annotated[
    Altitude, AltitudeType("CameraAltitudeSpan", QuantitySpan("LengthSpan", _LENGTH))
]
Heights = Annotated[HeightRange, HeightRangeType()]
