"""Plans one mission with several refiners, measures each plan in the same way and shows them side by side.

The mission is compiled once up to its convex path, from which every refiner starts.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

from shotc import plugins
from shotc.api import Compilation, PlanOptions, compile_source
from shotc.comparison.conditions import condition
from shotc.comparison.differences import differences
from shotc.diag.model import Diagnostic
from shotc.diag.registry import has_errors
from shotc.ir.comparison import Comparison, Condition
from shotc.ir.passes import PassContext, silent
from shotc.ir.path import PathIR
from shotc.source.file import SourceFile

USUAL = ("none", "ang", "look-at", "framing-only", "ours-4pt", "ours")
"""The refiners in the order of the framing paper, from the unrefined path to the whole method."""


class Report(NamedTuple):
    """A comparison with diagnostics; the comparison is None if the mission is rejected before any refiner."""

    comparison: Comparison | None
    diagnostics: tuple[Diagnostic, ...]
    sources: dict[str, SourceFile]


def ordered(names: Iterable[str]) -> list[str]:
    """Return refiners in the order of the comparison: first the usual ones, then others by name."""
    known = set(names)
    return [name for name in USUAL if name in known] + sorted(known - set(USUAL))


class Options(NamedTuple):
    """Options of a comparison.

    refiners : of ``plugins.names("refiners")``, in their order of display
    smoothings : seconds; each is tried with every refiner. None is the mission's own smoothing
    deadline, progress : as in ``api.PlanOptions``
    """

    refiners: Sequence[str]
    smoothings: Sequence[float | None] = (None,)
    deadline: float | None = None
    progress: Callable[[str], None] = silent


def compare_source(data: bytes, name: str, folder: Path | None, options: Options) -> Report:
    """Return the comparison of one mission under some refiners.

    A refiner without a plan becomes a condition without a plan. The mission is rejected only if no refiner
    could plan it.

    data, name, folder : as in ``api.compile_source``
    """
    conditions: list[Condition] = []
    first: tuple[PathIR, Compilation] | None = None
    for smoothing in options.smoothings:
        convex = PlanOptions(
            plugins.NO_REFINER, stop_after="solve-path-qp", progress=options.progress, smoothing=smoothing
        )
        compilation = compile_source(data, name, folder, convex)
        path = compilation.reports[-1].output if compilation.reports else None
        if not isinstance(path, PathIR) or has_errors(compilation.diagnostics):
            return Report(None, compilation.diagnostics, compilation.sources)
        path = _without_show(path)
        first = first or (path, compilation)
        conditions += (_under(refiner, path, smoothing, options) for refiner in options.refiners)
    assert first is not None
    path, compilation = first
    comparison = Comparison(path.keyframes.mission, tuple(conditions), differences(conditions))
    return Report(comparison, compilation.diagnostics, compilation.sources)


def _without_show(path: PathIR) -> PathIR:
    """Return the flights of cameras alone; they stay out of the airspace of the show that they film."""
    mission = path.keyframes.mission._replace(displays=(), fleets=())
    return replace(path, keyframes=path.keyframes._replace(mission=mission))


def _under(refiner: str, path: PathIR, smoothing: float | None, options: Options) -> Condition:
    ctx = PassContext(progress=lambda message: options.progress(f"{refiner}: {message}"))
    return replace(condition(refiner, path, options.deadline, ctx), smoothing=smoothing)
