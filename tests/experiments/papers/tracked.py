"""The aerial tracking of *yaw*, Sec. V-D and Table I, flown: a drone keeps 2 m from a robot that wanders."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from shotc.api import PlanOptions, compile_source
from shotc.geom.bernstein import Array
from shotc.ir.rehearsal import Loop
from shotc.ir.trajectory import TrajectoryIR
from shotc.simulation.conditions import Conditions
from shotc.simulation.gimbal import axes_of
from shotc.simulation.kalman import projection
from shotc.simulation.runs import flown
from shotc.simulation.truth import Truth
from shotc.simulation.world import at_times
from tests.experiments.papers.report import Table

RUNS = 3
WANDERS = Truth(0.3)
FILMED_S = (20.0, 60.0)
MISSION = """\
shotc: 1
mission: tracked
targets: {robot: {track: {start: [0, 0, 0.3], velocity: [0.4, 0, 0]}, radius: 0.3, height: 0.6}}
drones: {cam: {model: x500, radius: 0.25, home: [-6, 0, 0], limits: {speed: 1 m/s}}}
rules: {ground_clearance: 0.5 m, target_clearance: 0.5 m}
shots:
  - {id: behind, kind: chase, drone: cam, target: robot, distance: 1.8, altitude: 1.2,
     timing: {start: 20, duration: 40}}
"""


class Tracked(NamedTuple):
    """A run, or the mean of some; out : share of frames with the robot's middle out of the frame.

    off : mean angle between the optical axis and the robot, rad; turning : mean yaw rate, rad/s
    away, spread : mean and standard deviation of the distance, m
    """

    out: float
    off: float
    turning: float
    away: float
    spread: float


def trajectory() -> TrajectoryIR:
    """Plan the mission; it is one that can be planned."""
    done = compile_source(MISSION.encode(), "m.yaml", None, PlanOptions("none"))
    if done.plan is None:
        raise SystemExit("\n".join(d.message for d in done.diagnostics))
    return done.plan.trajectory


def fly(ir: TrajectoryIR, conditions: Conditions, runs: int, filmed: tuple[float, float]) -> list[Tracked]:
    """Fly a plan of one drone and one target; a result a run."""
    world, (drone,) = flown(ir, conditions, range(runs))
    (plan,), (target,) = ir.drones, ir.keyframes.mission.targets
    times = np.arange(*filmed, 0.04)
    wide = np.tan(plan.curve(times)[:, 6] / 2)
    half = np.column_stack([wide, wide / world.mission.drone(drone.drone).aspect])
    found = []
    for run in range(runs):
        at = at_times(drone.position[:, run], drone.times, times)
        away = at_times(world.places[target.name][:, run], world.times, times) - at
        yaw = at_times(np.unwrap(drone.yaw[:, run]), drone.times, times)
        axes = axes_of(yaw, at_times(drone.pitch[:, run], drone.times, times))
        found.append(measured(away, yaw, axes, half, float(times[1] - times[0])))
    return found


def measured(away: Array, yaw: Array, axes: Array, half: Array, step: float) -> Tracked:
    """Return the measures of offsets from the camera to the target (M, 3), W, ``step`` seconds apart.

    yaw : (M,), rad, unwrapped; axes : R_WC (M, 3, 3); half : tan of half the fields of view, (M, 2)
    """
    distance = np.linalg.norm(away, axis=1)
    uv, _ = projection(away, axes, half)
    inside = (np.abs(uv) <= 1.0).all(axis=1)  # NaN is not inside
    ahead = np.einsum("mi,mi->m", axes[:, :, 2], away) / distance
    return Tracked(
        float((~inside).mean()),
        float(np.arccos(np.clip(ahead, -1.0, 1.0)).mean()),
        float(np.abs(np.diff(yaw)).mean() / step),
        float(distance.mean()),
        float(distance.std()),
    )


def table(say: Callable[[str], None]) -> Table:
    """Return Table I, flown, beside the paper's."""
    ir = trajectory()
    rows = [("the paper", "2.07 %", "0.29", "0.12", "2.30 (0.36)")]
    loops: tuple[Loop, ...] = ("track", "replan")
    for loop in loops:
        say(f"flown: a robot that wanders, {loop}")
        mean = Tracked(*np.mean(fly(ir, Conditions(loop=loop, truth=WANDERS), RUNS, FILMED_S), axis=0))
        rows.append(
            (
                f"`{loop}`",
                f"{100 * mean.out:.2f} %",
                f"{mean.off:.3f}",
                f"{mean.turning:.3f}",
                f"{mean.away:.2f} ({mean.spread:.2f})",
            )
        )
    return Table(
        "A drone tracks a robot (yaw, Sec. V-D, Table I)",
        ("flown", "out of view", "off the axis, rad", "yaw rate, rad/s", "distance, m (SD)"),
        tuple(rows),
        (
            f"a chase of 40 s, {RUNS} runs: the robot goes 0.4 m/s along a straight way, "
            f"{WANDERS.wander:g} m off it (standard deviation along East and along North, seeded); the drone "
            "flies 1 m/s at most; RTK, still air; planned anew twice a second (the paper: 10 times)",
            "the yaw rate is the camera's, on a gimbal; the paper's camera is fixed to the drone, which "
            "turns and pitches as it flies, under motion capture indoors",
            "the plan has the drone 2.0 m from the robot",
            "to be reached were 2 %, 0.2 rad, 0.2 rad/s and 2.0 m within 0.3 m",
        ),
    )
