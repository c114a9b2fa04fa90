"""Labels and phrases that the diagnostics of several passes share."""

from __future__ import annotations

from typing import TYPE_CHECKING

from shotc.diag.model import Label
from shotc.ir.mission import Keyframe, MissionIR
from shotc.ir.origin import KeyPath

if TYPE_CHECKING:  # phases load numpy, and the lint rules of `check` label keyframes without it
    from shotc.ir.phases import Phase


def timing_value(mission: MissionIR, path: KeyPath, key: str) -> Label:
    """Return a label on a key of a shot's timing."""
    return mission.origins.value((*path, "timing", key))


def framing_label(mission: MissionIR, keyframe: Keyframe) -> Label:
    """Return a label on a keyframe; if the shot itself is one keyframe, on its angles."""
    written = mission.origins.values
    own = [(*keyframe.path, key) for key in ("look_at", "heading") if len(keyframe.path) == 2]
    return mission.origins.value(next((path for path in own if path in written), keyframe.path))


def phases_in_words(phases: tuple[Phase, ...]) -> str:
    """Return a list of phases with their durations, in order."""
    named = [f"{'shot `' + p.shot + '`' if p.shot else p.name} {p.end - p.start:.1f} s" for p in phases[:6]]
    rest = sum(p.end - p.start for p in phases[6:])
    return ", ".join(named) + (f" and {len(phases) - 6} more of {rest:.1f} s" if rest > 0 else "")
