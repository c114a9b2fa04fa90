"""Every help line is true: each alternative of each failing example, written into it, corrects it.

The fault must be gone and no error may come in its place. A rule applies an alternative, or the table of
choices (``by_hand``) has one for it. What stands in ``NOT_WRITTEN`` is no edit of a mission.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from shotc.diag.code_info import CodeInfo
from shotc.diag.registry import registry
from tests.support.front_passes import placed
from tests.support.remedies.by_hand import FILES, HANDS
from tests.support.remedies.tried import tried_all

pytestmark = pytest.mark.slow

CHECKED = [info for info in registry().values() if info.phase == "check" and not info.code.startswith("Y")]
"""Those of the Y family are faults of the text: there is no tree yet in which to set a key."""

NOT_WRITTEN = {
    (
        "S016",
        "start from a template: shotc new",
    ): "tests/cli/test_explain_list_new_schema.py plans every template",
    ("S017", "give the mission's YAML file; `shotc verify`, `emit`, `view` and `diff` take plans"): (
        "another file is given"
    ),
    ("G016", "the plan will leave the ideal here"): "it says what happens if nothing is done",
}
"""Alternatives that are no edit of a mission, and why."""


@pytest.mark.long
@pytest.mark.parametrize("info", CHECKED, ids=[info.code for info in CHECKED])
def test_what_a_help_proposes_does_when_it_is_written(info: CodeInfo, tmp_path: Path) -> None:
    for name, data in FILES.items():
        (tmp_path / name).write_bytes(data)
    result = tried_all(info.failing, lambda text: placed(text.encode(), tmp_path)[1], HANDS)
    assert result.wrong == []
    assert [text for text in result.untried if (info.code, text) not in NOT_WRITTEN] == []


def test_each_choice_and_reason_belongs_to_a_help_of_an_example() -> None:
    codes = {info.code for info in CHECKED}
    assert {hand.code for hand in HANDS} | {code for code, _ in NOT_WRITTEN} <= codes
