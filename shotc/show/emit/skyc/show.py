"""The content of a show file, in metres and seconds, North, West and Up of the mission's origin."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import ceil, degrees
from typing import Any

import numpy as np

from shotc.emit.audience import ASPECT, audience, picture_name, pictures_shown
from shotc.geom.bernstein import Array
from shotc.geom.camera import View
from shotc.geom.focal import focal_length
from shotc.geom.solid_arrays.points import in_footprint
from shotc.geom.solid_arrays.rings import ground_plan
from shotc.ir.fleet import FleetTrajectory
from shotc.ir.mission import MissionIR, Zone
from shotc.ir.show import Display, Fleet, PyroCue, drone_names
from shotc.ir.trajectory import VerifiedIR
from shotc.show.emit.sampled import by_number, carried
from shotc.show.emit.skyc.curve import COORDINATE_DECIMALS, Curves, curves
from shotc.show.emit.skyc.light_programs import programs

Json = dict[str, Any]

MOST_DRONES = 5000
"""Most drones of a show file: the loader of skybrush.js refuses more (``MAX_DRONE_COUNT`` in its
packages/show-format/src/constants.ts).
"""

STRAIGHT_M = 1.5e-4
"""Distance of inner control points from the thirds of a chord, below which the chord replaces
them, metres.
"""


@dataclass(frozen=True, slots=True, eq=False)
class ShowFile:
    """A show file's content, and its differences from the plan.

    error : largest distance of its flights from the plan's, metres
    left_out : zones that its geofence lacks
    """

    content: Json
    error: float
    left_out: tuple[Zone, ...]


def show_of(plan: VerifiedIR) -> ShowFile:
    """Return the show of all fleets of a plan."""
    mission = plan.trajectory.keyframes.mission
    flights = plan.trajectory.fleets
    flown = [curves(flight) for flight in flights]
    control = np.concatenate([curve.control.reshape(-1, 3) for curve in flown])
    keep_in = [zone for zone in mission.zones if zone.keep == "in"]
    left = tuple(zone for zone in keep_in if not in_footprint(zone.solid, control[:, :2]).all())
    by_fleet = {f.fleet: list(_drones(mission, f, curve)) for f, curve in zip(flights, flown, strict=True)}
    drones = [drone for _, drone in by_number(mission, by_fleet)]
    fences = [np.pad(ground_plan(zone.solid), ((0, 0), (0, 1))) for zone in keep_in if zone not in left]
    content: Json = {
        "version": 1,
        "meta": {
            "title": mission.name,
            "id": mission.source_sha256[:16],
            "segments": _segments(flights),
        },
        "environment": _environment(plan),
        "settings": {
            "cues": {"version": 1, "items": _cues(plan)},
            "geofence": {
                "version": 1,
                "polygons": [{"isInclusion": True, "points": _turned(points)} for points in fences],
            },
            "validation": _limits(mission, float(control[:, 2].max())),
        },
        "swarm": {"drones": drones},
    }
    # Inner control points replaced by a chord move by at most this.
    return ShowFile(content, max(curve.error for curve in flown) + STRAIGHT_M, left)


def _turned(points: Array) -> list[list[float]]:
    """Return points of W (East, North, Up) as North, West, Up."""
    turned = np.stack([points[..., 1], -points[..., 0], points[..., 2]], axis=-1)
    return list((np.round(turned, COORDINATE_DECIMALS) + 0.0).tolist())


def _drones(mission: MissionIR, flight: FleetTrajectory, fitted: Curves) -> Iterator[Json]:
    fleet = mission.fleet(flight.fleet)
    fired = _pyro_programs(mission.displays, fleet)
    takeoff = int(fitted.millis[0])
    times = ((fitted.millis - takeoff) / 1e3).tolist()
    third = (fitted.control[:, :, 3] - fitted.control[:, :, 0]) / 3.0
    chord = np.stack([fitted.control[:, :, 0] + third, fitted.control[:, :, 3] - third], axis=2)
    straight = np.linalg.norm(fitted.control[:, :, 1:3] - chord, axis=-1).max(axis=-1) < STRAIGHT_M
    for name, control, lines, code, pyro in zip(
        drone_names(fleet), fitted.control, straight.tolist(), programs(flight), fired, strict=True
    ):
        turned = _turned(control)
        points = [[times[0], turned[0][0], []]]
        points += [
            [time, piece[3], [] if line else [piece[1], piece[2]]]
            for time, piece, line in zip(times[1:], turned, lines, strict=True)
        ]
        yield {
            "type": "generic",
            "settings": {
                "name": name,
                "home": points[0][1],
                "landAt": points[-1][1],
                "trajectory": {
                    "version": 1,
                    "takeoffTime": takeoff / 1e3,
                    "landingTime": int(fitted.millis[-1]) / 1e3,
                    "points": points,
                },
                "lights": {"version": 1, "data": b64encode(code).decode("ascii")},
                **({} if pyro is None else {"pyro": pyro}),
            },
        }


def _segments(flights: tuple[FleetTrajectory, ...]) -> dict[str, list[float]]:
    """Return the time intervals of take-off, show and landing."""
    up = max(p.end for f in flights for p in f.phases if p.name == "takeoff")
    down = min(p.start for f in flights for p in f.phases if p.name == "land")
    end = max(float(f.breaks[-1]) for f in flights)
    if up >= down:  # one fleet lands before another has risen
        return {"show": [0.0, round(end, 3)]}
    marks = [round(t, 3) for t in (0.0, up, down, end)]
    return {"takeoff": marks[0:2], "show": marks[1:3], "landing": marks[2:4]}


def _environment(plan: VerifiedIR) -> Json:
    mission = plan.trajectory.keyframes.mission
    environment: Json = {"type": "outdoor"}
    if mission.origin is not None:
        place = mission.origin
        environment["location"] = {"origin": [place.lat_deg, place.lon_deg, place.alt], "orientation": 0}
    environment["cameras"] = [_camera(plan, i) for i in range(len(mission.displays))]
    return environment


def _camera(plan: VerifiedIR, index: int) -> Json:
    display = plan.trajectory.keyframes.mission.displays[index]
    seen = audience(plan, display, ASPECT)
    return {
        "name": f"audience of {display.id}",
        "type": "perspective",
        "position": _turned(np.array(seen.eye)),
        "orientation": _orientation(seen.view(ASPECT)),
        "focalLength": round(1e3 * focal_length(seen.hfov), 2),
        "default": index == 0,
    }


def _orientation(looks: View) -> list[float]:
    """Return the quaternion (w, x, y, z) of a camera; without rotation it looks down, with North to its
    right.
    """
    # to_camera is linear, so its rows are the camera's axes in W.
    east, north, up = np.eye(3)
    right, down, forward = (np.array(axis) for axis in looks.to_camera((east, north, up)))
    axes = np.stack([right, -down, -forward], axis=1)
    turn = np.stack([axes[1], -axes[0], axes[2]])
    # Shepperd's method, with the largest of the four components, is stable for every rotation.
    squares = np.array([np.trace(turn), *np.diag(turn)])
    w, x, y, z = _from(int(np.argmax(squares)), turn)
    return [round(float(c), 9) + 0.0 for c in np.array([w, x, y, z]) / np.linalg.norm([w, x, y, z])]


def _from(largest: int, m: Array) -> tuple[float, float, float, float]:
    skew = (m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1])
    if largest == 0:
        return (1.0 + np.trace(m), *skew)
    i = largest - 1
    column = m[i] + m[:, i]
    column[i] = 1.0 + 2.0 * m[i, i] - np.trace(m)
    return (skew[i], column[0], column[1], column[2])


def _cues(plan: VerifiedIR) -> list[Json]:
    mission = plan.trajectory.keyframes.mission
    cues = []
    for flight in plan.trajectory.fleets:
        for frame in pictures_shown(flight):
            name = picture_name(mission.display(frame.display).pictures[frame.picture])
            cues.append({"name": f"{frame.display}: {name}", "time": round(frame.start, 3)})
    return sorted(cues, key=lambda cue: cue["time"])


def _limits(mission: MissionIR, highest: float) -> Json:
    fleets = mission.fleets
    tops = [zone.solid.top for zone in mission.zones if zone.keep == "in"]
    return {
        "maxAltitude": float(min([top for top in tops if top >= highest], default=ceil(highest))),
        "maxVelocityXY": max(fleet.limits.speed for fleet in fleets),
        "maxVelocityZ": max(fleet.limits.descent for fleet in fleets),
        "maxVelocityZUp": max(fleet.limits.climb for fleet in fleets),
        "minDistance": min(min(f.apart.horizontal, f.apart.vertical) for f in fleets),
    }


def _pyro_programs(displays: Sequence[Display], fleet: Fleet) -> list[dict[str, Any] | None]:
    """Return the pyro programme of every drone of a fleet; None for a drone without products."""
    return [_pyro_program(cues) if cues else None for cues in carried(displays, fleet)]


def _pyro_program(cues: Sequence[PyroCue]) -> dict[str, Any]:
    """Return events [ignition in seconds, channel from 0, product] and the products, by channel from 1."""
    return {
        "version": 1,
        "events": [[round(cue.ignition, 3), k, str(k + 1)] for k, cue in enumerate(cues)],
        "payloads": {
            str(k + 1): {
                "name": cue.product,
                "duration": round(cue.duration, 3),
                "prefireTime": round(cue.prefire, 3),
                "yaw": round(degrees(cue.pan), 3),
                "pitch": round(degrees(cue.tilt), 3),
            }
            for k, cue in enumerate(cues)
        },
    }
