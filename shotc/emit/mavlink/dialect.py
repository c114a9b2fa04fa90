"""What PX4 and ArduPilot want said differently.

PX4 takes yaw from the waypoint, NaN where it may choose, and fine gimbal angles from the gimbal
manager once the mission has claimed it; it has no CONDITION_YAW. ArduPilot ignores a waypoint's yaw
and radius, refuses NaN, holds for whole seconds, and keeps gimbal manager angles as whole degrees
only, so the older mount command carries the angles there. PX4 hands a focal length on to the camera;
ArduPilot takes a share of the zoom's range alone, even in magnification (AP_Camera, AP_Mount_Siyi).
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

ITSELF = -2.0  # the mission's own system and component, for the gimbal's primary control


class Px4:
    """PX4 multirotor. At most 500 items: newer boards hold no more."""

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
        claim = action(GIMBAL_CONFIGURE, ITSELF, ITSELF, 0.0, 0.0)
        return [at(TAKEOFF, place, 0.0, 0.0, 0.0, compass_deg(yaw)), claim]

    def waypoint(self, place: GeoPosition, hold: float, radius: float, yaw: float) -> MissionItem:
        """Return a waypoint: hold in s, acceptance radius in m, body yaw in rad."""
        return at(WAYPOINT, place, round(hold, 2), round(radius, 2), 0.0, compass_deg(yaw))

    def gimbal(self, command: Command, style: Style) -> MissionItem:
        """Return the gimbal's angles; horizon-level, and against the earth where it pans."""
        flags = float(ROLL_LOCK | PITCH_LOCK | (YAW_LOCK if style.pans else 0))
        yaw = signed_deg(pi / 2 - command.cam_yaw) if style.pans else 0.0
        return action(GIMBAL_PITCHYAW, degrees_of(command.cam_pitch), yaw, None, None, flags)

    def zoom(self, lens: LensRange, hfov: float) -> MissionItem:
        """Return a zoom to a field of view, rad: a focal length in mm, as the lens counts them."""
        return action(CAMERA_ZOOM, float(ZOOM_FOCAL_LENGTH), round(1000 * lens.focal(hfov), 2))

    def zoomed(self, lens: LensRange, value: float) -> float:
        """Return the field of view, rad, of what a zoom says."""
        return field_of_view(value / 1000, lens.frame)

    def land(self, place: GeoPosition, yaw: float) -> MissionItem:
        """Return the landing."""
        return at(LAND, place, 0.0, 0.0, 0.0, compass_deg(yaw))


class ArduPilot:
    """ArduPilot Copter. At most 650 items with home: what 16 KB of storage hold."""

    firmware = 3
    most_items = 649
    whole_seconds = True
    least_takeoff = 1.0  # metres
    vertical_speeds = True
    turns_by_item = True
    earth_pan = False
    focuses = False  # but by itself, or in percent of what nobody knows
    changes_mode = False

    def takeoff(self, place: GeoPosition, yaw: float) -> list[MissionItem]:
        """Return the take-off; it keeps its heading."""
        return [at(TAKEOFF, place, 0.0, 0.0, 0.0, 0.0)]

    def waypoint(self, place: GeoPosition, hold: float, radius: float, yaw: float) -> MissionItem:
        """Return a waypoint: hold in whole s; radius and yaw come from parameters and CONDITION_YAW."""
        return at(WAYPOINT, place, hold, 0.0, 0.0, 0.0)

    def gimbal(self, command: Command, style: Style) -> MissionItem:
        """Return the gimbal's angles, yaw against the body."""
        yaw = signed_deg(-command.pan) if style.pans else 0.0
        return action(
            MOUNT_CONTROL, degrees_of(command.cam_pitch), 0.0, yaw, 0.0, 0.0, 0.0, float(MOUNT_ANGLES)
        )

    def zoom(self, lens: LensRange, hfov: float) -> MissionItem:
        """Return a zoom to a field of view, rad: in percent of the range of focal lengths."""
        short, long = lens.focal(lens.widest), lens.focal(lens.longest)
        share = (lens.focal(hfov) - short) / (long - short)
        return action(CAMERA_ZOOM, float(ZOOM_RANGE), round(100 * min(max(share, 0.0), 1.0), 2))

    def zoomed(self, lens: LensRange, value: float) -> float:
        """Return the field of view, rad, of what a zoom says."""
        short, long = lens.focal(lens.widest), lens.focal(lens.longest)
        return field_of_view(short + value / 100 * (long - short), lens.frame)

    def land(self, place: GeoPosition, yaw: float) -> MissionItem:
        """Return the landing."""
        return at(LAND, place, 0.0, 0.0, 0.0, 0.0)


Dialect = Px4 | ArduPilot
DIALECTS: dict[Autopilot, Dialect] = {"px4": Px4(), "ardupilot": ArduPilot()}
