"""What is drawn on a page: every text, how it is set, and the rectangle it takes."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import pytest

from shotc.emit.storyboard.canvas import CAPITAL_RATIO, Canvas, PageRectangle, Type


@dataclass(frozen=True)
class Written:
    """One text; capital : the height of its capital letters in the file, pixels."""

    text: str
    style: Type
    box: PageRectangle
    capital: float


@contextmanager
def texts() -> Iterator[list[Written]]:
    """Collect all texts that are drawn inside the block."""
    found: list[Written] = []
    text = Canvas.text

    def written(self: Canvas, x: float, y: float, words: str, style: Type, *rest: Any) -> None:
        width, height = self.extent(words, style)
        left = x - width * {"left": 0.0, "center": 0.5, "right": 1.0}[style.across]
        low = y - height * (0.5 if style.along.startswith("center") else 0.0)
        dpi = 9.0 * 72.0 / (CAPITAL_RATIO * self.least_size)
        found.append(
            Written(
                words, style, PageRectangle(left, low, width, height), style.size * dpi / 72.0 * CAPITAL_RATIO
            )
        )
        text(self, x, y, words, style, *rest)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Canvas, "text", written)
        yield found
