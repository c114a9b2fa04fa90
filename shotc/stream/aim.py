"""Aims the camera at a live target: only the gimbal angles change, never the drone's path.

The target stays at the position in the image that the plan gives it. The gimbal leaves its planned angles no
faster than its rate limit, stays in its range, and returns to them when no position of the target arrives.
"""

from __future__ import annotations

import numpy as np

from shotc.geom.camera import aim_at, view
from shotc.geom.vec import Vec2, Vec3, direction, minus, wrapped
from shotc.ir.drone import Drone
from shotc.ir.mission import MissionIR
from shotc.ir.path import BODY_YAW, CAM_PITCH, CAM_YAW, HFOV
from shotc.ir.sampling import subjects
from shotc.ir.trajectory import DroneTrajectory
from shotc.stream.clock import PERIOD_S, RATE_HZ
from shotc.stream.feed import Feed
from shotc.stream.setpoints import Aim, SetpointSeries

BACK_RAD = 1e-9
"""Offsets below this count as zero: the planned angles are sent unchanged."""


class LiveAim:
    """The gimbal angles of one drone, tick by tick."""

    def __init__(
        self, mission: MissionIR, track: DroneTrajectory, course: SetpointSeries, feeds: tuple[Feed, ...]
    ) -> None:
        """Follow the targets of ``feeds`` in the shots that film them."""
        self._mission = mission
        self._drone: Drone = mission.drone(track.drone)
        self._track = track
        self._course = course
        self._feeds = {feed.target: feed for feed in feeds}
        self._shots = {
            phase.shot: next((s for s in subjects(mission, track, phase.shot) if s in self._feeds), None)
            for phase in track.phases
            if phase.shot is not None
        }
        self._off = (0.0, 0.0)

    def at(self, tick: int, now: float) -> Aim:
        """Return the gimbal angles at a tick; now : the time on the clock of the feeds, s."""
        planned = self._course.aim(tick)
        if not self._feeds:
            return planned
        offset = self._offset(tick / RATE_HZ, now)
        before, most = self._off, self._drone.gimbal.rate * PERIOD_S
        self._off = (_towards(before[0], offset[0], most), _towards(before[1], offset[1], most))
        yaw, pitch = self._off
        if abs(yaw) < BACK_RAD and abs(pitch) < BACK_RAD:
            return planned
        rates = ((yaw - before[0]) * RATE_HZ, (pitch - before[1]) * RATE_HZ)
        return Aim(
            planned.pitch + pitch,
            float(wrapped(planned.yaw - yaw)),
            planned.pitch_rate + rates[1],
            planned.yaw_rate - rates[0],
        )

    def _offset(self, t: float, now: float) -> Vec2:
        """Return the wanted offset from the planned yaw (counter-clockwise) and pitch, rad."""
        name = self._filmed(t)
        feed = self._feeds.get(name) if name is not None else None
        seen = feed.position(now) if feed is not None else None
        if seen is None or name is None:
            return (0.0, 0.0)
        planned = self._mission.target(name).at(t)
        live = (seen[0], seen[1], planned[2] if seen[2] is None else seen[2])
        return self._kept(t, planned, live)

    def _filmed(self, t: float) -> str | None:
        shot = next(
            (p.shot for p in self._track.phases if p.shot is not None and p.start <= t <= p.end), None
        )
        return None if shot is None else self._shots.get(shot)

    def _kept(self, t: float, planned: Vec3, live: Vec3) -> Vec2:
        pose = self._track.curve(t)
        place: Vec3 = (float(pose[0]), float(pose[1]), float(pose[2]))
        yaw, pitch, hfov = float(pose[CAM_YAW]), float(pose[CAM_PITCH]), float(pose[HFOV])
        u, v, depth = view(yaw, pitch, hfov, self._drone.aspect).project(minus(planned, place))
        if depth <= 0:
            return (0.0, 0.0)
        aim = aim_at(minus(live, place), (u, v), hfov, self._drone.aspect, yaw)
        if aim is None:
            return (0.0, 0.0)
        low, high = self._drone.gimbal.pitch
        pitch_off = min(max(aim[1], low), high) - pitch
        if not self._course.pans:
            return (0.0, pitch_off)
        return (self._panned(float(wrapped(aim[0] - yaw)), yaw, float(pose[BODY_YAW])), pitch_off)

    def _panned(self, off: float, yaw: float, body: float) -> float:
        """Return the part of the pan offset ``off`` that the gimbal's pan range allows, rad."""
        left, right = self._drone.gimbal.yaw
        pan = direction(yaw - body)
        return min(max(pan + off, min(left, pan)), max(right, pan)) - pan


def _towards(value: float, goal: float, most: float) -> float:
    return value + float(np.clip(goal - value, -most, most))
