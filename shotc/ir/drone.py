"""A drone with its camera, as planning takes it. Plain Python."""

from math import radians
from typing import Literal, NamedTuple

from shotc.geom.focal import FULL_FRAME_M, focal_length
from shotc.ir.limits import Limits, Range, Vec3, reaches
from shotc.ir.origin import KeyPath
from shotc.ir.power import Power
from shotc.ir.source import ZOOM_COMMANDS, Autopilot

SAME_LENS_RAD = radians(0.01)
"""By how much a field of view may be beyond those of a lens: it is rounding."""


class Gimbal(NamedTuple):
    """Camera angles the gimbal reaches: pitch against the horizon, yaw against the body.

    pitch, yaw : (lowest, highest), rad; rate, acceleration : per axis, rad/s, rad/s^2
    """

    pitch: Range
    yaw: Range
    rate: float
    acceleration: float

    def reaches(self, pitch: float) -> bool:
        """Tell whether the camera comes to a pitch, rad."""
        return reaches(self.pitch, pitch)


class LensRange(NamedTuple):
    """What a camera's lens shows.

    longest, widest : horizontal fields of view at its ends, rad; of a fixed lens both are the same
    rate : how fast the field of view changes at most, rad/s; 0 of a fixed lens
    frame : width of the picture that its focal lengths count on, m
    """

    longest: float
    widest: float
    rate: float
    frame: float = FULL_FRAME_M

    @property
    def zooms(self) -> bool:
        """Tell whether it has more than one field of view."""
        return self.longest < self.widest

    def shows(self, hfov: float) -> bool:
        """Tell whether it has this field of view, rad, to a hundredth of a degree."""
        return self.longest - SAME_LENS_RAD <= hfov <= self.widest + SAME_LENS_RAD

    def focal(self, hfov: float) -> float:
        """Return the focal length, m, at which it has a field of view, rad."""
        return focal_length(hfov, self.frame)


class Optics(NamedTuple):
    """What a camera exposes with, where the mission says it.

    sensor : width of the area that takes the picture, m; None where nobody says: a full frame is taken then
    aperture : f-number, None where the mission is silent: no depth of field is told then
    circle : diameter of the disc on the sensor up to which a point counts as sharp, m
    shutter : time of exposure, s, None where the mission is silent: no motion blur is told then
    pixels : of the picture's width
    """

    sensor: float | None
    aperture: float | None
    circle: float
    shutter: float | None
    pixels: int

    @property
    def width(self) -> float:
        """Width of the sensor, or of the full frame that is taken for it, m."""
        return self.sensor or FULL_FRAME_M


LinkLost = Literal["return", "hover", "land", "continue"]


class Safety(NamedTuple):
    """What a drone does when something goes wrong, as far as the mission says it.

    return_height : above its home, m; rally : places of W where it may land instead of there
    """

    link_lost: LinkLost | None
    return_height: float | None
    rally: tuple[Vec3, ...]


class Drone(NamedTuple):
    """A drone with its presets filled in.

    home : p_WB at rest on its pad
    hfov : horizontal field of view, rad, where a shot asks for no other; aspect : width / height
    radius : of the body sphere, m; endurance : s, of a drone whose battery is known what that hovers
    power : its battery and rotors, None where nobody knows them
    lens : None where nobody says what the camera carries
    optics : None where the mission says neither aperture nor shutter
    safety : None where the mission is silent
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
        """Tell whether its lens is known to zoom, so that a file may command its field of view."""
        return self.lens is not None and self.lens.zooms

    @property
    def zooms_unasked(self) -> bool:
        """Tell whether a plan may zoom where the mission asks for one field of view: its files carry that."""
        return self.zooms and self.autopilot in ZOOM_COMMANDS

    @property
    def lasts(self) -> str:
        """How long it can stay in the air, in words, and by what."""
        if self.power is None:
            return f"{self.endurance:.1f} s"
        usable, kept = self.power.usable / 3600.0, 100 * self.power.reserve
        return (
            f"{self.endurance:.1f} s, {usable:.1f} Wh at {self.power.hover:.0f} W hovering, {kept:.0f} % kept"
        )
