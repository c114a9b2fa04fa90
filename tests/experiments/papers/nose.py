"""The yaw paper's joint programme (Sec. IV-C, Eq. 12, 13, 16, 18 and 19) beside ways that look ahead.

Place and heading are one clamped cubic spline through free knots, the heading as a direction s / |s|. Its
control effort and penalties on what breaks limits are minimised by L-BFGS. Ours are the ways of
`rules.look_ahead`.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from math import cos, pi, radians
from typing import NamedTuple

import casadi as ca
import numpy as np
from scipy.interpolate import CubicSpline
from scipy.optimize import minimize

from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.solids import Cylinder
from shotc.geom.vec import wrapped
from shotc.ir.drone import Drone
from shotc.ir.limits import Limits
from shotc.ir.owners import Owner
from shotc.ir.path import BODY_YAW, Pose
from shotc.planning.free_space import FreeSpace, Obstacle
from shotc.planning.obstacles import FreeSpaces
from shotc.planning.path.legs import LegContext, way_to
from shotc.planning.timing.timed_leg import leg_motion
from tests.experiments.papers.report import Table
from tests.support.front_passes import resolved

COUNT, SEED = 60, 16
HALF_ANGLES = (30.0, 45.0, 60.0)  # degrees
KNOT_S, SAMPLES, DENSE = 1.0, 12, 4001  # seconds a piece; samples a piece; samples of a whole motion
WEIGHTS = (1e2, 1e4, 1e6)  # of penalties, one round after the other
LEAST_RADIUS, MOST_RADIUS_RATE = 0.3, 3.0  # Eq. 19, times the limits of the real yaw
STEPS = 300
SLOW_M_S = 0.5
NEAR_DEG, CLEAR_M = 1.0, 0.02
WITHIN = 1.02  # of a limit: kept by a method of penalties
SCALES = tuple(np.arange(0.8, 1.65, 0.05).round(2))
"""Of our time, in which the programme is tried until it keeps everything."""

COLUMNS = (
    "method",
    "found",
    "time s",
    "beyond the cone, median deg",
    "worst deg",
    "limits kept",
    "yaw effort",
    "ms median",
)
MISSION = """\
shotc: 1
mission: nose
drones: {cam: {model: x500, home: [0, 0]}}
shots:
  - {id: a, kind: static, drone: cam, at: [0, 0, 10], heading: 0 deg, pitch: 0 deg, timing: {duration: 1 s}}
"""


class Instance(NamedTuple):
    """A way from one pose to another past a mast; half_angle : rad; mast : its centre, its radius, metres."""

    start: Pose
    goal: Pose
    half_angle: float
    mast: tuple[Array, float]


class Moved(NamedTuple):
    """Samples of a motion: places and their derivatives, heading with its rate and acceleration.

    clear : metres that the body is clear of the mast
    """

    t: Array
    places: Array
    velocity: Array
    acceleration: Array
    yaw: Array
    yaw_rate: Array
    yaw_acceleration: Array
    clear: float


class Measured(NamedTuple):
    """What is measured of a motion; off, beyond : of the course and the cone, rad; seconds : CPU time.

    used : the largest share of a limit; clear : metres
    """

    takes: float
    off: float
    beyond: float
    used: float
    clear: float
    effort: float
    seconds: float

    @property
    def kept(self) -> bool:
        """Whether limits and the mast are kept, but for what penalties leave."""
        return self.used <= WITHIN and self.clear >= -CLEAR_M


def instances(count: int = COUNT) -> list[Instance]:
    """Return ways of 25 to 60 m with headings from all directions, past a mast near their middle."""
    rng, found = np.random.default_rng(SEED), []
    for k in range(count):
        away, towards = rng.uniform(25.0, 60.0), rng.uniform(-pi, pi)
        along = np.array([np.cos(towards), np.sin(towards)])
        radius = rng.uniform(2.0, 5.0)
        aside = rng.uniform(-1.2, 1.2) * radius * np.array([-along[1], along[0]])
        yaws = rng.uniform(-pi, pi, 2)
        yaws[1] = yaws[0] + wrapped(float(yaws[1] - yaws[0]))
        ends = np.array([[0.0, 0.0, 10.0], [*(away * along), rng.uniform(7.0, 13.0)]])
        start, goal = (
            (*map(float, p), float(y), 0.0, float(y), 1.2) for p, y in zip(ends, yaws, strict=True)
        )
        mast = 0.5 * away * along + aside, float(radius)
        found.append(Instance(start, goal, radians(HALF_ANGLES[k % len(HALF_ANGLES)]), mast))
    return found


def drone() -> Drone:
    """Return the drone that flies."""
    mission, _ = resolved(MISSION)
    assert mission is not None
    return mission.drones[0]


def ours(who: Drone, of: Instance, *, look_ahead: bool = True) -> tuple[Moved, float]:
    """Return our way and its CPU time; look_ahead : whether the nose is kept near the course."""
    began = time.process_time()
    (x, y), radius = of.mast
    owner = Owner("zone", "mast", ("world", "zones", "mast"))
    mast = Obstacle(owner, Cylinder((float(x), float(y)), radius, 0.0, 60.0), who.radius)
    space = FreeSpace((mast,), (), ())
    spaces = FreeSpaces(space, space)
    flight = LegContext(who, spaces, np.array(of.start[:3]), of.half_angle if look_ahead else None)
    legs = way_to(flight, of.start, of.goal, ())
    assert isinstance(legs, list)
    motions = [leg_motion(who, leg) for leg in legs]
    curve = next(m.curve for m in motions if m is not None)
    return _sampled(curve, of, who), time.process_time() - began


def _sampled(curve: Piecewise, of: Instance, who: Drone) -> Moved:
    t = np.linspace(curve.start, curve.end, DENSE)
    first, second = curve.derivative()(t), curve.derivative(2)(t)
    pose = curve(t)
    clear = np.linalg.norm(pose[:, :2] - of.mast[0], axis=1).min() - of.mast[1] - who.radius
    return Moved(
        t,
        pose[:, :3],
        first[:, :3],
        second[:, :3],
        pose[:, BODY_YAW],
        first[:, BODY_YAW],
        second[:, BODY_YAW],
        float(clear),
    )


def joint(
    who: Drone, of: Instance, guide: Moved, takes: float, *, coupled: bool = True
) -> tuple[Moved, float]:
    """Return the paper's motion and its CPU time.

    guide : a motion from whose places and course the knots begin; takes : seconds of the motion
    coupled : whether Eq. 16 counts
    """
    began = time.process_time()
    pieces = max(4, round(takes / KNOT_S))
    knots = np.linspace(0.0, takes, pieces + 1)
    rest = (1, np.zeros(pieces + 1))
    basis = CubicSpline(knots, np.eye(pieces + 1), bc_type=(rest, rest))
    at = (knots / takes * (DENSE - 1)).round().astype(int)
    course = np.arctan2(guide.velocity[at, 1], guide.velocity[at, 0])
    s = np.column_stack([np.cos(course), np.sin(course)])
    s[[0, -1]] = [[np.cos(y), np.sin(y)] for y in (of.start[BODY_YAW], of.goal[BODY_YAW])]
    values = np.column_stack([guide.places[at], s])
    values[[0, -1], :3] = [of.start[:3], of.goal[:3]]
    inner = values[1:-1].ravel()
    for weight in WEIGHTS:
        cost = _cost(who, of, basis, values[[0, -1]], weight, coupled=coupled)
        found = minimize(cost, inner, jac=True, method="L-BFGS-B", options={"maxiter": STEPS})
        inner = found.x
    values[1:-1] = inner.reshape(-1, 5)
    seconds = time.process_time() - began
    t = np.linspace(0.0, takes, DENSE)
    zero, first, second = (basis(t, k) @ values for k in range(3))
    square = (zero[:, 3:] ** 2).sum(axis=1)
    rate = _cross(zero[:, 3:], first[:, 3:]) / square
    along = (zero[:, 3:] * first[:, 3:]).sum(axis=1) / square
    bend = _cross(zero[:, 3:], second[:, 3:]) / square - 2.0 * rate * along
    clear = np.linalg.norm(zero[:, :2] - of.mast[0], axis=1).min() - of.mast[1] - who.radius
    yaw = np.arctan2(zero[:, 4], zero[:, 3])
    return Moved(t, zero[:, :3], first[:, :3], second[:, :3], yaw, rate, bend, float(clear)), seconds


def _cross(a: Array, b: Array) -> Array:
    return np.asarray(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])


def _cost(
    who: Drone, of: Instance, basis: CubicSpline, ends: Array, weight: float, *, coupled: bool
) -> Callable[[Array], tuple[float, Array]]:
    """Return Eq. 12 and its gradient as a function of the inner knots."""
    pieces = len(basis.x) - 1
    x = (np.arange(SAMPLES * pieces) + 0.5) / (SAMPLES * pieces) * basis.x[-1]
    step = basis.x[-1] / len(x)
    w = ca.MX.sym("w", 5 * (pieces - 1))
    knots = ca.vertcat(ca.DM(ends[:1]), ca.reshape(w, 5, pieces - 1).T, ca.DM(ends[1:]))
    zero, first, second = (ca.DM(basis(x, k)) @ knots for k in range(3))
    p, v, a, limits = zero[:, :2], first[:, :3], second[:, :3], who.limits
    s, ds, dds = (part[:, 3:] for part in (zero, first, second))
    square = ca.sum2(s**2)
    rate = (s[:, 0] * ds[:, 1] - s[:, 1] * ds[:, 0]) / square  # Eq. 13
    along = ca.sum2(s * ds) / square
    bend = (s[:, 0] * dds[:, 1] - s[:, 1] * dds[:, 0]) / square - 2 * rate * along
    level = ca.sqrt(ca.sum2(v[:, :2] ** 2) + 1e-6)
    ahead = cos(of.half_angle) * level - ca.sum2(s * v[:, :2]) / ca.sqrt(square)  # Eq. 16
    near = of.mast[1] + who.radius
    broken = [
        level**2 / limits.speed**2 - 1,
        v[:, 2] ** 2 / limits.descent**2 - 1,
        ca.sum2(a**2) / limits.acceleration**2 - 1,
        1 - ca.sum2((p - ca.repmat(ca.DM(of.mast[0]).T, p.shape[0], 1)) ** 2) / near**2,
        rate**2 / limits.yaw_rate**2 - 1,  # Eq. 18, of the angle
        bend**2 / limits.yaw_acceleration**2 - 1,
        1 - square / LEAST_RADIUS**2,  # Eq. 19
        ca.sum2(ds**2) / (MOST_RADIUS_RATE * limits.yaw_rate) ** 2 - 1,
        ca.sum2(dds**2) / (MOST_RADIUS_RATE * limits.yaw_acceleration) ** 2 - 1,
        *([ahead] if coupled else []),
    ]
    penalty = sum(ca.sum1(ca.fmax(g, 0) ** 3) for g in broken)
    total = step * (ca.sum1(ca.sum2(second**2)) + weight * penalty)
    made = ca.Function("cost", [w], [total, ca.gradient(total, w)])

    def value(inner: Array) -> tuple[float, Array]:
        cost, slope = made(inner)
        return float(cost), np.asarray(slope).ravel()

    return value


def measured(moved: Moved, of: Instance, limits: Limits, seconds: float) -> Measured:
    """Return what a motion takes, how far its nose is off, and how far it uses its limits."""
    level = np.linalg.norm(moved.velocity[:, :2], axis=1)
    off = np.abs(wrapped(moved.yaw - np.arctan2(moved.velocity[:, 1], moved.velocity[:, 0])))
    used = (
        level.max() / limits.speed,
        np.linalg.norm(moved.acceleration, axis=1).max() / limits.acceleration,
        np.abs(moved.yaw_rate).max() / limits.yaw_rate,
        np.abs(moved.yaw_acceleration).max() / limits.yaw_acceleration,
    )
    takes = float(moved.t[-1] - moved.t[0])
    effort = float(np.trapezoid(moved.yaw_acceleration**2, moved.t))
    most = float(off[level > SLOW_M_S].max(initial=0.0))
    beyond = max(0.0, most - of.half_angle)
    return Measured(takes, most, beyond, float(max(used)), moved.clear, effort, seconds)


def table(count: int = COUNT) -> Table:
    """Run the programme and our ways on all instances."""
    who, given = drone(), instances(count)
    methods: dict[str, list[Measured]] = {}

    def add(name: str, of: Instance, made: tuple[Moved, float]) -> None:
        methods.setdefault(name, []).append(measured(made[0], of, who.limits, made[1]))

    for of in given:
        plain, way = ours(who, of, look_ahead=False), ours(who, of)
        add("ours, without the rule", of, plain)
        add("ours, look ahead", of, way)
        guide = plain[0]
        takes = float(way[0].t[-1])
        add("joint, in our time", of, joint(who, of, guide, takes))
        tried = (joint(who, of, guide, scale * takes) for scale in SCALES)
        soonest = next((made for made in tried if _keeps(measured(made[0], of, who.limits, 0.0), of)), None)
        if soonest is not None:
            add("joint, in the least time that keeps all", of, soonest)
        add("joint, without Eq. 16, in our time", of, joint(who, of, guide, takes, coupled=False))
    rows = tuple(_row(name, each, count) for name, each in methods.items())
    return Table(f"To look where one flies: {count} ways past a mast", COLUMNS, rows, NOTES)


def _keeps(found: Measured, of: Instance) -> bool:
    """Tell whether a motion keeps its limits, the mast and the cone, but for what penalties leave."""
    return found.kept and found.off <= of.half_angle + radians(NEAR_DEG)


def _row(name: str, each: list[Measured], count: int) -> tuple[str, ...]:
    beyond = np.degrees([m.beyond for m in each])
    return (
        name,
        f"{100 * len(each) / count:.0f} %",
        f"{np.mean([m.takes for m in each]):.2f}",
        f"{np.median(beyond):.1f}",
        f"{beyond.max():.1f}",
        f"{100 * np.mean([m.kept for m in each]):.0f} %",
        f"{np.median([m.effort for m in each]):.2f}",
        f"{1e3 * np.median([m.seconds for m in each]):.0f}",
    )


NOTES = (
    "Ways of 25 to 60 m from rest to rest, headings drawn from all directions at both ends, half-angles of "
    f"{', '.join(f'{a:.0f}' for a in HALF_ANGLES)} deg in turn, a mast of 2 to 5 m near the middle, the "
    "x500's limits. The paper gives no figures for it.",
    "joint: Eq. 12 with Eq. 13, 16, 18 and 19: clamped cubics with a knot a second, L-BFGS, penalties to the "
    "third power over time, of weight 10^2, then 10^4 and 10^6; from our way without the rule, and its "
    "course. Eq. 18 is held for the angle itself: psi^(2) of a unit vector has psi'^4 in its square, too. "
    "Eq. 14, 15 and 17 are of points that a sensor is to see; this task has none.",
    "beyond the cone: by how much the nose is farther off the course than the half-angle, wherever the drone "
    f"is faster than {SLOW_M_S} m/s, at {DENSE} samples; of ours that it is not is proved, too. limits kept: "
    "speed, acceleration, yaw rate and acceleration within 2 %, and the mast clear within 2 cm. The jerk is "
    "bound in ours alone. yaw effort: integral of the squared angular acceleration, rad^2/s^3.",
    f"least time: of {SCALES[0]:g} to {SCALES[-1]:g} times ours, by 0.05, the first in which limits are "
    f"kept and the cone within {NEAR_DEG:g} deg; ms are those of that try alone.",
)
