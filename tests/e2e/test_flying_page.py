"""The guide from a plan to the air: its mission does what the page says."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from shotc.simulation.rehearsal import RehearsalOptions, conditions_of, rehearse
from shotc.simulation.rehearsal_faults import not_kept
from shotc.simulation.runs import simulated
from tests.support.compiled import compiled_text

pytestmark = pytest.mark.slow

PAGE = (Path(__file__).parents[2] / "shotc" / "docs" / "flying.md").read_text(encoding="utf-8")


@pytest.mark.long
def test_following_what_is_seen_keeps_what_the_plan_alone_does_not() -> None:
    (text,) = re.findall(r"```yaml\n(# walker.yaml\n.*?)```", PAGE, re.DOTALL)
    plan = compiled_text(text).plan
    assert plan is not None

    def broken(asked: RehearsalOptions) -> list[str]:
        conditions = conditions_of(plan.trajectory.keyframes.mission, asked)
        runs = simulated(plan.trajectory, conditions, 6, 1)
        done = rehearse(plan.trajectory, conditions, runs, lambda _: None)
        return [each.code for each in not_kept(done)]

    assert set(broken(RehearsalOptions())) == {"W001"}
    assert broken(RehearsalOptions(loop="track")) == []
