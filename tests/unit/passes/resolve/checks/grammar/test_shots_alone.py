"""Short shots, fast pans and subjects that leave: each rule on both sides of its threshold."""

from __future__ import annotations

from math import degrees, radians, tan

import pytest

from tests.support.front_passes import loaded, resolved
from tests.support.grammar_missions import at, codes, grammar, mission

WIDTH = degrees(2 * tan(radians(35)))  # degrees of turn that move the picture by one frame width


@pytest.mark.parametrize(("duration", "told"), [(1.9, ["F003"]), (2.0, [])])
def test_a_shot_wants_two_seconds(duration: float, told: list[str]) -> None:
    shot = f"id: a, kind: static, at: [0, 20, 4], look_at: statue, timing: {{duration: {duration}}}"
    assert codes(shot) == told
    assert codes(shot, allow="short-shot") == []


def test_a_shot_without_a_duration_is_not_short() -> None:
    assert (
        codes("id: a, kind: elevator, target: statue, azimuth: 0 deg, distance: 9, altitude: [4, 4.5]") == []
    )


def sweep(turn: float, timing: str, *, hold: float = 0.0, first: float = 0.0, more: str = "") -> str:
    return (
        f"id: a, kind: keyframes, timing: {timing}{more}, keyframes: ["
        f"{{at: [0, 0, 9], heading: {first} deg, pitch: 0 deg, hold: {hold}}}, "
        f"{{at: [1, 0, 9], heading: {first + turn} deg, pitch: 0 deg}}]"
    )


@pytest.mark.parametrize(("seconds", "told"), [(6.9, ["F005"]), (7.1, [])])
def test_a_free_pan_takes_seven_seconds_a_width(seconds: float, told: list[str]) -> None:
    assert codes(sweep(WIDTH, f"{{duration: {seconds}}}")) == told
    assert codes(sweep(-WIDTH, f"{{duration: {seconds}}}", first=20)) == told
    assert codes(sweep(WIDTH, f"{{duration: {seconds + 5}}}", hold=5)) == told
    assert codes(sweep(WIDTH, f"{{duration: {seconds}}}"), allow="fast-pan") == []


def test_a_pan_is_told_on_its_duration_with_what_it_needs() -> None:
    text = mission(sweep(WIDTH, "{duration: 5}", hold=1))
    (found,) = grammar(text)
    line, column = at(found)
    assert text.splitlines()[line - 1][column - 1 :].startswith("5}")
    assert "in 4.0 s" in found.notes[0]
    assert found.help.startswith("write `duration: 8.0 s` or more")
    assert codes(sweep(WIDTH, "{duration: 8.0}", hold=1)) == []


def test_turns_are_counted_as_they_are_written() -> None:
    assert codes(sweep(20, "{duration: 10}")) == []
    assert codes(sweep(380, "{duration: 10}")) == ["F005"]


def test_a_pan_whose_time_is_free_is_not_told() -> None:
    assert codes(sweep(170, "auto")) == []


def test_a_time_between_tells_the_stretch_before_it() -> None:
    def timed(seconds: float) -> str:
        return (
            "id: a, kind: keyframes, keyframes: [{at: [0, 0, 9], heading: 0 deg, pitch: 0 deg}, "
            f"{{at: [1, 0, 9], heading: {WIDTH} deg, pitch: 0 deg, time: {seconds}}}, "
            f"{{at: [2, 0, 9], heading: {WIDTH} deg, pitch: 0 deg}}]"
        )

    assert codes(timed(6.9)) == ["F005"]
    assert codes(timed(7.1)) == []
    text = mission(timed(3))
    (found,) = grammar(text)
    line, column = at(found)
    assert text.splitlines()[line - 1][column - 8 :].startswith(" time: 3}")
    assert found.help.startswith("write `time: 7.0 s` or more, or write")
    assert codes(timed(7.0)) == []


@pytest.mark.parametrize("hold", [0, 2])
def test_what_ends_a_pan_counts_all_that_was_before_it(hold: float) -> None:
    def film(time: float, duration: float) -> str:
        return (
            f"id: a, kind: keyframes, timing: {{duration: {duration}}}, keyframes: ["
            f"{{at: [0, 0, 9], heading: 0 deg, pitch: 0 deg, hold: {hold}}}, "
            f"{{at: [1, 0, 9], heading: {WIDTH} deg, pitch: 0 deg, hold: {hold}, time: {time}}}, "
            f"{{at: [2, 0, 9], heading: 0 deg, pitch: 0 deg, hold: {hold}}}]"
        )

    (first,) = grammar(mission(film(hold + 4, 60)))
    assert f"`time: {hold + 7}.0 s` or more, and move what follows by as much" in first.help
    assert codes(film(hold + 7, 60)) == []
    (second,) = grammar(mission(film(20, 20 + hold + 4 + hold)))
    end = 20 + hold + 7 + hold
    assert f"`duration: {end}.0 s` or more" in second.help
    assert codes(film(20, end)) == []


@pytest.mark.parametrize(("share", "told"), [(0.95, ["F005"]), (1.05, [])])
def test_behind_a_subject_three_seconds_a_width_will_do(share: float, told: list[str]) -> None:
    # An orbit turns the camera by its sweep.
    seconds = 3 * 360 / WIDTH * share
    orbit = (
        "id: a, kind: orbit, target: statue, radius: 12, altitude: 2.6, "
        f"timing: {{duration: {seconds:.3f}}}, allow: [jump-cut]"
    )
    assert codes(orbit) == told


@pytest.mark.parametrize(("y", "told"), [(-2.5, ["F005"]), (-6.5, [])])
def test_a_runner_that_passes_near_turns_the_camera_fast(y: float, told: list[str]) -> None:
    # 1.5 m/s past a camera turn it by 1.5 m / distance a second: three seconds a width are 3.2 m.
    shot = f"id: a, kind: static, at: [45, {y}, 2.7], look_at: runner, timing: {{start: 20, duration: 20}}"
    assert codes(shot) == told


WATCH = (
    "id: a, kind: static, target: runner, at: [30, -20, 4], {aim}, "
    "timing: {{start: {start}, duration: {lasts}}}"
)


@pytest.mark.parametrize("aim", ["heading: 0 deg, pitch: -5 deg", "look_at: [30, 0, 2.25]"])
def test_a_runner_leaves_the_picture_of_a_camera_that_does_not_turn(aim: str) -> None:
    # The frame is 28 m wide there: the runner is in it from x = 16 to x = 44, t = 10.6 to 29.4 s.
    assert codes(WATCH.format(aim=aim, start=12, lasts=16)) == []
    (found,) = grammar(mission(WATCH.format(aim=aim, start=12, lasts=24)))
    assert found.code == "F004"
    assert "walks out" in found.message
    assert "from t = 12.0 s to 29." in found.notes[0]
    assert codes(WATCH.format(aim=aim, start=12, lasts=24), allow="walks-out-of-frame") == []


def test_a_runner_that_is_late_or_never_comes_is_told_too() -> None:
    aim = "heading: 0 deg, pitch: -5 deg"
    (late,) = grammar(mission(WATCH.format(aim=aim, start=5, lasts=20)))
    assert "not in the picture" in late.message
    (never,) = grammar(mission(WATCH.format(aim="heading: 180 deg, pitch: -5 deg", start=12, lasts=16)))
    assert "never" in never.message


def test_half_a_second_of_an_empty_frame_is_no_matter() -> None:
    aim = "heading: 0 deg, pitch: -5 deg"
    leaves = 29.64
    assert codes(WATCH.format(aim=aim, start=12, lasts=leaves - 12 + 0.3)) == []
    assert codes(WATCH.format(aim=aim, start=12, lasts=leaves - 12 + 0.9)) == ["F004"]


def test_an_aim_that_the_gimbal_does_not_reach_is_told() -> None:
    text = mission(WATCH.format(aim="heading: 0 deg, pitch: 80 deg", start=12, lasts=16))
    found = resolved(text)[1]
    assert [d.code for d in found] == ["G013"]


def test_a_camera_cannot_look_at_its_own_place() -> None:
    text = mission(WATCH.format(aim="look_at: [30, -20, 4]", start=12, lasts=16))
    assert [d.code for d in resolved(text)[1]] == ["G014"]


def test_an_unknown_name_is_told_with_the_nearest() -> None:
    text = mission(sweep(20, "{duration: 10}", more=", allow: [fast-pans]"), allow="jump-cuts")
    found = loaded(text)[1]
    assert [d.code for d in found] == ["S009", "S009"]
    assert [d.help for d in found] == ["did you mean `jump-cut`?", "did you mean `fast-pan`?"]
