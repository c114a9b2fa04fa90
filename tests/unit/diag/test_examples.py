"""The examples of every code that `check` finds: the failing one fails with it, the passing one passes."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import pytest

from shotc.diag.code_info import CodeInfo
from shotc.diag.model import Diagnostic, Severity
from shotc.diag.registry import FAMILIES, registry
from tests.support.front_passes import placed

CHECKED = [info for info in registry().values() if info.phase == "check"]
SLOW = ("M031",)
"""Codes of which a dozen remedies are tried."""
FAILING = [
    pytest.param(info, id=info.code, marks=[pytest.mark.slow] if info.code in SLOW else [])
    for info in CHECKED
]


def unescaped(text: str) -> bytes:
    """Return an example's bytes; those of Y codes may be written with backslash escapes."""
    return text.encode().decode("unicode_escape").encode("latin-1") if "\\x" in text else text.encode()


Check = Callable[[str], list[Diagnostic]]


@pytest.fixture(scope="module")
def check(tmp_path_factory: pytest.TempPathFactory) -> Check:
    """Check an example in an empty folder; many codes have the same one that passes."""
    folder = tmp_path_factory.mktemp("empty")

    @cache
    def checked(text: str) -> list[Diagnostic]:
        return placed(unescaped(text), folder)[1]

    return checked


@pytest.mark.slow
@pytest.mark.parametrize("info", FAILING)
def test_the_failing_example_raises_its_code_alone(info: CodeInfo, check: Check) -> None:
    found = check(info.failing)
    assert {d.code for d in found} == {info.code}, found


@pytest.mark.parametrize("info", CHECKED, ids=[info.code for info in CHECKED])
def test_the_passing_example_is_clean(info: CodeInfo, check: Check) -> None:
    assert check(info.passing) == []


@pytest.mark.parametrize("info", FAILING)
def test_a_diagnostic_reads_as_one_should(info: CodeInfo, check: Check) -> None:
    for d in check(info.failing):
        assert d.labels, "it points at a line"
        assert d.labels[0].span.line <= info.failing.count("\n") + 1
        assert not d.message.endswith(".")
        assert d.message[0] in "`'" or d.message[0] == d.message[0].lower()
        assert "illegal" not in d.message
        assert "infeasible" not in d.message
        assert d.help or d.notes or "expected" in d.message, "it says what would help, or why"


def test_every_code_is_explained() -> None:
    for info in registry().values():
        assert info.code[0] in FAMILIES
        assert info.summary
        assert not info.summary.endswith(".")
        assert len(info.explanation) > 60
        assert info.failing != info.passing or info.phase == "other"
        assert info.severity in Severity


def test_slugs_are_unique() -> None:
    slugs = [info.slug for info in registry().values()]
    assert len(slugs) == len(set(slugs))
