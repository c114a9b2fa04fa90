"""Field types for the picture: screen points, frames, composition sets, aspect."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from math import inf
from typing import Annotated, Any

from pydantic.json_schema import JsonSchemaValue

from shotc.ir.limits import Vec2
from shotc.ir.mission import Composition, DrawnBox
from shotc.spec.compositions import COMPOSITIONS, FRAMES, NAMED_POINTS
from shotc.spec.fieldtypes import FieldType, NamedOr
from shotc.spec.pydantic_faults import fault, read_each
from shotc.spec.quantities import Quantity, Tuple
from shotc.units import clip, describe

_SCREEN = Quantity("ScreenCoordinate", "ratio", -1.0, 1.0, noun="place on screen")
_PAIR = Tuple("ScreenPair", (_SCREEN, _SCREEN), "[u, v]")

ScreenPoint = Annotated[Vec2, NamedOr("ScreenPoint", NAMED_POINTS, "screen point", _PAIR)]


class OwnPointType(FieldType):
    """A screen point as a composition of one point."""

    label = "ScreenPair"

    def read(self, value: Any) -> Composition:
        """Return the composition of this point."""
        point: Vec2 = _PAIR.read(value)
        return Composition(_named((point,)), points=(point,))

    def schema(self) -> JsonSchemaValue:
        """Return the schema of a screen point."""
        return _PAIR.schema()


class OwnPointsType(FieldType):
    """A list of screen points as a composition."""

    label = "ScreenPoints"

    def read(self, value: Any) -> Composition:
        """Return the composition of these points. Raise a fault unless it is a list of points."""
        if not isinstance(value, list) or not any(isinstance(item, list) for item in value):
            raise fault(
                "wrong-type",
                f"expected a composition, got {describe(value)}",
                f"write one of {', '.join(COMPOSITIONS)}, or a list of points such as [[-0.3, 0], [0.3, 0]]",
            )
        points = read_each(((i,), partial(_PAIR.read, item)) for i, item in enumerate(value))
        return Composition(_named(points), points=tuple((u, v) for u, v in points))

    def schema(self) -> JsonSchemaValue:
        """Return a list of screen points."""
        return {"type": "array", "items": _PAIR.reference(), "minItems": 1}


def _named(points: Sequence[Vec2]) -> str:
    """Return the name of numeric points in messages and pictures: their notation in the mission."""
    written = ", ".join(f"[{u:.4g}, {v:.4g}]" for u, v in points)
    return clip(written if len(points) == 1 else f"[{written}]")


class ScreenBoxType(FieldType):
    """A box on the screen by its lower left and its upper right corner."""

    label = "ScreenBox"

    def read(self, value: Any) -> DrawnBox:
        """Return the box; raise a fault if it has no size."""
        u0, v0, u1, v1 = _CORNERS.read(value)
        if u0 < u1 and v0 < v1:
            return DrawnBox(u0, u1, v0, v1)
        if u0 == u1 or v0 == v1:
            raise fault("inverted-range", "the box is empty", "write [u0, v0, u1, v1], u0 < u1 and v0 < v1")
        right = ", ".join(f"{c:.4g}" for c in (min(u0, u1), min(v0, v1), max(u0, u1), max(v0, v1)))
        raise fault("inverted-range", "the corners of the box are swapped", f"write [{right}]")

    def schema(self) -> JsonSchemaValue:
        """Return the schema of four coordinates, without the order of the corners."""
        return _CORNERS.schema()


_CORNERS = Tuple("ScreenCorners", (_SCREEN,) * 4, "[u0, v0, u1, v1]")
BoxOnScreen = Annotated[DrawnBox, ScreenBoxType()]
Frame = Annotated[Composition, NamedOr("Frame", FRAMES, "frame", OwnPointType())]
CompositionSet = Annotated[Composition, NamedOr("CompositionSet", FRAMES, "composition", OwnPointsType())]


class AspectType(FieldType):
    """Frame width over height: a number, or text such as ``16:9``."""

    label = "Aspect"

    def read(self, value: Any) -> float:
        """Return width / height. Raise a fault unless it is from 0.2 to 5."""
        if not isinstance(value, str) or value.strip()[-1:] == "%":
            return _RATIO.read(value)
        width, height = (_side(part) for part in (value if value.count(":") == 1 else "0:0").split(":"))
        if not (height > 0 and 0.2 <= width / height <= 5.0):
            raise fault(
                "impossible-camera",
                f"no frame has the aspect `{clip(value)}`",
                'write width over height such as "16:9", from "1:5" to "5:1"',
            )
        return width / height

    def schema(self) -> JsonSchemaValue:
        """Return the schema of both notations."""
        side = r"[0-9]*[.]?[0-9]*[1-9][0-9]*[.]?[0-9]*"
        return {"anyOf": [_RATIO.reference(), {"type": "string", "pattern": f"^{side}:{side}$"}]}


_RATIO = Quantity(
    "AspectRatio", "ratio", 0.2, 5.0, fault="impossible-camera", noun="frame's width over its height"
)
Aspect = Annotated[float, AspectType()]


def _side(text: str) -> float:
    try:
        number = float(text)
    except ValueError:
        return 0.0
    return number if 0 < number < inf else 0.0
