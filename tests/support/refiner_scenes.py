"""Shots for the refiners of `plugins/shotc-casadi`: in memory for their parts, as text for the whole."""

from __future__ import annotations

from functools import cache
from math import pi
from typing import NamedTuple

import numpy as np
from shotc_casadi import conditions
from shotc_casadi.conditions import AimCondition
from shotc_casadi.margins import Margins
from shotc_casadi.problem import problem
from shotc_casadi.program import Problem
from shotc_casadi.references import ShotContext, references_at
from shotc_casadi.refiner import subjects
from shotc_casadi.stages import Stages, stages
from shotc_casadi.walls import half_spaces

from shotc.api import Compilation, PlanOptions, compile_source
from shotc.geom.solids import Cylinder
from shotc.ir.keyframes import PlacedShot
from shotc.ir.mission import MissionIR
from shotc.ir.path import MovingLeg, PathIR
from shotc.ir.target import Target
from shotc.ir.trajectory import VerifiedIR
from tests.support.path_scenes import TOWER, block, circle, mission, out, planned, shot


def subject(made: MissionIR, shot: PlacedShot) -> ShotContext:
    """The one moving shot of a mission, on its convex path."""
    return subjects(planned(made, shot))[0]


@cache
def arc() -> ShotContext:
    """A quarter turn round a tower."""
    return subject(mission(targets=(TOWER,)), shot(circle(TOWER, 4, 45.0, 20.0, sweep=1.5)))


@cache
def walled() -> ShotContext:
    """The same past a wall and a tank."""
    zones = (
        out("wall", block((28.0, 34.0), (-50.0, -38.0), (0.0, 40.0))),
        out("tank", Cylinder((45.0, -32.0), 3.0, 0.0, 30.0)),
    )
    return subject(mission(*zones, targets=(TOWER,)), shot(circle(TOWER, 4, 45.0, 20.0, sweep=1.5)))


def nodes_of(of: ShotContext, count: int | None = 24) -> Stages:
    """The nodes of a shot, few unless told."""
    return stages(of.leg, of.placed, of.drone, count)


def task(
    of: ShotContext,
    condition: AimCondition = conditions.OURS,
    count: int | None = 24,
    margins: Margins = Margins(),  # noqa: B008
) -> Problem:
    """The optimal-control problem of a shot on few stages."""
    nodes = nodes_of(of, count)
    walls = half_spaces(of.space, of.leg.curve, nodes, margins)
    return problem(of, condition, nodes, references_at(of, condition, nodes.s), walls, margins)


HEAD = """\
shotc: 1
mission: tower
world: {zones: {tree: {keep: out, cylinder: {center: [-25, -62], radius: 4, height: [0, 30]}}}}
targets:
  tower: {at: [0, 0, 12], radius: 4, height: 24}
  mast: {at: [60, 40, 8], radius: 2, height: 16}
drones: {cam: {model: x500, home: [0, -90, 0]}}
rules: {composition: thirds}
output: {emit: [csv]}
shots:
"""
ARC = (
    "at: [-60, -45, 10], look_at: tower",
    "at: [0, -70, 18], look_at: tower, frame: left-third",
    "at: [65, -30, 16], look_at: tower",
)


def keyed(*rows: str, shot: str = "s", target: str = "tower", more: str = "") -> str:
    """One shot of keyframes."""
    lines = [f"  - id: {shot}", "    kind: keyframes", "    drone: cam", f"    target: {target}"]
    lines += [f"    {more}"] * bool(more) + ["    keyframes:"] + [f"      - {{{row}}}" for row in rows]
    return "\n".join(lines) + "\n"


def compiled(text: str, refiner: str = "ours") -> Compilation:
    """The mission compiled under a refiner."""
    return compile_source(text.encode(), "tower.yaml", None, PlanOptions(refiner=refiner))


def path_of(done: Compilation, step: str = "refine-path") -> PathIR:
    """The path that a pass handed on."""
    return next(report.output for report in done.reports if report.name == step)


def leg_named(path: PathIR, shot: str = "s") -> MovingLeg:
    """The leg that films a shot."""
    return next(leg for drone in path.drones for leg in drone.legs if leg.shot == shot)


class Seen(NamedTuple):
    """What a camera makes of its target, at dense samples.

    off : distance of the centre from its place on screen; where the leg has one
    inside : angle by which the whole cylinder is inside the frame, negative where it is cropped
    """

    off: np.ndarray
    inside: np.ndarray


def seen(plan: VerifiedIR, shot: str = "s", count: int = 700) -> Seen:
    """Look at the flown camera: a cloud of points on the rims of each target, projected one by one."""
    mission = plan.trajectory.keyframes.mission
    off, inside = [], []
    for flown in plan.trajectory.drones:
        aspect = mission.drone(flown.drone).aspect
        for span in (f for f in flown.framing if f.shot == shot and f.reference is not None):
            t = np.linspace(span.start, span.end, count)
            q, wanted, target = flown.curve(t), span.reference(t), mission.target(span.target)
            half = np.tan(q[:, 6] / 2)
            right, up, forward = _in_camera(q, np.array(target.centre))
            u, v = right / forward / half, up / forward / half * aspect
            off.append(np.hypot(u - wanted[:, 0], v - wanted[:, 1]))
            inside.append(_least_angle(q, target, half, half / aspect))
    return Seen(np.concatenate(off), np.concatenate(inside))


def _in_camera(q: np.ndarray, point: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Right, up and forward components of points from cameras (N, 7), without shotc's own camera."""
    d = point - q[:, :3]
    cy, sy, cp, sp = np.cos(q[:, 3]), np.sin(q[:, 3]), np.cos(q[:, 4]), np.sin(q[:, 4])
    ahead = np.column_stack([cy * cp, sy * cp, sp])
    right = np.column_stack([sy, -cy, 0 * cy])
    up = np.cross(right, ahead)
    return (d * right).sum(axis=1), (d * up).sum(axis=1), (d * ahead).sum(axis=1)


def _least_angle(q: np.ndarray, target: Target, wide: np.ndarray, tall: np.ndarray) -> np.ndarray:
    a = np.linspace(0, 2 * pi, 180, endpoint=False)
    rim = np.column_stack([target.radius * np.cos(a), target.radius * np.sin(a), 0 * a])
    least = np.full(len(q), np.inf)
    for point in [
        np.array(target.centre) + r + [0, 0, end * target.height / 2] for end in (-1, 1) for r in rim
    ]:
        right, up, forward = _in_camera(q, point)
        assert (forward > 0).all()
        for side, edge in ((right, wide), (-right, wide), (up, tall), (-up, tall)):
            least = np.minimum(least, np.arctan(edge) - np.arctan2(side, forward))
    return least
