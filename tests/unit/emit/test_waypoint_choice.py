"""Points chosen on flights drawn by chance: within their bounds under every model, judged from the files."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

from shotc.emit.dji import EMITTER as DJI
from shotc.emit.litchi import EMITTER as LITCHI
from shotc.emit.waypoints.choose import MEAN_HALF_FRAMES, WORST_HALF_FRAMES
from shotc.emit.waypoints.stations import stations_of
from shotc.emit.waypoints.track import track_of
from tests.support.film_plans import orbit_mission
from tests.support.mavlink_flights import Move, flight, plan
from tests.support.records import replace

FREE = replace(orbit_mission(), zones=())
HIGH = (0.0, -60.0, 20.0, np.pi / 2, -0.2)
LOW = (0.0, -60.0, 0.0, np.pi / 2, 0.0)


@st.composite
def flights(draw):
    """Up, a way, two filmed moves that turn by at most 35 degrees on 15 m or more, down."""
    pose, moves = HIGH, [("takeoff", None, 8.0, HIGH)]
    for phase, shot in (("transit", None), ("shot", "half"), ("shot", "half")):
        bearing, way = draw(st.floats(0.0, 2 * np.pi)), draw(st.floats(15.0, 30.0))
        x, y = pose[0] + way * np.cos(bearing), pose[1] + way * np.sin(bearing)
        yaw, pitch = pose[3] + draw(st.floats(-0.6, 0.6)), draw(st.floats(-0.6, 0.0))
        pose = (x, y, draw(st.floats(15.0, 30.0)), yaw, pitch)
        moves.append((phase, shot, way / 3, pose))
    moves.append(("land", None, 10.0, (pose[0], pose[1], 0.0, pose[3], pose[4])))
    return moves


@pytest.mark.long
@settings(
    max_examples=5,
    deadline=None,
    derandomize=True,
    phases=[Phase.explicit, Phase.generate],
    suppress_health_check=[HealthCheck.too_slow],
)
@given(flights(), st.sampled_from([DJI, LITCHI]))
def test_few_points_keep_shots_within_their_bounds(moves: list[Move], emitter):
    emission = emitter.emit(plan(flight(moves, pad=LOW), mission=FREE, autopilot="dji-fly"))
    note = emission.notes[0]
    worst = float(note.split("adds at most ")[1].split()[0])
    mean = float(note.split(") and ")[1].split()[0])
    # Where points can be no nearer to each other, what is beyond the bounds is told, and nothing else.
    assert [d.code for d in emission.diagnostics] == (
        ["E117"] if worst > WORST_HALF_FRAMES or mean > MEAN_HALF_FRAMES else []
    )
    assert worst <= 3.0 * WORST_HALF_FRAMES
    assert float(note.split("position within ")[1].split()[0]) <= 1.05
    assert int(note.split(": ")[1].split()[0]) < 60


def stations(moves: list[Move]):
    track = track_of(FREE, flight(moves, pad=LOW))
    steps = np.linalg.norm(np.diff(track.poses.position, axis=0), axis=1)
    return stations_of(track, np.append(0.0, np.cumsum(steps)))


def test_a_shot_that_stands_is_a_stay_between_start_and_stop():
    east = (20.0, -60.0, 20.0, np.pi / 2, -0.2)
    moves: list[Move] = [
        ("takeoff", None, 8.0, HIGH),
        ("transit", None, 8.0, east),
        ("shot", "half", 7.0, east),
        ("return", None, 8.0, HIGH),
        ("land", None, 8.0, LOW),
    ]
    found, gaps = stations(moves)
    assert [[a.kind for a in s.actions] for s in found] == [[], ["start", "stay", "stop"], []]
    assert found[1].actions[1].seconds == pytest.approx(7.0)
    assert all(s.stops for s in found)
    assert [gap.shot for gap in gaps] == [None, None]


def test_a_stay_that_is_not_filmed_is_cut_short():
    east, north = (20.0, -60.0, 20.0, np.pi / 2, -0.2), (20.0, -40.0, 20.0, np.pi / 2, -0.2)
    moves: list[Move] = [
        ("takeoff", None, 8.0, HIGH),
        ("transit", None, 8.0, east),
        ("transit", None, 30.0, east),
        ("shot", "half", 8.0, north),
        ("land", None, 8.0, (20.0, -40.0, 0.0, np.pi / 2, 0.0)),
    ]
    found, _ = stations(moves)
    assert [(a.kind, a.seconds) for a in found[1].actions] == [("stay", 1.0), ("start", 0.0)]
