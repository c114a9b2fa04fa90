"""Whether a refined camera holds between its nodes: clear of everything, in time, the target whole."""

from __future__ import annotations

from shotc.plugin_api import Piecewise
from shotc.plugin_api.refiner import (
    ahead_in,
    lateness,
    rough_times,
    shortfall,
    with_camera,
)
from shotc_casadi.conditions import Condition
from shotc_casadi.covered import lost_on_path
from shotc_casadi.due import due
from shotc_casadi.frames import cropped
from shotc_casadi.margins import Check
from shotc_casadi.references import Subject

PROVED_M = 1e-6  # metres that a proof may lack
HOPELESS_RATIO = 1.1  # of what is asked: no bend of the path makes up for a rough profile that takes so long
AMPLE_SHARE = 0.8  # of what is asked: a rough profile that takes no longer needs no closer look


def checked(subject: Subject, condition: Condition, camera: Piecewise) -> Check:
    """Prove a camera's clearances, time it, and look at its frame between the nodes."""
    lack = float(shortfall(subject.space, camera.ctrl[:, :, :3]).max())
    looks = condition.visibility == "silhouette"
    hidden = lost_on_path(subject, camera) if looks else 0.0
    out = cropped(subject, camera) if looks else 0.0
    return Check(max(lack, 0.0), _late(subject, camera), hidden, out)


def hopeless(subject: Subject) -> bool:
    """Tell whether a shot's convex path is far from meeting the times asked for."""
    leg = subject.leg
    return due(leg).lateness(*rough_times(subject.drone, leg, 1.0)) > HOPELESS_RATIO - 1.0


def _late(subject: Subject, camera: Piecewise) -> float:
    """Return by which share of a time asked for the fastest flight of this camera misses it."""
    drone, ahead = subject.drone, ahead_in(subject.mission, subject.placed.shot)
    leg = with_camera(drone, subject.leg, camera, ahead)
    asked = due(leg)
    if not asked or asked.lateness(*rough_times(drone, leg, 1.0)) < AMPLE_SHARE - 1.0:
        return 0.0
    return lateness(drone, leg)
