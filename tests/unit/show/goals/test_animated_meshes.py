"""Meshes that move from frame to frame: nobody crosses the body, and drones stay apart."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from shotc.api import PlanOptions, compile_source
from tests.support.animated_meshes import animated

pytestmark = pytest.mark.slow


def test_goals_follow_each_other(tmp_path: Path) -> None:
    done = compile_source(animated(tmp_path, 40, 8, 1.0), "a.yaml", tmp_path, PlanOptions())
    assert done.plan is not None, done.diagnostics
    level = next(r.output for r in done.reports if r.name == "assign-goals")
    flight = level.fleets[0]
    at = np.abs(flight.breaks[:, None] - [s.start for s in flight.shown]).argmin(axis=0)
    goals = flight.coef[:, at + 1]
    steps = np.linalg.norm(np.diff(goals, axis=1), axis=2)
    assert steps.max() < 0.3 * np.ptp(goals, axis=(0, 1)).max()
    apart = dict(done.plan.trajectory.stats)["fleet swarm apart proven"]
    assert float(apart) >= 0.7
