"""Paths made by hand, and the checks that timed motions have to pass: for the tests of parameterize-time."""

from __future__ import annotations

from math import pi, radians

import numpy as np

from shotc.geom.bernstein import Piecewise, quintic_hermite
from shotc.ir.keyframes import KeyframeIR
from shotc.ir.mission import MissionIR
from shotc.ir.origin import OriginMap
from shotc.ir.path import DronePath, HoldLeg, Mark, MovingLeg, PathIR, Stop
from shotc.ir.phases import PhaseName
from shotc.ir.trajectory import TrajectoryIR
from shotc.planning.timing.limits import Ceiling
from shotc.source.file import Span
from tests.support.film_plans import orbit_mission
from tests.support.records import replace

CEILING = Ceiling(8.0, 4.0, 3.0, 3.0, 8.0, radians(60), radians(90), radians(45), radians(90))
HFOV = radians(70)


def line(start: tuple[float, ...], end: tuple[float, ...]) -> Piecewise:
    """A straight line in all seven channels; s is its length in space (or of the angles, in place)."""
    a, b = np.array(start), np.array(end)
    length = float(np.linalg.norm((b - a)[:3])) or float(np.abs(b - a).max())
    step = np.tile((b - a) / length, (2, 1))
    return quintic_hermite(np.array([0.0, length]), np.stack([a, b]), step, np.zeros((2, 7)))


def circle(radius: float, turn: float, pieces: int = 24) -> Piecewise:
    """A level arc from East, counter-clockwise, that looks at its centre with the body forward."""
    s = np.linspace(0.0, radius * turn, pieces + 1)
    w = s / radius
    zero, one = np.zeros_like(s), np.ones_like(s)
    value = np.stack([radius * np.cos(w), radius * np.sin(w), 20 * one, w + pi, zero, w + pi, HFOV * one], 1)
    rate = np.stack([-np.sin(w), np.cos(w), zero, one / radius, zero, one / radius, zero], 1)
    bend = np.stack([-np.cos(w) / radius, -np.sin(w) / radius, zero, zero, zero, zero, zero], 1)
    return quintic_hermite(s, value, rate, bend)


def smooth(seed: int, points: int = 6, size: float = 15.0) -> Piecewise:
    """A random C4 spline in all channels over its chord length."""
    from scipy.interpolate import make_interp_spline

    rng = np.random.default_rng(seed)
    steps = rng.uniform(-1, 1, (max(points, 6), 7)) * np.array([size, size, size / 3, 1, 0.3, 1, 0.05])
    p = np.cumsum(steps, axis=0)
    u = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(p[:, :3], axis=0), axis=1))])
    spline = make_interp_spline(u, p, k=5)
    knots = np.linspace(0.0, u[-1], 4 * len(p) + 1)
    return quintic_hermite(knots, spline(knots), spline(knots, 1), spline(knots, 2))


def s_curve_time(length: float, v: float, a: float, j: float) -> float:
    """The least time over a length from rest to rest under speed, acceleration and jerk: seven segments."""
    ramp = v / a + a / j if v * j >= a * a else 2 * np.sqrt(v / j)
    if length >= v * ramp:
        return length / v + ramp
    top = (-a * a / j + np.sqrt((a * a / j) ** 2 + 4 * a * length)) / 2
    if top >= a * a / j:
        return 2 * (top / a + a / j)
    return 4 * np.cbrt(length / (2 * j))


def uses(curve: Piecewise, ceiling: Ceiling, samples: int = 60) -> dict[str, float]:
    """The largest share of each limit at many instants of every piece, by plain evaluation."""
    x = np.linspace(0.0, 1.0, samples)
    t = (curve.breaks[:-1, None] + x * np.diff(curve.breaks)[:, None]).ravel()
    v, a, j = (curve.derivative(k)(t) for k in (1, 2, 3))
    gimbal = [d[:, [3, 4]] - np.stack([d[:, 5], 0 * d[:, 5]], 1) for d in (v, a)]
    return {
        "speed": np.hypot(v[:, 0], v[:, 1]).max() / ceiling.speed,
        "climb": v[:, 2].max() / ceiling.climb,
        "descent": -v[:, 2].min() / ceiling.descent,
        "acceleration": np.linalg.norm(a[:, :3], axis=1).max() / ceiling.acceleration,
        "jerk": np.linalg.norm(j[:, :3], axis=1).max() / ceiling.jerk,
        "yaw_rate": np.abs(v[:, 5]).max() / ceiling.yaw_rate,
        "yaw_acceleration": np.abs(a[:, 5]).max() / ceiling.yaw_acceleration,
        "gimbal_rate": np.abs(gimbal[0]).max() / ceiling.gimbal_rate,
        "gimbal_acceleration": np.abs(gimbal[1]).max() / ceiling.gimbal_acceleration,
    }


def jumps(curve: Piecewise) -> tuple[float, float, float]:
    """The largest jump of value, rate and acceleration at the joints."""
    found = []
    for order in range(3):
        ctrl = curve.derivative(order).ctrl if order else curve.ctrl
        found.append(float(np.abs(ctrl[1:, 0] - ctrl[:-1, -1]).max()) if len(ctrl) > 1 else 0.0)
    return found[0], found[1], found[2]


def mission(**changes: object) -> MissionIR:
    """The sample mission with some spans; changes go to its drone."""
    base = orbit_mission()
    spots = {
        ("shots", 0, "timing", "duration"): Span(10, 20, 10, 22),
        ("shots", 0, "timing", "start"): Span(10, 5, 10, 7),
        ("shots", 0, "keyframes", 1, "time"): Span(12, 30, 12, 31),
        ("drones", "cam1", "limits", "speed"): Span(5, 20, 5, 25),
        ("drones", "cam1", "endurance"): Span(6, 20, 6, 25),
    }
    return replace(
        base,
        drones=(replace(base.drones[0], **changes),),
        origins=OriginMap("mission.yaml", {("shots", 0): Span(8, 3, 8, 9)}, spots),
    )


MARKS = (("shots", 0, "keyframes", 0), ("shots", 0, "keyframes", 1))


def shot_leg(curve: Piecewise, **changes: object) -> MovingLeg:
    """The leg of the sample's shot: two stops without holds and a mark at each end, full pace."""
    leg = MovingLeg(
        phase="shot",
        shot="half",
        curve=curve,
        stops=(Stop(0.0, 0.0), Stop(curve.end, 0.0)),
        marks=tuple(
            Mark(s, None, i, path) for i, (s, path) in enumerate(zip((0.0, curve.end), MARKS, strict=True))
        ),
        framing=(),
        pace=1.0,
        duration=None,
        start=None,
        path=("shots", 0),
    )
    return replace(leg, **changes)


def held_leg(pose: tuple[float, ...], hold: float = 0.0, **changes: object) -> HoldLeg:
    """The same of a camera that stands."""
    marks = tuple(Mark(0.0, None, i, path) for i, path in enumerate(MARKS))
    leg = HoldLeg("half", pose, hold, marks, (), None, None, ("shots", 0))
    return replace(leg, **changes)


def flight(of: MissionIR, leg: MovingLeg | HoldLeg) -> PathIR:
    """Take-off and a transit to a shot's start, the shot, and down again."""
    pad = (*of.drones[0].home, *leg.pose[3:])
    above = (*pad[:2], pad[2] + 6.0, *pad[3:])
    end = leg.end_pose
    under = (*end[:2], 0.0, *end[3:])
    legs = (
        _plain("takeoff", line(pad, above)),
        _plain("transit", line(above, leg.pose)),
        leg,
        _plain("land", line(end, under)),
    )
    return PathIR(KeyframeIR(of, ()), (DronePath("cam1", legs),), (), ())


def _plain(phase: PhaseName, curve: Piecewise) -> MovingLeg:
    stops = (Stop(curve.start, 0.0), Stop(curve.end, 0.0))
    return MovingLeg(phase, None, curve, stops, (), (), 1.0, None, None, ("drones", "cam1"))


def shot_phase(ir: TrajectoryIR) -> tuple[float, float]:
    """Start and end of the filmed phase."""
    phase = next(p for p in ir.drones[0].phases if p.name == "shot")
    return phase.start, phase.end
