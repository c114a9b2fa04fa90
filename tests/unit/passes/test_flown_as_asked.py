"""Whether what is flown is what the mission asks for, in plans whose seal and certificate fit every edit."""

import json
from collections.abc import Callable
from typing import Any

import pytest

from shotc import api
from tests.kinds_plan import kinds_plan
from tests.resealed import Document, resealed

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
