"""The fields of an IR's records, which are named tuples or, where they hold arrays, dataclasses."""

from __future__ import annotations

from dataclasses import fields, is_dataclass
from typing import Any


def field_names(record: Any) -> tuple[str, ...]:
    """Return the names of the fields of a record or of its type, in their order; of anything else, none."""
    if is_dataclass(record):
        return tuple(field.name for field in fields(record))
    kind = record if isinstance(record, type) else type(record)
    return getattr(kind, "_fields", ()) if issubclass(kind, tuple) else ()
