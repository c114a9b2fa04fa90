"""Convert IR records to JSON values and back, by their type hints. Faults are collected with their JSON path.

A record becomes an object with all its fields, in their order. If a field may hold one of several records,
``type`` names the record. Tuples become lists. A number that may be unlimited is written "inf" or "-inf";
no other value that is not finite is read or written. A curve is {"breaks": [...], "control": [[[...]]]}. An
array of a record is a list of lists. An array of colours has one text per row: "ff8000ffffff" is two colours.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from math import inf, isfinite
from types import NoneType, UnionType
from typing import Any, Literal, Union, get_args, get_origin, get_type_hints

import numpy as np
from numpy.typing import NDArray
from pydantic_core import (
    CoreSchema,
    ErrorDetails,
    PydanticCustomError,
    SchemaValidator,
    ValidationError,
    core_schema,
)

from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.solids import Cylinder, Prism
from shotc.geom.track import Track
from shotc.ir.fleet import Colors, FleetTrajectory, Lights
from shotc.ir.limits import Limits
from shotc.ir.rules import Rules
from shotc.ir.show import Display, Fleet
from shotc.ir.text import field_names
from shotc.ir.trajectory import Claim, TrajectoryIR
from shotc.planfile.layout import RowList

UNLIMITED = {
    (Cylinder, "bottom"),
    (Cylinder, "top"),
    (Prism, "bottom"),
    (Prism, "top"),
    (Rules, "max_height"),
    (Limits, "tilt"),
    (Limits, "thrust_to_weight"),
    (Claim, "limit"),
    (Claim, "worst"),
    (Track, "until"),
    (Display, "weight"),
}

DEPTHS = {(FleetTrajectory, "breaks"): 1, (FleetTrajectory, "coef"): 3, (Lights, "times"): 1}
"""Number of dimensions of each array field of a record."""

LARGEST_NUMBER = 1e12
"""Largest absolute value that is read. In any unit, a larger number means a damaged file."""

_HEXADECIMAL = re.compile(r"[0-9a-f]+").fullmatch

INFINITE = {"inf": inf, "-inf": -inf}

TAG = "type"
"""The key that names the record if a field may hold one of several."""


@dataclass(frozen=True, slots=True)
class FieldFault:
    """A fault of one value: its path, such as ``drones[0].limits.speed``, and a text."""

    path: str
    text: str


def encode(value: Any) -> Any:
    """Return a JSON value for an IR value."""
    if isinstance(value, Piecewise):
        return {"breaks": value.breaks.tolist(), "control": value.ctrl.tolist()}
    if isinstance(value, np.ndarray):
        return _rows(value)
    if names := field_names(value):
        tag = {TAG: type(value).__name__} if type(value) in alternatives(TrajectoryIR) else {}
        return tag | {name: encode(getattr(value, name)) for name in names}
    if isinstance(value, tuple | list):
        return [encode(item) for item in value]
    if isinstance(value, float):
        return float(value) if isfinite(value) else repr(float(value))
    return value


def _rows(value: NDArray[Any]) -> list[Any]:
    if value.dtype == np.uint8:
        return RowList(row.tobytes().hex() for row in value)
    return RowList(value.tolist()) if value.ndim > 1 else list(value.tolist())


@cache
def hints(kind: type) -> dict[str, Any]:
    """Return the resolved types of a record's fields, in their order."""
    # A plan does not hold the terrain, but the file that the terrain is made from.
    known = {"Display": Display, "Fleet": Fleet, "Track": Track, "Terrain": Any, "ObstacleMesh": Any}
    types = get_type_hints(kind, localns=known)
    return {name: types[name] for name in field_names(kind)}


@cache
def alternatives(kind: Any) -> frozenset[Any]:
    """Return the records that are alternatives of one field, anywhere in a type."""
    classes: set[Any] = set()
    seen: set[Any] = set()
    _collect(kind, classes, seen)
    return frozenset(classes)


def _collect(kind: Any, classes: set[Any], seen: set[Any]) -> None:
    if kind in seen or kind is Piecewise:
        return
    seen.add(kind)
    parts = get_args(kind)
    if isinstance(kind, type) and field_names(kind):
        parts = tuple(hints(kind).values())
    elif get_origin(kind) in (Union, UnionType):
        records = [part for part in parts if isinstance(part, type) and field_names(part)]
        classes.update(records if len(records) > 1 else ())
    for part in parts:
        _collect(part, classes, seen)


@dataclass(slots=True)
class Decoder:
    """Converts JSON values to IR values and collects the faults in ``faults``."""

    faults: list[FieldFault]

    def fault(self, path: str, text: str) -> None:
        """Record a fault and continue."""
        self.faults.append(FieldFault(path or "the document", text))

    def fields(self, kinds: dict[str, Any], value: Any, path: str) -> dict[str, Any]:
        """Return the fields of an object. It must have all of them, and no others.

        After a fault, the result only has the fields that need no conversion from JSON.
        """
        try:
            fields: dict[str, Any] = _reader(tuple(kinds.items())).validate_python(value)
        except ValidationError as error:
            for item in error.errors(include_url=False):
                self.fault(_path(path, item["loc"]), _text(item))
            raw = value if isinstance(value, dict) else {}
            return {name: raw[name] for name, kind in kinds.items() if kind is object and name in raw}
        return fields


@cache
def _reader(kinds: tuple[tuple[str, Any], ...]) -> SchemaValidator:
    """Return the validator of an object with these fields.

    Building a ``TypeAdapter`` of the same schema takes three times as long as reading a plan.
    """
    return SchemaValidator(_object({name: _schema(kind) for name, kind in kinds}))


def _object(fields: Mapping[str, CoreSchema], *others: str) -> CoreSchema:
    """Return the schema of an object that has all of ``fields``, may have ``others``, and has no more."""
    known = {name: core_schema.typed_dict_field(field) for name, field in fields.items()}
    loose = {name: core_schema.typed_dict_field(core_schema.any_schema(), required=False) for name in others}
    return core_schema.typed_dict_schema(known | loose, extra_behavior="forbid")


@cache
def _schema(kind: Any) -> CoreSchema:
    """Return the schema of a value of this type in a plan."""
    if kind is Piecewise:
        arrays = {"breaks": _array(1), "control": _array(3)}
        return core_schema.no_info_after_validator_function(_curve, _object(arrays))
    if field_names(kind):
        return _record(kind)
    origin, parts = get_origin(kind), get_args(kind)
    if origin in (Union, UnionType):
        return _union(parts)
    if origin is tuple:
        return _tuple(parts)
    if origin is Literal:
        none = f"is none of {', '.join(map(str, parts))}"
        return core_schema.custom_error_schema(
            core_schema.literal_schema(list(parts)), custom_error_type="none_of", custom_error_message=none
        )
    return _plain(kind)


def _plain(kind: Any) -> CoreSchema:
    known = {
        object: core_schema.any_schema(),
        float: core_schema.float_schema(
            strict=True, allow_inf_nan=False, ge=-LARGEST_NUMBER, le=LARGEST_NUMBER
        ),
        int: core_schema.int_schema(strict=True),
        bool: core_schema.bool_schema(strict=True),
        # A text may hold lone surrogates: they represent bytes of a file that are not UTF-8.
        str: core_schema.is_instance_schema(str),
        Colors: core_schema.no_info_plain_validator_function(_colors),
    }
    return known[kind]


def _record(kind: Any) -> CoreSchema:
    fields = {name: _field(kind, name, hint) for name, hint in hints(kind).items()}

    def made(fields: dict[str, Any]) -> Any:
        fields.pop(TAG, None)
        return kind(**fields)

    return core_schema.no_info_after_validator_function(made, _object(fields, TAG))


def _field(owner: Any, name: str, hint: Any) -> CoreSchema:
    if (owner, name) in DEPTHS:
        return _array(DEPTHS[owner, name])
    if (owner, name) not in UNLIMITED:
        return _schema(hint)

    def limited(value: Any, read: Callable[[Any], Any]) -> Any:
        return INFINITE[value] if isinstance(value, str) and value in INFINITE else read(value)

    return core_schema.no_info_wrap_validator_function(limited, _schema(hint))


def _union(kinds: tuple[Any, ...]) -> CoreSchema:
    choices = {f"#{i}": kind for i, kind in enumerate(k for k in kinds if k is not NoneType)}

    def choice(value: Any) -> str | None:
        return next((tag for tag, kind in choices.items() if _fits(kind, value)), None)

    schemas = {tag: _schema(kind) for tag, kind in choices.items()}
    one = schemas["#0"] if len(schemas) == 1 else core_schema.tagged_union_schema(schemas, choice)
    return core_schema.nullable_schema(one) if NoneType in kinds else one


def _tuple(kinds: tuple[Any, ...]) -> CoreSchema:
    n = len(kinds)
    if n == 2 and kinds[1] is Ellipsis:
        return core_schema.tuple_variable_schema(_schema(kinds[0]))
    items = core_schema.tuple_positional_schema([_schema(kind) for kind in kinds])
    return core_schema.chain_schema([core_schema.list_schema(min_length=n, max_length=n), items])


def _curve(parts: dict[str, Any]) -> Piecewise:
    try:
        return Piecewise(parts["breaks"], parts["control"])
    except ValueError as wrong:
        raise _fault(str(wrong)) from None


def _colors(value: Any) -> Colors:
    if isinstance(value, list) and value and all(isinstance(row, str) for row in value):
        widths, digits = {len(row) for row in value}, "".join(value)
        if len(widths) == 1 and len(value[0]) % 6 == 0 and _HEXADECIMAL(digits):
            numbers = np.frombuffer(bytes.fromhex(digits), dtype=np.uint8)
            return numbers.reshape(len(value), -1, 3)
    raise _fault("is not a list of equally long texts of hexadecimal colours")


def _array(depth: int) -> CoreSchema:
    def read(value: Any) -> Array:
        try:
            if numeric(value, depth):
                array = np.array(value, dtype=np.float64)
                if np.abs(array).max() <= LARGEST_NUMBER:
                    return array
        except (ValueError, OverflowError):
            pass
        raise _fault(f"is not a table of finite numbers in {depth} dimension{'s' * (depth > 1)}")

    return core_schema.no_info_plain_validator_function(read)


def _fault(text: str) -> PydanticCustomError:
    return PydanticCustomError("fault", "{text}", {"text": text})


def _text(item: ErrorDetails) -> str:
    """Return the message of shotc for one of pydantic's faults."""
    kind, value, context = item["type"], item["input"], item.get("ctx", {})
    if kind in ("too_short", "too_long"):
        length = context.get("min_length", context.get("max_length"))
        return f"has {context['actual_length']} items, not {length}"
    if kind in ("missing", "extra_forbidden"):
        return "is missing" if kind == "missing" else "no such field is known"
    if kind == "fault":
        return item["msg"]
    if kind == "float_type" and not is_number(value):
        return f"{show(value)} is not a number"
    return f"{show(value)} {_WORDS.get(kind, item['msg'])}"


_TOO_LARGE = "is not a finite number, or too large a one"
_WORDS = {
    **dict.fromkeys(("float_type", "finite_number", "less_than_equal", "greater_than_equal"), _TOO_LARGE),
    **dict.fromkeys(("list_type", "tuple_type"), "is not a list"),
    "int_type": "is not a whole number",
    "bool_type": "is not true or false",
    "is_instance_of": "is not a text",
    "dict_type": "is not an object",
    "union_tag_not_found": "is of no type that belongs here",
}
"""Messages by the type of pydantic's fault. Faults of other types have their own message."""


def _path(path: str, place: tuple[str | int, ...]) -> str:
    for part in place:
        if isinstance(part, int):
            path += f"[{part}]"
        elif not part.startswith("#"):  # "#..." is the alternative of a union
            path = at(path, part)
    return path


def is_number(value: Any) -> bool:
    """Return whether a JSON value is a number (true and false are not)."""
    return type(value) in (int, float)


def numeric(value: Any, depth: int) -> bool:
    """Return whether a JSON value is a list of numbers, nested ``depth`` deep."""
    if not isinstance(value, list) or not value:
        return False
    if depth == 1:
        return all(map(is_number, value))
    return all(numeric(item, depth - 1) for item in value)


def at(path: str, name: str) -> str:
    """Return the path of a field."""
    return f"{path}.{name}" if path else name


def show(value: Any) -> str:
    """Return a JSON value as text for a message."""
    if isinstance(value, dict):
        return "an object"
    if isinstance(value, list):
        return "a list"
    text = repr(value) if not isinstance(value, str) else f"`{value}`"
    return text if len(text) <= 40 else text[:37] + "..."


def _fits(kind: Any, value: Any) -> bool:
    if field_names(kind):
        return isinstance(value, dict) and value.get("type", kind.__name__) == kind.__name__
    if get_origin(kind) is tuple:
        args = get_args(kind)
        return isinstance(value, list) and (args[-1] is Ellipsis or len(args) == len(value))
    return is_number(value) if kind is float else type(value) is kind
