"""What becomes of a mission that was drawn: planned or refused, and what every shot shows."""

from __future__ import annotations

import time
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

from shotc import api
from shotc.diag.model import Diagnostic, Severity
from shotc.diag.registry import severity_of
from shotc.ir.trajectory import VerifiedIR
from tests.support.generated.missions import Mission

WHOLE = 0.995
"""Share of a shot's frames that show the whole subject, wherever geometry lets every frame do."""

REFINER_FAILED = ("R010", "R011")
CRASHED = "X001"
_IN_FRAME = " in frame"


class Shown(NamedTuple):
    """One shot of a plan.

    share : of its frames that show the whole of the subject that is cropped most
    refined : how its refiner ended, empty where none worked on it
    """

    id: str
    kind: str
    share: float
    refined: str
    why_cropped: str

    @property
    def falls_short(self) -> bool:
        """Whether geometry allows more: every place that the shot asks for shows the whole subject."""
        return self.share < WHOLE and not self.why_cropped


class Verdict(NamedTuple):
    """One mission.

    errors : (code, message) of what refused it; warnings : codes; seconds : of processor time
    """

    seed: int
    theme: str
    drones: int
    errors: tuple[tuple[str, str], ...]
    warnings: tuple[str, ...]
    shots: tuple[Shown, ...]
    seconds: float

    @property
    def planned(self) -> bool:
        return not self.errors


def judge(mission: Mission, refiner: str | None = None) -> Verdict:
    """Plan a mission and tell what became of it."""
    began = time.process_time()
    with TemporaryDirectory() as folder:
        write(mission, Path(folder))
        try:
            done = api.compile_source(
                mission.text.encode(), "mission.yaml", Path(folder), api.PlanOptions(refiner=refiner)
            )
        except Exception as fault:  # noqa: BLE001 - a crash is a verdict, too
            errors: tuple[tuple[str, str], ...] = ((CRASHED, repr(fault)[:300]),)
            return _verdict(mission, errors, (), (), began)
    errors = _told(done.diagnostics, Severity.ERROR)
    warnings = tuple(code for code, _ in _told(done.diagnostics, Severity.WARNING))
    if done.plan is None:
        return _verdict(mission, errors or ((CRASHED, "no plan and no error"),), warnings, (), began)
    return _verdict(mission, errors, warnings, tuple(_shown(mission, done.plan)), began)


def write(mission: Mission, folder: Path) -> Path:
    """Write a mission with its files into a folder, and return where it stands."""
    for name, data in mission.files.items():
        (folder / name).write_bytes(data)
    path = folder / "mission.yaml"
    path.write_text(mission.text)
    return path


def _verdict(
    mission: Mission,
    errors: tuple[tuple[str, str], ...],
    warnings: tuple[str, ...],
    shots: tuple[Shown, ...],
    began: float,
) -> Verdict:
    seconds = time.process_time() - began
    return Verdict(mission.seed, mission.theme, len(mission.cameras), errors, warnings, shots, seconds)


def _told(diagnostics: tuple[Diagnostic, ...], severity: Severity) -> tuple[tuple[str, str], ...]:
    return tuple((d.code, d.message) for d in diagnostics if severity_of(d) is severity)


def _shown(mission: Mission, plan: VerifiedIR) -> list[Shown]:
    stats = dict(plan.trajectory.stats)
    found = []
    for take in mission.takes:
        shares = [c.worst for c in plan.certificate if c.shot == take.id and c.constraint.endswith(_IN_FRAME)]
        if shares:
            refined = str(stats.get(f"{take.id}.refine_status", ""))
            found.append(Shown(take.id, take.wanted["kind"], min(shares), refined, take.why_cropped))
    return found
