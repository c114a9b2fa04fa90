"""Fleets and their pictures, resolved. Plain Python, no numpy; part of MissionIR.

World frame W, metres, radians, seconds. A fleet's drones carry a light and no camera.
"""

from collections.abc import Iterable
from typing import Literal, NamedTuple

from shotc.ir.effects import Color, Effect, Way
from shotc.ir.limits import Limits, Timing, Vec3
from shotc.ir.origin import KeyPath


class Apart(NamedTuple):
    """The separation of two drones of a fleet, centre to centre, at every instant.

    shape : "ellipsoid": (dx^2 + dy^2) / h^2 + dz^2 / v^2 >= 1 with h, v the two distances and the margin
        added to each; "cylinder": at least h apart horizontally, or v vertically
    horizontal, vertical : metres; the vertical one is usually longer because of the downwash
    margin : metres added to both, for the tracking error of a drone
    """

    shape: Literal["ellipsoid", "cylinder"]
    horizontal: float
    vertical: float
    margin: float

    @property
    def across(self) -> float:
        """Horizontal separation with the margin, metres."""
        return self.horizontal + self.margin

    @property
    def upright(self) -> float:
        """Vertical separation with the margin, metres."""
        return self.vertical + self.margin


def stricter(one: Apart, other: Apart) -> Apart:
    """Return the separation between drones of two fleets: the larger of both rules."""
    shape = one.shape if one.shape == "cylinder" else other.shape
    return Apart(shape, max(one.across, other.across), max(one.upright, other.upright), 0.0)


class FleetGroup(NamedTuple):
    """The drones of a fleet that make one group.

    of : name of the fleet; name : of the group, empty for the drones in no group
    numbers : of its drones in the fleet, from 1, rising; total : number of drones of the fleet
    """

    of: str
    name: str
    numbers: tuple[int, ...]
    total: int


class Fleet(NamedTuple):
    """Drones of one model that draw together: a fleet, or a group of a fleet.

    name : ``fleet/group`` for a group; the fleet's name for its drones in no group
    pads : p_WB of every drone at rest, in the order of their numbers
    rise : height above its pad to which each drone takes off vertically, metres
    radius : of the body sphere, m; endurance : s
    returns : the pad on which each drone lands: any of the fleet's, or its own
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
        """The word "group" for a group, "fleet" for a fleet and for its drones in no group."""
        return "group" if self.group is not None and self.group.name else "fleet"

    @property
    def words(self) -> str:
        """Its name in messages."""
        return f"{self.kind} `{self.name}`"

    @property
    def key(self) -> KeyPath:
        """Key path of its list of drones; ``path`` is that of its other properties."""
        if self.group is None or not self.group.name:
            return self.path
        return (*self.path, "groups", self.group.name)

    @property
    def numbers(self) -> tuple[int, ...]:
        """The numbers of its drones, from 1, in the order of its pads."""
        return tuple(range(1, len(self.pads) + 1)) if self.group is None else self.group.numbers


def group_name(fleet: str, group: str | None) -> str:
    """Return the name of a group of a fleet; names in the language have no slash."""
    return fleet if group is None else f"{fleet}/{group}"


def fleet_name(name: str) -> str:
    """Return the name of the fleet of a group; a fleet's name stays as it is."""
    return name.partition("/")[0]


def whole_fleets(fleets: Iterable[Fleet]) -> tuple[Fleet, ...]:
    """Return the fleets with their given groups joined."""
    parts: dict[str, list[Fleet]] = {}
    for fleet in fleets:
        parts.setdefault(fleet_name(fleet.name), []).append(fleet)
    return tuple(_joined(name, members) for name, members in parts.items())


def _joined(name: str, parts: list[Fleet]) -> Fleet:
    group = parts[0].group
    if group is None:
        return parts[0]
    pads = sorted((n, pad) for part in parts for n, pad in zip(part.numbers, part.pads, strict=True))
    numbers = tuple(number for number, _ in pads)
    whole = None if len(pads) == group.total else FleetGroup(name, "", numbers, group.total)
    return parts[0]._replace(name=name, pads=tuple(pad for _, pad in pads), group=whole)


def kept_from_cameras(separation: float, fleet: Fleet) -> float:
    """Return the separation of cameras from drones of a fleet, centre to centre, metres: the stricter rule.

    separation : of the mission's rules, metres
    """
    return max(separation, fleet.apart.across, fleet.apart.upright)


class Sphere(NamedTuple):
    """A ball."""

    centre: Vec3
    radius: float


class Box(NamedTuple):
    """A box; size : along its own east, north and up; heading : its rotation about the vertical, compass
    sense.
    """

    centre: Vec3
    size: Vec3
    heading: float


class Torus(NamedTuple):
    """A torus; radius : from its centre to the middle of the tube; tube : radius of the tube.

    heading, tilt : of its axis: with tilt 0 the torus lies flat, with a quarter turn it stands upright with
        its axis along the heading
    """

    centre: Vec3
    radius: float
    tube: float
    heading: float
    tilt: float


class Lettering(NamedTuple):
    """An upright text, readable along the heading; height : of its capital letters, metres.

    font : a font file of the mission, the name of an installed font, or None
    """

    text: str
    centre: Vec3
    height: float
    heading: float
    font: str | None


class Drawing(NamedTuple):
    """The shapes of an SVG file, upright like lettering; height : of the whole drawing, metres."""

    file: str
    centre: Vec3
    height: float
    heading: float


class Model(NamedTuple):
    """Meshes or point clouds, one a frame.

    files : names in the order of the frames; period : seconds from frame to frame, if there are several
    centre : new centre of the first frame's bounding box, None to leave it in place
    height : of the first frame after scaling, metres, or None; all frames get the same scale
    heading : rotation of all frames about the vertical through that centre, compass sense
    unit : length of one unit of the files, metres
    up : axis of the files that points up, None for that of the format
    """

    files: tuple[str, ...]
    period: float | None
    centre: Vec3 | None
    height: float | None
    heading: float
    unit: float = 1.0
    up: Literal["x", "y", "z"] | None = None


Easing = Literal["ease-in-out", "linear", "ease-in", "ease-out"]
"""The speed over a move: slow at both ends, constant, slow at its start, or slow at its end."""


class Wave(NamedTuple):
    """A move whose drones depart one after another.

    time : from the first departure to the last, s
    along : direction of the wave through a picture; by : the picture that the drones fly to, or that they
        leave
    center : p_W for `out` and `in`, None for the picture's middle
    """

    time: float
    along: Way
    by: Literal["goal", "start"]
    center: Vec3 | None


class RecordedFlight(NamedTuple):
    """The flight of a whole fleet by another tool: tracks and lights of a `.zip` or `.skyc` file."""

    file: str

    @property
    def centre(self) -> None:
        """None: a flight stays where it was recorded."""
        return


Source = Sphere | Box | Torus | Lettering | Drawing | Model | RecordedFlight


class Picture(NamedTuple):
    """One picture, or an animation of several frames.

    fill : the part of the shape that the drones fill: its volume, its surface, or (flat shapes) its edges;
        "legible" is the more readable of a text's area and edges
    color : of every light; None for the colours of the file, or white if it has none
    transition : duration of the move to it from the picture before, s; None for the fastest at this pace
    hold : duration of its last frame, s
    layers : number of layers, one behind the other, of a flat picture
    effects : of its lights, the last on top
    transition_path : straight lines, arcs, or "auto" for straight lines if their separation is proved
    easing : of the move; wave : of the departures, None for all at once
    at : mission time at which it stands, s; None if it follows from the pictures before
    name : by which shots of cameras refer to it, or None
    size : width, depth and height of the box about it that cameras frame, metres; None for that of its shape
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
    """A pyrotechnic product that burns on drones of a fleet.

    time : mission time of its effect, s; prefire : from its ignition to its effect, s
    drones : numbers of the drones that carry it, from 1; product : its name
    duration : s; clear : least distance of all other drones while it burns, metres
    pan : its direction, clockwise from the nose of the drone, rad; tilt : up positive, rad
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
        """Mission time of its ignition, s."""
        return self.time - self.prefire

    @property
    def end(self) -> float:
        """Mission time at which it has burnt out, s."""
        return self.time + self.duration


class Display(NamedTuple):
    """A shot of a fleet: a sequence of pictures.

    viewpoint : p_W of the audience, or None
    weight : the paper's c-bar: 0 is the best picture from the viewpoint, infinity the best volume
    timing : its start is the time at which the first picture stands; pace : as of any shot
    effects : of all its lights, above those of its pictures, the last on top
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
        """Required mission time at which its first picture stands, s, or None if it is free."""
        at = self.pictures[0].at
        return self.timing.start if at is None else at

    @property
    def start_path(self) -> KeyPath:
        """Key path of its start."""
        first = self.pictures[0]
        return (*self.path, "timing", "start") if first.at is None else (*first.path, "at")


def drone_names(fleet: Fleet) -> tuple[str, ...]:
    """Return the names of a fleet's drones in the order of their numbers: ``swarm-001`` and so on.

    The drones of a group keep their names and numbers of the fleet.
    """
    digits = len(str(len(fleet.pads) if fleet.group is None else fleet.group.total))
    name = fleet_name(fleet.name)
    return tuple(f"{name}-{i:0{digits}d}" for i in fleet.numbers)


def rows_of(fleet: Fleet, cue: PyroCue) -> tuple[int, ...]:
    """Return the rows, from 0, of the drones of a cue in a fleet or a group."""
    row = {number: i for i, number in enumerate(fleet.numbers)}
    return tuple(row[number] for number in cue.drones)


def spans(numbers: Iterable[int]) -> str:
    """Return rising numbers as text with ranges: ``1-20, 75``."""
    runs: list[list[int]] = []
    for number in numbers:
        if runs and number == runs[-1][1] + 1:
            runs[-1][1] = number
        else:
            runs.append([number, number])
    return ", ".join(str(a) if a == b else f"{a}-{b}" for a, b in runs)
