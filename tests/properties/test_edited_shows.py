"""Edits of a show by seed, with a new seal and certificate: none that shows something else is accepted."""

from __future__ import annotations

import random
from collections.abc import Callable

import numpy as np
import pytest

from shotc import api
from tests.support.compiled import compiled_text
from tests.support.resealed_plans import Document, refused
from tests.unit.passes.verify.fleets.test_pictures_of_fleets import NOT_ASKED, SHOW, certificate

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("pictures-of-fleets")]

FEW, MANY = 10, 300


def of_the_lights(chance: random.Random, document: Document) -> None:
    """Give all lights another colour at one of the times at which a picture stands."""
    track = document["fleets"][0]
    lights, stands = track["lights"], [t for s in track["shown"] for t in (s["start"], s["end"])]
    k = lights["times"].index(chance.choice(stands))
    color = chance.choice(["000000", "00ff00", "0000ff", "7f7f7f"])
    lights["colors"] = [row[: 6 * k] + color + row[6 * k + 6 :] for row in lights["colors"]]


def of_the_times(chance: random.Random, document: Document) -> None:
    """Say that a frame is another one, stands at another time, or does not exist."""
    shown = document["fleets"][0]["shown"]
    frame = chance.choice(shown)
    kind = chance.randrange(4)
    if kind == 0:
        frame[chance.choice(["index", "picture"])] += chance.choice([1, 3])
    elif kind == 1:
        shown.remove(frame)
    else:
        frame[chance.choice(["start", "end"])] += chance.choice([-1.0, 1.0]) * chance.uniform(0.1, 5.0)


def of_the_places(chance: random.Random, document: Document) -> None:
    """Move all drones aside while one picture stands, or enlarge the picture about its middle."""
    track = document["fleets"][0]
    frame, breaks = chance.choice(track["shown"]), np.array(track["breaks"])
    first, last = np.searchsorted(breaks, [frame["start"] - 1e-6, frame["end"] - 1e-6])
    coef = np.array(track["coef"]).reshape(len(track["coef"]), -1, 3)
    held = coef[:, first : last + 3]
    if chance.random() < 0.5:
        held += chance.choice([-1.0, 1.0]) * chance.uniform(12.0, 40.0) * np.eye(3)[chance.randrange(3)]
    else:
        held += chance.choice([-0.5, 0.8]) * (held - held.mean(axis=0))
    track["coef"] = coef.tolist()


EDITS: tuple[Callable[[random.Random, Document], None], ...] = (of_the_lights, of_the_times, of_the_places)


def refuses(seed: int) -> bool:
    """Tell whether one edit of the plan, or of the mission beside its flight, is refused."""
    chance = random.Random(seed)
    if seed % (len(EDITS) + 1) == len(EDITS):
        old, new, _ = chance.choice(list(NOT_ASKED.values()))
        return not all(c.holds for c in certificate(SHOW.replace(old, new, 1)).values())
    plan = compiled_text(SHOW).plan
    assert plan is not None
    data = api.emit_plan(plan, []).artifacts[0].data
    edit = EDITS[seed % (len(EDITS) + 1)]
    return refused(data, lambda document: edit(chance, document), lambda: True)


@pytest.mark.long
def test_no_edit_is_accepted() -> None:
    assert [seed for seed in range(FEW) if not refuses(seed)] == []


@pytest.mark.fuzz
@pytest.mark.timeout(1800)
def test_no_edit_of_many_is_accepted() -> None:
    assert [seed for seed in range(FEW, MANY) if not refuses(seed)] == []
