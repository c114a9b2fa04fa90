"""The refine-path pass: PathIR -> PathIR by a refiner plugin, whose result is checked.

A refiner may move the filmed legs. It must not change what is filmed, nor return a path that violates the
invariants of PathIR, a clearance or the gimbal's range: all guarantees of solve-path-qp still hold. A
violation is an error that names the refiner and its package. If the shot says ``refine: {optional: true}``,
it is a warning, and the shot's convex path is flown.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from shotc.ir.passes import Outcome, PassContext
from shotc.ir.path import PathIR, needed
from shotc.passes.refine_path.account import account
from shotc.passes.refine_path.ask import ask
from shotc.passes.refine_path.blame import blame, shortest_refined, valid_on_refined, with_convex
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
    "valid_on_refined",
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
        """Return the path with refined legs, or errors."""
        return settle(ir, self.seat, ask(self.seat, self.deadline, ir, ctx))
