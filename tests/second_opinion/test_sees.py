"""Each check sees: on files that are edited to break one thing it says so."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tests.support.second_opinion.case import Case
from tests.support.second_opinion.compiled import case_of
from tests.support.second_opinion.judge import findings, judge
from tests.support.second_opinion.mission import Mission
from tests.support.second_opinion.reflight import reflights
from tests.support.second_opinion.rules import claims_hold

pytestmark = pytest.mark.slow

FOLDER = Path(__file__).parent
Plan = dict[str, Any]
Edit = Callable[[Plan], None]

STANDING = """\
shotc: 1
mission: standing
world:
  origin: {lat: 47.3769, lon: 8.5417, alt: 408}
  wind: 1 m/s
  zones:
    tree: {keep: out, cylinder: {center: [30, -30], radius: 3, height: [0, 18]}}
    wall: {keep: out, polygon: {points: [[38, 38], [44, 38], [41, 44]], height: [0, 9]}}
    field: {keep: in, box: {center: [0, 0, 31], size: [160, 160, 58]}}
targets:
  tower: {at: [0, 0, 12], radius: 4, height: 24}
drones:
  cam1: {model: x500, home: [-20, -60, 0], limits: {speed: 7 m/s}, camera: {hfov: 70 deg, aspect: "16:9"}}
  cam2: {model: x500, home: [0, -70, 0], priority: 2}
  spare: {model: x500, home: [-30, -75, 0], priority: 3}
rules: {composition: center, allow: [jump-cut], mutual_visibility: {strength: require}}
shots:
  - id: pass
    kind: keyframes
    drone: cam1
    target: tower
    require: {in_frame: 100 %, screen_error: 0.2, size: [0.2, 0.9]}
    timing: {duration: 20}
    keyframes:
      - {at: [-45, -25, 14], look_at: tower}
      - {at: [-40, 5, 16], look_at: tower, hold: 1, frame: center}
      - {at: [-45, 25, 14], look_at: tower, time: 18}
  - {id: round, kind: orbit, drone: cam2, target: tower, radius: 60, altitude: 20, start_azimuth: 180 deg,
     sweep: -30 deg, timing: {start: 80, duration: 12}}
  - {id: up, kind: elevator, drone: cam2, target: tower, azimuth: 110 deg, distance: 60, altitude: [12, 20],
     timing: {after: pass}}
output: {rate: 10}
"""


@pytest.fixture(scope="module")
def case(tmp_path_factory: pytest.TempPathFactory) -> Case:
    path = tmp_path_factory.mktemp("second") / "standing.yaml"
    path.write_text(STANDING, encoding="utf-8")
    return case_of(path, "none")


def sees(case: Case, rule: str) -> bool:
    return any(finding.rule == rule for finding in findings(case))


def edited(case: Case, edit: Edit) -> Case:
    plan = json.loads(case.files["plan.json"])
    edit(plan)
    return Case(case.mission, {**case.files, "plan.json": json.dumps(plan).encode()}, case.notes)


def asked(case: Case, old: str, new: str) -> Case:
    assert case.mission.text.count(old) == 1
    return Case(Mission(case.mission.text.replace(old, new), case.mission.read), case.files, case.notes)


def flight(plan: Plan, drone: str = "cam1") -> Plan:
    return next(found for found in plan["drones"] if found["drone"] == drone)


def moved(channel: int, by: float, phase: str = "shot", drone: str = "cam1") -> Edit:
    """Move all control points of the pieces within a phase."""

    def edit(plan: Plan) -> None:
        found = flight(plan, drone)
        part = next(p for p in found["phases"] if p["name"] == phase)
        curve = found["curve"]
        for start, end, piece in zip(curve["breaks"], curve["breaks"][1:], curve["control"], strict=False):
            if part["start"] <= start and end <= part["end"]:
                for point in piece:
                    point[channel] += by

    return edit


def bent(channel: int, by: float, phase: str = "shot", drone: str = "cam1") -> Edit:
    """Move two inner control points of the middle piece of a phase: its ends stay."""

    def edit(plan: Plan) -> None:
        found = flight(plan, drone)
        part = next(p for p in found["phases"] if p["name"] == phase)
        curve, middle = found["curve"], (part["start"] + part["end"]) / 2
        k = next(i for i, end in enumerate(curve["breaks"][1:]) if end > middle)
        for point in curve["control"][k][2:4]:
            point[channel] += by

    return edit


def claim(constraint: str, subject: str = "cam1", **values: Any) -> Edit:
    def edit(plan: Plan) -> None:
        for found in plan["certificate"]:
            if (found["constraint"], found["subject"]) == (constraint, subject):
                found.update(values)

    return edit


def without(constraint: str, subject: str = "cam1") -> Edit:
    def edit(plan: Plan) -> None:
        plan["certificate"] = [
            c for c in plan["certificate"] if (c["constraint"], c["subject"]) != (constraint, subject)
        ]

    return edit


def first_phase(**values: Any) -> Edit:
    return lambda plan: flight(plan)["phases"][0].update(values)


@pytest.mark.long
def test_nothing_is_wrong_with_the_plan_itself(case: Case) -> None:
    assert judge(case) == []


FLOWN = {
    "speed": bent(0, 60.0, "transit"),
    "climb": bent(2, 40.0, "transit"),
    "descent": bent(2, -40.0, "transit"),
    "acceleration": bent(0, 5.0),
    "jerk": bent(1, 1.0),
    "body yaw rate": bent(5, 5.0),
    "body yaw acceleration": bent(5, 5.0),
    "gimbal pitch max": moved(4, 2.0),
    "gimbal pitch min": moved(4, -2.0),
    "gimbal pitch rate": bent(4, 5.0),
    "gimbal pitch acceleration": bent(4, 5.0),
    "gimbal yaw max": moved(3, 3.0),
    "gimbal yaw min": moved(3, -3.0),
    "gimbal yaw rate": bent(3, 5.0),
    "gimbal yaw acceleration": bent(3, 5.0),
    "field of view max": moved(6, 2.0),
    "jump of value": moved(0, 1e-4),
    "ground clearance": moved(2, -12.0),
    "target tower": moved(0, 40.0),
    "zone field": moved(0, -40.0),
    "drift from the vertical": moved(0, 0.1, "takeoff"),
    "distance from home": moved(1, 0.1, "land"),
    "depth below home": moved(2, -1.0, "land"),
    "place of keyframe": moved(1, 0.01),
    "required in_frame": moved(3, 0.5),
    "required screen_error": moved(4, 0.2),
    "required size": moved(6, -0.7),
    "column x_m": moved(0, 1e-5),
    "column body_yaw_rad": moved(5, 1e-6),
    "column hfov_rad": moved(6, 1e-6),
    "column u": moved(3, 1e-5),
    "column v": moved(4, 1e-5),
    "column size": moved(6, 1e-3),
    "column in_frame": moved(3, 0.6),
    "frame of keyframe": moved(3, 0.1),
}


@pytest.mark.long
@pytest.mark.parametrize("rule", FLOWN)
def test_a_flight_that_breaks_a_rule_is_seen(case: Case, rule: str) -> None:
    assert sees(edited(case, FLOWN[rule]), rule)


CLAIMED = {
    "claimed speed": claim("speed", worst=3.0),
    "claimed jerk": claim("jerk", worst=1.0),
    "claimed ground clearance": claim("ground clearance", worst=50.0),
    "claimed separation from cam2": claim("separation from cam2", worst=500.0),
    "claimed separation from spare": claim("separation from spare", worst=500.0),
    "claimed endurance": claim("endurance", worst=1.0),
    "claimed size largest": claim("tower size largest", worst=0.1),
    "claimed screen error": claim("tower screen error", worst=0.0),
    "claimed in frame": claim("tower in frame", worst=0.5),
    "claimed cam2 out of the picture": claim("cam2 out of the picture", worst=500.0),
    "claimed jump of acceleration": claim("jump of acceleration", worst=5e-5),
    "limit of jerk": claim("jerk", limit=80.0),
    "holds: speed": claim("speed", holds=False),
    "no claim: separation from spare": without("separation from spare"),
    "no claim: zone tree": without("zone tree"),
    "no claim: spare out of the picture": without("spare out of the picture"),
    "phases without gaps": first_phase(end=1.0),
    "take-off first and landing last": first_phase(name="transit"),
    "shots flown once": lambda plan: flight(plan)["phases"][2].update(shot=None),
    "keyframes reached": lambda plan: flight(plan).update(keyframes=flight(plan)["keyframes"][:2]),
    "rows of framing.csv": lambda plan: flight(plan).update(framing=[]),
    "as written: limits.speed": lambda plan: plan["mission"]["drones"][0]["limits"].update(speed=9.0),
    "as written: home.1": lambda plan: plan["mission"]["drones"][0]["home"].__setitem__(1, -61.0),
}


@pytest.mark.long
@pytest.mark.parametrize("rule", CLAIMED)
def test_an_untrue_plan_is_seen(case: Case, rule: str) -> None:
    assert sees(edited(case, CLAIMED[rule]), rule)


@pytest.mark.parametrize(("worst", "found"), [(5.0 - 2e-6, 0), (5.0 - 6e-6, 1)])
def test_a_claim_holds_as_near_to_its_limit_as_the_page_says(case: Case, worst: float, found: int) -> None:
    """A millionth of the limit of 5 m."""
    edit = claim("ground clearance", limit=5.0, worst=worst)
    assert len(list(claims_hold(edited(case, edit)))) == found


ASKED = {
    "duration": ("timing: {duration: 20}", "timing: {duration: 21}"),
    "start": ("start: 80", "start: 81"),
    "after": ("timing: {duration: 20}", "timing: {after: up, duration: 20}"),
    "place of keyframe": ("at: [-40, 5, 16]", "at: [-40, 5.01, 16]"),
    "time of keyframe": ("time: 18", "time: 17"),
    "frame of keyframe": ("frame: center", "frame: left-third"),
    "sweep": ("sweep: -30 deg", "sweep: 330 deg"),
    "start azimuth": ("start_azimuth: 180 deg", "start_azimuth: 210 deg"),
    "radius": ("radius: 60", "radius: 50"),
    "altitude": ("altitude: 20", "altitude: 25"),
    "place of kind": ("azimuth: 110 deg", "azimuth: 120 deg"),
    "zone wall": (
        "[[38, 38], [44, 38], [41, 44]], height: [0, 9]",
        "[[-50, -5], [-30, -5], [-40, 15]], height: [0, 30]",
    ),
    "zone tree": ("center: [30, -30], radius: 3", "center: [-40, 5], radius: 3"),
    "zone field": ("center: [0, 0, 31]", "center: [60, 0, 31]"),
    "limit of ground clearance": ("rules: {", "rules: {ground_clearance: 3, "),
    "separation from spare": ("rules: {", "rules: {separation: 30, "),
    "target tower": ("rules: {", "rules: {target_clearance: 50, "),
    "latitude, longitude, altitude": ("lat: 47.3769", "lat: 47.37691"),
    "column size": ("radius: 4, height: 24", "radius: 4, height: 23"),
    "column occluded": ("center: [30, -30], radius: 3", "center: [-20, -5], radius: 6"),
    "shots flown once": (
        "  - {id: round",
        "  - {id: more, kind: static, drone: cam1, at: [0, 0, 9]}\n  - {id: round",
    ),
}


@pytest.mark.long
@pytest.mark.parametrize("rule", ASKED)
def test_a_plan_of_another_mission_is_seen(case: Case, rule: str) -> None:
    assert sees(asked(case, *ASKED[rule]), rule)


def item(command: int, slot: int, by: float) -> Edit:
    """Change a parameter of all items of one command."""

    def edit(plan: Plan) -> None:
        found = [i["params"] for i in plan["mission"]["items"] if i["command"] == command]
        assert found
        for params in found:
            params[slot] += by

    return edit


def other_command(old: int, new: int) -> Edit:
    def edit(plan: Plan) -> None:
        next(i for i in plan["mission"]["items"] if i["command"] == old)["command"] = new

    return edit


def halfway_aside(plan: Plan) -> None:
    waypoints = [i for i in plan["mission"]["items"] if i["command"] == 16]
    waypoints[len(waypoints) // 2]["params"][5] += 2e-5


MISSION_FILES = {
    "plan beside the way": halfway_aside,
    "way beside the plan": halfway_aside,
    "heading in the film": item(16, 3, 20.0),
    "picture in the film": item(195, 6, 9.0),
    "recordings": other_command(2500, 2501),
    "commands": other_command(21, 20),
    "home": lambda plan: plan["mission"]["plannedHomePosition"].__setitem__(2, 409.0),
    "items": lambda plan: plan["mission"]["items"].pop(1),
    "flown seconds of film": item(178, 1, -1.5),
    "place in the film": item(16, 6, 30.0),
}


@pytest.mark.long
@pytest.mark.parametrize("rule", MISSION_FILES)
def test_a_mission_file_that_flies_otherwise_is_seen(case: Case, rule: str) -> None:
    file = json.loads(case.files["cam1.plan"])
    MISSION_FILES[rule](file)
    found = Case(case.mission, {**case.files, "cam1.plan": json.dumps(file).encode()}, case.notes)
    assert rule in {finding.rule for finding in reflights(found)}


@pytest.mark.long
def test_a_note_that_says_less_than_is_true_is_seen(case: Case) -> None:
    """The heading, the position and the film's seconds of a file are those that its note says."""
    (note,) = (n for n in case.notes if "cam1.plan" in n)
    for old, new, rule in (
        (r"position within [\d.]+", "position within 0.00", "plan beside the way"),
        (r"heading within [\d.]+", "heading within 0.0", "heading in the film"),
        (r"take about \d+", "take about 10", "flown seconds of film"),
    ):
        untrue = re.sub(old, new, note)
        assert untrue != note
        rules = {f.rule for f in reflights(Case(case.mission, case.files, (untrue,)))}
        assert rule in rules


def test_shots_in_another_order_are_seen(case: Case) -> None:
    def swapped(plan: Plan) -> None:
        names = {"round": "up", "up": "round"}
        for phase in flight(plan, "cam2")["phases"]:
            phase["shot"] = names.get(phase["shot"])

    other = asked(edited(case, swapped), "start: 80, duration: 12", "duration: 12")
    assert sees(other, "order of shots")


@pytest.mark.long
def test_a_drone_in_the_picture_is_seen(case: Case) -> None:
    """The other drone stands in front of the tower that the first one films."""
    found = edited(case, lambda plan: plan["mission"]["drones"][2].update(home=[-20, 2.5, 14]))
    assert sees(found, "column occluded")
    assert sees(found, "required: spare out of the picture")


@pytest.mark.long
@pytest.mark.parametrize(
    ("table", "old", "new", "rule"),
    [
        ("trajectory.csv", b",takeoff,", b",transit,", "phase of a row"),
        ("trajectory.csv", b"\n0.4,", b"\n0.45,", "ticks of the clock"),
        ("trajectory.csv", b",47.3", b",47.4", "latitude, longitude, altitude"),
        ("framing.csv", b",1,0,0\n", b",0,0,0\n", "column in_frame"),
        ("framing.csv", b",1,0,0\n", b",1,1,0\n", "column occluded"),
        ("framing.csv", b",1,0,0\n", b",1,0,0.4\n", "column covered"),
    ],
)
def test_a_table_that_says_something_else_is_seen(
    case: Case, table: str, old: bytes, new: bytes, rule: str
) -> None:
    data = case.files[table]
    assert old in data
    found = Case(case.mission, {**case.files, table: data.replace(old, new, 3)}, case.notes)
    assert sees(found, rule)
