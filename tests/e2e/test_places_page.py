"""The guide to real places: its missions check clean and plan without a warning, each in its folder."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from shotc.api import PlanOptions, compile_source
from shotc.checking import check_source
from shotc.identify.mission import TextLocation, identify_source

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "shotc" / "docs" / "places.md").read_text(encoding="utf-8")
ANY = "any"


def missions() -> list[tuple[str, Path, bytes]]:
    """Return the name, the folder and the text of each mission on the page."""
    found = re.findall(r"```yaml\n# in (\S+).*?\n(.*?)```", PAGE, re.DOTALL)
    return [
        (
            re.findall(r"^mission: (.*)$", text, re.MULTILINE)[0],
            ROOT / ("" if folder == ANY else folder),
            text.encode(),
        )
        for folder, text in found
    ]


MISSIONS = missions()
BOXES = "what-is-that"
each = pytest.mark.parametrize(("folder", "text"), [m[1:] for m in MISSIONS], ids=[m[0] for m in MISSIONS])


def test_every_section_has_its_mission() -> None:
    sections = re.split(r"^## ", PAGE, flags=re.MULTILINE)[1:]
    assert [section.count("```yaml\n# in ") for section in sections] == [1] * len(MISSIONS)
    titles = " ".join(section.splitlines()[0].lower() for section in sections)
    for word in (
        "heights",
        "terrain",
        "scene",
        "buildings",
        "shapes",
        "groups",
        "building as a target",
        "found",
    ):
        assert word in titles


@each
def test_it_checks_clean(folder: Path, text: bytes) -> None:
    assert check_source(text, "mine.yaml", folder).diagnostics == ()


@pytest.mark.long
@each
def test_it_plans_without_a_warning(folder: Path, text: bytes) -> None:
    if BOXES.encode() in text:
        place = TextLocation("mine.yaml", folder)
        done = identify_source(text, place, place, None)
        assert [target.name for target in done.targets] == ["silo"]
        assert done.text is not None
        text = done.text
    made = compile_source(text, "mine.yaml", folder, PlanOptions())
    assert made.diagnostics == ()
    assert made.plan is not None


def test_the_height_in_words_is_that_of_the_mission() -> None:
    (text,) = (text for name, _, text in MISSIONS if name == "statue-on-a-hill")
    found = check_source(text.replace(b"{above: target, height: 8}", b"8"), "mine.yaml", None).diagnostics
    assert [d.code for d in found] == ["G020"]
    assert "z = 48.00 m" in " ".join(found[0].notes)
    assert "flies at z = 48" in PAGE
