"""A vehicle of few rules that flies a mission file: those of ``outputs.md``, and of the MAVLink commands.

Straight legs at the speeds that were commanded last. A PX4 turns to a waypoint's heading from the beginning
of the leg to it, an ArduPilot as it was told, and as a whole where its gimbal cannot turn. A vehicle stays at
a waypoint after it has arrived there, and turns on meanwhile. A gimbal looks at the region of interest, or
stands as it was commanded: against the body, or with its yaw from North where the command locks it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from tests.support.second_opinion.flight import Array
from tests.support.second_opinion.mission_files import Item, MissionFile

TAKEOFF, LAND, WAYPOINT = 22, 21, 16
TURN, SPEED, LOOK_AT, LOOK_AHEAD, TILT = 115, 178, 195, 197, 205
POINT_GIMBAL, TAKE_GIMBAL, RECORD, STOP = 1000, 1001, 2500, 2501
FOCUS, METRES = 532, 3  # and the type in which it is a distance
STEP = 0.02  # metres between two points of a leg
POINTS = 20  # of a leg at least, and of a stay
YAW_LOCK = 16  # bit of parameter 5 of POINT_GIMBAL
PX4_TURN = np.radians(45.0)  # rad/s
CAN_PAN = np.radians(1.0)  # range from which a gimbal turns by itself


class Flown(NamedTuple):
    """Points of a flight, shapes (K, ...): place, body's yaw, camera's yaw and pitch (NaN where nobody aims
    it), number of the recording (-1 outside) and of the leg, metres at which the lens is focused (NaN where
    nobody says); and how long all recordings take by speeds alone, seconds.
    """

    place: Array
    body: Array
    aim: Array
    recording: Array
    leg: Array
    focus: Array
    filmed: float

    def some(self, which: Array) -> Flown:
        """Return some of the points."""
        return Flown(*(field[which] for field in self[:-1]), self.filmed)


@dataclass(frozen=True)
class Vehicle:
    """What is in force between two items.

    speeds : over ground, up, down; turn : yaw to turn to, and rad/s with their sign
    gimbal : pitch and yaw, against the body or, if locked, from East; recording : number of the last one
    focus : metres
    """

    drone: dict[str, Any]
    file: MissionFile
    at: Array
    yaw: float
    speeds: tuple[float, float, float]
    turn: tuple[float, float] | None = None
    gimbal: tuple[float, float] | None = None
    locked: bool = False
    region: Array | None = None
    recording: int = -1
    focus: float = float("nan")
    filming: bool = False

    @property
    def pans(self) -> bool:
        """Whether the gimbal turns by itself."""
        low, high = self.drone["gimbal"]["yaw"]
        return bool(high - low > CAN_PAN)


def fly(file: MissionFile, drone: dict[str, Any], yaw: float) -> Flown:
    """Fly a file from above the pad to above the pad; yaw : of the body on the pad."""
    limits = drone["limits"]
    speeds = (limits["speed"], limits["climb"], limits["descent"])
    now = Vehicle(drone, file, file.place(file.items[0]), yaw, speeds)
    legs = []
    for item in file.items[1:-1]:
        if item.command == WAYPOINT:
            legs.append(_leg(now, item))
            now = replace(now, at=file.place(item), yaw=float(legs[-1].body[-1]), turn=None)
        else:
            now = COMMANDS[item.command](now, item)
    numbered = [leg._replace(leg=leg.leg + k) for k, leg in enumerate(legs)]
    parts = [np.concatenate(field) for field in list(zip(*numbered, strict=True))[:-1]]
    return Flown(*parts, sum(leg.filmed for leg in legs))


def _leg(now: Vehicle, item: Item) -> Flown:
    to = now.file.place(item)
    way = to - now.at
    up = now.speeds[1] if way[2] > 0 else now.speeds[2]
    moves, stays = max(float(np.hypot(way[0], way[1])) / now.speeds[0], abs(way[2]) / up), item.params[0]
    share = np.linspace(0.0, 1.0, max(POINTS, int(np.linalg.norm(way) / STEP) + 2))
    time = share * moves
    if stays:
        share = np.concatenate([share, np.ones(POINTS)])
        time = np.concatenate([time, np.linspace(moves, moves + stays, POINTS)])
    place = now.at + share[:, None] * way
    body, aim = _facing(now, item, place, time), np.full((len(share), 2), np.nan)
    if now.region is not None:
        yaw, pitch = _towards(now.region, place)
        aim = np.stack([yaw if now.pans else body, pitch], axis=1)
    elif now.gimbal is not None:
        pitch, pan = now.gimbal
        from_zero = np.zeros(len(share)) if now.locked else body
        aim = np.stack([from_zero + pan, np.full(len(share), pitch)], axis=1)
    recording = np.full(len(share), now.recording if now.filming else -1)
    focus, filmed = np.full(len(share), now.focus), float(time[-1]) if now.filming else 0.0
    return Flown(place, body, aim, recording, np.zeros(len(share)), focus, filmed)


def _facing(now: Vehicle, item: Item, place: Array, time: Array) -> Array:
    if now.drone["autopilot"] == "px4":
        by = _shortest(np.pi / 2 - np.radians(item.params[3]) - now.yaw)
        return now.yaw + np.clip(by, -PX4_TURN * time, PX4_TURN * time)
    if now.region is not None and not now.pans:
        return _towards(now.region, place)[0]
    if now.turn is None:
        return np.full(len(time), now.yaw)
    to, rate = now.turn
    return np.asarray(to - np.copysign(np.maximum(abs(to - now.yaw) - abs(rate) * time, 0.0), rate))


def _shortest(turn: float) -> float:
    return float((turn + np.pi) % (2 * np.pi) - np.pi)


def _towards(region: Array, place: Array) -> tuple[Array, Array]:
    away = region - place
    return np.arctan2(away[:, 1], away[:, 0]), np.arctan2(away[:, 2], np.hypot(away[:, 0], away[:, 1]))


def _speed(now: Vehicle, item: Item) -> Vehicle:
    ground, up, down = (
        item.params[1] if item.params[0] == kind else old
        for kind, old in zip((1, 2, 3), now.speeds, strict=True)
    )
    return replace(now, speeds=(ground, up, down))


def _turn(now: Vehicle, item: Item) -> Vehicle:
    heading, rate, way, _ = item.params[:4]
    by = _shortest(np.pi / 2 - np.radians(heading) - now.yaw)
    if way:  # 1 is clockwise, as yaw is not
        by = by % (2 * np.pi) - (2 * np.pi if way > 0 else 0.0)
    return replace(now, turn=(now.yaw + by, float(np.copysign(np.radians(rate), by))))


def _point(now: Vehicle, item: Item) -> Vehicle:
    pitch, yaw = item.params[0], item.params[1 if item.command == POINT_GIMBAL else 2]
    locked = item.command == POINT_GIMBAL and bool(int(item.params[4]) & YAW_LOCK)
    pan = (np.pi / 2 if locked else 0.0) - np.radians(yaw)
    return replace(now, gimbal=(np.radians(pitch), pan), locked=locked, region=None)


def _focus(now: Vehicle, item: Item) -> Vehicle:
    assert item.params[0] == METRES
    return replace(now, focus=item.params[1])


COMMANDS: dict[int, Callable[[Vehicle, Item], Vehicle]] = {
    SPEED: _speed,
    TURN: _turn,
    POINT_GIMBAL: _point,
    TILT: _point,
    TAKE_GIMBAL: lambda now, _: now,
    LOOK_AT: lambda now, item: replace(now, region=now.file.place(item), gimbal=None),
    LOOK_AHEAD: lambda now, _: replace(now, region=None, gimbal=None),
    FOCUS: _focus,
    RECORD: lambda now, _: replace(now, recording=now.recording + 1, filming=True),
    STOP: lambda now, _: replace(now, filming=False),
}
KNOWN = {TAKEOFF, LAND, WAYPOINT, *COMMANDS}
