"""NAME.tum: the camera's poses in the format of the TUM RGB-D benchmark, which evo and SLAM tools read.

The rows are ``timestamp tx ty tz qx qy qz qw`` with single spaces: the camera's position in W, and the
rotation to W from its own frame (x right, y down, z forward). evo's reader accepts no other white space, and
lines that begin with ``#`` are comments.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from shotc.emit.attitude import optical
from shotc.emit.base import Artifact, Emission
from shotc.emit.cameras import ticks, without_fleets
from shotc.ir.path import CAM_PITCH, CAM_YAW
from shotc.ir.trajectory import DroneTrajectory, VerifiedIR

HEAD = "# timestamp tx ty tz qx qy qz qw: seconds; metres East, North, Up; camera x right, y down, z forward"
ROW = "%.9g" + " %.6f" * 3 + " %.9f" * 4


@dataclass(frozen=True, slots=True)
class Tum:
    """Writes one file for each drone, with its whole flight at the ticks of the output clock."""

    name: ClassVar[str] = "tum"
    summary: ClassVar[str] = "NAME.tum: the camera's poses for evo and SLAM tools"
    api: ClassVar[int] = 1

    def emit(self, plan: VerifiedIR) -> Emission:
        """Return ``<drone>.tum`` for each drone."""
        files = [Artifact(f"{d.drone}.tum", _poses(plan, d)) for d in plan.trajectory.drones]
        return Emission(tuple(files), notes=without_fleets(plan, "tum"))


EMITTER = Tum()


def _poses(plan: VerifiedIR, drone: DroneTrajectory) -> bytes:
    at = ticks(plan, drone)
    turns = optical(at.pose[:, CAM_YAW], at.pose[:, CAM_PITCH])
    rows = np.column_stack([at.times, at.pose[:, :3], turns]) + 0.0  # no negative zeros
    return "\n".join([HEAD, *(ROW % tuple(row) for row in rows.tolist()), ""]).encode()
