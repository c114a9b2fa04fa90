"""The viewpoint paper's experiments: what its missions show, and that the walks are what they say."""

from __future__ import annotations

import numpy as np
import pytest

from tests.experiments.papers import viewpoint
from tests.experiments.papers.report import text
from tests.experiments.papers.viewpoint import (
    CAMERA,
    LASTS,
    PACE,
    START,
    crossing,
    ideal_look,
    look,
    planned,
    portrait,
    roaming,
)

pytestmark = pytest.mark.slow


@pytest.mark.long
def test_four_setpoints_are_had_as_asked() -> None:
    table = viewpoint.setpoints()
    assert len(table.rows) == 7
    for what, mean, most, size, view, whole in table.rows:
        on_the_way = what == "to the next"
        assert max(float(mean), float(most)) < 2.0
        assert float(size) < (0.02 if on_the_way else 0.005)
        assert float(view) < (2.0 if on_the_way else 0.5)
        assert whole == "100.0 %"


@pytest.mark.fuzz
def test_who_stops_in_the_line_of_sight_is_looked_past() -> None:
    walks = crossing(2)
    guide, ours = (planned(portrait(walks), refiner, walks)[0] for refiner in ("none", "ours"))
    before, after = (look(plan, "s", "face") for plan in (guide, ours))
    assert before.hidden.mean() > 0.2
    assert after.hidden.mean() < 0.25 * before.hidden.mean()
    assert after.whole.all()
    assert after.error.max() < 5.0
    assert after.value.min() > 1.0
    assert ideal_look(guide, "s", "face")[0] == before.hidden.mean()


@pytest.mark.long
def test_who_walks_at_the_camera_is_kept_clear_of() -> None:
    walks = roaming(1)
    guide = planned(portrait(walks), "none", walks)[0]
    _, value, near = ideal_look(guide, "s", "face")
    assert value < 1.0
    assert near < 0.3
    found = look(guide, "s", "face")
    assert found.value.min() > 1.0
    assert found.whole.all()


@pytest.mark.fuzz
def test_three_subjects_stand_on_one_line_of_the_picture() -> None:
    table = viewpoint.several()
    assert "middle" in text(table)
    for row in table.rows:
        assert float(row[1]) < 10.0
        assert float(row[3]) < 30.0
        assert row[5:] == ("100.0 %", "0.0 %")


def test_walkers_walk_at_their_pace_and_come_where_they_should() -> None:
    for seed in viewpoint.SEEDS:
        for walks in (crossing(seed), roaming(seed)):
            for walk in walks.values():
                speed = np.linalg.norm(np.diff(walk[:, 1:], axis=0), axis=1) / np.diff(walk[:, 0])
                assert speed.max() < PACE + 1e-6
                assert walk[-1, 0] >= START + LASTS
        assert any((np.abs(walk[:, 1]) < 0.31).any() for walk in crossing(seed).values())
        near = [np.linalg.norm(walk[:, 1:] - CAMERA, axis=1).min() for walk in roaming(seed).values()]
        assert min(near) < 0.2
