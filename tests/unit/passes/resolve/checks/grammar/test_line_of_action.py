"""Cuts across the line of action, on both sides of every threshold."""

from __future__ import annotations

from math import radians, tan

import pytest

from shotc.ir.limits import Timing
from shotc.ir.mission import Composition, Ideal, MissionIR, Shot, Subject
from shotc.passes.resolve.checks.grammar import check_grammar
from tests.support.front_passes import resolved
from tests.support.grammar_missions import codes, grammar, mission


def lateral(name: str, side: str, start: float, distance: float = 8, more: str = "") -> str:
    return (
        f"id: {name}, kind: lateral, target: runner, side: {side}, distance: {distance}, altitude: 4, "
        f"timing: {{start: {start}, duration: 5}}{more}"
    )


LEFT, RIGHT = lateral("a", "left", 10), lateral("b", "right", 30, 4)


def test_a_cut_to_the_other_side_is_told_where_the_second_shot_is_placed() -> None:
    text = mission(LEFT, RIGHT)
    (found,) = grammar(text)
    assert found.code == "F001"
    line = text.splitlines()[found.labels[0].span.line - 1]
    assert line[found.labels[0].span.column - 1 :].startswith("right, distance: 4")
    assert "8.0 m to the left" in found.notes[0]
    assert "4.0 m to the right" in found.notes[0]


def test_two_shots_from_one_side_are_fine() -> None:
    assert codes(LEFT, lateral("b", "left", 30, 4)) == []


def test_a_way_back_turns_the_sides_round() -> None:
    # The runner comes back: from the same bank of its way it goes the other way on screen.
    there_and_back = {"points": ((0, 0, 0.9), (60, 0, 0.9), (0, 0, 0.9)), "times": (0, 40, 80)}
    assert codes(LEFT, lateral("b", "left", 60, 4), **there_and_back) == []
    assert codes(LEFT, lateral("b", "right", 60, 4), **there_and_back) == ["F001"]


@pytest.mark.parametrize(("degrees", "told"), [(14.0, []), (16.0, ["F001"])])
def test_a_camera_near_the_line_is_on_no_side(degrees: float, told: list[str]) -> None:
    # A static camera as high as the runner's middle, nearly ahead of it as the shot begins at t = 30 s.
    aside = -20 * tan(radians(degrees))
    ahead = (
        f"id: b, kind: static, at: [{45 + 20}, {aside}, 0.9], look_at: runner, "
        "timing: {start: 30, duration: 2}, allow: [fast-pan]"
    )
    text = mission(LEFT, ahead).replace("rules: {", "rules: {ground_clearance: 0, ")
    assert [d.code for d in grammar(text)] == told


def test_a_camera_overhead_is_on_no_side() -> None:
    above = (
        "id: b, kind: static, at: [45, -2, 12], look_at: runner, timing: {start: 30, duration: 2}, "
        "allow: [fast-pan]"
    )
    assert codes(LEFT, above) == []


def test_a_shot_between_of_something_else_makes_the_cut_good() -> None:
    away = "id: c, kind: static, at: [20, 60, 4], look_at: statue, timing: {start: 18, duration: 3}"
    assert codes(LEFT, away, RIGHT) == []
    chase = "id: c, kind: chase, target: runner, distance: 8, altitude: 3, timing: {start: 20, duration: 4}"
    assert codes(LEFT, chase, RIGHT) == []


def test_a_camera_that_goes_over_the_line_establishes_the_new_side() -> None:
    # From South (right) by way of ahead to North (left) of a runner who goes East.
    over = (
        "id: c, kind: orbit, target: runner, radius: 9, altitude: 4, start_azimuth: 180 deg, sweep: 180 deg, "
        "timing: {start: 20, duration: 10}"
    )
    assert codes(LEFT, over) == []
    assert codes(over, lateral("b", "left", 45, 4)) == []
    assert codes(over, lateral("b", "right", 45, 4)) == ["F001"]


def test_the_film_is_cut_in_flown_order_over_all_drones() -> None:
    first, second, third = (
        f"drone: cam{n}, {lateral(name, side, start, distance)}"
        for n, name, side, start, distance in (
            (1, "a", "left", 10, 8),
            (2, "b", "left", 20, 4),
            (1, "c", "right", 40, 8),
        )
    )
    assert codes(first, second) == []
    # Written before it, `c` is flown last: from `b` to `c` is the only cut across.
    (found,) = grammar(mission(first, third, second))
    assert found.message.startswith("the cut from `b` to `c`")


def test_a_standing_subject_has_no_line() -> None:
    south, north = (
        f"id: {n}, kind: static, at: [0, {y}, 4], look_at: statue, timing: {{duration: 4}}"
        for n, y in (("a", 20), ("b", 60))
    )
    assert codes(south, north) == []


def test_a_start_that_is_not_known_matters_only_round_a_bend() -> None:
    a, b = (s.replace(f"start: {t}, ", "") for s, t in ((LEFT, 10), (RIGHT, 30)))
    assert codes(a, b) == ["F001"]
    bend = {"points": ((0, 0, 0.9), (45, 0, 0.9), (45, 45, 0.9)), "times": (0, 30, 60)}
    assert codes(a, b, **bend) == []


def test_it_is_allowed_by_name_in_the_shot_it_leads_to_or_everywhere() -> None:
    allowed = ", allow: [crossing-the-line]"
    assert codes(LEFT, lateral("b", "right", 30, 4, allowed)) == []
    assert codes(lateral("a", "left", 10, 8, allowed), RIGHT) == ["F001"]
    assert codes(LEFT, RIGHT, allow="crossing-the-line") == []


def together(y: float) -> list[str]:
    """Film the runner and the statue together from South of their line, then from ``y``."""
    base = resolved(mission(LEFT))[0]
    assert base is not None

    def shot(name: str, index: int, place: tuple[float, float, float], start: float) -> Shot:
        who = tuple(Subject(n, Composition("none"), None, None, ("shots", 0)) for n in ("runner", "statue"))
        ideal = Ideal("world", None, ((0.0, place), (1.0, place)))
        return base.shots[0]._replace(
            id=name, ideal=ideal, subjects=who, timing=Timing(start, None, 1e-3), path=("shots", index)
        )

    # At t = 0 the line runs North from the runner at [0, 0] to the statue at [0, 40].
    shots = (shot("a", 0, (30.0, 20.0, 4.0), 0.0), shot("b", 1, (y, 25.0, 9.0), 0.0))
    pair: MissionIR = base._replace(shots=shots)
    found = check_grammar(pair, {(): frozenset({"short-shot", "fast-pan", "jump-cut"})})
    return [d.code for d in found]


def test_the_line_between_two_that_are_filmed_together() -> None:
    assert together(20.0) == []
    assert together(-20.0) == ["F001"]
    assert together(-1.0) == []
