"""Shows that other tools made, flown as recorded: as near as is told, in their colours, within all limits."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from shotc.api import Compilation, PlanOptions, compile_source
from shotc.cli.show_facts import recorded
from shotc.geom.bernstein import Array
from shotc.geom.fleet_spline import places
from shotc.ir.fleet import FleetTrajectory
from shotc.ir.light_colors import light_colors
from shotc.show.emit.skyc import EMITTER as SKYC
from shotc.show.emit.zipped_csv import EMITTER as ZIPPED_CSV
from tests.support.compiled import compiled_text
from tests.support.flight_files import bomb, zipped
from tests.support.recorded_shows import (
    COUNT,
    HEAD,
    MISSION,
    csv_show,
    flown,
    planned,
    skyc_show,
    smooth,
    tables,
)

pytestmark = pytest.mark.slow

OWN = """\
shotc: 1
mission: own
fleets:
  swarm: {count: 9, layout: {grid: {spacing: 4, origin: [0, 0, 0]}}, model: show-drone, separation: 2}
shots:
  - id: two
    kind: display
    fleet: swarm
    frames:
      - {sphere: {center: [4, 4, 30], radius: 8}, color: orange, hold: 2}
      - {cube: {center: [4, 4, 30], size: 10}, color: "#0040ff", hold: 2}
output: {rate: 10 Hz}
"""


def flight(done: Compilation) -> FleetTrajectory:
    assert done.plan is not None, done.diagnostics
    (only,) = done.plan.trajectory.fleets
    return only


def stat(done: Compilation, name: str) -> float:
    assert done.plan is not None
    return float(dict(done.plan.trajectory.stats)[f"flight show {name}"])


def codes(done: Compilation) -> list[str]:
    return [each.code for each in done.diagnostics]


@pytest.mark.parametrize("emitter", [SKYC, ZIPPED_CSV], ids=["skyc", "zipped-csv"])
def test_what_we_write_is_flown_again_at_its_times_in_its_colours(emitter: object, tmp_path: Path) -> None:
    before = compiled_text(OWN)
    (file,) = emitter.emit(before.plan).artifacts  # type: ignore[attr-defined]
    again = planned(tmp_path, file.name, file.data)
    assert codes(again) == []
    one, other = flight(before), flight(again)
    assert stat(again, "longer s") == 0.0
    assert stat(again, "off m") < 0.03
    end = min(one.breaks[-1], other.breaks[-1])
    at = np.linspace(0.0, end, 3000)
    away = np.linalg.norm(places(one.breaks, one.coef, at) - places(other.breaks, other.coef, at), axis=2)
    # Half a millimetre of a table and of a show, and tenths where limits are kept.
    assert away.max() <= stat(again, "off m") + 2e-3
    lit = at[(at > 3.0) & (at < end - 3.0)]
    seen, wanted = (light_colors(each, lit).astype(int) for each in (other, one))
    assert np.abs(seen - wanted).max() <= 16 if emitter is ZIPPED_CSV else 6
    assert [phase.name for phase in other.phases] == ["takeoff", "shot", "land"]


@pytest.mark.long
def test_one_that_is_three_times_too_fast_takes_longer_on_the_same_ways(tmp_path: Path) -> None:
    legal = planned(tmp_path, "slow.zip", csv_show(flown(60.0), 60.0, 8.0))
    assert codes(legal) == []
    done = planned(tmp_path, "fast.zip", csv_show(flown(15.0), 15.0, 16.0))
    assert codes(done) == ["D154"]
    (told,) = done.diagnostics
    assert "descent is 6.0" in told.notes[0] or "descent is 5.9" in told.notes[0]
    track = flight(done)
    assert 15.0 < track.breaks[-1] < 45.0
    # Every formation of the flight is one of the file, all drones at one time of it.
    at = places(track.breaks, track.coef, np.linspace(0.0, track.breaks[-1], 400))
    file = flown(15.0)(np.linspace(0.0, 15.0, 6001))
    nearest = [np.linalg.norm(file - at[:, k : k + 1], axis=2).max(axis=0).min() for k in range(400)]
    assert max(nearest) <= stat(done, "off m") + 2e-3
    assert stat(done, "off m") < 0.15
    # Lights go by the clock of the drones: of the height at which a drone is, its colour follows.
    assert light_colors(track, np.array([track.breaks[-1]]))[3, 0].tolist() == [60, 200, 0]


@pytest.mark.parametrize(
    ("file", "made", "origin", "codes_told", "phases"),
    [
        ("a.zip", lambda: csv_show(flown(lean=1.0)), "[0, 0, 0]", ["D155", "D155"], 5),
        ("a.zip", lambda: csv_show(flown()), "[-20, 3, 0]", [], 5),
        ("a.skyc", lambda: skyc_show(flown()), "[0, 0, 0]", [], 3),
    ],
    ids=["leaning", "other pads", "a show of Skybrush"],
)
def test_the_fleet_takes_off_by_itself_where_the_file_has_no_way_straight_up(
    file: str, made: Callable[[], bytes], origin: str, codes_told: list[str], phases: int, tmp_path: Path
) -> None:
    done = planned(tmp_path, file, made(), origin=origin)
    assert [code for code in codes(done) if code != "D154"] == codes_told
    track = flight(done)
    assert len(track.phases) == phases
    if phases == 5:
        begin = np.array([track.phases[2].start])
        high = places(track.breaks, track.coef, begin)[:, 0]
        first = flown(lean=1.0 if codes_told else 0.0)(np.array([stat(done, "from s")]))[:, 0]
        away = np.linalg.norm(first[None] - high[:, None], axis=2)
        assert away.min(axis=1) == pytest.approx(np.zeros(COUNT), abs=2e-3)
        assert sorted(away.argmin(axis=1)) == list(range(COUNT))


@cache
def good() -> dict[str, bytes]:
    return tables(flown())


def first_rows() -> list[str]:
    return good()["Drone 1.csv"].decode().splitlines()


def spoilt(**changes: str) -> bytes:
    first = "\n".join(first_rows()[: int(changes.get("cut", "1000"))])
    for old, new in changes.items():
        first = first.replace(old, new) if old != "cut" else first
    return zipped({**good(), "Drone 1.csv": first.encode()})


def jumping() -> bytes:
    rows = [row.split(",") for row in first_rows()]
    for row in rows[80:]:
        row[1] = str(float(row[1]) + 90.0)
    return zipped({**good(), "Drone 1.csv": "\n".join(map(",".join, rows)).encode()})


def waiting() -> bytes:
    rows = [row.split(",") for row in first_rows()[1:]]
    flat = "\n".join([HEAD, *(",".join([row[0], row[1], row[2], "0", *row[4:]]) for row in rows)])
    return zipped({**good(), "Drone 1.csv": flat.encode()})


def show_of(change: object) -> bytes:
    return skyc_show(flown(), trajectory=change)


BAD: dict[str, tuple[str, Callable[[], bytes], str, str]] = {
    "cut short": ("a.zip", lambda: csv_show(flown())[:900], "N009", "breaks off: after 900 bytes"),
    "no archive": ("a.zip", lambda: b"hello" * 100, "N009", "no ZIP archive"),
    "empty": ("a.skyc", lambda: b"", "N009", "empty"),
    "a bomb": ("a.zip", lambda: bomb("a.csv"), "D150", "larger than 200 MB"),
    "no table": ("a.zip", lambda: zipped({"read me.txt": b"hello"}), "D150", "without a CSV file"),
    "no show": ("a.skyc", lambda: zipped({"read me.txt": b"hello"}), "D150", "without `show.json`"),
    "lacks a column": (
        "a.zip",
        lambda: zipped({**good(), "Drone 1.csv": b"0,0,0\n1000,0,0\n"}),
        "D150",
        "a.zip/Drone 1.csv, line 1",
    ),
    "not a number": (
        "a.zip", lambda: spoilt(**{"\n1000,0.000": "\n1000,nan"}), "D150", "Drone 1.csv, line 6",
    ),
    "out of order": ("a.zip", lambda: spoilt(**{"\n1250,": "\n250,"}), "D150", "0.25 s, does not come after"),
    "ends in the air": ("a.zip", lambda: spoilt(cut="60"), "D150", "ends at 14.5 s"),
    "a drone too few": ("a.zip", lambda: zipped(dict(list(good().items())[1:])), "D151", "write `count: 8`"),
    "a jump": ("a.zip", jumping, "D153", "`Drone 1.csv` of `a.zip` jumps at 19."),
    "stays on the ground": ("a.zip", waiting, "D152", "`Drone 1.csv` never comes 2.25 m above the ground"),
    "times of a show that fall": (
        "a.skyc",
        lambda: show_of(
            {"version": 1, "points": [[0, [0, 0, 0], []], [2, [0, 0, 9], []], [1, [0, 0, 0], []]]}
        ),
        "D150",
        "points[2]`, 1 s, does not come after 2 s",
    ),
    "a curve of no degree": (
        "a.skyc",
        lambda: show_of({"version": 1, "points": [[0, [0, 0, 0], []], [9, [0, 0, 9], [[0, 0, 1]] * 5]]}),
        "D150",
        "no line, quadratic or cubic",
    ),
    "a part that is not there": (
        "a.skyc", lambda: show_of({"$ref": "./gone.json#"}), "D150", "without `gone.json`",
    ),
    "a light that is none": (
        "a.skyc",
        lambda: skyc_show(flown(), lights={"version": 1, "data": "BAEC"}),
        "D150",
        "breaks off after 3 bytes",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", BAD)
def test_what_is_wrong_with_a_file_is_told_with_its_place_and_a_way_out(name: str, tmp_path: Path) -> None:
    file, made, code, said = BAD[name]
    done = planned(tmp_path, file, made())
    (told,) = done.diagnostics
    assert told.code == code
    assert said in " ".join([told.message, *told.notes, told.help])
    assert told.labels
    assert told.help


@pytest.mark.parametrize(("plain", "slope"), [(40.0, 0.0), (-30.0, 0.0), (15.0, 0.2)])
def test_a_fleet_takes_off_and_lands_on_the_ground_wherever_that_is(
    plain: float, slope: float, tmp_path: Path
) -> None:
    """Every drone rises 12 m over its own pad; the ground rises by so much a metre to the East."""
    posts = [(x, y) for x in range(-100, 101, 20) for y in range(-100, 101, 20)]
    relief = "".join(f"{x},{y},{plain + slope * x}\n" for x, y in posts)
    (tmp_path / "relief.csv").write_text("x,y,z\n" + relief)

    def over(times: Array) -> Array:
        at = flown(60.0, turn=0.0)(times).copy()
        at[..., 2] += plain + slope * at[:, :1, 0]
        return at

    (tmp_path / "a.zip").write_bytes(csv_show(over, 60.0))
    text = MISSION.format(count=COUNT, origin="[0, 0]", file="a.zip")
    text += "world: {terrain: {file: relief.csv}}\n"
    done = compile_source(text.encode(), "again.yaml", tmp_path, PlanOptions())
    assert codes(done) == []
    track = flight(done)
    assert [phase.name for phase in track.phases] == ["takeoff", "shot", "land"]
    assert (stat(done, "from s"), stat(done, "to s")) == (0.0, 60.0)
    for when in (track.phases[0].end, track.phases[-1].start):
        at = places(track.breaks, track.coef, np.array([when]))[:, 0]
        high = at[:, 2] - plain - slope * at[:, 0]
        assert 2.25 <= high.min() < 6.0


def test_another_ending_is_told_by_check(tmp_path: Path) -> None:
    (told,) = planned(tmp_path, "show.7z", b"7z").diagnostics
    assert (told.code, told.help) == ("D011", "give a file that ends in .zip or .skyc")


def test_music_that_no_longer_fits_is_told(tmp_path: Path) -> None:
    (tmp_path / "a.zip").write_bytes(csv_show(flown(15.0), 15.0))
    text = MISSION.format(count=COUNT, origin="[0, 0, 0]", file="a.zip") + "music: {tempo: 120}\n"
    (told,) = compile_source(text.encode(), "again.yaml", tmp_path, PlanOptions()).diagnostics
    assert told.code == "D154"
    assert "the music keeps its own time" in told.notes[-1]


def passing(times: Array) -> Array:
    """Two drones change places, straight at each other, and back."""
    at = flown(60.0)(times).copy()
    one, other = at[0].copy(), at[1].copy()
    share = smooth((times - 20.0) / 12.0) * (1.0 - smooth((times - 34.0) / 12.0))
    at[0] = one + (other - one) * share[:, None]
    return at


def test_drones_that_come_too_near_are_moved_apart_in_the_air_alone(tmp_path: Path) -> None:
    done = planned(tmp_path, "a.zip", csv_show(passing, 60.0))
    assert codes(done) == []
    assert done.plan is not None
    assert dict(done.plan.trajectory.stats)["fleet swarm apart moved"] == 2.0
    facts = " ".join(recorded(done.plan.trajectory.stats))
    assert re.search(r"within (0\.[5-9]|1\.)\d+ m of every track; 2 are moved so that all stay apart", facts)


def test_drones_that_stand_too_near_are_named(tmp_path: Path) -> None:
    close = Path(tmp_path) / "a.zip"
    close.write_bytes(csv_show(flown(60.0), 60.0))
    text = MISSION.format(count=COUNT, origin="[0, 0, 0]", file="a.zip").replace(
        "separation: 2", "separation: 4.5"
    )
    done = compile_source(text.encode(), "again.yaml", tmp_path, PlanOptions())
    assert set(codes(done)) == {"D156"}
    told = done.diagnostics[0]
    assert "within 4.00 m of each other" in told.message
    assert "`swarm-1` and `swarm-2`" in told.notes[0]
    assert "a separation of 4.00 m" in told.help


def test_effects_are_laid_over_its_lights(tmp_path: Path) -> None:
    (tmp_path / "a.zip").write_bytes(csv_show(flown()))
    text = MISSION.format(count=COUNT, origin="[0, 0, 0]", file="a.zip")
    text = text.replace("flight: a.zip}", "flight: a.zip}, effects: [{fade: {to: black, time: 2 s}}]")
    done = compile_source(text.encode(), "again.yaml", tmp_path, PlanOptions())
    track = flight(done)
    end = track.phases[-1].end - 0.1
    assert light_colors(track, np.array([end / 2]))[4, 0].astype(int) == pytest.approx([80, 100, 0], abs=3)
    assert light_colors(track, np.array([end]))[4, 0].astype(int) == pytest.approx([0, 0, 0], abs=10)


def test_drones_pushed_apart_rise_and_land_straight_over_their_pads_as_recorded(tmp_path: Path) -> None:
    """They come to 1.92 m in the air, and 2 m is asked for; nothing parts the way there from the rise."""
    middle = np.array([4.0, 4.0])

    def nearer(at: Array) -> Array:
        recorded = flown(80.0, turn=np.pi / 2)(at)
        share = smooth(np.minimum(at - 7.0, 73.0 - at) / 15.0)[:, None]
        recorded[..., :2] = middle + (1.0 - 0.52 * share) * (recorded[..., :2] - middle)
        return recorded

    done = planned(tmp_path, "near.zip", csv_show(nearer, 80.0))
    assert codes(done) == []
    found = flight(done)
    up, down = found.phases[0].end, found.phases[-1].start
    at = np.array([*np.linspace(0.0, up, 50), *np.linspace(down, found.breaks[-1], 50)])
    low = places(found.breaks, found.coef, at)[..., :2]
    np.testing.assert_allclose(low[:, :50], np.repeat(low[:, :1], 50, axis=1), atol=1e-9)
    np.testing.assert_allclose(low[:, 50:], np.repeat(low[:, -1:], 50, axis=1), atol=1e-9)
