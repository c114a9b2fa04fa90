"""Whether a refined camera holds between its nodes: clear of everything, the target whole."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.bspline import subdivide
from shotc.geom.camera import View, frustum_margins
from shotc.geom.corridor import shortfall
from shotc_casadi.conditions import Condition
from shotc_casadi.problem import Margins
from shotc_casadi.wishes import Subject, fields_of_view, wishes

SAMPLES = 6  # a piece
ROOM_STEP = 0.02  # metres added to what was missing
FRAME_STEP = 1.5  # times what was missing
HOLD = 1e3
GAIN = 0.9  # of what was cropped before; a round that leaves more has helped nothing


class Check(NamedTuple):
    """What is left open.

    lack : metres by which clearance is not proved for all s (Bernstein hulls); 0 is proved
    cropped : the most that the target sticks out of the frame, as a share of its distance
    """

    lack: float
    cropped: float

    @property
    def holds(self) -> bool:
        """Whether nothing is left open."""
        return self.lack <= 0.0 and self.cropped <= 0.0


def checked(subject: Subject, condition: Condition, camera: Piecewise) -> Check:
    """Prove a camera's clearances and look at its frame between the nodes."""
    lack = float(shortfall(subject.room, camera.ctrl[:, :, :3]).max())
    cropped = _cropped(subject, condition, camera) if condition.visibility == "silhouette" else 0.0
    return Check(max(lack, 0.0), cropped)


def tighter(margins: Margins, check: Check, *, hold: bool) -> Margins:
    """Return margins that make up for what a check found; hold : keep to the convex path."""
    return Margins(
        frame=max(0.5, margins.frame - FRAME_STEP * check.cropped),
        room=margins.room + (check.lack + ROOM_STEP if check.lack > 0 else 0.0),
        hold=HOLD if hold and check.lack > 0 else margins.hold,
    )


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
