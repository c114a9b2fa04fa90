"""Directions all round, in which places about a place are tried."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from shotc.geom.bernstein import Array


def directions(turns: int, rises: Sequence[float]) -> Array:
    """Return unit vectors, ``turns`` to all sides at each rise, rad over level, then up; shape (N, 3)."""
    turn = 2.0 * np.pi * np.arange(turns) / turns
    flat = np.column_stack([np.cos(turn), np.sin(turn), np.zeros(turns)])
    up = np.array([0.0, 0.0, 1.0])
    return np.concatenate([*(np.cos(rise) * flat + np.sin(rise) * up for rise in rises), up[None]])
