"""The refine-path pass: PathIR -> PathIR by a refiner plugin, whose result is checked, not believed.

A refiner may move the filmed legs; it may not change what is filmed, nor hand back a path that breaks the
invariants of PathIR, a clearance or the gimbal's range: all that solve-path-qp guarantees still holds.
What goes wrong is an error that names the refiner and its package. Where the shot that it concerns says
``refine: {optional: true}``, it is a warning and the shot's convex path is flown.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from shotc.ir.needs import needed
from shotc.ir.passes import Outcome, PassContext
from shotc.ir.path import PathIR
from shotc.passes.refine_path.account import account
from shotc.passes.refine_path.ask import ask
from shotc.passes.refine_path.blame import blame, shortest_refined, still_true
from shotc.passes.refine_path.instead import with_convex
from shotc.passes.refine_path.seat import REFINER, KeepPath, Seat, Unusable
from shotc.passes.refine_path.settle import settle

__all__ = [
    "REFINER",
    "KeepPath",
    "RefinePath",
    "Refiner",
    "Seat",
    "Unusable",
    "account",
    "blame",
    "needed",
    "shortest_refined",
    "still_true",
    "with_convex",
]


@dataclass(frozen=True, slots=True)
class RefinePath:
    """Run one refiner.

    deadline : seconds that it may take, or None
    """

    seat: Seat
    deadline: float | None = None
    name: ClassVar[str] = "refine-path"

    def run(self, ir: PathIR, ctx: PassContext) -> Outcome[PathIR]:
        """Refine the filmed legs, or explain."""
        return settle(ir, self.seat, ask(self.seat, self.deadline, ir, ctx))
