"""simulate.png: the distributions of framing, clearance and stray over the runs, on one page."""

from __future__ import annotations

from collections.abc import Callable
from io import BytesIO
from math import inf, isfinite
from typing import Any, NamedTuple

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from shotc.emit.palette import CAMERA, FAINT, INK, KEEP_OUT, PAPER, QUIET, SUBJECT
from shotc.simulation.judge import Run
from shotc.simulation.rehearsal import Rehearsed
from shotc.simulation.runs import Strays

DPI = 110.0
WIDTH_IN = 11.0
PANEL_IN = 2.6

HEAD_IN = 1.0
BIN_COUNT = 32
HEADROOM_RATIO = 1.3
"""Height of the axes over the tallest bar, which leaves space for the legend."""


class _Panel(NamedTuple):
    """One distribution.

    limit : the mission's requirement, or None
    most : no value is larger, so the axis ends there
    """

    title: str
    unit: str
    measure: Callable[[Run], float]
    limit: float | None
    most: float = inf


def draw(rehearsed: Rehearsed) -> bytes:
    """Return the page as PNG; the same rehearsal gives the same bytes."""
    panels = _panels(rehearsed)
    rows = (len(panels) + 1) // 2 + (rehearsed.strays is not None)
    height = HEAD_IN + PANEL_IN * rows
    figure = Figure(figsize=(WIDTH_IN, height), dpi=DPI, facecolor=PAPER)
    top, bottom = 1 - 0.75 / height, 0.5 / height
    grid = figure.add_gridspec(
        rows, 2, hspace=0.65, wspace=0.2, left=0.07, right=0.97, top=top, bottom=bottom
    )
    figure.suptitle(
        _title(rehearsed), x=0.07, y=1 - 0.2 / height, ha="left", va="top", color=INK, fontsize=12
    )
    for i, panel in enumerate(panels):
        _spread(figure.add_subplot(grid[i // 2, i % 2]), rehearsed, panel)
    if rehearsed.strays is not None:
        _timeline(figure.add_subplot(grid[rows - 1, :]), rehearsed, rehearsed.strays)
    into = BytesIO()
    figure.savefig(into, format="png", metadata={"Software": None})
    return into.getvalue()


def _title(rehearsed: Rehearsed) -> str:
    count = len(rehearsed.runs)
    if count == 1:
        return f"{rehearsed.mission.name}: 1 run"
    return f"{rehearsed.mission.name}: {count} runs, worst is run {rehearsed.worst.number}"


def _panels(rehearsed: Rehearsed) -> list[_Panel]:
    promise = rehearsed.promise
    least, sight = (None if p is None else 100 * p for p in (promise.in_frame, promise.in_sight))
    clear = 0.0 if promise.clearance is None else promise.clearance
    pictures = [
        _Panel(
            "Whole target in frame, worst shot", "% of frames", lambda run: 100 * run.in_frame, least, 100.0
        ),
        _Panel(
            "Mean distance on screen, worst shot", "half frames", lambda run: run.error, promise.mean_error
        ),
    ]
    if sight is not None:
        title = "Target in sight, worst shot"
        pictures.append(_Panel(title, "% of instants", lambda run: 100 * run.in_sight, sight, 100.0))
    return [
        *(pictures if rehearsed.runs[0].pictures else ()),
        _Panel("Least distance of a body from anything", "m", lambda run: run.clearance, clear),
        _Panel("Farthest from the plan", "m", lambda run: run.stray, promise.stray),
    ]


def _spread(axes: Any, rehearsed: Rehearsed, panel: _Panel) -> None:
    """Draw every run as a tick with their histogram, the worst run in amber, the requirement in vermilion."""
    every = np.array([panel.measure(run) for run in rehearsed.runs])
    values = every[np.isfinite(every)]
    left_out = len(every) - len(values)
    if len(values):
        low, high = float(values.min()), float(values.max())
        if panel.limit is not None:
            low, high = min(low, panel.limit), max(high, panel.limit)
        around = max(high - low, 0.1 * max(abs(high), 1e-3))
        ends = low - 0.05 * around, min(high + 0.05 * around, panel.most)
        drawn, _, _ = axes.hist(values, bins=np.linspace(*ends, BIN_COUNT), color=SUBJECT)
        axes.plot(values, np.zeros(len(values)), "|", color=INK, markersize=8, clip_on=False)
        axes.set_ylim(0.0, HEADROOM_RATIO * float(drawn.max()))
        axes.set_xlim(right=min(axes.get_xlim()[1], panel.most))
    worst = panel.measure(rehearsed.worst)
    if isfinite(worst):
        axes.axvline(
            worst,
            ymax=1 / HEADROOM_RATIO,
            color=CAMERA,
            linewidth=2.0,
            label=f"run {rehearsed.worst.number}, the worst",
        )
    if panel.limit is not None:
        axes.axvline(
            panel.limit, ymax=1 / HEADROOM_RATIO, color=KEEP_OUT, linewidth=1.5, linestyle="--", label="asked"
        )
    axes.xaxis.set_major_locator(MaxNLocator(6))
    axes.ticklabel_format(axis="x", useOffset=False)
    axes.yaxis.set_major_locator(MaxNLocator(4, integer=True))
    axes.legend(loc="upper left", ncols=2, fontsize=9, frameon=False, labelcolor=QUIET)
    beyond = f" ({left_out} of {len(every)} runs infinite)" if left_out else ""
    _labels(axes, f"{panel.title}{beyond}", panel.unit, "runs")


def _timeline(axes: Any, rehearsed: Rehearsed, strays: Strays) -> None:
    median, largest = np.median(strays.metres, axis=1), strays.metres.max(axis=1)
    top = float(largest.max())
    label = "largest of the runs"
    axes.fill_between(strays.times, 0.0, largest, color=SUBJECT, alpha=0.25, linewidth=0, label=label)
    axes.plot(strays.times, median, color=SUBJECT, linewidth=1.2, label="median")
    for row, track in enumerate(rehearsed.ir.drones):
        for phase in track.phases:
            if phase.shot is not None:
                axes.axvspan(phase.start, phase.end, color=CAMERA, alpha=0.12, linewidth=0)
                height = top * (1.03 + 0.12 * row)
                axes.text(phase.start, height, f" {phase.shot}", fontsize=9, color=QUIET, va="bottom")
    axes.set_xlim(0.0, float(strays.times[-1]))
    axes.set_ylim(0.0, top * (1.15 + 0.12 * len(rehearsed.ir.drones)))
    axes.legend(loc="upper right", fontsize=9, frameon=False, labelcolor=QUIET)
    _labels(axes, "Distance from the plan over the flight (shots in amber)", "s", "m")


def _labels(axes: Any, title: str, x: str, y: str) -> None:
    axes.set_title(title, loc="left", fontsize=10, color=INK)
    axes.set_xlabel(x, fontsize=9, color=QUIET)
    axes.set_ylabel(y, fontsize=9, color=QUIET)
    axes.tick_params(labelsize=9, colors=QUIET)
    for name, side in axes.spines.items():
        side.set_visible(name in ("left", "bottom"))
        side.set_color(FAINT)
    axes.set_facecolor("white")
