"""Aims for many times at once are those of one camera after the other."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pytest

from shotc.geom.camera import aim_at
from shotc.ir.keyframes import PlacedSubject
from shotc.planning.clock.aims import CameraTask, aims_at
from tests.support.front_passes import clean

MISSION = """\
shotc: 1
mission: aims
targets: {mark: {at: [3, -2, 5], radius: 0.4, height: 1.8}}
drones: {cam: {model: x500, home: [20, -20, 0]}}
shots:
  - {id: s, kind: static, drone: cam, target: mark, at: [0, -20, 5], look_at: mark, timing: {duration: 5}}
"""


class Transfer(NamedTuple):
    """Offsets of a target from the camera, and its place on screen."""

    offsets: np.ndarray
    place: tuple[float, float]


def ways() -> list[Transfer]:
    """Offsets from everywhere, with stretches at, straight above and straight below the target."""
    rng, found = np.random.default_rng(3), []
    for k in range(20):
        offsets = rng.normal(size=(40, 3)) * np.array([5.0, 5.0, (1.0, 5.0, 50.0)[k % 3]])
        offsets[[0, 10, 11]], offsets[[20, 21], :2] = 0.0, 0.0
        u, v = rng.uniform(-0.8, 0.8, 2)
        found.append(Transfer(offsets[k % 2 :], (u, v) if k % 4 else (0.0, 0.0)))
    return found


@pytest.mark.parametrize("way", ways())
def test_the_aims_of_a_way_are_those_of_its_places(way: Transfer) -> None:
    mission = clean(MISSION).mission
    drone, centre = mission.drone("cam"), np.array(mission.target("mark").centre)
    camera_task = CameraTask(mission, drone, (PlacedSubject("mark", way.place, None, None, ()),))
    found = aims_at(camera_task, np.arange(len(way.offsets)) * 0.1, centre - way.offsets)
    last = (0.0, 0.0)
    for aim, offset in zip(found, way.offsets, strict=True):
        x, y, z = offset
        last = aim_at((x, y, z), way.place, drone.hfov, drone.aspect, last[0]) or last
        turned = (aim[0] - last[0] + np.pi) % (2 * np.pi) - np.pi
        assert (turned, aim[1] - last[1]) == pytest.approx((0.0, 0.0), abs=1e-9)
