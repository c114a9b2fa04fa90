"""Framings of the user that no camera can have; checked before composition."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from math import acos, degrees, dist, hypot, pi, tan

from shotc.diag.model import Diagnostic
from shotc.geom.camera import heading_of, view
from shotc.geom.vec import Vec2
from shotc.ir.begins import first_start
from shotc.ir.drone import Drone
from shotc.ir.keyed import is_keyed
from shotc.ir.mission import Keyframe, MissionIR, Shot
from shotc.ir.origin import KeyPath
from shotc.passes.labels import framing_label
from shotc.planning.framing.candidates import FixedCamera
from shotc.planning.framing.moments import is_sure, moments
from shotc.planning.framing.placing import explicit_aim, setting_of
from shotc.rounding import at_least, at_most, down, up

SAME_PLACE_M = 1e-3  # metres within which a point is the camera's own place


def check_framing(mission: MissionIR, misplaced: Collection[KeyPath] = ()) -> list[Diagnostic]:
    """Return the faults of every keyframe with camera angles, one per keyframe.

    misplaced : key paths of keyframes with an invalid place, which are skipped
    """
    faults: list[Diagnostic] = []
    reported: set[tuple[object, ...]] = set()
    for shot in mission.shots:
        for keyframe, then in _moments(mission, shot):
            fault = None if keyframe.path in misplaced else _fault(then, shot, keyframe)
            # The keyframes of a file or of a generated path share a line, which gets one report.
            if fault is not None and (keyframe.path, fault.code) not in reported:
                reported.add((keyframe.path, fault.code))
                faults.append(fault)
    return faults


def _moments(mission: MissionIR, shot: Shot) -> Iterator[tuple[Keyframe, MissionIR]]:
    """Yield the keyframes of a shot with a known picture, and the mission at their time."""
    if not is_keyed(shot):
        yield from ((keyframe, mission) for keyframe in shot.keyframes)
        return
    for keyframe, then in zip(
        shot.keyframes, moments(mission, shot, first_start(mission, shot)), strict=True
    ):
        if is_sure(mission, shot, keyframe):
            yield keyframe, then


def _fault(mission: MissionIR, shot: Shot, keyframe: Keyframe) -> Diagnostic | None:
    if keyframe.aim is None:
        return None
    if len(keyframe.aim) == 3 and dist(keyframe.at, keyframe.aim) < SAME_PLACE_M:
        label = mission.origins.value((*keyframe.path, "look_at"))
        return Diagnostic("G014", "the camera looks at its own place", (label,), help="look at another point")
    aim = explicit_aim(keyframe.at, keyframe.aim, pi / 2)
    drone = mission.drone(shot.drone)
    if (len(keyframe.aim) == 2 or keyframe.target is None) and not drone.gimbal.reaches(aim[1]):
        key = "pitch" if len(keyframe.aim) == 2 else "look_at"
        shown = keyframe.target is None or _unseen(mission, drone, keyframe, aim) is None
        return beyond_gimbal(mission, drone, (*keyframe.path, key), aim[1], shown=shown)
    return None if keyframe.target is None else _unseen(mission, drone, keyframe, aim)


def beyond_gimbal(
    mission: MissionIR, drone: Drone, path: KeyPath, pitch: float, *, shown: bool = True
) -> Diagnostic:
    """Return the fault of a pitch out of the gimbal's range.

    path  : its key path
    shown : whether a camera that pitches so far shows what it films
    """
    low, high = (degrees(p) for p in drone.gimbal.pitch)
    required = degrees(pitch)
    labels = (
        mission.origins.value(path),
        mission.origins.value((*drone.path, "gimbal", "pitch"), "the gimbal's range"),
    )
    return Diagnostic(
        "G013",
        f"the gimbal cannot pitch to {required:.1f} deg",
        labels,
        (f"the gimbal of `{drone.name}` reaches {low:.1f} to {high:.1f} deg",),
        f"pitch the camera to {max(low, min(high, required)):.1f} deg"
        + (f", or take a gimbal of {_range_to(low, high, required)} for `{drone.name}`" if shown else ""),
    )


def _range_to(low: float, high: float, required: float) -> str:
    """Return a gimbal's range in degrees that has a pitch in it, as it is written."""
    return f"`gimbal: {{pitch: [{min(low, down(required, 1)):g} deg, {max(high, up(required, 1)):g} deg]}}`"


def _unseen(mission: MissionIR, drone: Drone, keyframe: Keyframe, aim: Vec2) -> Diagnostic | None:
    """Return the fault of a target that the user's framing does not show at all, or None."""
    setting = setting_of(mission, drone, keyframe, aim[0])
    off = degrees(_angle_off(setting, aim))
    if off < 90.0 and setting.shows(aim):
        return None
    straight = setting.aim((0.0, 0.0)) or aim
    right = f"heading: {degrees(heading_of(straight[0])):.0f} deg, pitch: {degrees(straight[1]):.0f} deg"
    remedy = f"write `look_at: {keyframe.target}`, or `{right}`"
    if not keyframe.placed:
        remedy = _less_drift(setting, keyframe)
    label = (framing_label(mission, keyframe),)
    if off >= 90.0:
        note = f"it is {off:.0f} deg away from where the camera looks"
        return Diagnostic("G008", f"target `{keyframe.target}` is behind the camera", label, (note,), remedy)
    note = (
        f"it is {off:.0f} deg away from the middle of a frame {degrees(setting.hfov):.0f} deg wide; "
        "no part of it is in the picture"
    )
    return Diagnostic("G009", f"target `{keyframe.target}` is out of the frame", label, (note,), remedy)


def _less_drift(setting: FixedCamera, keyframe: Keyframe) -> str:
    """Return how far a camera that looks straight down may drift, and from what height, as a remedy."""
    below, level = -setting.offset[2], hypot(*setting.offset[:2])
    half = tan(setting.hfov / 2) / setting.aspect
    if below <= 0:
        return "drift less far, or fly higher"
    high = keyframe.at[2] + level / half - below
    return f"drift {at_most(below * half)} m or less in all, or write `altitude: {at_least(high, 1)}` or more"


def _angle_off(setting: FixedCamera, aim: Vec2) -> float:
    forward = view(aim[0], aim[1], setting.hfov, setting.aspect).to_camera(setting.offset)[2]
    return acos(max(-1.0, min(1.0, forward / max(hypot(*setting.offset), 1e-12))))
