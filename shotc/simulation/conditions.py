"""The conditions in which a plan is simulated."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from zlib import crc32

import numpy as np

from shotc.ir.rehearsal import Loop, VehicleName
from shotc.simulation.outages import Outage
from shotc.simulation.sensors import RTK, Detector, Gps, Interval
from shotc.simulation.truth import Truth
from shotc.simulation.wind import WindField


@dataclass(frozen=True, slots=True)
class Conditions:
    """The conditions that all runs share.

    loop : "replay" flies the plan; with "track" the camera follows the estimates of its targets; with
        "replan" the drone follows them as well
    replanner : name of the replanner, of ``plugins.names("replanners")``
    vehicle : "lag" is the built-in model, "rotorpy" needs RotorPy
    gps : receiver of the drones and of moving targets
    outages : when positions are lost
    detector : finds targets in pictures, or None
    """

    loop: Loop = "replay"
    replanner: str = "ours"
    wind: WindField = field(default_factory=WindField)
    vehicle: VehicleName = "lag"
    gps: Gps = RTK
    outages: tuple[Outage, ...] = ()
    detector: Detector | None = field(default_factory=Detector)
    truth: Truth = field(default_factory=Truth)
    seed: int = 1

    def chances(self, runs: Sequence[int], what: str) -> list[np.random.Generator]:
        """Return one random generator for each run; it depends only on the seed, the run and ``what``."""
        return [np.random.default_rng(self.seed_of(run, what)) for run in runs]

    def lost(self, name: str) -> tuple[Interval, ...]:
        """Return the intervals in which a drone or a target has no satellite positions, in order, apart."""
        spans: list[Interval] = []
        for start, end in sorted((o.start, o.end) for o in self.outages if o.who in ("", name)):
            if spans and start <= spans[-1][1]:
                spans[-1] = (spans[-1][0], max(end, spans[-1][1]))
            else:
                spans.append((start, end))
        return tuple(spans)

    def seed_of(self, run: int, what: str) -> tuple[int, ...]:
        """Return the seed of one random quantity in a run."""
        return (self.seed, run, crc32(what.encode()))
