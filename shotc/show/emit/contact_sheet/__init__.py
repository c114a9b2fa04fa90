"""contact-sheet.png: every picture of a show as its audience sees it, with a map, on one page."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from shotc.emit.base import Artifact, Emission
from shotc.ir.trajectory import VerifiedIR

DPI = 120.0


@dataclass(frozen=True, slots=True)
class ContactSheetEmitter:
    """Draws the contact sheet.

    It needs matplotlib; without it, it raises ModuleNotFoundError.
    """

    name: ClassVar[str] = "contact-sheet"
    summary: ClassVar[str] = "contact-sheet.png: a show's pictures as its audience sees them, with a map"
    api: ClassVar[int] = 1

    def prepare(self) -> None:
        """Load matplotlib."""
        import shotc.show.emit.contact_sheet.page  # noqa: F401

    def emit(self, plan: VerifiedIR) -> Emission:
        """Return contact-sheet.png; the same plan gives the same bytes. Without fleets there is no file."""
        if not plan.trajectory.fleets:
            return Emission(
                (), notes=("contact-sheet.png is left out: it shows fleets, and the mission has none",)
            )
        from shotc.show.emit.contact_sheet.page import draw_page

        return Emission((Artifact("contact-sheet.png", draw_page(plan, DPI)),))


EMITTER = ContactSheetEmitter()
