"""Stretches of a sampled signal."""

import numpy as np
from numpy.typing import NDArray


def worst_of_runs(values: NDArray[np.float64], above: float, notice: float) -> list[int]:
    """Return where the largest value of each run above ``above`` is, of runs that rise above ``notice``.

    values : shape (M,); above, notice : in their unit
    """
    found = np.flatnonzero(values > above)
    runs = np.split(found, np.flatnonzero(np.diff(found) > 1) + 1) if found.size else []
    worst = [int(run[np.argmax(values[run])]) for run in runs]
    return [i for i in worst if values[i] > notice]
