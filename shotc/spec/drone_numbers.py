"""Numbers of drones in the language: one, a range, or a list of both."""

import re
from typing import Annotated, Any

from pydantic.json_schema import JsonSchemaValue

from shotc.spec.fieldtypes import FieldType
from shotc.spec.pydantic_faults import fault
from shotc.units import describe

MOST_DRONES = 20_000
_RANGE = re.compile(r"([0-9]{1,5}) ?- ?([0-9]{1,5})")
_RULE = "give numbers of drones, from 1: a range such as 1-20, or a list such as [21-60, 75]"


class NumbersType(FieldType):
    """Numbers of drones, stored as rising integers."""

    label = "DroneNumbers"

    def read(self, value: Any) -> tuple[int, ...]:
        """Return all numbers, each once. Raise a fault for none, or for a number that is given twice."""
        named: set[int] = set()
        for item in value if isinstance(value, list) else [value]:
            numbers = _span(item)
            again = named.intersection(numbers)
            if again:
                help_ = "name every drone of the group once"
                raise fault("out-of-range", f"drone {min(again)} is named twice", help_)
            named.update(numbers)
        if not named:
            raise fault("wrong-length", "a group needs a drone", _RULE)
        return tuple(sorted(named))

    def schema(self) -> JsonSchemaValue:
        """Return a number, a range, or a list of both."""
        one = [
            {"type": "integer", "minimum": 1, "maximum": MOST_DRONES},
            {"type": "string", "pattern": f"^{_RANGE.pattern}$"},
        ]
        return {"anyOf": [*one, {"type": "array", "items": {"anyOf": one}, "minItems": 1}]}


def _span(item: Any) -> range:
    match = _RANGE.fullmatch(item) if isinstance(item, str) else None
    if match is None and type(item) is not int:
        raise fault("wrong-type", f"expected numbers of drones, got {describe(item)}", _RULE)
    first, last = (int(match[1]), int(match[2])) if match is not None else (item, item)
    if not 1 <= first <= last <= MOST_DRONES:
        quoted = f"`{item}`" if match is not None or abs(first) <= MOST_DRONES else "a number so large"
        raise fault("out-of-range", f"{quoted} is no range of drones", _RULE)
    return range(first, last + 1)


DroneNumbers = Annotated[tuple[int, ...], NumbersType()]
