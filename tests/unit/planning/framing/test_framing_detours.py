"""A framing of several that avoids what hides one of them says so where it cannot be had, with what helps."""

from __future__ import annotations

import pytest

from tests.support.front_passes import placed
from tests.support.remedies.tried import failed

pytestmark = pytest.mark.slow

SHAFT = """\
shotc: 1
mission: shaft
world:
  zones:
    n: {keep: out, box: {center: [0, 1.5, 5], size: [3.4, 0.4, 10]}}
    s: {keep: out, box: {center: [0, -1.5, 5], size: [3.4, 0.4, 10]}}
    e: {keep: out, box: {center: [1.5, 0, 5], size: [0.4, 3.4, 10]}}
    w: {keep: out, box: {center: [-1.5, 0, 5], size: [0.4, 3.4, 10]}}
targets:
  statue: {at: [0, 0, 0.9], radius: 0.4, height: 1.8}
  guide: {at: [8, 0, 0.9], radius: 0.4, height: 1.8}
drones:
  cam1: {model: x500, home: [0, -30, 0]}
shots:
  - {id: both, kind: framing, drone: cam1, timing: {duration: 4},
     subjects: [{target: statue, size: 0.4}, {target: guide, size: 0.4}]}
"""
"""Both at their size are seen from the side alone, and the statue from above alone."""


@pytest.mark.long
def test_a_framing_that_avoids_walls_names_them_and_each_help_does() -> None:
    (fault,) = placed(SHAFT.encode())[1]
    assert fault.code == "M033"
    assert fault.notes[-1] == (
        "where all appear as asked, `s` hides more than half of `statue` in 100 % of the shot"
    )
    found, wrong = failed(SHAFT, lambda text: placed(text.encode())[1])
    assert [remedy.text.split("`")[1] for remedy in found] == ["size: 0.118", "allow: [hidden-subject]"]
    assert wrong == []
