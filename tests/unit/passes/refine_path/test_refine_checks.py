"""What is checked of a refined path: every rule is broken once, and the fault says where and by how much."""

from __future__ import annotations

import re
from itertools import pairwise

import numpy as np
import pytest

from shotc.geom.bernstein import Piecewise
from shotc.geom.bspline import subdivide
from shotc.geom.solids import Cylinder
from shotc.ir.path import BODY_YAW, CAM_PITCH, CAM_YAW, HoldLeg, Z
from shotc.passes.refine_path.limits import nearest
from shotc.planning.free_space import Disc, FreeSpace, Obstacle, Wall
from tests.support.bad_refiners import (
    MISSION,
    PASS,
    ROUND,
    along,
    bumped,
    jolted,
    leg,
    path,
    refine,
    returns,
    with_leg,
)
from tests.support.owners import owner
from tests.support.records import replace

EARLY = (0.05, 0.5)
"""Between the first two keyframes of the pass."""


def told(act):
    """Return the only fault of a changed path."""
    outcome = refine(returns(act))
    assert outcome.value is None
    (fault,) = outcome.diagnostics
    assert "refiner `odd` of package odd-maker" in fault.message
    return fault


def line_of(text: str) -> int:
    return MISSION[: MISSION.index(text)].count("\n") + 1


def written(fault) -> str:
    return " ".join((fault.message, *fault.notes))


INWARDS = [-6.5, 24.1, 0, 0, 0, 0, 0]
"""From the middle of the round to the mast."""

BREACHES = {
    "zone": (lambda ir: bumped(ir, PASS, along(1, -8), EARLY), "R006", "zone `tree`", "tree: {keep"),
    "target": (lambda ir: bumped(ir, ROUND, INWARDS), "R006", "target `mast`", "targets:"),
    "ground": (lambda ir: bumped(ir, ROUND, along(Z, -11)), "R006", "the ground", "shotc: 1"),
    "pitch": (lambda ir: bumped(ir, PASS, along(CAM_PITCH, 1.0), EARLY), "R008", "its pitch range", "gimbal"),
    "yaw": (lambda ir: bumped(ir, PASS, along(BODY_YAW, 3.0), EARLY), "R008", "its yaw range", "gimbal"),
    "keyframe": (lambda ir: bumped(ir, PASS, along(Z, 0.5)), "R007", "keyframe 2", "{at: [0, -30, 12]"),
}  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("name", BREACHES)
def test_a_breach_names_the_shot_the_place_and_what_it_is_against(name):
    act, code, what, line = BREACHES[name]
    fault = told(act)
    assert fault.code == code
    assert what in written(fault)
    shot = ROUND if name in ("target", "ground") else PASS
    assert f"`{shot}`" in fault.message
    assert re.search(r"\d+\.\d m along the shot, nearest keyframe \d", written(fault))
    assert line_of(line) in [label.span.line for label in fault.labels]


def test_how_far_a_keyframe_is_missed_is_told():
    """At keyframe 2 a bump of 0.5 m, 64 (x (1 - x))^3 high, has this height."""
    curve, (_, second, _) = leg(path(), PASS).curve, leg(path(), PASS).marks
    x = (second.s - curve.start) / (curve.end - curve.start)
    assert f"{0.5 * 64 * (x * (1 - x)) ** 3:.3g} m away" in written(told(BREACHES["keyframe"][0]))


def test_how_far_the_gimbal_is_turned_too_far_is_told():
    curve = leg(path(), PASS).curve
    angles = (
        bumped(path(), PASS, along(CAM_PITCH, 1.0), EARLY)
        .drones[0]
        .legs[2]
        .curve(np.linspace(curve.start, curve.end, 20001))
    )
    beyond = np.degrees(angles[:, CAM_PITCH].max()) - 20
    assert f"by {beyond:.3g} deg" in written(told(BREACHES["pitch"][0]))


def test_a_tenth_of_a_millimetre_off_a_keyframe_is_none():
    assert refine(returns(lambda ir: bumped(ir, PASS, along(Z, 1e-4)))).value is not None


def test_a_generated_keyframe_need_not_be_passed():
    assert refine(returns(lambda ir: bumped(ir, ROUND, along(Z, 3)))).value is not None


def test_whole_turns_of_camera_and_body_together_are_none_of_the_gimbal_s():
    def turned(ir):
        turn = 2 * np.pi * np.eye(7)[[CAM_YAW, BODY_YAW]].sum(axis=0)
        legs = ir.drones[0].legs
        moved = tuple(replace(one, curve=Piecewise(one.curve.breaks, one.curve.ctrl + turn)) for one in legs)
        return replace(ir, drones=(replace(ir.drones[0], legs=moved),))

    assert refine(returns(turned)).value is not None


@pytest.mark.parametrize("order", [1, 2])
def test_a_jump_of_a_derivative_is_found(order):
    fault = told(lambda ir: jolted(ir, ROUND, order))
    assert fault.code == "R002"
    assert ("rate", "acceleration")[order - 1] + " jumps" in written(fault)
    assert "nearest keyframe 4" in written(fault)


def changes(shot, **fields):
    return lambda ir: with_leg(ir, shot, **{k: f(getattr(leg(ir, shot), k)) for k, f in fields.items()})


def standing(ir, shot, channels=7):
    """The shot's camera stands still where it begins."""
    was = leg(ir, shot)
    hold = HoldLeg(
        was.shot, was.pose[:channels], 0.0, was.marks, was.framing, was.duration, was.start, was.path
    )
    legs = tuple(hold if one is was else one for one in ir.drones[0].legs)
    return replace(ir, drones=(replace(ir.drones[0], legs=legs),))


def marked(**fields):
    return lambda marks: (replace(marks[0], **fields), *marks[1:])


def moved_reference(by):
    """Another wanted place on screen, everywhere on the first span."""

    def change(spans):
        old = spans[0].reference
        return (replace(spans[0], reference=Piecewise(old.breaks, old.ctrl + by)), *spans[1:])

    return change


def bent_reference(spans):
    old = spans[0].reference
    ctrl = old.ctrl.copy()
    ctrl[:, 2:4] += 0.1
    return (replace(spans[0], reference=Piecewise(old.breaks, ctrl)), *spans[1:])


CHANGED = {
    "pace": (changes(PASS, pace=lambda p: 1.0), "timing"),
    "duration": (changes(PASS, duration=lambda d: 30.0), "timing"),
    "hold": (changes(PASS, stops=lambda stops: (replace(stops[0], hold=2.0), *stops[1:])), "stops"),
    "stop": (changes(PASS, stops=lambda stops: (stops[0], *stops)), "stops"),
    "keyframe time": (changes(PASS, marks=marked(time=3.0)), "keyframes"),
    "keyframe": (changes(PASS, marks=lambda marks: marks[1:]), "keyframes"),
    "target": (changes(PASS, framing=lambda spans: (replace(spans[0], target="tree"),)), "targets"),
    "no target": (changes(PASS, framing=lambda _: ()), "targets"),
    "no reference": (changes(PASS, framing=lambda spans: (replace(spans[0], reference=None),)), "targets"),
    "reference": (changes(PASS, framing=moved_reference(0.2)), "0.283 of half a frame"),
    "bent reference": (changes(PASS, framing=bent_reference), "of half a frame"),
    "still": (lambda ir: standing(ir, PASS), "stands still"),
}  # fmt: skip


@pytest.mark.parametrize("name", CHANGED)
def test_what_is_the_mission_s_may_not_be_changed(name):
    act, words = CHANGED[name]
    found = refine(returns(act)).diagnostics
    assert "R005" in {d.code for d in found}
    assert words in " ".join(written(d) for d in found if d.code == "R005")
    assert "`pass`" in found[-1].message


def without(ir, *gone):
    legs = tuple(one for k, one in enumerate(ir.drones[0].legs) if k not in gone)
    return replace(ir, drones=(replace(ir.drones[0], legs=legs),))


FORMS = {
    "no take-off": lambda ir: without(ir, 0),
    "no shot": lambda ir: without(ir, 2),
    "other order": lambda ir: replace(ir, drones=(replace(ir.drones[0], legs=ir.drones[0].legs[::-1]),)),
    "two ways in a row": lambda ir: replace(
        ir, drones=(replace(ir.drones[0], legs=(ir.drones[0].legs[0], *ir.drones[0].legs[:])),)
    ),
    "no drone": lambda ir: replace(ir, drones=()),
    "a short pose": lambda ir: standing(ir, PASS, channels=5),
    "no curve": changes(PASS, curve=lambda _: None),
    "no stops": changes(PASS, stops=lambda _: ()),
    "stops off the curve": changes(PASS, stops=lambda s: (s[0], replace(s[-1], s=1e3))),
    "keyframes out of order": changes(PASS, marks=lambda marks: marks[::-1]),
    "a cubic": changes(PASS, curve=lambda c: Piecewise(c.breaks, c.ctrl[:, 1:5])),
    "six channels": changes(PASS, curve=lambda c: Piecewise(c.breaks, c.ctrl[:, :, :6])),
    "a short curve": changes(PASS, curve=lambda c: Piecewise(c.breaks[:-1], c.ctrl[:-1])),
    "statistics": lambda ir: replace(ir, stats=(("iterations", float("nan")),)),
}


@pytest.mark.parametrize("name", FORMS)
def test_what_is_no_path_of_the_mission_is_found(name):
    outcome = refine(returns(FORMS[name]))
    assert outcome.value is None
    assert {d.code for d in outcome.diagnostics} == {"R002"}
    assert "odd-maker" in outcome.diagnostics[0].message


def test_another_mission_is_found():
    def other(ir):
        mission = ir.keyframes.mission
        rules = mission.rules._replace(ground_clearance=0.0)
        return replace(ir, keyframes=ir.keyframes._replace(mission=mission._replace(rules=rules)))

    assert told(other).code == "R005"


def test_a_moved_take_off_is_found():
    def moved(ir):
        first = ir.drones[0].legs[0]
        ctrl = first.curve.ctrl + np.eye(7)[0]
        return with_leg(ir, 0, curve=Piecewise(first.curve.breaks, ctrl))

    found = refine(returns(moved)).diagnostics
    assert any(d.code == "R005" and "moved the takeoff" in d.message for d in found)


def line(start, end, pieces=1):
    x = np.linspace(0.0, 1.0, 6)[:, None]
    curve = Piecewise(np.array([0.0, 1.0]), ((1 - x) * np.array(start) + x * np.array(end))[None])
    breaks = subdivide(curve.breaks, pieces)
    return Piecewise(breaks, np.stack([(1 - x) * curve(a) + x * curve(b) for a, b in pairwise(breaks)]))


POLE = Obstacle(owner("zone pole"), Cylinder((0.0, 0.0), 1.0, 0.0, 20.0), 0.5)
ROOM = FreeSpace(
    (POLE,),
    (Wall(owner("ground"), (0.0, 0.0, 1.0), 2.0, 2.0),),
    (Disc(owner("zone ring"), (0.0, 0.0), 50.0),),
)


@pytest.mark.parametrize("pieces", [1, 7])
@pytest.mark.parametrize(
    ("ends", "lack", "s"),
    [
        ([(-30, 1.4, 10), (30, 1.4, 10)], 0.1, 0.5),  # passes the pole by
        ([(-30, 10, 3), (30, 10, 1.5)], 0.5, 1.0),  # sinks
        ([(-30, 10, 3), (60, 10, 3)], np.hypot(60, 10) - 50, 1.0),  # leaves the ring
    ],
    ids=["pole", "ground", "ring"],
)
def test_the_worst_point_of_a_line_is_found(ends, lack, s, pieces):
    near = nearest(ROOM, line(*ends, pieces))
    assert near.lack == pytest.approx(lack, abs=2e-4)
    assert near.s == pytest.approx(s, abs=0.01)


@pytest.mark.parametrize("aside", [1.5, 1.5 + 1e-9, 2.0, 10.0])
def test_a_line_that_just_keeps_its_distance_is_free(aside):
    assert nearest(ROOM, line((-30, aside, 10), (30, aside, 10))) is None
