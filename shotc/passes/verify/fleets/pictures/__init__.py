"""Whether the lights of a fleet draw the pictures that its mission asks for.

The shapes are drawn here anew, from the mission alone, and by other formulas than planning's.
"""

from __future__ import annotations

from shotc.passes.verify.fleets.pictures.drawn import drawn

__all__ = ["drawn"]
