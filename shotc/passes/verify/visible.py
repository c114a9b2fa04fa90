"""Claims on the visible share of a shot's targets: in any frame, in most frames, and for reveals."""

from __future__ import annotations

from collections.abc import Iterator
from math import inf

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.pieces import Mask
from shotc.ir.hidden import HALF_SHARE
from shotc.ir.mission import Shot
from shotc.ir.sampling import share_of_frames
from shotc.ir.trajectory import Claim
from shotc.passes.verify.claims import JudgedFlight, Limit, WorstValue, claim

VISIBLE, IN_SIGHT = " visible", " in sight"
AT_FIRST, AT_LAST = " visible at first", " visible at last"
"""Endings of such claims, after the target's name."""

OUTLINE = "of its outline"
"""The unit of shares of an outline."""

SAME_SHARE = 1e-9
"""Tolerance of equal shares of an outline."""


def visible(
    flight: JudgedFlight, shot: Shot, target: str, times: Array, seen: tuple[Array, Mask]
) -> Iterator[Claim]:
    """Yield claims on the visible share of a target: in any frame, in most frames, and for a reveal.

    times : of the samples, (M,)
    seen : share of the outline that something covers, (M,), and which samples shares count, (M,)
    """
    covered, counted = seen
    free = 1.0 - covered
    yield _least(flight, shot, target, times, free)
    promised = shot.promise.visible is not None or shot.promise.reveal is not None
    most = -inf if promised else HALF_SHARE  # a promise replaces this claim
    limit = Limit(f"{target}{IN_SIGHT}", most, "of samples", shot.path, upper=False, hard=False, shot=shot.id)
    hidden = free < HALF_SHARE
    yield claim(
        flight,
        limit,
        WorstValue(share_of_frames(~hidden, counted), float(times[longest(hidden)]), "sampled"),
    )
    if shot.promise.reveal is not None:
        first, last = shot.promise.reveal
        for name, key, value, k, upper in (
            (AT_FIRST, "from", first, 0, first < last),
            (AT_LAST, "to", last, -1, first > last),
        ):
            path = (*shot.path, "require", "reveal", key)
            limit = Limit(f"{target}{name}", value, OUTLINE, path, upper=upper, shot=shot.id)
            yield claim(flight, limit, WorstValue(float(free[k]), float(times[k]), "sampled"))


def _least(flight: JudgedFlight, shot: Shot, target: str, times: Array, free: Array) -> Claim:
    promised, least = shot.promise.visible, float(free.min())
    default = -inf if shot.promise.reveal is not None else HALF_SHARE
    limit = Limit(
        f"{target}{VISIBLE}",
        default if promised is None else promised,
        OUTLINE,
        shot.path if promised is None else (*shot.path, "require", "visible"),
        upper=False,
        hard=promised is not None,
        shot=shot.id,
    )
    k = longest(free <= least + SAME_SHARE)
    return claim(flight, limit, WorstValue(least, float(times[k]), "sampled"))


def longest(hidden: Mask) -> int:
    """Return the sample in the middle of the longest run of True; 0 where there is none."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], hidden, [False]]).astype(np.int8)))
    if not len(edges):
        return 0
    starts, ends = edges[::2], edges[1::2]
    k = int((ends - starts).argmax())
    return int((starts[k] + ends[k] - 1) // 2)
