"""Functions that all formats share: order diagnostics without repeats, count them, make text safe to show."""

from __future__ import annotations

import unicodedata
from collections.abc import Sequence
from typing import NamedTuple

from shotc.diag.code_info import CodeInfo
from shotc.diag.model import Diagnostic, Severity
from shotc.diag.registry import registry, severity_of

# Unassigned, control, format (which hold the bidirectional overrides), surrogate and line separators.
_HIDDEN = frozenset({"Cc", "Cf", "Cn", "Co", "Cs", "Zl", "Zp"})


class Counts(NamedTuple):
    """How many errors and warnings a report holds."""

    errors: int
    warnings: int


def ordered(diagnostics: Sequence[Diagnostic]) -> list[Diagnostic]:
    """Return the diagnostics sorted by file, position and code, without exact repeats."""
    return list(dict.fromkeys(sorted(diagnostics, key=lambda d: d.sort_key)))


def count(diagnostics: Sequence[Diagnostic]) -> Counts:
    """Count errors and warnings, without exact repeats."""
    severities = [severity_of(d) for d in dict.fromkeys(diagnostics)]
    errors = severities.count(Severity.ERROR)
    return Counts(errors, len(severities) - errors)


def info_of(diagnostic: Diagnostic) -> CodeInfo:
    """Return the registry's entry for a diagnostic's code."""
    return registry()[diagnostic.code]


def visible(text: str) -> str:
    """Return ``text`` with every character escaped that a terminal would interpret or hide.

    Names come from the mission and may hold escape sequences or bidirectional overrides.
    """
    if text.isascii() and text.isprintable():
        return text
    return "".join(map(_visible_character, text))


def _visible_character(character: str) -> str:
    code = ord(character)
    if code < 0x20:
        return "→   " if character == "\t" else chr(0x2400 + code)
    if unicodedata.category(character) in _HIDDEN:
        return f"<U+{code:04X}>"
    return character
