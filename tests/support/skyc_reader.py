"""A reader of show files, written from what their format says: the test's own, not the emitter's."""

from __future__ import annotations

import itertools
import json
from base64 import b64decode
from collections.abc import Callable, Iterator
from copy import deepcopy
from io import BytesIO
from math import isfinite
from typing import Any
from zipfile import ZipFile

import numpy as np

Content = dict[str, Any]

BLACK = (0.0, 0.0, 0.0)
MOST = 5000
"""Drones that Skybrush loads from one file."""


def read(archive: bytes) -> Content:
    """Return what a show file holds, which breaks no rule of Skybrush's loader."""
    with ZipFile(BytesIO(archive)) as zipped:
        assert zipped.testzip() is None
        content = dict(json.loads(zipped.read("show.json")))
    assert list(faults(content)) == []
    return content


def archived(content: Content) -> bytes:
    stream = BytesIO()
    with ZipFile(stream, "w") as zipped:
        zipped.writestr("show.json", json.dumps(content))
    return stream.getvalue()


def faults(content: Content) -> Iterator[str]:
    """Yield what Skybrush's loader and its players refuse in a show."""
    if content.get("version") != 1:
        yield "version"
    drones = content.get("swarm", {}).get("drones", [])
    if not 0 < len(drones) <= MOST:
        yield "number of drones"
    for drone in drones[:MOST]:
        settings = drone.get("settings", {})
        yield from _of_flight(settings.get("trajectory") or {})
        yield from _of_lights(settings.get("lights", {}))
        if "yawControl" in settings:
            yield from _of_yaw(settings["yawControl"])
    environment = content.get("environment", {})
    if environment.get("type", "outdoor") not in ("outdoor", "indoor"):
        yield "environment"
    for camera in environment.get("cameras", []):
        if not isinstance(camera.get("type", ""), str):
            yield "type of a camera"
        for name, count in (("position", 3), ("orientation", 4)):
            if name in camera and not _numbers(camera[name], count):
                yield f"{name} of a camera"


def _of_flight(trajectory: Content) -> Iterator[str]:
    if trajectory.get("version") != 1:
        yield "version of a trajectory"
    for name in ("takeoffTime", "landingTime"):
        if not _numbers([trajectory.get(name, 0.0)], 1):
            yield name
    points = trajectory.get("points", [])
    if not points:
        yield "no key points"
    for time, place, control in points:
        if not _numbers([time, *place], 4) or not all(_numbers(point, 3) for point in control):
            yield "a key point"
        if len(control) > 2:
            yield "a curve of more than the third degree"


def _of_lights(lights: Content) -> Iterator[str]:
    if lights.get("version") != 1 or not isinstance(lights.get("data"), str):
        yield "lights"
    else:
        try:
            color_at(b64decode(lights["data"]) + bytes([0]), 1e9)
        except (ValueError, IndexError):
            yield "light program"


def _of_yaw(yaw: Content) -> Iterator[str]:
    if yaw.get("version") != 1 or not isinstance(yaw.get("setpoints"), list):
        yield "yaw"


def _numbers(values: list[Any], count: int) -> bool:
    return len(values) >= count and all(isinstance(v, int | float) and isfinite(v) for v in values)


def _first(content: Content) -> Content:
    return dict(content["swarm"]["drones"][0]["settings"])


DAMAGE: dict[str, Callable[[Content], object]] = {
    "no version": lambda show: show.pop("version"),
    "version 2": lambda show: show.update(version=2),
    "no drones": lambda show: show.update(swarm={"drones": []}),
    "too many drones": lambda show: show.update(swarm={"drones": show["swarm"]["drones"][:1] * (MOST + 1)}),
    "no trajectory": lambda show: show["swarm"]["drones"][0]["settings"].pop("trajectory"),
    "packed trajectory": lambda show: _first(show)["trajectory"].update(version=2),
    "no key points": lambda show: _first(show)["trajectory"].update(points=[]),
    "start that is a text": lambda show: _first(show)["trajectory"].update(takeoffTime="3 s"),
    "end that is a text": lambda show: _first(show)["trajectory"].update(landingTime="3 s"),
    "curves of the fourth degree": lambda show: [
        point.__setitem__(2, [[0, 0, 0]] * 3) for point in _first(show)["trajectory"]["points"]
    ],
    "lights of another version": lambda show: _first(show)["lights"].update(version=2),
    "lights that are no program": lambda show: _first(show)["lights"].update(data="/////w=="),
    "lights that end in a number": lambda show: _first(show)["lights"].update(data="BP8AAIA="),
    "yaw without setpoints": lambda show: show["swarm"]["drones"][0]["settings"].update(
        yawControl={"version": 1}
    ),
    "environment under water": lambda show: show["environment"].update(type="underwater"),
    "camera of a number": lambda show: show["environment"]["cameras"][0].update(type=3),
    "camera on a plane": lambda show: show["environment"]["cameras"][0].update(position=[0, 0]),
    "camera without a turn": lambda show: show["environment"]["cameras"][0].update(
        orientation=[1, 0, None, 0]
    ),
}
"""What makes Skybrush's loader, or one of its players, refuse a show of one drone or more and a camera."""


def damaged(content: Content, name: str) -> Content:
    """Return a show with one thing wrong."""
    spoilt = deepcopy(content)
    DAMAGE[name](spoilt)
    return spoilt


def place_at(trajectory: dict[str, Any], time: float) -> np.ndarray:
    """Return where a drone is at a time; it stands before the first key point and after the last."""
    t = time - trajectory.get("takeoffTime", 0.0)
    points = trajectory["points"]
    if t <= points[0][0]:
        return np.array(points[0][1])
    for (t0, first, _), (t1, last, control) in itertools.pairwise(points):
        if t <= t1:
            return de_casteljau([first, *control, last], (t - t0) / (t1 - t0))
    return np.array(points[-1][1])


def de_casteljau(points: list[list[float]], share: float) -> np.ndarray:
    level = np.array(points)
    while len(level) > 1:
        level = level[:-1] + share * (level[1:] - level[:-1])
    return np.asarray(level[0])


def color_at(code: bytes, time: float) -> tuple[float, float, float]:
    """Return the colour that a light program shows at a time, 0 to 255; the last one stays."""
    at, now, color = 0, 0.0, BLACK
    while code[at] != 0:
        what, wanted = code[at], tuple(float(c) for c in code[at + 1 : at + 4])
        at, steps = varint(code, at + 4)
        span = steps * 0.02
        if what not in (4, 8):
            raise ValueError(f"order {what}")
        if time < now + span:
            share = (time - now) / span if what == 8 else 1.0
            return tuple(a + share * (b - a) for a, b in zip(color, wanted, strict=True))  # type: ignore[return-value]
        now, color = now + span, wanted  # type: ignore[assignment]
    return color


def varint(code: bytes, at: int) -> tuple[int, int]:
    value = shift = 0
    while True:
        byte = code[at]
        value |= (byte & 0x7F) << shift
        at, shift = at + 1, shift + 7
        if byte < 0x80:
            return at, value
