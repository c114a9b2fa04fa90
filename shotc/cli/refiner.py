"""The refiner that a command line asks for, or not."""

from __future__ import annotations

from shotc import plugins
from shotc.api import Compilation


def told(done: Compilation, asked: str | None) -> Compilation:
    """Add that there was no refiner, where none was asked for and the path could have been refined."""
    reached = any(report.name == "refine-path" for report in done.reports)
    if asked is not None or plugins.usual_refiner() != plugins.NO_REFINER or not reached:
        return done
    return done._replace(diagnostics=(*done.diagnostics, plugins.no_refiner()))
