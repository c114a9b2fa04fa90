"""Write NAME.chan: the camera for Nuke, one line per frame: ``frame tx ty tz rx ry rz vfov``.

Y is up, so W's East, North, Up are x, -z, y. Rotations are degrees, applied in the order Z, X, Y. vfov is the
vertical field of view, degrees. A frame is a tick of the output clock; the first has number 1.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from shotc.plugin_api import CAM_PITCH, CAM_YAW, HFOV, Artifact, DroneTrajectory, Emission, VerifiedIR

LINE = "%d" + " %.6f" * 3 + " %.7f" * 4 + "\n"


@dataclass(frozen=True, slots=True)
class NukeCamera:
    """Writes one camera per drone."""

    name: ClassVar[str] = "chan"
    summary: ClassVar[str] = "NAME.chan: the camera for Nuke"
    api: ClassVar[int] = 1

    def emit(self, plan: VerifiedIR) -> Emission:
        """Return ``<drone>.chan`` for each drone."""
        mission = plan.trajectory.keyframes.mission
        files = [
            Artifact(f"{drone.drone}.chan", camera(drone, mission.rate, mission.drone(drone.drone).aspect))
            for drone in plan.trajectory.drones
        ]
        notes = (
            [f"chan: {mission.rate:g} frames a second, set it in Nuke's project settings"] if files else []
        )
        if plan.trajectory.fleets:
            notes.append("chan: fleets have no cameras and are left out")
        return Emission(tuple(files), notes=tuple(notes))


EMITTER = NukeCamera()


def camera(drone: DroneTrajectory, rate: float, aspect: float) -> bytes:
    """Return the bytes of one drone's camera. ``rate``: frames per second; ``aspect``: width over height."""
    frames = np.arange(round(drone.curve.end * rate) + 1)
    state = drone.curve(frames / rate)
    east, north, up = state[:, :3].T
    vfov = 2.0 * np.arctan(np.tan(state[:, HFOV] / 2.0) / aspect)
    angles = np.degrees([state[:, CAM_PITCH], state[:, CAM_YAW] - np.pi / 2.0, 0.0 * vfov, vfov])
    rows = np.column_stack([frames + 1, east, up, -north, *angles])
    return "".join(LINE % tuple(row) for row in rows.tolist()).encode()
