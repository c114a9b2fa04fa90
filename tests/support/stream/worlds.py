"""Flights over loopback in simulated time: a clock that drives the autopilots while the sender waits."""

from __future__ import annotations

import socket
from contextlib import ExitStack
from dataclasses import dataclass, field, replace

import numpy as np
from pymavlink.dialects.v20 import common as mavlink

from shotc.geom.earth import of_world
from shotc.stream.autopilots import AUTOPILOTS
from shotc.stream.endpoint import Endpoint
from shotc.stream.messages import GlobeFix
from shotc.stream.projection import LocalFrame
from shotc.stream.session import Session
from shotc.stream.sockets import DOORS
from tests.support.stream.autopilot import ARDUPILOT, PX4, Autopilot, Script

EPOCH = 1.8e9
"""The time of day at which a ``DrivenClock`` begins, POSIX seconds."""
SOMEWHERE = (47.0, 8.0, 400.0)


@dataclass
class DrivenClock:
    """A clock that stands until somebody waits; the autopilots live in the meantime.

    events : what happens at a time, each once: (time, call)
    """

    autopilots: list
    time: float = 1000.0
    events: list = field(default_factory=list)

    def now(self):
        return self.time

    def utc(self):
        return EPOCH + self.time

    def wait_until(self, moment):
        self.time = max(self.time, moment)
        for event in [e for e in self.events if e[0] <= self.time]:
            self.events.remove(event)
            event[1]()
        for autopilot in self.autopilots:
            autopilot.run(self.time)


def endpoints_of(ports):
    return {name: Endpoint("127.0.0.1", port, False) for name, port in ports.items()}


def free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class World:
    """A plan, its vehicles on their pads, and a session with them."""

    def __init__(self, plan, *, targets=(), **scripts):
        """Scripts : of drones by name, where a vehicle is not as it should be."""
        self.plan = plan
        self.mission = plan.trajectory.keyframes.mission
        self.lines = []
        self.stack = ExitStack()
        self.ports, self.autopilots = {}, {}
        for system, track in enumerate(plan.trajectory.drones, 1):
            self.ports[track.drone] = free_port()
            script = scripts.get(track.drone, Script())
            self.autopilots[track.drone] = self._autopilot(track.drone, system, script)
        self.clock = DrivenClock(list(self.autopilots.values()))
        self.targets = {name: Endpoint("127.0.0.1", free_port(), False) for name in targets}
        self.session = self.stack.enter_context(Session(plan, DOORS, self.clock, self.lines.append))

    def _autopilot(self, name, system, script):
        drone = self.mission.drone(name)
        if script.kind is None:
            script = replace(script, kind=PX4 if drone.autopilot == "px4" else ARDUPILOT)
        pad = np.array(drone.home) + script.shift
        home, place = (
            tuple(of_world(point[None], self.mission.origin or SOMEWHERE)[0].tolist())
            for point in (pad, pad + script.stands)
        )
        layout = AUTOPILOTS["px4" if script.kind == PX4 else "ardupilot"].layout
        local = LocalFrame(layout, GlobeFix(*(script.tie or home))).of_places(np.array([place]))[0]
        made = Autopilot(self.ports[name], system, script, home, local)
        self.stack.callback(made.close)
        return made

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.stack.close()

    @property
    def endpoints(self):
        return endpoints_of(self.ports)

    def check(self):
        found = self.session.open(self.endpoints, self.targets)
        if found:
            return [], found
        return self.session.check()

    def fly(self):
        aboard, found = self.check()
        assert found == [], found
        return self.session.fly(aboard)


def send_json(endpoint, text):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        sender.sendto(text.encode(), (endpoint.host, endpoint.port))


def send_position(endpoint, place, system=7):
    mav = mavlink.MAVLink(None, srcSystem=system, srcComponent=1)
    lat, lon, alt = place
    message = mav.global_position_int_encode(
        0, round(lat * 1e7), round(lon * 1e7), round(alt * 1e3), 0, 0, 0, 0, 0
    )
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        sender.sendto(message.pack(mav), (endpoint.host, endpoint.port))
