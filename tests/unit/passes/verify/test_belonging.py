"""A plan belongs to its mission: the mission in it is lowered again, and all it asks for is compared."""

import json
from collections.abc import Callable
from hashlib import sha256
from typing import Any

import pytest

from shotc import api
from shotc.emit.plan_json import EMITTER
from shotc.ir.passes import PassContext
from shotc.passes.verify import Verify
from tests.support.film_plans import orbit_plan
from tests.support.resealed_plans import Document, resealed

pytestmark = pytest.mark.slow

PLAN = Verify().run(orbit_plan().trajectory, PassContext()).value
assert PLAN is not None
DATA = EMITTER.emit(PLAN).artifacts[0].data
SPAN = {"line": 1, "column": 1, "end_line": 1, "end_column": 2}
Edit = Callable[[Document], Any]


def codes(data: bytes) -> set[str]:
    report = api.verify_plan(data, "plan.json")
    assert (report.plan is None) == bool(report.diagnostics)
    return {d.code for d in report.diagnostics}


def shot(document: Document) -> Document:
    found: Document = document["mission"]["shots"][0]
    return found


def placed(document: Document, index: int) -> Document:
    found: Document = document["keyframes"][0]["keyframes"][index]
    return found


def both(index: int, **changes: Any) -> Edit:
    """Return an edit of a keyframe as the mission has it, and as it is placed."""

    def edit(document: Document) -> None:
        shot(document)["keyframes"][index].update(changes)
        placed(document, index).update(changes)

    return edit


def without(index: int) -> Edit:
    def edit(document: Document) -> None:
        del shot(document)["keyframes"][index], document["keyframes"][0]["keyframes"][index]

    return edit


EDITS: dict[str, tuple[Edit, str]] = {
    "a keyframe is moved": (both(2, at=[40.0, 25.0, 20.0]), "keyframe 3, at is (40, 25, 20) in the plan"),
    "a keyframe is not placed": (both(1, placed=False), "placed is false in the plan, but true"),
    "a keyframe is left out": (without(2), "the plan has 4, the mission asks for 5"),
    "a hold is asked": (both(2, hold=3.0), "hold is 3 in the plan, but 0 in the mission"),
    "a time is asked": (both(2, time=15.0), "time is 15 in the plan, but nothing in the mission"),
    "another lens": (both(2, hfov=1.0), "hfov is 1 in the plan, but 1.22173048 in the mission"),
    "no target": (both(2, target=None), "target is nothing in the plan, but `tower` in the mission"),
    "another place on screen": (lambda d: placed(d, 1).update(reference=[0.1, 0.0]), "reference is (0.1, 0)"),
    "another direction": (lambda d: placed(d, 1).update(yaw=0.0), "keyframe 2, yaw is 0 in the plan"),
    "a looser limit": (lambda d: d["mission"]["drones"][0]["limits"].update(speed=20.0), "speed is 20 in"),
    "no zone": (lambda d: d["mission"]["zones"].pop(0), "zones: `tree` is left out"),
    "an easier promise": (lambda d: shot(d)["promise"].update(in_frame=0.1), "in_frame is 0.1 in the plan"),
    "no promise": (lambda d: shot(d).update(promise=dict.fromkeys(shot(d)["promise"])), "screen_error is no"),
    "no time": (lambda d: shot(d)["timing"].update(duration=None), "duration is nothing in the plan, but 30"),
    "another lane": (lambda d: d["mission"]["origin"].update(lat_deg=10.0), "lat_deg is 10 in the plan"),
    "another text": (lambda d: d["source"].update(sha256="0" * 64), "source_sha256 is"),
    "another drone": (
        lambda d: d["source"]["chosen"]["drones"].append({"shot": "half", "drone": "cam1"}),
        "the drones that were chosen",
    ),
    "another file": (lambda d: d["source"]["tables"].append({"name": "a", "text": [""]}), "the tables in"),
    "another line": (
        lambda d: d["origins"]["keys"].append(
            [["shots"], dict.fromkeys(("line", "column", "end_line", "end_column"), 2)]
        ),
        "the place of shots in the file",
    ),
}


@pytest.mark.long
@pytest.mark.parametrize("name", EDITS)
def test_what_a_plan_says_of_its_mission_is_held_to_the_mission(name: str) -> None:
    edit, said = EDITS[name]
    document = json.loads(DATA)
    edit(document)
    report = api.verify_plan(resealed(document), "plan.json")
    assert report.plan is None
    found = [d for d in report.diagnostics if d.code == "V041"]
    assert any(said in d.message for d in found), [d.message for d in found]
    assert all(d.labels[0].file == "half-orbit.yaml" and d.help for d in found)


def test_a_difference_points_at_the_line_of_the_mission() -> None:
    document = json.loads(DATA)
    both(2, at=[40.0, 25.0, 20.0])(document)
    report = api.verify_plan(resealed(document), "plan.json")
    (label,) = next(d for d in report.diagnostics if d.code == "V041").labels
    assert report.sources[label.file].line(label.span.line).lstrip().startswith("- {at: [40.0, 0.0, 20]")


def test_a_resealed_plan_that_says_the_same_holds() -> None:
    assert codes(resealed(json.loads(DATA))) == set()


def of_text(document: Document, old: str, new: str) -> None:
    """Edit the text of the mission in a plan, and its hash."""
    text = "\n".join(document["source"]["text"])
    assert old in text
    text = text.replace(old, new)
    document["source"].update(text=text.split("\n"), sha256=sha256(text.encode()).hexdigest())


@pytest.mark.parametrize(
    ("old", "new", "code"),
    [
        ("40.0, 0.0, 20]", "40.0, 25.0, 20]", "V041"),
        ("endurance: 20 min", "endurance: 2 min", "V041"),
        ("id: half", "id: whole", "V041"),
        ("kind: keyframes", "kind: somersault", "V042"),
        ("shotc: 1", "shotc: {", "V042"),
        ("drone: cam1", "drone: auto", "V042"),
    ],
)
def test_another_text_is_another_mission(old: str, new: str, code: str) -> None:
    document = json.loads(DATA)
    of_text(document, old, new)
    assert code in codes(resealed(document))


def test_a_comment_more_in_the_text_is_the_same_mission() -> None:
    document = json.loads(DATA)
    of_text(document, "output:", "# the end\noutput:")
    assert codes(resealed(document)) == set()


def test_a_plan_without_its_mission_proves_nothing() -> None:
    document = json.loads(DATA)
    document["source"] = {name: document["source"][name] for name in ("file", "sha256")}
    report = api.verify_plan(resealed(document), "plan.json")
    assert report.plan is None
    assert [d.code for d in report.diagnostics] == ["V042"]


@pytest.mark.parametrize(
    "wrong",
    [{"text": ["\ud800"]}, {"text": "shotc: 1"}, {"tables": [{"name": "a"}]}, {"drawn": 3}, {"chosen": None}],
)
def test_a_source_that_cannot_be_read_is_told(wrong: Document) -> None:
    document = json.loads(DATA)
    document["source"].update(wrong)
    assert codes(json.dumps(document).encode()) == {"E003"}


def speed(document: Document) -> Document:
    found: Document = next(c for c in document["certificate"] if c["constraint"] == "speed")
    return found


CERTIFICATES: dict[str, tuple[Edit, str]] = {
    "the limit": (lambda d: speed(d).update(limit=9.0), "the limit is 9 m/s"),
    "the value": (lambda d: speed(d).update(worst=7.0), "the worst value is 7 m/s"),
    "the verdict": (lambda d: speed(d).update(holds=False), "it is broken by the certificate"),
    "the side": (lambda d: speed(d).update(upper=False), "it is bounded below by the certificate"),
    "the weight": (lambda d: speed(d).update(hard=False), "it is not required by the certificate"),
    "the method": (
        lambda d: speed(d).update(method="sampled"),
        "it is sampled by the certificate",
    ),
    "the time": (lambda d: speed(d).update(time=speed(d)["time"] + 1.0), "it is worst at t = 38"),
    "no time": (lambda d: speed(d).update(time=None), "it is worst at no time by the certificate"),
    "the place": (lambda d: speed(d).update(position=[0.0, 0.0, 9.0]), "it is worst at another place"),
    "no place": (lambda d: speed(d).update(position=None), "it is worst at another place"),
    "the unit": (lambda d: speed(d).update(unit="km/h"), "it is in `km/h` by the certificate, in `m/s`"),
    "the line": (lambda d: speed(d).update(path=["drones", "cam1"]), "it is of another line"),
    "the drones": (lambda d: speed(d).update(drones=["cam1"]), "it is of another line or of other drones"),
    "a claim twice": (lambda d: d["certificate"].append(speed(d)), "stands 2 times in the certificate"),
    "a claim less": (lambda d: d["certificate"].remove(speed(d)), "is not in the certificate"),
    "a claim more": (
        lambda d: d["certificate"].append(speed(d) | {"constraint": "safety"}),
        "safety is in the certificate, but follows from nothing in the plan",
    ),
    "the order": (lambda d: d["certificate"].reverse(), "are in another order"),
}


@pytest.mark.long
@pytest.mark.parametrize("name", CERTIFICATES)
def test_the_certificate_is_compared_whole(name: str) -> None:
    edit, said = CERTIFICATES[name]
    document = json.loads(DATA)
    edit(document)
    report = api.verify_plan(json.dumps(document).encode(), "plan.json")
    assert report.plan is None
    (found,) = report.diagnostics
    assert found.code == "V040"
    assert said in found.message


def test_a_claim_that_stands_twice_is_told_of_any_version() -> None:
    document = json.loads(DATA)
    document["certificate"].append(speed(document) | {"worst": 1.0})
    document["tool"]["version"] = "0.0.1"
    assert codes(json.dumps(document).encode()) == {"V040"}
