"""Where a path cannot lead: gaps too narrow, pads that cannot be left, and what is said to help."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.ir.mission import Zone
from tests.support.path_scenes import (
    FIELD,
    block,
    codes,
    free,
    inside,
    legs,
    mission,
    out,
    planned,
    shot,
    solve,
)
from tests.support.records import replace


@pytest.mark.slow
@pytest.mark.parametrize("width", [1.22, 1.3, 1.4, 3.0])
def test_a_gap_that_the_drone_fits_through_is_used(width):
    south = out("south", block((-1, 1), (-90, -width / 2), (0, 70)))
    north = out("north", block((-1, 1), (width / 2, 90), (0, 70)))
    made = mission(inside("field", FIELD), south, north, targets=(), home=(-10.0, -60.0, 0.0))
    (leg,) = legs(planned(made, shot([free(0, (-20, 0, 8)), free(1, (20, 0, 8))])), "shot")
    flown = leg.curve(np.linspace(0, leg.curve.end, 2001))
    between = flown[np.abs(flown[:, 0]) <= 1]
    assert np.abs(between[:, 1]).max() <= width / 2 - 0.6


@pytest.mark.slow
def test_a_gap_too_narrow_is_named_with_its_width():
    south = out("south", block((-1, 1), (-90, -0.4), (0, 70)))
    north = out("north", block((-1, 1), (0.4, 90), (0, 70)))
    made = mission(inside("field", FIELD), south, north, targets=(), home=(-10.0, -60.0, 0.0))
    outcome = solve(made, shot([free(0, (-20, 0, 8)), free(1, (20, 0, 8))]))
    (fault,) = outcome.diagnostics
    assert fault.code == "Q001"
    assert "the gap between zone `south` and zone `north` is 0.80 m; the drone needs 1.20 m" in fault.notes
    assert "0.2" in fault.help


def across(*zones: Zone, clearance: float = 2.0):
    made = mission(*zones, targets=(), home=(-10.0, -60.0, 0.0))
    made = replace(made, rules=replace(made.rules, ground_clearance=clearance))
    return solve(made, shot([free(0, (-20, 0, 8)), free(1, (20, 0, 8))]))


@pytest.mark.slow
def test_a_gap_under_a_ceiling_is_measured_from_the_ceiling():
    wall = out("wall", block((-1, 1), (-90, 90), (0, 59.2)))
    (fault,) = across(inside("field", FIELD), wall).diagnostics
    assert "the gap between zone `wall` and zone `field` is 0.80 m; the drone needs 1.20 m" in fault.notes
    lower = out("wall", block((-1, 1), (-90, 90), (0, 59.2 - told(fault.help, "widen the gap by"))))
    assert across(inside("field", FIELD), lower).value is not None


@pytest.mark.slow
def test_the_ground_is_nothing_to_move_but_its_clearance_is():
    wall = out("wall", block((-1, 1), (-90, 90), (2.4, 70)))
    field = inside("field", replace(FIELD, bottom=-5.0))
    (fault,) = across(field, wall).diagnostics
    assert "the ground is 2.40 m" not in fault.help
    assert "or the ground" not in fault.help
    lower = told(fault.help, "lower rules.ground_clearance to")
    assert 0.9 < lower <= 1.2
    assert across(field, wall, clearance=lower).value is not None


@pytest.mark.long
def test_of_many_zones_that_close_a_way_any_one_is_enough():
    sides = [((10, 30), (8, 12)), ((10, 30), (-12, -8)), ((8, 12), (-12, 12)), ((28, 32), (-12, 12))]
    walls = [out(f"w{i}", block(x, y, (-20, 60))) for i, (x, y) in enumerate(sides)]
    (fault,) = across(*walls, out("lid", block((8, 32), (-12, 12), (20, 22)))).diagnostics
    assert "any one of zone `w0`, zone `w1`, zone `w2`, zone `w3` and zone `lid`" in fault.help


def told(text: str, before: str) -> float:
    return float(text.split(f"{before} ")[1].split(" m", maxsplit=1)[0])


@pytest.mark.parametrize(
    ("zones", "home", "words"),
    [
        ((out("beam", block((-1, 1), (-61, -59), (2, 3))),), (0, -60, 0), "in the way above"),
        ((inside("field", FIELD),), (0, -90, 0), "is not inside zone `field`"),
        ((inside("low", replace(FIELD, top=3.0)),), (0, -60, 0), "no height to fly at"),
    ],
)
def test_a_pad_that_cannot_be_left_says_why(zones, home, words):
    outcome = solve(
        mission(*zones, targets=(), home=tuple(map(float, home))),
        shot([free(0, (0, 0, 2.3)), free(1, (9, 0, 2.3))]),
    )
    assert outcome.value is None
    assert any(d.code == "Q002" and words in d.message for d in outcome.diagnostics)


@pytest.mark.slow
def test_a_pad_deep_under_something_is_led_out_from_under_it():
    roof = out("roof", block((-12, 12), (-72, -48), (2, 30)))
    frames = shot([free(0, (0, 0, 8)), free(1, (9, 0, 8))])
    blocked = solve(mission(roof, targets=(), home=(0.0, -60.0, 0.0)), frames)
    help_ = next(d.help for d in blocked.diagnostics if d.code == "Q002")
    x, y, z = (float(c) for c in help_.split("[")[1].split("]")[0].split(","))
    assert max(abs(x), abs(y + 60)) >= 12.5
    assert solve(mission(roof, targets=(), home=(x, y, z)), frames).value is not None


def test_all_drones_faults_are_told_in_one_run():
    made = mission(targets=(), home=(0.0, -90.0, 0.0))
    made = replace(made, zones=(inside("field", FIELD), out("box", block((-5, 5), (-5, 5), (0, 70)))))
    outcome = solve(
        made,
        shot([free(0, (-20, 0, 8)), free(1, (0, 0, 8))]),
        shot([free(0, (-20, 0, 8)), free(1, (2, 0, 8))], name="s1"),
    )
    assert sorted(codes(outcome)) == ["Q002", "Q004", "Q004"]
