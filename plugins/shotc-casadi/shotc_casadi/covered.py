"""How much of a target is free of occluders; the measure by which refined cameras are accepted."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from shotc.plugin_api import Piecewise
from shotc.plugin_api.refiner import HALF_SHARE, Array, PlacedShot, coverage, hidden_on_purpose
from shotc_casadi.references import ShotContext

GAIN_SHARE = 0.005  # of an outline, or of the frames: a smaller loss does not count
LEAST_SHARE = 0.02  # the same for the one frame that shows least of the outline
PATH_SAMPLES = 240  # of a path


class UncoveredShare(NamedTuple):
    """Which share of a target's outline is not covered, from 0 to 1.

    mean, least, first, last : mean over the frames, least of all frames, first frame, last frame
    sighted : share of the frames that show at least half of the outline
    """

    mean: float = 1.0
    least: float = 1.0
    first: float = 1.0
    last: float = 1.0
    sighted: float = 1.0


def free_of(covered: Array) -> UncoveredShare:
    """Return what is free in one or more frames; covered : covered share of the outline by frame, (M,)."""
    free = 1.0 - covered
    in_sight = (free >= HALF_SHARE).mean()
    return UncoveredShare(
        float(free.mean()), float(free.min()), float(free[0]), float(free[-1]), float(in_sight)
    )


def lost(placed: PlacedShot, before: UncoveredShare, after: UncoveredShare) -> float:
    """Return by how much a target is less free than before in what is promised or reported; 0 if not.

    If the target may be hidden, only promises count. Otherwise two more values count: the mean, and whether
    every frame shows half of the outline.
    """
    if hidden_on_purpose(placed.shot):
        return broken(placed, before, after)
    losses = [before.mean - after.mean - GAIN_SHARE, before.sighted - after.sighted - GAIN_SHARE]
    if placed.shot.promise.visible is None:
        losses.append(_short(HALF_SHARE, before.least, after.least))
    return max(*losses, broken(placed, before, after))


def broken(placed: PlacedShot, before: UncoveredShare, after: UncoveredShare) -> float:
    """Return by how much a promise that was kept is broken, or is broken further; 0 for none."""
    promise, losses = placed.shot.promise, [0.0]
    if promise.visible is not None:
        losses.append(_short(promise.visible, before.least, after.least))
    if promise.reveal is not None:
        first, last = promise.reveal
        side = 1.0 if first < last else -1.0
        losses.append(_short(-side * first, -side * before.first, -side * after.first))
        losses.append(_short(side * last, side * before.last, side * after.last))
    return max(losses)


def _short(required: float, before: float, after: float) -> float:
    """Return by how much a value misses what is asked, or the value before if that misses it too."""
    return required - after if before >= required else before - after - LEAST_SHARE


def lost_on_path(subject: ShotContext, camera: Piecewise) -> float:
    """Return by how much a camera over s shows less of its targets than the convex path, as ``lost`` does.

    Moving occluders do not count: the time of each place is not known yet.
    """
    after = _on_path(subject, camera)
    return (
        0.0
        if after == UncoveredShare()
        else lost(subject.placed, _on_path(subject, subject.leg.curve), after)
    )


def _on_path(subject: ShotContext, camera: Piecewise) -> UncoveredShare:
    mission, covered = subject.mission, [np.zeros(0)]
    standing = mission._replace(targets=tuple(t for t in mission.targets if t.track is None))
    s = np.linspace(camera.start, camera.end, PATH_SAMPLES)
    for span in subject.leg.framing:
        inside = s[(s >= span.start) & (s <= span.end)]
        eyes = camera(inside)[:, :3]
        covered.append(coverage(standing, (), span.target, eyes, np.zeros(len(inside))).share)
    shares = np.concatenate(covered)
    return free_of(shares) if len(shares) else UncoveredShare()
