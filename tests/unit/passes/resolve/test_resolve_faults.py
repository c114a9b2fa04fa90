"""What resolve finds: each fault once, on its line, with its numbers, and all of them in one run."""

from __future__ import annotations

import pytest

from tests.support.front_passes import resolved
from tests.support.resolve_missions import FIRST, at, faults, mission, only


@pytest.mark.slow
def test_every_fault_of_the_mission_is_told_in_one_run() -> None:
    text = (
        mission(
            "id: a, kind: keyframes, target: towr, keyframes: [{at: [0, -50, -2], look_at: tower}, "
            "{at: [-30, 20, 5], look_at: tower, time: 3}, {at: [0, 50, 9], look_at: towr, time: 2}]",
            "id: a, kind: static, at: [0, -50, 15], look_at: tower, timing: {after: z}",
            "id: c, kind: orbit, target: tower, radius: 2, altitude: 10",
        )
        .replace("[[-80, -80], [80, -80]", "[[80, 80], [80, -80]")
        .replace("[0, -60, 0]", "[0, -60, -4]")
    )
    found = faults(text)
    # Keyframes of the first shot are not judged: one of them looks at a target that does not exist.
    assert sorted(d.code for d in found) == ["G004", "G006", "G007", "N001", "N004", "N006"]
    (unknown,) = [d for d in found if d.code == "N001"]
    assert len(unknown.labels) == 2


def test_an_unknown_drone_silences_only_what_depends_on_it() -> None:
    text = mission(at(0, -50, 10)).replace("drone: cam1, id: a", "drone: cam2, id: a") + (
        "  - {drone: cam1, id: b, kind: static, at: [0, -50, 1], heading: 0 deg, pitch: 0 deg}\n"
    )
    assert [d.code for d in faults(text)] == ["N002", "G001"]
    assert "`cam1`" in faults(text)[0].help


@pytest.mark.parametrize(
    ("aim", "code", "says"),
    [
        ("heading: 180 deg, pitch: 0 deg", "G008", "180 deg away"),
        ("heading: 270 deg, pitch: 0 deg", "G008", "90 deg away"),
        ("heading: 60 deg, pitch: 0 deg", "G009", "60 deg away"),
        ("heading: 0 deg, pitch: -60 deg", "G009", "60 deg away"),
        ("heading: 0 deg, pitch: 45 deg", "G013", "-90.0 to 30.0 deg"),
        ("look_at: [0, -50, 12]", "G014", ""),
        ("look_at: [0, -60, 12]", "G008", "180 deg away"),
    ],
)
def test_a_framing_that_shows_nothing(aim: str, code: str, says: str) -> None:
    d = only(mission(f"id: a, kind: static, target: tower, at: [0, -50, 12], {aim}"))
    assert (d.code, says in "".join(d.notes)) == (code, True)
    assert d.labels[0].span.line == FIRST


def test_the_proposed_heading_looks_at_the_target() -> None:
    d = only(mission("id: a, kind: static, target: tower, at: [40, -40, 12], heading: 90 deg, pitch: 0 deg"))
    assert "heading: 315 deg, pitch: 0 deg" in d.help
    assert (
        faults(
            mission("id: a, kind: static, target: tower, at: [40, -40, 12], heading: 315 deg, pitch: 0 deg")
        )
        == []
    )


@pytest.mark.slow
def test_every_kind_of_a_moving_target_is_planned() -> None:
    text = mission(
        at(0, -50, 10),
        "id: b, kind: framing, subjects: [{target: runner, size: full}], timing: {duration: 5}",
        "id: c, kind: top-down, target: runner, altitude: 20",
        "id: d, kind: orbit, target: tower, radius: 50, altitude: 20, size: full",
    ).replace(
        "drones:",
        "  runner: {track: {start: [0, 0, 1], velocity: [1, 0, 0]}, radius: 0.4, height: 1.8}\ndrones:",
    )
    value, found = resolved(text)
    assert found == []
    assert value is not None
    assert value.deferred == ()
    assert [s.id for s in value.shots] == ["a", "b", "c", "d"]


def test_a_target_beside_the_camera_is_out_of_the_frame_though_it_has_no_outline() -> None:
    aim = "id: a, kind: static, target: tower, at: [-40, -30, 10], pitch: 2 deg, heading: "
    assert only(mission(aim + "142 deg")).code == "G009"
    assert faults(mission(aim + "53 deg")) == []
