"""The page of plots: its axes show values that can be, and what it leaves out is told."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
from matplotlib.figure import Figure

from shotc.simulation.plots import _Panel, _spread, _title


def rehearsed(values):
    runs = [SimpleNamespace(number=i, value=value) for i, value in enumerate(values)]
    return SimpleNamespace(runs=runs, worst=runs[0], mission=SimpleNamespace(name="walk"))


def drawn(values, limit=None, **more):
    axes = Figure().add_subplot()
    _spread(axes, rehearsed(values), _Panel("Share", "%", lambda run: run.value, limit, **more))
    return axes


def test_no_axis_of_shares_goes_beyond_all_of_them():
    axes = drawn([100.0, 100.0, 99.8], 99.0, most=100.0)
    assert axes.get_xlim()[1] == 100.0
    assert axes.get_xlim()[0] < 99.0
    assert sum(bar.get_height() for bar in axes.patches) == 3


def test_other_axes_have_room_on_both_sides():
    axes = drawn([0.1, 0.2, 0.3])
    assert axes.get_xlim()[0] < 0.1
    assert axes.get_xlim()[1] > 0.3


def test_runs_without_a_number_are_counted_in_the_title():
    axes = drawn([0.2, np.inf, 0.3])
    assert axes.get_title(loc="left") == "Share (1 of 3 runs infinite)"
    assert sum(bar.get_height() for bar in axes.patches) == 2


def test_one_run_has_no_worst_one():
    assert _title(rehearsed([1.0])) == "walk: 1 run"
    assert _title(rehearsed([1.0, 2.0])) == "walk: 2 runs, worst is run 0"
