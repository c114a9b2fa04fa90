"""Pieces cut out of a curve."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.geom.bernstein import Piecewise
from shotc.geom.pieces import cut

CURVE = Piecewise(
    np.array([1.0, 1.5, 4.0, 6.0]), np.cumsum(np.random.default_rng(2).normal(size=(3, 4, 2)), axis=1)
)


@pytest.mark.parametrize(
    ("start", "end", "count"),
    [(1.0, 6.0, 3), (1.2, 5.0, 3), (1.2, 1.4, 1), (1.5, 4.0, 1), (2.0, 5.0, 2), (4.5, 5.5, 1), (0.0, 9.0, 3)],
)
def test_what_is_cut_out_of_a_curve_is_the_curve_there(start: float, end: float, count: int) -> None:
    found = cut(CURVE, start, end)
    assert len(found.ctrl) == count
    assert (found.low[0], found.high[-1]) == (max(start, 1.0), min(end, 6.0))
    assert (found.low[1:] == found.high[:-1]).all()
    for low, high, ctrl in zip(found.low, found.high, found.ctrl, strict=True):
        t = np.linspace(low, high, 7)[1:-1]
        assert Piecewise(np.array([low, high]), ctrl[None])(t) == pytest.approx(CURVE(t))


@pytest.mark.parametrize(("start", "end"), [(2.0, 2.0), (3.0, 2.0), (-3.0, 1.0), (6.0, 8.0), (7.0, 8.0)])
def test_nothing_is_cut_out_where_there_is_no_curve(start: float, end: float) -> None:
    assert not len(cut(CURVE, start, end).ctrl)
