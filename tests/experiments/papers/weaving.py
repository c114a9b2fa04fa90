"""The field mission of *multidrone*, Sec. 6, flown: three drones plan anew beside a walker who weaves."""

from __future__ import annotations

from collections.abc import Callable
from itertools import combinations
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.ir.trajectory import TrajectoryIR
from shotc.simulation.conditions import Conditions
from shotc.simulation.flight import DroneRuns
from shotc.simulation.judge import Run, judged
from shotc.simulation.runs import flown
from shotc.simulation.sensors import Gps
from shotc.simulation.truth import Truth
from shotc.simulation.wind import WindField
from shotc.simulation.world import at_times
from tests.experiments.papers.fleets import THREE, planned
from tests.experiments.papers.report import Table

RUNS = 3
GUSTS = WindField(gusts=0.5)
WEAVES = Truth(0.5)
CASES = {
    "replay, straight walker": Conditions(loop="replay", wind=GUSTS),
    "replan, straight walker, places known exactly": Conditions(
        loop="replan", wind=GUSTS, gps=Gps(noise=1e-6), detector=None
    ),
    "replan, straight walker": Conditions(loop="replan", wind=GUSTS),
    "replan, weaving walker": Conditions(loop="replan", wind=GUSTS, truth=WEAVES),
}
FILMED_S = (30.0, 90.0)
STEP_S = 0.1
PAPER = {"cam1": (95.0, 0.125, 9.543), "cam2": (141.4, 0.108, 9.543), "cam3": (98.6, 0.100, 14.711)}
"""Table 4: way, m, mean acceleration, m/s^2, and the least distance across, m."""

NOTES = (
    f"the mission of the other table of Sec. 6, planned and then flown {RUNS} times: gusts of "
    f"{GUSTS.gusts:g} m/s (standard deviation of each axis), RTK; the walker is "
    f"{WEAVES.wander:g} m off the straight way (standard deviation along East and along North), seeded",
    "way, acceleration and error are means over the runs; the rest is the worst of them. Accelerations are "
    f"differences of the flown velocity over {STEP_S:g} s; the rows of `replay` tell what gusts alone cost, "
    "and those of places known exactly that the rest is the estimate of where the walker is in 3 s",
    "to be reached were 0.2 m/s^2, the whole walker in every frame, and the paper's least distance",
    "the paper planned 10 s ahead every 2 s, with a walk that is not published",
)


class Told(NamedTuple):
    """One drone in one run, while it films.

    way, apart : m, the latter across, from the nearest other drone; acceleration : mean of its norm, m/s^2
    whole : share of frames with the whole walker; off, largest : distance on screen from the planned place,
        half frames
    """

    way: float
    acceleration: float
    apart: float
    whole: float
    off: float
    largest: float


def tables(say: Callable[[str], None]) -> tuple[Table, ...]:
    """Run it."""
    ir = planned(THREE).trajectory
    rows = []
    for name, conditions in CASES.items():
        say(f"flown: three drones beside a walker, {name}")
        found = fly(ir, conditions, RUNS, FILMED_S)
        rows += [row(name, drone, told) for drone, told in found.items()]
    return (
        Table(
            "Three drones film a walker who weaves (multidrone, Sec. 6, Table 4)",
            (
                "flown",
                "drone",
                "way, m (paper)",
                "acceleration, m/s^2 (paper)",
                "nearest across, m (paper)",
                "whole walker in frame",
                "screen error, mean",
                "largest",
            ),
            tuple(rows),
            NOTES,
        ),
    )


def fly(
    ir: TrajectoryIR, conditions: Conditions, runs: int, filmed: tuple[float, float]
) -> dict[str, list[Told]]:
    """Fly a plan and return by drone what came of each run between two times, s."""
    world, tracks = flown(ir, conditions, range(runs))
    times = np.arange(*filmed, STEP_S)
    places = [at_times(each.position, each.times, times) for each in tracks]
    apart = {each.drone: np.full(runs, np.inf) for each in tracks}
    for (one, a), (other, b) in combinations(zip(tracks, places, strict=True), 2):
        across = np.linalg.norm((a - b)[..., :2], axis=2).min(axis=0)
        for each in (one, other):
            apart[each.drone] = np.minimum(apart[each.drone], across)
    shown = judged(world, ir, tracks)
    return {
        each.drone: [
            Told(
                *_motion(place[:, r], _velocity(each, r, times)),
                float(apart[each.drone][r]),
                *_seen(run, each),
            )
            for r, run in enumerate(shown)
        ]
        for each, place in zip(tracks, places, strict=True)
    }


def row(name: str, drone: str, told: list[Told]) -> tuple[str, ...]:
    """Return a drone's row: means over the runs, and the worst of what is bounded."""
    way, acceleration, apart = PAPER[drone]
    mean = np.mean(told, axis=0)
    return (
        name,
        drone,
        f"{mean[0]:.1f} ({way:g})",
        f"{mean[1]:.3f} ({acceleration:.3f})",
        f"{min(each.apart for each in told):.2f} ({apart:.2f})",
        f"{100 * min(each.whole for each in told):.2f} %",
        f"{mean[4]:.3f}",
        f"{max(each.largest for each in told):.3f}",
    )


def _motion(place: Array, velocity: Array) -> tuple[float, float]:
    """Return the way and the mean acceleration of places and velocities (M, 3), STEP_S apart."""
    way = np.linalg.norm(np.diff(place, axis=0), axis=1).sum()
    return float(way), float(np.linalg.norm(np.diff(velocity, axis=0), axis=1).mean() / STEP_S)


def _velocity(of: DroneRuns, run: int, times: Array) -> Array:
    return at_times(of.velocity[:, run], of.times, times)


def _seen(run: Run, of: DroneRuns) -> tuple[float, float, float]:
    (picture,) = (each for each in run.pictures if each.drone == of.drone)
    assert picture.error is not None
    assert picture.worst is not None
    return picture.in_frame, picture.error, picture.worst
