"""Whether what is flown is what the mission asks for, in plans whose seal and certificate fit every edit."""

import json
from collections.abc import Callable
from typing import Any

import pytest

from shotc import api
from shotc.ir.passes import PassContext
from shotc.passes.verify import judge
from tests.support.few import few
from tests.support.film_plans import orbit_plan
from tests.support.kinds_plan import kinds_plan
from tests.support.records import replace
from tests.support.resealed_plans import Document, resealed

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("kinds-plan")]

Edit = Callable[[Document], Any]


@pytest.fixture(scope="module")
def data() -> bytes:
    return kinds_plan()


def codes(data: bytes) -> set[str]:
    report = api.verify_plan(data, "plan.json")
    return {d.code for d in report.diagnostics}


def track(document: Document, drone: str) -> Document:
    found: Document = next(t for t in document["drones"] if t["drone"] == drone)
    return found


def test_the_plan_holds(data: bytes) -> None:
    assert codes(resealed(json.loads(data))) == set()


def test_a_reference_off_its_composition_is_told(data: bytes) -> None:
    document = json.loads(data)
    (span,) = track(document, "cam2")["framing"]
    for point in span["reference"]["control"][0]:
        point[0] += 0.1
    report = api.verify_plan(resealed(document), "plan.json")
    found = next(d for d in report.diagnostics if d.code == "V024")
    assert "reference off its composition" in found.message


def flight_of(document: Document, other: bytes) -> None:
    """Put the flights of another plan into a plan, and how far that one leaves its paths."""
    source = json.loads(other)
    document["drones"] = source["drones"]
    document["deviations"] = source["deviations"]


def variant(old: str, new: str) -> bytes:
    return kinds_plan(((old, new),))


OTHERS: dict[str, tuple[str, str, str]] = {
    "an orbit of -40 deg": ("sweep: -180 deg", "sweep: -40 deg", "V016"),
    "an orbit of -160 deg": ("sweep: -180 deg", "sweep: -160 deg", "V016"),
    "the other way round": ("sweep: -180 deg", "sweep: 180 deg", "V044"),
    "a rise to 15 m": ("altitude: [8, 24]", "altitude: [8, 15]", "V044"),
    "a rise flown backwards": ("altitude: [8, 24]", "altitude: [24, 8]", "V044"),
    "a keyframe moved": ("at: [-40, -10, 12]", "at: [-45, -10, 12]", "V016"),
    "a keyframe left out": ("      - {at: [-30, -30, 14], look_at: tower}\n", "", "V016"),
    "a hold dropped": (", hold: 2}", "}", "V016"),
    "another direction": ("heading: 200 deg", "heading: 100 deg", "V045"),
    "another lens": ("hfov: 60 deg", "hfov: 55 deg", "V045"),
    "the other side": ("side: left", "side: right", "V044"),
    "nearer": ("distance: 8", "distance: 5", "V044"),
    "brisker": ("rules: {", "rules: {pace: brisk, ", "V065"),
    "after waiting for 60 s": (
        "start_azimuth: 180 deg}",
        "start_azimuth: 180 deg, timing: {start: 80}}",
        "V066",
    ),
    "a hold of 3 s": (", hold: 2}", ", hold: 3}", "V066"),
    "a hold of 62 s": (", hold: 2}", ", hold: 62}", "V066"),
    "five times slower": ("altitude: [8, 24]}", "altitude: [8, 24], timing: {duration: 40}}", "V066"),
    "a film that begins late": (
        "timing: {duration: 8}",
        "timing: {start: 200, duration: 8}",
        "V066",
    ),
}
QUICK = ("the other way round", "a hold dropped", "another direction", "the other side")


@pytest.mark.long
@pytest.mark.parametrize("name", few(OTHERS, QUICK))
def test_the_flight_of_another_mission_is_refused(data: bytes, name: str) -> None:
    old, new, code = OTHERS[name]
    document = json.loads(data)
    flight_of(document, variant(old, new))
    assert code in codes(resealed(document))


def test_a_free_body_does_not_follow_its_camera(data: bytes) -> None:
    document = json.loads(variant("home: [0, -60, 0]}", "home: [0, -60, 0], body: free}"))
    assert codes(resealed(document)) == set()
    flight_of(document, data)
    report = api.verify_plan(resealed(document), "plan.json")
    assert any("turn of a free body of shot `round`" in d.message for d in report.diagnostics)


@pytest.mark.parametrize(
    "name", few(["the other way round", "a rise to 15 m", "an orbit of -40 deg"], QUICK[:1])
)
def test_what_a_plan_says_of_a_detour_explains_no_other_shot(data: bytes, name: str) -> None:
    old, new, _ = OTHERS[name]
    document = json.loads(data)
    flight_of(document, variant(old, new))
    document["deviations"] = [
        {"shot": shot, "distance": 200.0, "s": 0.0, "cause": "zone tree"} for shot in ("round", "rise")
    ]
    spread_keyframes(document, "round")
    assert "V044" in codes(resealed(document))


@pytest.mark.parametrize(
    "cause", ["the drone's limits", "the pictures of other drones", "zone tree", "drone cam1"]
)
def test_no_cause_explains_another_shot_of_what_moves(data: bytes, cause: str) -> None:
    """The other side of a runner is 16 m away: more than any cause that is there leads a drone."""
    document = json.loads(data)
    flight_of(document, variant("side: left", "side: right"))
    document["deviations"] = [{"shot": "side", "distance": 200.0, "s": 0.0, "cause": cause}]
    document = json.loads(resealed(document))
    (found,) = (
        c
        for c in document["certificate"]
        if (c["shot"], c["constraint"]) == ("side", "distance from its place")
    )
    assert not found["holds"]
    assert found["hard"]
    assert found["limit"] < 12.0


def test_the_way_between_placed_keyframes_is_held_to_them(data: bytes) -> None:
    document = json.loads(data)
    flown = track(document, "cam1")
    first, second = (k["time"] for k in flown["keyframes"] if k["shot"] == "look" and k["index"] in (2, 3))
    breaks, control = flown["curve"]["breaks"], flown["curve"]["control"]
    inside = [k for k in range(len(control)) if first < breaks[k] and breaks[k + 1] < second]
    assert "V044" not in codes(resealed(document))
    for k in inside:
        for point in control[k]:
            point[1] -= 12.0
    assert "V044" in codes(resealed(document))


def spread_keyframes(document: Document, shot: str) -> None:
    """Say that as many keyframes as the mission has are met along a shot, whatever is flown there."""
    for flown in document["drones"]:
        for phase in (p for p in flown["phases"] if p["shot"] == shot):
            asked = next(s for s in document["keyframes"] if s["shot"] == shot)["keyframes"]
            step = (phase["end"] - phase["start"]) / (len(asked) - 1)
            times = [phase["start"] + i * step for i in range(len(asked))]
            others = [k for k in flown["keyframes"] if k["shot"] != shot]
            told = [{"shot": shot, "index": i, "time": t} for i, t in enumerate(times)]
            flown["keyframes"] = [*others, *told]


def test_a_promise_without_a_claim_is_told() -> None:
    plain = orbit_plan().trajectory
    placed = plain.keyframes.shots[0]
    unframed = tuple(k._replace(target=None, reference=None) for k in placed.keyframes)
    keyframes = plain.keyframes._replace(shots=(placed._replace(keyframes=unframed),))
    track = replace(plain.drones[0], framing=())
    shots = tuple(shot._replace(subject=None) for shot in keyframes.mission.shots)
    keyframes = keyframes._replace(mission=keyframes.mission._replace(shots=shots))
    verdict = judge(replace(plain, keyframes=keyframes, drones=(track,)), PassContext())
    found = [d for d in verdict.diagnostics if d.code == "V046"]
    assert [d.message.split("`")[3] for d in found] == ["in_frame", "screen_error"]
