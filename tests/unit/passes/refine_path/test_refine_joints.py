"""How smooth a path is: what rounding explains is taken off, and nothing more."""

import numpy as np
import pytest

from shotc.geom.bernstein import Piecewise, quintic_hermite
from shotc.passes.refine_path.form import largest_jump

STEP = 0.01
"""Metres of path of a piece: short enough for rounding to show in second derivatives."""


def bend(jump: float, order: int) -> Piecewise:
    """A circle of 60 m whose second half begins with a jump of a derivative."""
    s = STEP * np.arange(81)
    turn = s / 60.0
    place = 60.0 * np.column_stack([np.cos(turn), np.sin(turn)])
    rate = np.column_stack([-np.sin(turn), np.cos(turn)])
    curve = quintic_hermite(s, place, rate, -place / 3600.0)
    ctrl = curve.ctrl.copy()
    if order < 2:
        ctrl[40:, :, 0] += jump if order == 0 else jump * (s[40:-1, None] + STEP * np.arange(6) / 5 - s[40])
    else:
        ctrl[40, :3, 0] += jump * np.array([0.0, 0.0, STEP**2 / 20])
    return Piecewise(s, ctrl)


@pytest.mark.parametrize("order", range(3))
def test_rounding_is_no_jump(order: int) -> None:
    assert largest_jump(bend(0.0, order), order).size == 0.0


@pytest.mark.parametrize(("order", "jump"), [(0, 1e-10), (1, 1e-8), (2, 5e-6)])
def test_what_is_more_than_rounding_is_told(order: int, jump: float) -> None:
    scale = 60.0 if order == 0 else 1.0
    found = largest_jump(bend(jump, order), order)
    assert found.size == pytest.approx(jump / scale, rel=0.25)
    assert found.at == pytest.approx(0.4)
