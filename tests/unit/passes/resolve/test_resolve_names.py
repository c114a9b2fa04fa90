"""Names in missions: what is proposed for one that is unknown, and circles of waits."""

from __future__ import annotations

import pytest
import yaml

from shotc.diag.model import Diagnostic
from shotc.passes.resolve.lower.names import emitters_of
from shotc.spec.mission import MissionSpec
from tests.support.front_passes import placed

HEAD = """\
shotc: 1
mission: names
targets: {tower: {at: [0, 0, 12], radius: 4, height: 24}}
drones: {cam1: {home: [0, -60, 0]}, cam2: {home: [9, -60, 0]}}
output: {emit: [EMIT]}
shots:
"""


def faults(
    *waits: str | None, drone: str = "cam1", target: str = "tower", emit: str = "csv"
) -> list[Diagnostic]:
    shots = "".join(
        f"  - {{id: s{i}, kind: static, drone: {drone}, at: [0, -50, 12], look_at: {target}"
        + (f", timing: {{after: {w}}}" if w else "")
        + "}\n"
        for i, w in enumerate(waits)
    )
    return placed(HEAD.replace("EMIT", emit) + shots)[1]


@pytest.mark.parametrize(
    ("wrong", "code", "proposal"),
    [
        ({"drone": "cam3"}, "N002", "cam"),
        ({"drone": "drone"}, "N002", "known are cam1, cam2"),
        ({"target": "tovwer"}, "N001", "did you mean `tower`?"),
        ({"emit": "cvs"}, "N005", "did you mean `csv`?"),
        ({"emit": "pdf"}, "N005", "known are csv"),
    ],
)
def test_the_nearest_name_is_proposed(wrong: dict[str, str], code: str, proposal: str) -> None:
    (d,) = faults(None, **wrong)
    assert d.code == code
    assert proposal in d.help
    (value,) = wrong.values()
    assert d.labels[0].span.end_column - d.labels[0].span.column == len(value)


@pytest.mark.parametrize(
    ("waits", "circles"),
    [
        ((None, "s0", "s1"), []),
        (("s0",), [1]),
        (("s1", "s0"), [2]),
        (("s1", "s2", "s0"), [3]),
        (("s1", "s2", "s1"), [2]),
        (("s1", "s0", "s3", "s2"), [2, 2]),
    ],
)
def test_each_circle_of_waits_is_told_once(waits: tuple[str | None, ...], circles: list[int]) -> None:
    found = faults(*waits)
    assert [d.code for d in found] == ["N007"] * len(circles)
    assert [len(d.labels) for d in found] == circles


def test_a_wait_for_nobody() -> None:
    (d,) = faults(None, "s9")
    assert (d.code, d.labels[0].span.line) == ("N004", 8)
    (d,) = faults("s9")
    assert d.help == "the mission has no other shot"


def test_a_name_used_twice_is_blamed_on_the_second() -> None:
    text = HEAD.replace("EMIT", "csv") + (
        "  - {id: a, kind: static, drone: cam1, at: [0, -50, 12], look_at: tower}\n" * 3
    )
    found = placed(text)[1]
    assert [(d.code, d.labels[0].span.line, d.labels[1].span.line) for d in found] == [
        ("N006", 8, 7),
        ("N006", 9, 7),
    ]


def test_targets_are_known_though_no_keyframe_uses_them() -> None:
    text = HEAD.replace("EMIT", "csv") + (
        "  - {id: a, kind: static, drone: cam1, target: towr, at: [0, -50, 12], look_at: tower}\n"
    )
    assert [d.code for d in placed(text)[1]] == ["N001"]


def test_a_name_unknown_in_many_places_is_told_once() -> None:
    text = HEAD.replace("EMIT", "csv") + "".join(
        f"  - {{id: s{i}, kind: static, drone: cam9, at: [0, -50, 12], look_at: towr}}\n" for i in range(6)
    )
    found = placed(text)[1]
    assert [(d.code, [label.span.line for label in d.labels]) for d in found] == [
        ("N002", [7, 8, 9, 10]),
        ("N001", [7, 8, 9, 10]),
    ]
    assert all("6 places" in d.notes[0] for d in found)


def test_a_silent_mission_gets_the_emitters_that_suit_it() -> None:
    def emitters(kind: str, output: str = "") -> tuple[str, ...]:
        text = f"shotc: 1\nmission: m\nshots: [{{id: a, kind: {kind}, drone: cam}}]\n{output}"
        return emitters_of(MissionSpec.model_validate(yaml.safe_load(text)))

    on_earth = "world: {origin: {lat: 47, lon: 8}}\n"
    assert emitters("orbit", on_earth) == ("csv", "mavlink", "storyboard", "rerun")
    assert emitters("orbit") == ("csv", "storyboard", "rerun")
    assert emitters("display") == ("csv", "skyc", "contact-sheet", "animatic", "rerun")
    assert emitters("display", "output: {emit: []}\n") == ()
