"""A drone and its camera as resolved for planning. Plain Python."""

from math import radians
from typing import Literal, NamedTuple

from shotc.geom.focal import FULL_FRAME_M, focal_length
from shotc.ir.limits import Limits, Range, Vec3, reaches
from shotc.ir.origin import KeyPath
from shotc.ir.power import Power
from shotc.ir.source import ZOOM_COMMANDS, Autopilot

SAME_LENS_RAD = radians(0.01)
"""Tolerance of a field of view beyond the ends of a lens, for rounding."""


class Gimbal(NamedTuple):
    """The angles that the gimbal reaches: pitch from the horizon, yaw from the body.

    pitch, yaw : (lowest, highest), rad; rate, acceleration : per axis, rad/s, rad/s^2
    """

    pitch: Range
    yaw: Range
    rate: float
    acceleration: float

    def reaches(self, pitch: float) -> bool:
        """Return whether the camera reaches a pitch, rad."""
        return reaches(self.pitch, pitch)


class LensRange(NamedTuple):
    """The fields of view of a camera's lens.

    longest, widest : horizontal fields of view at its ends, rad; equal for a fixed lens
    rate : largest rate of the field of view, rad/s; 0 for a fixed lens
    frame : width of the picture to which its focal lengths refer, m
    """

    longest: float
    widest: float
    rate: float
    frame: float = FULL_FRAME_M

    @property
    def zooms(self) -> bool:
        """Whether it has more than one field of view."""
        return self.longest < self.widest

    def shows(self, hfov: float) -> bool:
        """Return whether it has this field of view, rad, to a hundredth of a degree."""
        return self.longest - SAME_LENS_RAD <= hfov <= self.widest + SAME_LENS_RAD

    def focal(self, hfov: float) -> float:
        """Return the focal length, m, of a field of view, rad."""
        return focal_length(hfov, self.frame)


class Optics(NamedTuple):
    """The sensor, aperture and shutter of a camera, as far as the mission states them.

    sensor : width of the exposed area, m; None if unknown, then a full frame is assumed
    aperture : f-number; None if unknown, then no depth of field is computed
    circle : diameter of the circle of confusion on the sensor, m
    shutter : exposure time, s; None if unknown, then no motion blur is computed
    pixels : width of the picture in pixels
    """

    sensor: float | None
    aperture: float | None
    circle: float
    shutter: float | None
    pixels: int

    @property
    def width(self) -> float:
        """Width of the sensor, or of a full frame if it is unknown, m."""
        return self.sensor or FULL_FRAME_M


LinkLost = Literal["return", "hover", "land", "continue"]


class Safety(NamedTuple):
    """What a drone does on a failure, as far as the mission states it.

    return_height : above its home, m; rally : places of W where it may land instead of at home
    """

    link_lost: LinkLost | None
    return_height: float | None
    rally: tuple[Vec3, ...]


class Drone(NamedTuple):
    """A drone with its presets filled in.

    home : p_WB at rest on its pad
    hfov : horizontal field of view of shots that state none, rad; aspect : width / height
    radius : of the body sphere, m; endurance : s; the time of hovering if the battery is known
    power : battery and rotors, None if unknown
    lens : None if unknown
    optics : None if the mission states neither aperture nor shutter
    safety : None if the mission states none
    """

    name: str
    model: str
    home: Vec3
    limits: Limits
    gimbal: Gimbal
    hfov: float
    aspect: float
    radius: float
    endurance: float
    priority: int
    body: Literal["forward", "follow-camera", "free"]
    autopilot: Autopilot
    path: KeyPath
    power: Power | None = None
    lens: LensRange | None = None
    optics: Optics | None = None
    safety: Safety | None = None

    @property
    def zooms(self) -> bool:
        """Whether its lens is known to zoom, so that a file may command its field of view."""
        return self.lens is not None and self.lens.zooms

    @property
    def zooms_unasked(self) -> bool:
        """Whether a plan may zoom in a shot of one field of view: its autopilot's files can command it."""
        return self.zooms and self.autopilot in ZOOM_COMMANDS

    @property
    def endurance_text(self) -> str:
        """Its endurance in words, with the energy and the power that it follows from."""
        if self.power is None:
            return f"{self.endurance:.1f} s"
        usable, reserve = self.power.usable / 3600.0, 100 * self.power.reserve
        hover = f"{usable:.1f} Wh at {self.power.hover:.0f} W hovering"
        return f"{self.endurance:.1f} s, {hover}, {reserve:.0f} % kept"
