"""Missions made by hand for the geometry stage, and a dense check that knows nothing of how it plans."""

from __future__ import annotations

from math import cos, pi, radians, sin

import numpy as np

from shotc.geom.camera import aim_at
from shotc.geom.shapes import CylinderShape
from shotc.geom.solids import Cylinder, Prism, Solid, distance
from shotc.ir.drone import Drone
from shotc.ir.keyframes import KeyframeIR, PlacedKeyframe, PlacedShot
from shotc.ir.limits import Timing
from shotc.ir.mission import MissionIR, Shot, Zone
from shotc.ir.passes import Outcome, PassContext
from shotc.ir.path import BODY_YAW, CAM_PITCH, CAM_YAW, MovingLeg, PathIR, PathLeg
from shotc.ir.promise import Promise
from shotc.ir.target import Target
from shotc.passes.solve_path_qp import SolvePathQp
from tests.support.film_plans import orbit_mission
from tests.support.records import replace

HFOV, ASPECT = radians(70), 16 / 9
FIELD = Prism(((-80.0, -80.0), (80.0, -80.0), (80.0, 80.0), (-80.0, 80.0)), 2.0, 60.0)
TOWER = Target("tower", (0.0, 0.0, 12.0), CylinderShape(4.0, 24.0), ("targets", "tower"))


def codes(outcome: Outcome[PathIR]) -> list[str]:
    return [d.code for d in outcome.diagnostics]


def mission(*zones: Zone, targets: tuple[Target, ...] | None = None, **drone: object) -> MissionIR:
    base = orbit_mission()
    made = replace(base, zones=zones, drones=(replace(base.drones[0], **{"body": "free", **drone}),))
    if targets is None:
        return made
    # The shots of the mission that it is made from film a target that is gone.
    unaimed = tuple(
        replace(s, subject=None, keyframes=tuple(replace(k, target=None) for k in s.keyframes))
        for s in made.shots
    )
    return replace(made, targets=targets, shots=unaimed)


def out(name: str, solid: Solid) -> Zone:
    return Zone(name, "out", solid, ("world", "zones", name))


def inside(name: str, solid: Solid) -> Zone:
    return Zone(name, "in", solid, ("world", "zones", name))


def block(x: tuple[float, float], y: tuple[float, float], z: tuple[float, float]) -> Prism:
    return Prism(((x[0], y[0]), (x[1], y[0]), (x[1], y[1]), (x[0], y[1])), *z)


def free(index: int, at, *, yaw=0.0, pitch=0.0, hfov=HFOV, hold=0.0, placed=True) -> PlacedKeyframe:
    """A keyframe that frames nothing."""
    return PlacedKeyframe(
        tuple(map(float, at)), yaw, pitch, hfov, None, None, None, hold, None, placed,
        ("shots", 0, "keyframes", index),
    )  # fmt: skip


def framed(index: int, at, target: Target, *, uv=(0.0, 0.0), hfov=HFOV, hold=0.0, placed=True):
    """A keyframe that shows a target at the screen place uv."""
    at = tuple(map(float, at))
    yaw, pitch = aim_at(tuple(c - p for c, p in zip(target.centre, at, strict=True)), uv, hfov, ASPECT)
    return PlacedKeyframe(
        at, yaw, pitch, hfov, target.name, uv, uv, hold, None, placed, ("shots", 0, "keyframes", index)
    )


def shot(keyframes, *, name="s0", timing=Timing(), pace=0.75) -> PlacedShot:  # noqa: B008
    made = Shot(name, "keyframes", "cam1", None, (), timing, pace, Promise(), False, ("shots", 0))
    return PlacedShot(made, tuple(keyframes))


def circle(target: Target, count: int, radius: float, z: float, *, sweep=2 * pi, start=-pi / 2, placed=True):
    angles = np.linspace(start, start + sweep, count)
    return [
        framed(i, (radius * cos(a), radius * sin(a), z), target, placed=placed) for i, a in enumerate(angles)
    ]


def solve(made: MissionIR, *shots: PlacedShot) -> Outcome[PathIR]:
    return SolvePathQp().run(KeyframeIR(made, shots), PassContext())


def planned(made: MissionIR, *shots: PlacedShot) -> PathIR:
    """Plan, and hold the plan to everything that can be sampled."""
    outcome = solve(made, *shots)
    assert outcome.value is not None, [d.message for d in outcome.diagnostics]
    outcome.value.check()
    for leg in outcome.value.drones[0].legs:
        if isinstance(leg, MovingLeg):
            assert_sound(made, made.drones[0], leg)
    return outcome.value


def legs(path: PathIR, phase: str) -> list[PathLeg]:
    return [leg for leg in path.drones[0].legs if leg.phase == phase]


def assert_sound(made: MissionIR, drone: Drone, leg: MovingLeg) -> None:
    """Clearances, gimbal ranges and continuity, densely sampled."""
    curve = leg.curve
    q = curve(np.linspace(curve.start, curve.end, 700))
    gimbal_yaw = q[:, CAM_YAW] - q[:, BODY_YAW]
    assert gimbal_yaw.min() >= drone.gimbal.yaw[0] - 1e-7
    assert gimbal_yaw.max() <= drone.gimbal.yaw[1] + 1e-7
    assert q[:, CAM_PITCH].min() >= drone.gimbal.pitch[0] - 1e-9
    assert q[:, CAM_PITCH].max() <= drone.gimbal.pitch[1] + 1e-9
    if leg.phase not in {"takeoff", "land"}:
        points = [tuple(p) for p in q[::7, :3]]
        assert min(least_room(made, drone, p) for p in points) >= -1e-6
    assert_continuous(leg)


def assert_continuous(leg: MovingLeg) -> None:
    """C2 at every break that is no stop, C0 at the others."""
    curve = leg.curve
    stops = np.array([s.s for s in leg.stops])
    moving = np.abs(curve.breaks[1:-1, None] - stops).min(axis=1) > 1e-9
    for order, where in ((0, np.ones_like(moving)), (1, moving), (2, moving)):
        d = curve.derivative(order)
        jump = np.abs(d.ctrl[1:, 0] - d.ctrl[:-1, -1])[where]
        assert jump.max(initial=0.0) <= 1e-6 * (1 + np.abs(d.ctrl).max())


def least_room(made: MissionIR, drone: Drone, p: tuple[float, float, float]) -> float:
    """Metres that a point has beyond the nearest clearance."""
    space = [p[2] - made.rules.ground_clearance - drone.radius]
    for zone in made.zones:
        if zone.keep == "out":
            space.append(distance(zone.solid, p) - drone.radius)
        elif isinstance(zone.solid, Prism):
            space += [p[2] - zone.solid.bottom - drone.radius, zone.solid.top - p[2] - drone.radius]
            space += [beyond(zone.solid, p) - drone.radius]
    for t in made.targets:
        x, y, z = t.centre
        solid = Cylinder((x, y), t.radius, z - t.height / 2, z + t.height / 2)
        space.append(distance(solid, p) - drone.radius - made.rules.target_clearance)
    return min(space)


def beyond(prism: Prism, p: tuple[float, float, float]) -> float:
    """Distance from a point inside a prism to its sides, negative outside."""
    from shotc.geom.solids import closest_on_segment, edges, inside_polygon

    nearest = min(
        np.hypot(q[0] - p[0], q[1] - p[1])
        for q in (closest_on_segment(a, b, (p[0], p[1])) for a, b in edges(prism.points))
    )
    return float(nearest if inside_polygon(prism.points, (p[0], p[1])) else -nearest)
