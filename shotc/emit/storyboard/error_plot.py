"""Screen error over a shot as a small plot, shaded where a target is not wholly in frame."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from shotc.emit.palette import CAMERA, FAINT, INK, KEEP_OUT, QUIET, WHITE
from shotc.emit.storyboard.canvas import Canvas, PageRectangle, Type
from shotc.geom.bernstein import Array
from shotc.geom.pieces import Mask
from shotc.ir.comparison import ComparedShot, Trace


def draw_error(canvas: Canvas, box: PageRectangle, shot: ComparedShot, what: tuple[float, float]) -> None:
    """Draw the errors of a shot.

    what : time of the frame to mark, seconds, and the end of the error axis
    """
    time, top = what
    canvas.polygons([box.outline()], WHITE, FAINT, 0.6)
    cropped = [
        PageRectangle(box.x + a * box.width, box.y, (b - a) * box.width, box.height).outline()
        for trace in shot.traces
        for a, b in stretches(trace.share, trace.margin < 0.0)
    ]
    if cropped:
        canvas.polygons(cropped, (*KEEP_OUT, 0.22), clip=box)
    at = box.x + (time - shot.start) / (shot.end - shot.start) * box.width
    canvas.lines([np.array([[at, box.y], [at, box.top]])], CAMERA, 1.2)
    for trace in shot.traces:
        for strip in _curves(box, trace, top):
            canvas.lines([strip], INK, 1.3, box)
    canvas.text(box.x - 0.05, box.top - 0.08, f"{top:g}", Type(7.5, QUIET, across="right"))
    canvas.text(box.x - 0.05, box.y, "0", Type(7.5, QUIET, across="right"))
    canvas.text(box.x, box.y - 0.14, "0 s", Type(7.5, QUIET))
    canvas.text(box.right, box.y - 0.14, f"{shot.end - shot.start:.1f} s", Type(7.5, QUIET, across="right"))


def stretches(share: Array, flags: Mask) -> Iterator[tuple[float, float]]:
    """Yield the intervals in which the flags hold, each extended half-way to the neighbouring samples.

    share : of the samples' times in the shot, (M,), ascending; flags : (M,)
    """
    joined = np.concatenate([[False], joins(share), [False]])
    for a, b in runs(share, flags):
        low = 0.5 * (share[a - 1] + share[a]) if joined[a] else share[a]
        high = 0.5 * (share[b - 1] + share[b]) if joined[b] else share[b - 1]
        yield float(low), float(high)


def runs(share: Array, flags: Mask) -> Iterator[tuple[int, int]]:
    """Yield the first and one past the last index of consecutive samples whose flags hold.

    share, flags : as of ``stretches``, (M,) each
    """
    joined = np.concatenate([[False], joins(share)])
    (firsts,) = np.nonzero(flags & ~(joined & np.roll(flags, 1)))
    (lasts,) = np.nonzero(flags & ~(np.roll(joined, -1) & np.roll(flags, -1)))
    yield from zip(firsts.tolist(), (lasts + 1).tolist(), strict=True)


def joins(share: Array) -> Mask:
    """Return which samples are followed by the next on the clock, (M - 1,); at gaps another target is filmed.

    share : as of ``stretches``
    """
    steps = np.diff(share)
    return np.asarray(steps <= 1.5 * float(np.median(steps))) if len(steps) else np.zeros(0, dtype=np.bool_)


def _curves(box: PageRectangle, trace: Trace, top: float) -> Iterator[Array]:
    """Yield the curve of an error in parts, broken where the error is unknown and cut at the top."""
    x = box.x + trace.share * box.width
    y = box.y + np.minimum(trace.error, 2 * top) / top * box.height
    for a, b in runs(trace.share, ~np.isnan(y)):
        yield np.stack([x[a:b], y[a:b]], axis=-1)
