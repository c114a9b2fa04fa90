"""The times of a show: how long its pictures stand, where it begins and ends, and its animations' periods."""

from __future__ import annotations

import pytest

from shotc.ir.fleet import FrameTimes
from shotc.ir.phases import Phase
from shotc.ir.show import Model
from shotc.ir.trajectory import Claim
from shotc.passes.verify.fleets.standing import standing
from tests.support.records import replace
from tests.support.show_plans import display, mission, show
from tests.support.verdicts import verdict_on

WALK = Model(("a.ply", "b.ply", "c.ply", "d.ply"), 2.0, (0.0, 0.0, 30.0), 10.0, 0.0)


def claims(*shown: tuple[int, int, float, float], asked: object = None) -> dict[str, Claim]:
    """The claims of a show with frames at times: (picture, index, start, end)."""
    ir = show() if asked is None else show(mission(displays=(asked,)))
    frames = tuple(FrameTimes("globe", *frame) for frame in shown)
    ir = replace(ir, fleets=(replace(ir.fleets[0], shown=frames),))
    return {c.constraint: c for c in verdict_on(ir).certificate}


@pytest.mark.parametrize(("end", "excess"), [(20.0, 0.0), (19.0, 0.0), (24.0, 4.0)])
def test_a_picture_stands_no_longer_than_it_is_held(end: float, excess: float) -> None:
    found = claims((0, 0, 16.0, end), (1, 0, 26.0, 28.0))["excess of hold"]
    assert found.worst == pytest.approx(excess)
    assert found.holds is (excess == 0.0)


def test_a_picture_before_one_with_a_fixed_time_stands_as_long_as_it_takes() -> None:
    first, second = display().pictures
    asked = display()._replace(pictures=(first, second._replace(at=26.0)))
    assert claims((0, 0, 16.0, 24.0), (1, 0, 26.0, 28.0), asked=asked)["excess of hold"].worst == 0.0


@pytest.mark.parametrize(
    ("shown", "off"),
    [
        (((0, 0, 16.0, 20.0), (1, 0, 26.0, 28.0)), 0.0),
        (((0, 0, 17.0, 20.0), (1, 0, 26.0, 28.0)), 1.0),  # a second before the first picture
        (((0, 0, 16.0, 20.0), (1, 0, 26.0, 27.5)), 0.5),  # half a second after the last one
    ],
)
def test_a_display_is_its_pictures(shown: tuple[tuple[int, int, float, float], ...], off: float) -> None:
    found = claims(*shown)["display without a picture"]
    assert found.worst == pytest.approx(off)
    assert found.holds is (off == 0.0)


def test_a_frame_that_a_picture_does_not_have_is_none_of_the_mission() -> None:
    found = claims((0, 3, 16.0, 20.0), (1, 0, 26.0, 28.0))
    assert (found["pictures left out"].worst, found["pictures out of order"].worst) == (1, 1)


@pytest.mark.parametrize(
    ("times", "error"),
    [
        ((0.0, 4.0, 6.0, 10.0), 0.0),  # it begins and ends at rest
        ((0.0, 2.0, 4.0, 6.0), 0.0),
        ((0.0, 4.0, 9.0, 13.0), 3.0),  # slower between
        ((0.0, 1.0, 3.0, 5.0), 1.0),  # faster at first
        ((0.0, 5.0, 7.0, 11.0), 1.0),
    ],
)
def test_frames_of_an_animation_follow_each_other_by_its_period(
    times: tuple[float, ...], error: float
) -> None:
    picture = display().pictures[0]._replace(source=WALK)
    asked = display()._replace(pictures=(picture,))
    frames = [FrameTimes("globe", 0, k, t, t) for k, t in enumerate(times)]
    frames[-1] = replace(frames[-1], end=times[-1] + 4.0)
    phase = Phase("shot", "globe", times[0], frames[-1].end)
    found = {c.constraint: c for c in standing("swarm", asked, phase, frames)}
    assert found["error of period"].worst == pytest.approx(error)
    assert found["excess of hold"].worst == 0.0
    assert found["display without a picture"].worst == 0.0


def test_of_an_animation_all_frames_are_shown() -> None:
    picture = display().pictures[0]._replace(source=WALK)
    asked = display()._replace(pictures=(picture, *display().pictures[1:]))
    few = ((0, 0, 16.0, 16.0), (0, 1, 18.0, 18.0), (0, 3, 20.0, 20.0), (1, 0, 26.0, 28.0))
    assert claims(*few, asked=asked)["pictures left out"].worst == 1
