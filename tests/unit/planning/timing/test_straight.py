"""Motion along a straight line: it keeps every limit, takes the least time, and is what is flown."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from shotc.geom.bernstein import Piecewise
from shotc.ir.path import BODY_YAW, CAM_PITCH, CAM_YAW, CHANNELS, HFOV, X, Y, Z
from shotc.planning.timing import move
from shotc.planning.timing.limits import Ceiling
from shotc.planning.timing.move import time_move
from shotc.planning.timing.straight import LineLimits, rate_of_line

CEILING = Ceiling(8.0, 3.0, 2.0, 4.0, 10.0, 1.5, 3.0, 1.0, 4.0)
BOUNDS = st.builds(LineLimits, *[st.floats(0.5, 20.0)] * 3)


def line(**goes: float) -> Piecewise:
    """Return a path over s from 0 to 1 on which channels go evenly, in two pieces."""
    names = {"x": X, "y": Y, "z": Z, "yaw": BODY_YAW, "cam_yaw": CAM_YAW, "pitch": CAM_PITCH, "hfov": HFOV}
    end = np.zeros(len(CHANNELS))
    for name, value in goes.items():
        end[names[name]] = value
    share = np.linspace(0.0, 0.4, 6), np.linspace(0.4, 1.0, 6)
    return Piecewise(np.array([0.0, 0.4, 1.0]), np.stack([part[:, None] * end for part in share]))


@pytest.mark.slow
@given(BOUNDS, st.floats(1e-2, 1e3))
def test_the_motion_keeps_its_limits_and_ends_at_rest_where_it_is_to(
    bounds: LineLimits, distance: float
) -> None:
    profile = bounds.profile(2.0, 2.0 + distance)
    assert profile.duration == pytest.approx(bounds.rest_to_rest(distance), rel=1e-9)
    assert (profile.s[0], profile.s[-1], profile.sd[-1], profile.sdd[-1]) == (2.0, 2.0 + distance, 0.0, 0.0)
    curve = profile.curve()
    for order, most in zip((1, 2, 3), bounds, strict=True):
        assert np.abs(curve.derivative(order).ctrl).max() <= most * (1 + 1e-4)
    assert (curve.derivative().ctrl >= -1e-6 * bounds.speed).all()


@pytest.mark.parametrize("distance", [0.01, 1.0, 10.0, 200.0])
def test_no_other_peak_takes_less_time(distance: float) -> None:
    """What is flown in the time reckoned is the distance, by the trapezoid's own sums."""
    bounds = LineLimits(8.0, 3.0, 8.0)
    peaks = np.linspace(1e-3, bounds.speed, 4000)
    turns = np.array([bounds.least_time(float(v)) for v in peaks])
    flown = peaks * turns
    best = np.where(flown <= distance, 2 * turns + (distance - flown) / peaks, np.inf)
    assert bounds.rest_to_rest(distance) == pytest.approx(float(best.min()), rel=0.02)
    assert bounds.rest_to_rest(distance) <= best.min()


@pytest.mark.parametrize(
    "goes",
    [{"x": 60.0}, {"z": 12.0}, {"z": -12.0}, {"x": 3.0, "z": -4.0}, {"y": 20.0, "yaw": 2.5, "cam_yaw": 2.5}],
    ids=["far", "up", "down", "aslant", "turning"],
)
def test_a_straight_move_is_no_slower_than_the_programme_finds(goes, monkeypatch: pytest.MonkeyPatch) -> None:
    path = line(**goes)
    ours = time_move(path, (0.0, 1.0), CEILING)
    assert (ours.steps, ours.held) == (0, None)
    assert ours.cells <= 7
    monkeypatch.setattr(move, "rate_of_line", lambda *_: None)
    found = time_move(path, (0.0, 1.0), CEILING)
    assert found.steps > 0
    assert 0.95 * found.duration < ours.duration <= found.duration
    assert ours.topp_time == pytest.approx(found.topp_time, rel=5e-3)
    times = np.linspace(0.0, ours.duration, 200)
    flown = ours.curve(times)
    assert np.abs(np.cross(flown[:, :3], path(1.0)[:3])).max() < 1e-9
    assert np.abs(flown[-1] - path(1.0)).max() < 1e-12


def test_a_zoom_on_the_way_counts_where_its_rate_is_limited() -> None:
    path = line(x=10.0, hfov=0.5)
    free, held = (time_move(path, (0.0, 1.0), replace(CEILING, zoom_rate=rate)) for rate in (np.inf, 0.1))
    assert held.duration > free.duration
    assert np.abs(held.curve.derivative().ctrl[..., HFOV]).max() == pytest.approx(0.1, rel=1e-4)


def test_what_bends_or_changes_its_rate_is_no_line() -> None:
    path = line(x=10.0, y=4.0)
    assert rate_of_line(path, (0.0, 1.0)) == pytest.approx([10.0, 4.0, 0, 0, 0, 0, 0])
    ctrl = path.ctrl.copy()
    ctrl[1, 3, Y] += 1e-3
    bent = Piecewise(path.breaks, ctrl)
    assert rate_of_line(bent, (0.0, 1.0)) is None
    assert rate_of_line(bent, (0.0, 0.4)) is not None
    assert rate_of_line(Piecewise(path.breaks, 0.0 * path.ctrl), (0.0, 1.0)) is None
