"""What ``make test`` tries a little of, and ``make fuzz`` all: parameters and drawn examples."""

from __future__ import annotations

import os
from collections.abc import Collection, Iterable
from typing import Any

import pytest


def few(values: Iterable[Any], kept: Collection[Any]) -> list[Any]:
    """Return the values as parameters, those that are not kept marked for ``make fuzz``."""
    found = list(values)
    missing = [value for value in kept if value not in found]
    assert not missing, f"none of the values: {missing}"
    return [value if value in kept else pytest.param(value, marks=pytest.mark.fuzz) for value in found]


def examples(kept: int, every: int) -> int:
    """Return how many examples hypothesis draws: those of `make fuzz` are more and new ones."""
    return every if os.environ.get("FUZZ") else kept
