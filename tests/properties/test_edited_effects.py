"""Edits of the light effects of a plan by seed, with a new seal and certificate: none is accepted."""

from __future__ import annotations

import json
import random
from collections.abc import Iterator
from contextlib import suppress
from typing import Any

import pytest

from shotc import api
from tests.support.compiled import compiled_text
from tests.support.resealed_plans import Document, resealed
from tests.unit.passes.verify.fleets.test_effects_of_fleets import SHOW

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("effects-of-fleets")]

FEW, MANY = 10, 200
FREE = {"seed"}
"""What a mission leaves open: which lights sparkle."""


def stacks(document: Document) -> list[list[Any]]:
    """Return the lists of layers of the show that are not empty."""
    lights = document["fleets"][0]["lights"]
    return [stack for stack in (*(look["layers"] for look in lights["looks"]), lights["over"]) if stack]


def numbers(record: dict[str, Any] | list[Any]) -> Iterator[tuple[Any, Any]]:
    """Yield every number of a layer as what holds it and its key."""
    entries = list(record.items() if isinstance(record, dict) else enumerate(record))
    # A gradient that does not move has no time of its own.
    still = isinstance(record, dict) and record.get("rate") == 0.0
    free = FREE | {"origin"} if still else FREE
    for key, value in entries:
        if isinstance(value, dict | list):
            yield from numbers(value)
        elif isinstance(value, int | float) and not isinstance(value, bool) and key not in free:
            yield record, key


def edit(chance: random.Random, document: Document) -> None:
    """Drop, double or swap layers, or change one number of one of them."""
    stack = chance.choice(stacks(document))
    kind = chance.randrange(6)
    if kind == 0:
        stack.pop(chance.randrange(len(stack)))
    elif kind == 1:
        stack.append(chance.choice(stack))
    elif kind == 2 and len(stack) > 1:
        stack.reverse()
    else:
        holder, key = chance.choice(list(numbers(chance.choice(stack))))
        value = holder[key]
        if isinstance(value, int):
            holder[key] = value - 5 if value > 5 else value + 5
        else:
            holder[key] = value + chance.choice([-1.0, 1.0]) * chance.uniform(0.02, 0.5)


def refused(seed: int) -> bool:
    """Tell whether one edit of the plan is refused."""
    chance = random.Random(seed)
    plan = compiled_text(SHOW).plan
    assert plan is not None
    document = json.loads(api.emit_plan(plan, []).artifacts[0].data)
    edit(chance, document)
    edited = json.dumps(document).encode()
    with suppress(AssertionError):  # where it can be read at all
        edited = resealed(document)
    return api.verify_plan(edited, "plan.json").plan is None


@pytest.mark.long
def test_no_edit_is_accepted() -> None:
    assert [seed for seed in range(FEW) if not refused(seed)] == []


@pytest.mark.fuzz
@pytest.mark.timeout(1800)
def test_no_edit_of_many_is_accepted() -> None:
    assert [seed for seed in range(FEW, MANY) if not refused(seed)] == []
