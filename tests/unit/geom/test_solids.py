"""Segments and solids in the plane: who crosses whom, at the borders."""

from __future__ import annotations

import pytest

from shotc.geom.solids import segments_cross

LONG = ((0.0, 0.0), (4.0, 0.0))


@pytest.mark.parametrize(
    ("other", "crosses"),
    [
        (((2.0, -1.0), (2.0, 1.0)), True),
        (((2.0, 1.0), (2.0, 0.0)), True),  # ends on it
        (((2.0, 0.0), (2.0, 1.0)), True),  # starts on it
        (((4.0, 0.0), (5.0, 1.0)), True),  # shares an end
        (((3.0, 0.0), (6.0, 0.0)), True),  # along it, and on
        (((5.0, 0.0), (6.0, 0.0)), False),  # along it, beyond
        (((2.0, 1.0), (2.0, 0.1)), False),
        (((5.0, -1.0), (3.9, 1.0)), False),  # boxes overlap
        (((5.0, -1.0), (3.0, 0.5)), True),
    ],
)
def test_two_segments_cross_or_touch_whichever_comes_first(other, crosses: bool) -> None:
    (a, b), (c, d) = LONG, other
    for first, second in (((a, b), (c, d)), ((b, a), (d, c))):
        assert segments_cross(*first, *second) is crosses
        assert segments_cross(*second, *first) is crosses
