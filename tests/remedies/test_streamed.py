"""Helps about what a stream does not send: each is written into the mission, and nothing is left out."""

from __future__ import annotations

import pytest

from shotc.diag.model import Diagnostic
from shotc.stream.session import filmed_instead, unplaced, zoomed
from tests.support.compiled import compiled_text

pytestmark = pytest.mark.slow

PLACE = "world: {origin: {lat: 47.3769, lon: 8.5417, alt: 408}}\n"
MISSION = f"""\
shotc: 1
mission: stream
{PLACE}targets: {{mast: {{at: [0, 0, 6], radius: 1, height: 12}}}}
drones: {{cam: {{model: x500, home: [0, -40, 0]}}}}
shots:
  - id: look
    kind: keyframes
    drone: cam
    target: mast
    keyframes:
      - {{at: [-4, -35, 12], look_at: mast}}
      - {{at: [4, -35, 12], look_at: mast}}
"""
LAST = "{at: [4, -35, 12], look_at: mast}"
CASES = [
    ("A001", "`world.origin: {lat: .., lon: .., alt: ..}`", MISSION.replace(PLACE, "")),
    ("A031", "give the shot one `hfov`", MISSION.replace(LAST, LAST[:-1] + ", hfov: 60 deg}")),
    ("A033", "take the photos out of the film",
        MISSION.replace("    keyframes:", "    photos: {every: 2 s}\n    keyframes:")),
]  # fmt: skip


def unsent(text: str) -> list[Diagnostic]:
    plan = compiled_text(text, "none").plan
    assert plan is not None
    mission, (track,) = plan.trajectory.keyframes.mission, plan.trajectory.drones
    return [*unplaced(mission, plan), *zoomed(mission, track), *filmed_instead(mission, track)]


@pytest.mark.long
@pytest.mark.parametrize(("code", "said", "text"), CASES, ids=[code for code, *_ in CASES])
def test_what_a_help_proposes_is_sent(code: str, said: str, text: str) -> None:
    (fault,) = unsent(text)
    assert fault.code == code
    assert said in (fault.help or "")
    assert unsent(MISSION) == []
