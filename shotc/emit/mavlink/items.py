"""Mission items of MAVLink, their command numbers and their units.

Angles in items are degrees. Headings are clockwise from North, and gimbal pitch is positive up. Positions are
latitude and longitude in degrees and height above home in metres.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

from shotc.emit.waypoints.geo import GeoPosition
from shotc.geom.camera import heading_of
from shotc.geom.vec import wrapped

WAYPOINT, LAND, TAKEOFF = 16, 21, 22
CONDITION_YAW, CHANGE_SPEED = 115, 178
ROI_LOCATION, ROI_NONE, MOUNT_CONTROL = 195, 197, 205
CAMERA_ZOOM, CAMERA_FOCUS = 531, 532
GIMBAL_PITCHYAW, GIMBAL_CONFIGURE = 1000, 1001
PHOTO_DISTANCE, CAMERA_MODE, PHOTO_START, PHOTO_STOP = 206, 530, 2000, 2001
VIDEO_START, VIDEO_STOP = 2500, 2501
MODE_PHOTO, MODE_VIDEO = 0, 1
POSITION_COMMANDS = frozenset({WAYPOINT, LAND, TAKEOFF})

FRAME_GLOBAL, FRAME_MISSION, FRAME_RELATIVE = 0, 2, 3
SPEED_GROUND, SPEED_CLIMB, SPEED_DESCENT = 1, 2, 3
MOUNT_ANGLES = 2
ZOOM_RANGE, ZOOM_FOCAL_LENGTH, FOCUS_METERS = 2, 3, 3
ROLL_LOCK, PITCH_LOCK, YAW_LOCK = 4, 8, 16


@dataclass(frozen=True, slots=True)
class MissionItem:
    """One mission item.

    params : seven numbers; None stands for NaN, which leaves the choice to the autopilot
    """

    command: int
    frame: int
    params: tuple[float | None, ...]


def action(command: int, *params: float | None) -> MissionItem:
    """Return an item without a position; zeros fill the parameters up to seven."""
    return MissionItem(command, FRAME_MISSION, (*params, *(0.0,) * (7 - len(params))))


def at(command: int, place: GeoPosition, *params: float | None) -> MissionItem:
    """Return an item at a position, with its first four parameters."""
    return MissionItem(command, FRAME_RELATIVE, (*params, place.lat, place.lon, place.alt))


def degrees_of(angle: float) -> float:
    """Return an angle, rad, in degrees, rounded to four decimals and never a negative zero."""
    return round(angle * 180 / pi, 4) + 0.0


def compass_deg(yaw: float) -> float:
    """Return the compass heading in [0, 360) degrees of a yaw, rad counter-clockwise from East."""
    return degrees_of(heading_of(yaw)) % 360.0


def signed_deg(angle: float) -> float:
    """Return an angle, rad, wrapped into [-180, 180) degrees."""
    return degrees_of(wrapped(angle))
