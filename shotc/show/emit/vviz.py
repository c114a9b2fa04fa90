"""<mission>.vviz: the show for viewers, in the interchange format of Verge, which Finale 3D and FWsim read.

Format: docs.verge.aero (VVIZ format) and finale3d.com/documentation/vviz-file-format. It is JSON; X is right,
Y up and Z forward, here East, Up and North. Positions are differences from the sample before. The absolute
positions are rounded, so rounding errors do not accumulate. A colour lasts for a number of frames.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from math import degrees
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from shotc.emit.audience import picture_name, pictures_shown
from shotc.emit.base import Artifact, Emission
from shotc.filenames import file_name
from shotc.geom.bernstein import Array
from shotc.ir.fleet import Colors
from shotc.ir.sampling import clock
from shotc.ir.show import PyroCue
from shotc.ir.trajectory import VerifiedIR
from shotc.show.emit.sampled import Sampled, count, sampled
from shotc.spec.presets import MANY_DRONES

PLACES_HZ, COLORS_HZ = 4, 24
"""Samples a second, as in files of Skybrush."""

NORTH_DEG = 0.0
"""Heading of every drone, degrees clockwise from Z."""

Json = dict[str, Any]


@dataclass(frozen=True, slots=True)
class VvizEmitter:
    """Writes one file for all fleets, drone by drone; the same plan gives the same bytes."""

    name: ClassVar[str] = "vviz"
    summary: ClassVar[str] = "<mission>.vviz: the show of all fleets, for Finale 3D and other viewers"
    api: ClassVar[int] = 1

    def emit(self, plan: VerifiedIR) -> Emission:
        """Return the file; no file without fleets."""
        mission, drones = plan.trajectory.keyframes.mission, count(plan)
        if drones == 0:
            return Emission(
                (), notes=("no .vviz is written: it holds the show of a fleet, and the mission has none",)
            )
        parts, large = partial(_parts, plan), drones > MANY_DRONES
        whole = b"" if large else b"".join(parts())
        file = Artifact(f"{file_name(mission.name)}.vviz", whole, parts if large else None)
        note = f"{file.name} is for viewing, not for flight: straight between {PLACES_HZ} places a second"
        return Emission((file,), notes=(note,))


def _parts(plan: VerifiedIR) -> Iterator[bytes]:
    """Yield the file: its head, then drone by drone."""
    end = plan.trajectory.end
    times, frames = clock(PLACES_HZ, end), clock(COLORS_HZ, end)
    head = _dumped({**_head(plan), "performances": []})
    yield head.removesuffix("]}").encode()
    comma = ""
    for drone in sampled(plan, times, frames):
        yield f"{comma}{_dumped(_performance(plan, drone))}".encode()
        comma = ","
    yield b"]}\n"


def _dumped(value: Json) -> str:
    return json.dumps(value, allow_nan=False, separators=(",", ":"))


def _head(plan: VerifiedIR) -> Json:
    mission = plan.trajectory.keyframes.mission
    head: Json = {"version": "1.0", "performanceName": mission.name, "coordinateFrame": "ogl"}
    if mission.origin is not None:
        place = mission.origin
        head["globalReferenceFrame"] = {"lat": place.lat_deg, "lon": place.lon_deg, "alt": place.alt}
    rates = {"defaultPositionRate": float(PLACES_HZ), "defaultColorRate": float(COLORS_HZ)}
    return {**head, **rates, "timeOffsetSecs": 0.0, "eventTags": _tags(plan)}


def _tags(plan: VerifiedIR) -> list[Json]:
    mission = plan.trajectory.keyframes.mission
    tags = sorted(
        (round(s.start, 3), f"{s.display}: {picture_name(mission.display(s.display).pictures[s.picture])}")
        for flight in plan.trajectory.fleets
        for s in pictures_shown(flight)
    )
    return [{"time": time, "tagType": "EffectStart", "tagID": name} for time, name in tags]


def _performance(plan: VerifiedIR, drone: Sampled) -> Json:
    millimetres = np.round(1e3 * drone.places[:, [0, 2, 1]]).astype(np.int64)
    home = [value / 1e3 for value in millimetres[0].tolist()]
    return {
        "id": drone.number,
        "agentDescription": {
            **dict(zip(("homeX", "homeY", "homeZ"), home, strict=True)),
            "homeH": NORTH_DEG,
            "airframe": plan.trajectory.keyframes.mission.fleet(drone.fleet).model,
            "agentTraversal": _steps(millimetres),
        },
        "payloadDescription": [
            {"id": 0, "type": "Light", "payloadActions": _actions(drone.colors)},
            *(_fired(cue, k) for k, cue in enumerate(drone.pyro, 1)),
        ],
    }


def _fired(cue: PyroCue, number: int) -> Json:
    """Return the payload of a product, with one event; pan and tilt 0 point up."""
    return {
        "id": number,
        "type": "Pyro",
        "eventTime": round(cue.ignition, 3),
        "vdl": cue.product,
        "pan": round(degrees(cue.pan), 3),
        "tilt": round(90.0 - degrees(cue.tilt), 3),
    }


def _steps(millimetres: NDArray[np.int64]) -> list[Json]:
    """Return the steps between samples; a standing drone needs one step for any time.

    The first step states that the drone is at home at 0 s, for readers that count it like any other.
    """
    steps: list[Json] = [{"dx": 0.0, "dy": 0.0, "dz": 0.0, "dt": 0.0}]
    still = 0
    for dx, dy, dz in np.diff(millimetres, axis=0).tolist():
        if not (dx or dy or dz):
            still += 1
            continue
        steps += _standing(still)
        still = 0
        steps.append({"dx": dx / 1e3, "dy": dy / 1e3, "dz": dz / 1e3})
    return [*steps, *_standing(still)]


def _standing(samples: int) -> list[Json]:
    return [{"dx": 0.0, "dy": 0.0, "dz": 0.0, "dt": samples / PLACES_HZ}] if samples else []


def _actions(colors: Colors) -> list[Json]:
    """Return the colours, each with its number of frames if that is above one."""
    changes = np.flatnonzero((colors[1:] != colors[:-1]).any(axis=1)) + 1
    starts: Array = np.concatenate([[0], changes, [len(colors)]])
    return [
        {"r": r, "g": g, "b": b} if frames == 1 else {"r": r, "g": g, "b": b, "frames": frames}
        for (r, g, b), frames in zip(colors[starts[:-1]].tolist(), np.diff(starts).tolist(), strict=True)
    ]


EMITTER = VvizEmitter()
