"""Which pieces of a fleet's splines stand on pads."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.geom.on_pads import on_pads

PADS = np.array([[0.0, 0.0, 0.0], [5.0, 0.0, 0.0]])
STEPS = [0.0] * 5 + [1.0, 2.0, 2.0, 2.0, 2.0, 1.0] + [0.0] * 6
"""Heights of the control points: it rises after two pieces, stands on one aloft, and has landed for three."""


def flown(x: float, off: float = 0.0, end: float = 0.0) -> np.ndarray:
    """Return the control points of a drone that rises over x, a little off its pad, and lands elsewhere."""
    coef = np.array([[x + off, 0.0, z] for z in STEPS])
    coef[8:, 0] += end
    return coef


def test_a_drone_stands_on_its_pad_until_it_rises_and_from_when_it_has_landed() -> None:
    still = on_pads(flown(5.0)[None], PADS)
    assert still.shape == (1, len(STEPS) - 3)
    assert np.flatnonzero(still[0]).tolist() == [0, 1, 11, 12, 13]


@pytest.mark.parametrize(
    ("coef", "pieces"),
    [
        (flown(5.0, off=0.0005), [0, 1, 11, 12, 13]),  # within a millimetre
        (flown(5.0, off=0.002), []),
        (flown(5.0, off=0.5), []),
        (flown(2.0), []),  # between pads
        (flown(5.0, end=-5.0), [0, 1, 11, 12, 13]),  # to another pad
        (flown(5.0, end=-4.0), [0, 1]),  # and beside any
        (flown(1.0, end=-1.0), [11, 12, 13]),
    ],
)
def test_only_who_begins_or_ends_on_a_pad_stands_on_it(coef: np.ndarray, pieces: list[int]) -> None:
    both = np.stack([coef, flown(0.0)])
    still = on_pads(both, PADS)
    assert np.flatnonzero(still[0]).tolist() == pieces
    assert np.flatnonzero(still[1]).tolist() == [0, 1, 11, 12, 13]


def test_one_that_never_flies_stands_all_the_while() -> None:
    assert on_pads(np.tile(PADS[1], (1, 9, 1)), PADS).all()
    assert not on_pads(np.tile([2.0, 0.0, 0.0], (1, 9, 1)), PADS).any()
