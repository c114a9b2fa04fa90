"""The refine-path pass: PathIR -> PathIR by a refiner plugin, whose result is checked, not believed.

A refiner may move the filmed legs; it may not change what is filmed, nor hand back a path that breaks the
invariants of PathIR, a clearance or the gimbal's range: all that solve-path-qp guarantees still holds.
What goes wrong is an error that names the refiner and its package. Where the shot that it concerns says
``refine: {optional: true}``, it is a warning and the shot's convex path is flown.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar

from shotc.ir.keyframes import KeyframeIR
from shotc.ir.path import PathIR
from shotc.passes.base import Outcome, PassContext
from shotc.passes.refine_path.ask import ask
from shotc.passes.refine_path.blame import blame, still_true
from shotc.passes.refine_path.seat import REFINER, KeepPath, Refiner, Seat, Unusable
from shotc.passes.refine_path.settle import settle

__all__ = ["REFINER", "KeepPath", "RefinePath", "Refiner", "Seat", "Unusable", "blame", "still_true"]


@dataclass(frozen=True, slots=True)
class RefinePath:
    """Run one refiner.

    deadline : seconds that it may take, or None
    """

    seat: Seat
    deadline: float | None = None
    name: ClassVar[str] = "refine-path"

    def run(self, ir: PathIR, ctx: PassContext) -> Outcome[PathIR]:
        """Refine the filmed legs of drones that film what stands, or explain."""
        if not ir.drones:
            return Outcome(ir)
        if not ir.timed:
            return settle(ir, self.seat, ask(self.seat, self.deadline, ir, ctx))
        standing = _standing(ir)
        settled = settle(standing, self.seat, ask(self.seat, self.deadline, standing, ctx))
        if settled.value is None:
            return settled
        return settled._replace(value=replace(settled.value, keyframes=ir.keyframes, timed=ir.timed))


def _standing(ir: PathIR) -> PathIR:
    """Return a path, and the mission it comes from, with the drones alone that a refiner refines."""
    names = {drone.drone for drone in ir.drones}
    mission = ir.keyframes.mission
    mine = mission._replace(shots=tuple(s for s in mission.shots if s.drone in names))
    shots = tuple(p for p in ir.keyframes.shots if p.shot.drone in names)
    return replace(ir, keyframes=KeyframeIR(mine, shots), timed=())
