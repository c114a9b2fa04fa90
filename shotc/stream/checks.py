"""Checks vehicles before they are armed: pure functions over what was read from them.

Each returns diagnostics. A flight starts only if none of them is an error.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import degrees, dist, hypot, inf, isfinite
from typing import NamedTuple

import numpy as np

from shotc.diag.model import Diagnostic, Label
from shotc.geom.earth import of_world, to_world
from shotc.geom.vec import Vec3, minus
from shotc.ir.drone import Drone
from shotc.ir.mission import GeoOrigin, MissionIR
from shotc.rounding import up
from shotc.stream.autopilots import MULTIROTORS, NAMES, Action, LossRule
from shotc.stream.messages import GlobeFix
from shotc.stream.projection import LocalFrame
from shotc.stream.reading import HEARTBEAT_S, READ_S, missing
from shotc.stream.setpoints import SetpointSeries, pitch_range, speeds
from shotc.stream.vehicle import VehicleStatus

HOME_OFF_M = 1.0
"""How far the home may be from the pad on which the plan starts and ends."""
ELSEWHERE_M = 100.0
"""A vehicle farther from its pad than this is at another site than the mission's."""
ORIGIN_FAR_M = 1000.0
"""Farther from the frame's origin than this, the vehicle's North and Down differ too much from the plan's."""
STANDBY, ACTIVE = 3, 4
"""MAV_STATE of a vehicle that waits to be armed, and of one with running motors."""
STATES = {
    0: "not initialised",
    1: "booting",
    2: "calibrating",
    4: "active",
    5: "critical",
    6: "in an emergency",
}
SPEED_SLACK_SHARE = 0.01
SLACK_RAD = 0.0175
"""One degree: gimbals round the range that they report."""


class Ready(NamedTuple):
    """One drone of the mission, with what was read from its vehicle."""

    mission: MissionIR
    drone: Drone
    vehicle: VehicleStatus

    def label(self, *keys: str) -> Label:
        """Return the location of a key of the drone in the mission file."""
        return self.mission.origins.value((*self.drone.path, *keys))


def answered(ready: Ready) -> list[Diagnostic]:
    """Check which vehicle answers, and whether it answered enough to check the rest."""
    vehicle, name = ready.vehicle, ready.drone.name
    if vehicle.heartbeat is None:
        return [_nobody(ready)]
    if vehicle.heartbeat.autopilot != vehicle.autopilot.number:
        return [_other_autopilot(ready)]
    if vehicle.heartbeat.kind not in MULTIROTORS:
        number = vehicle.heartbeat.kind
        return [
            Diagnostic(
                "A004",
                f"the vehicle of `{name}` does not hover",
                (ready.label("model"),),
                (f"its heartbeat says MAV_TYPE {number}; a plan is flown by multirotors and helicopters",),
                "give the address of the right vehicle with --to",
            )
        ]
    silent = sorted(missing(vehicle))
    if silent:
        return [_silent(ready, silent)]
    return []


def ready_to_fly(ready: Ready, origin: GeoOrigin, course: SetpointSeries | None) -> list[Diagnostic]:
    """Check a vehicle that has answered all that is needed.

    origin : origin of the plan's frame
    course : the setpoints to send, None if the vehicle's position is unknown
    """
    diagnostics = [*_state(ready), *_losses(ready), *_place(ready, origin)]
    return diagnostics if course is None else [*diagnostics, *_gimbal(ready, course), *_speeds(ready, course)]


def frame_of(ready: Ready, origin: GeoOrigin) -> LocalFrame | None:
    """Return the local frame of a vehicle, None if it did not report it."""
    vehicle = ready.vehicle
    if vehicle.origin is None or vehicle.home is None:
        return None
    return LocalFrame(vehicle.autopilot.layout, vehicle.origin, vehicle.home.alt - pad_of(ready, origin).alt)


def pad_of(ready: Ready, origin: GeoOrigin) -> GlobeFix:
    """Return the position of the pad on the globe."""
    lat, lon, alt = of_world(np.array([ready.drone.home]), origin)[0].tolist()
    return GlobeFix(lat, lon, alt)


def home_offset(ready: Ready, origin: GeoOrigin) -> Vec3:
    """Return the vehicle's home minus the drone's pad: East, North, Up, m."""
    assert ready.vehicle.home is not None
    return minus(_in_world(ready.vehicle.home, origin), ready.drone.home)


def actions_of(vehicle: VehicleStatus) -> dict[str, Action]:
    """Return the action of the autopilot on a lost link, by parameter."""
    known = vehicle.parameters
    actions = {
        rule.parameter: rule.actions.get(_whole(known.get(rule.parameter)))
        for rule in vehicle.autopilot.losses
    }
    return {parameter: action for parameter, action in actions.items() if action is not None}


def loss_times(vehicle: VehicleStatus) -> dict[str, float]:
    """Return after how many seconds of silence it does so, by parameter."""
    rows = vehicle.autopilot.times
    return {r.parameter: vehicle.parameters[r.parameter] for r in rows if r.parameter in vehicle.parameters}


def _nobody(ready: Ready) -> Diagnostic:
    endpoint = ready.vehicle.link.endpoint
    return Diagnostic(
        "A003",
        f"no autopilot is heard for `{ready.drone.name}`",
        (ready.label(),),
        (f"{HEARTBEAT_S:.0f} s were waited for a HEARTBEAT at {endpoint}",),
        "switch the vehicle on, let its telemetry send to this machine and port, or give another address",
    )


def _other_autopilot(ready: Ready) -> Diagnostic:
    vehicle, name = ready.vehicle, ready.drone.name
    assert vehicle.heartbeat is not None
    number = vehicle.heartbeat.autopilot
    theirs = NAMES.get(number, f"MAV_AUTOPILOT {number}")
    return Diagnostic(
        "A004",
        f"the vehicle of `{name}` runs {theirs}, and the plan is for {vehicle.autopilot.name}",
        (ready.label("autopilot"),),
        (f"drones.{name}.autopilot says {ready.drone.autopilot}",),
        "write the autopilot that flies into the mission and plan again, or give the right vehicle's address",
    )


def _silent(ready: Ready, silent: Sequence[str]) -> Diagnostic:
    place = {"GPS_GLOBAL_ORIGIN", "HOME_POSITION", "LOCAL_POSITION_NED"}
    fix = "wait until it has a position by satellites" if place & set(silent) else "check its radio link"
    return Diagnostic(
        "A006",
        f"the vehicle of `{ready.drone.name}` does not report what has to be known before a flight",
        (ready.label(),),
        (f"no answer within {READ_S:.0f} s: {', '.join(silent)}", *_status_texts(ready.vehicle)),
        f"{fix}, then run this again",
    )


def _state(ready: Ready) -> Iterator[Diagnostic]:
    vehicle, name = ready.vehicle, ready.drone.name
    assert vehicle.heartbeat is not None
    if vehicle.armed or vehicle.heartbeat.status == ACTIVE:
        yield Diagnostic(
            "A005",
            f"the vehicle of `{name}` is armed already",
            (ready.label(),),
            ("a plan begins on the pad, with motors off",),
            "land and disarm it, then run this again",
        )
    elif vehicle.heartbeat.status != STANDBY:
        state = STATES.get(vehicle.heartbeat.status, f"in MAV_STATE {vehicle.heartbeat.status}")
        yield Diagnostic(
            "A005",
            f"the vehicle of `{name}` is not ready: it is {state}",
            (ready.label(),),
            _status_texts(vehicle),
            "wait until it stands by, or correct what it reports",
        )


def _losses(ready: Ready) -> Iterator[Diagnostic]:
    known = ready.vehicle.parameters
    for rule in ready.vehicle.autopilot.losses:
        if rule.parameter in known:
            value = _whole(known[rule.parameter])
            if value not in rule.actions and value not in rule.harmless:
                yield _forbidden(ready, rule, known[rule.parameter])
    for row in ready.vehicle.autopilot.times:
        silence = known.get(row.parameter, 0.0)
        if not 0.0 <= silence <= row.longest:
            yield Diagnostic(
                "A008",
                f"the autopilot of `{ready.drone.name}` minds a lost link too late",
                (ready.label(),),
                (
                    f"{row.parameter} is {silence:g} s, and at most {row.longest:g} s may pass",
                    "until then it follows the last setpoint",
                ),
                f"set {row.parameter} to at most {row.longest:g}",
            )


def _forbidden(ready: Ready, rule: LossRule, value: float) -> Diagnostic:
    allowed = ", ".join(f"{number} ({action})" for number, action in sorted(rule.actions.items()))
    also = ", ".join(f"{number}" for number in sorted(rule.harmless))
    number, action = rule.safe
    return Diagnostic(
        "A007",
        f"when its link is lost, the autopilot of `{ready.drone.name}` neither holds, returns nor lands",
        (ready.label(),),
        (f"{rule.parameter} is {value:g}; a plan is flown with {allowed}" + f", or {also}" * bool(also),),
        f"set {rule.parameter} to {number}, which is {action}, in a ground station",
    )


def _place(ready: Ready, origin: GeoOrigin) -> Iterator[Diagnostic]:
    vehicle = ready.vehicle
    assert vehicle.origin is not None
    offset = home_offset(ready, origin)
    if dist(offset, (0.0, 0.0, 0.0)) > ELSEWHERE_M:
        yield _elsewhere(ready, offset)
        return
    if dist(offset, (0.0, 0.0, 0.0)) > HOME_OFF_M:
        yield _home_off(ready, origin, offset)
    far = minus(_in_world(vehicle.origin, origin), ready.drone.home)
    if hypot(*far) > ORIGIN_FAR_M:
        yield Diagnostic(
            "A011",
            f"the local frame of `{ready.drone.name}` begins {hypot(*far) / 1000:.1f} km from its pad",
            (ready.label("home"),),
            (f"at most {ORIGIN_FAR_M / 1000:.0f} km, so that North and Down there are the plan's",),
            "restart the autopilot where it is to fly",
        )
    yield from _off_its_home(ready, origin)


def _off_its_home(ready: Ready, origin: GeoOrigin) -> Iterator[Diagnostic]:
    """Check where the vehicle stands now: its home may date from an earlier start."""
    frame, position = frame_of(ready, origin), ready.vehicle.position
    assert frame is not None
    assert position is not None
    pad = frame.of_places(of_world(np.array([ready.drone.home]), origin))[0]
    distance = dist(position, pad.tolist())
    home = ready.vehicle.home
    if (
        distance > HOME_OFF_M
        and home is not None
        and dist(home_offset(ready, origin), (0.0, 0.0, 0.0)) <= HOME_OFF_M
    ):
        yield Diagnostic(
            "A010",
            f"the vehicle of `{ready.drone.name}` stands {distance:.1f} m from its pad",
            (ready.label("home"),),
            (f"by its LOCAL_POSITION_NED; its home is right, and at most {HOME_OFF_M:g} m are flown with",),
            "put it on its pad, and wait until its position is steady",
        )


def _elsewhere(ready: Ready, offset: Vec3) -> Diagnostic:
    assert ready.vehicle.home is not None
    lat, lon, alt = ready.vehicle.home
    return Diagnostic(
        "A009",
        f"the plan of `{ready.drone.name}` is for another place: its pad is {_far(offset)} from the vehicle",
        (ready.mission.origins.value(("world", "origin")),),
        (f"the vehicle's home is at {lat:.7f}, {lon:.7f}, {alt:.1f} m",),
        "fly the plan where it belongs, or give `world.origin` the place of this flight and plan again",
    )


def _home_off(ready: Ready, origin: GeoOrigin, offset: Vec3) -> Diagnostic:
    assert ready.vehicle.home is not None
    across, rise = hypot(offset[0], offset[1]), offset[2]
    there = tuple(round(c, 2) + 0.0 for c in _in_world(ready.vehicle.home, origin))
    return Diagnostic(
        "A010",
        f"the home of `{ready.drone.name}` is {dist(offset, (0, 0, 0)):.1f} m from the plan's",
        (ready.label("home"),),
        (
            f"{across:.2f} m across ({_signed(offset[0])} East, {_signed(offset[1])} North), "
            f"{_signed(rise)} m in height; at most {HOME_OFF_M:g} m",
            f"in the mission's frame it is at [{there[0]:g}, {there[1]:g}, {there[2]:g}]",
        ),
        "put the vehicle on its pad and let it take its home there; where the whole site is off, as heights "
        "by satellites are, move `world.origin` by as much and plan again",
    )


def _gimbal(ready: Ready, course: SetpointSeries) -> Iterator[Diagnostic]:
    gimbal, name = ready.vehicle.gimbal, ready.drone.name
    if gimbal is None:
        yield Diagnostic(
            "A012",
            f"no gimbal answers on the vehicle of `{name}`",
            (ready.label("gimbal"),),
            ("GIMBAL_MANAGER_INFORMATION was asked for: the camera would not look where the plan does",),
            "set up the gimbal as a MAVLink gimbal (PX4: MNT_MODE_IN 4; ArduPilot: MNT1_TYPE)",
        )
        return
    low, high = pitch_range(course)
    least, most = gimbal.pitch
    known = isfinite(least) and isfinite(most) and least < most
    if known and (low < least - SLACK_RAD or high > most + SLACK_RAD):
        yield Diagnostic(
            "A012",
            f"the gimbal of `{name}` does not reach all that the plan looks at",
            (ready.label("gimbal"),),
            (
                f"the plan pitches from {degrees(low):.0f} to {degrees(high):.0f} degrees; "
                f"the gimbal from {degrees(least):.0f} to {degrees(most):.0f}",
            ),
            f"write its range into `drones.{name}.gimbal` and plan again",
        )


def _speeds(ready: Ready, course: SetpointSeries) -> Iterator[Diagnostic]:
    needed = speeds(course)
    for limit in ready.vehicle.autopilot.speeds:
        most = ready.vehicle.parameters.get(limit.parameter, inf)
        if needed[limit.axis] > most * (1 + SPEED_SLACK_SHARE):
            yield Diagnostic(
                "A014",
                f"the vehicle of `{ready.drone.name}` is not let fly as fast as the plan",
                (ready.label("limits"),),
                (f"it asks for {needed[limit.axis]:.1f} m/s {limit.axis}; {limit.parameter} is {most:g}",),
                f"set {limit.parameter} to {up(needed[limit.axis], 1):g} or more, or plan with lower limits",
            )


def _status_texts(vehicle: VehicleStatus) -> tuple[str, ...]:
    return tuple(f"it says: {text}" for text in vehicle.texts)


def _in_world(place: GlobeFix, origin: GeoOrigin) -> Vec3:
    east, north, up = to_world(np.array([place]), origin)[0].tolist()
    return (east, north, up)


def _signed(metres: float) -> str:
    return f"{round(metres, 2) + 0.0:+.2f}"


def _far(offset: Vec3) -> str:
    distance = dist(offset, (0.0, 0.0, 0.0))
    return f"{distance / 1000:.1f} km" if distance >= 1000 else f"{distance:.0f} m"


def _whole(value: float | None) -> int:
    """Return a parameter as an integer, -1000 if it is not one."""
    return round(value) if value is not None and isfinite(value) and value == round(value) else -1000
