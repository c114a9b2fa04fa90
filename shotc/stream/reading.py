"""Reads the vehicles before any check: which autopilot answers, where it is, and what it does on
a lost link.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

from shotc.stream.clock import PERIOD_S, FlightClock
from shotc.stream.messages import GimbalManager, Home, LocalPosition, Message, Origin
from shotc.stream.vehicle import VehicleStatus

HEARTBEAT_S = 10.0
"""How long to wait for a vehicle's first heartbeat."""
READ_S = 6.0
"""How long to wait for its answers, from its first heartbeat on."""
SOME_LACK_S = 2.0
"""How long to wait for parameters that some versions lack."""
AGAIN_S = 0.5
"""A request is repeated after this time: a radio link loses about one message in ten."""
BEAT_S = 1.0
POSITION_HZ = 10.0


class AskedMessage(NamedTuple):
    """A message to request, the attribute of VehicleStatus that holds it, and its MAVLink name."""

    kind: type[Message]
    known: str
    name: str


ASKED = (
    AskedMessage(Origin, "origin", "GPS_GLOBAL_ORIGIN"),
    AskedMessage(Home, "home", "HOME_POSITION"),
    AskedMessage(LocalPosition, "position", "LOCAL_POSITION_NED"),
    AskedMessage(GimbalManager, "gimbal", "GIMBAL_MANAGER_INFORMATION"),
)


def read(
    vehicles: Sequence[VehicleStatus], clock: FlightClock, note: Callable[[str], None] = lambda _: None
) -> None:
    """Wait for all vehicles and read their answers; what does not arrive stays unknown."""
    start = now = clock.now()
    met: dict[str, float] = {}
    beat = requested = start - 60.0
    while not all(_is_read(vehicle, met.get(vehicle.drone), start, now) for vehicle in vehicles):
        if now - beat >= BEAT_S:
            beat = now
            for vehicle in vehicles:
                vehicle.link.heartbeat()
        for vehicle in vehicles:
            _meet(vehicle, met, now, note)
        if now - requested >= AGAIN_S:
            requested = now
            for vehicle in vehicles:
                _ask(vehicle)
        clock.wait_until(now + PERIOD_S)
        now = clock.now()
    for vehicle in vehicles:
        _take_station(vehicle)


def missing(vehicle: VehicleStatus) -> Iterator[str]:
    """Yield the MAVLink names of missing answers, except those that some versions lack."""
    yield from (m.name for m in ASKED if m.known != "gimbal" and getattr(vehicle, m.known) is None)
    pilot = vehicle.autopilot
    yield from (n for n in pilot.parameters if n not in vehicle.parameters and not pilot.can_lack(n))


def _meet(vehicle: VehicleStatus, met: dict[str, float], now: float, note: Callable[[str], None]) -> None:
    vehicle.listen(now)
    if vehicle.heartbeat is not None and vehicle.drone not in met:
        met[vehicle.drone] = now
        note(f"{vehicle.drone}: system {vehicle.heartbeat.system} is there")


def _take_station(vehicle: VehicleStatus) -> None:
    """Use the system id of the ground station whose silence the autopilot monitors."""
    known = vehicle.parameters
    station = next((known[name] for name in vehicle.autopilot.station if name in known), 0.0)
    if 1 <= station <= 255:
        vehicle.link.speak_as(int(station))


def _ask(vehicle: VehicleStatus) -> None:
    if vehicle.heartbeat is None or vehicle.heartbeat.autopilot != vehicle.autopilot.number:
        return
    for message in ASKED:
        if getattr(vehicle, message.known) is None:
            vehicle.link.ask(message.kind)
    if not vehicle.parameters:  # first request
        vehicle.link.stream(LocalPosition, POSITION_HZ)
    for name in vehicle.autopilot.parameters:
        if name not in vehicle.parameters:
            vehicle.link.ask_parameter(name)


def _is_read(vehicle: VehicleStatus, met: float | None, start: float, now: float) -> bool:
    if met is None or vehicle.heartbeat is None:
        return now - start >= HEARTBEAT_S
    if vehicle.heartbeat.autopilot != vehicle.autopilot.number:
        return True
    lacking = any(n not in vehicle.parameters for n in vehicle.autopilot.parameters)
    whole = not any(missing(vehicle)) and vehicle.gimbal is not None
    return now - met >= READ_S or (whole and (not lacking or now - met >= SOME_LACK_S))
