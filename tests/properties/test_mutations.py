"""Real missions, damaged in every way: `check` says what is wrong, and never does anything else."""

from __future__ import annotations

import io
import json
import re
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path
from unittest.mock import patch

import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from shotc import api
from shotc.checking import check_source
from shotc.cli import app
from shotc.diag.model import Severity
from shotc.diag.registry import has_errors, registry, severity_of
from shotc.diag.render import json as json_report
from shotc.diag.render import text as text_report
from tests.support.damaged_missions import bent_trees, damaged_bytes, damaged_trees
from tests.support.few import examples

pytestmark = pytest.mark.slow


def examine(data: bytes, folder: Path) -> bool:
    """Check a mission, hold its report to the rules, and tell whether it is accepted."""
    report = check_source(data, "m.yaml", folder)
    lines = re.split("\r\n|\r|\n", report.sources["m.yaml"].text)
    for diagnostic in report.diagnostics:
        assert diagnostic.code in registry()
        assert diagnostic.code != "X001"
        assert diagnostic.labels
        assert len(diagnostic.message) < 400
        for label in diagnostic.labels:
            assert label.file == "m.yaml"
            assert 1 <= label.span.line <= label.span.end_line <= len(lines)
            width = len(lines[label.span.line - 1])
            assert 1 <= label.span.column <= width + 1
    document = json.loads(json_report.render(report.diagnostics, report.sources))
    assert len(document["diagnostics"]) == len(report.diagnostics)
    assert "\x1b" not in text_report.render(report.diagnostics, report.sources, color=False)
    return not has_errors(report.diagnostics)


@pytest.mark.long
@settings(max_examples=250)
@given(damaged_trees())
def test_a_damaged_mission_is_checked(damaged: tuple[bytes, Path]) -> None:
    examine(*damaged)


@settings(max_examples=250)
@given(damaged_bytes())
def test_a_damaged_text_is_checked(damaged: tuple[bytes, Path]) -> None:
    examine(*damaged)


@settings(max_examples=60)
@given(st.one_of(damaged_trees(), damaged_bytes()))
def test_the_command_accepts_or_rejects_and_writes_json(damaged: tuple[bytes, Path]) -> None:
    data, folder = damaged
    out, err = io.StringIO(), io.StringIO()
    with patch("sys.stdin", io.TextIOWrapper(io.BytesIO(data))), redirect_stdout(out), redirect_stderr(err):
        code = app.run(["check", "-", "--stdin-filename", str(folder / "m.yaml"), "--format", "json"])
    found = json.loads(out.getvalue())
    assert code == (1 if found["summary"]["errors"] else 0)
    assert err.getvalue() == ""


@pytest.mark.long
@pytest.mark.timeout(240)
@settings(
    max_examples=examples(3, 6), suppress_health_check=[HealthCheck.filter_too_much, HealthCheck.too_slow]
)
@given(bent_trees())
def test_a_bent_mission_is_planned_or_refused_with_a_reason(bent: tuple[bytes, Path]) -> None:
    data, folder = bent
    assume(examine(data, folder))
    done = api.compile_source(data, "m.yaml", folder, api.PlanOptions(refiner="none"))
    errors = [d for d in done.diagnostics if severity_of(d) is Severity.ERROR]
    assert (done.plan is None) == bool(errors)
    assert all(d.labels and (d.help or d.notes) for d in errors)
    # The planner keeps what it is given: verification may only find that a promise does not hold, or that
    # drones cannot keep out of each other's pictures as the mission requires.
    assert {d.code for d in errors if d.code[0] == "V"} <= {"V019", "V020", "V021", "V025"}
    if done.plan is not None:
        proved = api.verify_plan(api.emit_plan(done.plan, []).artifacts[0].data, "plan.json")
        assert proved.plan is not None
