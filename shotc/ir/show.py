"""Fleets and what they draw, resolved. Plain Python, no numpy; part of MissionIR.

World frame W, metres, radians, seconds. A fleet's drones carry a light and no camera.
"""

from collections.abc import Iterable
from typing import Literal, NamedTuple

from shotc.ir.effects import Color, Effect, Way
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


class FleetGroup(NamedTuple):
    """Which drones of a fleet draw together, where it has groups.

    of : name of the fleet; name : of the group, empty for the drones that are in none
    numbers : of its drones in the fleet, from 1, rising; total : drones of the fleet
    """

    of: str
    name: str
    numbers: tuple[int, ...]
    total: int


class Fleet(NamedTuple):
    """Drones of one model that draw together: a fleet, or a group of one.

    name : of a group ``fleet/group``; the drones of a fleet that are in no group have the fleet's
    pads : p_WB of every drone at rest, in the order of their numbers
    rise : metres above its pad to which each drone rises, straight up, before it goes anywhere
    radius : of the body sphere, m; endurance : s
    returns : to which pad each drone comes home: any of the fleet's, or its own
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
    group: FleetGroup | None = None
    returns: Literal["any", "own"] = "any"

    @property
    def kind(self) -> str:
        """Whether it is a fleet, or the drones of one that are in no group, or a group."""
        return "group" if self.group is not None and self.group.name else "fleet"

    @property
    def words(self) -> str:
        """What messages call it."""
        return f"{self.kind} `{self.name}`"

    @property
    def key(self) -> KeyPath:
        """Where the mission says which drones it has; ``path`` is where it says all else of them."""
        if self.group is None or not self.group.name:
            return self.path
        return (*self.path, "groups", self.group.name)

    @property
    def numbers(self) -> tuple[int, ...]:
        """The numbers of its drones, from 1, in the order of its pads."""
        return tuple(range(1, len(self.pads) + 1)) if self.group is None else self.group.numbers


def group_name(fleet: str, group: str | None) -> str:
    """Return the name of a group of a fleet; names of the language have no slash."""
    return fleet if group is None else f"{fleet}/{group}"


def fleet_name(name: str) -> str:
    """Return the name of the fleet that a group is of, or its own of a fleet."""
    return name.partition("/")[0]


def whole_fleets(fleets: Iterable[Fleet]) -> tuple[Fleet, ...]:
    """Return fleets whose groups are put together again, those of them that there are."""
    parts: dict[str, list[Fleet]] = {}
    for fleet in fleets:
        parts.setdefault(fleet_name(fleet.name), []).append(fleet)
    return tuple(_joined(name, found) for name, found in parts.items())


def _joined(name: str, parts: list[Fleet]) -> Fleet:
    group = parts[0].group
    if group is None:
        return parts[0]
    pads = sorted((n, pad) for part in parts for n, pad in zip(part.numbers, part.pads, strict=True))
    numbers = tuple(number for number, _ in pads)
    whole = None if len(pads) == group.total else FleetGroup(name, "", numbers, group.total)
    return parts[0]._replace(name=name, pads=tuple(pad for _, pad in pads), group=whole)


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


class Wave(NamedTuple):
    """Drones that set out one after another.

    time : from when the first sets out to when the last does, s
    along : where it goes through the picture that they come to, or through the one that they leave (by)
    center : p_W from which `out` and `in` count, None for the picture's middle
    """

    time: float
    along: Way
    by: Literal["goal", "start"]
    center: Vec3 | None


class RecordedFlight(NamedTuple):
    """The flight of a whole fleet as another tool made it: tracks and lights of a `.zip` or a `.skyc`."""

    file: str

    @property
    def centre(self) -> None:
        """Return None: a flight stays where it was recorded."""
        return


Source = Sphere | Box | Torus | Lettering | Drawing | Model | RecordedFlight


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
    proved; easing : how their speed runs; wave : in which they set out, None for all at once
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
    wave: Wave | None = None


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
    """Return the names of a fleet's drones, in the order of their numbers: ``swarm-001`` and on.

    Those of a group have the names and the numbers of the fleet.
    """
    digits = len(str(len(fleet.pads) if fleet.group is None else fleet.group.total))
    name = fleet_name(fleet.name)
    return tuple(f"{name}-{i:0{digits}d}" for i in fleet.numbers)


def rows_of(fleet: Fleet, cue: PyroCue) -> tuple[int, ...]:
    """Return the rows, from 0, of the drones of a fleet or a group that a cue is for."""
    row = {number: i for i, number in enumerate(fleet.numbers)}
    return tuple(row[number] for number in cue.drones)


def spans(numbers: Iterable[int]) -> str:
    """Write numbers that rise as ranges: ``1-20, 75``."""
    runs: list[list[int]] = []
    for number in numbers:
        if runs and number == runs[-1][1] + 1:
            runs[-1][1] = number
        else:
            runs.append([number, number])
    return ", ".join(str(a) if a == b else f"{a}-{b}" for a, b in runs)
