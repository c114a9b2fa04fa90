"""Sharpness of subjects: depth of field and motion blur, sampled, where the mission gives the exposure.

These claims are soft: they give warnings and never refuse a plan.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import ceil, floor, inf, isfinite

import numpy as np

from shotc.diag.model import Diagnostic
from shotc.geom.bernstein import Array
from shotc.ir.allow import BLURRED, SOFT
from shotc.ir.drone import Optics
from shotc.ir.mission import MissionIR
from shotc.ir.sharpness import sharpness
from shotc.ir.trajectory import Claim, TrajectoryIR
from shotc.passes.verify.claims import JudgedFlight, Limit, WorstValue, claim
from shotc.passes.verify.framing import Filmed, FramingSamples
from shotc.rounding import at_least, exposure, plain
from shotc.spec.exposure import LEAST_S, MOST_F

DISC, MOTION, BACKGROUND = " blur disc", " motion blur", " background blur"
"""Endings of claims: the largest disc of a target's points, and the longest blur of the target and
behind it.
"""

MOTION_SHARE = 1 / 384
"""Share of the picture's width that a subject may move during the exposure: 10 pixels of 3840."""

F_NUMBERS = (1.4, 2, 2.8, 4, 5.6, 8, 11, 16, 22, 32, 45, 64)


def most_motion(optics: Optics) -> float:
    """Return how far a subject may move during the exposure, pixels."""
    return MOTION_SHARE * optics.pixels


def sharp(flight: JudgedFlight, shot: Filmed) -> Iterator[Claim]:
    """Yield claims on the sharpness of a shot's targets, where the mission gives the exposure."""
    optics = flight.drone.optics
    if optics is None:
        return
    for view in shot.views:
        sharpness_of_view = sharpness(flight.mission, flight.track, view.shot.id, view.target, view.times)
        if optics.aperture is not None:
            path = (*flight.drone.path, "camera", "aperture")
            limit = Limit(
                f"{view.target}{DISC}", 1e3 * optics.circle, "mm", path, hard=False, shot=view.shot.id
            )
            yield _claimed(flight, view, limit, 1e3 * sharpness_of_view.disc)
        if optics.shutter is not None:
            path = (*flight.drone.path, "camera", "shutter")
            for name, most, values in (
                (MOTION, most_motion(optics), sharpness_of_view.motion),
                (BACKGROUND, inf, sharpness_of_view.background),
            ):
                limit = Limit(f"{view.target}{name}", most, "px", path, hard=False, shot=view.shot.id)
                yield _claimed(flight, view, limit, values)


def _claimed(flight: JudgedFlight, view: FramingSamples, limit: Limit, values: Array) -> Claim:
    """Return the claim on the largest of some values; an unknown value counts as infinite."""
    known = np.where(np.isnan(values), inf, values)
    k = int(np.argmax(known))
    return claim(flight, limit, WorstValue(float(known[k]), float(view.times[k]), "sampled"))


def unsharp(ir: TrajectoryIR, claims: tuple[Claim, ...]) -> Iterator[Diagnostic]:
    """Yield warnings for subjects that are out of focus or blurred by motion, unless their shot allows it."""
    mission = ir.keyframes.mission
    for each in claims:
        if each.holds:
            continue
        if each.constraint.endswith(DISC) and SOFT not in mission.shot(each.shot).allow:
            yield _soft(ir, each)
        elif each.constraint.endswith(MOTION) and BLURRED not in mission.shot(each.shot).allow:
            yield _blurred(mission, each)


def _soft(ir: TrajectoryIR, each: Claim) -> Diagnostic:
    mission, target = ir.keyframes.mission, each.constraint.removesuffix(DISC)
    drone, time = mission.drone(each.subject), each.time or 0.0
    optics = drone.optics
    assert optics is not None
    assert optics.aperture is not None
    assert each.shot is not None
    track = next(t for t in ir.drones if t.drone == each.subject)
    then = sharpness(mission, track, each.shot, target, np.array([time]))
    focus, near, far = (float(a[0]) for a in (then.focus, then.near, then.far))
    state = "behind the camera, or nothing is in focus"
    if isfinite(each.worst):
        state = f"shown as discs of up to {at_least(each.worst, 3)} mm, {each.limit:.3g} mm counts as sharp"
    reach = "infinity" if far == inf else f"{far:.1f} m"
    width = (
        f"{1e3 * optics.width:.3g} mm wide{'' if optics.sensor else ' (taken for it; `sensor` says another)'}"
    )
    return Diagnostic(
        "V061",
        f"{target} is soft in shot `{each.shot}`",
        (mission.origins.key(mission.shot(each.shot).path),),
        (
            f"worst at t = {time:.3f} s: its points are {state}",
            f"at f/{optics.aperture:g}, focused at {focus:.1f} m, it is sharp from {near:.1f} m to {reach};"
            f" the sensor is {width}",
        ),
        _stop_down(each, optics, drone.name) + f"write `allow: [{SOFT}]` in the shot",
    )


def _stop_down(each: Claim, optics: Optics, drone: str) -> str:
    """Return the aperture that makes the discs small enough; they are inversely proportional to the
    f-number.
    """
    assert optics.aperture is not None
    needed = optics.aperture * each.worst / each.limit
    stop = next((stop for stop in F_NUMBERS if stop >= needed * (1 + 1e-9)), MOST_F)
    if needed > MOST_F:
        return "film it from farther away or with a shorter lens, or "
    return f"write `camera: {{aperture: f/{stop:g}}}` of `{drone}`, or "


def _blurred(mission: MissionIR, each: Claim) -> Diagnostic:
    target, drone = each.constraint.removesuffix(MOTION), mission.drone(each.subject)
    optics = drone.optics
    assert optics is not None
    assert optics.shutter is not None
    needed = optics.shutter * each.limit / each.worst if isfinite(each.worst) else 0.0
    faster = "film it from farther away, or more slowly, or "
    if needed >= LEAST_S:
        faster = f"write `camera: {{shutter: {_time(needed)}}}` of `{drone.name}`, or "
    return Diagnostic(
        "V062",
        f"{target} is blurred by motion in shot `{each.shot}`",
        (mission.origins.key(mission.shot(each.shot).path),),
        (
            f"worst at t = {each.time or 0.0:.3f} s: it moves {at_least(each.worst, 1)} px of {optics.pixels}"
            f" while the shutter is open for {exposure(optics.shutter)}",
            f"up to {plain(each.limit)} px cause no warning",
        ),
        f"{faster}write `allow: [{BLURRED}]` in the shot",
    )


def _time(seconds: float) -> str:
    """Return a round exposure time, not longer than the given one."""
    rate = 1.0 / seconds
    step = 10.0 ** max(floor(np.log10(rate)) - 1, 0)
    return f"1/{ceil(rate / step - 1e-9) * step:.0f} s"
