"""Framings of one to three subjects, each asked for as a camera that was drawn shows it."""

from __future__ import annotations

from itertools import pairwise
from math import ceil, degrees, hypot
from typing import Any

import numpy as np

from tests.support.generated.cameras import Camera
from tests.support.generated.dice import Dice
from tests.support.generated.moving import rates_bearable
from tests.support.generated.optics import FARTHEST, PITCH_ROOM, aim, reach, rims, screen
from tests.support.generated.subjects import Subject
from tests.support.generated.takes import CENTRE, TARGET_ROOM, Array, Rules, Take, bearing

ROOM = 0.8  # of half the frame that the subjects reach at most, in the picture that is asked for
FRAME_STEP = 0.05  # half frames to which places on screen are rounded
BEYOND = (1.0, 2.0)  # times the distance at which all subjects fit


def take(
    dice: Dice,
    camera: Camera,
    rules: Rules,
    subjects: tuple[Subject, ...],
    when: tuple[float, float],
    name: str,
    *,
    timed: bool,
) -> Take | None:
    """Draw a framing of subjects that stand, or go along together; None where no camera drawn shows them.

    when : start and duration, s; timed : whether the start is written
    """
    start, lasts = when
    middle = np.array([s.at(start + lasts / 2) for s in subjects])
    away = _witness(dice, camera, rules, subjects, middle)
    if away is None:
        return None
    times = np.linspace(start, start + lasts, 25)
    places = subjects[0].at(times) + (away - middle[0])
    if not rates_bearable(camera, times, places):
        return None
    look = aim(middle.mean(axis=0) - away, CENTRE, camera.hfov, camera.aspect)
    assert look is not None
    asked = _asked(dice, camera, subjects, middle - away, look)
    timing: dict[str, Any] = {"start": start, "duration": lasts} if timed else {"duration": lasts}
    wanted = {"id": name, "kind": "framing", "drone": camera.name, "subjects": asked, "timing": timing}
    if dice.chance(0.25):
        wanted["require"] = {"in_frame": "100 %"}
    moves = any(s.moves for s in subjects)
    return Take(
        name,
        camera.name,
        tuple(s.name for s in subjects),
        wanted,
        places if moves else places[:1],
        times if timed else None,
        lasts,
    )


def _witness(
    dice: Dice, camera: Camera, rules: Rules, subjects: tuple[Subject, ...], middle: Array
) -> Array | None:
    """Return the place of a camera that shows all subjects, side by side, when it looks at their middle."""
    centre, floor = middle.mean(axis=0), rules.floor(camera)
    tall = max(s.height for s in subjects)
    z = max(floor, dice.between(0.5, 1.0) * tall if dice.chance(0.5) else tall + dice.between(0.0, 5.0))
    azimuth = dice.whole(0, 359)
    low, high = max(s.radius for s in subjects) + 1.0, FARTHEST

    def at(distance: float) -> Array:
        return np.round(np.array([*centre[:2], 0.0]) + distance * bearing(azimuth) + [0, 0, z], 2)

    if not _whole(camera, subjects, middle - at(high)):
        return None
    for _ in range(20):
        half = (low * high) ** 0.5
        low, high = (low, half) if _whole(camera, subjects, middle - at(half)) else (half, high)
    place = at(min(FARTHEST, high * dice.scaled(*BEYOND)))
    offsets = middle - place
    clear = all(
        hypot(*o[:2]) > s.radius + rules.target + camera.radius + TARGET_ROOM
        for s, o in zip(subjects, offsets, strict=True)
    )
    fine = clear and _whole(camera, subjects, offsets) and _side_by_side(camera, subjects, offsets)
    return place if fine else None


def _whole(camera: Camera, subjects: tuple[Subject, ...], offsets: Array) -> bool:
    look = aim(offsets.mean(axis=0), CENTRE, camera.hfov, camera.aspect)
    if look is None or not camera.pitch[0] + PITCH_ROOM <= look[1] <= camera.pitch[1] - PITCH_ROOM:
        return False
    return all(
        reach(s, o, look, camera.hfov, camera.aspect) <= ROOM for s, o in zip(subjects, offsets, strict=True)
    )


def _side_by_side(camera: Camera, subjects: tuple[Subject, ...], offsets: Array) -> bool:
    """Tell whether no two subjects overlap on screen from left to right."""
    look = aim(offsets.mean(axis=0), CENTRE, camera.hfov, camera.aspect)
    assert look is not None
    spans = []
    for s, o in zip(subjects, offsets, strict=True):
        u = screen(rims(s, o), look, camera.hfov, camera.aspect)[:, 0]
        spans.append((u.min(), u.max()))
    spans.sort()
    return all(a[1] < b[0] - 0.02 for a, b in pairwise(spans))


def _asked(
    dice: Dice, camera: Camera, subjects: tuple[Subject, ...], offsets: Array, look: tuple[float, float]
) -> list[dict[str, Any]]:
    """Return what is asked of every subject, as that camera shows it: some of it, as much as can be had."""
    rows: list[dict[str, Any]] = []
    for i, (subject, offset) in enumerate(zip(subjects, offsets, strict=True)):
        row: dict[str, Any] = {"target": subject.name}
        seen = screen(rims(subject, offset), look, camera.hfov, camera.aspect)
        u, v = screen(offset[None], look, camera.hfov, camera.aspect)[0, :2]
        if i < 2 or dice.chance(0.5):
            row["frame"] = [round(FRAME_STEP * round(float(c) / FRAME_STEP), 2) for c in (u, v)]
        if i == 0 and dice.chance(0.7):
            row["size"] = round(0.5 * float(np.ptp(seen[:, 1])), 2)
        if i == 0 and dice.chance(0.5):
            azimuth = degrees(np.arctan2(-offset[0], -offset[1])) % 360
            row["view"] = {"azimuth": f"{azimuth:.0f} deg"}
            if len(subjects) == 1 and dice.chance(0.5):
                elevation = degrees(np.arctan2(-offset[2], hypot(*offset[:2])))
                row["view"]["elevation"] = f"{ceil(elevation)} deg"
        rows.append(row)
    if any(row.get("size") == 0 for row in rows):
        rows[0].pop("size")
    return rows
