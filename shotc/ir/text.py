"""A stable text form of any IR, for --dump-ir and for tests."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass
from typing import Any

from shotc.ir.origin import OriginMap

DIGITS = 9


def dump(value: Any) -> str:
    """Return ``value`` as indented text: one line a field, numbers with nine digits, no addresses."""
    return "\n".join(_lines(value, 0)) + "\n"


def _lines(value: Any, indent: int) -> Iterator[str]:
    pad = "  " * indent
    if isinstance(value, OriginMap):
        yield f"{pad}{value.file}"
    elif is_dataclass(value) and not isinstance(value, type):
        yield f"{pad}{type(value).__name__}"
        for field in fields(value):
            yield from _field(field.name, getattr(value, field.name), indent + 1)
    elif isinstance(value, Mapping):
        for key in value:
            yield from _field(str(key), value[key], indent)
    elif isinstance(value, list | tuple):
        for item in value:
            inner = list(_lines(item, indent + 1))
            yield f"{pad}- {inner[0].strip()}"
            yield from inner[1:]
    else:
        yield pad + _scalar(value)


def _field(name: str, value: Any, indent: int) -> Iterator[str]:
    pad = "  " * indent
    if hasattr(value, "tolist"):
        value = value.tolist()
    if _flat(value):
        yield f"{pad}{name}: {_scalar(value)}"
    else:
        yield f"{pad}{name}:"
        yield from _lines(value, indent + 1)


def _flat(value: Any) -> bool:
    if isinstance(value, list | tuple):
        return all(isinstance(v, int | float | str | None) for v in value)
    return not is_dataclass(value) and not isinstance(value, Mapping)


def _scalar(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.{DIGITS}g}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(_scalar(v) for v in value) + "]"
    return str(value)
