"""Records with other values: of named tuples and of dataclasses alike."""

from __future__ import annotations

import dataclasses
from typing import Any


def replace(record: Any, **changes: Any) -> Any:
    """Return the record with other values in some of its fields."""
    if isinstance(record, tuple):
        return record._replace(**changes)
    return dataclasses.replace(record, **changes)
