"""Field types for numbers with a dimension: a single one, a fixed list, a range, a span [from, to]."""

from __future__ import annotations

import re
from functools import partial
from math import degrees, inf
from typing import Any

from pydantic.json_schema import JsonSchemaValue

from shotc.spec.fieldtypes import FieldType
from shotc.spec.pydantic_faults import fault, read_each, unit_fault
from shotc.units import (
    ANGULAR,
    LARGEST,
    NUMBER,
    SMALLEST,
    UNITS,
    Dimension,
    QuantityError,
    a,
    clip,
    describe,
    parse_quantity,
)

# Two numbers with a dash between them, the usual notation of a range.
_DASHED = rf"\s*({NUMBER})\s*(?:-|–|\.\.|to)\s*({NUMBER})\s*([^\W\d_]\S*|[°%])?\s*"


class Quantity(FieldType):
    """A number with a dimension, stored in SI, between ``low`` and ``high`` (SI, inclusive).

    fault : slug of the code for a value out of bounds; noun : in messages about bounds
    """

    def __init__(
        self,
        label: str,
        dimension: Dimension,
        low: float = -inf,
        high: float = inf,
        fault: str = "out-of-range",
        noun: str = "",
    ) -> None:
        self.label = label
        self.dimension = dimension
        self.low = low
        self.high = high
        self.fault = fault
        self.noun = noun

    def read(self, value: Any) -> float:
        """Return the value in SI. Raise a fault for a wrong unit, or a value out of bounds."""
        try:
            number = parse_quantity(value, self.dimension)
        except QuantityError as error:
            raise unit_fault(error) from None
        if self.low <= number <= self.high:
            return number
        raise fault(
            self.fault,
            f"`{clip(str(value))}` is {'below' if number < self.low else 'above'} "
            f"what {a(self.noun or self.dimension)} may be here",
            self._meant(value) or f"give {self._bounds()}",
        )

    def _meant(self, value: Any) -> str:
        """Return the most likely intended notation of a value out of bounds, empty if unknown."""
        return ""

    def schema(self) -> JsonSchemaValue:
        """Return a number-or-text schema; text only for angles."""
        sign = "[+]?" if self.low >= 0 else "[+-]?"
        units = "|".join(re.escape(unit) for unit in UNITS[self.dimension])
        text = {"type": "string", "pattern": rf"^\s*{sign}{NUMBER.removeprefix('[+-]?')}\s*({units})\s*$"}
        if self.dimension in ANGULAR:
            return {**text, "description": f"{a(self.dimension)} with its unit"}
        limit = LARGEST[self.dimension]
        number = {"type": "number", "minimum": max(self.low, -limit), "maximum": min(self.high, limit)}
        return {"anyOf": [number, text], "description": f"{a(self.dimension)} in SI, or with its unit"}

    def _bounds(self) -> str:
        if self.low == SMALLEST[self.dimension]:
            most = f", at most {self.show(self.high)}" if self.high < inf else ""
            return f"{a(self.noun or self.dimension)} above 0{most}"
        if self.high == inf:
            return f"at least {self.show(self.low)}"
        if self.low == -inf:
            return f"at most {self.show(self.high)}"
        return f"{self.show(self.low)} to {self.show(self.high)}"

    def show(self, number: float) -> str:
        """Return an SI value in its usual notation."""
        if self.dimension == "ratio":
            return f"{number:g}"
        unit = next(iter(UNITS[self.dimension]))
        return f"{degrees(number) if self.dimension in ANGULAR else number:g} {unit}"


class WattHours(Quantity):
    """The energy of a battery, usually written in watt-hours."""

    def show(self, number: float) -> str:
        """Return an energy, J, in watt-hours as text."""
        return f"{number / 3600.0:g} Wh"

    def _meant(self, value: Any) -> str:
        """Return the watt-hours that a bare number probably means."""
        return "" if isinstance(value, str) or value <= 0 else f"write `{value:g} Wh`"


class Percentage(Quantity):
    """A share of a whole, usually written in percent."""

    def show(self, number: float) -> str:
        """Return a share in percent as text."""
        return f"{100 * number:g} %"

    def _meant(self, value: Any) -> str:
        """Return the percentage that a bare number probably means."""
        if isinstance(value, str) or not 1 < value <= 100:
            return ""
        return f"write `{value:g} %`, or a share up to 1"


class Tuple(FieldType):
    """A list of fixed length, stored as a tuple; ``shape`` is its notation, such as ``[x, y, z]``.

    hint : help for a list of another length, if the shape is not enough
    """

    def __init__(self, label: str, items: tuple[FieldType, ...], shape: str, hint: str = "") -> None:
        self.label = label
        self.items = items
        self.shape = shape
        self.hint = hint or f"write {shape}"

    def read(self, value: Any) -> tuple[Any, ...]:
        """Return the items, each read by its type. Raise a fault for another number of items."""
        if not isinstance(value, list | tuple):
            raise fault("wrong-type", f"expected a list {self.shape}, got {describe(value)}", _apart(value))
        if len(value) != len(self.items):
            few = f"expected {len(self.items)} values {self.shape}, got {len(value)}"
            raise fault("wrong-length", few, (_apart(value[0]) if len(value) == 1 else "") or self.hint)
        pairs = zip(self.items, value, strict=True)
        return tuple(read_each(((i,), partial(item.read, v)) for i, (item, v) in enumerate(pairs)))

    def schema(self) -> JsonSchemaValue:
        """Return an array schema."""
        return {
            "type": "array",
            "prefixItems": [item.reference() for item in self.items],
            "items": False,
            "minItems": len(self.items),
            "maxItems": len(self.items),
        }


class Range(FieldType):
    """A list ``[lowest, highest]``, stored as a tuple; ``thick`` refuses equal ends."""

    def __init__(self, label: str, item: FieldType, thick: bool = False) -> None:
        self.label = label
        self.item = item
        self.thick = thick

    def read(self, value: Any) -> tuple[float, float]:
        """Return (lowest, highest) in SI. Raise a fault if it is inverted, or empty where ``thick``."""
        low, high = self._pair.read(value)
        if low < high or (low == high and not self.thick):
            return (low, high)
        written = f"[{clip(str(value[0]), 20)}, {clip(str(value[1]), 20)}]"
        if low == high:
            raise fault(
                "inverted-range", f"the range {written} is empty", "make the second value the larger one"
            )
        raise fault(
            "inverted-range",
            f"the range {written} runs from high to low",
            f"write [{clip(str(value[1]), 20)}, {clip(str(value[0]), 20)}]",
        )

    def schema(self) -> JsonSchemaValue:
        """Return an array schema without the order of the ends."""
        return self._pair.schema()

    @property
    def _pair(self) -> Tuple:
        return Tuple(self.label, (self.item, self.item), "[lowest, highest]")


class QuantitySpan(FieldType):
    """One value, or ``[from, to]``; stored as (from, to)."""

    def __init__(self, label: str, item: FieldType) -> None:
        self.label = label
        self.item = item

    def read(self, value: Any) -> tuple[float, float]:
        """Return (from, to) in SI; a single value gives equal ends. Raise a fault for text as 40-65 m."""
        if isinstance(value, list):
            first, last = Tuple(self.label, (self.item, self.item), "[from, to]").read(value)
            return (first, last)
        if help_ := _apart(value):
            raise fault(
                "wrong-type", f"expected one value or a list [from, to], got {describe(value)}", help_
            )
        only = self.item.read(value)
        return (only, only)

    def schema(self) -> JsonSchemaValue:
        """Return a value-or-array schema."""
        pair = Tuple(self.label, (self.item, self.item), "[from, to]")
        return {"anyOf": [self.item.reference(), pair.schema()]}


def _apart(value: object) -> str:
    """Return a text such as ``40-65 m`` in the notation of two values; empty for anything else."""
    match = re.fullmatch(_DASHED, clip(value)) if isinstance(value, str) else None
    if match is None:
        return ""
    unit = f" {match[3]}" if match[3] else ""
    return f"write two values, such as `[{match[1]}{unit}, {match[2]}{unit}]`"
