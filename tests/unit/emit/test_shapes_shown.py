"""Boxes in pictures: recordings carry them along as they turn, storyboards draw the sides that are seen."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest

from shotc.emit.rerun_log.world import carried
from shotc.emit.storyboard.bodies import sides_seen
from shotc.geom.shapes import BoxShape, CylinderShape
from shotc.geom.solids import Prism
from shotc.geom.track import Track
from shotc.ir.target import Target

BEND = Track((0.0, 10.0, 20.0), ((5.0, 2.0, 1.0), (45.0, 2.0, 1.0), (45.0, 42.0, 3.0)))
CAR = Target("car", BEND.points[0], BoxShape(4.0, 2.0, 1.5, (1.0, 0.0)), ("targets", "car"), BEND)


def turned(points: np.ndarray, quaternion: np.ndarray) -> np.ndarray:
    """Return points turned by a quaternion x, y, z, w."""
    axis, w = quaternion[:3], quaternion[3]
    across = 2 * np.cross(axis, points)
    return np.asarray(points + w * across + np.cross(axis, across))


@pytest.mark.parametrize("time", [0.0, 4.0, 10.0, 13.0, 30.0])
def test_a_body_is_carried_to_where_it_is(time: float) -> None:
    start, there = CAR.solid, CAR.solid_at(time)
    assert isinstance(start, Prism)
    assert isinstance(there, Prism)
    translation, quaternion = carried(CAR, np.array([time]))
    assert quaternion is not None
    corners = np.array([[*point, start.bottom] for point in start.points])
    found = turned(corners, quaternion[0]) + translation[0]
    assert found == pytest.approx(np.array([[*point, there.bottom] for point in there.points]), abs=1e-9)


def test_what_is_round_is_only_moved() -> None:
    man = CAR._replace(shape=CylinderShape(0.4, 1.8))
    assert carried(man, np.array([10.0])).quaternion is None
    assert carried(man, np.array([10.0])).translation[0] == pytest.approx([40.0, 0.0, 0.0])


@pytest.mark.parametrize(
    ("offset", "outwards"),
    [
        ((10.0, 0.0, 0.0), [pi]),
        ((10.0, 10.0, 0.0), [-pi / 2, pi]),
        ((0.0, -10.0, 3.0), [pi / 2]),
        ((0.0, 0.0, -5.0), []),
    ],
)
def test_only_the_sides_that_face_the_eye_are_drawn(
    offset: tuple[float, float, float], outwards: list[float]
) -> None:
    seen = sides_seen(BoxShape(4.0, 2.0, 1.5, (1.0, 0.0)), offset)
    assert sorted(seen.outwards % (2 * pi)) == pytest.approx(sorted(out % (2 * pi) for out in outwards))
    assert len(seen.edges) == len(outwards)
    assert len(seen.top) == 4
