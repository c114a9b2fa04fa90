"""The examples of every code that `check` finds: the failing one fails with it, the passing one passes."""

from __future__ import annotations

from importlib import import_module
from typing import Any

import pytest

from shotc.diag.model import Diagnostic, Severity
from shotc.diag.registry import FAMILIES, CodeInfo, registry
from shotc.passes.base import PassContext
from shotc.passes.place_keyframes import PlaceKeyframes
from shotc.passes.resolve import Resolve
from shotc.spec.load import load

MODULES = (
    "keyframes", "static", "orbit", "spiral", "elevator", "dolly", "crane", "top_down", "chase", "lead",
    "lateral", "flyby", "follow_path", "framing", "display",
)  # fmt: skip
KINDS: dict[str, Any] = {k.name: k for k in (import_module(f"shotc.kinds.{m}").KIND for m in MODULES)}
EMITTERS = ("csv", "mavlink", "storyboard", "rerun")
CHECKED = [info for info in registry().values() if info.phase == "check"]


def unescaped(text: str) -> bytes:
    """Return an example's bytes; those of Y codes may be written with backslash escapes."""
    return text.encode().decode("unicode_escape").encode("latin-1") if "\\x" in text else text.encode()


def check(data: bytes, tmp_path: Any) -> list[Diagnostic]:
    loaded = load(data, "mission.yaml", tmp_path, {name: kind.model for name, kind in KINDS.items()})
    found = list(loaded.diagnostics)
    if loaded.mission is not None:
        resolved = Resolve(KINDS, EMITTERS).run(loaded.mission, PassContext())
        found += resolved.diagnostics
        if resolved.value is not None:
            found += PlaceKeyframes().run(resolved.value, PassContext()).diagnostics
    return found


@pytest.mark.parametrize("info", CHECKED, ids=[info.code for info in CHECKED])
def test_the_failing_example_raises_its_code_alone(info: CodeInfo, tmp_path: Any) -> None:
    found = check(unescaped(info.failing), tmp_path)
    assert {d.code for d in found} == {info.code}, found


@pytest.mark.parametrize("info", CHECKED, ids=[info.code for info in CHECKED])
def test_the_passing_example_is_clean(info: CodeInfo, tmp_path: Any) -> None:
    assert check(unescaped(info.passing), tmp_path) == []


@pytest.mark.parametrize("info", CHECKED, ids=[info.code for info in CHECKED])
def test_a_diagnostic_reads_as_one_should(info: CodeInfo, tmp_path: Any) -> None:
    for d in check(unescaped(info.failing), tmp_path):
        assert d.labels, "it points at a line"
        assert d.labels[0].span.line <= info.failing.count("\n") + 1
        assert not d.message.endswith(".")
        assert d.message[0] in "`'" or d.message[0] == d.message[0].lower()
        assert "illegal" not in d.message
        assert "infeasible" not in d.message
        assert d.help or d.notes, "it says what would help, or why"


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
