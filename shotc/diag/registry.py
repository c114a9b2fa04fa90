"""The table of all diagnostic codes. It is loaded with the first diagnostic."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cache
from importlib import import_module
from typing import TYPE_CHECKING

from shotc.diag.model import Diagnostic, Severity

if TYPE_CHECKING:
    from shotc.diag.code_info import CodeInfo

FAMILIES = {
    "Y": ("yaml", "text and YAML"),
    "S": ("schema", "schema"),
    "N": ("names", "names and references"),
    "U": ("units", "units"),
    "G": ("geometry", "geometry and framing"),
    "K": ("keyframes", "keyframes and kinds"),
    "M": ("motion", "moving targets"),
    "F": ("grammar", "film grammar"),
    "D": ("display", "displays and fleets"),
    "Q": ("convex", "convex solve"),
    "R": ("refinement", "refinement"),
    "T": ("timing", "timing"),
    "V": ("verification", "verification"),
    "W": ("rehearsals", "rehearsals"),
    "E": ("emission", "emission"),
    "A": ("autopilots", "autopilots and streaming"),
    "I": ("imports", "imports"),
    "P": ("plugins", "plugins and options"),
    "X": ("internal", "our bug"),
}


@cache
def registry() -> dict[str, CodeInfo]:
    """Return every known code, in order of family and number; raise ValueError if one is registered twice."""
    table: dict[str, CodeInfo] = {}
    for module, _ in FAMILIES.values():
        codes: tuple[CodeInfo, ...] = import_module(f"shotc.diag.codes.{module}").CODES
        for info in codes:
            if info.code in table:
                raise ValueError(f"code {info.code} is registered twice")
            table[info.code] = info
    return table


@cache
def code_of(slug: str) -> str:
    """Return the code with this slug."""
    return next(info.code for info in registry().values() if info.slug == slug)


def severity_of(diagnostic: Diagnostic) -> Severity:
    """Return the severity that the registry gives this diagnostic's code."""
    return registry()[diagnostic.code].severity


def has_errors(diagnostics: Iterable[Diagnostic]) -> bool:
    """Return whether any of the diagnostics rejects the mission."""
    return any(severity_of(d) is Severity.ERROR for d in diagnostics)


def stops(diagnostics: Iterable[Diagnostic]) -> bool:
    """Return whether any of the diagnostics stops the later passes.

    Every error does, except one that only knows a bound: a later pass finds the exact number.
    """
    return any(severity_of(d) is Severity.ERROR and not registry()[d.code].exact for d in diagnostics)


def without_answered(diagnostics: Iterable[Diagnostic], later: Iterable[Diagnostic]) -> list[Diagnostic]:
    """Return the diagnostics without the bounds for which a later pass found the exact numbers."""
    answers = {d.code for d in later}
    return [d for d in diagnostics if answers.isdisjoint(registry()[d.code].exact)]
