"""Write JSON that people can read: short objects and rows of numbers on one line each, the rest indented."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

LONGEST_VALUE_CHARACTERS = 100
"""Most characters of a value on one line."""

LINE_ITEMS = 20
"""Most items of a value on one line."""

LINE_NUMBERS = 10
"""Numbers per line of a long list."""

LONGEST_RECORD_CHARACTERS = 420
"""Most characters of an object of plain values on one line."""
_ESCAPED = "surrogateescape"
_END = "\n"


class RowList(list[Any]):
    """A list of many items. Each item is written on one line, whatever its size."""


def text(value: Any) -> str:
    """Return a JSON text, ASCII only, that reads back to the same value.

    Raises ValueError if a number is not finite.
    """
    return "".join(_parts(value, "")) + "\n"


def _parts(value: Any, pad: str) -> Iterator[str]:
    if isinstance(value, RowList):
        rows = (json.dumps(item, allow_nan=False, separators=(",", ":")) for item in value)
        yield f"[\n{pad}  " + f",\n{pad}  ".join(rows) + f"\n{pad}]"
        return
    line = _one_line(value)
    if line is not None:
        yield line
        return
    inner = pad + "  "
    if isinstance(value, list) and not any(isinstance(item, dict | list) for item in value):
        rows = (
            json.dumps(value[i : i + LINE_NUMBERS], allow_nan=False)[1:-1]
            for i in range(0, len(value), LINE_NUMBERS)
        )
        yield f"[\n{inner}" + f",\n{inner}".join(rows) + f"\n{pad}]"
        return
    pairs = value.items() if isinstance(value, dict) else ((None, item) for item in value)
    opening, closing = ("{", "}") if isinstance(value, dict) else ("[", "]")
    yield opening
    for i, (key, item) in enumerate(pairs):
        yield (",\n" if i else "\n") + inner + ("" if key is None else json.dumps(key) + ": ")
        yield from _parts(item, inner)
    yield f"\n{pad}{closing}"


def _one_line(value: Any) -> str | None:
    if not isinstance(value, dict | list) or not value:
        return json.dumps(value, allow_nan=False)
    items = list(value.values()) if isinstance(value, dict) else value
    if len(items) > LINE_ITEMS or not all(map(_is_short, items)):
        return None
    line = json.dumps(value, allow_nan=False)
    flat = isinstance(value, dict) and not any(isinstance(item, dict) for item in items)
    return line if len(line) <= (LONGEST_RECORD_CHARACTERS if flat else LONGEST_VALUE_CHARACTERS) else None


def _is_short(value: Any) -> bool:
    return not isinstance(value, dict | list) or len(value) <= 8


def as_lines(data: bytes) -> RowList:
    """Return the lines of a file's bytes. A carriage return stays at the end of its line."""
    return RowList(data.decode("utf-8", _ESCAPED).split(_END))


def as_bytes(lines: tuple[str, ...]) -> bytes:
    """Return the bytes of a file from its lines. Raises ValueError if no file has such lines."""
    return _END.join(lines).encode("utf-8", _ESCAPED)
