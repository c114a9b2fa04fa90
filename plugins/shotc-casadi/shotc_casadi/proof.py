"""Checks a refined camera between its nodes: clearance, deadlines, the whole target in the frame."""

from __future__ import annotations

from shotc.plugin_api import Piecewise
from shotc.plugin_api.refiner import (
    ahead_in,
    lateness,
    rough_times,
    shortfall,
    with_camera,
)
from shotc_casadi.conditions import AimCondition
from shotc_casadi.covered import lost_on_path
from shotc_casadi.frames import cropped
from shotc_casadi.margins import Check
from shotc_casadi.place_times import place_times
from shotc_casadi.references import ShotContext

PROVED_M = 1e-6  # lack of clearance that a proof allows, metres
HOPELESS_RATIO = 1.1  # of the time asked for: a rough profile this slow cannot be saved by a bend of the path
AMPLE_SHARE = 0.8  # of the time asked for: a rough profile this fast needs no closer look


def checked(subject: ShotContext, condition: AimCondition, camera: Piecewise) -> Check:
    """Return the errors of a camera: unproved clearance, lateness, hidden and cropped targets.

    A drawn path that it leaves counts as unproved clearance.
    """
    lack = float(shortfall(subject.space, camera.ctrl[:, :, :3]).max())
    if subject.drawn is not None:
        lack = max(lack, subject.drawn.excess(camera.channels(0, 1, 2)))
    looks = condition.visibility == "silhouette"
    hidden = lost_on_path(subject, camera) if looks else 0.0
    out = cropped(subject, camera) if looks else 0.0
    return Check(lack if lack > PROVED_M else 0.0, _late(subject, camera), hidden, out)


def hopeless(subject: ShotContext) -> bool:
    """Return whether a shot's convex path is far too slow for the times asked for."""
    leg = subject.leg
    return place_times(leg).lateness(*rough_times(subject.drone, leg, leg.most)) > HOPELESS_RATIO - 1.0


def _late(subject: ShotContext, camera: Piecewise) -> float:
    """Return by which share the fastest flight of this camera misses a time asked for."""
    drone, ahead = subject.drone, ahead_in(subject.mission, subject.placed.shot)
    leg = with_camera(drone, subject.leg, camera, ahead)
    deadlines = place_times(leg)
    if not deadlines or deadlines.lateness(*rough_times(drone, leg, leg.most)) < AMPLE_SHARE - 1.0:
        return 0.0
    return lateness(drone, leg)
