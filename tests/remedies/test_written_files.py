"""Helps about what files cannot carry: each is done once in a small mission, and the file carries it."""

from __future__ import annotations

from functools import partial

import pytest

from tests.remedies.test_planned import planned
from tests.support.remedies.done import Done, assert_helps

pytestmark = pytest.mark.slow

HEAD = """\
shotc: 1
mission: files
world: {origin: {lat: 47.3769, lon: 8.5417, alt: 408}}
rules: {ground_clearance: 0.5, allow: [fast-pan]}
targets: {mast: {at: [0, 0, 6], radius: 1, height: 12}}
"""
FILM = HEAD + "drones: {cam: {model: MODEL, home: [0, -40, 0]}}\nshots:\n"
TURN = FILM.replace("MODEL", "mini-4-pro") + (
    "  - {id: turn, kind: keyframes, drone: cam,\n"
    "     keyframes: [{at: [0, -25, 16], heading: 0 deg, pitch: 0 deg},\n"
    "     {at: [0, -25, 16], heading: 60 deg, pitch: 0 deg}]}\noutput: {emit: [dji]}\n"
)
PAIR = HEAD + (
    "drones: {one: {model: mini-4-pro, home: [0, -40, 0]}, two: {model: mini-4-pro, home: [10, -40, 0]}}\n"
    "shots:\n"
    "  - {id: a, kind: static, drone: one, at: [0, -25, 16], look_at: mast}\n"
    "  - {id: b, kind: static, drone: two, at: [0, -24, 16], look_at: mast, timing: {after: a}}\n"
    "output: {emit: [dji]}\n"
)
SHOW = HEAD + (
    "fleets: {swarm: {count: 8, layout: {grid: {spacing: 4, origin: [20, 20, 0]}}, model: show-drone}}\n"
    "shots:\n  - {id: ball, kind: display, fleet: swarm, frames: [{sphere: {center: [20, 20, 40], radius: 6},"
    " hold: 4}]}\noutput: {emit: [EMIT]}\n"
)
NOWHERE = ("world: {origin: {lat: 47.3769, lon: 8.5417, alt: 408}}\n", "")
LOST = (SHOW.replace(*NOWHERE), (("rules:", NOWHERE[0] + "rules:"),))
ON_MAP = "write `origin: {lat: ..., lon: ..., alt: ...}` under `world`"
CASES = [
    Done("E110", SHOW.replace("EMIT", "mavlink"), "ask for `skyc` in `output.emit`", (("mavlink", "skyc"),)),
    Done("E111", LOST[0].replace("EMIT", "skyc"), ON_MAP, LOST[1]),
    Done("E130", LOST[0].replace("EMIT", "site"), ON_MAP, LOST[1]),
    Done("E130", LOST[0].replace("EMIT", "site"), "take `site` out of `emit`", (("[site]", "[csv]"),)),
    Done("E117", TURN, "let the drone move while the camera turns", (
        ("     {at: [0, -25, 16]", "     {at: [30, -40, 16]"),)),
    Done("E120", PAIR, "air of its own by zones or heights", (
        ("at: [0, -24, 16]", "at: [30, -40, 30]"), ("home: [10, -40, 0]", "home: [30, -50, 0]"))),
    Done("E120", PAIR, "film with one drone", (("drone: two", "drone: one"),)),
]  # fmt: skip


@pytest.mark.long
@pytest.mark.parametrize("case", CASES, ids=[f"{case.code}-{i}" for i, case in enumerate(CASES)])
def test_what_a_help_proposes_does_when_it_is_written(case: Done) -> None:
    assert_helps(case, partial(planned, refiner="none"))
