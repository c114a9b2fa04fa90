"""Shots of moving targets against the meaning of their kinds: the camera is in the place that they name."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from shotc.geom.bernstein import Array
from tests.e2e.conftest import MISSIONS, Plan, Planned
from tests.support.written_missions import KINDS, Course, Written, course, number, place, read

pytestmark = pytest.mark.slow

NOTICE = 0.5
"""Metres off its place that a shot may be without a word."""
BETWEEN = 0.03
"""What a distance may rise by between the tenths of a second at which it is looked at."""
TOLD = re.compile(r"^shot `(.*)` leaves its place by ([\d.]+) m at t = ([\d.]+) s$")


def filmed(path: Path) -> list[Written]:
    return [shot for shot in read(path)["shots"] if shot["kind"] in KINDS]


MOVING = [
    pytest.param(path, id=path.stem, marks=pytest.mark.xdist_group(path.stem))
    for path in MISSIONS
    if filmed(path)
]
each_moving = pytest.mark.parametrize("path", MOVING)


def from_its_place(planned: Planned, shot: Written) -> tuple[Array, Array]:
    """Times of a shot's rows and how far its camera is from the place beside the target, metres."""
    rows = planned.motion.where(shot=shot["id"])
    t, timing = rows["t_s"], shot["timing"]
    start = number(timing["start"]) if "start" in timing else t[0]  # after another: from its first row
    share = (t - start) / number(timing["duration"])
    assert share.min() > -1e-9
    assert share.max() < 1 + 1e-9
    ideal = place(shot, planned.courses[shot["target"]], t, share)
    return t, np.linalg.norm(rows.numbers("x_m", "y_m", "z_m") - ideal, axis=1)


def test_there_are_such_missions() -> None:
    kinds = {shot["kind"] for path in MISSIONS for shot in filmed(path)}
    assert kinds == set(KINDS)


@each_moving
def test_the_camera_is_in_its_place_or_it_is_told(plan: Plan, path: Path) -> None:
    planned = plan(path)
    told: dict[str, list[tuple[float, float]]] = {}
    for diagnostic in planned.diagnostics:
        if found := TOLD.match(diagnostic.message):
            assert diagnostic.code == "M008"
            told.setdefault(found[1], []).append((float(found[3]), float(found[2])))
    for shot in filmed(path):
        t, away = from_its_place(planned, shot)
        stretches = told.get(shot["id"], [])
        most = max([NOTICE, *(distance for _, distance in stretches)])
        assert away.max() <= most + BETWEEN, shot["id"]
        for time, distance in stretches:
            # The time is told to a tenth of a second, the distance to a centimetre; the last frame of a
            # shot has its row in the phase that begins then, a fiftieth of a second further on.
            around = away[np.abs(t - time) < 0.051]
            assert around.min() - 0.02 <= distance <= around.max() + 0.02, shot["id"]


@each_moving
def test_targets_are_on_time(plan: Plan, path: Path) -> None:
    """What the plan believes of a target's place is what the mission says of it."""
    planned = plan(path)
    t = planned.motion["t_s"][::50]
    for target in planned.mission.targets:
        believed = np.array([target.at(float(u)) for u in t])
        assert believed == pytest.approx(planned.courses[target.name].at(t), abs=1e-9)


def test_a_course_by_hand() -> None:
    for track in (
        {"points": [[0, 0, 1], [30, 0, 1], [30, 40, 1]], "speed": "10 m/s"},
        {"points": [[0, 0, 1], [30, 0, 1], [30, 40, 1]], "times": [0, "3 s", 7]},
    ):
        found = course(track)
        wanted = [[0, 0, 1], [15, 0, 1], [30, 0, 1], [30, 20, 1], [30, 40, 1], [30, 40, 1]]
        assert found.at(np.array([0, 1.5, 3, 5, 7, 99])).tolist() == wanted
        assert found.ahead(np.array([1.0, 3.0, 6.0])) == pytest.approx(
            np.array([[1, 0], [0.5**0.5, 0.5**0.5], [0, 1]])
        )


NORTH = Course(np.array([0.0, 10.0]), np.array([[5.0, 0.0, 1.0], [5.0, 50.0, 1.0]]))


@pytest.mark.parametrize(
    ("shot", "share", "at"),
    [
        ({"kind": "chase", "distance": 6, "altitude": 4}, 0.5, [5, 19, 4]),
        ({"kind": "lead", "distance": 6, "altitude": 4}, 0.5, [5, 31, 4]),
        ({"kind": "lateral", "side": "left", "distance": 6, "altitude": 4}, 0.5, [-1, 25, 4]),
        ({"kind": "lateral", "side": "right", "distance": 6, "altitude": 4}, 0.5, [11, 25, 4]),
        ({"kind": "flyby", "behind": 8, "ahead": 12, "offset": -3, "altitude": 4}, 0.0, [8, 17, 4]),
        ({"kind": "flyby", "behind": 8, "ahead": 12, "offset": -3, "altitude": 4}, 0.25, [8, 22, 4]),
        ({"kind": "flyby", "behind": 8, "ahead": 12, "altitude": 4}, 1.0, [5, 37, 4]),
    ],
)
def test_places_by_hand(shot: Written, share: float, at: list[float]) -> None:
    """A target on its way North at 5 m/s, five seconds after it began."""
    assert place(shot, NORTH, np.array([5.0]), np.array([share]))[0] == pytest.approx(at)
