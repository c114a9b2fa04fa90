"""One mission planned under several refiners: each judged by the same measures, and shown side by side.

The mission is compiled once up to its convex path; every refiner starts from that.
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
"""The order of the framing paper, from the path as it is to the whole method."""


class Report(NamedTuple):
    """A comparison, or None where the mission was rejected before any refiner, with what there is to say."""

    comparison: Comparison | None
    diagnostics: tuple[Diagnostic, ...]
    sources: dict[str, SourceFile]


def ordered(names: Iterable[str]) -> list[str]:
    """Return refiners in the order in which they are compared: the usual ones, then others by name."""
    known = set(names)
    return [name for name in USUAL if name in known] + sorted(known - set(USUAL))


class Options(NamedTuple):
    """What to compare.

    refiners : of ``plugins.names("refiners")``, in the order in which they are shown
    smoothings : seconds, each tried with every refiner instead of the mission's; the mission's where None
    deadline, progress : as in ``api.PlanOptions``
    """

    refiners: Sequence[str]
    smoothings: Sequence[float | None] = (None,)
    deadline: float | None = None
    progress: Callable[[str], None] = silent


def compare_source(data: bytes, name: str, folder: Path | None, options: Options) -> Report:
    """Plan one mission under some refiners; data, name, folder : as in ``api.compile_source``.

    A refiner without a plan is a condition that says so; only a mission that no refiner could plan is
    rejected.
    """
    conditions: list[Condition] = []
    first: tuple[PathIR, Compilation] | None = None
    for smoothing in options.smoothings:
        convex = PlanOptions(
            plugins.NO_REFINER, stop_after="solve-path-qp", progress=options.progress, smoothing=smoothing
        )
        done = compile_source(data, name, folder, convex)
        path = done.reports[-1].output if done.reports else None
        if not isinstance(path, PathIR) or has_errors(done.diagnostics):
            return Report(None, done.diagnostics, done.sources)
        path = _without_show(path)
        first = first or (path, done)
        conditions += (_under(refiner, path, smoothing, options) for refiner in options.refiners)
    assert first is not None
    path, done = first
    found = Comparison(path.keyframes.mission, tuple(conditions), differences(conditions))
    return Report(found, done.diagnostics, done.sources)


def _without_show(path: PathIR) -> PathIR:
    """Return the flights of cameras alone, which stay out of the airspace of the show that they film."""
    mission = path.keyframes.mission._replace(displays=(), fleets=())
    return replace(path, keyframes=path.keyframes._replace(mission=mission))


def _under(refiner: str, path: PathIR, smoothing: float | None, options: Options) -> Condition:
    ctx = PassContext(progress=lambda message: options.progress(f"{refiner}: {message}"))
    return replace(condition(refiner, path, options.deadline, ctx), smoothing=smoothing)
