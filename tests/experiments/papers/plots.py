"""Plots of the report as PNG bytes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from io import BytesIO

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from shotc.geom.bernstein import Array

DPI = 110
FLOOR = 1e-5  # errors below this are drawn as this


def errors(found: Mapping[str, Sequence[Array]]) -> bytes:
    """Draw the share of frames whose screen error stays below a value, a line a condition."""
    figure = Figure(figsize=(7.5, 4))
    axes = figure.add_subplot()
    for name, each in found.items():
        if each:
            error = np.sort(np.maximum(np.concatenate(each), FLOOR))
            axes.plot(error, np.arange(1, len(error) + 1) / len(error), label=name)
    axes.set(xscale="log", xlabel="screen error, half frames", ylabel="share of frames", ylim=(0, 1.02))
    axes.grid(alpha=0.3)
    axes.legend()
    return png(figure)


def times(found: Mapping[str, Sequence[float]]) -> bytes:
    """Draw a histogram of solve times, seconds, a colour a condition."""
    figure = Figure(figsize=(7.5, 3.5))
    axes = figure.add_subplot()
    every = np.concatenate([np.asarray(each) for each in found.values()])
    bins = np.geomspace(max(every.min(), 1e-4), every.max() * 1.001, 30)
    for name, each in found.items():
        axes.hist(each, bins=list(bins), histtype="step", linewidth=1.5, label=name)
    axes.set(xscale="log", xlabel="seconds in the solver", ylabel="missions")
    axes.legend()
    return png(figure)


def lines(
    found: Mapping[str, Sequence[tuple[float, float]]], across: str, along: str, *, equal: bool = False
) -> bytes:
    """Draw one line a name; equal : the same scale on both axes, as for a map."""
    figure = Figure(figsize=(7.5, 7.5 if equal else 3.5))
    axes = figure.add_subplot()
    for name, each in found.items():
        x, y = zip(*each, strict=True)
        axes.plot(x, y, label=name, marker=None if equal else "o")
    axes.set(xlabel=across, ylabel=along)
    if equal:
        axes.set_aspect("equal")
    else:
        axes.set(xlim=(0, None), ylim=(0, None))
    axes.grid(alpha=0.3)
    axes.legend()
    return png(figure)


def png(figure: Figure) -> bytes:
    """Return a figure as PNG bytes."""
    out = BytesIO()
    FigureCanvasAgg(figure)
    figure.savefig(out, format="png", dpi=DPI, bbox_inches="tight")
    return out.getvalue()
