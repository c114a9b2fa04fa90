"""Convert the bytes of a file to a list of lines and back, exactly.

A byte that is not UTF-8 becomes a lone surrogate.
"""

from __future__ import annotations

from shotc.planfile.layout import RowList

_ESCAPED = "surrogateescape"
_END = "\n"


def as_lines(data: bytes) -> RowList:
    """Return the lines of a file's bytes. A carriage return stays at the end of its line."""
    return RowList(data.decode("utf-8", _ESCAPED).split(_END))


def as_bytes(lines: tuple[str, ...]) -> bytes:
    """Return the bytes of a file from its lines. Raises ValueError if no file has such lines."""
    return _END.join(lines).encode("utf-8", _ESCAPED)
