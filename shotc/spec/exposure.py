"""Field types of a camera's exposure: the f-number of its lens, the time of its shutter."""

from __future__ import annotations

import re
from typing import Any

from pydantic.json_schema import JsonSchemaValue

from shotc.ir.photos import Photos
from shotc.spec.fieldtypes import FieldType
from shotc.spec.places import NAME
from shotc.spec.pydantic_faults import fault, unit_fault
from shotc.spec.quantities import Quantity
from shotc.units import NUMBER, QuantityError, clip, describe, parse_quantity

LEAST_F, MOST_F = 0.7, 64.0
LEAST_S, MOST_S = 1e-5, 1.0
_UNSIGNED = NUMBER.removeprefix("[+-]?")
_APERTURE = re.compile(rf"\s*(?:[fF]\s*/?\s*)?({_UNSIGNED})\s*")
_FRACTION = re.compile(rf"\s*({_UNSIGNED})\s*/\s*({_UNSIGNED})\s*(?:s|sec)?\s*")


class Millimetres(Quantity):
    """A length, usually written in millimetres."""

    def show(self, number: float) -> str:
        """Return a length, m, in millimetres as text."""
        return f"{1e3 * number:g} mm"


class ApertureType(FieldType):
    """An f-number, as ``f/2.8`` or the number alone."""

    label = "Aperture"

    def read(self, value: Any) -> float:
        """Return the f-number. Raise a fault unless it is one of a lens."""
        written = _APERTURE.fullmatch(value) if isinstance(value, str) else None
        if isinstance(value, bool) or not (written or isinstance(value, int | float)):
            raise fault("wrong-type", f"expected an aperture, got {describe(value)}", "write it as `f/2.8`")
        number = float(written[1]) if written else float(value)
        if not LEAST_F <= number <= MOST_F:
            raise fault(
                "out-of-range", f"no lens has an aperture of `{clip(str(value))}`", "give f/0.7 to f/64"
            )
        return number

    def schema(self) -> JsonSchemaValue:
        """Return the schema of a number, or a text that starts with f/."""
        return {
            "anyOf": [
                {"type": "number", "minimum": LEAST_F, "maximum": MOST_F},
                {"type": "string", "pattern": f"^{_APERTURE.pattern}$"},
            ],
            "description": "an f-number, such as f/2.8",
        }


class FocusType(FieldType):
    """The focus of a lens: the name of a target, or a distance such as ``60 m``."""

    label = "Focus"
    _distance = Quantity("FocusDistance", "length", 0.1, 1e5, noun="distance of focus")

    def read(self, value: Any) -> str | float:
        """Return the name, or the distance along the camera's axis, m.

        Text that is a valid length is a distance. Raise a fault unless the value is a name or a distance.
        """
        try:
            parse_quantity(value, "length")
        except QuantityError:
            if not isinstance(value, str) or re.match(r"\s*[+-]?[\d.]*\d\s+\S", value):
                raise fault(
                    "wrong-type",
                    f"expected a target or a distance, got {describe(value)}",
                    "write the name of a target, or a distance such as `60 m`",
                ) from None
            return str(NAME.read(value))
        return self._distance.read(value)

    def schema(self) -> JsonSchemaValue:
        """Return the schema of both notations."""
        return {"anyOf": [NAME.reference(), *self._distance.schema()["anyOf"]]}


class IntervalType(FieldType):
    """The interval of photos in time or along the path, such as ``2 s`` or ``5 m``."""

    label = "PhotoInterval"
    _ways = (
        Quantity("PhotoTime", "duration", 0.1, 3600.0, noun="time between photos"),
        Quantity("PhotoDistance", "length", 0.1, 1000.0, noun="distance between photos"),
    )

    def read(self, value: Any) -> Photos:
        """Return the interval; raise a fault for a bare number, which could be either."""
        if isinstance(value, int | float) and not isinstance(value, bool):
            raise fault(
                "wrong-type", f"expected a time or a distance, got {describe(value)}", "write `2 s` or `5 m`"
            )
        try:
            parse_quantity(value, "length")
        except QuantityError:
            return Photos(seconds=self._ways[0].read(value))
        return Photos(metres=self._ways[1].read(value))

    def schema(self) -> JsonSchemaValue:
        """Return the schema of both notations, with their units."""
        return {"anyOf": [interval.schema()["anyOf"][1] for interval in self._ways]}


class ShutterType(FieldType):
    """An exposure time, such as ``1/50 s``, or a duration; stored in seconds."""

    label = "Shutter"

    def read(self, value: Any) -> float:
        """Return the time, s. Raise a fault unless it is a time of exposure of a film."""
        fraction = _FRACTION.fullmatch(value) if isinstance(value, str) else None
        try:
            seconds = _share(fraction) if fraction else parse_quantity(value, "duration")
        except QuantityError as error:
            raise unit_fault(error) from None
        if LEAST_S <= seconds <= MOST_S:
            return seconds
        raise fault(
            "out-of-range",
            f"`{clip(str(value))}` is no time of exposure of a film",
            "give 1/100000 s to 1 s, as `1/50 s`",
        )

    def schema(self) -> JsonSchemaValue:
        """Return the schema of a number of seconds, a duration, or a fraction of a second."""
        return {
            "anyOf": [
                {"type": "number", "minimum": LEAST_S, "maximum": MOST_S},
                {"type": "string", "pattern": rf"^\s*{_UNSIGNED}\s*(ms|s)\s*$"},
                {"type": "string", "pattern": f"^{_FRACTION.pattern}$"},
            ],
            "description": "a time of exposure, such as 1/50 s",
        }


def _share(fraction: re.Match[str]) -> float:
    whole = float(fraction[2])
    return float(fraction[1]) / whole if whole > 0.0 else 0.0
