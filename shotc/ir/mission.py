"""MissionIR: the mission with every name, preset, unit and kind resolved. Plain Python, no numpy.

World frame W (East, North, Up, metres), radians, seconds; ``path`` is where an element stands in
the mission file (see ``OriginMap``).
"""

from typing import TYPE_CHECKING, Literal, NamedTuple, TypeVar

from shotc.geom.solids import Solid
from shotc.ir.drone import Drone
from shotc.ir.ground import Above, counted_from, flat
from shotc.ir.limits import Timing, Vec2, Vec3
from shotc.ir.music import Music
from shotc.ir.origin import KeyPath, OriginMap
from shotc.ir.photos import Photos
from shotc.ir.promise import Promise
from shotc.ir.rehearsal import Rehearsal
from shotc.ir.rules import Rules
from shotc.ir.setpoints import Asked, Setpoint, ViewAngles, required_at
from shotc.ir.smoothing import NORMAL_S
from shotc.ir.source import MissionSource
from shotc.ir.target import Target

if TYPE_CHECKING:  # a mission without fleets, meshes and terrain does not load them
    from shotc.ir.obstacle_mesh import ObstacleMesh
    from shotc.ir.show import Display, Fleet
    from shotc.ir.terrain import Terrain

ELSEWHERE_IN_PLANS = frozenset(
    {"origins", "files", "source", "terrain", "meshes", "wind_toward", "rehearsal", "music"}
)
"""Fields of a mission that a plan does not store: they follow from its text and its files."""

OffsetPoints = tuple[tuple[float, Vec3], ...]  # (share of the shot's time, metres)


class GeoOrigin(NamedTuple):
    """The WGS84 position of W's origin.

    lat_deg, lon_deg : degrees
    alt : metres above mean sea level
    """

    lat_deg: float
    lon_deg: float
    alt: float


class Zone(NamedTuple):
    """A named volume; the body sphere stays outside or inside of it."""

    name: str
    keep: Literal["in", "out"]
    solid: Solid
    path: KeyPath


class Composition(NamedTuple):
    """The admissible places of a target on screen: points, lines, or by the user's angles (``keep``).

    Without any of them the camera keeps its own angles and the target has no reference.

    points : (u, v) in [-1, 1]^2, u right, v up
    u_lines, v_lines : vertical lines u = c, horizontal lines v = c
    last : points that are used only if the whole target fits at no other place of the set
    """

    name: str
    points: tuple[Vec2, ...] = ()
    u_lines: tuple[float, ...] = ()
    v_lines: tuple[float, ...] = ()
    keep: bool = False
    last: tuple[Vec2, ...] = ()

    @property
    def watches(self) -> bool:
        """Whether the target may be anywhere on screen."""
        return not (self.points or self.u_lines or self.v_lines or self.keep)


class Beside(NamedTuple):
    """A place relative to a target.

    offset : from the target's foot (the lowest point of its axis), metres: East, North and Up, or, if
        ``turns``, ahead, left and up relative to the target's heading
    turns : whether it turns with the target's heading
    above : reference of Up
    """

    target: str
    offset: Vec3
    turns: bool = False
    above: Above = "target"


class DrawnBox(NamedTuple):
    """A box that the author drew on the screen, half frames: u to the right, v up."""

    u_min: float
    u_max: float
    v_min: float
    v_max: float


class Keyframe(NamedTuple):
    """The position of the camera and its aim, before composition.

    at : p_WC; beside a moving target, that for the earliest possible start of the shot
    aim : (yaw, pitch) as the user wrote them, rad, camera yaw counter-clockwise from East; a point
        of W to look at; or None to look at ``target``
    target : name of the subject that is framed here, if any
    composition : the set of places for this keyframe's target (the shot's or its own)
    hold : seconds at rest; time : seconds from the shot's start, if fixed
    placed : True if the user gave the position (it must be met), False if a kind generated it
    heading : compass heading as the user wrote it, rad, with whole turns; None if none is written
    beside : the target that the place is relative to, or None for a place of W
    box : drawn on screen round the intended subject; None without one
    """

    at: Vec3
    aim: Vec2 | Vec3 | None
    target: str | None
    composition: Composition
    hfov: float
    hold: float
    time: float | None
    placed: bool
    path: KeyPath
    heading: float | None = None
    beside: Beside | None = None
    box: DrawnBox | None = None

    @property
    def unidentified(self) -> bool:
        """Whether it has a box but no named target yet."""
        return self.box is not None and self.target is None


class Near(NamedTuple):
    """The preferred pose of a framing's camera, kept as far as the picture allows (viewpoint Eq. 10).

    at : p_WC, as in ``Keyframe``; beside : the moving target that it is relative to, or None
    yaw, pitch : of the camera, rad, each None if it is free
    """

    at: Vec3
    beside: Beside | None = None
    yaw: float | None = None
    pitch: float | None = None


class Ideal(NamedTuple):
    """The position of the camera of a shot on its own clock, without limits and obstacles.

    frame : origin and axes of the offsets. "world": W. "target": the target's axis, East and North of it, and
        up from ``above``. "heading": the same, ahead and to the left relative to the target's heading.
        "about": the target's centre, along W's axes. "keyframes": points are the places and times of the
        shot's keyframes, and ``ir.keyed`` interpolates them
    target : its name; None in the frames "world" and "keyframes"
    points : (share of the shot's time, offset in metres), shares rising from 0 to 1; linear between them
    placed : True if the user gave the positions, False if a kind generated them; for keyframes, whether the
        ways between them are given
    aim : constant (yaw, pitch) of the camera, rad, or None if it follows the shot's subjects
    framed : True if the points follow from the required appearance of the subjects (``ir.framed``), for the
        start of the shot as far as it is known
    above : reference of up in the frames "target" and "heading"
    near : the preferred pose of a framing's camera
    """

    frame: Literal["world", "target", "heading", "about", "keyframes"]
    target: str | None
    points: OffsetPoints
    placed: bool = False
    aim: Vec2 | None = None
    framed: bool = False
    above: Above = "target"
    near: Near | None = None


class Subject(NamedTuple):
    """A target that a shot on its own clock frames; the first subject of a shot is the most important.

    composition : the set of admissible places of its centre on screen
    size : required projected height over frame height, above 1 if it is to be cropped; or None
    view : (azimuth as a compass bearing from it to the camera, elevation), rad, each None if it is free; or
        None
    setpoints : changes of these over the shot, in the order of their times
    """

    target: str
    composition: Composition
    size: float | None
    view: ViewAngles | None
    path: KeyPath
    setpoints: tuple[Setpoint, ...] = ()

    def asked(self, time: float) -> Asked:
        """Return its required appearance at a time of its shot, seconds from the first frame."""
        points = self.composition.points
        first = Asked(points[0] if len(points) == 1 else None, self.size, self.view)
        return required_at(first, self.setpoints, time)


class Shot(NamedTuple):
    """One shot of one drone, with keyframes, or with an ideal if its targets move.

    pace : share of the limits that is used if the duration is free, 0 to 1
    subject : the target as the shot names it, or None
    ideal : of a shot on its own clock, whose timing has a duration; such a shot has keyframes only if they
        define the ideal
    subjects : framed targets of a shot on its own clock
    size : required size of its target, as in Subject, or None
    allow : names of ``spec.allow`` that the shot or the rules allow without a warning
    above : reference of the altitude of its camera; None if it has none
    smoothing : seconds; see ``ir.smoothing``
    focus : name of the target that the lens is focused on, or a depth, m; None for the framed target
    photos : taken instead of a film, or None
    """

    id: str
    kind: str
    drone: str
    subject: str | None
    keyframes: tuple[Keyframe, ...]
    timing: Timing
    pace: float
    promise: Promise
    refine_optional: bool
    path: KeyPath
    ideal: Ideal | None = None
    subjects: tuple[Subject, ...] = ()
    size: float | None = None
    allow: tuple[str, ...] = ()
    above: Above | None = None
    smoothing: float = NORMAL_S
    focus: str | float | None = None
    photos: Photos | None = None

    @property
    def smoother(self) -> float:
        """Its smoothing over the normal one."""
        return self.smoothing / NORMAL_S


class Deferred(NamedTuple):
    """A part of the language that is checked but cannot be planned yet.

    help : advice to the author
    """

    feature: str
    path: KeyPath
    help: str


class MissionIR(NamedTuple):
    """The whole mission.

    shots : in the order of the text
    rate : output samples a second, Hz
    emit : names of the requested emitters
    source_sha256 : of the mission file's bytes, hexadecimal
    deferred : parts that this version cannot plan; planning refuses them, checking does not
    displays : the shots of fleets, in the order of the text
    files : (name, bytes) of the files that displays draw; a plan does not store them
    terrain : the ground if it is not the plane z = 0; a plan stores the file that it is made of
    meshes : scenes and buildings
    groups : targets of several bodies in one picture; the bodies are in ``targets``
    source : the inputs of the lowering
    wind : its speed, m/s; wind_toward : yaw of the direction in which it blows, rad, None if unknown
    rehearsal : requirements on rehearsals; no pass reads them
    music : of a show, or None
    """

    name: str
    origin: GeoOrigin | None
    wind: float
    zones: tuple[Zone, ...]
    targets: tuple[Target, ...]
    drones: tuple[Drone, ...]
    rules: Rules
    shots: tuple[Shot, ...]
    rate: float
    emit: tuple[str, ...]
    source_sha256: str
    deferred: tuple[Deferred, ...]
    origins: OriginMap
    fleets: "tuple[Fleet, ...]" = ()
    displays: "tuple[Display, ...]" = ()
    files: tuple[tuple[str, bytes], ...] = ()
    source: MissionSource = MissionSource()
    terrain: "Terrain | None" = None
    meshes: "tuple[ObstacleMesh, ...]" = ()
    groups: tuple[Target, ...] = ()
    wind_toward: float | None = None
    rehearsal: Rehearsal | None = None
    music: Music | None = None

    @property
    def parked(self) -> tuple[Drone, ...]:
        """The drones without shots; they stand on their pads all the time."""
        filming = {shot.drone for shot in self.shots}
        return tuple(drone for drone in self.drones if drone.name not in filming)

    @property
    def opaque_zones(self) -> tuple[Zone, ...]:
        """The keep-out zones that are occluders: those of the world.

        The airspace of a show is a zone of a fleet for its cameras. It is transparent, because the cameras
        film what is in it.
        """
        return tuple(zone for zone in self.zones if zone.keep == "out" and zone.path[0] == "world")

    @property
    def wind_taken(self) -> float:
        """The speed of a wind of unknown direction, m/s, which reduces all airspeeds; 0 if it is known."""
        return self.wind if self.wind_toward is None else 0.0

    def ground(self, x: float, y: float) -> float:
        """Return z of the ground at a place, metres; beyond the terrain it is 0."""
        return flat(x, y) if self.terrain is None else self.terrain.z(x, y)

    def lowest(self, place: Vec3, radius: float) -> float:
        """Return the least z of a body's centre over a place, metres; radius : of the body, metres."""
        return self.ground(place[0], place[1]) + self.rules.over_ground(radius)

    def base(self, above: Above, place: Vec2, target: Target, t: float) -> float:
        """Return z of the height reference at a place, for the target's position at a mission time, m."""
        return counted_from(above, self.ground, place, target.foot_at(t)[2])

    def drone(self, name: str) -> Drone:
        """Return the drone of that name; raise KeyError if there is none."""
        return next_named(self.drones, name)

    def target(self, name: str) -> Target:
        """Return the target of that name, one body or a group; raise KeyError if there is none."""
        return next_named(self.every_target, name)

    @property
    def every_target(self) -> tuple[Target, ...]:
        """The targets that are bodies, and the groups of them."""
        return (*self.targets, *self.groups)

    def one_with(self, name: str) -> frozenset[str]:
        """Return the names of the bodies that are in one group with a target, its own included."""
        own = self.parts_of(name)
        return frozenset(own).union(*(g.parts for g in self.groups if not set(own).isdisjoint(g.parts)))

    def parts_of(self, name: str) -> tuple[str, ...]:
        """Return the names of the bodies of a target: its own, or those of the group."""
        return self.target(name).parts or (name,)

    def shot(self, name: str | None) -> "Shot":
        """Return the shot of that id; raise KeyError if there is none."""
        for shot in self.shots:
            if shot.id == name:
                return shot
        raise KeyError(name)

    def fleet(self, name: str) -> "Fleet":
        """Return the fleet of that name; raise KeyError if there is none."""
        return next_named(self.fleets, name)

    def display(self, name: str) -> "Display":
        """Return the display of that id; raise KeyError if there is none."""
        for display in self.displays:
            if display.id == name:
                return display
        raise KeyError(name)


def frozen(mission: MissionIR, time: float) -> MissionIR:
    """Return the mission with every target standing at its position at a time, for pictures of that time."""
    if all(target.track is None for target in mission.targets):
        return mission
    return mission._replace(
        targets=tuple(
            target._replace(centre=target.at(time), shape=target.shape_at(time), track=None)
            for target in mission.targets
        )
    )


_Named = TypeVar("_Named", Drone, Target, "Fleet")


def next_named(items: tuple[_Named, ...], name: str) -> _Named:
    """Return the first item of that name; raise KeyError if there is none."""
    for item in items:
        if item.name == name:
            return item
    raise KeyError(name)
