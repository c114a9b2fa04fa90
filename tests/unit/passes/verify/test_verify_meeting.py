"""What keeps two drones that film apart: which shots meet, and when the later one may start."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.passes.verify.claims import JudgedFlight
from shotc.passes.verify.meeting import _notes, _remedies, filming, put_off
from shotc.passes.verify.pair import separation
from tests.support.records import replace
from tests.support.sight_plans import at, film, mission, through, unfilmed
from tests.support.tampered_plans import PLAN

# The eye rests 2 s, flies for 6 s, and films from 10 to 20 s; the bird crosses its way and films earlier.
EYE_WAY = through(
    [0.0, 2.0, 8.0, 20.0, 24.0], [at(-9, 0, 10), at(-9, 0, 10), at(9, 0, 10), at(9, 0, 10), at(9, 8, 10)]
)
BIRD_WAY = through([0.0, 3.0, 7.0, 24.0], [at(0, -9, 12), at(0, -9, 12), at(0, 9, 12), at(0, 9, 12)])
EYE, BIRD = film("eye", EYE_WAY, (10.0, 20.0)), film("bird", BIRD_WAY, (8.0, 16.0))
RATE = 10.0


def test_the_shot_of_a_time_is_the_one_that_is_filmed_then_or_the_next_or_the_last() -> None:
    for time in (0.0, 12.0, 23.0):
        phase = filming(EYE, time)
        assert phase is not None
        assert phase.shot == "eyes"
    later = replace(EYE, phases=(*EYE.phases, replace(EYE.phases[1], shot="more", start=21.0, end=23.0)))
    assert [filming(later, time).shot for time in (3.0, 20.0, 20.5, 99.0)] == ["eyes", "eyes", "more", "more"]  # type: ignore[union-attr]
    assert filming(unfilmed("bird", BIRD_WAY), 3.0) is None


def starts(text: str) -> float:
    return float(text.split("start: ")[1].split(" s", maxsplit=1)[0])


def test_a_shot_is_put_off_until_the_other_has_ended_and_it_has_come_there() -> None:
    of = mission(rate=RATE)
    text = put_off(of, BIRD.phases[1], (EYE, EYE.phases[1]))
    assert text.startswith("start shot `eyes` after `birds`")
    # It moves from 2 to 8 s, but for the first and last moment of that.
    assert 16.0 + 5.4 <= starts(text) <= 16.0 + 6.0
    # A shot that begins later than that keeps its own start.
    ended = replace(BIRD.phases[1], end=9.0)
    assert 10.0 + 5.4 <= starts(put_off(of, ended, (EYE, EYE.phases[1]))) <= 10.0 + 6.0
    # What was flown before the shot before is over.
    again = replace(EYE, phases=(*EYE.phases[:2], replace(EYE.phases[1], shot="more", start=24.0, end=30.0)))
    assert (
        16.0 + 8.0 + 3.4 <= starts(put_off(of, BIRD.phases[1], (again, again.phases[2]))) <= 16.0 + 8.0 + 4.0
    )


@pytest.mark.parametrize(("start", "moved", "at"), [(8.0, "eyes", 16.0 + 6.0), (12.0, "birds", 20.0 + 4.0)])
def test_the_shot_that_begins_later_is_the_one_to_move(start: float, moved: str, at: float) -> None:
    of = mission(rate=RATE, separation=5.0)
    bird = film("bird", BIRD_WAY, (start, 16.0))
    (claim,) = separation([JudgedFlight(of, of.drone(t.drone), t) for t in (EYE, bird)], [])
    assert claim.worst == pytest.approx(2.0, abs=1e-3)
    found = list(_remedies(of, claim, (EYE, bird), [EYE.phases[1], bird.phases[1]]))
    assert f"start shot `{moved}` after" in found[0]
    assert at - 0.6 <= starts(found[0]) <= at  # when the other has ended, and it has come there
    assert found[1].startswith("bring them 3.0")
    assert found[2].startswith("lower `rules.separation` to ")
    assert list(_remedies(of, claim, (EYE, bird), [None, bird.phases[1]])) == found[1:]
    wide = replace(of, drones=tuple(replace(d, radius=1.2) for d in of.drones))
    assert list(_remedies(wide, claim, (EYE, bird), [None, None])) == found[1:2]


def test_it_is_told_how_long_they_are_too_near_and_where_they_are_then() -> None:
    of = mission(rate=RATE, separation=5.0)
    (claim,) = separation([JudgedFlight(of, of.drone(t.drone), t) for t in (EYE, BIRD)], [])
    ir = replace(PLAN, keyframes=replace(PLAN.keyframes, mission=of))
    spell, worst = _notes(ir, claim, (EYE, BIRD))
    times = np.arange(0.0, 24.0 + 1e-9, 1 / RATE)
    near = times[np.linalg.norm((EYE_WAY(times) - BIRD_WAY(times))[:, :3], axis=1) < 5.0]
    assert spell == f"they are nearer than that from t = {near[0]:.2f} s to {near[-1]:.2f} s"
    assert worst.startswith("worst at t = 5.0")
    assert ", 0.00, 10.00) m and bird is at (0.00, " in worst
    assert worst.endswith(", 12.00) m")
