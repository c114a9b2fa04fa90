"""What resolve finds in the files that a mission names: tracks and routes."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.support.front_passes import resolved
from tests.support.resolve_missions import FIRST, at, faults, mission, only, span


def test_files_stay_in_the_missions_folder(tmp_path: Path) -> None:
    inside, outside = tmp_path / "mission", tmp_path / "secret.csv"
    (inside / "deep").mkdir(parents=True)
    outside.write_text("x,y,z\n0,-50,10\n40,-50,10\n")
    (inside / "link.csv").symlink_to(outside)
    (inside / "up").symlink_to(tmp_path)
    (inside / "loop.csv").symlink_to("loop.csv")
    (inside / "deep" / "own.csv").write_text(outside.read_text())
    (inside / "inner.csv").symlink_to("deep/own.csv")

    def by(name: str) -> list[str]:
        shot = f"id: a, kind: follow-path, file: {name}, heading: along"
        return [d.code for d in resolved(mission(shot), inside)[1]]

    assert by("link.csv") == ["N010"]
    assert by("up/secret.csv") == ["N010"]
    assert by("loop.csv") == ["N008"]
    assert by("deep") == ["N008"]
    assert by("none.csv") == ["N008"]
    assert by("deep/own.csv") == by("inner.csv") == []
    assert [d.code for d in resolved(mission("id: a, kind: follow-path, file: deep/own.csv"), None)[1]] == [
        "N008"
    ]


def test_a_missing_file_proposes_its_neighbours(tmp_path: Path) -> None:
    (tmp_path / "rout.csv").write_text("")
    d = only(mission("id: a, kind: follow-path, file: route.csv"), tmp_path)
    assert "`rout.csv`" in d.help


def test_a_bad_line_of_a_file_is_named(tmp_path: Path) -> None:
    (tmp_path / "r.csv").write_text("x,y,z\n0,-50,10\n0,oops,10\n")
    text = mission("id: a, kind: follow-path, file: r.csv")
    d = only(text, tmp_path)
    assert (d.code, d.notes) == ("N009", ("r.csv, line 3",))
    assert "`oops` is not a number for `y`" in d.message
    line = text.splitlines()[FIRST - 1]
    assert span(d)[:2] == (FIRST, line.index("r.csv") + 1)


@pytest.mark.parametrize(
    ("rows", "says"),
    [
        ("t,x,y,z\n0,0,0,1\n", "two rows"),
        ("t,x,y,z\n0,0,0,1\n1,1,0,1\n1,2,0,1\n", "do not rise"),
        ("t,x\n0,0\n", "other columns"),
        ("t,x,y,z,heading\n0,0,0,1,0\n1,0,0,nan,0\n", "out of bounds"),
    ],
)
def test_tracks_are_checked_though_they_cannot_be_planned(tmp_path: Path, rows: str, says: str) -> None:
    (tmp_path / "t.csv").write_text(rows)
    text = mission(at(0, -50, 10)).replace(
        "drones:", "  runner: {track: {file: t.csv}, radius: 0.4, height: 1.8}\ndrones:"
    )
    d = only(text, tmp_path)
    assert (d.code, says in d.message) == ("N009", True)
    (tmp_path / "t.csv").write_text("t,x,y,z\n0,0,0,1\n9,5,0,1\n")
    assert faults(text, tmp_path) == []
