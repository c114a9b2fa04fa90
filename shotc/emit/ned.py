"""NAME-ned.csv: setpoints along North, East and Down for scripts that fly a PX4 or an ArduPilot offboard.

The columns are the fields of SET_POSITION_TARGET_LOCAL_NED (mavlink.io, message 84) with position, velocity,
acceleration and yaw, and the angles of GIMBAL_MANAGER_SET_PITCHYAW (message 287).
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi
from typing import ClassVar

import numpy as np

from shotc.emit.base import Artifact, Emission
from shotc.emit.cameras import ticks, turned, without_fleets
from shotc.emit.table_numbers import NUMBER
from shotc.geom.vec import wrapped
from shotc.ir.path import BODY_YAW, CAM_PITCH, CAM_YAW
from shotc.ir.sampling import phase_index
from shotc.ir.trajectory import DroneTrajectory, VerifiedIR

SETPOINTS = (
    "t_s,north_m,east_m,down_m,vn_m_s,ve_m_s,vd_m_s,an_m_s2,ae_m_s2,ad_m_s2,"
    "yaw_ned_rad,yaw_rate_ned_rad_s,gimbal_pitch_rad,gimbal_yaw_ned_rad,phase,shot"
)
LEAST_HZ = 2.0
"""Setpoints a second, below which a PX4 leaves its offboard mode (docs.px4.io, flight_modes/offboard)."""


@dataclass(frozen=True, slots=True)
class Ned:
    """Writes one table for each drone, relative to its pad, at the ticks of the output clock."""

    name: ClassVar[str] = "ned"
    summary: ClassVar[str] = "NAME-ned.csv: setpoints North, East, Down from the pad, for offboard scripts"
    api: ClassVar[int] = 1

    def emit(self, plan: VerifiedIR) -> Emission:
        """Return ``<drone>-ned.csv`` for each drone."""
        mission = plan.trajectory.keyframes.mission
        files, notes = [], [*without_fleets(plan, "ned")]
        for drone in plan.trajectory.drones:
            home = mission.drone(drone.drone).home
            files.append(Artifact(f"{drone.drone}-ned.csv", _setpoints(plan, drone, np.array(home))))
            where = ", ".join(f"{value:g}" for value in home)
            notes.append(f"ned {drone.drone}-ned.csv: counted from the pad, which is [{where}] in the plan")
        if mission.rate <= LEAST_HZ and files:
            slow = f"ned: {mission.rate:g} setpoints a second; PX4 asks for more than 2, give `output.rate`"
            notes.append(slow)
        return Emission(tuple(files), notes=tuple(notes))


EMITTER = Ned()


def _setpoints(plan: VerifiedIR, drone: DroneTrajectory, home: np.ndarray) -> bytes:
    at = ticks(plan, drone)
    yaw, gimbal = (wrapped(pi / 2 - at.pose[:, channel]) for channel in (BODY_YAW, CAM_YAW))
    columns = [
        at.times,
        turned(at.pose[:, :3] - home),
        turned(at.rate),
        turned(at.acceleration),
        yaw,
        -at.rate[:, BODY_YAW],
        at.pose[:, CAM_PITCH],
        gimbal,
    ]
    numbers = np.column_stack(columns) + 0.0  # no negative zeros
    names = [f"{phase.name},{phase.shot or ''}" for phase in drone.phases]
    line = ",".join([NUMBER] * numbers.shape[1]) + ",%s"
    index = phase_index(drone.phases, at.times).tolist()
    rows = (line % (*row, names[k]) for row, k in zip(numbers.tolist(), index, strict=True))
    return "\n".join([SETPOINTS, *rows, ""]).encode()
