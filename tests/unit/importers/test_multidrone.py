"""Missions of the MultiDrone project: corrected where they can be, told where they had to be."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml

from shotc.api import PlanOptions, compile_source
from shotc.checking import check_source
from shotc.diag.registry import has_errors
from shotc.importers.mission import import_multidrone
from tests.support.multidrone_files import EARTH, MISSION, POINT, action, imported, mapped, said, shots
from tests.support.multidrone_originals import ORIGINALS

pytestmark = pytest.mark.slow


@pytest.mark.parametrize(
    ("kind", "params", "wanted"),
    [
        (
            "CHASE",
            '{"x_s": {"value": -9}, "z_0": {"value": 5}}',
            {"kind": "chase", "distance": 9, "altitude": 5},
        ),
        ("LEAD", '{"x_s": 9, "z_0": 5}', {"kind": "lead", "distance": 9}),
        (
            "LATERAL",
            '{"y_0": -7, "z_0": 4}',
            {"kind": "lateral", "side": "right", "composition": "left-third"},
        ),
        (
            "LATERAL",
            '{"y_0": 7, "z_0": 4}',
            {"kind": "lateral", "side": "left", "composition": "right-third"},
        ),
        (
            "FLYBY",
            '{"x_s": -10, "x_e": 12, "y_0": -5, "z_0": 4}',
            {"kind": "flyby", "behind": 10, "ahead": 12, "offset": -5, "altitude": 4},
        ),
        (
            "ORBIT",
            '{"r_0": 9, "azimuth_speed": 0.1, "azimuth_s": 0, "z_0": 6}',
            {"kind": "orbit", "radius": 9, "sweep": "114.6 deg", "start_azimuth": "90.0 deg"},
        ),
        ("STATIC", '{"z_0": 6}', {"kind": "static", "at": [12, -3, 6], "look_at": "target1"}),
        ("ELEVATOR", '{"z_s": 4, "z_e": 9}', {"kind": "follow-path", "points": [[12, -3, 4], [12, -3, 9]]}),
        (
            "ESTABLISH",
            '{"x_s": -30, "x_e": -12, "z_s": 20, "z_e": 6}',
            {"kind": "crane", "azimuth": "270.0 deg"},
        ),
    ],
)
def test_every_shot_becomes_ours_with_its_numbers(kind: str, params: str, wanted: dict[str, object]) -> None:
    (shot,) = shots(imported(action(kind, params)))
    assert shot | wanted == shot


def test_decimal_commas_are_read_and_told_with_their_line() -> None:
    made = imported(action("CHASE", '{"x_s": -9, "z_0": 5}', way=((0, "0,5", 0), (40, 0, 20))))
    assert ("`0,5` has a decimal comma", 11) in said(made)
    assert made.text is not None
    assert "[0.00, 0.50, 0.9]" in made.text


@pytest.mark.parametrize(
    ("way", "line", "why"),
    [
        (((0, 0, 0), (9, 0, 0)), 11, "the times of the trajectory are all 0"),
        (((0, 0, 0), (9, 0, "")), 11, "a point of the trajectory has no time"),
        (((0, 0, 5), (9, 0, 4)), 11, "the times of the trajectory do not rise: 4 s follows 5 s"),
        (((0, 0, 0), (9, 0, 0.1)), 11, "the times ask for 90 m/s up to this point"),
    ],
)
def test_times_that_cannot_be_meant_give_way_to_the_speed_in_km_h(way, line: int, why: str) -> None:
    made = imported(action("CHASE", '{"x_s": -9, "z_0": 5}', way=way))
    assert made.text is not None
    assert "times: [40.00, 49.00]" in made.text
    assert f"# assumed: its points are passed at formationSpeed, 3.6 km/h (line {line}: {why})" in made.text


def test_a_fault_is_told_at_its_own_column() -> None:
    made = imported(action("CHASE", '{"x_s": -9, "z_0": 5}', way=((0, 0, 5), (9, 0, 4))))
    (note,) = (d for d in made.diagnostics if "do not rise" in d.message)
    line = made.sources["m.xml"].text.splitlines()[note.labels[0].span.line - 1]
    assert line[note.labels[0].span.column - 1 :].startswith("<time>4</time>")


def test_a_speed_that_contradicts_the_times_is_told_and_the_times_hold() -> None:
    made = imported(action("CHASE", '{"x_s": -9, "z_0": 5}', way=((0, 0, 0), (60, 0, 20))))
    assert ("formationSpeed says 1.00 m/s, the times of the trajectory 3.00 m/s", 10) in said(made)
    assert made.text is not None
    assert "times: [40.00, 60.00]" in made.text


def test_a_shot_ends_where_the_way_of_its_target_does() -> None:
    (shot,) = shots(made := imported(action("CHASE", '{"x_s": -9, "z_0": 5}', duration="600")))
    assert shot["timing"] == {"start": 40, "duration": 40}
    assert ("the action lasts 600 s, the path of its target is given for 40.0 s", 9) in said(made)


def test_a_target_that_waits_is_there_until_it_goes() -> None:
    made = imported(action("LATERAL", '{"y_0": 8, "z_0": 5}', way=((0, 0, 0), (0, 0, 14), (20, 0, 24))))
    assert made.text is not None
    assert "times: [40.00, 54.00, 64.00]" in made.text
    assert len(shots(made)) == 1


def test_one_target_that_goes_two_ways_is_two_targets_and_told() -> None:
    params = '<targetIdentifierParams>{"ID": 3}</targetIdentifierParams><params>'
    first = action("CHASE", '{"x_s": -9, "z_0": 5}').replace("<params>", params)
    other = action("LATERAL", '{"y_0": 8, "z_0": 5}', way=((200, 0, 0), (200, 40, 20)))
    between = (
        "</shootingActions></shootingActionSequence><shootingActionSequence><name>S2</name><shootingActions>"
    )
    made = imported(first + between + other.replace("<params>", params))
    assert [shot["target"] for shot in shots(made)] == ["target1", "target2"]
    assert any("target 3 goes another way" in message for message, _ in said(made))
    assert (made.drones, made.shots) == (2, 2)


def test_metres_beside_degrees_count_from_where_the_map_shows_them() -> None:
    mixed = POINT.format(x=100, y=50, t=0) + EARTH.format(47.001, 8.0, 40)
    made = imported(mapped(mixed, "8.0,47.0 8.0,47.001"))
    assert made.text is not None
    origin = yaml.safe_load(made.text)["world"]["origin"]
    track = yaml.safe_load(made.text)["targets"]["target1"]["track"]["points"]
    assert origin["lat"] == pytest.approx(47 - 50 / 111_170, abs=1e-6)
    assert track == [[100, 50, 0.9], [pytest.approx(100, abs=0.1), pytest.approx(161.2, abs=0.1), 0.9]]
    assert any("where the map (KML) of the same action shows the first" in d.help for d in made.diagnostics)


def test_metres_beside_degrees_without_a_map_that_fits_count_from_the_first_place() -> None:
    mixed = POINT.format(x=100, y=50, t=0) + EARTH.format(47.001, 8.0, 40)
    made = imported(mapped(mixed, "9.0,48.0 9.0,48.001"))
    assert any("no map says where they count from" in d.help for d in made.diagnostics)
    assert len(shots(made)) == 1


def test_places_on_the_earth_stay_so_and_a_map_elsewhere_is_told() -> None:
    points = EARTH.format("47.0010000", 8.5, 0) + EARTH.format(47.002, 8.5, 60)
    origin = "<latitude>47.001</latitude><longitude>8.501</longitude>"
    whole = mapped(points, "9.0,48.0 9.0,48.001").replace("<x>12</x><y>-3</y>", origin)
    made = imported(whole)
    assert made.text is not None
    written = yaml.safe_load(made.text)
    assert written["world"]["origin"] == {"lat": 47.001, "lon": 8.5, "alt": 0}
    assert written["targets"]["target1"]["track"]["points"][1] == {"lat": 47.002, "lon": 8.5, "height": 0.9}
    assert any("the map (KML) in the description begins 1" in message for message, _ in said(made))
    assert len(shots(made)) == 1


@pytest.mark.parametrize("map_", ["", "{", "[]", '{"KML": 3}', '{"KML": "&lt;a"}', '{"KML": "&lt;a/&gt;"}'])
def test_a_map_that_cannot_be_read_is_no_map(map_: str) -> None:
    text = f"<Maps><Map><description>{map_}</description></Map></Maps><originOfFormation>"
    whole = action("LATERAL", '{"y_0": 8, "z_0": 5}').replace("<originOfFormation>", text)
    assert len(shots(imported(whole))) == 1


def test_a_fly_through_follows_its_own_way_and_turns_its_camera_as_told() -> None:
    turned = '<targetIdentifierParams>{"pan_s": 90, "pan_e": 90, "tilt_s": 80, "tilt_e": 80}'
    params = turned + "</targetIdentifierParams><params>"
    flown = action("FLY_THROUGH", '{"z_0": 6}', way=((0, 0, 0), (30, 0, 20)))
    (shot,) = shots(made := imported(flown.replace("<params>", params)))
    assert "targets" not in yaml.safe_load(made.text or "")
    assert shot["keyframes"] == [
        {"at": [0, 0, 6], "heading": "0.0 deg", "pitch": "-10 deg"},
        {"at": [30, 0, 6], "heading": "0.0 deg", "pitch": "-10 deg"},
    ]


def test_the_distance_holds_against_the_framing_and_gives_way_where_it_is_missing() -> None:
    (shot,) = shots(made := imported(action("LATERAL", '{"y_0": 8, "z_0": 5}')))
    assert "size" not in shot
    assert "# FRAMING_TYPE_MS would be `size: medium`; the distances of the file hold" in (made.text or "")
    assert shots(imported(action("LATERAL", '{"z_0": 5}')))[0]["size"] == "medium"


def test_a_framing_that_is_not_known_is_told() -> None:
    made = imported(action("LATERAL", "{}").replace("FRAMING_TYPE_MS", "FRAMING_TYPE_XXL"))
    assert ("the framing `FRAMING_TYPE_XXL` is not known", 15) in said(made)


def test_nothing_in_the_file_ends_a_comment() -> None:
    evil = "TWIRL\n  x: [\u2028\u0085"
    assert len(shots(imported(action("CHASE", "{}", composition=evil).replace("FRAMING_TYPE_MS", evil)))) == 1
    odd = imported(action(evil, "{}").replace(f'Ref="{evil}"', 'Ref="x"'))
    assert len(shots(odd)) == 1


@pytest.mark.parametrize("written", ["1_000", "0x10", "1.234,5", "nan", "inf", "1e9", "\u0663"])
def test_what_is_no_number_counts_as_missing(written: str) -> None:
    made = imported(action("CHASE", '{"x_s": -9, "z_0": 5}', way=((0, written, 0), (40, 0, 20), (60, 0, 40))))
    assert any("is no number that can be meant" in message for message, _ in said(made))
    assert len(shots(made)) == 1


def test_parameters_with_decimal_commas_are_read_where_they_stand() -> None:
    made = imported(action("LATERAL", '{"y_0": "7,5", "z_0": true}'))
    assert ("y_0 = `7,5` has a decimal comma", 17) in said(made)
    assert ("z_0 = `True` is no number that can be meant", 17) in said(made)
    assert shots(made)[0]["distance"] == 7.5


def test_everything_that_is_told_stands_in_the_mission_as_a_comment() -> None:
    made = imported(action("CHASE", "{}", composition="ODD"), action("TWIRL", '{"z_0": 1}'))
    assert made.text is not None
    for note in made.diagnostics:
        assert note.code == "I004"
        taken = (note.help or "").removeprefix("taken: ")
        assert taken in made.text


def test_what_is_left_out_stands_at_the_head_of_the_mission() -> None:
    empty = "<shootingAction><name>none</name></shootingAction>"
    made = imported(action("CHASE", '{"x_s": -9, "z_0": 5}'), empty)
    assert made.text is not None
    head = made.text[: made.text.index("shotc: 1")]
    assert "# assumed: it is left out (line 20: an action that neither names its shot nor has a role)" in head


def test_a_decimal_comma_is_a_comment_at_its_target() -> None:
    made = imported(action("CHASE", '{"x_s": -9, "z_0": 5}', way=((0, "0,5", 0), (40, 0, 20))))
    targets, _, _ = (made.text or "").partition("drones:")
    assert "  # assumed: 0.5 (line 11: `0,5` has a decimal comma)\n  target1:" in targets


def test_strict_refuses_what_would_be_assumed() -> None:
    made = imported(action("CHASE", '{"x_s": -9, "z_0": 5}'), strict=True)
    assert made.text is None
    assert {d.code for d in made.diagnostics} == {"I005"}


def test_two_roles_of_an_action_are_two_drones() -> None:
    both = action("CHASE", '{"x_s": -9, "z_0": 5}').replace(
        "</shootingRoles>",
        "<shootingRole><name>LATERAL</name><params>{}</params></shootingRole></shootingRoles>",
    )
    assert [shot["drone"] for shot in shots(imported(both))] == ["cam1", "cam2"]


def test_actions_one_after_the_other_follow_one_target_and_leave_time_to_change() -> None:
    later = ((60, 20, 40), (60, 90, 60))
    chase = action("CHASE", '{"x_s": -9, "z_0": 5}', duration="40")
    found = shots(imported(chase, action("LATERAL", '{"y_0": 8, "z_0": 5}', later)))
    assert {shot["target"] for shot in found} == {"target1"}
    first, second = (shot["timing"] for shot in found)
    assert first == {"start": 40, "duration": 40}
    assert second["start"] + second["duration"] == 100


@pytest.mark.slow
def test_rule_of_thirds_is_flown_and_proved() -> None:
    made = imported(action("LATERAL", '{"y_0": -9, "z_0": 4}'))
    assert made.text is not None
    done = compile_source(made.text.encode(), "m.yaml", None, PlanOptions(refiner="none"))
    assert done.plan is not None, done.diagnostics
    (span,) = done.plan.trajectory.drones[0].framing
    assert span.reference is not None
    assert span.reference(span.start)[0] == pytest.approx(-1 / 3)
    claims = {c.constraint: c.worst for c in done.plan.certificate if c.shot}
    assert claims["target1 screen error"] < 0.05
    assert claims["target1 in frame"] == 1.0


def test_a_secondary_sequence_gives_way() -> None:
    between = (
        "</shootingActions></shootingActionSequence><shootingActionSequence><name>S2</name><shootingActions>"
    )
    lateral = action("LATERAL", '{"y_0": 8, "z_0": 5}')
    text = MISSION.format(actions=lateral + between + lateral).replace(">main<", ">secondary<", 1)
    made = import_multidrone(text.encode(), "m.xml", strict=False)
    drones = yaml.safe_load(made.text or "")["drones"]
    assert [drones[name]["priority"] for name in ("cam1", "cam2")] == [2, 1]


@pytest.mark.skipif(not ORIGINALS, reason="no original missions: MULTIDRONE_MISSIONS=DIR names their folder")
@pytest.mark.parametrize("path", ORIGINALS, ids=lambda path: path.stem)
def test_every_production_mission_is_imported_and_accepted(path: Path) -> None:
    made = import_multidrone(path.read_bytes(), path.name, strict=False)
    assert made.text is not None, made.diagnostics
    found = check_source(made.text.encode(), "m.yaml", None).diagnostics
    assert not has_errors(found), found
    assert len(shots(made)) == made.shots
    for note in made.diagnostics:
        assert (
            f"# assumed: {note.help.removeprefix('taken: ')} (line {note.labels[0].span.line}:" in made.text
        )


SOME_PLANNED = [
    pytest.param(path, id=path.stem, marks=() if k % 3 == 0 else pytest.mark.fuzz)
    for k, path in enumerate(ORIGINALS)
]
"""All are read and checked; every third one is planned, too, and all by `make fuzz`."""


@pytest.mark.long
@pytest.mark.skipif(not ORIGINALS, reason="no original missions: MULTIDRONE_MISSIONS=DIR names their folder")
@pytest.mark.parametrize("path", SOME_PLANNED)
def test_every_production_mission_is_planned(path: Path) -> None:
    made = import_multidrone(path.read_bytes(), path.name, strict=False)
    assert made.text is not None
    done = compile_source(made.text.encode(), "m.yaml", None, PlanOptions(refiner="none"))
    assert done.plan is not None, [d for d in done.diagnostics if d.severity == "error"]
