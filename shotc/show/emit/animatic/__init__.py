"""animatic.gif: a show as its audience sees it, at the pace at which it is flown."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from shotc.emit.base import Artifact, Emission
from shotc.ir.trajectory import VerifiedIR


@dataclass(frozen=True, slots=True)
class AnimaticEmitter:
    """Draws the animatic; needs Pillow, and raises ModuleNotFoundError without it."""

    name: ClassVar[str] = "animatic"
    summary: ClassVar[str] = "animatic.gif: a show's lights as its audience sees them, from beginning to end"
    api: ClassVar[int] = 1

    def prepare(self) -> None:
        """Load Pillow and SciPy."""
        import shotc.show.emit.animatic.film  # noqa: F401

    def emit(self, plan: VerifiedIR) -> Emission:
        """Return animatic.gif, nothing where no fleet shows anything; the same plan gives the same bytes."""
        if not any(flight.shown for flight in plan.trajectory.fleets):
            return Emission(
                (), notes=("animatic.gif is left out: it shows fleets, and the mission has none",)
            )
        from shotc.show.emit.animatic.film import film

        return Emission((Artifact("animatic.gif", film(plan)),))


EMITTER = AnimaticEmitter()
