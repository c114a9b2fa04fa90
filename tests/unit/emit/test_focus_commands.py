"""Focus in mission files, and what of the exposure is left to the pilot's hand."""

from __future__ import annotations

import json

import numpy as np
import pytest

from shotc.emit.dji import EMITTER as DJI
from shotc.emit.mavlink import EMITTER as MAVLINK
from shotc.ir.drone import Optics
from shotc.ir.mission import MissionIR
from shotc.ir.promise import Promise
from tests.support.film_plans import orbit_mission, orbit_plan
from tests.support.mavlink_flights import plan, retold, straight
from tests.support.records import replace

FAST = Optics(0.036, 0.95, 0.03e-3, 0.02, 3840)  # with 70 deg, a lens of 25.7 mm


def mission() -> MissionIR:
    sample = orbit_mission()
    return replace(sample, shots=(replace(sample.shots[0], promise=Promise()),))


def commands(emission: object, number: int) -> list[list[float]]:
    items = json.loads(emission.artifacts[0].data)["mission"]["items"]  # type: ignore[attr-defined]
    return [i["params"] for i in items if i["command"] == number]


def test_px4_focuses_in_metres_before_it_films_and_as_often_as_sharpness_asks() -> None:
    source = plan(straight(), mission=mission(), target="tower", optics=FAST)
    emission = MAVLINK.emit(source)
    items = json.loads(emission.artifacts[0].data)["mission"]["items"]
    names = [i["command"] for i in items]
    assert names.index(532) < names.index(2500)
    told = commands(emission, 532)
    assert {p[0] for p in told} == {3}
    # The tower is 60 m to the North, and so is where the camera looks: that is its depth all along.
    assert [p[1] for p in told] == [pytest.approx(60.0, abs=0.1)]
    by_hand = "set by hand on the camera, as no file holds it"
    assert emission.notes[-2] == f"px4 cam1: {by_hand}: aperture f/0.95, shutter 1/50 s"


def test_a_depth_that_changes_is_followed_so_that_no_disc_is_half_of_what_is_sharp() -> None:
    optics = FAST._replace(circle=3e-6)
    source = plan(straight(yaw=np.pi / 4), mission=mission(), target="tower", optics=optics)
    told = np.array([p[1] for p in commands(MAVLINK.emit(source), 532)])
    # Looking north-east while going east: what stays behind in the west comes nearer to the image plane.
    first, last = 60 / np.sqrt(2), 20 / np.sqrt(2)
    assert (np.diff(told) < 0).all()
    # By the thin lens: f^2 / N |1/s - 1/d| at most half the circle to either side of each focus.
    focal = 0.036 / (2 * np.tan(np.radians(35)))
    reach = 0.5 * optics.circle * 0.95 / focal**2
    ends = [1 / first, *(0.5 * (1 / told[1:] + 1 / told[:-1])), 1 / last]
    off = [max(abs(1 / s - a), abs(1 / s - b)) for s, a, b in zip(told, ends, ends[1:], strict=False)]
    assert max(off) <= reach * 1.3  # legs end beside the middles
    assert len(told) <= 3 * (1 / last - 1 / first) / (2 * reach)


@pytest.mark.slow
def test_nothing_is_focused_where_nothing_is_said_of_an_aperture() -> None:
    assert commands(MAVLINK.emit(orbit_plan()), 532) == []
    shutter = FAST._replace(aperture=None)
    emission = MAVLINK.emit(plan(straight(), mission=mission(), target="tower", optics=shutter))
    assert commands(emission, 532) == []
    assert emission.notes[-2] == "px4 cam1: set by hand on the camera, as no file holds it: shutter 1/50 s"


def test_other_machines_are_told_what_is_left_to_the_hand() -> None:
    by_hand = "set by hand on the camera, as no file holds it: aperture f/0.95, shutter 1/50 s, focus"
    ardupilot = MAVLINK.emit(
        plan(straight(), mission=mission(), target="tower", optics=FAST, autopilot="ardupilot")
    )
    assert commands(ardupilot, 532) == []
    assert ardupilot.notes[-2] == f"ardupilot cam1: {by_hand}"


@pytest.mark.long
def test_files_of_dji_are_told_so_too() -> None:
    emission = DJI.emit(retold(orbit_plan(), optics=FAST, autopilot="pilot-2"))
    assert any("as no file holds it: aperture f/0.95" in note for note in emission.notes)
