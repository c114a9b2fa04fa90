"""plan.json: the whole plan, from which `shotc` can verify it again and make all other outputs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from shotc.emit.base import Artifact, Emission
from shotc.ir.trajectory import VerifiedIR
from shotc.planfile.write import plan_bytes

FILE = "plan.json"


@dataclass(frozen=True, slots=True)
class PlanJson:
    """Writes plan.json (see ``shotc.planfile``, which also reads it)."""

    name: ClassVar[str] = "plan"
    summary: ClassVar[str] = "plan.json, the whole plan with its certificate"
    api: ClassVar[int] = 1

    def emit(self, plan: VerifiedIR) -> Emission:
        """Return the plan file."""
        return Emission((Artifact(FILE, plan_bytes(plan)),))


EMITTER = PlanJson()
