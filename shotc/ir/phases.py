"""What a drone, or a fleet, does when."""

from __future__ import annotations

from dataclasses import dataclass

from shotc.ir.path import PhaseName


@dataclass(frozen=True, slots=True)
class Phase:
    """A stretch of mission time, seconds; ``shot`` is set where phase is "shot"."""

    name: PhaseName
    shot: str | None
    start: float
    end: float
