"""Random villages, and houses about framing missions: drawn anew alike, all seen from the keyframes."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.ir.coverage import coverage
from tests.experiments.papers.houses import HOUSES, with_houses
from tests.experiments.papers.missions import missions
from tests.experiments.villages import flight
from tests.support.village_films import some_film

pytestmark = pytest.mark.slow


@pytest.mark.long
def test_a_flight_through_a_village_is_planned_and_proved():
    assert not flight(7).fault


def test_films_are_drawn_anew_alike_on_a_free_square():
    one, again = (some_film(np.random.default_rng([4, 1])) for _ in range(2))
    assert one.text == again.text
    assert one.text.count("look_at: monument") >= 2
    corners = one.triangles.reshape(-1, 3)
    assert np.hypot(corners[:, 0], corners[:, 1]).min() > 5.0


def test_houses_hide_no_target_from_a_keyframe():
    placed = with_houses(missions(1)[0], 1)
    (mesh,) = placed.mission.meshes
    assert len(mesh.closed) > HOUSES
    for k in placed.shots[0].keyframes:
        seen = coverage(placed.mission, (), str(k.target), np.array([k.at]), np.zeros(1))
        assert not any(share.any() for name, share in seen.by if name.startswith("scene"))
