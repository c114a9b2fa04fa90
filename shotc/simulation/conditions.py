"""Under which conditions a plan is flown."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from zlib import crc32

import numpy as np

from shotc.ir.rehearsal import Loop, VehicleName
from shotc.simulation.sensors import RTK, Detector, Gps
from shotc.simulation.truth import Truth
from shotc.simulation.wind import WindField


@dataclass(frozen=True, slots=True)
class Conditions:
    """What runs have in common.

    loop : replay flies the plan; track lets the camera follow where its targets are taken to be; replan lets
        the drone follow, too; replanner : who plans anew then, of ``plugins.names("replanners")``
    vehicle : what flies: "lag" is ours, "rotorpy" needs RotorPy
    gps : the receivers of drones and of targets that move; detector : what finds targets in pictures, or None
    """

    loop: Loop = "replay"
    replanner: str = "ours"
    wind: WindField = field(default_factory=WindField)
    vehicle: VehicleName = "lag"
    gps: Gps = RTK
    detector: Detector | None = field(default_factory=Detector)
    truth: Truth = field(default_factory=Truth)
    seed: int = 1

    def chances(self, runs: Sequence[int], what: str) -> list[np.random.Generator]:
        """Return random numbers for one thing in each run: no other thing and no other run changes them."""
        return [np.random.default_rng(self.seed_of(run, what)) for run in runs]

    def seed_of(self, run: int, what: str) -> tuple[int, ...]:
        """Return the seed of one thing in a run."""
        return (self.seed, run, crc32(what.encode()))
