"""Zipped CSV from elsewhere, good and broken: each fault is told with its table and its line."""

from __future__ import annotations

from zipfile import ZIP_LZMA

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from shotc.diag.registry import has_errors
from shotc.importers.flights import zipped as reader
from shotc.importers.flights.read import read
from shotc.ir.trajectory import VerifiedIR
from shotc.show.emit.zipped_csv import EMITTER
from tests.support.flight_files import bomb, verified, zipped
from tests.support.show_plans import fleet, mission, plan

HEAD = "Time [msec],x [m],y [m],z [m],Red,Green,Blue"
MISSION = """\
shotc: 1
mission: show
fleets:
  swarm: {count: 4, layout: {grid: {spacing: 4, origin: [0, 0, 0]}}, model: show-drone,
          separation: {horizontal: 1 m, vertical: 2 m}, limits: {speed: 8 m/s, climb: 6 m/s, descent: 5 m/s}}
shots:
  - {id: globe, kind: display, fleet: swarm, frames: [{sphere: {center: [6, 20, 30], radius: 6}, hold: 4}]}
"""


def rows(z: float = 10.0, x: float = 0.0) -> str:
    return f"{HEAD}\n0,{x},0,0,0,0,0\n4000,{x},0,{z},255,0,0\n8000,{x},0,0,0,0,0\n"


GOOD = {"swarm-1.csv": rows(), "swarm-2.csv": rows(x=4.0)}
"""Two drones that go up and down."""
BROKEN: dict[str, tuple[dict[str, str], str, str, int, str]] = {
    "no table": ({"read me.txt": "hello"}, "I009", "", 1, "without a CSV file"),
    "an empty table": ({**GOOD, "b.csv": ""}, "I008", "b.csv", 1, "it is empty"),
    "a picture": ({**GOOD, "b.csv": "\x89PNG\0\0"}, "I008", "b.csv", 1, "no text"),
    "only a head": ({**GOOD, "b.csv": HEAD}, "I010", "b.csv", 1, "no row"),
    "another table": ({**GOOD, "b.csv": "lat,lon\n1,2\n3,4\n"}, "I009", "b.csv", 1, "no row, and names no"),
    "one row": ({**GOOD, "b.csv": "0,0,0,0\n"}, "I010", "b.csv", 1, "one row"),
    "out of order": (
        {**GOOD, "b.csv": f"{HEAD}\n0,0,0,0,0,0,0\n4000,0,0,9,0,0,0\n3000,0,0,0,0,0,0\n"},
        "I010",
        "b.csv",
        4,
        "3 s, does not come after",
    ),
    "not a number": (
        {**GOOD, "b.csv": rows().replace(",10.0,", ",nan,")}, "I010", "b.csv", 3, "column 4 is `nan`",
    ),
    "a word": ({**GOOD, "b.csv": rows().replace(",10.0,", ",high,")}, "I010", "b.csv", 3, "`high`"),
    "a short row": ({**GOOD, "b.csv": "0,0,0,0\n1000,0,0\n"}, "I010", "b.csv", 2, "column 4"),
    "too bright": ({**GOOD, "b.csv": rows().replace("255", "256")}, "I010", "b.csv", 3, "red is 256"),
    "below black": ({**GOOD, "b.csv": rows().replace("255", "-1")}, "I010", "b.csv", 3, "red is -1"),
    "half a level": ({**GOOD, "b.csv": rows().replace("255", "0.5")}, "I010", "b.csv", 3, "red is 0.5"),
    "twice a drone": (
        {**GOOD, "more/swarm-1.csv": rows()}, "I010", "more/swarm-1.csv", 1, "`swarm-1.csv` is the flight",
    ),
    "a table that ends in the air": (
        {**GOOD, "b.csv": f"{HEAD}\n0,0,0,0,0,0,0\n4000,0,0,9,0,0,0\n"},
        "I010",
        "b.csv",
        3,
        "ends at 4 s, 9.0 m over where it begins, and `swarm-1.csv` at 8 s",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", BROKEN)
def test_each_is_told_with_its_table_and_line(name: str) -> None:
    files, code, member, line, said = BROKEN[name]
    data = zipped({name: text.encode("latin-1") for name, text in files.items()})
    report = verified(("show.zip", data), text=MISSION)
    (told,) = report.diagnostics
    assert (told.code, told.labels[0].span.line) == (code, line)
    assert told.labels[0].file == (f"show.zip/{member}" if member else "show.zip")
    assert said in told.message
    assert not report.holds


@pytest.mark.slow
def test_a_bomb_is_not_unpacked() -> None:
    assert len(bomb("a.csv")) < 2_000_000
    (told,) = verified(("show.zip", bomb("a.csv")), text=MISSION).diagnostics
    assert (told.code, "larger than 200 MB" in told.message) == ("I008", True)


@pytest.mark.parametrize(
    ("data", "said"),
    [
        (b"", "a broken archive"),
        (zipped({"a.csv": b"0,0,0,0\n"})[:40], "a broken archive"),
        (zipped({"a.csv": b"0,0,0,0\n"}, ZIP_LZMA), "packed in a way"),
    ],
    ids=["empty", "cut short", "another packing"],
)
def test_what_is_no_archive_is_told(data: bytes, said: str) -> None:
    (told,) = verified(("show.zip", data), text=MISSION).diagnostics
    assert told.code == "I008"
    assert said in told.message


@pytest.mark.slow
@settings(max_examples=60, deadline=None)
@given(data=st.data())
def test_no_bytes_make_a_traceback(data: st.DataObject) -> None:
    spoilt = bytearray(zipped({name: text.encode() for name, text in GOOD.items()}, 0))
    for _ in range(data.draw(st.integers(1, 4))):
        at = data.draw(st.integers(0, len(spoilt) - 1))
        spoilt[at : at + data.draw(st.integers(0, 3))] = data.draw(st.binary(max_size=3))
    report = verified(("show.zip", bytes(spoilt)), text=MISSION)
    assert report.holds != has_errors(report.diagnostics)
    assert all(each.labels and each.message for each in report.diagnostics)


def squared() -> VerifiedIR:
    """The show of the mission's pads."""
    pads = tuple((4.0 * (i % 2), 4.0 * (i // 2), 0.0) for i in range(4))
    return plan(mission(fleets=(fleet(pads),)))


def test_what_we_write_is_read_and_holds() -> None:
    (file,) = EMITTER.emit(squared()).artifacts
    report = verified((file.name, file.data), text=MISSION)
    assert report.holds, report.diagnostics
    assert {claim.subject for claim in report.certificate} == {"swarm"}
    assert "separation" in {claim.constraint for claim in report.certificate}


def test_drones_of_other_names_are_those_on_whose_pads_they_stand() -> None:
    (file,) = EMITTER.emit(squared()).artifacts
    tables = {f"Drone {i}.csv": "\n".join(each.lines).encode() for i, each in enumerate(read_rows(file.data))}
    assert verified(("show.zip", zipped(tables)), text=MISSION).holds
    aside = {name: text.replace(b",0.000,", b",30.000,") for name, text in tables.items()}
    (told, *_) = verified(("show.zip", zipped(aside)), text=MISSION).diagnostics
    assert told.code == "I013"


def test_a_broken_limit_is_told_in_the_table() -> None:
    (file,) = EMITTER.emit(squared()).artifacts
    slow = MISSION.replace("climb: 6 m/s", "climb: 2 m/s")
    report = verified(("show.zip", file.data), text=slow)
    (told,) = report.diagnostics
    assert told.labels[0].file.startswith("show.zip/swarm-")
    lines = report.sources[told.labels[0].file].text.splitlines()
    assert lines[told.labels[0].span.line - 1].count(",") == 6


def read_rows(data: bytes) -> tuple[reader.DroneRows, ...]:
    found = read(data, "show.zip").content
    assert isinstance(found, tuple)
    assert all(np.isfinite(rows.place).all() for rows in found)
    return found
