"""The front half of the compiler on a text, without plugin discovery: load, resolve, place-keyframes."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path

from shotc.diag.model import Diagnostic
from shotc.ir.keyframes import KeyframeIR
from shotc.ir.mission import MissionIR
from shotc.ir.passes import PassContext
from shotc.kinds.base import Kind
from shotc.passes.place_keyframes import PlaceKeyframes
from shotc.passes.resolve import Resolve
from shotc.spec.load import LoadedMission, load

MODULES = (
    "keyframes", "static", "orbit", "spiral", "elevator", "dolly", "dolly_zoom", "crane", "top_down", "chase",
    "lead", "lateral", "flyby", "follow_path", "framing", "display",
)  # fmt: skip
KINDS: dict[str, Kind] = {k.name: k for k in (import_module(f"shotc.kinds.{m}").KIND for m in MODULES)}
EMITTERS = ("csv", "mavlink", "dji", "litchi", "storyboard", "rerun", "skyc", "contact-sheet", "animatic")


def loaded(text: str | bytes, folder: Path | None = None) -> tuple[LoadedMission | None, list[Diagnostic]]:
    """Load a mission text."""
    data = text if isinstance(text, bytes) else text.encode()
    found = load(data, "mission.yaml", folder, {name: kind.model for name, kind in KINDS.items()})
    return found.mission, list(found.diagnostics)


def resolved(text: str | bytes, folder: Path | None = None) -> tuple[MissionIR | None, list[Diagnostic]]:
    """Load and resolve a mission text."""
    mission, found = loaded(text, folder)
    if mission is None:
        return None, found
    outcome = Resolve(KINDS, EMITTERS).run(mission, PassContext())
    return outcome.value, [*found, *outcome.diagnostics]


def placed(text: str | bytes, folder: Path | None = None) -> tuple[KeyframeIR | None, list[Diagnostic]]:
    """Load, resolve and place a mission text."""
    mission, found = resolved(text, folder)
    if mission is None:
        return None, found
    outcome = PlaceKeyframes().run(mission, PassContext())
    return outcome.value, [*found, *outcome.diagnostics]


def clean(text: str, folder: Path | None = None) -> KeyframeIR:
    """Return the placed mission; fail where anything at all is said about it."""
    value, found = placed(text, folder)
    assert not found, found
    assert value is not None
    return value
