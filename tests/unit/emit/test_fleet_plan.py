"""Fleets in plan.json: exact round trip, bytes that stay, lights as texts, and edits that are noticed."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from shotc.diag.registry import registry
from shotc.emit.plan_json import EMITTER
from shotc.ir.mission import MissionIR
from shotc.ir.origin import OriginMap
from shotc.ir.show import Box, Drawing, Lettering, Model, Picture, Sphere, Torus
from shotc.ir.text import field_names
from shotc.ir.trajectory import TrajectoryIR, VerifiedIR
from shotc.passes.verify.file import verify_file
from shotc.planfile.codec import alternatives
from shotc.planfile.compare import compare
from shotc.planfile.read import read_plan
from shotc.source.file import Span
from tests.support.lowered_missions import always
from tests.support.records import replace
from tests.support.show_plans import CONTEXT, PADS, display, fleet, mission, plan

PLAN = plan()
DATA = EMITTER.emit(PLAN).artifacts[0].data
LOWER = always(PLAN.trajectory.keyframes)


def same(a: Any, b: Any) -> bool:
    if isinstance(a, np.ndarray):
        return a.dtype == b.dtype and np.array_equal(a, b)
    if names := field_names(a):
        return type(a) is type(b) and all(same(getattr(a, name), getattr(b, name)) for name in names)
    if isinstance(a, tuple):
        return isinstance(b, tuple) and len(a) == len(b) and all(map(same, a, b))
    return type(a) is type(b) and a == b


def test_a_show_comes_back_as_it_was() -> None:
    read = read_plan(DATA, "plan.json")
    assert read.diagnostics == ()
    assert same(read.trajectory, PLAN.trajectory)
    assert same(read.certificate, PLAN.certificate)
    verdict = verify_file(DATA, "plan.json", CONTEXT, LOWER)
    assert verdict.diagnostics == ()
    assert verdict.plan is not None
    assert verdict.certificate == PLAN.certificate
    assert EMITTER.emit(verdict.plan).artifacts[0].data == DATA


def test_every_source_comes_back_and_files_stay_away() -> None:
    sources = (
        Sphere((0.0, 0.0, 30.0), 5.0),
        Box((0.0, 0.0, 30.0), (4.0, 5.0, 6.0), 0.5),
        Torus((0.0, 0.0, 30.0), 5.0, 1.0, 0.0, 1.0),
        Lettering("SHOTC", (0.0, 0.0, 30.0), 6.0, 0.0, None),
        Lettering("HI", (0.0, 0.0, 30.0), 6.0, 0.0, "my.ttf"),
        Drawing("star.svg", (0.0, 0.0, 30.0), 6.0, 0.0),
        Model(("a.ply", "b.ply"), 2.0, None, 10.0, 0.0),
        Model(("a.ply",), None, (0.0, 0.0, 30.0), None, 0.0),
    )
    pictures = tuple(Picture(s, "volume", (1, 2, 3), None, 0.0, ("shots", 0)) for s in sources)
    asked = mission(displays=(display()._replace(pictures=pictures),), files=(("a.ply", b"secret"),))
    data = EMITTER.emit(plan(asked)).artifacts[0].data
    assert b"secret" not in data
    read = read_plan(data, "plan.json").trajectory
    assert read is not None
    assert read.keyframes.mission == asked._replace(files=())
    assert {type(s) for s in sources} <= alternatives(TrajectoryIR)


def test_a_drone_is_a_line_of_short_numbers() -> None:
    document = json.loads(DATA)
    (track,) = document["fleets"]
    assert track["lights"]["colors"] == ["000000ffffffffffffff8000ff8000000000"] * 4
    assert [len(row) for row in track["coef"]] == [26] * 4
    lines = DATA.decode("ascii").splitlines()
    assert sum(line.strip().startswith("[[0.0,0.0,0.0],[0.0,0.0,0.0]") for line in lines) == 1


def test_spans_of_fleets_and_displays_travel() -> None:
    span = Span(4, 1, 4, 9)
    keys = {("fleets", "swarm"): span, ("shots", 0): span, ("fleets", "swarm", "separation"): span}
    asked: MissionIR = mission(origins=OriginMap("show.yaml", keys, {}))
    made = plan(asked)
    assert next(c.path for c in made.certificate if c.constraint == "separation")[-1] == "separation"
    read = read_plan(EMITTER.emit(made).artifacts[0].data, "plan.json").trajectory
    assert read is not None
    assert read.keyframes.mission.origins.keys == keys


def track(document: dict[str, Any]) -> dict[str, Any]:
    return document["fleets"][0]


def asked(document: dict[str, Any]) -> dict[str, Any]:
    return document["mission"]["fleets"][0]


def shown(document: dict[str, Any]) -> dict[str, Any]:
    return document["mission"]["displays"][0]


EARLY = {"time": -1.0, "along": "up", "by": "goal", "center": None}
EDITS: list[tuple[str, Callable[[dict[str, Any]], Any], str, str]] = [
    ("a control point", lambda d: track(d)["coef"][1][7].__setitem__(2, 60.0), "V001", "swarm-2"),
    ("drones that meet", lambda d: track(d)["coef"].__setitem__(1, track(d)["coef"][0]), "V022", "swarm-1"),
    ("a limit", lambda d: asked(d)["limits"].update(speed=4.0), "V001", "4 m/s"),
    ("a loosened limit", lambda d: asked(d)["limits"].update(speed=20.0), "V040", "speed"),
    ("a loosened separation", lambda d: asked(d)["apart"].update(horizontal=0.5), "V040", "separation"),
    ("a pad elsewhere", lambda d: asked(d)["pads"].__setitem__(0, [0.0, 1.0, 0.0]), "V012", "swarm-1"),
    ("the worst drone", lambda d: d["certificate"][3].update(worst=4.0), "V040", "speed"),
    ("a claim removed", lambda d: d["certificate"].pop(3), "V040", "speed"),
    ("a phase", lambda d: track(d)["phases"][2].update(end=27.0), "V014", "27"),
    ("a faster clock", lambda d: track(d).update(breaks=[t / 2 for t in track(d)["breaks"]]), "V014", ""),
    ("a missing break", lambda d: track(d)["breaks"].pop(), "E003", "coef"),
    ("breaks that go back", lambda d: track(d)["breaks"].__setitem__(3, 1.0), "E003", "breaks"),
    ("one drone less", lambda d: track(d)["coef"].pop(), "E003", "coef"),
    ("a ragged drone", lambda d: track(d)["coef"][2].pop(), "E003", "coef"),
    ("points on a map", lambda d: track(d).update(coef=[[[0, 0]] * 26] * 4), "E003", "coef"),
    ("a text for a number", lambda d: track(d)["coef"][0].__setitem__(0, ["0", 0, 0]), "E003", "coef"),
    ("a huge number", lambda d: track(d)["coef"][0].__setitem__(0, [1e300, 0, 0]), "E003", "coef"),
    ("a fleet of none", lambda d: track(d).update(fleet="crowd"), "E003", "crowd"),
    ("a fleet twice", lambda d: d["fleets"].append(track(d)), "E003", "twice"),
    ("no fleets", lambda d: d.pop("fleets"), "E003", "fleets"),
    ("no flight", lambda d: d.update(fleets=[]), "V015", "globe"),
    ("colours for fewer", lambda d: track(d)["lights"]["colors"].pop(), "E003", "lights.colors"),
    ("half a colour", lambda d: track(d)["lights"].update(colors=["fff"] * 4), "E003", "lights.colors"),
    ("no colour", lambda d: track(d)["lights"].update(colors=["gg0000ff8000"] * 4), "E003", "lights.colors"),
    ("blanks", lambda d: track(d)["lights"].update(colors=["ff  00ff8000"] * 4), "E003", "lights.colors"),
    ("numbers for colours", lambda d: track(d)["lights"].update(colors=[1, 2]), "E003", "lights.colors"),
    ("lights that go back", lambda d: track(d)["lights"].update(times=[5, 2]), "E003", "lights.times"),
    ("lights at no time", lambda d: track(d)["lights"].update(times=[]), "E003", "lights.times"),
    ("an unknown picture", lambda d: track(d)["shown"][0].update(picture=7), "E003", "shown[0]"),
    ("a picture before all", lambda d: track(d)["shown"][0].update(picture=-1), "E003", "shown[0]"),
    ("a display of none", lambda d: shown(d).update(fleet="crowd"), "E003", "crowd"),
    ("no pictures", lambda d: shown(d).update(pictures=[]), "E003", "pictures"),
    ("an unknown source", lambda d: shown(d)["pictures"][0]["source"].update(type="Cone"), "E003", "source"),
    ("a source of no type", lambda d: shown(d)["pictures"][1]["source"].pop("type"), "E003", "source"),
    ("a colour too bright", lambda d: shown(d)["pictures"][0].update(color=[256, 0, 0]), "E003", "color"),
    ("a hold before", lambda d: shown(d)["pictures"][0].update(hold=-1), "E003", "hold"),
    ("a wave before", lambda d: shown(d)["pictures"][1].update(wave=EARLY), "E003", "wave.time"),
    ("an unknown easing", lambda d: shown(d)["pictures"][1].update(easing="steps"), "E003", "easing"),
    ("a name of no target", lambda d: shown(d)["pictures"][0].update(name="moon"), "E003", "name"),
    ("another pace", lambda d: shown(d).update(pace=3), "E003", "pace"),
    ("a weight of none", lambda d: shown(d).update(weight="nan"), "E003", "weight"),
    ("a weight below", lambda d: shown(d).update(weight=-1), "E003", "weight"),
    ("no pads", lambda d: asked(d).update(pads=[]), "E003", "pads"),
    ("no endurance", lambda d: asked(d).update(endurance=0), "E003", "endurance"),
    ("a margin below", lambda d: asked(d)["apart"].update(margin=-0.1), "E003", "margin"),
    ("a shape of none", lambda d: asked(d)["apart"].update(shape="cube"), "E003", "shape"),
    ("endless flight", lambda d: track(d)["breaks"].__setitem__(-1, 1e9), "E003", "breaks"),
    ("two displays of a name", lambda d: d["mission"]["displays"].append(shown(d)), "E003", "globe"),
]  # fmt: skip


@pytest.mark.parametrize(("edit", "code", "said"), [e[1:] for e in EDITS], ids=[e[0] for e in EDITS])
def test_edits_are_noticed(edit: Callable[[dict[str, Any]], Any], code: str, said: str) -> None:
    document = json.loads(DATA)
    edit(document)
    verdict = verify_file(
        json.dumps(document).encode(), "plan.json", CONTEXT, always(PLAN.trajectory.keyframes)
    )
    found = [d for d in verdict.diagnostics if d.code == code]
    assert any(said in d.message for d in found)
    assert verdict.plan is None
    assert all(d.code in registry() for d in verdict.diagnostics)


def places_in(value: Any, path: tuple[str | int, ...] = ()) -> list[tuple[str | int, ...]]:
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    return [path, *(p for key, item in items for p in places_in(item, (*path, key)))]


DOCUMENT = json.loads(DATA)
PLACES = [p for p in places_in(DOCUMENT) if p[:1] == ("fleets",) or p[1:2] in (("fleets",), ("displays",))]
JUNK = [None, True, -1, 0, 1e12, 10**400, "", "inf", "x", [], {}, [[]], [[0.0, 1.0]], {"type": "Sphere"}]


@pytest.mark.long
@settings(max_examples=300, deadline=None)
@given(st.sampled_from(PLACES), st.sampled_from(JUNK))
def test_any_value_anywhere_is_told_not_raised(place: tuple[str | int, ...], junk: Any) -> None:
    document = json.loads(DATA)
    at = document
    for key in place[:-1]:
        at = at[key]
    at[place[-1]] = junk
    verdict = verify_file(
        json.dumps(document).encode(), "plan.json", CONTEXT, always(PLAN.trajectory.keyframes)
    )
    assert all(d.code in registry() for d in verdict.diagnostics)


def test_two_shows_compared() -> None:
    assert compare(PLAN, PLAN).claims == ()
    (shot,) = compare(PLAN, PLAN).shots
    assert (shot.shot, shot.distance) == ("globe", 0.0)
    coef = PLAN.trajectory.fleets[0].coef.copy()
    coef[2, 8:13, 0] += 1.5
    moved = replace(PLAN.trajectory, fleets=(replace(PLAN.trajectory.fleets[0], coef=coef),))
    found = compare(PLAN, VerifiedIR(moved, PLAN.certificate))
    assert found.shots[0].distance == pytest.approx(1.5)
    (change,) = found.fleets
    assert (change.fleet, change.drones, change.duration) == ("swarm", (4, 4), (46.0, 46.0))
    fewer = plan(mission(fleets=(fleet(PADS[:3]),)))
    found = compare(PLAN, fewer)
    assert found.shots[0].distance is None
    assert found.fleets[0].drones == (4, 3)
