"""Flights with a clock: tables of trajectories and shows, proved between their rows and key points."""

from __future__ import annotations

import json
from collections.abc import Callable
from io import BytesIO
from typing import Any
from zipfile import ZipFile

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from shotc.emit.csv_table import EMITTER as CSV
from shotc.flightfiles.clocked import of_rows
from shotc.geom.bernstein import Piecewise
from shotc.geom.bspline import restrict
from shotc.geom.fleet_spline import pieces as spline_pieces
from shotc.geom.meetings import closest_of
from shotc.geom.separation import closest
from shotc.importers.flights.rows import rows as rows_of
from shotc.ir.limits import Limits
from shotc.ir.passes import PassContext
from shotc.ir.show import Apart
from shotc.passes.verify import Verify
from tests.experiments.planted import FLEET, KINDS, LONGEST_S, cruise, show, table
from tests.support.film_plans import orbit_plan, orbit_text
from tests.support.flight_files import MISSION, claims, codes, verified, zipped

Drones = list[dict[str, Any]]
LIMITS = "{speed: 8, climb: 3, descent: 3, acceleration: 300, jerk: 90000}"
TEXT = MISSION.replace("limits: {speed: 8 m/s, climb: 3 m/s, descent: 2 m/s}", f"limits: {LIMITS}")
GENTLE = FLEET.format(zones="", limits=LIMITS)
FLIGHT = cruise((0.0, -60.0, 0.0), 12.0, 5.0, 8.0)


def swarm(count: int = 4) -> bytes:
    pads = ((0.0, 0.0), (4.0, 0.0), (0.0, 4.0), (4.0, 4.0))[:count]
    return show([cruise((x, y, 0.0), 12.0, 2.0, 8.0) for x, y in pads])


@pytest.mark.slow
def test_our_own_table_holds_with_what_its_shots_show() -> None:
    """The rows of a plan that holds: limits, the world, and the target in the frame of every shot."""
    proved = Verify().run(orbit_plan().trajectory, PassContext()).value
    assert proved is not None
    made = CSV.emit(proved).artifacts[0]
    report = verified((made.name, made.data), text=orbit_text())
    assert (report.holds, codes(report)) == (True, [])
    plan = {(c.shot, c.constraint): c for c in proved.certificate}
    for name in ("tower in frame", "tower screen error", "tower size smallest", "tower visible"):
        (own,) = claims(report, name)
        assert own.worst == pytest.approx(plan["half", name].worst, abs=2e-3), name
    (low,) = claims(report, "ground clearance")
    assert low.worst == pytest.approx(plan[None, "ground clearance"].worst, abs=1e-4)


def test_other_columns_are_refused_with_those_that_are_wanted() -> None:
    report = verified(("all.csv", b"time,px,py,pz\n0,0,0,0\n"), text=TEXT)
    assert codes(report) == ["I009"]
    assert "`t_s`, `x_m`, `y_m`, `z_m`" in report.diagnostics[0].message
    assert "t_s,drone,x_m,y_m,z_m,vx_m_s" in report.diagnostics[0].help


def test_rows_without_velocities_are_straight_lines() -> None:
    text = "t_s,x_m,y_m,z_m\n0,0,-60,0\n5,0,-60,10\n15,60,-60,10\n"
    report = verified(("flight.csv", text.encode()), text=TEXT)
    assert (report.holds, codes(report)) == (True, [])
    assert claims(report, "speed")[0].worst == pytest.approx(6.0)
    assert claims(report, "climb")[0].worst == pytest.approx(2.0)
    assert claims(report, "acceleration") == []
    notes = " ".join(report.notes)
    assert "straight from row to row" in notes
    assert "not judged: the acceleration" in notes
    assert codes(verified(("flight.csv", text.replace("15,60", "10,60").encode()), text=TEXT)) == ["V001"]


def test_accelerations_are_at_least_what_velocities_tell() -> None:
    hard = TEXT.replace("acceleration: 300", "acceleration: 3")
    report = verified(("cam1.csv", table({"cam1": FLIGHT})), text=hard)
    assert codes(report) == ["V002"]
    assert claims(report, "acceleration")[0].worst == pytest.approx(5.0 / 0.25, rel=1e-6)


def test_shots_are_aligned_by_the_times_that_the_mission_fixes() -> None:
    """A camera that looks at a mast has it in frame in a shot from 8 to 12 s; one that looks down has not."""
    mast = "targets:\n  mast: {at: [200, -60, 12], radius: 1, height: 4}\nshots:"
    shot = "  - {id: wide, kind: static, drone: cam1, target: mast, at: [10, -60, 12], look_at: mast,\n"
    shot += "     timing: {start: 8, duration: 4}, require: {in_frame: 100 %}}\n"
    text = TEXT[: TEXT.index("shots:")] + mast + "\n" + shot
    head, *lines = table({"cam1": FLIGHT}).decode().splitlines()
    for pitch, expected in ((0.0, []), (-1.2, ["V019"])):
        wide = [f"{head},cam_yaw_rad,cam_pitch_rad", *(f"{line},0,{pitch}" for line in lines), ""]
        report = verified(("cam1.csv", "\n".join(wide).encode()), text=text)
        assert codes(report) == expected
        assert claims(report, "mast in frame")[0].shot == "wide"
    blind = verified(("cam1.csv", table({"cam1": FLIGHT})), text=text)
    assert any("in_frame of shot `wide`" in note for note in blind.notes)
    open_ = text.replace("timing: {start: 8, duration: 4}, ", "")
    untold = verified(("cam1.csv", "\n".join(wide).encode()), text=open_)
    assert any("the file does not give its time" in note for note in untold.notes)


def test_nothing_is_claimed_of_angles_that_a_table_has_not() -> None:
    """No heading, no camera: neither the course of the body nor what its camera shows is judged."""
    rules = "rules: {mutual_visibility: {strength: require}, look_ahead: 30 deg}\ndrones:"
    text = TEXT.replace("drones:", rules).replace(
        "shots:", "  cam2: {model: x500, home: [90, -60, 0]}\nshots:"
    )
    timed = text.replace("pitch: 0 deg}", "pitch: 0 deg, timing: {start: 9, duration: 3}}")
    report = verified(("cam1.csv", table({"cam1": FLIGHT})), text=timed)
    assert (report.holds, codes(report)) == (True, [])
    assert claims(report, "out of the picture") == []
    head, *lines = table({"cam1": FLIGHT}).decode().splitlines()
    wide = [
        f"{head},body_yaw_rad,cam_yaw_rad,cam_pitch_rad,hfov_rad",
        *(f"{line},0,0,0,1.2" for line in lines),
    ]
    seen = verified(("cam1.csv", "\n".join(wide).encode()), text=timed)
    assert codes(seen) == ["V025"]
    blunt = "\n".join(wide).replace(",1.2\n", ",0\n", 1).encode()
    refused = verified(("cam1.csv", blunt), text=timed)
    assert [(d.code, d.labels[0].span.line) for d in refused.diagnostics] == [("I010", 2)]


def test_a_show_is_judged_drone_by_drone() -> None:
    report = verified(("all.skyc", swarm()), text=GENTLE)
    assert (report.holds, codes(report)) == (True, [])
    (apart,) = claims(report, "separation")
    assert apart.worst == pytest.approx(4.0, abs=1e-5)
    assert "pictures" in " ".join(report.notes)


def test_drones_of_a_show_with_other_names_are_those_on_whose_pads_they_stand() -> None:
    renamed = _changed(
        swarm(), lambda drones: [d["settings"].update(name=f"D{i}") for i, d in enumerate(drones)]
    )
    assert verified(("all.skyc", renamed), text=GENTLE).holds


def test_parts_of_a_show_may_stand_in_files_of_their_own() -> None:
    content = json.loads(ZipFile(BytesIO(swarm())).read("show.json"))
    files = {}
    for i, drone in enumerate(content["swarm"]["drones"]):
        files[f"drones/{i}/path.json"] = json.dumps(drone["settings"]["trajectory"]).encode()
        drone["settings"]["trajectory"] = {"$ref": f"./drones/{i}/path.json#"}
    whole = zipped({"show.json": json.dumps(content).encode(), **files})
    assert (
        verified(("all.skyc", whole), text=GENTLE).certificate
        == verified(("all.skyc", swarm()), text=GENTLE).certificate
    )
    part = zipped({"show.json": json.dumps(content).encode()})
    lacking = verified(("all.skyc", part), text=GENTLE)
    assert (codes(lacking), "drones/0/path.json" in lacking.diagnostics[0].message) == (["I008"], True)


def test_a_table_without_names_is_of_the_drone_that_the_user_names() -> None:
    rows = table({"": FLIGHT}).replace(b",drone,", b",").replace(b",,", b",")
    two = TEXT.replace("shots:", "  cam2: {model: x500, home: [40, -90, 0]}\nshots:")
    assert codes(verified(("flight.csv", rows), text=two)) == ["I013"]
    report = verified(("flight.csv", rows), text=two, drones=["cam1"])
    assert (report.holds, claims(report, "separation from cam2")[0].holds) == (True, True)
    assert any("`cam2`: without a file" in note for note in report.notes)


def test_unequal_numbers_of_drones_are_told() -> None:
    few = verified(("all.skyc", swarm(3)), text=GENTLE)
    assert codes(few) == ["I013"]
    assert "3 flights of fleet `swarm`, which has 4 drones" in few.diagnostics[0].message
    assert "`swarm-4`" in few.diagnostics[0].notes[0]
    many = _changed(swarm(), lambda drones: drones.append({"type": "generic", "settings": dict(_FAR)}))
    assert codes(verified(("all.skyc", many), text=GENTLE)) == ["I013"]
    twice = verified(("a.skyc", swarm()), ("b.skyc", swarm()), text=GENTLE)
    assert codes(twice) == ["I013"] * 4
    stranger = verified(("all.csv", table({"cam9": FLIGHT, "cam1": FLIGHT})), text=TEXT)
    assert (codes(stranger), stranger.diagnostics[0].labels[0].span.line) == (["I013"], 2)


_FAR = {
    "name": "swarm-5",
    "trajectory": {"version": 1, "points": [[0, [90, 90, 0], []], [9, [90, 90, 9], []]]},
}


def _changed(data: bytes, change: Callable[[Drones], object]) -> bytes:
    content = json.loads(ZipFile(BytesIO(data)).read("show.json"))
    change(content["swarm"]["drones"])
    return zipped({"show.json": json.dumps(content).encode()})


def test_a_show_turned_and_moved_is_where_its_location_says() -> None:
    """The same show in a frame that is turned by 90 deg and has its origin 10 m North of the mission's."""

    def moved(data: bytes) -> bytes:
        content = json.loads(ZipFile(BytesIO(data)).read("show.json"))
        for drone in content["swarm"]["drones"]:
            for point in drone["settings"]["trajectory"]["points"]:
                # X is East and Y North there: North less 10 m is Y, -West is X.
                for place in (point[1], *point[2]):
                    north, west = place[0], place[1]
                    place[0], place[1] = -west, north - 10.0
        lat = 47.3769 + np.degrees(10.0 / 6366500.0)
        content["environment"] = {"location": {"origin": [lat, 8.5417], "orientation": 90}}
        return zipped({"show.json": json.dumps(content).encode()})

    one, other = (verified(("all.skyc", data), text=GENTLE) for data in (swarm(), moved(swarm())))
    assert (one.holds, other.holds) == (True, True)
    assert claims(other, "separation")[0].worst == pytest.approx(claims(one, "separation")[0].worst, abs=1e-6)


@pytest.mark.long
@pytest.mark.parametrize("kind", range(len(KINDS)))
def test_a_violation_that_no_place_of_the_file_shows_is_found(kind: int) -> None:
    violation = KINDS[kind](np.random.default_rng([7, kind]))
    assert 0.0 < violation.lasts < LONGEST_S
    assert violation.found


@pytest.mark.slow
@settings(max_examples=40, deadline=None)
@given(data=st.data())
def test_another_flight_through_the_rows_is_as_near_as_is_said(data: st.DataObject) -> None:
    """Rows of a sum of sines, whose acceleration and jerk are at most those of its terms together."""
    waves = data.draw(
        st.lists(st.tuples(st.floats(0.1, 3), st.floats(0.2, 4), st.floats(0, 6)), min_size=1, max_size=3)
    )
    step = data.draw(st.sampled_from([0.05, 0.2, 0.5]))
    limits = Limits(99, 99, 99, sum(a * w**2 for a, w, _ in waves), sum(a * w**3 for a, w, _ in waves), 9, 9)
    t = np.arange(0.0, 4.0 + step / 2, step)

    def motion(at: np.ndarray, order: int) -> np.ndarray:
        return sum(a * w**order * np.sin(w * at + p + order * np.pi / 2) for a, w, p in waves)

    lines = [
        f"{u:.17g},{x:.17g},0,20,{v:.17g},0,0" for u, x, v in zip(t, motion(t, 0), motion(t, 1), strict=True)
    ]
    text = "\n".join(["t_s,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s", *lines])
    flown = of_rows(rows_of(text)[0], "cam1", "all.csv", limits)
    fine = np.linspace(0.0, t[-1], 2001)
    off = np.abs(flown.curve(fine)[:, 0] - motion(fine, 0)).max()
    assert off <= flown.leeway.between * (1 + 1e-9) + 1e-9
    faster = np.abs(flown.curve.derivative()(fine)[:, 0] - motion(fine, 1)).max()
    assert faster <= min(2 * limits.acceleration * step / 3, limits.jerk * step**2 / 4) + 1e-6


@pytest.mark.slow
@settings(max_examples=12, deadline=None)
@given(seed=st.integers(0, 10**6), upright=st.booleans())
def test_the_nearest_two_are_those_of_the_other_method(seed: int, upright: bool) -> None:
    """Splines over common breaks by ``closest``; the same, cut at times of their own, by ``closest_of``."""
    rng = np.random.default_rng(seed)
    breaks = np.linspace(0.0, 10.0, 9)
    coef = rng.uniform(-6, 6, (5, 11, 3))
    apart = Apart("cylinder" if upright else "ellipsoid", 1.0, 1.7, 0.1)
    expected = closest(breaks, coef, apart)
    curves = [Piecewise(breaks, ctrl) for ctrl in spline_pieces(breaks, coef)]
    even = closest_of(curves, apart)
    own = closest_of([_cut(curve, rng) for curve in curves], apart)
    for found in (even, own):
        assert found.attained == pytest.approx(expected.attained, abs=2e-6)
        assert found.proven == pytest.approx(expected.proven, abs=2e-6)
        assert found.proven <= found.attained


def _cut(curve: Piecewise, rng: np.random.Generator) -> Piecewise:
    return restrict(curve, np.union1d(curve.breaks, rng.uniform(0.1, 9.9, 4)))


BAD_SHOWS = {
    "no zip": (b"PK", "I008", "broken archive"),
    "no show": (zipped({"a.json": b"{}"}), "I008", "without `show.json`"),
    "no JSON": (zipped({"show.json": b"{"}), "I008", "no JSON"),
    "deep": (zipped({"show.json": b"[" * 100_000}), "I008", "no JSON"),
    "version": (zipped({"show.json": b'{"version": 2}'}), "I009", "version 2"),
    "no drones": (zipped({"show.json": b'{"version": 1}'}), "I010", "`swarm.drones`"),
}


@pytest.mark.parametrize("name", BAD_SHOWS)
def test_broken_shows_are_told(name: str) -> None:
    data, code, said = BAD_SHOWS[name]
    report = verified(("all.skyc", data), text=GENTLE)
    assert (codes(report), said in report.diagnostics[0].message) == ([code], True)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (
            lambda p: p.update(version=2),
            "`swarm.drones[0].settings.trajectory` is no trajectory",
        ),
        (lambda p: p.update(points=[]), "no list of 1 to"),
        (lambda p: p.update(takeoffTime="soon"), "takeoffTime` is no time"),
        (lambda p: p["points"][3].__setitem__(0, 0.0), "points[3]`, 0 s, does not come after"),
        (
            lambda p: p["points"][2].__setitem__(1, [0, None, 0]),
            "the place of `swarm.drones[0].settings.trajectory.points[2]` is no list of 3 finite",
        ),
        (
            lambda p: p["points"][2].__setitem__(2, [[0, 0, 0]] * 3),
            "points[2]` has 3 control points, which make no",
        ),
        (
            lambda p: p["points"][2].__setitem__(0, float("nan")),
            "the time of `swarm.drones[0].settings.trajectory.points[2]` is no number",
        ),
    ],
)
def test_broken_curves_are_told_with_their_element(change: Callable[[Any], object], said: str) -> None:
    data = _changed(swarm(), lambda drones: change(drones[0]["settings"]["trajectory"]))
    report = verified(("all.skyc", data), text=GENTLE)
    assert codes(report) == ["I010"]
    assert said in report.diagnostics[0].message


@pytest.mark.parametrize(
    ("old", "new", "code", "line", "said"),
    [
        ("0.50,cam1", "0.25,cam1", "I010", 4, "does not come after"),
        ("0.50,cam1", "half,cam1", "I010", 4, "`half`, which is no number"),
        ("0.50,cam1", "nan,cam1", "I010", 4, "no number"),
        ("\n0.00,cam1", "\n-1,cam1", "I010", 2, "before the mission does"),
        ("\n0.25,cam1", "\n0.25", "I010", 3, "no number"),
        ("\n14.00,cam1", "\n1e8,cam1", "I010", 58, "which is no flight"),
        ("cam1,39.375,", "cam1,4e7,", "I012", 58, "40000 km from its pad"),
    ],
)
def test_broken_rows_are_told_with_their_line(old: str, new: str, code: str, line: int, said: str) -> None:
    text = table({"cam1": FLIGHT}).decode()
    assert old in text
    report = verified(("cam1.csv", text.replace(old, new).encode()), text=TEXT)
    assert [(d.code, d.labels[0].span.line) for d in report.diagnostics] == [(code, line)]
    assert said in report.diagnostics[0].message


_LOOKING = b"\n".join(
    line + (b",cam_yaw_rad,cam_pitch_rad,hfov_rad,body_yaw_rad" if i == 0 else b",0.1,-0.2,1.2,0.1")
    for i, line in enumerate(table({"cam1": FLIGHT}).splitlines())
)


@pytest.mark.long
@settings(max_examples=40, deadline=None)
@given(data=st.data(), shown=st.booleans())
def test_no_bytes_make_a_traceback(data: st.DataObject, shown: bool) -> None:
    inside = ZipFile(BytesIO(swarm())).read("show.json") if shown else _LOOKING
    spoilt = bytearray(inside)
    for _ in range(data.draw(st.integers(1, 4))):
        at = data.draw(st.integers(0, len(spoilt) - 1))
        spoilt[at : at + data.draw(st.integers(0, 3))] = data.draw(st.binary(max_size=3))
    name, whole = ("all.skyc", zipped({"show.json": bytes(spoilt)})) if shown else ("cam1.csv", bytes(spoilt))
    report = verified((name, whole), text=GENTLE if shown else TEXT)
    assert report.holds == (not any(d.code[0] in "IV" for d in report.diagnostics))
