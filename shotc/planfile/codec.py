"""IR records to JSON values and back, by their type hints; faults are collected with their JSON path.

A record is an object with all its fields, in their order; where a field may hold one of several
records, ``type`` names it. Tuples are lists. A number that may be without limit is "inf" or "-inf" then;
nothing else that is not finite is read or written. A curve is {"breaks": [...], "control": [[[...]]]}. An
array of a record is a list of lists, or of colours a text a row: "ff8000ffffff" is two of them.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cache
from math import inf, isfinite
from types import NoneType, UnionType
from typing import Any, Literal, Union, get_args, get_origin, get_type_hints

import numpy as np
from numpy.typing import NDArray

from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.solids import Cylinder, Prism
from shotc.geom.track import Track
from shotc.ir.fleet import Colors, FleetTrajectory, Lights
from shotc.ir.records import field_names
from shotc.ir.show import Display, Fleet
from shotc.ir.trajectory import Claim, TrajectoryIR
from shotc.planfile.layout import Rows

UNLIMITED = {
    (Cylinder, "bottom"),
    (Cylinder, "top"),
    (Prism, "bottom"),
    (Prism, "top"),
    (Claim, "limit"),
    (Claim, "worst"),
    (Track, "until"),
    (Display, "weight"),
}

DEPTHS = {(FleetTrajectory, "breaks"): 1, (FleetTrajectory, "coef"): 3, (Lights, "times"): 1}
"""How many dimensions an array of a record has."""

LARGEST = 1e12
"""Size of the largest number that is read: whatever it measures, more than that is damage."""

_HEXADECIMAL = re.compile(r"[0-9a-f]+").fullmatch

INFINITE = {"inf": inf, "-inf": -inf}


@dataclass(frozen=True, slots=True)
class FieldFault:
    """What is wrong with one value: its path, like ``drones[0].limits.speed``, and the fault."""

    path: str
    text: str


def encode(value: Any) -> Any:
    """Return a JSON value for an IR value."""
    if isinstance(value, Piecewise):
        return {"breaks": value.breaks.tolist(), "control": value.ctrl.tolist()}
    if isinstance(value, np.ndarray):
        return _rows(value)
    if names := field_names(value):
        tag = {"type": type(value).__name__} if type(value) in alternatives(TrajectoryIR) else {}
        return tag | {name: encode(getattr(value, name)) for name in names}
    if isinstance(value, tuple | list):
        return [encode(item) for item in value]
    if isinstance(value, float):
        return float(value) if isfinite(value) else repr(float(value))
    return value


def _rows(value: NDArray[Any]) -> list[Any]:
    if value.dtype == np.uint8:
        return Rows(row.tobytes().hex() for row in value)
    return Rows(value.tolist()) if value.ndim > 1 else list(value.tolist())


@cache
def hints(kind: type) -> dict[str, Any]:
    """Return the resolved types of a record's fields, in their order."""
    found = get_type_hints(kind, localns={"Display": Display, "Fleet": Fleet, "Track": Track})
    return {name: found[name] for name in field_names(kind)}


@cache
def alternatives(kind: Any) -> frozenset[Any]:
    """Return the records of which a field may hold one or another, anywhere in a type."""
    found: set[Any] = set()
    seen: set[Any] = set()
    _collect(kind, found, seen)
    return frozenset(found)


def _collect(kind: Any, found: set[Any], seen: set[Any]) -> None:
    if kind in seen or kind is Piecewise:
        return
    seen.add(kind)
    parts = get_args(kind)
    if isinstance(kind, type) and field_names(kind):
        parts = tuple(hints(kind).values())
    elif get_origin(kind) in (Union, UnionType):
        records = [part for part in parts if isinstance(part, type) and field_names(part)]
        found.update(records if len(records) > 1 else ())
    for part in parts:
        _collect(part, found, seen)


@dataclass(slots=True)
class Decoder:
    """Turns JSON values into IR values; ``faults`` fills up, and a value with a fault comes back as None."""

    faults: list[FieldFault]

    def fault(self, path: str, text: str) -> None:
        """Note a fault and go on."""
        self.faults.append(FieldFault(path or "the document", text))

    def decode(self, kind: Any, value: Any, path: str) -> Any:
        """Return ``value`` as ``kind``."""
        if kind is object or kind == Array:
            return value
        if kind == Colors:
            return self._colors(value, path)
        if kind is Piecewise:
            return self._curve(value, path)
        if field_names(kind):
            return self._record(kind, value, path)
        origin = get_origin(kind)
        if origin in (Union, UnionType):
            return self._union(get_args(kind), value, path)
        if origin is tuple:
            return self._tuple(get_args(kind), value, path)
        if origin is Literal:
            if value not in get_args(kind) or isinstance(value, bool):
                self.fault(path, f"{show(value)} is none of {', '.join(map(str, get_args(kind)))}")
            return value
        return self._scalar(kind, value, path)

    def fields(self, kinds: dict[str, Any], value: Any, path: str) -> dict[str, Any]:
        """Return the fields of an object: all of them, and no others; an empty dict where it is none."""
        if not isinstance(value, dict):
            self.fault(path, f"{show(value)} is not an object")
            return {}
        for name in value.keys() - kinds.keys():
            self.fault(at(path, name), "no such field is known")
        found: dict[str, Any] = {}
        for name, kind in kinds.items():
            if name in value:
                found[name] = self.decode(kind, value[name], at(path, name))
            else:
                self.fault(at(path, name), "is missing")
        return found

    def _record(self, kind: Any, value: Any, path: str) -> Any:
        kinds = dict(hints(kind))
        loose = {name for owner, name in UNLIMITED if owner is kind and isinstance(value, dict)}
        infinite = {
            n: INFINITE[value[n]] for n in loose if isinstance(value.get(n), str) and value[n] in INFINITE
        }
        if isinstance(value, dict):
            value = {k: v for k, v in value.items() if k != "type" and k not in infinite}
        found = self.fields({n: k for n, k in kinds.items() if n not in infinite}, value, path)
        found |= infinite
        for owner, name in DEPTHS.keys() if found else ():
            if owner is kind and name in found:
                found[name] = self._array(found[name], DEPTHS[owner, name], at(path, name))
        return kind(**found) if found.keys() == kinds.keys() else None

    def _union(self, kinds: tuple[Any, ...], value: Any, path: str) -> Any:
        if value is None and NoneType in kinds:
            return None
        fitting = [kind for kind in kinds if kind is not NoneType and _fits(kind, value)]
        others = [kind for kind in kinds if kind is not NoneType]
        if not fitting and len(others) == 1:
            fitting = others
        if not fitting:
            self.fault(path, f"{show(value)} is of no type that belongs here")
            return None
        return self.decode(fitting[0], value, path)

    def _tuple(self, kinds: tuple[Any, ...], value: Any, path: str) -> Any:
        if not isinstance(value, list):
            self.fault(path, f"{show(value)} is not a list")
            return ()
        if len(kinds) == 2 and kinds[1] is Ellipsis:
            kinds = kinds[:1] * len(value)
        if len(kinds) != len(value):
            self.fault(path, f"has {len(value)} items, not {len(kinds)}")
            return ()
        pairs = enumerate(zip(kinds, value, strict=True))
        return tuple(self.decode(kind, item, f"{path}[{i}]") for i, (kind, item) in pairs)

    def _scalar(self, kind: Any, value: Any, path: str) -> Any:
        if kind is float and is_number(value):
            try:
                if abs(float(value)) <= LARGEST:
                    return float(value)
            except OverflowError:
                pass
            self.fault(path, f"{show(value)} is not a finite number, or too large a one")
            return None
        if type(value) is not kind:
            self.fault(path, f"{show(value)} is not {NAMES[kind]}")
            return None
        return value

    def _curve(self, value: Any, path: str) -> Piecewise | None:
        parts = self.fields({"breaks": object, "control": object}, value, path)
        arrays = {
            name: self._array(parts[name], depth, at(path, name))
            for name, depth in (("breaks", 1), ("control", 3))
            if name in parts
        }
        if len(arrays) < 2 or any(a is None for a in arrays.values()):
            return None
        try:
            return Piecewise(arrays["breaks"], arrays["control"])
        except ValueError as wrong:
            self.fault(path, str(wrong))
            return None

    def _colors(self, value: Any, path: str) -> Colors | None:
        if isinstance(value, list) and value and all(isinstance(row, str) for row in value):
            widths, digits = {len(row) for row in value}, "".join(value)
            if len(widths) == 1 and len(value[0]) % 6 == 0 and _HEXADECIMAL(digits):
                found = np.frombuffer(bytes.fromhex(digits), dtype=np.uint8)
                return found.reshape(len(value), -1, 3)
        self.fault(path, "is not a list of equally long texts of hexadecimal colours")
        return None

    def _array(self, value: Any, depth: int, path: str) -> Any:
        try:
            if numeric(value, depth):
                found = np.array(value, dtype=np.float64)
                if np.abs(found).max() <= LARGEST:
                    return found
        except (ValueError, OverflowError):
            pass
        self.fault(path, f"is not a table of finite numbers in {depth} dimension{'s' * (depth > 1)}")
        return None


NAMES = {float: "a number", int: "a whole number", str: "a text", bool: "true or false"}


def is_number(value: Any) -> bool:
    """Tell whether a JSON value is a number (true and false are none)."""
    return type(value) in (int, float)


def numeric(value: Any, depth: int) -> bool:
    """Tell whether a JSON value is a list of lists (``depth`` of them) of numbers."""
    if not isinstance(value, list) or not value:
        return False
    if depth == 1:
        return all(map(is_number, value))
    return all(numeric(item, depth - 1) for item in value)


def at(path: str, name: str) -> str:
    """Return the path of a field."""
    return f"{path}.{name}" if path else name


def show(value: Any) -> str:
    """Return a JSON value as a message can carry it."""
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
