"""Diagnostics for a command that finds no refiner installed."""

from __future__ import annotations

from shotc import plugins
from shotc.api import Compilation
from shotc.diag.model import Diagnostic


def with_missing(compilation: Compilation, refiner: str | None) -> Compilation:
    """Add the diagnostic of a missing refiner if the path could have been refined and no name was given."""
    reached = any(report.name == "refine-path" for report in compilation.reports)
    return (
        compilation._replace(diagnostics=(*compilation.diagnostics, *missing(refiner)))
        if reached
        else compilation
    )


def missing(refiner: str | None) -> tuple[Diagnostic, ...]:
    """Return the diagnostic of a missing refiner; nothing if one is installed or ``refiner`` names one."""
    there = refiner is not None or plugins.usual_refiner() != plugins.NO_REFINER
    return () if there else (plugins.no_refiner(),)
