"""What all drones of a run share: the wind, and the true positions of targets."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.track import Track
from shotc.ir.mission import MissionIR
from shotc.ir.target import Target
from shotc.ir.trajectory import TrajectoryIR
from shotc.simulation.conditions import Conditions
from shotc.simulation.vehicle import STEP_S


@dataclass(frozen=True, slots=True, eq=False)
class World:
    """R runs of a mission.

    runs : their numbers
    times : N steps from the mission's start to its end, seconds
    steady : constant part of the wind, (R, 3), m/s
    places : true positions of each target, (N, R, 3), metres
    """

    mission: MissionIR
    conditions: Conditions
    runs: tuple[int, ...]
    times: Array
    steady: Array
    places: dict[str, Array]

    @staticmethod
    def of(ir: TrajectoryIR, conditions: Conditions, runs: Sequence[int]) -> World:
        """Return the world of some runs of a plan."""
        mission = ir.keyframes.mission
        end = max(track.curve.end for track in ir.drones)
        times = np.arange(int(np.ceil(end / STEP_S)) + 1, dtype=np.float64) * STEP_S
        steady = conditions.wind.steady(conditions.chances(runs, "wind"))
        places = {
            target.name: conditions.truth.places(
                target, times, conditions.chances(runs, f"target {target.name}")
            )
            for target in mission.targets
        }
        return World(mission, conditions, tuple(runs), times, steady, places)

    def moves(self, name: str) -> bool:
        """Return whether a target leaves its centre in any run."""
        moving = self.mission.target(name).track is not None
        return moving or name in dict(self.conditions.truth.tracks)

    def target(self, name: str, run: int, times: Array) -> Target:
        """Return a target with its true track in one run, sampled at times (M,).

        run : index of the run
        """
        target = self.mission.target(name)
        if not self.moves(name):
            return target
        rows = at_times(self.places[name][:, run], self.times, times)
        points = tuple((x, y, z) for x, y, z in rows.tolist())
        track = Track(tuple(times.tolist()), points, since=float(times[0]), until=float(times[-1]))
        return target._replace(centre=track.at(0.0), track=track)


def at_times(rows: Array, clock: Array, times: Array) -> Array:
    """Return rows (N, ...) on a uniform clock (N,), linearly interpolated at times (M,); shape (M, ...)."""
    at = np.clip((times - clock[0]) / (clock[1] - clock[0]), 0.0, len(clock) - 1.0)
    k = np.minimum(at.astype(np.intp), len(clock) - 2)
    share = (at - k).reshape(-1, *([1] * (rows.ndim - 1)))
    return np.asarray(rows[k] * (1.0 - share) + rows[k + 1] * share)
