"""Short flights made by hand, for tests of the MAVLink emitter; within no particular limits."""

from __future__ import annotations

import numpy as np

from shotc.geom.bernstein import concatenate, quintic_hermite
from shotc.ir.mission import MissionIR
from shotc.ir.phases import Phase, Reference
from shotc.ir.trajectory import DroneTrajectory, VerifiedIR
from tests.support.film_plans import orbit_mission, orbit_plan
from tests.support.records import replace

Pose = tuple[float, float, float, float, float]  # x, y, z, yaw of camera and body, pitch
Move = tuple[str, str | None, float, Pose]  # phase, shot, seconds, pose at its end


def flight(moves: list[Move], *, pad: Pose, camera_off: float = 0.0, steady: bool = False) -> DroneTrajectory:
    """Fly rest to rest from pose to pose; a move that ends where it began is a hold.

    camera_off : camera yaw less body yaw, rad; steady : constant speed on every move instead
    """

    def channels(pose: Pose) -> np.ndarray:
        x, y, z, yaw, pitch = pose
        return np.array([x, y, z, yaw + camera_off, pitch, yaw, np.radians(70)])

    pieces, phases, now, last = [], [], 0.0, pad
    for name, shot, seconds, pose in moves:
        ends = np.stack([channels(last), channels(pose)])
        rate = np.zeros_like(ends)
        if steady:
            rate = np.repeat((ends[1:] - ends[:1]) / seconds, 2, axis=0)
        pieces.append(quintic_hermite(np.array([now, now + seconds]), ends, rate, np.zeros_like(ends)))
        phases.append(Phase(name, shot, now, now + seconds))  # type: ignore[arg-type]
        now, last = now + seconds, pose
    return DroneTrajectory("cam1", concatenate(pieces), tuple(phases), (), ())


def plan(
    trajectory: DroneTrajectory,
    *,
    mission: MissionIR | None = None,
    target: str | None = None,
    **drone: object,
) -> VerifiedIR:
    """Put a flight into the sample mission, its drone changed as told; ``target`` is framed in every shot."""
    sample = orbit_plan().trajectory
    mission = mission or orbit_mission()
    mission = replace(mission, drones=(replace(mission.drones[0], **drone),))  # type: ignore[arg-type]
    if target:
        framing = tuple(
            Reference(p.shot, target, p.start, p.end, None) for p in trajectory.phases if p.shot is not None
        )
        trajectory = replace(trajectory, framing=framing)
    keyframes = replace(sample.keyframes, mission=mission)
    return VerifiedIR(replace(sample, keyframes=keyframes, drones=(trajectory,)), ())


def straight(yaw: float = np.pi / 2, pitch: float = 0.0, **options: bool) -> DroneTrajectory:
    """Up, 40 m to the East filmed, 40 m back, down."""
    low, high = (0.0, -60.0, 0.0, yaw, pitch), (0.0, -60.0, 20.0, yaw, pitch)
    east = (40.0, -60.0, 20.0, yaw, pitch)
    return flight(
        [
            ("takeoff", None, 8.0, high),
            ("shot", "half", 10.0, east),
            ("return", None, 10.0, high),
            ("land", None, 8.0, low),
        ],
        pad=low,
        **options,
    )


def retold(source: VerifiedIR, **drone: object) -> VerifiedIR:
    """Return a plan with its drone changed."""
    keyframes = source.trajectory.keyframes
    mission = keyframes.mission
    mission = replace(mission, drones=(replace(mission.drones[0], **drone),))  # type: ignore[arg-type]
    return replace(
        source, trajectory=replace(source.trajectory, keyframes=replace(keyframes, mission=mission))
    )
