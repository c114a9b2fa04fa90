"""Groups that cannot be kept apart: who meets whom, where it is written, and a start that does."""

from __future__ import annotations

import re

import pytest

from shotc.diag.model import Diagnostic
from tests.support.compiled import compiled_text
from tests.support.show_texts import marked

pytestmark = pytest.mark.slow

SWAPPED = """\
shotc: 1
mission: swapped
fleets:
  swarm:
    count: 12
    layout: {grid: {spacing: 3, origin: [-6, -20, 0]}}
    separation: {horizontal: 1.5 m, vertical: 2 m}
    groups: {east: 7-12}
shots:
  - id: one
    kind: display
    fleet: swarm
    timing: {start: 40 s}
    frames:
      - {cube: {center: [-14, 0, 30], size: 7}, hold: 4}
      - {cube: {center: [14, 0, 30], size: 7}, transition: {path: straight}, hold: 4}
  - id: two
    kind: display
    fleet: swarm
    group: east
    timing: {start: 40 s}
    frames:
      - {cube: {center: [14, 0, 30], size: 7}, hold: 4}
      - {cube: {center: [-14, 0, 30], size: 7}, transition: {path: straight}, hold: 4}
"""


def met(text: str) -> list[Diagnostic]:
    return [d for d in compiled_text(text).diagnostics if d.code == "D087"]


@pytest.mark.long
def test_two_groups_that_meet_are_named_with_a_start_that_does() -> None:
    (d,) = met(SWAPPED)
    assert d.message.startswith("fleet `swarm` and group `swarm/east` come within ")
    assert (marked(d, SWAPPED), marked(d, SWAPPED, 1)) == ("swarm", "east")
    found = re.match(
        r"show all pictures of `(swarm(?:/east)?)` (\d+) s later, the first at (\d+\.\d+) s, with which they "
        r"are apart, or bring",
        d.help,
    )
    assert found is not None, d.help
    first, second = SWAPPED.split("  - id: two")
    later = f"start: {found[3]} s"
    corrected = (
        first.replace("start: 40 s", later) + "  - id: two" + second
        if found[1] == "swarm"
        else first + "  - id: two" + second.replace("start: 40 s", later)
    )
    done = compiled_text(corrected)
    assert done.plan is not None, done.diagnostics
    assert float(found[3]) == 40.0 + float(found[2])


def test_fleets_that_wait_for_each_other_are_shown_one_after_the_other() -> None:
    tied = SWAPPED.replace("timing: {start: 40 s}", "timing: {start: 40 s}", 1) + (
        "  - {id: three, kind: display, fleet: swarm, timing: {after: two}, "
        "frames: [{sphere: {center: [0, 40, 30], radius: 5}, hold: 2}]}\n"
    )
    (d,) = met(tied)
    assert d.help.startswith("show `swarm")
    assert "once `swarm" in d.help
