"""Every help line is true: each remedy of each failing example, written into it, corrects it.

The fault must be gone and no error may come in its place. What stands in ``TOLD_IN_WORDS`` names no edit that
a rule could apply; the list may only get shorter.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from shotc.diag.code_info import CodeInfo
from shotc.diag.registry import registry
from tests.support.front_passes import placed
from tests.support.remedies.tried import failed

pytestmark = pytest.mark.slow

CHECKED = [info for info in registry().values() if info.phase == "check" and not info.code.startswith("Y")]
"""Those of the Y family are faults of the text: there is no tree yet in which to set a key."""

TOLD_IN_WORDS = {
    **dict.fromkeys(
        (*("S004", "S005", "S007", "S008", "S011", "S012", "S015", "S016", "S017", "D120", "D130"),
            *("G050", "N008", "U002", "U005", "U006")),
        "only the author knows the value: the help says its form",
    ),
    **dict.fromkeys(("G007", "G014", "G015", "G054"), "another place is the author's choice"),
    **dict.fromkeys(("K005", "D021"), "what to drop is the author's choice"),
    **dict.fromkeys(("K009", "M003"), "how long a shot lasts is the author's choice"),
    "M036": "how a subject appears at first is the author's choice",
    **dict.fromkeys(("K015", "K022", "M030", "M034"), "it asks whether what is written is meant"),
    **dict.fromkeys(("K016", "K019", "M002"), "it needs a name or another kind with keys of its own"),
    **dict.fromkeys(
        ("D011", "D012", "D013", "D024"),
        "where a picture or pad goes is the author's choice",
    ),
}  # fmt: skip
"""Codes whose help no rule applies, and why."""


@pytest.mark.long
@pytest.mark.parametrize("info", CHECKED, ids=[info.code for info in CHECKED])
def test_what_a_help_proposes_does_when_it_is_written(info: CodeInfo, tmp_path: Path) -> None:
    found, wrong = failed(info.failing, lambda text: placed(text.encode(), tmp_path)[1])
    assert bool(found) != (info.code in TOLD_IN_WORDS), "a rule applies it, or the list says why none does"
    assert wrong == []
