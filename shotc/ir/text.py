"""The fields of IR records, and a stable text form of any IR for --dump-ir and for tests."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass
from typing import Any

from shotc.ir.origin import OriginMap

TEXT_DIGITS = 9


def dump(value: Any) -> str:
    """Return ``value`` as indented text: one line a field, numbers with nine digits, no addresses."""
    return "\n".join(_lines(value, 0)) + "\n"


def _lines(value: Any, indent: int) -> Iterator[str]:
    pad = "  " * indent
    if isinstance(value, OriginMap):
        yield f"{pad}{value.file}"
    elif names := field_names(value):
        yield f"{pad}{type(value).__name__}"
        for name in names:
            yield from _field(name, getattr(value, name), indent + 1)
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
    if field_names(value) or isinstance(value, Mapping):
        return False
    return not isinstance(value, list | tuple) or all(isinstance(v, int | float | str | None) for v in value)


def _scalar(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.{TEXT_DIGITS}g}"
    if isinstance(value, bytes):
        return f"{len(value)} bytes"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(_scalar(v) for v in value) + "]"
    return str(value)


def field_names(record: Any) -> tuple[str, ...]:
    """Return the field names of a record or of its type, in order; empty for anything else."""
    if is_dataclass(record):
        return tuple(field.name for field in fields(record))
    kind = record if isinstance(record, type) else type(record)
    return getattr(kind, "_fields", ()) if issubclass(kind, tuple) else ()
