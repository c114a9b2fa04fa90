"""Edits of plans by seed, mission-changing ones among them: none is accepted that flies another mission.

Whoever edits here knows the format: the seal and the certificate are made anew where they can be.
"""

import json
import random
from collections.abc import Callable
from hashlib import sha256
from typing import Any

import numpy as np
import pytest

from shotc.geom.bernstein import Array, Piecewise, quintic_hermite
from shotc.ir.path import BODY_YAW, CAM_PITCH, CAM_YAW, HFOV
from shotc.planfile.codec import encode
from shotc.planfile.read import read_plan
from tests.support.kinds_plan import MISSION, kinds_plan
from tests.support.moved_plans import excursion
from tests.support.resealed_plans import Document, refused
from tests.support.slowed_plans import inserted, stretched, waiting

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("kinds-plan")]

FEW, MANY = 10, 2000
ROUND, RISE = (
    MISSION[MISSION.index(first) : MISSION.index(then)]
    for first, then in (("  - {id: round", "  - {id: rise"), ("  - {id: rise", "  - id: look"))
)
CHANGES = (
    ("sweep: -180 deg", "sweep: -20 deg"),
    ("sweep: -180 deg", "sweep: 180 deg"),
    ("altitude: [8, 24]", "altitude: [8, 15]"),
    ("altitude: [8, 24]", "altitude: [24, 8]"),
    ("at: [-40, -10, 12]", "at: [-45, -10, 12]"),
    (", hold: 2}", "}"),
    ("heading: 200 deg", "heading: 100 deg"),
    ("side: left", "side: right"),
    ("distance: 8", "distance: 5"),
    ("home: [0, -60, 0]}", "home: [0, -60, 0], body: free}"),
    (ROUND + RISE, RISE + ROUND),
)


def places_in(value: Any, path: tuple[str | int, ...] = ()) -> list[tuple[str | int, ...]]:
    """Return the paths of all single values."""
    if not isinstance(value, dict | list):
        return [path]
    items = value.items() if isinstance(value, dict) else enumerate(value)
    return [p for key, item in items for p in places_in(item, (*path, key))]


def put(document: Document, path: tuple[str | int, ...], change: Callable[[Any], Any]) -> None:
    at: Any = document
    for key in path[:-1]:
        at = at[key]
    at[path[-1]] = change(at[path[-1]])


def another(chance: random.Random, value: Any) -> Any:
    """Return another value of the same sort, or now and then of another one."""
    if chance.random() < 0.1:
        return chance.choice([None, True, 3, -1.0, "x", [], {}])
    if isinstance(value, bool):
        return not value
    if isinstance(value, int | float):
        return chance.choice([value * 1.1 + 0.1, -value - 1.0, value + chance.uniform(1.0, 30.0)])
    return f"{value}x" if isinstance(value, str) else 1.0


def of_a_value(chance: random.Random, document: Document) -> None:
    """Change one value of what the plan says of its mission."""
    part = chance.choice(["mission", "keyframes", "source", "origins"])
    path = (part, *chance.choice(places_in(document[part])))
    if path != ("source", "file"):
        put(document, path, lambda value: another(chance, value))


def of_the_text(chance: random.Random, document: Document) -> None:
    """Change the mission's text alone, with its hash."""
    text = "\n".join(document["source"]["text"])
    old, new = chance.choice(CHANGES)
    changed = text.replace(old, new)
    document["source"].update(text=changed.split("\n"), sha256=sha256(changed.encode()).hexdigest())


def of_the_flight(chance: random.Random, document: Document) -> None:
    """Fly another mission's plan, with or without what that plan says of itself."""
    other = json.loads(kinds_plan((chance.choice(CHANGES),)))
    document["drones"] = other["drones"]
    if chance.random() < 0.5:
        document.update(mission=other["mission"], keyframes=other["keyframes"])
    if chance.random() < 0.5:
        shots = [shot["id"] for shot in document["mission"]["shots"]]
        document["deviations"] = [
            {"type": "PathDeviation", "shot": shot, "distance": 100.0, "s": 0.0, "cause": "zone tree"}
            for shot in shots
        ]


def of_a_time(chance: random.Random, document: Document) -> None:
    """Change when a keyframe is said to be met, or a phase to begin; or say less of what is framed."""
    flown = document["drones"][0]
    kind = chance.randrange(3)
    if kind == 0:
        chance.choice(flown["keyframes"])["time"] += chance.choice([-2.0, 2.0])
    elif kind == 1:
        i = chance.randrange(1, len(flown["phases"]))
        flown["phases"][i]["start"] += 1.0
        flown["phases"][i - 1]["end"] += 1.0
    else:
        flown["keyframes"].remove(chance.choice(flown["keyframes"]))


def of_the_motion(chance: random.Random, document: Document) -> None:
    """Lead a drone, its nose, its lens or a camera that is held to a place aside for a part of a shot."""
    drone, shot, channels = chance.choice(
        [
            (0, "round", (0, 1, 2, HFOV, BODY_YAW)),
            (0, "rise", (0, 1, 2, HFOV, BODY_YAW)),
            (0, "look", (0, 1, 2, HFOV, BODY_YAW)),
            (1, "side", (0, 1, 2, HFOV, BODY_YAW, CAM_YAW, CAM_PITCH)),
        ]
    )
    phase = next(p for p in document["drones"][drone]["phases"] if p["shot"] == shot)
    length = phase["end"] - phase["start"]
    start = phase["start"] + chance.uniform(0.0, 0.3) * length
    channel = chance.choice(channels)
    least = {HFOV: 0.05, BODY_YAW: 0.05, CAM_YAW: 0.8, CAM_PITCH: 0.5}.get(channel, 15.0)
    by = chance.choice([-1.0, 1.0]) * least * chance.uniform(1.0, 1.5)
    excursion(document, drone, channel, (start, start + chance.uniform(0.5, 0.7) * length), by)


def of_the_picture(chance: random.Random, document: Document) -> None:
    """Frame less, more or something else than the mission does in a shot."""
    flown = chance.choice(document["drones"])
    span = chance.choice(flown["framing"])
    phase = next(p for p in flown["phases"] if p["shot"] == span["shot"])
    kind = chance.randrange(4)
    if kind == 0:
        flown["framing"].remove(span)
    elif kind == 1:
        span["target"] = "runner" if span["target"] == "tower" else "tower"
    elif kind == 2:
        span["start"] += 0.6 * (span["end"] - span["start"])
    else:
        flown["framing"].append(
            {
                "shot": span["shot"],
                "target": "runner" if span["target"] == "tower" else "tower",
                "start": phase["start"],
                "end": phase["end"],
                "reference": None,
            }
        )


def of_free_time(chance: random.Random, document: Document) -> None:
    """Fly a shot slower or faster than its pace, wait where the drone rests, or fly away and back."""
    read = read_plan(json.dumps(document).encode(), "plan.json")
    assert read.trajectory is not None
    track = read.trajectory.drones[0]
    spans = {p.shot: (p.start, p.end) for p in track.phases if p.shot in ("round", "rise")}
    shot = chance.choice(sorted(spans.values()))
    rest = chance.choice([0.0, *(end for span in spans.values() for end in span)])
    kind = chance.randrange(4)
    if kind == 0:
        track = stretched(track, shot, chance.uniform(2.0, 9.0))
    elif kind == 1:
        track = stretched(track, shot, chance.uniform(0.4, 0.78))
    elif kind == 2:
        track = waiting(track, rest, chance.uniform(6.0, 1000.0))
    else:
        at = int(np.argmin(np.abs(track.curve.breaks - rest)))
        way = chance.uniform(300.0, 2000.0)
        track = inserted(track, at, away_and_back(track.curve(rest), rest, way, chance.uniform(0.0, 7.0)))
    document["drones"][0] = encode(track)


def away_and_back(pose: Array, at: float, way: float, course: float) -> Piecewise:
    """Return a flight to a place and back, as fast as an x500 is on it."""
    far = pose + way * np.array([np.cos(course), np.sin(course), *np.zeros(5)])
    zero, lasts = np.zeros((3, 7)), 1.875 * way / 8.0
    return quintic_hermite(at + lasts * np.arange(3.0), np.stack([pose, far, pose]), zero, zero)


EDITS = (
    *(of_a_value, of_a_value, of_a_value, of_the_text, of_the_flight, of_a_time),
    *(of_the_motion, of_the_picture, of_free_time),
)


def refuses(seed: int) -> bool:
    """Tell whether one edit of the plan is refused, or changes nothing."""
    chance = random.Random(seed)
    edit = EDITS[seed % len(EDITS)]
    return refused(kinds_plan(), lambda document: edit(chance, document), lambda: chance.random() < 0.5)


@pytest.mark.long
def test_no_edit_is_accepted() -> None:
    assert [seed for seed in range(FEW) if not refuses(seed)] == []


@pytest.mark.fuzz
@pytest.mark.timeout(1800)
def test_no_edit_of_many_is_accepted() -> None:
    assert [seed for seed in range(FEW, MANY) if not refuses(seed)] == []
