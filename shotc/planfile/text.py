"""Texts of files as lists of their lines, exactly: UTF-8 as it reads, any other byte as a lone surrogate."""

from __future__ import annotations

from shotc.planfile.layout import RowList

_ESCAPED = "surrogateescape"
_END = "\n"


def as_lines(data: bytes) -> RowList:
    """Return the lines of a file's bytes; a carriage return belongs to the line that it ends."""
    return RowList(data.decode("utf-8", _ESCAPED).split(_END))


def as_bytes(lines: tuple[str, ...]) -> bytes:
    """Return the bytes of a file from its lines; ValueError where they are those of no file."""
    return _END.join(lines).encode("utf-8", _ESCAPED)
