"""<mission>-report.html: the verified properties of a flight on one page, for the authority."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from shotc.emit.base import Artifact, Emission
from shotc.emit.report.page import Simulated, page
from shotc.filenames import file_name
from shotc.ir.trajectory import VerifiedIR


@dataclass(frozen=True, slots=True)
class ReportEmitter:
    """Writes one self-contained file; the same plan gives the same bytes."""

    name: ClassVar[str] = "report"
    summary: ClassVar[str] = "<mission>-report.html: every limit with its proved worst value, for authorities"
    api: ClassVar[int] = 1

    def emit(self, plan: VerifiedIR) -> Emission:
        """Return the report."""
        return Emission((report(plan),))


def report(plan: VerifiedIR, simulated: Simulated | None = None) -> Artifact:
    """Return the report.

    simulated : results of `shotc simulate`
    """
    name = file_name(plan.trajectory.keyframes.mission.name)
    return Artifact(f"{name}-report.html", page(plan, simulated).encode())


EMITTER = ReportEmitter()
