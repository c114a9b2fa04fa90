"""A drone's plan, sampled at the steps of a simulation."""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot

import numpy as np

from shotc.geom.bernstein import Array
from shotc.ir.drone import Drone
from shotc.ir.mission import MissionIR
from shotc.ir.path import CAM_PITCH, CAM_YAW, HFOV
from shotc.ir.sampling import references, subjects
from shotc.ir.trajectory import DroneTrajectory
from shotc.simulation.vehicle import STEP_S, VehicleSetpoint

LEAD_S = 1.5
"""Seconds in which a camera passes from its plan to following a target before a shot."""


@dataclass(frozen=True, slots=True, eq=False)
class FramedTarget:
    """A target that a drone frames.

    reference : reference on screen at each step, (N, 2); NaN where it is not framed
    share : how far the camera follows it, 0 to 1, shape (N,); it rises before a shot and falls after it
    """

    target: str
    reference: Array
    share: Array


@dataclass(frozen=True, slots=True, eq=False)
class PlanSamples:
    """One drone's plan at N steps of STEP_S.

    times : (N,), seconds
    position, velocity, acceleration : (N, 3), W, metres, m/s, m/s^2
    yaw, pitch, yaw_rate, pitch_rate : of the camera, (N,), rad, rad/s
    half : tan of half the fields of view, (N, 2)
    """

    drone: Drone
    track: DroneTrajectory
    times: Array
    position: Array
    velocity: Array
    acceleration: Array
    yaw: Array
    pitch: Array
    yaw_rate: Array
    pitch_rate: Array
    half: Array
    framed: tuple[FramedTarget, ...]

    def step(self, time: float) -> int:
        """Return the index of the first step at or after a time."""
        return min(int(np.ceil(time / STEP_S - 1e-6)), len(self.times) - 1)

    def places(self, times: Array) -> Array:
        """Return where the drone is planned to be at times (M,), (M, 3), metres."""
        return np.asarray(self.position[[self.step(time) for time in times.tolist()]])

    @property
    def above_pad(self) -> float:
        """The time at which the drone has taken off over its pad, or the start of its flight, seconds."""
        rises = [phase.end for phase in self.track.phases if phase.name == "takeoff"]
        return max(rises, default=float(self.times[0]))

    @property
    def lands(self) -> float:
        """The time at which the drone begins to land over its pad, or the end of its flight, seconds."""
        landings = [phase.start for phase in self.track.phases if phase.name == "land"]
        return min(landings, default=float(self.times[-1]))

    @property
    def fastest(self) -> float:
        """The largest speed that the drone's limits allow, climb and descent included, m/s."""
        limits = self.drone.limits
        return hypot(limits.fastest, max(limits.climb, limits.descent))

    def setpoint(self, k: int) -> VehicleSetpoint:
        """Return the setpoint of the plan at a step."""
        return VehicleSetpoint(self.position[k, None], self.velocity[k, None], self.acceleration[k, None])


def film_of(mission: MissionIR, track: DroneTrajectory) -> PlanSamples:
    """Return the samples of one drone's plan, from time 0 to its landing."""
    drone = mission.drone(track.drone)
    count = int(np.ceil(track.curve.end / STEP_S)) + 1
    times = np.arange(count, dtype=np.float64) * STEP_S
    pose = track.curve(times)
    rate, acceleration = track.curve.derivative()(times), track.curve.derivative(2)(times)
    rate[-1] = acceleration[-1] = 0.0  # the drone stands on its pad
    half = np.tan(pose[:, HFOV] / 2)
    return PlanSamples(
        drone=drone,
        track=track,
        times=times,
        position=pose[:, :3],
        velocity=rate[:, :3],
        acceleration=acceleration[:, :3],
        yaw=pose[:, CAM_YAW],
        pitch=pose[:, CAM_PITCH],
        yaw_rate=rate[:, CAM_YAW],
        pitch_rate=rate[:, CAM_PITCH],
        half=np.column_stack([half, half / drone.aspect]),
        framed=_framed(mission, track, times),
    )


def _framed(mission: MissionIR, track: DroneTrajectory, times: Array) -> tuple[FramedTarget, ...]:
    by_target: dict[str, Array] = {}
    for phase in track.phases:
        if phase.shot is None:
            continue
        inside = (times >= phase.start) & (times <= phase.end)
        for target in subjects(mission, track, phase.shot):
            into = by_target.setdefault(target, np.full((len(times), 2), np.nan))
            into[inside] = references(track, phase.shot, target, times[inside])
    return tuple(_led_in(name, uv) for name, uv in by_target.items() if np.isfinite(uv).any())


def _led_in(name: str, reference: Array) -> FramedTarget:
    """Return a target that the camera begins to follow LEAD_S before a shot and releases as
    slowly after it.
    """
    framed = np.isfinite(reference[:, 0])
    steps, rows = round(LEAD_S / STEP_S), np.arange(len(reference))
    at = rows[framed]
    before, after = np.searchsorted(at, rows, side="right") - 1, np.searchsorted(at, rows)
    before_steps = np.where(before >= 0, rows - at[np.maximum(before, 0)], np.inf)
    after_steps = np.where(after < len(at), at[np.minimum(after, len(at) - 1)] - rows, np.inf)
    nearest = np.where(
        before_steps <= after_steps, at[np.maximum(before, 0)], at[np.minimum(after, len(at) - 1)]
    )
    share = np.clip(1.0 - np.minimum(before_steps, after_steps) / steps, 0.0, 1.0)
    return FramedTarget(name, np.where(share[:, None] > 0.0, reference[nearest], np.nan), share)
