"""What a flown shot shows, measured without the code that made it or that verifies it.

Curves are evaluated by SciPy, and pictures projected by the equations of ``outputs.md``. The wanted picture
is the framing paper's: between two keyframes the place on screen and the cylinder to be framed go from one
keyframe's to the next one's with progress along the path (f_t and v_d, Sec. 4).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import BPoly

if TYPE_CHECKING:
    from shotc.geom.bernstein import Piecewise
    from shotc.ir.keyframes import PlacedKeyframe
    from shotc.ir.mission import MissionIR
    from shotc.ir.path import MovingLeg
    from shotc.ir.trajectory import DroneTrajectory

Array = NDArray[np.float64]

CAM_YAW, CAM_PITCH, HFOV = 3, 4, 6  # channels of a flight
UP = np.array([0.0, 0.0, 1.0])
NODES, WEIGHTS = np.polynomial.legendre.leggauss(3)  # exact for the square of a quintic's third derivative
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


class Pictures(NamedTuple):
    """What frames show, as in ``Shown``."""

    error: Array
    margin: Array
    points: Array


def shown(
    mission: MissionIR, keyframes: tuple[PlacedKeyframe, ...], leg: MovingLeg, flown: DroneTrajectory
) -> Shown:
    """Measure one shot that moves; leg : the path that was timed, flown : what came of it."""
    (phase,) = (p for p in flown.phases if p.shot == leg.shot)
    motion = polynomial(flown.curve)
    jerk = _rms_jerk(motion, phase.start, phase.end)
    seen = pictures(mission, keyframes, leg, flown, motion)
    return Shown(*seen, jerk=jerk, duration=phase.end - phase.start)


def pictures(
    mission: MissionIR,
    keyframes: tuple[PlacedKeyframe, ...],
    leg: MovingLeg,
    plan: DroneTrajectory,
    eyes: Callable[[Array], Array],
) -> Pictures:
    """Look at the frames of one shot that moves, wherever the camera is.

    plan : from which the picture that is wanted at a time is told; eyes : states (M, 7) at times (M,)
    """
    (phase,) = (p for p in plan.phases if p.shot == leg.shot)
    t = np.linspace(phase.start, phase.end, int(np.ceil((phase.end - phase.start) * RATE)) + 1)
    states = eyes(t)
    centre, radius, height, place = wanted(mission, keyframes, leg, _places(leg, polynomial(plan.curve), t))
    lens = Lens.of(states, mission.drone(plan.drone).aspect)
    offset = centre - states[:, :3]
    screen, depth = lens.project(offset)
    away = np.linalg.norm(offset, axis=1)
    return Pictures(
        error=np.where(depth > 0, np.linalg.norm(screen - place, axis=1), np.inf),
        margin=lens.inside(offset, radius, height) / away,
        points=np.min([lens.inside(point) for point in four_points(offset, radius, height)], axis=0) / away,
    )


def polynomial(curve: Piecewise) -> BPoly:
    """Return a curve in Bernstein form as SciPy has it."""
    return BPoly(np.array(curve.ctrl).transpose(1, 0, 2), np.array(curve.breaks))


class Lens(NamedTuple):
    """Cameras in W: directions right, down and ahead (M, 3), and half of what they see a metre ahead (M,)."""

    right: Array
    down: Array
    ahead: Array
    wide: Array
    high: Array

    @staticmethod
    def of(states: Array, aspect: float) -> Lens:
        """Return the cameras of states (M, 7)."""
        yaw, pitch = states[:, CAM_YAW], states[:, CAM_PITCH]
        ahead = np.stack([np.cos(yaw) * np.cos(pitch), np.sin(yaw) * np.cos(pitch), np.sin(pitch)], axis=1)
        right = np.stack([np.sin(yaw), -np.cos(yaw), np.zeros_like(yaw)], axis=1)
        wide = np.tan(states[:, HFOV] / 2)
        return Lens(right, np.cross(ahead, right), ahead, wide, wide / aspect)

    def project(self, offset: Array) -> tuple[Array, Array]:
        """Return the places on screen (M, 2) and the depths (M,) of points (M, 3) from the camera."""
        x, y, z = ((offset * axis).sum(axis=1) for axis in (self.right, self.down, self.ahead))
        return np.stack([x / (z * self.wide), -y / (z * self.high)], axis=1), z

    def inside(self, offset: Array, radius: Array | float = 0.0, height: Array | float = 0.0) -> Array:
        """Return how far all of an upright cylinder is inside the frame's nearest edge, metres (M,).

        Every edge is a plane through the camera: the point of the cylinder that is farthest beyond it, on one
        of the rims, decides.
        """
        found = []
        for axis, half in ((self.right, self.wide), (self.down, self.high)):
            for side in (-1.0, 1.0):
                inward = side * axis + half[:, None] * self.ahead
                inward /= np.linalg.norm(inward, axis=1)[:, None]
                level = inward * [1.0, 1.0, 0.0]
                level /= np.maximum(np.linalg.norm(level, axis=1), 1e-12)[:, None]
                rim = np.multiply(radius, level.T).T + np.outer(np.sign(inward[:, 2]) * height / 2, UP)
                found.append((inward * (offset - rim)).sum(axis=1))
        return np.asarray(np.min(found, axis=0))


def four_points(offset: Array, radius: Array, height: Array) -> list[Array]:
    """Return the paper's points (Eq. 4-7): above and below the centre, and beside it, square to the sight."""
    above = np.outer(height / 2, UP)
    beside = np.cross(UP, offset)
    beside = beside / np.linalg.norm(beside, axis=1)[:, None] * radius[:, None]
    return [offset + above, offset - above, offset + beside, offset - beside]


def _rms_jerk(motion: BPoly, start: float, end: float) -> float:
    breaks = motion.x[(motion.x > start) & (motion.x < end)]
    edges = np.concatenate([[start], breaks, [end]])
    middle, half = (edges[1:] + edges[:-1]) / 2, np.diff(edges) / 2
    times = middle[:, None] + half[:, None] * NODES
    jerk = motion.derivative(3)(times)[..., :3]
    return float(np.sqrt((half[:, None] * WEIGHTS * (jerk**2).sum(axis=-1)).sum() / (end - start)))


def wanted(
    mission: MissionIR, keyframes: tuple[PlacedKeyframe, ...], leg: MovingLeg, s: Array
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


def _places(leg: MovingLeg, motion: BPoly, t: Array) -> Array:
    """Return the path parameters at times of a shot: both have the same way behind them there."""
    s, fine = np.linspace(leg.curve.start, leg.curve.end, FINE), np.linspace(t[0], t[-1], FINE)
    over_path, over_time = _way(polynomial(leg.curve)(s)), _way(motion(fine))
    share = np.interp(t, fine, over_time / over_time[-1])
    return np.asarray(np.interp(share, over_path / over_path[-1], s))


def _way(q: Array) -> Array:
    return np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(q[:, :3], axis=0), axis=1))])
