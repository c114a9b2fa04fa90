"""Missions of the MultiDrone project: mended where they can be, told where they had to be."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

from shotc.api import PlanOptions, check_source, compile_source
from shotc.diag.registry import has_errors
from shotc.importers.mission import Imported, import_multidrone

ORIGINALS = sorted((Path(__file__).parents[2].parent / "shared/data/multidrone-missions").glob("*.xml"))

POINT = "<RTTrajectoryPoint><x>{x}</x><y>{y}</y><altitude>-1.0</altitude><time>{t}</time></RTTrajectoryPoint>"
ACTION = """\
<shootingAction shootingActionTemplateRef="{kind}">
  <name>one</name>
  <duration>{duration}</duration>
  <formationSpeed>3.6</formationSpeed>
  <RTTrajectory>{points}</RTTrajectory>
  <originOfFormation><x>12</x><y>-3</y><altitude>-1.0</altitude><time>0</time></originOfFormation>
  <shootingRoles><shootingRole>
    <name>{kind}</name>
    <framingTypeName>FRAMING_TYPE_MS</framingTypeName>
    <shootingTypeName>{composition}</shootingTypeName>
    <params>{params}</params>
  </shootingRole></shootingRoles>
</shootingAction>
"""
MISSION = """\
<?xml version="1.0" encoding="UTF-8"?>
<mission eventRef="GO">
<targetTypes><targetType><name>TARGET_RUNNER</name></targetType></targetTypes>
<shootingActionSequences><shootingActionSequence>
<name>S1</name><role>main</role>
<shootingActions>
{actions}</shootingActions>
</shootingActionSequence></shootingActionSequences>
</mission>
"""
WAY = ((0, 0, 0), (40, 0, 20), (60, 20, 40))


def action(kind: str, params: str, way=WAY, duration: str = "20", composition: str = "RULE_OF_THIRDS") -> str:
    points = "".join(POINT.format(x=x, y=y, t=t) for x, y, t in way)
    return ACTION.format(kind=kind, params=params, points=points, duration=duration, composition=composition)


def imported(*actions: str, strict: bool = False) -> Imported:
    return import_multidrone(MISSION.format(actions="".join(actions)).encode(), "m.xml", strict=strict)


def shots(made: Imported) -> list[dict[str, object]]:
    assert made.text is not None
    assert not has_errors(check_source(made.text.encode(), "m.yaml", None).diagnostics)
    found = yaml.safe_load(made.text)["shots"]
    assert isinstance(found, list)
    return found


def said(made: Imported) -> list[tuple[str, int]]:
    return [(d.message, d.labels[0].span.line) for d in made.diagnostics]


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


def test_times_that_do_not_rise_give_way_to_the_speed_with_a_comment_there() -> None:
    made = imported(action("CHASE", '{"x_s": -9, "z_0": 5}', way=((0, 0, 0), (36, 0, 0))))
    assert made.text is not None
    assert "times: [40.00, 50.00]" in made.text
    assert "# assumed: the points are passed at 3.6 m/s (line 11:" in made.text


def test_everything_that_is_told_stands_in_the_mission_as_a_comment() -> None:
    made = imported(action("CHASE", "{}", composition="ODD"), action("TWIRL", '{"z_0": 1}'))
    assert made.text is not None
    for note in made.diagnostics:
        assert note.code == "I004"
        taken = (note.help or "").removeprefix("taken: ")
        assert taken in made.text


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


@pytest.mark.parametrize(
    ("data", "code"),
    [
        (b"", "I001"),
        (b"shotc: 1\n", "I001"),
        (b"<!DOCTYPE a [<!ENTITY x 'y'>]><mission>&x;</mission>", "I001"),
        (b"<mission" + b"><a" * 80, "I001"),
        (b"<?xml version='1.0' encoding='klingon'?><mission/>", "I001"),
        (b"<kml/>", "I002"),
        (b"<mission/>", "I003"),
    ],
)
def test_what_is_no_such_mission_is_told(data: bytes, code: str) -> None:
    made = import_multidrone(data, "m.xml", strict=False)
    assert made.text is None
    assert made.diagnostics[-1].code == code


@settings(deadline=None, max_examples=150)
@given(st.binary(max_size=200))
def test_any_bytes_are_read_without_a_traceback(data: bytes) -> None:
    import_multidrone(data, "m.xml", strict=False)


GARBLED = st.sampled_from(
    ["", "nan", "1e999", "-1,5", "x", "{", "[]", '{"x_s": "a"}', "0", "9999999", "<b/>", "é"]
)


@settings(deadline=None, max_examples=150)
@given(
    st.lists(GARBLED, min_size=6, max_size=6),
    st.sampled_from(["CHASE", "ORBIT", "STATIC", "FLY_THROUGH", "?"]),
)
def test_garbled_values_are_mended_or_refused(values: list[str], kind: str) -> None:
    x, y, t, params, duration, composition = values
    text = MISSION.format(
        actions=action(kind, params, ((x, y, t), (1, 2, 3)), duration=duration, composition=composition)
    )
    made = import_multidrone(text.encode(), "m.xml", strict=False)
    if made.text is not None:
        check_source(made.text.encode(), "m.yaml", None)


@pytest.mark.skipif(not ORIGINALS, reason="the original missions are not here")
@pytest.mark.parametrize("path", ORIGINALS, ids=lambda path: path.stem)
def test_every_production_mission_is_imported_and_accepted(path: Path) -> None:
    made = import_multidrone(path.read_bytes(), path.name, strict=False)
    assert made.text is not None, made.diagnostics
    found = check_source(made.text.encode(), "m.yaml", None).diagnostics
    assert not has_errors(found), found
    assert len(shots(made)) == made.shots
