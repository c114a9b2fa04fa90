"""Differences between the mission items of PX4 and ArduPilot.

PX4 takes the yaw from the waypoint (NaN leaves the choice to it). It takes fine gimbal angles from the gimbal
manager after the mission has claimed control of it. It has no CONDITION_YAW.

ArduPilot ignores a waypoint's yaw and radius, refuses NaN and holds for whole seconds. It stores gimbal
manager angles as whole degrees, so the older mount command carries the angles.

PX4 passes a focal length on to the camera. ArduPilot takes only a share of the zoom range, which is linear in
magnification (AP_Camera, AP_Mount_Siyi).
"""

from __future__ import annotations

from math import pi

from shotc.emit.mavlink.items import (
    CAMERA_ZOOM,
    GIMBAL_CONFIGURE,
    GIMBAL_PITCHYAW,
    LAND,
    MOUNT_ANGLES,
    MOUNT_CONTROL,
    PITCH_LOCK,
    ROLL_LOCK,
    TAKEOFF,
    WAYPOINT,
    YAW_LOCK,
    ZOOM_FOCAL_LENGTH,
    ZOOM_RANGE,
    MissionItem,
    action,
    at,
    compass_deg,
    degrees_of,
    signed_deg,
)
from shotc.emit.mavlink.style import Command, Style
from shotc.emit.waypoints.geo import GeoPosition
from shotc.geom.focal import field_of_view
from shotc.ir.drone import LensRange
from shotc.ir.source import Autopilot

ITSELF_PARAMETER = -2.0  # the mission's own system and component, which take primary control of the gimbal


class Px4:
    """PX4 multirotor, with at most 500 items: newer boards store no more."""

    firmware = 12
    most_items = 500
    whole_seconds = False
    least_takeoff = 3.0  # metres: the acceptance radius (NAV_ACC_RAD, 2 m for multirotors) plus 1 m
    vertical_speeds = False
    turns_by_item = False
    earth_pan = True
    focuses = True
    changes_mode = True

    def takeoff(self, place: GeoPosition, yaw: float) -> list[MissionItem]:
        """Return the take-off, after which the mission claims the gimbal."""
        claim = action(GIMBAL_CONFIGURE, ITSELF_PARAMETER, ITSELF_PARAMETER, 0.0, 0.0)
        return [at(TAKEOFF, place, 0.0, 0.0, 0.0, compass_deg(yaw)), claim]

    def waypoint(self, place: GeoPosition, hold: float, radius: float, yaw: float) -> MissionItem:
        """Return a waypoint: hold in s, acceptance radius in m, body yaw in rad."""
        return at(WAYPOINT, place, round(hold, 2), round(radius, 2), 0.0, compass_deg(yaw))

    def gimbal(self, command: Command, style: Style) -> MissionItem:
        """Return the gimbal's angles: the horizon is level, and the yaw is relative to North if the gimbal
        pans.
        """
        flags = float(ROLL_LOCK | PITCH_LOCK | (YAW_LOCK if style.pans else 0))
        yaw = signed_deg(pi / 2 - command.cam_yaw) if style.pans else 0.0
        return action(GIMBAL_PITCHYAW, degrees_of(command.cam_pitch), yaw, None, None, flags)

    def zoom(self, lens: LensRange, hfov: float) -> MissionItem:
        """Return the zoom to a field of view, rad, as a focal length in mm."""
        return action(CAMERA_ZOOM, float(ZOOM_FOCAL_LENGTH), round(1000 * lens.focal(hfov), 2))

    def zoomed(self, lens: LensRange, value: float) -> float:
        """Return the field of view, rad, of the value in a zoom item."""
        return field_of_view(value / 1000, lens.frame)

    def land(self, place: GeoPosition, yaw: float) -> MissionItem:
        """Return the landing."""
        return at(LAND, place, 0.0, 0.0, 0.0, compass_deg(yaw))


class ArduPilot:
    """ArduPilot Copter, with at most 650 items including home: the capacity of 16 KB of storage."""

    firmware = 3
    most_items = 649
    whole_seconds = True
    least_takeoff = 1.0  # metres
    vertical_speeds = True
    turns_by_item = True
    earth_pan = False
    focuses = False  # only autofocus, or a percentage of an unknown range
    changes_mode = False

    def takeoff(self, place: GeoPosition, yaw: float) -> list[MissionItem]:
        """Return the take-off; the vehicle keeps its heading."""
        return [at(TAKEOFF, place, 0.0, 0.0, 0.0, 0.0)]

    def waypoint(self, place: GeoPosition, hold: float, radius: float, yaw: float) -> MissionItem:
        """Return a waypoint with a hold in whole seconds; parameters set the radius and CONDITION_YAW sets
        the yaw.
        """
        return at(WAYPOINT, place, hold, 0.0, 0.0, 0.0)

    def gimbal(self, command: Command, style: Style) -> MissionItem:
        """Return the gimbal's angles, with the yaw relative to the body."""
        yaw = signed_deg(-command.pan) if style.pans else 0.0
        return action(
            MOUNT_CONTROL, degrees_of(command.cam_pitch), 0.0, yaw, 0.0, 0.0, 0.0, float(MOUNT_ANGLES)
        )

    def zoom(self, lens: LensRange, hfov: float) -> MissionItem:
        """Return the zoom to a field of view, rad, in percent of the range of focal lengths."""
        short, long = lens.focal(lens.widest), lens.focal(lens.longest)
        share = (lens.focal(hfov) - short) / (long - short)
        return action(CAMERA_ZOOM, float(ZOOM_RANGE), round(100 * min(max(share, 0.0), 1.0), 2))

    def zoomed(self, lens: LensRange, value: float) -> float:
        """Return the field of view, rad, of the value in a zoom item."""
        short, long = lens.focal(lens.widest), lens.focal(lens.longest)
        return field_of_view(short + value / 100 * (long - short), lens.frame)

    def land(self, place: GeoPosition, yaw: float) -> MissionItem:
        """Return the landing."""
        return at(LAND, place, 0.0, 0.0, 0.0, 0.0)


Dialect = Px4 | ArduPilot
DIALECTS: dict[Autopilot, Dialect] = {"px4": Px4(), "ardupilot": ArduPilot()}
