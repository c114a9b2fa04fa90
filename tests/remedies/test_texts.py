"""Helps about faults of the text, which stop the reading of a mission: each is done in its example."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import pytest

from shotc.diag.registry import registry
from tests.support.front_passes import placed
from tests.support.remedies.with_files import WAY
from tests.unit.diag.test_examples import unescaped


class Case(NamedTuple):
    """A code, a part of its help, and what is written for what in the example; None writes the good one."""

    code: str
    said: str
    edits: tuple[tuple[str, str], ...] | None


def case(code: str, said: str, *edits: tuple[str, str]) -> Case:
    return Case(code, said, edits or None)


DEEP = registry()["Y004"].failing.partition("target: tower, at: ")[2].strip()
CASES = [
    case("Y001", "save the file as UTF-8", ("\\xe9", "\\xc3\\xa9")),
    case("Y002", "delete it", ("\\x00", "")),
    case("Y004", "a mission needs less than 12 levels", (DEEP, "[0, -50, 15], look_at: tower}")),
    case("Y006", "write values out"),
    case("Y007", "delete it", ("]}}", "]}")),
    case(
        "Y007",
        "add what it should close",
        ("cam1: {model", "cam1: {limits: {speed: 5 m/s}, model"),
        ("]}}", "]}"),
    ),
    case("Y008", "indent with spaces", ("\tcam1", "  cam1")),
    case("Y009", "indent the keys of one mapping alike", ("   wind: 3\n", "world:\n  wind: 3\n")),
    case("Y010", "add the ']'", ("[0, -60, 0}", "[0, -60, 0]}")),
    case("Y011", 'put the value in quotes: "@look"', ("@look", '"@look"')),
    case("Y012", "keep one of the two", ("mission: again\n", "")),
    case("Y013", "delete the tag", ("!!python/name:os.system ", "")),
    case("Y014", "in a file of its own", ("---\n", "\x00")),
    case("Y015", "begin with 'shotc: 1' and 'mission: NAME'"),
    case("Y016", "begin with 'shotc: 1' and 'mission: NAME'"),
    case("Y017", "write the keys out", ("<<: {model: x500}", "model: x500")),
    case(
        "Y018",
        'write it in quotes: "7"',
        ("  7:", '  "7":'),
        ("target: 7", 'target: "7"'),
        ("look_at: 7", 'look_at: "7"'),
    ),
    case("Y019", "write the key as text", ("{{ key }}", "mission")),
    case("Y020", "quote the value", ("*look", "'look'")),
    case("Y021", "write out what is meant", ("*drone", "x500")),
]


@pytest.mark.parametrize("case", CASES, ids=[f"{case.code}-{i}" for i, case in enumerate(CASES)])
def test_what_a_help_proposes_makes_the_text_a_mission(case: Case) -> None:
    info = registry()[case.code]
    (fault,) = placed(unescaped(info.failing))[1]
    assert case.said in (fault.help or "")
    text = info.failing if case.edits is not None else info.passing
    for old, new in case.edits or ():
        assert old in text
        text = text.partition(old)[0] if new == "\x00" else text.replace(old, new, 1)
    assert placed(unescaped(text))[1] == []


@pytest.mark.long
@pytest.mark.slow
def test_values_in_a_file_of_their_own_are_not_too_many(tmp_path: Path) -> None:
    """A track of more rows than a mission may have values is named, as the help says."""
    rows = [(t / 100.0, t / 100.0) for t in range(45_000)]
    head = "shotc: 1\nmission: run\ndrones: {cam: {model: x500, home: [0, -30, 0]}}\nshots:\n"
    shot = (
        "  - {id: side, kind: lateral, drone: cam, target: runner, side: left, distance: 8, altitude: 4,\n"
        "     timing: {start: 15, duration: 10}}\n"
    )
    points = ", ".join(f"[{x:g}, 0, 0.9]" for _, x in rows)
    times = ", ".join(f"{t:g}" for t, _ in rows)
    runner = "targets: {runner: {track: TRACK, radius: 0.4, height: 1.8}}\n"
    written = head + shot + runner.replace("TRACK", f"{{points: [{points}], times: [{times}]}}")
    (fault,) = placed(written, tmp_path)[1]
    assert (fault.code, fault.help) == (
        "Y005",
        "keep long tracks and points in CSV files and name them in the mission",
    )
    table = "t,x,y,z\n" + "".join(f"{t:g},{x:g},0,0.9\n" for t, x in rows)
    (tmp_path / "run.csv").write_text(table)
    assert placed(head + shot + runner.replace("TRACK", "{file: run.csv}"), tmp_path)[1] == []


def test_a_file_put_into_the_folder_of_its_mission_is_read(tmp_path: Path) -> None:
    folder, route = tmp_path / "mission", b"x,y,z\n0,0,8\n9,0,8\n"
    folder.mkdir()
    (tmp_path / "way.csv").write_bytes(route)
    (folder / "way.csv").symlink_to(tmp_path / "way.csv")
    (fault,) = placed(WAY, folder)[1]
    assert (fault.code, fault.help) == ("N010", "put the file into the mission's folder")
    (folder / "way.csv").unlink()
    (folder / "way.csv").write_bytes(route)
    assert placed(WAY, folder)[1] == []
