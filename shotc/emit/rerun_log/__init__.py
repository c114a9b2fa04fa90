"""mission.rrd: the plan as a rerun recording, with a layout that needs no explanation."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from shotc.emit.base import Artifact, Emission
from shotc.ir.trajectory import VerifiedIR


@dataclass(frozen=True, slots=True)
class RerunEmitter:
    """Writes the recording.

    It needs rerun-sdk; without it, it raises ModuleNotFoundError.
    """

    name: ClassVar[str] = "rerun"
    summary: ClassVar[str] = "mission.rrd: the world, the camera's view and the plots, for the rerun viewer"
    api: ClassVar[int] = 1

    def prepare(self) -> None:
        """Load rerun."""
        import shotc.emit.rerun_log.recording  # noqa: F401

    def emit(self, plan: VerifiedIR) -> Emission:
        """Return mission.rrd; the same plan gives the same content, but not the same bytes."""
        from shotc.emit.rerun_log.recording import record

        return Emission((Artifact("mission.rrd", record(plan)),))


EMITTER = RerunEmitter()
