"""The clock of the machine, and autopilots that live beside the sender: what is sent is judged, not when.

Time goes three times as fast, for a flight of seconds; a busy machine may be told to be one.
"""

from __future__ import annotations

import gc
import time
from contextlib import contextmanager
from threading import Event, Thread

import numpy as np
import pytest

from shotc.geom.earth import of_world
from shotc.stream.clock import WallClock
from shotc.stream.punctual import punctual
from shotc.stream.session import Session
from shotc.stream.sockets import DOORS
from tests.support.stream.autopilot import Script
from tests.support.stream.globe import in_world, px4_place
from tests.support.stream.plans import brief_plan
from tests.support.stream.worlds import World, endpoints_of, free_port

pytestmark = pytest.mark.slow

HURRY = 3.0
PARAMETERS = {"COM_OBL_RC_ACT": 5, "COM_OBL_ACT": 1, "NAV_DLL_ACT": 2, "COM_OF_LOSS_T": 1.0}
"""With COM_OBL_ACT, which older versions have, nothing is left to be waited for."""
BUSY = {"A021", "A022", "A023", "A025"}
"""What may be told truly where the machine is busy for long."""
PLAN = brief_plan()


class Hurried:
    """The clock of the machine, faster."""

    def __init__(self):
        self._wall = WallClock()

    def now(self):
        return self._wall.now() * HURRY

    def utc(self):
        return self._wall.utc()

    def wait_until(self, moment):
        self._wall.wait_until(moment / HURRY)


@contextmanager
def alive(step):
    """Run ``step`` again and again beside the block."""
    over = Event()

    def live():
        while not over.is_set():
            step(time.monotonic() * HURRY)
            time.sleep(0.004)

    thread = Thread(target=live)
    thread.start()
    try:
        yield
    finally:
        over.set()
        thread.join()


def flown_from(port):
    with Session(PLAN, DOORS, Hurried(), lambda _: None) as session, punctual():
        assert session.open(endpoints_of({"cam1": port}), {}) == []
        aboard, found = session.check()
        assert found == []
        flown, _ = session.fly(aboard)
    assert flown.landed or {d.code for d in flown.diagnostics} & BUSY
    assert not flown.landed or flown.times.ticks + flown.times.skipped >= 6 * 50
    return flown


def on_the_plan(places, origin):
    (track,) = PLAN.trajectory.drones
    world = PLAN.trajectory.keyframes.mission.origin
    path = track.curve(np.linspace(0.0, 6.0, 20_000))[:, :3]
    for place in places:
        there = in_world(place, origin, world, px4_place)
        assert np.linalg.norm(path - there, axis=1).min() < 0.02


@pytest.mark.long
def test_a_short_flight_by_the_clock_of_the_machine():
    with World(PLAN, cam1=Script(parameters=PARAMETERS)) as world:
        autopilot = world.autopilots["cam1"]
        with alive(autopilot.run):
            flown_from(world.ports["cam1"])
        on_the_plan(np.array(autopilot.setpoints)[::5, 1:4].tolist(), autopilot.origin)
    assert gc.isenabled()


@pytest.mark.long
def test_mavsdk_understands_all_that_is_sent():
    pytest.importorskip("mavsdk", exc_type=ModuleNotFoundError)
    from tests.support.stream.sdk_autopilot import SdkAutopilot

    mission = PLAN.trajectory.keyframes.mission
    port = free_port()
    place = tuple(of_world(np.array([mission.drone("cam1").home]), mission.origin)[0].tolist())
    autopilot = SdkAutopilot(port, place, PARAMETERS)

    try:
        with alive(autopilot.run):
            flown = flown_from(port)
    finally:
        autopilot.close()
    on_the_plan([(s["x"], s["y"], s["z"]) for s in autopilot.setpoints[::5]], place)
    assert {(s["type_mask"], s["coordinate_frame"], s["target_system"]) for s in autopilot.setpoints} == {
        (2048, 1, 1)
    }
    assert {aim["flags"] for aim in autopilot.aims} == {4 | 8}
    if flown.landed:
        recorded = [c["command"] for c in autopilot.commands if c["command"] in (2500, 2501)]
        assert recorded == [2500, 2501]
        assert min(s["z"] for s in autopilot.setpoints) == pytest.approx(-3.0, abs=0.01)
        pitches = [2 * np.arctan2(aim["q"][2], aim["q"][0]) for aim in autopilot.aims]
        assert min(pitches) == pytest.approx(-0.2, abs=1e-4)
