"""The field names of IR records: named tuples, or dataclasses if they hold arrays."""

from __future__ import annotations

from dataclasses import fields, is_dataclass
from typing import Any


def field_names(record: Any) -> tuple[str, ...]:
    """Return the field names of a record or of its type, in order; empty for anything else."""
    if is_dataclass(record):
        return tuple(field.name for field in fields(record))
    kind = record if isinstance(record, type) else type(record)
    return getattr(kind, "_fields", ()) if issubclass(kind, tuple) else ()
