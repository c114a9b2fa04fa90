"""A shot that is faster than its drone: each change that is proposed lets it keep up."""

from __future__ import annotations

import re

import pytest

from shotc.diag.model import Diagnostic
from tests.support.front_passes import resolved

MISSION = """\
shotc: 1
mission: bend
targets:
  rider:
    track: {TRACK}
    radius: 0.9
    height: 1.8
drones:
  cam1: {model: x500, home: [0, -30, 0], limits: {speed: LIMIT}}
shots:
  - {id: s, drone: cam1, target: rider, SHOT, timing: {start: 2, duration: 20}}
"""
TURN = ", ".join(
    f"[{x:.2f}, {y:.2f}, 0.9]"
    for x, y in [(0, 0), (50, 0), (57.65, 1.52), (64.14, 5.86), (68.48, 12.35), (70, 20), (70, 90)]
)
BEND = f"points: [{TURN}], speed: 6 m/s"  # to the left, by a quarter turn of 20 m
LATERAL = "kind: lateral, side: right, distance: 8, altitude: 4"


def told(
    shot: str, limit: str = "7 m/s", track: str = BEND, before: str = "targets:"
) -> tuple[Diagnostic, ...]:
    text = MISSION.replace("TRACK", track).replace("LIMIT", limit).replace("SHOT", shot)
    text = text.replace("targets:", before, 1)
    return tuple(d for d in resolved(text)[1] if d.code == "M005")


def help_of(shot: str, limit: str = "7 m/s", track: str = BEND) -> str:
    (found,) = told(shot, limit, track)
    return found.help


@pytest.mark.slow
@pytest.mark.parametrize(
    ("shot", "asked", "limit"),
    [
        (LATERAL, "distance: 8", "7 m/s"),
        ("kind: flyby, behind: 9, ahead: 9, offset: -8, altitude: 4", "offset: -8", "8.3 m/s"),
    ],
)
def test_the_place_that_is_proposed_is_the_farthest_at_which_it_keeps_up(
    shot: str, asked: str, limit: str
) -> None:
    key, _, _ = asked.partition(":")
    proposed = re.search(rf"`{key}: (-?[\d.]+) m` or nearer", help_of(shot, limit))
    assert proposed is not None
    metres = float(proposed[1])
    assert not told(shot.replace(asked, f"{key}: {metres}"), limit)
    assert told(shot.replace(asked, f"{key}: {metres * 1.06:.2f}"), limit)


def test_the_other_side_is_named_where_it_is_the_inside_of_the_bend() -> None:
    assert "`side: left`" in help_of(LATERAL)
    assert not told(LATERAL.replace("right", "left"))
    both = BEND.replace("[70.00, 90.00, 0.9]", "[71.52, 27.65, 0.9], [75.86, 34.14, 0.9], [90, 40, 0.9]")
    assert "side" not in help_of(LATERAL, track=both)


@pytest.mark.parametrize("wind", [0.0, 0.144, 1.46])
def test_a_higher_limit_is_enough(wind: float) -> None:
    windy = f"world: {{wind: {wind}}}\ntargets:"
    (found,) = told(LATERAL, before=windy)
    limit = re.search(r"`limits: \{speed: ([\d.]+ m/s)\}`", found.help)
    assert limit is not None
    assert not told(LATERAL, limit[1], before=windy)


def test_a_radius_that_changes_is_proposed_from_one_to_another() -> None:
    spiral = "kind: spiral, radius: [34, 17], altitude: [6, 9], start_azimuth: 0 deg, sweep: 360 deg"
    proposed = re.search(r"`radius: (\[[\d.]+ m, [\d.]+ m\])` or nearer", help_of(spiral, "12 m/s"))
    assert proposed is not None
    assert not told(spiral.replace("[34, 17]", proposed[1]), "12 m/s")


def test_where_the_target_itself_is_too_fast_no_place_beside_it_is_named() -> None:
    found = help_of(LATERAL, "5 m/s")
    assert "distance" not in found
    assert "side" not in found
    assert "slow down `rider`" in found


def test_what_moves_about_its_target_is_given_more_time() -> None:
    orbit = "kind: orbit, radius: 30, altitude: 10, sweep: 360 deg, start_azimuth: 180 deg"
    still = "points: [[0, 0, 0.9], [1, 0, 0.9]], speed: 0.1 m/s"
    longer = re.search(r"`duration: ([\d.]+) s`", help_of(orbit, track=still))
    assert longer is not None
    text = MISSION.replace("TRACK", still).replace("LIMIT", "7 m/s").replace("SHOT", orbit)
    assert not [
        d for d in resolved(text.replace("duration: 20", f"duration: {longer[1]}"))[1] if d.code == "M005"
    ]


FIRST = "  - {id: r, drone: cam1, kind: static, at: [20, -30, 8], look_at: [20, 0, 1], timing: {WHEN}}\n"


def after(first: str, timing: str, track: str = BEND) -> list[Diagnostic]:
    """Return M005 of the shot in the bend where another shot comes first; timing : of the later one."""
    shot = FIRST.replace("WHEN", first) + "  - {id: s,"
    text = MISSION.replace("start: 2, duration: 20", timing).replace("  - {id: s,", shot)
    text = text.replace("TRACK", track).replace("LIMIT", "7 m/s").replace("SHOT", LATERAL)
    found = resolved(text)[1]
    assert {d.code for d in found} <= {"M005"}
    return list(found)


@pytest.mark.parametrize("timing", ["after: r, duration: 20", "duration: 20"])
def test_a_shot_without_a_start_is_judged_from_the_end_of_what_it_comes_after(timing: str) -> None:
    slow = BEND.replace("6 m/s", "4 m/s")
    assert not after("start: 30, duration: 10", timing)  # it rests by then
    assert not after("start: 30, duration: 10", "start: 40, duration: 20")
    endless = "start: [0, 0, 0.9], velocity: [9, 0, 0]"
    (fault,) = after("start: 30, duration: 10", timing, endless)
    assert "begins at 40.0 s at the earliest" in fault.notes[0]
    assert float(fault.notes[0].split("t = ")[1].split()[0]) >= 40.0
    assert not after("start: 30, duration: 10", timing, slow)


@pytest.mark.parametrize("timing", ["after: r, duration: 20", "duration: 20"])
def test_where_the_end_of_what_comes_before_is_not_known_nothing_is_told(timing: str) -> None:
    assert after("start: 2, duration: 3", "start: 8, duration: 12")
    assert not after("duration: 5", timing)


def test_what_moves_evenly_for_ever_is_told_whenever_the_shot_begins() -> None:
    assert after("duration: 5", "duration: 20", "start: [0, 0, 0.9], velocity: [9, 0, 0]")
    assert not after("duration: 5", "duration: 20", "start: [0, 0, 0.9], velocity: [6, 0, 0]")


def test_a_shot_that_keeps_up_if_it_begins_a_little_later_is_left_to_planning() -> None:
    assert not after("start: 7, duration: 2", "after: r, duration: 6")
    assert after("start: 7, duration: 2", "start: 9.1, duration: 6")


def test_a_target_that_turns_back_asks_for_acceleration_as_well() -> None:
    """A drone as fast as its target, but no quicker to turn, overshoots where that turns back."""
    back = "points: [[0, 0, 0.9], [100, 0, 0.9], [0, 0, 0.9]], speed: 9 m/s"
    assert re.search(
        r"raise `limits: {speed: [\d.]+ m/s, acceleration: 9\.9 m/s\^2}`", help_of(LATERAL, track=back)
    )
    along = "points: [[0, 0, 0.9], [300, 0, 0.9]], speed: 9 m/s"
    assert "raise `limits: {speed: 9.0 m/s}`" in help_of(LATERAL, track=along)


SLIGHT = "points: [[0, 0, 0.9], [30, 0, 0.9], [90, 35, 0.9]], speed: 6 m/s"
"""A bend by 30 deg."""


def test_a_place_that_swings_round_a_slight_bend_is_left_to_planning() -> None:
    # Over 2 s the place moves at 9.7 m/s, 1.7 more than the drone, which loses 3.9 m of 15 m.
    wide = LATERAL.replace("distance: 8", "distance: 15")
    assert not told(wide, "8 m/s", SLIGHT)
    assert told(wide, "6.5 m/s", SLIGHT)  # it would lose 6.8 m, which is more than 40 %


def test_a_slight_bend_is_no_excuse_for_a_target_that_is_too_fast_itself() -> None:
    assert told(LATERAL.replace("distance: 8", "distance: 60"), "5.9 m/s", SLIGHT)
