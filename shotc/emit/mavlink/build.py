"""Builds mission items from steps.

The order between two waypoints is: end of recording, end of following, speed, gimbal, zoom, start of
recording, heading. The heading is last because on ArduPilot a CONDITION command delays every command behind
it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from shotc.emit.mavlink.dialect import Dialect
from shotc.emit.mavlink.focus import Focus
from shotc.emit.mavlink.items import (
    CAMERA_FOCUS,
    CAMERA_MODE,
    CHANGE_SPEED,
    CONDITION_YAW,
    FOCUS_METERS,
    MODE_PHOTO,
    MODE_VIDEO,
    PHOTO_DISTANCE,
    PHOTO_START,
    PHOTO_STOP,
    ROI_LOCATION,
    ROI_NONE,
    SPEED_CLIMB,
    SPEED_DESCENT,
    SPEED_GROUND,
    VIDEO_START,
    VIDEO_STOP,
    MissionItem,
    action,
    at,
    compass_deg,
    degrees_of,
)
from shotc.emit.mavlink.speed import Speeds, adapted, seconds
from shotc.emit.mavlink.steps import SAME_RAD, WaypointStep
from shotc.emit.mavlink.style import Command, Style, turns_body
from shotc.emit.waypoints.geo import Geo, GeoPosition
from shotc.emit.waypoints.lens import SAME_LENS_HALF_FRAMES, edge
from shotc.emit.waypoints.track import Poses, SampledFlight, select
from shotc.ir.drone import Drone
from shotc.ir.limits import Vec3
from shotc.ir.photos import Photos

Array = NDArray[np.float64]

SLEW_DEG_S = 60.0  # deg/s, ArduPilot's ATC_SLEW_YAW, the fastest turn that is flown
LEAST_TURN_DEG_S = 0.01  # deg/s; zero would select the default rate


@dataclass(slots=True)
class Builder:
    """The flight list under construction, and the state at its end.

    yaw : body yaw commanded last, rad
    aimed : gimbal angles commanded last; None after following
    region : point in W that the gimbal looks at, or None
    hfov : field of view commanded last, rad
    photos : photo settings of the shots that take photos, by shot name
    focus : focus distances along the flight; None where the file does not set the focus
    focused : focus distance commanded last, metres
    """

    drone: Drone
    style: Style
    dialect: Dialect
    geo: Geo
    speeds: Speeds
    items: list[MissionItem] = field(default_factory=list)
    yaw: float | None = None
    aimed: Command | None = None
    region: Vec3 | None = None
    hfov: float | None = None
    photos: Mapping[str, Photos] = field(default_factory=dict)
    focus: Focus | None = None
    focused: float | None = None

    def build(self, track: SampledFlight, steps: list[WaypointStep]) -> list[MissionItem]:
        """Return the whole flight: take-off, the steps, landing."""
        places = self.geo.places(track.poses.position)
        start = float(track.poses.body_yaw[0])
        home = GeoPosition(self.geo.home_lat, self.geo.home_lon, 0.0)
        above = replace(home, alt=max(places[0].alt, self.dialect.least_takeoff))
        self.items.extend(self.dialect.takeoff(above, start))
        shot: str | None = None
        for step in steps:
            entered = step.leg.shot if step.leg.shot != shot else None
            if step.leg.shot != shot:
                self._leave(shot, following=step.region is not None)
            end = select(track.poses, slice(step.leg.last, step.leg.last + 1))
            self._go(step, entered, places[step.leg.last], end)
            shot = step.leg.shot
        self._leave(shot, following=False)
        self.items.append(self.dialect.land(home, float(track.poses.body_yaw[-1])))
        return self.items

    def _leave(self, shot: str | None, *, following: bool) -> None:
        if shot is not None:
            self.items.append(self._stop(shot))
        if self.region is not None and not following:
            self.items.append(action(ROI_NONE))
            self.region = self.aimed = self.yaw = None

    def _go(self, step: WaypointStep, entered: str | None, place: GeoPosition, end: Poses) -> None:
        self._pace(step)
        turned = False
        if step.region is None:
            turned = self._aim(step.command)
        else:
            self._look(step.region, end.position[0])
        self._zoom(step.command)
        self._sharpen(step)
        if entered is not None:
            self.items.extend(self._start(entered))
        if self.dialect.turns_by_item and not (step.region and turns_body(self.drone)):
            self._turn(step, float(end.body_yaw[0]), force=turned)
        self.items.append(self.dialect.waypoint(place, step.hold, step.radius, step.command.body_yaw))

    def _start(self, shot: str) -> list[MissionItem]:
        """Return the items that start the recording or the photos of a shot."""
        photos = self.photos.get(shot)
        changes = self.dialect.changes_mode and self.photos
        mode = (
            [action(CAMERA_MODE, 0.0, float(MODE_VIDEO if photos is None else MODE_PHOTO))] if changes else []
        )
        if photos is None:
            return [*mode, action(VIDEO_START)]
        if photos.seconds is not None:
            return [*mode, action(PHOTO_START, 0.0, photos.seconds)]
        return [*mode, action(PHOTO_DISTANCE, photos.metres, 0.0, 1.0)]

    def _stop(self, shot: str) -> MissionItem:
        photos = self.photos.get(shot)
        if photos is None:
            return action(VIDEO_STOP)
        return action(PHOTO_DISTANCE if photos.seconds is None else PHOTO_STOP)

    def _pace(self, step: WaypointStep) -> None:
        if step.duration == 0:
            return
        limits = self.drone.limits if self.dialect.vertical_speeds else None
        speeds = adapted(self.speeds, limits, step.across, step.rise, step.duration)
        for kind, new, old in (
            (SPEED_GROUND, speeds.ground, self.speeds.ground),
            (SPEED_CLIMB, speeds.climb, self.speeds.climb),
            (SPEED_DESCENT, speeds.descent, self.speeds.descent),
        ):
            if new != old:
                self.items.append(action(CHANGE_SPEED, float(kind), new, -1.0))
        self.speeds = speeds

    def _aim(self, command: Command) -> bool:
        last = self.aimed
        if last is not None:
            turned = command.cam_yaw - last.cam_yaw if self.dialect.earth_pan else command.pan - last.pan
            if abs(command.cam_pitch - last.cam_pitch) < SAME_RAD and (
                not self.style.pans or abs(turned) < SAME_RAD
            ):
                return False
        self.items.append(self.dialect.gimbal(command, self.style))
        self.aimed = command
        return True

    def _zoom(self, command: Command) -> None:
        lens = self.drone.lens
        if lens is None or not self.style.zooms:
            return
        if self.hfov is None or edge(command.hfov, self.hfov) > SAME_LENS_HALF_FRAMES:
            self.items.append(self.dialect.zoom(lens, command.hfov))
            self.hfov = command.hfov

    def _sharpen(self, step: WaypointStep) -> None:
        part = slice(step.leg.first, step.leg.last + 1)
        if self.focus is None or step.leg.shot is None:
            return
        if self.focused is None or not self.focus.serves(part, self.focused):
            middle = self.focus.middle(part)
            if middle is not None and middle != self.focused:
                self.items.append(action(CAMERA_FOCUS, float(FOCUS_METERS), middle))
                self.focused = middle

    def _look(self, region: Vec3, position: Array) -> None:
        if self.region is not None and _parted(region, self.region, position) < SAME_RAD:
            return
        self.items.append(at(ROI_LOCATION, self.geo.place(region), 0.0, 0.0, 0.0, 0.0))
        self.region = region

    def _turn(self, step: WaypointStep, yaw: float, *, force: bool) -> None:
        # A mount that cannot pan takes control of the body with every mount command, so the heading must be
        # commanded again (ArduCopter, do_mount_control).
        if self.yaw is None:
            rate = SLEW_DEG_S
        elif abs(yaw - self.yaw) < SAME_RAD and not force:
            return
        else:
            moving = seconds(self.speeds, step.across, step.rise)
            time = max(moving if step.duration > 0 else step.hold, 0.5)
            rate = min(SLEW_DEG_S, max(LEAST_TURN_DEG_S, round(abs(degrees_of(yaw - self.yaw)) / time, 4)))
        self.items.append(action(CONDITION_YAW, compass_deg(yaw), rate, 0.0, 0.0))
        self.yaw = yaw


def _parted(a: Vec3, b: Vec3, position: Array) -> float:
    """Return the angle between two points as seen from a third, rad."""
    ray, other = np.array(a) - position, np.array(b) - position
    return float(np.arctan2(np.linalg.norm(np.cross(ray, other)), ray @ other))
