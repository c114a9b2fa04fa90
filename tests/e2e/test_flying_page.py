"""The guide from a plan to the air: its mission does what the page says."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.support.command import run

pytestmark = pytest.mark.slow

PAGE = (Path(__file__).parents[2] / "shotc" / "docs" / "flying.md").read_text(encoding="utf-8")


def test_following_what_is_seen_keeps_what_the_plan_alone_does_not(tmp_path: Path) -> None:
    (text,) = re.findall(r"```yaml\n(# walker.yaml\n.*?)```", PAGE, re.DOTALL)
    (tmp_path / "walker.yaml").write_text(text)
    assert run("plan", "walker.yaml", "--emit", "csv", folder=tmp_path).code == 0
    replayed = run("simulate", "out/walker", "--seeds", "6", folder=tmp_path)
    assert replayed.code == 1
    assert "W001" in replayed.err
    tracked = run("simulate", "out/walker", "--seeds", "6", "--loop", "track", folder=tmp_path)
    assert tracked.code == 0, tracked.err
