"""What is told of a way that passes several things too near, by the remedy of each rule."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from shotc.passes.verify import passing
from shotc.passes.verify.passing import PLAY_M, ClosestPass


def together(*passes: tuple[str, float]) -> list[tuple[Any, ClosestPass]]:
    """Claims of one drone on one way: the key of the rule, and the least distance on the way."""
    made = []
    for key, least in passes:
        claim = SimpleNamespace(subject="cam", path=("rules", "transit_clearance", key))
        made.append((claim, ClosestPass("it", ("zones", "it"), ("a", "b"), 1.0, least, 5.0, least, "")))  # type: ignore[arg-type]
    return made


def test_each_rule_that_a_way_breaks_is_accepted_at_the_least_distance_of_its_passes(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(passing, "_near", lambda *_: "near")
    monkeypatch.setattr(passing, "_when", lambda *_: "then")
    monkeypatch.setattr(passing, "_labels", lambda *_: ())
    passes = together(("other", 3.0), ("filmed", 2.0), ("other", 1.5), ("filmed", PLAY_M / 2))
    found = passing._diagnostic(SimpleNamespace(), passes)  # type: ignore[arg-type]
    least = passing.at_most(1.5 - PLAY_M)
    assert f"transit_clearance: {{filmed: 0.00 m, other: {least} m}}" in found.help
    assert found.message == "cam passes near"
    assert found.notes == ("then", *["and near; then"] * 3)
