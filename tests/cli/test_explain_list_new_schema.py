"""The commands that teach: explain, list, new and schema."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from shotc.cli import new
from shotc.diag.registry import registry
from shotc.pipeline import PASS_NAMES
from shotc.solvers.headings import DEFAULT, METHODS
from tests.cli.conftest import GOOD, Run
from tests.support.front_passes import resolved


@pytest.mark.parametrize("name", ["Y012", "y012", "duplicate-key", "Duplicate-Key"])
def test_a_code_by_number_or_name(run: Run, name: str) -> None:
    result = run("explain", name)
    assert result.code == 0
    assert result.out.startswith("Y012 duplicate-key: a key is given twice\nerror, since 0.1\n")
    assert "Raises it:\n\n    shotc: 1\n    mission: look\n    mission: again\n" in result.out
    assert result.out.endswith("Passes with:\n\n    - mission: again\n")


def test_every_code_with_examples_tells_how_the_failing_one_is_mended(run: Run) -> None:
    for info in (info for info in registry().values() if info.passing and info.code[1:].endswith("1")):
        raises, _, passes = run("explain", info.code).out.partition("\nPasses")
        for line in set(info.failing.splitlines()) - set(info.passing.splitlines()):
            assert f"    {line}" in raises, info.code
            assert f"    - {line}" in passes or passes.startswith(":"), info.code
        for line in set(info.passing.splitlines()) - set(info.failing.splitlines()):
            assert f"    + {line}" in passes or passes.startswith(":"), info.code


@pytest.mark.parametrize(
    ("name", "hint"),
    [("duplicat-key", "Y012 (duplicate-key)"), ("Y912", "Y012"), ("zzzz", "lists all codes")],
)
def test_an_unknown_code_gets_the_nearest(run: Run, name: str, hint: str) -> None:
    result = run("explain", name)
    assert (result.code, result.out) == (2, "")
    assert hint in result.err


def test_all_codes_by_family(run: Run) -> None:
    out = run("explain").out
    assert out.startswith("Y: text and YAML\n  Y001  ")
    assert all(f"  {code}  {info.slug}" in out for code, info in registry().items())


@pytest.mark.parametrize(
    ("group", "name"),
    [
        ("kinds", "orbit"),
        ("drones", "x500"),
        ("refiners", "none"),
        ("emitters", "csv"),
        ("replanners", "ours"),
        ("saliency", "spectral-residual"),
        ("compositions", "thirds"),
    ],
)
def test_lists_name_and_summary(run: Run, group: str, name: str) -> None:
    result = run("list", group)
    assert result.code == 0
    rows = dict(line.split(maxsplit=1) for line in result.out.splitlines())
    assert rows[name]


def test_without_a_group_the_groups_are_listed(run: Run) -> None:
    result = run("list")
    assert result.code == 0
    assert [line.split()[0] for line in result.out.splitlines()] == [
        "kinds",
        "drones",
        "refiners",
        "replanners",
        "emitters",
        "saliency",
        "compositions",
        "headings",
    ]


def test_drones_are_listed_with_what_they_may_do(run: Run) -> None:
    heading, *rows = (re.split(r"  +", line) for line in run("list", "drones").out.splitlines())
    assert heading[:6] == ["name", "speed m/s", "climb m/s", "accel. m/s^2", "hfov deg", "endurance min"]
    x500 = next(row for row in rows if row[0] == "x500")
    assert x500[1:7] == ["8", "3", "3", "70", "14.4", "px4"]
    assert {len(row) for row in rows} == {len(heading)}


def test_every_kind_is_planned(run: Run) -> None:
    assert "not planned yet" not in run("list", "kinds").out


def test_named_points_are_listed_with_the_compositions(run: Run) -> None:
    assert re.search(r"^left-third +\(-0\.333, 0\)$", run("list", "compositions").out, re.MULTILINE)


def test_heading_methods_are_listed_and_one_is_the_default(run: Run) -> None:
    lines = run("list", "headings").out.splitlines()
    assert [line.split()[0] for line in lines] == list(METHODS)
    assert [line.split()[0] for line in lines if line.endswith("[default]")] == [DEFAULT]


def test_an_unknown_heading_method_names_the_known_ones(run: Run) -> None:
    done = run("plan", "mission.yaml", "--headings", "windig")
    assert done.code == 2
    assert "winding" in done.err


@pytest.mark.slow
def test_help_of_plan_names_the_passes(run: Run) -> None:
    out = run("plan", "--help").out
    assert all(name in out for name in PASS_NAMES)


def test_an_unknown_list(run: Run) -> None:
    assert run("list", "planes").code == 2


@pytest.mark.slow
def test_the_schema_is_json(run: Run) -> None:
    document = json.loads(run("schema").out)
    assert document["$schema"].startswith("https://json-schema.org/")
    assert "shots" in document["properties"]


@pytest.mark.parametrize("name", sorted(new._templates()))
def test_a_template_keeps_well_clear_of_what_it_films_and_is_clean(name: str) -> None:
    mission, found = resolved(new._templates()[name])
    assert mission is not None
    assert found == []
    assert not mission.targets or mission.rules.target_clearance >= 3.0


@pytest.fixture
def _templates(monkeypatch: pytest.MonkeyPatch) -> None:
    texts = {"landmark": b"# A tower.\n" + GOOD.encode(), "orbit": GOOD.encode()}
    monkeypatch.setattr(new, "_templates", lambda: texts)


@pytest.mark.usefixtures("_templates")
class TestNew:
    def test_templates_are_listed(self, run: Run) -> None:
        assert run("new").out == "landmark  A tower.\norbit\n"

    def test_a_mission_that_checks(self, run: Run) -> None:
        result = run("new", "landmark", "-o", "a/my.yaml")
        assert (result.code, result.out) == (0, "wrote a/my.yaml\n")
        assert "shotc check a/my.yaml" in result.err
        assert run("check", "a/my.yaml").code == 0

    def test_the_name_is_the_default(self, run: Run) -> None:
        assert run("new", "orbit.yaml").code == 0
        assert Path("orbit.yaml").read_text() == GOOD

    def test_nothing_is_overwritten_unasked(self, run: Run) -> None:
        Path("orbit.yaml").write_text("mine")
        result = run("new", "orbit")
        assert result.code == 2
        assert "--force" in result.err
        assert Path("orbit.yaml").read_text() == "mine"
        assert run("new", "orbit", "--force").code == 0
        assert Path("orbit.yaml").read_text() == GOOD

    def test_to_standard_output(self, run: Run) -> None:
        assert run("new", "orbit", "-o", "-").out == GOOD

    def test_an_unknown_template_gets_the_nearest(self, run: Run) -> None:
        result = run("new", "landmrk")
        assert result.code == 2
        assert "`landmark`" in result.err

    def test_a_place_that_cannot_be_written(self, run: Run) -> None:
        Path("file").write_text("")
        result = run("new", "orbit", "-o", "file/x.yaml")
        assert result.code == 1
        assert "error[E901]" in result.err
