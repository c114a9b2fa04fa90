"""What the command line prints and writes of a show's plan."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from shotc.cli.summary import WIDTH_CHARACTERS, summary
from shotc.emit.plan_json import EMITTER
from shotc.ir.keyframes import Lowered
from shotc.ir.trajectory import VerifiedIR
from shotc.source.file import SourceFile
from tests.cli.conftest import Run
from tests.support.show_plans import PADS, display, fleet, mission, plan


def written(folder: Path, made: VerifiedIR) -> Path:
    folder.mkdir()
    path = folder / "plan.json"
    path.write_bytes(EMITTER.emit(made).artifacts[0].data)
    return path


def lowered(made: VerifiedIR) -> Lowered:
    return Lowered(made.trajectory.keyframes, (), SourceFile("show.yaml", ""))


@pytest.fixture
def show(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A plan made by hand; the mission that it would be lowered from is the one that it was made with."""
    made = plan()
    monkeypatch.setattr("shotc.api.lower_kept", lambda *_: lowered(made))
    return written(tmp_path / "out", made)


def test_verify_names_the_worst_drone_of_every_claim(run: Run, show: Path) -> None:
    done = run("verify", str(show))
    assert done.code == 0
    assert "swarm, whole flight" in done.out
    assert "swarm, shot globe" in done.out
    (line,) = (text for text in done.out.splitlines() if " separation " in text)
    assert line.split() == [
        "ok",
        "separation",
        ">=",
        "1.150",
        "m",
        "4.000",
        "m",
        "0:01.0",
        "every",
        "instant,",
        "swarm-1",
        "and",
        "swarm-2",
    ]
    assert "27 requirements proved again" in done.out
    as_json = json.loads(run("verify", str(show), "--format", "json").out)
    assert as_json["holds"]
    assert as_json["certificate"][-1]["drones"] == ["swarm-1", "swarm-2"]


def test_verify_tells_which_drones_come_too_near(run: Run, show: Path) -> None:
    document = json.loads(show.read_text())
    document["fleets"][0]["coef"][1][8:13] = [[0.5, 20.0, 30.0]] * 5
    show.write_text(json.dumps(document))
    done = run("verify", str(show))
    assert done.code == 1
    assert (
        "error[V022]: swarm-1 and swarm-2 of swarm: separation is 0.500 m, at least 1.150 m is needed"
        in done.err
    )
    assert "BROKEN  separation" in done.out


def test_emit_writes_the_table_and_says_what_is_for_cameras(run: Run, show: Path) -> None:
    before = show.read_bytes()
    done = run("emit", str(show), "--emit", "csv,mavlink,storyboard", "-o", "tables")
    assert done.code == 1
    assert done.err.count("error[E114]") == 2
    assert sorted(path.name for path in Path("tables").iterdir()) == ["framing.csv", "trajectory.csv"]
    assert done.err.count("drones that follow theirs would meet") == 1
    assert show.read_bytes() == before


def test_diff_of_shows(run: Run, show: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    same = run("diff", str(show), str(show))
    assert "the certificates say the same" in same.out
    assert "same path" in same.out
    few = plan(mission(fleets=(fleet(PADS[:3]),)))
    fewer = written(tmp_path / "fewer", few)
    in_turn = iter([lowered(plan()), lowered(few)])
    monkeypatch.setattr("shotc.api.lower_kept", lambda *_: next(in_turn))
    done = run("diff", str(show), str(fewer))
    assert done.code == 0
    assert "swarm  4 -> 3  46.00 s" in done.out
    assert "drones apart" in done.out


def test_the_summary_of_a_thousand_drones_is_a_screen() -> None:
    pads = tuple((4.0 * i, 4.0 * j, 0.0) for i in range(40) for j in range(25))
    made = plan(mission(fleets=(fleet(pads),)))
    text = summary(made, [Path("out/show/plan.json"), Path("out/show/trajectory.csv")], ["a note"])
    lines = text.splitlines()
    assert len(lines) <= 24
    assert max(map(len, lines)) <= WIDTH_CHARACTERS
    assert lines[0] == "show: 1 display of 1000 drones, 0:46.0 in the air, planned and proved"
    assert "swarm (1000 drones)" in text
    assert "come nearest, 4.000 m, 1.150 m needed" in text
    assert "27 requirements hold" in text


def test_the_summary_of_several_fleets_names_each() -> None:
    other = fleet(tuple((x, y + 60.0, z) for x, y, z in PADS), "crowd")
    both = mission(fleets=(fleet(), other), displays=(display(), display("ring", "crowd", 1)))
    text = summary(plan(both), [Path("out/show/plan.json")], [])
    assert text.startswith("show: 2 displays of 8 drones")
    assert "swarm-1 and swarm-2 come nearest" in text
    assert "crowd-1 and crowd-2 come nearest" in text
    assert text.count("come nearest") == 3
