"""Film grammar: what irritates an audience, found in a mission with valid names and places.

Every finding is a warning, because a filmmaker may break any of these rules; `allow` names the rules that are
broken on purpose.
"""

from __future__ import annotations

from collections.abc import Mapping

from shotc.diag.model import Diagnostic
from shotc.ir.mission import MissionIR, Shot
from shotc.ir.origin import KeyPath
from shotc.passes.resolve.checks.grammar.cuts import check_cuts
from shotc.passes.resolve.checks.grammar.single_shot import check_single_shot
from shotc.spec.mission import MissionSpec


def allowed(spec: MissionSpec) -> Mapping[KeyPath, frozenset[str]]:
    """Return the rules that may be broken: in each shot by its key path, and under () in all shots."""
    codes: dict[KeyPath, frozenset[str]] = {(): frozenset(spec.rules.allow)}
    codes |= {("shots", i): frozenset(shot.allow) for i, shot in enumerate(spec.shots) if shot.allow}
    return codes


def check_grammar(mission: MissionIR, allow: Mapping[KeyPath, frozenset[str]]) -> list[Diagnostic]:
    """Return the warnings about the looks of a mission's shots: first those of cuts, then of each shot."""
    everywhere, none = allow.get((), frozenset()), frozenset[str]()

    def judged(slug: str, shot: Shot) -> bool:
        return slug not in everywhere and slug not in allow.get(shot.path, none)

    diagnostics: list[Diagnostic] = []
    if len(mission.shots) > 1:
        diagnostics += check_cuts(mission, judged)
    lasting = [shot for shot in mission.shots if shot.timing.duration is not None or _timed(shot)]
    if lasting:
        for shot in lasting:
            diagnostics += check_single_shot(mission, shot, judged)
    return diagnostics


def _timed(shot: Shot) -> bool:
    return any(keyframe.time is not None for keyframe in shot.keyframes)
