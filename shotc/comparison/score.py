"""The measures of a comparison: screen error, target in frame, jerk and duration of every shot.

Framing is measured on the samples of verification.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite

import numpy as np

from shotc.geom.bernstein import Array, Piecewise, bernstein_basis
from shotc.geom.camera import ROUNDING_M
from shotc.geom.framing import points_in_frame
from shotc.geom.pieces import cut
from shotc.ir.bodies import shapes
from shotc.ir.comparison import ComparedShot, MotionMeasures, Score, Trace
from shotc.ir.framed import at_start
from shotc.ir.keyed import is_keyed
from shotc.ir.mission import MissionIR
from shotc.ir.path import CAM_PITCH, CAM_YAW, X, Y, Z
from shotc.ir.phases import Phase
from shotc.ir.sampling import beside_cameras, cameras, subjects
from shotc.ir.trajectory import DroneTrajectory, VerifiedIR
from shotc.passes.verify.claims import JudgedFlight
from shotc.passes.verify.framing import view_of
from shotc.planning.clock.ideals import ideal_places

PERCENTILE_SHARE = 0.95
PLACES_HZ = 10.0  # Hz of the camera positions that are compared with the ideal
STILL = MotionMeasures(0.0, 0.0, 0.0, 0.0, 0.0)
ROUNDS = "refine_rounds"
"""Name of the statistic SHOT.refine_rounds: how often the refiner solved the shot."""
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(3)
"""Exact for the square of a quintic's third derivative, which has degree four."""


def flown_shots(plan: VerifiedIR) -> tuple[ComparedShot, ...]:
    """Return all shots of a plan, measured, in the order of filming."""
    flown = [
        _flown(plan, track, phase)
        for track in plan.trajectory.drones
        for phase in track.phases
        if phase.shot is not None
    ]
    return tuple(sorted(flown, key=lambda shot: (shot.start, shot.id)))


def total(plan: VerifiedIR, shots: Sequence[ComparedShot]) -> Score:
    """Return the score of all shots together; each frame has the same weight, and so has each
    filmed second.
    """
    motions = [shot.motion for shot in shots]
    motion = (
        MotionMeasures(*(float(sum(column)) for column in zip(*motions, strict=True))) if motions else STILL
    )
    return score([trace for shot in shots for trace in shot.traces], motion)


def score(traces: Sequence[Trace], motion: MotionMeasures) -> Score:
    """Return the score of some traces and of the motion of their cameras."""
    margin = np.concatenate([np.empty(0), *(trace.margin for trace in traces)])
    points = np.concatenate([np.empty(0), *(trace.points for trace in traces)])
    covered = np.concatenate([np.empty(0), *(trace.covered for trace in traces)])
    error = np.concatenate([np.empty(0), *(trace.error for trace in traces)])
    error = np.sort(error[~np.isnan(error)])
    count = len(error)
    return Score(
        frames=len(margin),
        error_mean=float(error.mean()) if count else None,
        error_p95=float(error[int(np.ceil(PERCENTILE_SHARE * count)) - 1]) if count else None,
        error_worst=float(error[-1]) if count else None,
        in_frame=float((margin >= -ROUNDING_M).mean()) if len(margin) else None,
        in_frame_four_points=float(points.mean()) if len(points) else None,
        visible=1.0 - float(covered.max()) if len(covered) else None,
        jerk_rms=_rms(motion.jerk, motion.duration),
        turn_jerk_rms=_rms(motion.turn_jerk, motion.duration),
        off_place=motion.off_place / motion.placed if motion.placed > 0 else None,
        duration=motion.duration,
    )


def _rms(squared: float, duration: float) -> float:
    return float(np.sqrt(squared / duration)) if duration > 0 else 0.0


def squared_jerk(curve: Piecewise, start: float, end: float, *channels: int) -> float:
    """Return the integral of the squared norm of jerk over a time interval.

    channels : of the curve; without any x, y and z, in m^2/s^5
    """
    pieces = cut(curve, start, end).channels(*(channels or (X, Y, Z)))
    for _ in range(3):
        pieces = pieces.derivative()
    if not len(pieces):
        return 0.0
    basis = bernstein_basis(pieces.ctrl.shape[1] - 1, (_NODES + 1) / 2)
    jerk: Array = np.einsum("gk,pkd->pgd", basis, pieces.ctrl)
    widths = (pieces.high - pieces.low) / 2
    return float(np.einsum("p,g,pgd->", widths, _WEIGHTS, jerk**2))


def _flown(plan: VerifiedIR, track: DroneTrajectory, phase: Phase) -> ComparedShot:
    ir, shot = plan.trajectory, str(phase.shot)
    traces = tuple(
        trace
        for target in subjects(ir.keyframes.mission, track, shot)
        if (trace := _trace(plan, track, phase, target)) is not None
    )
    motion = _motion(ir.keyframes.mission, track, phase)
    scored = score(traces, motion)
    return ComparedShot(
        shot, track.drone, phase.start, phase.end, traces, motion, scored, _rounds(plan, shot)
    )


def _motion(mission: MissionIR, track: DroneTrajectory, phase: Phase) -> MotionMeasures:
    shot, duration = mission.shot(phase.shot), phase.end - phase.start
    jerk = squared_jerk(track.curve, phase.start, phase.end)
    turn_jerk = squared_jerk(track.curve, phase.start, phase.end, CAM_YAW, CAM_PITCH)
    if shot.ideal is None or is_keyed(shot) or duration <= 0:
        return MotionMeasures(jerk, turn_jerk, 0.0, 0.0, duration)
    times = np.linspace(phase.start, phase.end, max(2, round(PLACES_HZ * duration)))
    ideal = ideal_places(mission, at_start(mission, shot, phase.start), phase.start, times)
    off = np.linalg.norm(track.curve(times)[:, :3] - ideal, axis=1)
    return MotionMeasures(jerk, turn_jerk, float(off.mean()) * duration, duration, duration)


def _rounds(plan: VerifiedIR, shot: str) -> int | None:
    statistic = dict(plan.trajectory.stats).get(f"{shot}.{ROUNDS}")
    return int(statistic) if isinstance(statistic, (int, float)) and isfinite(statistic) else None


def _trace(plan: VerifiedIR, track: DroneTrajectory, phase: Phase, target: str) -> Trace | None:
    ir = plan.trajectory
    mission = ir.keyframes.mission
    (placed,) = (p for p in ir.keyframes.shots if p.shot.id == phase.shot)
    view = view_of(JudgedFlight(mission, mission.drone(track.drone), track), placed, target, phase)
    if view is None:
        return None
    t = view.times
    share = (t - phase.start) / (phase.end - phase.start)
    filmed = mission.target(target)
    eyes = beside_cameras(cameras(mission, track, t), filmed, t)
    points = points_in_frame(eyes, filmed.centre, shapes(filmed, t))
    return Trace(target, t, share, view.error, view.frames.margin, points.astype(np.float64), view.covered)
