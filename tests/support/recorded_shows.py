"""Shows as other tools export them: tables a drone, zipped, and shows of Skybrush, made by hand."""

from __future__ import annotations

import json
from base64 import b64encode
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np

from shotc.api import Compilation, PlanOptions, compile_source
from shotc.geom.bernstein import Array
from tests.support.flight_files import zipped

HEAD = "Time [msec],x [m],y [m],z [m],Red,Green,Blue"
COUNT, SIDE, HIGH_M = 9, 3, 12.0
"""Drones, of a row, and how high they fly."""
PADS = tuple((4.0 * (i % SIDE), 4.0 * (i // SIDE), 0.0) for i in range(COUNT))
MISSION = """\
shotc: 1
mission: again
fleets:
  swarm: {{count: {count}, layout: {{grid: {{spacing: 4, origin: {origin}}}}}, separation: 2}}
shots:
  - {{id: show, kind: display, fleet: swarm, frames: {{flight: {file}}}}}
"""
Way = Callable[[Array], Array]
"""Places (n, T, 3) at times (T,)."""


def smooth(share: Array) -> Array:
    """A way from 0 to 1 with rest at both ends, to the second derivative."""
    x = np.clip(share, 0.0, 1.0)
    return np.asarray(x**3 * (10.0 - 15.0 * x + 6.0 * x * x))


def flown(seconds: float = 40.0, turn: float = np.pi / 2, lean: float = 0.0) -> Way:
    """Rise in a quarter of the time, turn about the middle in the next two, and land in the last."""
    pads = np.array(PADS)
    middle = pads.mean(axis=0)

    def way(times: Array) -> Array:
        share = times / seconds
        high = smooth(4.0 * share) * (1.0 - smooth(4.0 * share - 3.0)) * HIGH_M
        angle = turn * smooth(2.0 * share - 0.5)
        c, s = np.cos(angle), np.sin(angle)
        rel = pads - middle
        x = rel[:, :1] * c - rel[:, 1:2] * s + middle[0] + lean * high / HIGH_M
        y = rel[:, :1] * s + rel[:, 1:2] * c + middle[1]
        return np.stack([x, y, np.broadcast_to(high, x.shape)], axis=2)

    return way


def times(seconds: float, rate: float) -> Array:
    return np.arange(round(seconds * rate) + 1) / rate


def tables(way: Way, seconds: float = 40.0, rate: float = 4.0) -> dict[str, bytes]:
    """A table a drone, each in a colour of its own that fades."""
    at = times(seconds, rate)
    found = {}
    for i, track in enumerate(way(at)):
        rows = [
            f"{1e3 * t:.0f},{x:.3f},{y:.3f},{z:.3f},{20 * i},{round(200 * t / seconds)},0"
            for t, (x, y, z) in zip(at, track, strict=True)
        ]
        found[f"Drone {i + 1}.csv"] = "\n".join([HEAD, *rows, ""]).encode()
    return found


def csv_show(way: Way, seconds: float = 40.0, rate: float = 4.0) -> bytes:
    return zipped(tables(way, seconds, rate))


def skyc_show(way: Way, seconds: float = 40.0, **changes: object) -> bytes:
    """A show of straight segments, a fifth of a second each; changes : other settings of the first drone."""
    at = times(seconds, 5.0)
    drones = []
    for i, track in enumerate(way(at)):
        points = [[round(t, 3), p, []] for t, p in zip(at.tolist(), track.tolist(), strict=True)]
        settings: dict[str, object] = {
            "name": f"{i + 1}",
            "trajectory": {"version": 1, "points": points},
            "lights": {
                "version": 1,
                "data": b64encode(bytes([4, 0, 0, 255, 50, 8, 255, 0, 0, 50, 0])).decode(),
            },
        }
        drones.append({"type": "generic", "settings": {**settings, **(changes if i == 0 else {})}})
    # Their X is North and their Y is West, turned so that X is East.
    show = {
        "version": 1,
        "environment": {"location": {"orientation": 90.0}},
        "swarm": {"drones": drones},
    }
    return zipped({"show.json": json.dumps(show).encode()})


def planned(folder: Path, file: str, data: bytes, **changes: object) -> Compilation:
    """Plan a mission that flies a file; changes : of what MISSION is filled with."""
    (folder / file).write_bytes(data)
    filled: Mapping[str, object] = {"count": COUNT, "origin": "[0, 0, 0]", "file": file, **changes}
    text = MISSION.format(**filled)
    return compile_source(text.encode(), "again.yaml", folder, PlanOptions())
