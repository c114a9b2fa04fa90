"""storyboard.png: the camera's pictures of every shot, with a map or a side view, on one page."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from shotc.emit.base import Artifact, Emission
from shotc.ir.trajectory import VerifiedIR

DPI = 120.0


@dataclass(frozen=True, slots=True)
class StoryboardEmitter:
    """Draws the storyboard.

    It needs matplotlib; without it, it raises ModuleNotFoundError.
    """

    name: ClassVar[str] = "storyboard"
    summary: ClassVar[str] = "storyboard.png: the camera's pictures at the keyframes, with maps"
    api: ClassVar[int] = 1

    def prepare(self) -> None:
        """Load matplotlib."""
        import shotc.emit.storyboard.page  # noqa: F401

    def emit(self, plan: VerifiedIR) -> Emission:
        """Return storyboard.png; the same plan gives the same bytes. Without cameras there is no file."""
        if plan.trajectory.fleets and not plan.trajectory.drones:
            return Emission(
                (), notes=("storyboard.png is left out: it shows what cameras see, and the mission has none",)
            )
        from shotc.emit.storyboard.page import draw_page

        return Emission((Artifact("storyboard.png", draw_page(plan, DPI)),))


EMITTER = StoryboardEmitter()
