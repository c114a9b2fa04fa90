"""plan.json: exact round trip, the same bytes twice, and any other bytes told as diagnostics."""

import json
from collections.abc import Callable
from hashlib import sha256
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from shotc.diag.registry import registry
from shotc.emit.plan_json import EMITTER
from shotc.geom.bernstein import Piecewise
from shotc.geom.solids import Cylinder
from shotc.ir.mission import Zone
from shotc.ir.origin import OriginMap
from shotc.ir.passes import PassContext
from shotc.ir.path import ClockDeviation, PathDeviation
from shotc.ir.text import field_names
from shotc.ir.trajectory import VerifiedIR
from shotc.lowering import lower_kept
from shotc.passes.verify import Verify
from shotc.passes.verify.file import verify_file
from shotc.planfile import layout
from shotc.planfile.compare import compare
from shotc.planfile.read import read_plan
from shotc.source.file import Span
from tests.support.film_plans import orbit_plan
from tests.support.lowered_missions import always
from tests.support.records import replace

CONTEXT = PassContext()


def verified(plan: VerifiedIR) -> VerifiedIR:
    value = Verify().run(plan.trajectory, CONTEXT).value
    assert value is not None
    return value


PLAN = verified(orbit_plan())
DATA = EMITTER.emit(PLAN).artifacts[0].data


def same(a: Any, b: Any) -> bool:
    if isinstance(a, Piecewise):
        return np.array_equal(a.breaks, b.breaks) and np.array_equal(a.ctrl, b.ctrl)
    if names := field_names(a):
        return type(a) is type(b) and all(same(getattr(a, name), getattr(b, name)) for name in names)
    if isinstance(a, tuple):
        return isinstance(b, tuple) and len(a) == len(b) and all(map(same, a, b))
    return type(a) is type(b) and a == b if not isinstance(a, float) else a == b


def edited(edit: Callable[[dict[str, Any]], None]) -> bytes:
    document = json.loads(DATA)
    edit(document)
    return json.dumps(document).encode()


def test_ir_to_bytes_to_ir_is_identity() -> None:
    read = read_plan(DATA, "plan.json")
    assert read.diagnostics == ()
    assert read.trajectory is not None
    assert same(read.trajectory, PLAN.trajectory)
    assert same(read.certificate, PLAN.certificate)


def test_a_deviation_is_at_a_length_or_at_a_time() -> None:
    shot = PLAN.trajectory.keyframes.shots[0].shot.id
    both = (PathDeviation(shot, 1.0, 3.0, "zone tree"), ClockDeviation(shot, 0.5, 7.0, "drone cam2"))
    plan = replace(PLAN, trajectory=replace(PLAN.trajectory, deviations=both))
    (artifact,) = EMITTER.emit(plan).artifacts
    one, other = json.loads(artifact.data)["deviations"]
    assert (one["type"], one["s"]) == ("PathDeviation", 3.0)
    assert (other["type"], other["t"]) == ("ClockDeviation", 7.0)
    assert "t" not in one
    assert "s" not in other
    read = read_plan(artifact.data, "plan.json").trajectory
    assert read is not None
    assert read.deviations == both


@pytest.mark.slow
def test_the_same_bytes_twice_and_after_reading() -> None:
    again = EMITTER.emit(verified(orbit_plan())).artifacts[0]
    assert again.name == "plan.json"
    assert again.data == DATA
    verdict = verify_file(DATA, "plan.json", CONTEXT, always(PLAN.trajectory.keyframes))
    assert verdict.diagnostics == ()
    assert verdict.plan is not None
    assert verdict.certificate == PLAN.certificate
    assert EMITTER.emit(verdict.plan).artifacts[0].data == DATA


def test_the_file_is_versioned_and_can_be_skimmed() -> None:
    document = json.loads(DATA)
    assert (document["format"], document["version"]) == ("shotc-plan", 1)
    assert document["source"]["sha256"] == sha256("\n".join(document["source"]["text"]).encode()).hexdigest()
    assert document["drones"][0]["phases"][2] == {"name": "shot", "shot": "half", "start": 22.0, "end": 52.0}
    lines = DATA.decode("ascii").splitlines()
    assert max(map(len, lines)) < 450
    assert '      {"name": "takeoff", "shot": null, "start": 0.0, "end": 8.0},' in [
        line[2:] for line in lines
    ]


def test_spans_that_are_used_travel_and_others_do_not() -> None:
    mission = PLAN.trajectory.keyframes.mission
    speed = ("drones", "cam1", "limits", "speed")
    origins = OriginMap(
        "dir/a.yaml",
        {("shots", 0, "id"): Span(9, 1, 9, 2), ("drones", "cam1"): Span(3, 1, 3, 5)},
        {speed: Span(4, 1, 4, 9), ("shots", 0): Span(8, 1, 9, 9)},
    )
    keyframes = replace(PLAN.trajectory.keyframes, mission=replace(mission, origins=origins))
    data = EMITTER.emit(VerifiedIR(replace(PLAN.trajectory, keyframes=keyframes), PLAN.certificate))
    read = read_plan(data.artifacts[0].data, "plan.json").trajectory
    assert read is not None
    found = read.keyframes.mission.origins
    assert found.file == "dir/a.yaml"
    assert found.values == origins.values
    assert found.keys == {("drones", "cam1"): Span(3, 1, 3, 5)}


@pytest.mark.slow
def test_unlimited_heights_and_missing_origins_survive() -> None:
    mission = orbit_plan(origin=False).trajectory.keyframes.mission
    sky = Zone(
        "sky", "out", Cylinder((70.0, 70.0), 2.0, -float("inf"), float("inf")), ("world", "zones", "sky")
    )
    plan = orbit_plan(origin=False).trajectory
    plan = replace(plan, keyframes=replace(plan.keyframes, mission=replace(mission, zones=(sky,))))
    data = EMITTER.emit(verified(VerifiedIR(plan, ()))).artifacts[0].data
    read = read_plan(data, "plan.json").trajectory
    assert read is not None
    assert same(read, plan)
    assert verify_file(data, "plan.json", CONTEXT, always(plan.keyframes)).diagnostics == ()


def curve(document: dict[str, Any]) -> dict[str, Any]:
    return document["drones"][0]["curve"]


def drone(document: dict[str, Any]) -> dict[str, Any]:
    return document["mission"]["drones"][0]


EDITS: list[tuple[str, Callable[[dict[str, Any]], None], str, str]] = [
    ("control point", lambda d: curve(d)["control"][40][2].__setitem__(0, 1e3), "V011", "cam1"),
    ("limit", lambda d: drone(d)["limits"].update(speed=7.0), "V001", "7 m/s"),
    ("loosened limit", lambda d: drone(d)["limits"].update(speed=20.0), "V040", "speed"),
    ("moved on earth", lambda d: d["mission"]["origin"].update(lat_deg=10.0), "V040", "planned for"),
    ("another lens", lambda d: drone(d).update(hfov=drone(d)["hfov"] + 1e-9), "V040", "planned for"),
    ("another rate", lambda d: d["mission"].update(rate=25.0), "V041", "rate is 25"),
    ("the seal", lambda d: d.update(mission_sha256="0" * 64), "V040", "planned for"),
    ("phase time", lambda d: d["drones"][0]["phases"][2].update(end=51.5), "V014", "51.5"),
    ("worst value", lambda d: d["certificate"][6].update(worst=5.0), "V040", "speed"),
    ("claim removed", lambda d: d["certificate"].pop(6), "V040", "speed"),
    ("claim invented", lambda d: d["certificate"][6].update(constraint="safety"), "V040", "safety"),
    ("moved keyframe", lambda d: d["keyframes"][0]["keyframes"][1].update(at=[28, -28, 20]), "V016", ""),
    ("not a number", lambda d: d["mission"].update(rate="50"), "E003", "mission.rate"),
    ("true for a number", lambda d: d["mission"].update(rate=True), "E003", "mission.rate"),
    ("missing field", lambda d: drone(d).pop("hfov"), "E003", "drones[0].hfov"),
    ("no keyframes", lambda d: d["keyframes"][0].pop("keyframes"), "E003", "keyframes[0].keyframes"),
    ("unknown field", lambda d: d["mission"]["rules"].update(height=3), "E003", "mission.rules.height"),
    ("wrong length", lambda d: d["mission"]["targets"][0].update(centre=[0, 0]), "E003", "3"),
    ("ragged table", lambda d: curve(d)["control"][3].pop(), "E003", "curve.control"),
    ("text in a table", lambda d: curve(d)["breaks"].__setitem__(2, "9"), "E003", "curve.breaks"),
    ("breaks go back", lambda d: curve(d)["breaks"].__setitem__(2, 0.5), "E003", "increase"),
    ("huge integer", lambda d: d["mission"].update(wind=10**400), "E003", "mission.wind"),
    ("too long a number", lambda d: curve(d)["breaks"].__setitem__(2, 10**400), "E003", "breaks"),
    ("null for a drone", lambda d: d["mission"].update(drones=[None]), "E003", "mission.drones[0]"),
    ("list for an object", lambda d: d.update(mission=[]), "E003", "mission"),
    ("unknown word", lambda d: d["mission"]["zones"][0].update(keep="away"), "E003", "keep"),
    ("unknown solid", lambda d: d["mission"]["zones"][0]["solid"].update(type="Cone"), "E003", "solid"),
    ("unknown target", lambda d: d["drones"][0]["framing"][0].update(target="spire"), "E003", "spire"),
    ("unknown drone", lambda d: d["mission"]["shots"][0].update(drone="cam7"), "E003", "cam7"),
    ("unknown shot", lambda d: d["keyframes"][0].update(shot="other"), "E003", "keyframes[0]"),
    ("unknown framed", lambda d: d["keyframes"][0]["keyframes"][0].update(target="spire"), "E003", "spire"),
    ("missing keyframes", lambda d: d.update(keyframes=[]), "E003", "half"),
    ("negative limit", lambda d: drone(d)["limits"].update(jerk=-1.0), "E003", "limits.jerk"),
    ("endless rate", lambda d: d["mission"].update(rate=1e9), "E003", "mission.rate"),
    ("twisted zone", lambda d: d["mission"]["zones"][1]["solid"]["points"].reverse(), "E003", "zones[1]"),
    ("two zones of a name", lambda d: d["mission"]["zones"][1].update(name="tree"), "E003", "tree"),
    ("another version", lambda d: d.update(version=2), "E002", "version"),
    ("version true", lambda d: d.update(version=True), "E002", "version"),
    ("another format", lambda d: d.update(format="plan"), "E002", "shotc plan"),
]  # fmt: skip


@pytest.mark.parametrize(("edit", "code", "said"), [e[1:] for e in EDITS], ids=[e[0] for e in EDITS])
def test_edits_are_noticed(edit: Callable[[dict[str, Any]], None], code: str, said: str) -> None:
    verdict = verify_file(edited(edit), "plan.json", CONTEXT, lower_kept)
    found = [d for d in verdict.diagnostics if d.code == code]
    assert found
    assert any(said in d.message for d in found)
    assert verdict.plan is None
    assert all(d.code in registry() for d in verdict.diagnostics)


BYTES = [
    (b"", "E001", (1, 1)),
    (b"\xff\xfe{}", "E001", (1, 1)),
    (b"{\n  \"format\": }", "E001", (2, 13)),
    (b'{"format": "shotc-plan", "version": NaN}', "E001", (1, 1)),
    (b'{"format": "shotc-plan", "format": "shotc-plan"}', "E001", (1, 1)),
    (b"[" * 100_000, "E001", (1, 1)),
    (b"[]", "E002", (1, 1)),
    (b"3", "E002", (1, 1)),
    (b"null", "E002", (1, 1)),
    (b'{"format": "shotc-plan", "version": 1}', "E003", (1, 1)),
    (DATA[: len(DATA) // 2], "E001", None),
    (b"1" * 10_000, "E001", (1, 1)),
]  # fmt: skip


@pytest.mark.parametrize(("data", "code", "place"), BYTES, ids=range(len(BYTES)))
def test_any_bytes_are_told_not_raised(data: bytes, code: str, place: tuple[int, int] | None) -> None:
    read = read_plan(data, "some/plan.json")
    assert read.trajectory is None
    first = read.diagnostics[0]
    assert first.code == code
    assert first.labels[0].file == "some/plan.json"
    if place is not None:
        assert (first.labels[0].span.line, first.labels[0].span.column) == place


junk = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=5), inner, max_size=3),
    max_leaves=6,
)


@pytest.mark.long
@settings(deadline=None, max_examples=60, suppress_health_check=[HealthCheck.too_slow])
@given(st.data())
def test_any_value_in_any_place_is_read_or_told(data: st.DataObject) -> None:
    document = json.loads(DATA)
    place: Any = document
    while True:
        key = data.draw(
            st.sampled_from(sorted(place)) if isinstance(place, dict) else st.integers(0, len(place) - 1)
        )
        inner = place[key]
        if not (isinstance(inner, dict | list) and inner) or data.draw(st.integers(0, 3)) == 0:
            break
        place = inner
    place[key] = data.draw(junk)
    verdict = verify_file(json.dumps(document).encode(), "plan.json", CONTEXT, lower_kept)
    assert verdict.plan is not None or verdict.diagnostics


def test_layout_reads_back() -> None:
    value = {"a": [[1.0, 2.5], [1e-300, -0.0]], "b": {}, "c": [], "d": "é\n", "e": [{"x": list(range(50))}]}
    assert json.loads(layout.text(value)) == value
    with pytest.raises(ValueError, match="JSON"):
        layout.text(float("nan"))


def test_plans_are_compared_shot_by_shot() -> None:
    same_plan = compare(PLAN, PLAN)
    assert same_plan.claims == ()
    assert same_plan.shots[0].distance == 0
    track = PLAN.trajectory.drones[0]
    higher = Piecewise(track.curve.breaks, track.curve.ctrl + np.array([0, 0, 2.0, 0, 0, 0, 0]))
    moved = replace(PLAN.trajectory, drones=(replace(track, curve=higher),))
    found = compare(PLAN, VerifiedIR(moved, PLAN.certificate[1:]))
    assert found.shots[0].distance == pytest.approx(2.0)
    assert found.shots[0].duration == (30.0, 30.0)
    assert [c.claim.constraint for c in found.claims] == ["jump of value"]
    gone = compare(PLAN, VerifiedIR(replace(PLAN.trajectory, drones=()), ()))
    assert gone.shots[0].duration == (30.0, None)
