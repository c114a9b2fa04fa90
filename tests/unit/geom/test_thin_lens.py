"""Depth of field by the thin lens: figures of tables, limits that are where discs have their size, crops."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from shotc.geom.thin_lens import blur, limits


def one(value: float) -> np.ndarray:
    return np.array([value])


@pytest.mark.parametrize(
    ("focal_mm", "aperture", "focus_m", "near_m", "far_m"),
    [
        # H = f^2 / (N c) + f with c = 0.03 mm, near = H s / (H + s - f) as tables print it for full frame.
        (50, 2.8, 10, 7.502, 15.0),
        (85, 1.4, 12, 11.222, 12.894),
        (24, 8, 3, 1.339, np.inf),
    ],
)
def test_the_limits_are_those_of_tables(focal_mm, aperture, focus_m, near_m, far_m) -> None:
    near, far = limits(one(focal_mm / 1e3), aperture, one(focus_m), 0.03e-3)
    assert near[0] == pytest.approx(near_m, rel=2e-3)
    assert far[0] == pytest.approx(far_m, rel=5e-3)


@pytest.mark.slow
@given(st.floats(0.005, 0.2), st.floats(0.7, 32.0), st.floats(0.5, 200.0), st.floats(1e-6, 1e-4))
def test_at_the_limits_the_disc_has_the_size_of_the_circle(focal, aperture, focus, circle) -> None:
    near, far = limits(one(focal), aperture, one(focus), circle)
    assert near[0] <= focus
    assert blur(one(focal), aperture, one(focus), near)[0] == pytest.approx(circle, rel=1e-6)
    if np.isfinite(far[0]):
        assert blur(one(focal), aperture, one(focus), far)[0] == pytest.approx(circle, rel=1e-4)
    else:
        assert blur(one(focal), aperture, one(focus), one(1e9))[0] <= circle * (1 + 1e-6)


@pytest.mark.slow
@given(st.floats(1.5, 6.0), st.floats(1.0, 8.0), st.floats(2.0, 60.0))
def test_a_smaller_sensor_is_as_sharp_as_a_full_frame_stopped_down_by_the_crop(crop, aperture, focus) -> None:
    # The same picture: focal length and circle go with the width, the f-number of full frame against it.
    small = limits(one(0.05 / crop), aperture, one(focus), 0.03e-3 / crop)
    full = limits(one(0.05), aperture * crop, one(focus), 0.03e-3)
    # But for the focal length, which is no distance to the lens of the one or the other.
    for near_or_far in (0, 1):
        nearness = [1 / limit[near_or_far][0] for limit in (small, full)]
        assert nearness[0] == pytest.approx(nearness[1], abs=0.06 / focus)


def test_nothing_is_in_focus_nearer_than_the_focal_length_or_seen_behind_the_lens() -> None:
    focal, focus = np.array([0.05, 0.05]), np.array([0.04, 2.0])
    assert np.isnan(limits(focal, 2.8, focus, 3e-5)[0]).tolist() == [True, False]
    assert np.isnan(blur(focal, 2.8, focus, np.array([3.0, -1.0]))).all()
