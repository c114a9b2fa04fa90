"""Where the nodes of a shot stand."""

from __future__ import annotations

import numpy as np
import pytest
from shotc_casadi.stages import MOST_STAGES, USUAL_STAGES

from shotc.ir.limits import Timing
from tests.support.path_scenes import TOWER, circle, mission, shot
from tests.support.records import replace as changed
from tests.support.refiner_scenes import arc, nodes_of, subject


def test_every_keyframe_and_stop_is_a_node_and_time_runs_on():
    held = circle(TOWER, 5, 45.0, 20.0, sweep=2.0)
    held[2] = changed(held[2], hold=2.0)
    of = subject(mission(targets=(TOWER,)), shot(held))
    nodes = nodes_of(of)
    assert len(nodes.s) == 25
    assert (np.diff(nodes.s) > 0).all()
    assert (np.diff(nodes.t) > 0).all()
    assert nodes.s[[0, -1]].tolist() == [of.leg.curve.start, of.leg.curve.end]
    for s in [m.s for m in of.leg.marks] + [stop.s for stop in of.leg.stops]:
        assert np.abs(nodes.s - s).min() == 0.0
    assert nodes.s[nodes.pins].tolist() == sorted({m.s for m in of.leg.marks})
    assert (np.diff(nodes.pins) >= 2).all()


def test_places_that_a_kind_generated_bind_only_at_rest():
    of = subject(mission(targets=(TOWER,)), shot(circle(TOWER, 5, 45.0, 20.0, sweep=2.0, placed=False)))
    nodes = nodes_of(of)
    assert nodes.pins.tolist() == [0, 24]


def test_nodes_are_even_in_time_between_keyframes():
    nodes = nodes_of(arc())
    for a, b in zip(nodes.pins[:-1], nodes.pins[1:], strict=True):
        steps = np.diff(nodes.t[a : b + 1])
        assert steps == pytest.approx(np.full(b - a, steps.mean()), rel=1e-9)


def test_many_keyframes_get_more_stages():
    assert len(nodes_of(arc(), None).s) == USUAL_STAGES + 1
    many = subject(mission(targets=(TOWER,)), shot(circle(TOWER, 13, 45.0, 20.0, sweep=2.0)))
    assert USUAL_STAGES < len(nodes_of(many, None).s) - 1 <= MOST_STAGES


def test_a_duration_stretches_the_guess_to_it_less_the_holds():
    held = circle(TOWER, 5, 45.0, 20.0, sweep=2.0)
    held[2] = changed(held[2], hold=2.0)
    of = subject(mission(targets=(TOWER,)), shot(held, timing=Timing(duration=40.0)))
    assert nodes_of(of).t[-1] == pytest.approx(38.0)
