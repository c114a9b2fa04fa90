"""What is told as "within", "at most" or "up to" is rounded up: it is never below what it stands for."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

import shotc
from shotc.rounding import nearer_than

SOURCES = sorted(Path(shotc.__file__).parent.rglob("*.py"))
WORDS = re.compile(r"within|at most|up to|no more than")
BEFORE = re.compile(r"\b(within|at most|up to|no more than) $")
AFTER = re.compile(r"[^,;:]{0,12} at most\b")


def rounded_to_nearest(source: str) -> list[str]:
    """Return the values in f-strings that such words bound, and that the format rounds to the nearest digit.

    Named constants are as they are written.
    """
    found: list[str] = []
    if not WORDS.search(source):
        return found
    for string in ast.walk(ast.parse(source)):
        parts = string.values if isinstance(string, ast.JoinedStr) else []
        texts = [str(part.value) if isinstance(part, ast.Constant) else "" for part in parts]
        for part, before, after in zip(parts, ["", *texts], [*texts[1:], ""], strict=False):
            if not isinstance(part, ast.FormattedValue) or part.format_spec is None:
                continue
            names = {node.id for node in ast.walk(part.value) if isinstance(node, ast.Name)}
            rounds = re.search(r"\.\d+[fg]", ast.unparse(part.format_spec))
            if rounds and not all(map(str.isupper, names)) and (BEFORE.search(before) or AFTER.match(after)):
                found.append(ast.unparse(part))
    return found


@pytest.mark.long
def test_nothing_that_is_told_as_a_bound_is_rounded_to_the_nearest():
    found = {path.name: rounded_to_nearest(path.read_text(encoding="utf-8")) for path in SOURCES}
    assert {name: values for name, values in found.items() if values} == {}


@pytest.mark.parametrize(
    "text",
    ['f"comes within {near:.2f} m"', 'f"{speed:.1f} m/s at most"', 'f"rises by up to {value:.3g} m"'],
)
def test_a_bound_rounded_to_the_nearest_is_found(text):
    assert len(rounded_to_nearest(text)) == 1


@given(st.floats(0.0, 1e3), st.floats(1e-6, 10.0))
def test_a_distance_is_told_rounded_up_and_still_below_what_is_needed(distance, lack):
    told = float(nearer_than(distance, distance + lack))
    assert distance - 1e-7 <= told < distance + lack
