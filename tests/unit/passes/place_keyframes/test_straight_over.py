"""Places on screen that no angles reach, from straight above a target."""

from __future__ import annotations

import pytest

from tests.support.front_passes import placed


@pytest.mark.parametrize(
    ("composition", "drift", "code"),
    [("left-third", "", "G010"), ("upper-third", "", "G011"), ("left-third", ", drift: [1, 0, 0]", "G010")],
)
def test_a_place_beside_the_middle_line_is_refused_straight_above_with_its_reason(
    composition: str, drift: str, code: str
) -> None:
    """It said that infinitely many metres are cropped."""
    text = f"""\
shotc: 1
mission: above
targets: {{statue: {{at: [0, 0, 3], radius: 1.5, height: 6}}}}
drones: {{cam: {{model: pro, home: [50, -40, 0]}}}}
shots:
  - {{id: top, kind: top-down, drone: cam, target: statue, altitude: 16, composition: {composition}{drift},
     timing: {{duration: 6}}}}
"""
    (told,) = placed(text.encode())[1]
    assert (told.code, told.message) == (
        code,
        f"no angles of the camera put target `statue` on `{composition}`",
    )
    assert told.notes[0].startswith("it is straight below the camera")
    assert told.help.startswith("set `composition: center`")
    assert placed(text.replace(composition, "center").encode())[1] == []
