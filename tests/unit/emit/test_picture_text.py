"""Every text of every picture is large enough to be read."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from shotc.emit import storyboard
from shotc.ir.trajectory import VerifiedIR
from shotc.show.emit import contact_sheet
from tests.support import show_flights
from tests.support.film_plans import dense_plan, orbit_plan
from tests.support.page_texts import texts
from tests.support.records import replace
from tests.support.two_target_plans import pair_plan

pytestmark = pytest.mark.slow

LONG = "a name that somebody has made as long as a sentence, because nothing said that it may not be"


def renamed(plan: VerifiedIR) -> VerifiedIR:
    """Return a plan whose mission, models and deviations have long names."""
    keyframes = plan.trajectory.keyframes
    drones = tuple(replace(d, model=LONG) for d in keyframes.mission.drones) * 3
    mission = replace(keyframes.mission, name=LONG * 4, drones=drones)
    return VerifiedIR(
        replace(plan.trajectory, keyframes=replace(keyframes, mission=mission)), plan.certificate
    )


@pytest.mark.long
@pytest.mark.parametrize(
    "make", [orbit_plan, pair_plan, lambda: dense_plan(placed=True), lambda: renamed(orbit_plan())]
)
def test_texts_of_a_storyboard_are_at_least_nine_pixels_high(make: Callable[[], VerifiedIR]) -> None:
    with texts() as found:
        storyboard.EMITTER.emit(make())
    assert min(t.capital for t in found) >= 9.0 - 1e-9, min(found, key=lambda t: t.capital)
    assert all(t.box.x >= 0.0 and t.box.right <= 16.0 for t in found)


def test_texts_of_a_contact_sheet_are_at_least_nine_pixels_high() -> None:
    for plan in (show_flights.plan(), show_flights.plan(replace(show_flights.mission(), name=LONG * 4))):
        with texts() as found:
            contact_sheet.EMITTER.emit(plan)
        assert min(t.capital for t in found) >= 9.0 - 1e-9, min(found, key=lambda t: t.capital)
        assert all(t.box.x >= 0.0 and t.box.right <= 16.0 for t in found)
