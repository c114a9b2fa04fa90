"""Framings over ground that rises: the camera is above the ground that is below it, wherever z = 0 is."""

from __future__ import annotations

import numpy as np
import pytest

from shotc import api
from tests.support.few import few
from tests.support.surfaces import grid
from tests.support.terrain_missions import SIDE, STEP, under, write

pytestmark = pytest.mark.slow


def slope(level: float):
    """Ground that rises by 3 m in 10 to the East, from a level in the middle."""
    rise = level + 3.0 * (np.arange(SIDE) - (SIDE - 1) / 2)
    return grid(rise[:, None] * np.ones(SIDE), STEP)


@pytest.mark.long
@pytest.mark.parametrize("level", few([-80.0, 0.0, 60.0], [-80.0, 60.0]))
@pytest.mark.parametrize(
    "target",
    [
        "  hut: {at: [60, 40, {above: ground, height: 3}], radius: 2, height: 6}",
        "  hut: {radius: 0.5, height: 2, track: {speed: 3, "
        "points: [[60, 0, {above: ground, height: 1}], [60, 200, {above: ground, height: 1}]]}}",
    ],
)
def test_a_subject_on_a_slope_is_framed_from_above_the_ground(tmp_path, level, target):
    shot = (
        "kind: framing, subjects: [{target: hut, size: 0.2, view: {azimuth: 90 deg}}], timing: {duration: 8}"
    )
    shape = slope(level)
    path = write(tmp_path, shape, shot, target)
    found = api.compile_source(path.read_bytes(), path.name, path.parent, api.PlanOptions(refiner="none"))
    assert found.plan is not None, found.diagnostics
    track = found.plan.trajectory.drones[0]
    (film,) = [phase for phase in track.phases if phase.name == "shot"]
    places = track.curve(np.arange(film.start, film.end, 0.05))[:, :3]
    height = places[:, 2] - under(shape, places)
    assert height.min() >= 2.6
    assert height.max() <= 3.2
