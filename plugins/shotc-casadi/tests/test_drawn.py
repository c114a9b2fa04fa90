"""The tube of half-spaces about a path that the author draws."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from shotc_casadi.drawn import beside_legs

from shotc.plugin_api.refiner import DrawnPath

POINTS = np.array([[0.0, 0.0, 40.0], [80.0, 0.0, 40.0], [80.0, 15.0, 60.0], [80.0, 15.0, 90.0]])
S = np.array([0.0, 80.0, 105.0, 135.0])
WIDTHS = np.array([1.5, np.inf, 0.5])
NODES = np.linspace(0.0, 135.0, 28)


def on_lines(s: np.ndarray) -> np.ndarray:
    return np.column_stack([np.interp(s, S, POINTS[:, axis]) for axis in range(3)])


@pytest.mark.parametrize("aside", [0.0, 0.3])
def test_a_node_is_held_within_the_half_width_of_its_leg(aside: float) -> None:
    reference = on_lines(NODES) + aside * np.array([0.0, 0.6, 0.8])
    node, rows = beside_legs(DrawnPath(POINTS, S, WIDTHS), NODES, reference)
    slack = np.einsum("rd,rd->r", rows[:, :3], on_lines(NODES)[node]) - rows[:, 3]
    for k, s in enumerate(NODES):
        leg = min(int(np.searchsorted(S, s, side="right")) - 1, len(WIDTHS) - 1)
        assert (node == k).sum() == (0 if np.isinf(WIDTHS[leg]) else 4)
        assert slack[node == k] == pytest.approx(WIDTHS[leg])


def test_across_a_leg_nothing_beyond_the_tube_is_allowed() -> None:
    drawn = DrawnPath(POINTS, S, WIDTHS)
    node, rows = beside_legs(drawn, NODES, on_lines(NODES))
    rng = np.random.default_rng(4)
    for (low, high), width in zip(pairwise(S), WIDTHS, strict=True):
        for k in np.flatnonzero((low < NODES) & (high > NODES) & np.isfinite(width)):
            along = on_lines(np.array([high]))[0] - on_lines(np.array([low]))[0]
            off = np.cross(along, rng.normal(size=3))
            off *= width / np.linalg.norm(off)
            mine = rows[node == k]

            def slack(p: np.ndarray, mine: np.ndarray = mine) -> float:
                return float((mine[:, :3] @ p - mine[:, 3]).min())

            place = on_lines(NODES[[k]])[0]
            assert slack(place + 0.7 * off) > 0.0
            assert slack(place + 1.42 * off) < 0.0
