"""The picture and the recording of a comparison: which frame is shown, what is shaded, where entities are."""

from __future__ import annotations

import io
from math import inf, nan

import numpy as np
import pytest
from PIL import Image

from shotc.comparison.score import flown_shots, score, total
from shotc.diag.model import Diagnostic
from shotc.emit.rerun_log.side_by_side import place_of, within
from shotc.emit.screen import error_top
from shotc.emit.storyboard.side_by_side import draw_comparison, runs, stretches, worst_frame
from shotc.ir.comparison import ComparedShot, Comparison, Condition, MotionMeasures, Trace
from tests.support.film_plans import orbit_plan

TIMES = np.array([20.0, 21.0, 22.0, 23.0])


def shot(*pairs) -> ComparedShot:
    """Return a shot of 4 frames from 20 s on, of targets with some errors and margins."""
    share = (TIMES - 20) / 10
    traces = tuple(
        Trace("t", TIMES, share, np.array(e), np.array(m), np.ones(4), np.zeros(4)) for e, m in pairs
    )
    motion = MotionMeasures(0.0, 0.0, 0.0, 0.0, 10.0)
    return ComparedShot("s", "cam", 20.0, 30.0, traces, motion, score(traces, motion))


def test_the_worst_frame_is_the_one_that_crops_most():
    assert worst_frame(shot(([0.0, 0.9, 0.0, 0.0], [1.0, 1.0, -0.2, -0.1]))) == 22.0
    assert worst_frame(shot(([0.0] * 4, [1.0, -0.1, 1.0, 1.0]), ([0.0] * 4, [1.0, 1.0, 1.0, -2.0]))) == 23.0


def test_where_nothing_is_cropped_it_is_the_one_that_is_farthest_off():
    assert worst_frame(shot(([0.1, nan, 0.3, 0.2], [1.0] * 4))) == 22.0
    assert worst_frame(shot(([0.1, 0.4, inf, 0.2], [1.0] * 4))) == 22.0


def test_where_nothing_is_wanted_it_is_half_way():
    assert worst_frame(shot(([nan] * 4, [1.0] * 4))) == 25.0
    assert worst_frame(shot()) == 25.0


def test_what_is_shaded_reaches_half_way_to_the_next_frame():
    share = np.linspace(0.0, 1.0, 6)
    flags = np.array([True, False, True, True, False, False])
    assert list(stretches(share, flags)) == [pytest.approx((0.0, 0.1)), pytest.approx((0.3, 0.7))]
    assert list(stretches(share, np.ones(6, dtype=bool))) == [(0.0, 1.0)]
    assert list(stretches(share, np.zeros(6, dtype=bool))) == []
    assert list(stretches(share[:1], np.ones(1, dtype=bool))) == [(0.0, 0.0)]


def test_while_another_target_is_filmed_nothing_is_shaded_or_drawn():
    share = np.array([0.0, 0.1, 0.2, 0.7, 0.8, 0.9])
    assert list(stretches(share, np.ones(6, dtype=bool))) == [(0.0, 0.2), (0.7, 0.9)]
    assert list(runs(share, np.array([False, True, True, True, False, True]))) == [(1, 3), (3, 4), (5, 6)]


@pytest.mark.parametrize(
    ("errors", "top"),
    [([], 0.05), ([0.02], 0.05), ([0.2, nan], 0.2), ([0.21], 0.5), ([inf, 0.3], 0.5), ([40.0], 2.0)],
)
def test_an_axis_ends_at_a_round_number_above_all_errors(errors, top):
    assert error_top([np.array(errors)]) == top


def test_entities_of_a_refiner_lie_below_it():
    assert within("refiners/ours", "world/cameras/cam") == "world/refiners/ours/cameras/cam"
    assert within("refiners/ours", "plots/cam/jerk") == "plots/refiners/ours/cam/jerk"
    assert place_of("a b/c") == r"refiners/a\ b\/c"


@pytest.mark.slow
def test_a_page_has_a_column_for_each_refiner_also_where_it_has_no_plan():
    plan = orbit_plan()
    shots = flown_shots(plan)
    flown = Condition("none", "shotc", plan, shots=shots, score=total(plan, shots))
    failing = Condition("odd", "odd-maker", None, (Diagnostic("R001", "refiner `odd` failed"),))
    mission = plan.trajectory.keyframes.mission
    widths = []
    for conditions in ([flown, failing], [flown, failing, flown]):
        page = draw_comparison(Comparison(mission, tuple(conditions)), 40.0)
        assert page == draw_comparison(Comparison(mission, tuple(conditions)), 40.0)
        widths.append(Image.open(io.BytesIO(page)).size[0])
    assert widths[1] - widths[0] == pytest.approx(40 * 3.47, abs=1)
