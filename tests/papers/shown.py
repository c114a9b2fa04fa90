"""What a flown shot shows, measured without the code that made it or that verifies it.

The wanted picture is the framing paper's: between two keyframes the place on screen and the cylinder to be
framed go from one keyframe's to the next one's with progress along the path (f_t and v_d, Sec. 4).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from shotc.comparison.score import squared_jerk
from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.camera import View, frustum_margins, point_margins
from shotc.ir.keyframes import PlacedKeyframe
from shotc.ir.mission import MissionIR
from shotc.ir.path import CAM_PITCH, CAM_YAW, HFOV, Leg
from shotc.ir.trajectory import DroneTrajectory

RATE = 25.0  # frames a second
FINE = 4001  # samples by which places on the path are told from places on the trajectory


@dataclass(frozen=True, eq=False)
class Shown:
    """One shot, frame by frame, shape (M,), and its motion.

    error : distance on screen of the target's centre from its place, half frames; infinite behind the camera
    margin, points : how far inside the frame's nearest edge the exact cylinder, and the least of the paper's
        four points, lie, as a share of the distance
    jerk : RMS, m/s^3; duration : s
    """

    error: Array
    margin: Array
    points: Array
    jerk: float
    duration: float

    @property
    def p95(self) -> float:
        """What 95 % of the frames do not exceed."""
        return percentile(self.error, 0.95)

    @property
    def whole(self) -> float:
        """Share of frames with the exact cylinder in the frame."""
        return float((self.margin >= 0.0).mean())

    @property
    def four_points(self) -> float:
        """Share of frames with the four points in the frame."""
        return float((self.points >= 0.0).mean())


def percentile(values: Array, share: float) -> float:
    """Return the least of the values that ``share`` of them do not exceed."""
    ordered = np.sort(values)
    return float(ordered[int(np.ceil(share * len(ordered))) - 1])


def shown(
    mission: MissionIR, keyframes: tuple[PlacedKeyframe, ...], leg: Leg, flown: DroneTrajectory
) -> Shown:
    """Measure one shot that moves; leg : the path that was timed, flown : what came of it."""
    (phase,) = (p for p in flown.phases if p.shot == leg.shot)
    t = np.linspace(phase.start, phase.end, int(np.ceil((phase.end - phase.start) * RATE)) + 1)
    q = flown.curve(t)
    centre, radius, height, place = wanted(mission, keyframes, leg, _places(leg, flown.curve, t))
    aspect = mission.drone(flown.drone).aspect
    wide = np.tan(q[:, HFOV] / 2)
    yaw, pitch = q[:, CAM_YAW], q[:, CAM_PITCH]
    view = View(np.cos(yaw), np.sin(yaw), np.cos(pitch), np.sin(pitch), wide, wide / aspect)
    x, y, z = (centre - q[:, :3]).T
    u, v, forward = view.project((x, y, z))
    away = np.sqrt(x * x + y * y + z * z)
    return Shown(
        error=np.where(forward > 0, np.hypot(u - place[:, 0], v - place[:, 1]), np.inf),
        margin=np.min(frustum_margins(view, (x, y, z), radius, height), axis=0) / away,
        points=np.min(point_margins(view, (x, y, z), radius, height), axis=0) / away,
        jerk=float(np.sqrt(squared_jerk(flown.curve, phase.start, phase.end) / (phase.end - phase.start))),
        duration=phase.end - phase.start,
    )


def wanted(
    mission: MissionIR, keyframes: tuple[PlacedKeyframe, ...], leg: Leg, s: Array
) -> tuple[Array, Array, Array, Array]:
    """Return the cylinder's centre (M, 3), radius and height (M,), and its place (M, 2), at path places s."""
    at = np.array([mark.s for mark in leg.marks])
    rows = []
    for mark in leg.marks:
        keyframe = keyframes[mark.index]
        assert keyframe.target is not None
        assert keyframe.reference is not None
        target = mission.target(keyframe.target)
        rows.append([*target.centre, target.radius, target.height, *keyframe.reference])
    i = np.clip(np.searchsorted(at, s, side="right") - 1, 0, len(at) - 2)
    x = np.clip((s - at[i]) / (at[i + 1] - at[i]), 0.0, 1.0)
    share = (x**3 * (10.0 + x * (6.0 * x - 15.0)))[:, None]
    table = (1.0 - share) * np.array(rows)[i] + share * np.array(rows)[i + 1]
    return table[:, :3], table[:, 3], table[:, 4], table[:, 5:]


def _places(leg: Leg, curve: Piecewise, t: Array) -> Array:
    """Return the path parameters at times of a shot: both have the same way behind them there."""
    assert leg.curve is not None
    s, fine = np.linspace(leg.curve.start, leg.curve.end, FINE), np.linspace(t[0], t[-1], FINE)
    over_path, over_time = _way(leg.curve(s)), _way(curve(fine))
    return np.interp(np.interp(t, fine, over_time / over_time[-1]), over_path / over_path[-1], s)


def _way(q: Array) -> Array:
    return np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(q[:, :3], axis=0), axis=1))])
