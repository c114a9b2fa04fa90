"""Draws of all sorts from one seed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import exp, log
from random import Random
from typing import TypeVar

T = TypeVar("T")


class Dice:
    """Numbers, choices and ways to write a quantity; the same seed gives the same draws in every process."""

    def __init__(self, seed: int | str) -> None:
        self._random = Random(f"mission {seed}")

    def between(self, low: float, high: float, digits: int = 2) -> float:
        return round(self._random.uniform(low, high), digits)

    def scaled(self, low: float, high: float, digits: int = 2) -> float:
        """Return a number whose logarithm is even between those of the bounds."""
        return round(exp(self._random.uniform(log(low), log(high))), digits)

    def whole(self, low: int, high: int) -> int:
        return self._random.randint(low, high)

    def sign(self) -> int:
        return self._random.choice((-1, 1))

    def chance(self, share: float) -> bool:
        return self._random.random() < share

    def pick(self, items: Sequence[T]) -> T:
        return self._random.choice(items)

    def weighted(self, items: Mapping[T, float]) -> T:
        return self._random.choices(list(items), list(items.values()))[0]

    def shuffled(self, items: Sequence[T]) -> list[T]:
        found = list(items)
        self._random.shuffle(found)
        return found

    def written(self, value: float, unit: str) -> float | str:
        """Return a number in SI as an author writes it: bare, or with its unit."""
        return value if self.chance(0.6) else f"{value:g} {unit}"
