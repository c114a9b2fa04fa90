"""Shots that film a picture of a show before it stands or after it has left, and the fix that is told."""

from __future__ import annotations

import pytest

from shotc.ir.keyframes import KeyframeIR
from shotc.ir.phases import Phase
from shotc.ir.show import Picture
from shotc.ir.trajectory import TrajectoryIR
from shotc.passes.verify.filmed_pictures import not_standing
from tests.support import show_plans
from tests.support.film_plans import orbit_mission, orbit_plan
from tests.support.records import replace

FIRST, LAST = show_plans.display().pictures
SHORTER = "give the shot `duration: 4` or less"
BEGIN = "leave out `start` and `after` of the shot: it begins when the picture stands"


def filmed(start: float, end: float, *later: Picture) -> TrajectoryIR:
    """A shot of the first picture of the sample show, which stands from 16 to 20 s."""
    pictures = (FIRST._replace(name="ball"), *(later or (LAST,)))
    shot = replace(orbit_mission().shots[0], id="look", subject="ball")
    shown = show_plans.display()._replace(pictures=pictures)
    mission = show_plans.mission(displays=(shown,), drones=orbit_mission().drones, shots=(shot,))
    flight = replace(orbit_plan().trajectory.drones[0], phases=(Phase("shot", "look", start, end),))
    fleets = (show_plans.flight(mission.fleets[0]),)
    return TrajectoryIR(KeyframeIR(mission, ()), (flight,), (), (), fleets)


@pytest.mark.parametrize(("start", "end"), [(16.0, 20.0), (17.0, 18.0), (15.9995, 20.0005)])
def test_nothing_is_told_while_the_picture_stands(start: float, end: float) -> None:
    assert list(not_standing(filmed(start, end))) == []


@pytest.mark.parametrize(
    ("start", "end", "parts", "way"),
    [
        (14.0, 19.0, "2.00 s before it stands", BEGIN),
        (14.0, 22.5, "2.00 s before it stands and 2.50 s after it has left", BEGIN),
        (20.0, 22.0, "2.00 s after it has left", BEGIN),
        (21.0, 23.0, "3.00 s after it has left", BEGIN),
        (
            17.0,
            22.0,
            "2.00 s after it has left",
            f"{SHORTER}, or the picture `hold: 6.00`",
        ),
    ],
)
def test_too_early_and_too_late_are_told_with_what_to_write(
    start: float, end: float, parts: str, way: str
) -> None:
    (told,) = not_standing(filmed(start, end))
    assert (told.code, told.message) == ("V058", f"shot `look` films `ball` {parts}")
    assert told.notes == ("it stands from 16 to 20 s",)
    assert told.help == way


def test_no_longer_hold_is_proposed_where_any_later_picture_has_a_time_of_its_own() -> None:
    timed = LAST._replace(at=26.0)
    for later in ((timed,), (timed, LAST), (LAST, timed)):
        (told,) = not_standing(filmed(17.0, 22.0, *later))
        assert told.help == SHORTER
