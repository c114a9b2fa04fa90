"""``shotc import show``: a mission, its pads and the show in one folder, or nothing."""

from __future__ import annotations

import re
from hashlib import sha256
from pathlib import Path

import numpy as np
import pytest

from tests.cli.conftest import Run
from tests.support.flight_files import zipped
from tests.support.recorded_shows import HEAD, PADS, csv_show, flown, tables


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def with_one_file(mission: Path) -> None:
    """Have a mission write next to nothing, which takes no time."""
    with mission.open("a") as stream:
        stream.write("output: {emit: [skyc]}\n")


def moved(text: str, seconds: float) -> str:
    """The rows of a table from a time on, as if they began then; none after 30 s."""
    rows = [row.split(",") for row in text.splitlines()[1:]]
    kept = [row for row in rows if 1e3 * seconds <= float(row[0]) <= 3e4]
    return "\n".join([HEAD, *(",".join([f"{float(t) - 1e3 * seconds:.0f}", *rest]) for t, *rest in kept)])


@pytest.mark.slow
def test_from_a_file_to_a_proved_plan(run: Run, tmp_path: Path) -> None:
    show, mission, out = tmp_path / "My show (1).zip", tmp_path / "new" / "show.yaml", tmp_path / "out"
    show.write_bytes(csv_show(flown(60.0), 60.0))
    made = run("import", "show", str(show), "-o", str(mission))
    assert made.code == 0, made.err
    assert "imported 9 drones; 0 assumptions" in made.err
    names = sorted(each.name for each in mission.parent.iterdir())
    assert names == ["My-show-1-pads.csv", "My-show-1.zip", "show.yaml"]
    pads = np.loadtxt(mission.parent / "My-show-1-pads.csv", delimiter=",", skiprows=1)
    assert pads == pytest.approx(np.array(PADS))
    assert run("check", str(mission)).code == 0
    with_one_file(mission)
    done = run("plan", str(mission), "-o", str(out))
    assert done.code == 0, done.err
    said = re.sub(r"\s+", " ", done.out)
    assert re.search(r"show flies its file from 0.00 s to 60.00 s, at its own times, within 0.0\d\d m", said)
    assert run("verify", str(out / "plan.json")).code == 0
    sealed = (out / "plan.json").read_text()
    assert sha256(show.read_bytes()).hexdigest() in sealed


@pytest.mark.slow
def test_a_show_that_begins_in_the_air_gets_a_grid_and_is_told(run: Run, tmp_path: Path) -> None:
    cut = {name: moved(text.decode(), 10.0).encode() for name, text in tables(flown()).items()}
    (tmp_path / "a.zip").write_bytes(zipped(cut))
    mission = tmp_path / "a.yaml"
    made = run("import", "show", str(tmp_path / "a.zip"), "-o", str(mission))
    assert made.code == 0
    assert "warning[I004]: a track begins 12.00 m high, on no pad" in made.err
    assert "grid: {spacing: 4 m" in mission.read_text()
    with_one_file(mission)
    done = run("plan", str(mission), "-o", str(tmp_path / "out"))
    assert done.code == 0, done.err


def test_pads_nearer_than_usual_are_told_and_strict_writes_nothing(run: Run, tmp_path: Path) -> None:
    near = {
        f"{i}.csv": f"{HEAD}\n0,{1.5 * i},0,0,0,0,0\n9000,{1.5 * i},0,9,0,0,0\n".encode() for i in range(3)
    }
    (tmp_path / "a.zip").write_bytes(zipped(near))
    mission = tmp_path / "a.yaml"
    made = run("import", "show", str(tmp_path / "a.zip"), "-o", str(mission), "--strict")
    assert (made.code, mission.exists()) == (1, False)
    made = run("import", "show", str(tmp_path / "a.zip"), "-o", str(mission))
    assert made.code == 0
    assert "tracks begin 1.50 m apart" in made.err
    assert "separation: 1.5 m" in mission.read_text()
    assert sorted(each.name for each in tmp_path.iterdir()) == ["a-pads.csv", "a.yaml", "a.zip"]


def test_drones_that_come_nearer_in_the_air_than_on_their_pads_are_told(run: Run, tmp_path: Path) -> None:
    rows = [
        [
            f"{time},{step * i},0,{up},0,0,0\n"
            for time, step, up in ((0, 4, 0), (9000, 2.25, 9), (18000, 4, 0))
        ]
        for i in range(3)
    ]
    near = {f"{i}.csv": (f"{HEAD}\n" + "".join(rows[i])).encode() for i in range(3)}
    (tmp_path / "a.zip").write_bytes(zipped(near))
    mission = tmp_path / "a.yaml"
    made = run("import", "show", str(tmp_path / "a.zip"), "-o", str(mission))
    assert made.code == 0
    assert "two drones come within 2.25 m of each other at 9.0 s, and 3.0 m are usual" in made.err
    assert "separation: 2.25 m" in mission.read_text()


@pytest.mark.parametrize(
    ("arguments", "code", "said"),
    [
        (("a.zip",), 2, "a show takes files beside it"),
        (("gone.zip", "-o", "a.yaml"), 1, "cannot be read: No such file"),
        (("a.txt", "-o", "a.yaml"), 1, "a show is zipped CSV"),
        (("bad.zip", "-o", "a.yaml"), 1, "bad.zip/Drone 1.csv:4"),
        (("under.zip", "-o", "a.yaml"), 1, "stands underground"),
    ],
)
def test_what_cannot_be_imported_is_told_and_nothing_is_written(
    run: Run, arguments: tuple[str, ...], code: int, said: str, folder: Path
) -> None:
    rows = f"{HEAD}\n0,0,0,0,0,0,0\n1000,0,0,9,0,0,0\n2000,0,0,0,0,0,0\n"
    Path("a.zip").write_bytes(zipped({"a.csv": rows.encode()}))
    Path("a.txt").write_bytes(b"hello")
    Path("bad.zip").write_bytes(zipped({"Drone 1.csv": rows.replace("2000,0", "2000,nan").encode()}))
    Path("under.zip").write_bytes(
        zipped({"a.csv": rows.replace("0,0,0,0,0,0,0\n1", "0,0,0,-5,0,0,0\n1").encode()})
    )
    done = run("import", "show", *arguments)
    assert done.code == code
    assert said in done.err
    assert not (folder / "a.yaml").exists()
