"""The refine-path pass: PathIR -> PathIR by a refiner plugin, whose result is checked, not believed.

A refiner may move the filmed legs; it may not change which legs there are, nor hand back a path that
breaks the invariants of PathIR. What goes wrong is an error that names the refiner, or, where every
shot of the mission says ``refine: {optional: true}``, a warning and the convex path.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, Protocol

import numpy as np

from shotc.diag.model import Diagnostic
from shotc.ir.path import Leg, PathIR
from shotc.passes.base import Outcome, PassContext


class Refiner(Protocol):
    """What sits in the refiner seat (entry-point group ``shotc.refiners``)."""

    name: ClassVar[str]
    summary: ClassVar[str]
    api: ClassVar[int]

    def refine(self, path: PathIR, ctx: PassContext) -> Outcome[PathIR]:
        """Return a better path, or errors that say why there is none."""
        ...


@dataclass(frozen=True, slots=True)
class KeepPath:
    """The refiner ``none``: the convex path is flown as it is."""

    name: ClassVar[str] = "none"
    summary: ClassVar[str] = "fly the convex path as it is"
    api: ClassVar[int] = 1

    def refine(self, path: PathIR, ctx: PassContext) -> Outcome[PathIR]:
        """Return ``path``."""
        del ctx
        return Outcome(path)


REFINER = KeepPath()


@dataclass(frozen=True, slots=True)
class RefinePath:
    """Run one refiner."""

    refiner: Refiner = REFINER
    name: ClassVar[str] = "refine-path"

    def run(self, ir: PathIR, ctx: PassContext) -> Outcome[PathIR]:
        """Refine the filmed legs, or explain."""
        try:
            outcome: Any = self.refiner.refine(ir, ctx)
        except Exception as fault:  # noqa: BLE001  a plugin may raise anything
            return self._failed(
                ir, "R001", f"refiner `{self.refiner.name}` failed", f"{type(fault).__name__}: {fault}"
            )
        if not isinstance(outcome, Outcome):
            return self._failed(
                ir, "R002", f"refiner `{self.refiner.name}` returned no path", f"got {type(outcome)}"
            )
        if outcome.value is None:
            return self._failed(ir, None, "", "", outcome.diagnostics)
        fault_found = broken(ir, outcome.value)
        if fault_found:
            return self._failed(
                ir, "R002", f"refiner `{self.refiner.name}` returned a broken path", fault_found
            )
        return outcome

    def _failed(
        self, ir: PathIR, code: str | None, message: str, note: str, own: tuple[Diagnostic, ...] = ()
    ) -> Outcome[PathIR]:
        mission = ir.keyframes.mission
        found = (
            own
            if code is None
            else (Diagnostic(code, message, notes=(note,), help="plan with --refiner none"),)
        )
        if not all(shot.refine_optional for shot in mission.shots):
            return Outcome(None, found)
        kept = Diagnostic(
            "R003",
            f"refiner `{self.refiner.name}` gave nothing usable; the convex path is kept",
            labels=tuple(mission.origins.key((*shot.path, "refine")) for shot in mission.shots[:1]),
            notes=(note,) if note else tuple(d.message for d in found),
        )
        return Outcome(ir, (kept,))


def broken(before: PathIR, after: object) -> str:
    """Say what makes a refined path unusable, or return an empty string."""
    if not isinstance(after, PathIR):
        return f"got {type(after).__name__}, not PathIR"
    shape = [(d.drone, [(leg.phase, leg.shot) for leg in d.legs]) for d in before.drones]
    if shape != [(d.drone, [(leg.phase, leg.shot) for leg in d.legs]) for d in after.drones]:
        return "its legs are not those of the convex path"
    try:
        after.check()
    except ValueError as fault:
        return str(fault)
    legs = [leg for d in after.drones for leg in d.legs]
    return next((f"{leg.phase} of {leg.shot} is not finite" for leg in legs if not _finite(leg)), "")


def _finite(leg: Leg) -> bool:
    return bool(np.isfinite(leg.pose).all())
