"""Looking into the compiler and at its plans by the command line: stages, verify, emit and diff."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest

from shotc.cli import app, console
from shotc.pipeline import ROUTES
from tests.support.command import PLAN, SMALL, Result

pytestmark = pytest.mark.xdist_group("command")

FILM = ROUTES["film"]
NAMES = [step.name for step in FILM]
Shotc = Callable[..., Result]


@pytest.fixture
def shotc(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Shotc:
    """Return the command line, inside this process and in a folder with a mission."""
    for name in ("NO_COLOR", "FORCE_COLOR", "GITHUB_ACTIONS"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.chdir(tmp_path)
    Path("small.yaml").write_text(SMALL)

    def call(*arguments: str) -> Result:
        code = app.run(arguments)
        console.configure()
        return Result(code, *capsys.readouterr())

    return call


@pytest.mark.parametrize(("name", "gives"), [(step.name, step.gives) for step in FILM])
def test_every_pass_can_be_dumped(shotc: Shotc, name: str, gives: str) -> None:
    result = shotc(*PLAN, "small.yaml", "--dump-ir", name)
    assert (result.code, result.err) == (0, "")
    first, *rest = result.out.splitlines()
    assert first == gives
    assert all(line.startswith("  ") for line in rest)
    assert not Path("out").exists()


@pytest.mark.parametrize("name", NAMES)
def test_stopping_after_a_pass_times_the_passes_and_writes_nothing(shotc: Shotc, name: str) -> None:
    result = shotc(*PLAN, "small.yaml", "--stop-after", name, "--time-passes")
    assert (result.code, result.out) == (0, "")
    times = [line.split() for line in result.err.splitlines()]
    assert [words[2] for words in times] == NAMES[: NAMES.index(name) + 1]
    assert all(float(words[0]) >= 0 and words[1] == "s" for words in times)
    assert not Path("out").exists()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("emit", "files"),
    [
        ("csv", ["framing.csv", "plan.json", "trajectory.csv"]),
        ("csv,csv", ["framing.csv", "plan.json", "trajectory.csv"]),
        ("", ["plan.json"]),
        ("storyboard, csv", ["framing.csv", "plan.json", "storyboard.png", "trajectory.csv"]),
    ],
)
def test_emitters_are_chosen_by_name(shotc: Shotc, emit: str, files: list[str]) -> None:
    assert shotc(*PLAN, "small.yaml", "--emit", emit).code == 0
    assert sorted(path.name for path in Path("out/small").iterdir()) == files


@pytest.mark.slow
def test_a_written_plan_is_verified_and_an_edited_one_refused(shotc: Shotc) -> None:
    shotc(*PLAN, "small.yaml")
    result = shotc("verify", "out/small")
    assert result.code == 0
    assert result.out.splitlines()[-1].startswith("the plan holds: ")
    assert "speed" in result.out
    plan = Path("out/small/plan.json")
    document = json.loads(plan.read_text())
    document["mission"]["drones"][0]["limits"]["speed"] = 1.0
    plan.write_text(json.dumps(document))
    result = shotc("verify", "out/small/plan.json")
    assert result.code == 1
    (broken,) = [report for report in result.errors if report.code == "V001"]
    assert "at most 1 m/s is allowed" in broken.message
    before = {path.name: path.read_bytes() for path in plan.parent.iterdir()}
    assert shotc("emit", "out/small").code == 1
    assert {path.name: path.read_bytes() for path in plan.parent.iterdir()} == before


@pytest.mark.slow
def test_emit_writes_the_same_tables_again(shotc: Shotc) -> None:
    shotc(*PLAN, "small.yaml")
    assert shotc("emit", "out/small", "-o", "again", "--emit", "csv").code == 0
    assert sorted(path.name for path in Path("again").iterdir()) == ["framing.csv", "trajectory.csv"]
    for name in ("trajectory.csv", "framing.csv"):
        assert Path("again", name).read_bytes() == Path("out/small", name).read_bytes()


@pytest.mark.slow
def test_diff_tells_two_plans_apart(shotc: Shotc) -> None:
    shotc(*PLAN, "small.yaml", "-o", "old")
    Path("small.yaml").write_text(SMALL.replace("[0, -50, 15]", "[0, -50, 17]"))
    shotc(*PLAN, "small.yaml", "-o", "new")
    assert "the certificates say the same" in shotc("diff", "old", "old").out
    result = shotc("diff", "old", "new")
    assert result.code == 0
    assert "2.00 m" in result.out
