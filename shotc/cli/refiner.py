"""The refiner that a command line asks for, or not."""

from __future__ import annotations

from shotc import plugins
from shotc.api import Compilation
from shotc.diag.model import Diagnostic


def told(done: Compilation, asked: str | None) -> Compilation:
    """Add that there was no refiner, where none was asked for and the path could have been refined."""
    reached = any(report.name == "refine-path" for report in done.reports)
    return done._replace(diagnostics=(*done.diagnostics, *missing(asked))) if reached else done


def missing(asked: str | None) -> tuple[Diagnostic, ...]:
    """Say that there is no refiner; nothing where there is one, or where one is asked for by name."""
    there = asked is not None or plugins.usual_refiner() != plugins.NO_REFINER
    return () if there else (plugins.no_refiner(),)
