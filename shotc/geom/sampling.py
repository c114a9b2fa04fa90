"""Runs of a sampled signal, and sampled directions."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from shotc.geom.bernstein import Array


def worst_of_runs(values: NDArray[np.float64], above: float, notice: float) -> list[int]:
    """Return the index of the maximum of each run of values above ``above``, for runs that exceed ``notice``.

    values : shape (M,); above, notice : in their unit
    """
    above_it = np.flatnonzero(values > above)
    runs = np.split(above_it, np.flatnonzero(np.diff(above_it) > 1) + 1) if above_it.size else []
    worst = [int(run[np.argmax(values[run])]) for run in runs]
    return [i for i in worst if values[i] > notice]


def directions(turns: int, rises: Sequence[float]) -> Array:
    """Return unit vectors, shape (N, 3): ``turns`` azimuths at each elevation in ``rises``, rad, then up."""
    turn = 2.0 * np.pi * np.arange(turns) / turns
    flat = np.column_stack([np.cos(turn), np.sin(turn), np.zeros(turns)])
    up = np.array([0.0, 0.0, 1.0])
    return np.concatenate([*(np.cos(rise) * flat + np.sin(rise) * up for rise in rises), up[None]])
