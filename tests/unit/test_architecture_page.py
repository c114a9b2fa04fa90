"""The files and the names that architecture.md mentions are there."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from shotc import pipeline

ROOT = Path(__file__).parents[2]
PACKAGE = ROOT / "shotc"
PAGE = (PACKAGE / "docs" / "architecture.md").read_text(encoding="utf-8")
QUOTED = set(re.findall(r"`([^`\n]+)`", re.sub(r"```.*?```", "", PAGE, flags=re.DOTALL)))


def test_the_files_and_folders_are_there() -> None:
    here = [path.relative_to(PACKAGE).as_posix() for path in PACKAGE.rglob("*") if path.suffix in ("", ".py")]
    named = {name.rstrip("/") for name in QUOTED if re.fullmatch(r"[\w/.-]+(\.py|/)", name)}
    inside = {n for n in named if any(f"/{path}".endswith(f"/{n}") for path in here)}
    missing = {n for n in named - inside if not (ROOT / n).exists()}
    assert len(named) > 100
    assert missing == set()


@pytest.mark.slow
def test_the_names_of_the_code_are_there() -> None:
    sources = "\n".join(path.read_text(encoding="utf-8") for path in PACKAGE.rglob("*.py"))
    words = set(re.findall(r"\w+", sources))
    names = {name for name in QUOTED if re.fullmatch(r"[A-Za-z_]\w*(\.[A-Za-z_]\w*)+|[A-Z]\w+", name)}
    parts = {part for name in names for part in name.split(".")}
    assert len(names) > 40
    assert parts - words == set()


def test_the_flow_draws_the_passes_of_the_routes() -> None:
    drawn = [
        tuple(re.findall(r"─([a-z-]+)→", line)) for line in re.findall(r"```\n(.*?)```", PAGE, re.DOTALL)
    ]
    passes = [tuple(p for p in flow if p in pipeline.PASS_NAMES) for flow in drawn if flow]
    front = [step.name for step in pipeline.FRONT]
    assert passes[0] == (*front, *(step.name for step in (*pipeline.FILM, pipeline.VERIFY)))
    assert passes[1] == tuple(step.name for step in (*pipeline.SHOW, pipeline.VERIFY))
