"""The moment with the worst framing of a shot, according to the certificate."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite

import numpy as np

from shotc.emit.screen import IN_FRAME, SCREEN_ERROR
from shotc.ir.sampling import projected
from shotc.ir.trajectory import Claim, DroneTrajectory, VerifiedIR
from shotc.rounding import at_least, at_most


@dataclass(frozen=True, slots=True)
class WorstFrame:
    """The time of a shot's worst framing, seconds, and the error in words."""

    time: float
    words: str


@dataclass(frozen=True, slots=True)
class _Edge:
    """The least margin of a whole target inside the frame, metres, with its time, seconds."""

    margin: float
    time: float
    target: str


def worst_framing(plan: VerifiedIR, flight: DroneTrajectory, shot: str) -> WorstFrame | None:
    """Return the worst moment of a shot; None if the certificate has no claim on its framing.

    It is the moment of the largest cropping. If no target is cropped, it is that of the largest screen error.
    If no target has a reference either, it is that of the least margin to the frame's edge.
    """
    claims = [c for c in plan.certificate if c.shot == shot and c.time is not None]
    whole = [c for c in claims if c.constraint.endswith(IN_FRAME)]
    off = max((c for c in claims if c.constraint.endswith(SCREEN_ERROR)), key=lambda c: c.worst, default=None)
    several = len(whole) > 1
    if off is not None and off.time is not None and all(c.worst >= 1.0 for c in whole):
        name = f"{off.constraint.removesuffix(SCREEN_ERROR)} " if several else ""
        text = f"screen error {at_least(off.worst, 3)}" if isfinite(off.worst) else "behind the camera"
        return WorstFrame(off.time, name + text)
    least = min((_edge(plan, flight, c) for c in whole), key=lambda edge: edge.margin, default=None)
    if least is None:
        return None
    name = f"{least.target} " if several else ""
    text = (
        f"{at_least(-least.margin, 2)} m out of the frame"
        if least.margin < 0.0
        else f"{at_most(least.margin, 2)} m from the frame's edge"
    )
    return WorstFrame(least.time, name + text)


def _edge(plan: VerifiedIR, flight: DroneTrajectory, claim: Claim) -> _Edge:
    target, time = claim.constraint.removesuffix(IN_FRAME), claim.time or 0.0
    frames = projected(plan.trajectory.keyframes.mission, flight, target, np.array([time]))
    return _Edge(float(frames.margin[0]), time, target)
