"""What each format prints for one report, against text files that a person has read."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path

import pytest

from tests.support.diagnostics import REPORT, SOURCES

GOLDEN = Path(__file__).parent / "golden"
FORMATS = {"text": "txt", "concise": "txt", "json": "json", "github": "txt"}


@pytest.mark.parametrize("name", FORMATS)
def test_as_agreed(name: str) -> None:
    rendered = import_module(f"shotc.diag.render.{name}").render(REPORT, SOURCES)
    assert rendered == (GOLDEN / f"{name}.{FORMATS[name]}").read_text(encoding="utf-8")


@pytest.mark.parametrize("name", FORMATS)
def test_order_and_repeats_do_not_matter(name: str) -> None:
    render = import_module(f"shotc.diag.render.{name}").render
    assert render(REPORT[::-1] + REPORT[:3], SOURCES) == render(REPORT, SOURCES)


def test_colour_changes_no_word() -> None:
    import re

    from shotc.diag.render.text import render

    colored = render(REPORT, SOURCES, color=True)
    assert "\x1b[1;31merror[Y012]\x1b[0m" in colored
    assert re.sub(r"\x1b\[[0-9;]*m", "", colored) == render(REPORT, SOURCES)


@pytest.mark.parametrize("name", ["text", "concise", "github"])
def test_nothing_for_nothing(name: str) -> None:
    assert import_module(f"shotc.diag.render.{name}").render((), {}) == ""
