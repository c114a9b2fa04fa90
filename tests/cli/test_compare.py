"""compare: one mission under several refiners, of which some break promises or fail."""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from shotc import plugins
from shotc.comparison import Options, compare_source, ordered, outputs
from shotc.comparison.table import rows
from shotc.ir.comparison import Comparison, Condition
from tests.cli.conftest import Run
from tests.support.bad_refiners import MISSION, PASS, ROUND, text
from tests.support.plugin_distributions import lay, refiner

pytestmark = pytest.mark.slow

ALONG = "from tests.support.bad_refiners import along, bumped"
BENT = (ALONG, "return Outcome(bumped(path, 'pass', along(4, 0.2)))")
FAILING = ("raise RuntimeError('no camera')",)
SHORT = (ALONG, "return Outcome(bumped(path, 'pass', along(0, 40)))")
PROMISE = "    require: {screen_error: 0.05}\n"
FILES = ["compare.json", "compare.md", "compare.png", "compare.rrd", "differences.png"]
Install = Callable[..., None]


@pytest.fixture
def install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Install]:
    """Return a function that installs a refiner whose ``refine`` has some lines."""
    folder = tmp_path / "site"
    folder.mkdir()

    def laid(name: str, *lines: str) -> None:
        lay(folder, f"{name}-maker", name, refiner(name, *lines), "refiners")
        monkeypatch.delitem(sys.modules, f"{name}_maker", raising=False)
        plugins.forget()

    monkeypatch.syspath_prepend(str(folder))
    yield laid
    plugins.forget()


@pytest.fixture
def yard(tmp_path: Path) -> Path:
    """A mission of two shots, of which the first promises to keep its target in place."""
    path = tmp_path / "yard.yaml"
    path.write_text(MISSION.replace(f"  - id: {PASS}\n", f"  - id: {PASS}\n{PROMISE}"))
    return path


def conditions(mission: str, *refiners: str) -> list[Condition]:
    report = compare_source(mission.encode(), "yard.yaml", None, Options(refiners))
    assert report.comparison is not None
    return list(report.comparison.conditions)


@pytest.mark.long
def test_each_refiner_is_a_row_whether_it_keeps_promises_breaks_them_or_fails(
    run: Run, yard: Path, install: Install
) -> None:
    install("bent", *BENT)
    install("failing", *FAILING)
    done = run("compare", str(yard), "--refiners", "none,bent,failing")
    assert (done.code, done.err) == (0, "")
    lines = [re.split(r"\s{2,}", line.strip()) for line in done.out.splitlines()]
    table = {(row[0], row[1]): row for row in lines if len(row) > 7}
    assert float(table["none", "all"][4]) < 0.01
    assert float(table["bent", "all"][4]) > 0.2
    assert table["failing", "all"][2] == "no plan (R001)"
    assert [row[0] for row in lines if row[0] in (PASS, ROUND)] == [PASS, ROUND] * 2
    assert "bent breaks a promise, V020" in done.out
    assert "failing gives no plan, R001" in done.out
    folder = yard.parent / "out" / "yard" / "compare"
    assert sorted(path.name for path in folder.iterdir()) == FILES
    shape(json.loads((folder / "compare.json").read_text()))
    reads_back(folder / "compare.rrd")


def shape(document: dict) -> None:
    """Hold a compare.json to the shape that others read; no clock reading is in it."""
    assert list(document) == ["format", "version", "tool", "source", "mission", "refiners", "differences"]
    assert (document["format"], document["version"]) == ("shotc-compare", 1)
    none, bent, failing = document["refiners"]
    score = [
        "frames",
        "error_mean",
        "error_p95",
        "error_worst",
        "in_frame",
        "in_frame_four_points",
        "visible",
        "jerk_rms",
        "turn_jerk_rms",
        "off_place",
        "duration",
    ]
    for each in (none, bent, failing):
        assert list(each) == [
            "refiner",
            "package",
            "smoothing_s",
            "planned",
            "faults",
            "broken_promises",
            "left_convex",
            "all",
            "shots",
        ]
    assert list(none["all"]) == score
    assert [list(shot) for shot in none["shots"]] == [["shot", "drone", "start", "rounds", *score]] * 2
    assert (none["planned"], none["faults"], none["broken_promises"]) == (True, [], [])
    assert [fault["code"] for fault in bent["broken_promises"]] == ["V020"]
    assert bent["planned"]
    assert (failing["planned"], failing["all"], failing["shots"]) == (False, None, [])
    assert (failing["package"], failing["faults"][0]["code"]) == ("failing-maker", "R001")


def reads_back(recording: Path) -> None:
    """Hold a recording to cameras that move, each below its refiner, on one timeline."""
    from rerun.chunk import RrdReader

    moving, still = set(), set()
    for chunk in RrdReader(recording).stream().to_chunks():
        names = chunk.to_record_batch().schema.names
        (moving if "t" in names else still).add(str(chunk.entity_path))
    for name in ("none", "bent"):
        assert f"/world/refiners/{name}/cameras/cam" in moving
        assert f"/world/refiners/{name}/cameras/cam/screen/mast/outline" in moving
        assert f"/plots/refiners/{name}/cam/screen_error/screen_error" in moving
    assert {"/world/targets/mast/body", "/world/ground/plane", "/summary"} <= still
    assert not any("failing" in entity for entity in moving | still)


@pytest.mark.long
def test_what_is_written_is_the_same_every_time(run: Run, yard: Path, install: Install) -> None:
    install("bent", *BENT)
    for folder in ("one", "two"):
        assert run("compare", str(yard), "--refiners", "bent", "-o", folder).code == 0
    for name in FILES[:3]:
        assert Path("one", name).read_bytes() == Path("two", name).read_bytes()


@pytest.mark.parametrize("form", ["json", "markdown"])
def test_the_table_is_printed_for_machines_and_for_pages(run: Run, good: Path, form: str) -> None:
    done = run("compare", str(good), "--refiners", "none", "--format", form, "-o", "out")
    assert (done.code, done.err) == (0, "")
    if form == "json":
        printed = json.loads(done.out)
        assert printed["refiners"][0].pop("refine_seconds") >= 0
        assert printed == json.loads(Path("out/compare.json").read_text())
    else:
        assert done.out.splitlines()[2].startswith("| refiner | error mean | 95 % |")
        assert "refined in" in done.out
        assert "refined in" not in Path("out/compare.md").read_text()


def test_a_limit_that_a_refiner_breaks_refuses_its_plan(install: Install) -> None:
    install("short", *SHORT)
    none, short = conditions(MISSION, "none", "short")
    assert none.plan is not None
    assert short.plan is None
    assert short.faults
    assert all(fault.code[0] in "RTV" for fault in short.faults)


def test_a_shot_that_keeps_its_convex_path_is_told(install: Install) -> None:
    install("failing", *FAILING)
    none, failing = conditions(text(PASS, ROUND), "none", "failing")
    assert [d.code for d in failing.convex] == ["R003", "R003"]
    assert failing.score == none.score


def test_a_refiner_that_takes_too_long_keeps_nobody_waiting(run: Run, good: Path, install: Install) -> None:
    install("slow", "import time", "time.sleep(600)")
    done = run("compare", str(good), "--refiners", "none,slow", "--deadline", "0.5")
    assert done.code == 0
    assert "slow gives no plan, R004" in done.out


def test_rounds_are_told_where_a_refiner_counts_them(install: Install) -> None:
    install(
        "counting",
        "from dataclasses import replace",
        f"return Outcome(replace(path, stats=(('{PASS}.refine_rounds', 3.0),)))",
    )
    (counting,) = conditions(MISSION, "counting")
    assert [shot.rounds for shot in counting.shots] == [3, None]
    found = Comparison(counting.plan.trajectory.keyframes.mission, (counting,))
    assert [row[-1] for row in rows(found, seconds=False)] == ["rounds", "3", "3", "-"]


def test_a_plan_that_breaks_a_promise_is_not_one_that_makes_it(install: Install) -> None:
    install("bent", *BENT)
    mission = MISSION.replace(f"  - id: {PASS}\n", f"  - id: {PASS}\n{PROMISE}")
    (bent,) = conditions(mission, "bent")
    assert bent.plan is not None
    assert all(claim.holds for claim in bent.plan.certificate if claim.hard)
    assert all(shot.promise.screen_error is None for shot in bent.plan.trajectory.keyframes.mission.shots)


def test_where_no_refiner_gives_a_plan_the_mission_is_rejected(
    run: Run, yard: Path, install: Install
) -> None:
    install("failing", *FAILING)
    done = run("compare", str(yard), "--refiners", "failing")
    assert (done.code, done.out) == (1, "")
    assert "error[R001]" in done.err
    assert not Path("out").exists()


def test_a_mission_with_a_fault_is_rejected_before_any_refiner(run: Run, tmp_path: Path) -> None:
    path = tmp_path / "bad.yaml"
    path.write_text(MISSION.replace("target: mast", "target: mats"))
    done = run("compare", str(path), "--refiners", "none")
    assert (done.code, done.out) == (1, "")
    assert "mats" in done.err


@pytest.mark.parametrize(("names", "hint"), [("none,nine", "did you mean `none`?"), (",", "no refiner")])
def test_names_that_nobody_knows_are_a_usage_error(run: Run, good: Path, names: str, hint: str) -> None:
    done = run("compare", str(good), "--refiners", names)
    assert done.code == 2
    assert hint in done.err


def test_without_rerun_its_recording_is_left_out(
    run: Run, good: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(outputs, "find_spec", lambda name: None)
    done = run("compare", str(good), "--refiners", "none", "-o", "out")
    assert done.code == 0
    assert "warning[P005]: output `compare.rrd` needs rerun" in done.err
    assert sorted(path.name for path in Path("out").iterdir()) == FILES[:3]  # of one plan nothing differs


def test_the_usual_refiners_come_first_others_by_name() -> None:
    known = ["zeal", "ours", "none", "ang", "look-at", "bold", "ours-4pt", "framing-only"]
    assert ordered(known) == ["none", "ang", "look-at", "framing-only", "ours-4pt", "ours", "bold", "zeal"]
