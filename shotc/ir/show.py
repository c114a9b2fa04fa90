"""Fleets and what they draw, resolved. Plain Python, no numpy; part of MissionIR.

World frame W, metres, radians, seconds. A fleet's drones carry a light and no camera.
"""

from typing import Literal, NamedTuple

from shotc.ir.effects import Color, Effect
from shotc.ir.limits import Limits, Timing, Vec3
from shotc.ir.origin import KeyPath

MANY_DRONES = 2000
"""Drones of a show beyond which tables and recordings of it are made only where they are asked for."""


class Apart(NamedTuple):
    """How far two drones of a fleet stay apart, centre to centre, at every instant.

    shape : "ellipsoid": (dx^2 + dy^2) / h^2 + dz^2 / v^2 >= 1 with h, v the two distances and the margin
        beyond each; "cylinder": at least h apart horizontally, or v vertically
    horizontal, vertical : metres; the vertical one is the longer where rotors push air down
    margin : metres beyond both, for how far a drone may be from where it should be
    """

    shape: Literal["ellipsoid", "cylinder"]
    horizontal: float
    vertical: float
    margin: float

    @property
    def across(self) -> float:
        """Horizontal distance that is kept, margin included, metres."""
        return self.horizontal + self.margin

    @property
    def upright(self) -> float:
        """Vertical distance that is kept, margin included, metres."""
        return self.vertical + self.margin


def stricter(one: Apart, other: Apart) -> Apart:
    """Return what drones of two fleets keep of each other: the more that either asks for."""
    shape = one.shape if one.shape == "cylinder" else other.shape
    return Apart(shape, max(one.across, other.across), max(one.upright, other.upright), 0.0)


class Fleet(NamedTuple):
    """Drones of one model that draw together.

    pads : p_WB of every drone at rest, in the order of their numbers
    rise : metres above its pad to which each drone rises, straight up, before it goes anywhere
    radius : of the body sphere, m; endurance : s
    """

    name: str
    model: str
    pads: tuple[Vec3, ...]
    rise: float
    limits: Limits
    radius: float
    endurance: float
    apart: Apart
    path: KeyPath


def kept_from_cameras(separation: float, fleet: Fleet) -> float:
    """Return how far cameras stay from every drone of a fleet, centre to centre, metres: the stricter rule.

    separation : of the mission's rules, metres
    """
    return max(separation, fleet.apart.across, fleet.apart.upright)


class Sphere(NamedTuple):
    """A ball."""

    centre: Vec3
    radius: float


class Box(NamedTuple):
    """A box; size : along its own east, north and up; heading : by which it is turned, compass sense."""

    centre: Vec3
    size: Vec3
    heading: float


class Torus(NamedTuple):
    """A ring; radius : from its centre to the middle of the tube; tube : radius of that.

    heading, tilt : of its axis: 0 tilt lies flat, a quarter turn stands upright, its axis along the heading
    """

    centre: Vec3
    radius: float
    tube: float
    heading: float
    tilt: float


class Lettering(NamedTuple):
    """A text that stands upright, read by who looks along the heading; height : of its capitals, metres.

    font : a file of the mission's, or the name of a font of the system's, or None
    """

    text: str
    centre: Vec3
    height: float
    heading: float
    font: str | None


class Drawing(NamedTuple):
    """The shapes of an SVG file, upright as lettering; height : of all of it, metres."""

    file: str
    centre: Vec3
    height: float
    heading: float


class Model(NamedTuple):
    """Meshes or point clouds, one a frame.

    files : names, in order of the frames; period : seconds from frame to frame, of several
    centre : where the middle of the first frame's bounding box goes, None to leave it where it is
    height : to which the first frame is scaled, all others alike, metres, or None
    heading : by which all are turned about the vertical through that middle, compass sense
    unit : metres that one unit of the files is long
    up : axis of the files that points up, None where each format's own does
    """

    files: tuple[str, ...]
    period: float | None
    centre: Vec3 | None
    height: float | None
    heading: float
    unit: float = 1.0
    up: Literal["x", "y", "z"] | None = None


Easing = Literal["ease-in-out", "linear", "ease-in", "ease-out"]
"""How the speed of a move runs: slow at both ends, even, slow at its beginning, or slow at its end."""

Source = Sphere | Box | Torus | Lettering | Drawing | Model


class Picture(NamedTuple):
    """One picture, or an animation of several frames.

    fill : what of it the drones stand in: all of the inside, the surface, or (flat shapes) the edges;
        "legible" is what of a text reads best, its inside or its edges
    color : of every light; None where the file says, white where it does not
    transition : seconds to it from the picture before it, None for as fast as the pace allows
    hold : seconds that its last frame stands
    layers : in how many layers, one behind the other, a flat picture stands
    effects : of its lights, the last on top
    transition_path : how drones come to it: on straight lines, on arcs, or "auto", straight where that is
    proved; easing : how their speed runs
    at : when it stands on the mission's clock, s, or None where that follows from what is before it
    name : what shots of cameras call it, or None
    size : width, depth and height of the box about it that they frame, metres; None where its shape says that
    """

    source: Source
    fill: Literal["volume", "surface", "outline", "legible"]
    color: Color | None
    transition: float | None
    hold: float
    path: KeyPath
    transition_path: Literal["auto", "straight", "arc"] = "auto"
    layers: int = 1
    at: float | None = None
    name: str | None = None
    size: Vec3 | None = None
    effects: tuple[Effect, ...] = ()
    easing: Easing = "ease-in-out"


class PyroCue(NamedTuple):
    """A product that burns on drones of a fleet.

    time : when it is seen on the mission's clock, s; prefire : from its ignition to that, s
    drones : numbers of those that carry it, from 1; product : its name
    duration : s; clear : metres that all others stay away while it burns
    pan : where it points, clockwise from the nose of the drone, rad; tilt : up positive, rad
    """

    time: float
    drones: tuple[int, ...]
    product: str
    duration: float
    clear: float
    prefire: float
    pan: float
    tilt: float
    path: KeyPath

    @property
    def ignition(self) -> float:
        """When it is lit, s."""
        return self.time - self.prefire

    @property
    def end(self) -> float:
        """When it has burnt, s."""
        return self.time + self.duration


class Display(NamedTuple):
    """A shot of a fleet: pictures in their order.

    viewpoint : where the audience is, p_W, or None
    weight : the paper's c-bar: 0 is the best picture from the viewpoint, infinity the best volume
    timing : start is when its first picture stands; pace as of any shot
    effects : of all its lights, over those of its pictures, the last on top
    """

    id: str
    fleet: str
    pictures: tuple[Picture, ...]
    viewpoint: Vec3 | None
    weight: float
    timing: Timing
    pace: float
    path: KeyPath
    pyro: tuple[PyroCue, ...] = ()
    effects: tuple[Effect, ...] = ()

    @property
    def every_effect(self) -> tuple[Effect, ...]:
        """The effects of its pictures, then its own."""
        return (*(effect for picture in self.pictures for effect in picture.effects), *self.effects)

    @property
    def start(self) -> float | None:
        """When its first picture is to stand on the mission's clock, s, or None where that is open."""
        at = self.pictures[0].at
        return self.timing.start if at is None else at

    @property
    def start_path(self) -> KeyPath:
        """Where the mission says when it starts."""
        first = self.pictures[0]
        return (*self.path, "timing", "start") if first.at is None else (*first.path, "at")


def drone_names(fleet: Fleet) -> tuple[str, ...]:
    """Return the names of a fleet's drones, in the order of their numbers: ``swarm-001`` and on."""
    digits = len(str(len(fleet.pads)))
    return tuple(f"{fleet.name}-{i:0{digits}d}" for i in range(1, len(fleet.pads) + 1))
