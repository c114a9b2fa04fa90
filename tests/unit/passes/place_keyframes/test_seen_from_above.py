"""Targets that a view from above crops, and targets that a mission crops on purpose."""

from __future__ import annotations

import re

import pytest

from tests.support.front_passes import placed

HEAD = """\
shotc: 1
mission: above
targets: {roof: {at: [0, 0, 4], size: [16, 12, 8], heading: 80 deg}}
drones: {cam: {model: pro, home: [0, -40, 0]}}
shots:
"""


@pytest.mark.parametrize(
    ("altitude", "drift"),
    [("16", ""), ("16", "drift: [1, 0, 0], "), ("{above: origin, height: 20.5}", "drift: [0.4, -0.6, 0], ")],
)
def test_a_view_from_above_that_crops_is_told_the_altitude_that_shows_all(altitude: str, drift: str) -> None:
    """It was told to move to a distance from the centre or, with a drift, to make the target smaller."""
    shot = f"  - {{id: top, kind: top-down, drone: cam, target: roof, {drift}altitude: ALT,"
    shot += " timing: {duration: 8}}"
    text = HEAD + shot
    (told,) = placed(text.replace("ALT", altitude).encode())[1]
    assert told.code == "G012"
    assert told.labels[0].span.column == shot.index("ALT") + 1
    remedy = re.search(r"write `altitude: (.+?)`", told.help)
    assert remedy is not None
    assert placed(text.replace("ALT", remedy[1]).encode())[1] == []
    number = float(re.findall(r"[\d.]+", remedy[1])[0])
    lower = remedy[1].replace(f"{number}", f"{number - 0.2:.1f}")
    assert [d.code for d in placed(text.replace("ALT", lower).encode())[1]] == ["G012"]


def test_a_target_that_does_not_fit_can_be_cropped_on_purpose() -> None:
    """A push-in that ends tight was refused, and the help did not say how to allow it."""
    shot = "  - {id: in, kind: dolly, drone: cam, target: roof, azimuth: 180 deg, distance: [40, 11],"
    shot += " altitude: 9}"
    (told,) = placed((HEAD + shot).encode())[1]
    assert told.code == "G010"
    assert told.help.endswith(", or set `composition: keep` to allow cropping")
    kept = shot.replace("altitude: 9", "altitude: 9, composition: keep")
    assert [d.code for d in placed((HEAD + kept).encode())[1]] == ["G012"]
