"""animatic.gif: a show as its audience sees it, in real time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from shotc.emit.base import Artifact, Emission
from shotc.ir.trajectory import VerifiedIR


@dataclass(frozen=True, slots=True)
class AnimaticEmitter:
    """Draws the animatic.

    It needs Pillow; without it, it raises ModuleNotFoundError.
    """

    name: ClassVar[str] = "animatic"
    summary: ClassVar[str] = "animatic.gif: a show's lights as its audience sees them, from beginning to end"
    api: ClassVar[int] = 1

    def prepare(self) -> None:
        """Load Pillow and SciPy."""
        import shotc.show.emit.animatic.film  # noqa: F401

    def emit(self, plan: VerifiedIR) -> Emission:
        """Return animatic.gif; the same plan gives the same bytes. Without pictures there is no file."""
        if not any(flight.shown for flight in plan.trajectory.fleets):
            return Emission(
                (), notes=("animatic.gif is left out: it shows fleets, and the mission has none",)
            )
        from shotc.show.emit.animatic.film import film

        return Emission((Artifact("animatic.gif", film(plan)),))


EMITTER = AnimaticEmitter()
