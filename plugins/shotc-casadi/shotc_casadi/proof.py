"""Whether a refined camera holds between its nodes: clear of everything, in time, the target whole."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from shotc.plugin_api import Piecewise
from shotc.refiner_api import (
    Array,
    View,
    frustum_margins,
    lateness,
    rough_times,
    shortfall,
    subdivide,
    with_camera,
)
from shotc_casadi.conditions import Condition
from shotc_casadi.due import due
from shotc_casadi.problem import Margins
from shotc_casadi.wishes import Subject, fields_of_view, wishes

SAMPLES = 6  # a piece
PROVED = 1e-6  # metres that a proof may lack
ROOM_STEP = 0.02  # metres added to what was missing
FRAME_STEP = 1.5  # times what was missing
LIMIT_STEP = 1.2  # times what was missing
LITTLE = 0.02  # share of the room beyond the clearances that is kept where the picture needs the rest
HOLD = 1e3
GAIN = 0.9  # of what was open before; a round that leaves more has helped nothing
HOPELESS = 1.1  # times what is asked that a rough profile takes for no bend of the path to make up for it
AMPLE = 0.8  # share of what is asked that a rough profile may take for it to be met without a closer look


class Check(NamedTuple):
    """What is left open, the worst first.

    lack : metres by which clearance is not proved for all s (Bernstein hulls); 0 is proved
    late : share of a time asked for by which the fastest flight is too slow
    cropped : the most that the target sticks out of the frame, as a share of its distance
    """

    lack: float
    late: float
    cropped: float

    @property
    def holds(self) -> bool:
        """Whether nothing is left open."""
        return max(self) <= 0.0

    def helped(self, before: Check) -> bool:
        """Tell whether anything that was open has become notably better."""
        return any(now < GAIN * then for now, then in zip(self, before, strict=True))


def checked(subject: Subject, condition: Condition, camera: Piecewise) -> Check:
    """Prove a camera's clearances, time it, and look at its frame between the nodes."""
    lack = float(shortfall(subject.room, camera.ctrl[:, :, :3]).max())
    cropped = _cropped(subject, condition, camera) if condition.visibility == "silhouette" else 0.0
    return Check(max(lack, 0.0), _late(subject, camera), cropped)


def tighter(margins: Margins, check: Check, *, hold: bool) -> Margins:
    """Return margins that make up for what a check found; hold : keep to the convex path."""
    return Margins(
        frame=max(0.5, margins.frame - FRAME_STEP * check.cropped),
        room=margins.room + (check.lack + ROOM_STEP if check.lack > 0 else 0.0),
        limits=margins.limits / (1.0 + LIMIT_STEP * check.late),
        comfort=LITTLE if check.cropped > 0 else margins.comfort,
        hold=HOLD if hold and check.lack > 0 else margins.hold,
    )


def hopeless(subject: Subject) -> bool:
    """Tell whether a shot's convex path is far from meeting the times asked for."""
    leg = subject.leg
    return due(leg).lateness(*rough_times(subject.drone, leg, 1.0)) > HOPELESS - 1.0


def _late(subject: Subject, camera: Piecewise) -> float:
    """Return by which share of a time asked for the fastest flight of this camera misses it."""
    drone, leg = subject.drone, with_camera(subject.drone, subject.leg, camera)
    asked = due(leg)
    if not asked or asked.lateness(*rough_times(drone, leg, 1.0)) < AMPLE - 1.0:
        return 0.0
    return lateness(drone, leg)


def _cropped(subject: Subject, condition: Condition, camera: Piecewise) -> float:
    s: Array = subdivide(camera.breaks, SAMPLES)
    wanted = wishes(subject, condition, s)
    q = camera(s)
    offset = (wanted.centre - q[:, :3]).T
    wide, tall = fields_of_view(subject, s)
    view = View(np.cos(q[:, 3]), np.sin(q[:, 3]), np.cos(q[:, 4]), np.sin(q[:, 4]), wide, tall)
    inside = frustum_margins(view, (offset[0], offset[1], offset[2]), wanted.radius, wanted.height)
    gap = np.min(inside, axis=0) / np.maximum(np.linalg.norm(offset, axis=0), 1e-9)
    return float(max(0.0, -(gap[wanted.whole > 0]).min(initial=0.0)))
