"""Ways between placed keyframes on the clock, led to where the shot's targets are visible.

The motion through the keyframes is found first. Where zones, terrain, scenes or buildings hide a target, the
way is led around them. The new motion is taken only if less is hidden and no more frames crop the target.
Keyframes keep their places and times.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.framing import Cameras, frames
from shotc.geom.solid_arrays.points import distances
from shotc.ir.allow import hidden_on_purpose
from shotc.ir.bodies import moved, shapes
from shotc.ir.coverage import coverage
from shotc.ir.hiding_surfaces import surfaces_before
from shotc.ir.keyed import arrivals, is_keyed, stays
from shotc.ir.mission import MissionIR
from shotc.ir.owners import target_owner
from shotc.ir.path import CAM_PITCH, CAM_YAW, HFOV
from shotc.ir.target import Target
from shotc.planning.clock.aims import aims_at
from shotc.planning.clock.moving import Moving
from shotc.planning.clock.task import ClockTask
from shotc.planning.free_space import MARGIN_M
from shotc.planning.layered import Passing, VisiblePath, VisibleSubject, led_round

STEP_S = 0.1  # seconds between samples
ABOUT_M = 1.0  # metres by which a target is enlarged, because the motion deviates from the course
LESS_SHARE = 0.9  # largest ratio of hidden shares with which a led motion is taken
CROPS_SHARE = 1e-3  # share of the frames, tolerance of the cropped ones
AIM_RAD = 2e-3  # rad, tolerance of the angles at a keyframe


class KeyframeSpan(NamedTuple):
    """The way from one keyframe to the next that films a target; mission times, seconds."""

    start: float
    end: float
    target: Target


def ways_of(task: ClockTask) -> tuple[KeyframeSpan, ...]:
    """Return the ways between keyframes that may be led, each for the target that both ends show."""
    mission, shot, start = task.mission, task.shot, task.clock.start
    hides = mission.meshes or mission.terrain or mission.opaque_zones
    if not hides or not is_keyed(shot) or shot.ideal is None or shot.ideal.placed or hidden_on_purpose(shot):
        return ()
    spans = []
    for (a, left), (b, reached) in pairwise(zip(shot.keyframes, arrivals(shot), strict=True)):
        if a.target is not None and a.target == b.target and not stays(a, b):
            spans.append(KeyframeSpan(start + left + a.hold, start + reached, mission.target(a.target)))
    return tuple(spans)


def led_to_see(task: ClockTask, spans: tuple[KeyframeSpan, ...], motion: Piecewise) -> ClockTask | None:
    """Return the task with ways led to where their targets are visible; None where no way is changed.

    motion : x, y, z over the task's clock
    """
    breaks = task.clock.breaks
    places, for_sight = motion(breaks)[:, :3], np.zeros(len(breaks))
    for span in spans:
        (inside,) = np.nonzero((breaks >= span.start - STEP_S / 2) & (breaks <= span.end + STEP_S / 2))
        if len(inside) > 2:
            course = _led(task, span.target, breaks[inside], places[inside])
            places[inside], for_sight[inside] = course.places, course.for_sight
    return replace(task, course=VisiblePath(places, for_sight)) if for_sight.any() else None


def _led(task: ClockTask, target: Target, times: Array, places: Array) -> VisiblePath:
    held = np.zeros(len(times), dtype=bool)
    held[[0, -1]] = True
    near: list[Passing] = [*(motion.what for motion in task.motions), _no_nearer(target, times, places)]
    return led_round(task.walls, near, (times, places), _watched(task.mission, target, times), held)


def _watched(mission: MissionIR, target: Target, times: Array) -> VisibleSubject:
    """Return an enlarged target at times (M,), and the standing occluders that may hide it."""
    surfaces = tuple(surface for _, surface in surfaces_before(mission, target.name))
    zones = tuple(zone.solid for zone in mission.opaque_zones)
    centres = np.array(target.centre) + moved(target, times) + np.array([0.0, 0.0, 0.5 * ABOUT_M])
    size = (target.radius + ABOUT_M, target.height + ABOUT_M)
    return VisibleSubject(centres, np.ones(len(times), dtype=bool), *size, surfaces, zones)


def _no_nearer(target: Target, times: Array, places: Array) -> Moving:
    """Return a target as an obstacle with the least distance of places (N, 3) at times (N,) as its clearance.

    A nearer camera would crop it.
    """
    least = distances(target.kept_clear, places - moved(target, times)).min()
    return Moving(target_owner(target), target.kept_clear, float(least) - MARGIN_M, partial(moved, target))


@dataclass(frozen=True, slots=True, eq=False)
class VisibleShares:
    """What a motion with its camera shows on some ways.

    hidden : mean covered share of the targets' outlines
    cropped : share of the frames that do not show the whole target
    astray : largest error of the camera angles at keyframes, rad
    """

    hidden: float
    cropped: float
    astray: float

    def better(self, than: VisibleShares) -> bool:
        """Return whether notably less is hidden, no more is cropped, and keyframes are composed as well."""
        return (
            self.hidden <= LESS_SHARE * than.hidden
            and self.cropped <= than.cropped + CROPS_SHARE
            and self.astray <= than.astray + AIM_RAD
        )


def visible_shares(task: ClockTask, spans: tuple[KeyframeSpan, ...], curve: Piecewise) -> VisibleShares:
    """Return what a camera shows on ways; curve : all channels over the task's clock."""
    mission, hidden, whole = task.mission, [np.zeros(0)], [np.ones(0, dtype=bool)]
    for span in spans:
        t = np.linspace(span.start, span.end, max(2, round((span.end - span.start) / STEP_S)))
        pose = curve(t)
        hidden.append(coverage(mission, (), span.target.name, pose[:, :3], t).share)
        still = pose[:, :3] - moved(span.target, t)
        cameras = Cameras(still, pose[:, CAM_YAW], pose[:, CAM_PITCH], pose[:, HFOV], task.drone.aspect)
        whole.append(frames(cameras, span.target.centre, shapes(span.target, t)).in_frame)
    at = np.array([bound.start for bound in task.bound])
    pose = curve(at)
    off = pose[:, [CAM_YAW, CAM_PITCH]] - aims_at(task.camera_task, at, pose[:, :3])
    off[:, 0] = np.arctan2(np.sin(off[:, 0]), np.cos(off[:, 0])) * np.cos(pose[:, CAM_PITCH])
    cropped = 1.0 - np.concatenate(whole).mean()
    return VisibleShares(
        float(np.concatenate(hidden).mean()), float(cropped), float(np.abs(off).max(initial=0.0))
    )
