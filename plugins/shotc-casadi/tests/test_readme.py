"""The weights in the README are those of the problem."""

from __future__ import annotations

from pathlib import Path

import pytest
from shotc_casadi import lens, problem
from shotc_casadi.clock import weights
from shotc_casadi.clock.problem import SEVERAL_STAGES, USUAL_STAGES
from shotc_casadi.refiner import ANG, FRAMING_ONLY, LOOK_AT, OURS, OURS_4PT
from shotc_casadi.timeout import TIMEOUT_S

README = (Path(__file__).parents[1] / "README.md").read_text(encoding="utf-8")
WEIGHTS = {
    "framing": problem.FRAMING_WEIGHT,
    "visibility": problem.VISIBILITY_WEIGHT,
    "aiming": problem.AIMING_WEIGHT,
    "position": problem.POSITION_ERROR_WEIGHT,
    "jerk": problem.JERK_SHARE,
    "angular jerk": problem.ANGULAR_JERK_SHARE,
    "time": 1.0,
    "pace": problem.PACE_WEIGHT,
    "lag": problem.LAG_WEIGHT,
    "lens": problem.POSITION_ERROR_WEIGHT,
    "zoom": lens.ACCELERATION_WEIGHT,
    "pins": problem.PIN_WEIGHT,
    "rests": problem.REST_WEIGHT,
    "due": problem.TIME_WEIGHT,
    "place": weights.PLACE_WEIGHT,
    "given place": weights.PLACED_WEIGHT,
    "leash": weights.LEASH_SHARE,
    "place jerk": weights.JERK_WEIGHT,
    "turn acceleration": weights.TURN_WEIGHTS[2],
    "turn jerk": weights.TURN_WEIGHTS[4],
    "steep": weights.PITCH_WEIGHT,
    "yielding place": weights.YIELDING_WEIGHT,
    "hidden": weights.HIDDEN_WEIGHT,
    "together": weights.SUBJECTS_WEIGHT,
    "loose place": weights.LOOSE_WEIGHT,
    "field": weights.FIELD_WEIGHT,
    "touch": weights.TOUCH_WEIGHT,
}


@pytest.mark.parametrize("term", list(WEIGHTS))
def test_a_weight_is_the_one_that_is_used(term):
    (line,) = (row for row in README.splitlines() if row.startswith(f"| {term} | "))
    assert float(line.split("|")[2].split()[0]) == WEIGHTS[term]


def test_every_condition_is_there():
    for made in (OURS, OURS_4PT, FRAMING_ONLY, LOOK_AT, ANG):
        assert f"| `{made.name}` |" in README
    assert TIMEOUT_S == 30.0  # "half a minute"
    assert f"in a range of {weights.RANGE_M} m" in README


def test_yaw_and_pitch_weigh_the_same_and_rates_nothing():
    assert weights.TURN_WEIGHTS[:2] == (0.0, 0.0)
    assert weights.TURN_WEIGHTS[2:5:2] == weights.TURN_WEIGHTS[3:6:2]
    assert f"{USUAL_STAGES} stages a film, {SEVERAL_STAGES} with several subjects" in README
