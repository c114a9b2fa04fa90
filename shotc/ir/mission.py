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
from shotc.ir.setpoints import Asked, Setpoint, ViewAngles, asked_at
from shotc.ir.smoothing import NORMAL_S
from shotc.ir.source import MissionSource
from shotc.ir.target import Target

if TYPE_CHECKING:  # a mission of cameras loads none of it
    from shotc.ir.obstacle_mesh import ObstacleMesh
    from shotc.ir.show import Display, Fleet
    from shotc.ir.terrain import Terrain

ELSEWHERE_IN_PLANS = frozenset(
    {"origins", "files", "source", "terrain", "meshes", "wind_toward", "rehearsal", "music"}
)
"""Fields of a mission that a plan does not hold as such: they are made of its text and its files."""

OffsetPoints = tuple[tuple[float, Vec3], ...]  # (share of the shot's time, metres)


class GeoOrigin(NamedTuple):
    """The WGS84 place of W's origin.

    lat_deg, lon_deg : degrees
    alt : metres above mean sea level
    """

    lat_deg: float
    lon_deg: float
    alt: float


class Zone(NamedTuple):
    """A named volume that the body sphere stays out of, or inside."""

    name: str
    keep: Literal["in", "out"]
    solid: Solid
    path: KeyPath


class Composition(NamedTuple):
    """Screen positions a target may take: points, lines, or wherever the user put it (``keep``).

    Without any of them the camera keeps its own angles and the target is only watched.

    points : (u, v) in [-1, 1]^2, u right, v up
    u_lines, v_lines : vertical lines u = c, horizontal lines v = c
    last : points that are taken only where the whole target fits at no other place of the set
    """

    name: str
    points: tuple[Vec2, ...] = ()
    u_lines: tuple[float, ...] = ()
    v_lines: tuple[float, ...] = ()
    keep: bool = False
    last: tuple[Vec2, ...] = ()

    @property
    def watches(self) -> bool:
        """Whether nothing is asked of where the target is."""
        return not (self.points or self.u_lines or self.v_lines or self.keep)


class Beside(NamedTuple):
    """A place that counts from a target.

    offset : from its foot, the lowest point of its axis, metres: East, North and Up, or, where it turns with
        the way that the target goes, ahead of it, to the left of it and up
    above : what Up counts from
    """

    target: str
    offset: Vec3
    turns: bool = False
    above: Above = "target"


class DrawnBox(NamedTuple):
    """A box that an author drew on the screen, half frames: u to the right, v up."""

    u_min: float
    u_max: float
    v_min: float
    v_max: float


class Keyframe(NamedTuple):
    """Where the camera is to be and what it looks at, before composition.

    at : p_WC; where it counts from a target that moves, as that is for a shot that begins as early as it may
    aim : (yaw, pitch) as the user wrote them, rad, camera yaw counter-clockwise from East; a point
        of W to look at; or None to look at ``target``
    target : name of the subject that is framed here, if any
    composition : the set this keyframe's target is placed on (shot's or own)
    hold : seconds at rest; time : seconds from the shot's start, if fixed
    placed : True where the user gave the position (it binds), False where a kind generated it
    heading : compass heading as the user wrote it, rad, whole turns included; None where none is written
    beside : what the place counts from, or None for a place of W
    box : on screen, as the author framed it, round what is meant; None where none is drawn
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
        """Whether a box shows what is meant, and nobody has said what that is."""
        return self.box is not None and self.target is None


class Near(NamedTuple):
    """A pose that the camera of a framing stays near as far as the picture lets it (viewpoint Eq. 10).

    at : place of W, as of ``Keyframe``; beside : the moving target that it counts from, or None
    yaw, pitch : of the camera, rad, each None where it is free
    """

    at: Vec3
    beside: Beside | None = None
    yaw: float | None = None
    pitch: float | None = None


class Ideal(NamedTuple):
    """Where the camera of a shot on its own clock would be, if nothing stood against it.

    frame : what offsets count from. "world": W's origin. "target": the target's axis, East and North of
        it, and up from what ``above`` says. "heading": the same, ahead of the way the target faces and to
        the left of it.
        "about": the target's centre, along W's axes. "keyframes": points are the places of the shot's
        keyframes and when they are reached, and ``ir.keyed`` says where the camera is between them
    target : its name, None in the world and of keyframes
    points : (share of the shot's time, offset in metres), shares rising from 0 to 1; even between them
    placed : True where the user gave the positions, False where a kind generated them; of keyframes, whether
        the ways between them are given
    aim : (yaw, pitch) that the camera keeps, rad, or None where it follows the shot's subjects
    framed : True where the points are found from how the subjects are to appear (``ir.framed``), for the
        time at which the shot begins, as far as that is known
    above : what up counts from in the frames "target" and "heading"
    near : the pose near which a framing's camera stays
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
    """A target that a shot on its own clock frames, the first one foremost.

    composition : the set of places its centre may have on screen
    size : projected height over frame height to aim for, above 1 where it is to be cropped; or None
    view : (azimuth as a compass bearing from it to the camera, elevation), rad, each None where it is free,
        or None
    setpoints : what of these changes over the shot, in the order of their times
    """

    target: str
    composition: Composition
    size: float | None
    view: ViewAngles | None
    path: KeyPath
    setpoints: tuple[Setpoint, ...] = ()

    def asked(self, time: float) -> Asked:
        """Return how it is to appear at a time of its shot, seconds from the first frame."""
        points = self.composition.points
        first = Asked(points[0] if len(points) == 1 else None, self.size, self.view)
        return asked_at(first, self.setpoints, time)


class Shot(NamedTuple):
    """One shot of one drone: keyframes, or an ideal where its targets move.

    pace : share of the limits used where the duration is not given, 0 to 1
    subject : the target as the shot names it, or None
    ideal : of a shot on its own clock, whose timing has a duration; it has no keyframes then, unless they are
        what the ideal is made of
    subjects : whom it frames then
    size : that its target is to have, as in Subject, or None
    allow : what of ``spec.allow`` it may do untold, by name, by its own word or by that of the rules
    above : what the altitude of its camera counts from; None where it has none
    smoothing : seconds; see ``ir.smoothing``
    focus : name of the target that the lens is focused on, or a depth, m; None for the one that is framed
    photos : taken in place of a film, or None
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

    help : what the author does instead
    """

    feature: str
    path: KeyPath
    help: str


class MissionIR(NamedTuple):
    """The whole mission.

    shots : in the order they are written
    rate : output samples a second, Hz
    emit : emitters the mission asks for
    source_sha256 : of the mission file's bytes, hexadecimal
    deferred : what only a later version can plan; planning refuses it, checking does not
    displays : the shots of fleets, in the order they are written
    files : (name, bytes) of the files that displays draw; no plan carries them
    terrain : the ground where it is not the plane z = 0; a plan carries the file that it is made of
    meshes : scenes and buildings, which stand
    groups : targets that are several bodies in one picture; these are among the targets
    source : what the mission was lowered from
    wind : its speed, m/s; wind_toward : yaw of the direction in which it blows, rad, None where nobody says
    rehearsal : what rehearsals are asked; no pass reads it
    music : what a show is flown to, or None
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
        """The drones that film nothing: they stand on their pads all the time."""
        filming = {shot.drone for shot in self.shots}
        return tuple(drone for drone in self.drones if drone.name not in filming)

    @property
    def opaque_zones(self) -> tuple[Zone, ...]:
        """The keep-out zones that hide what is behind them: those of the world.

        The airspace of a show, which cameras know as zones of the fleet, is air, and holds what they film.
        """
        return tuple(zone for zone in self.zones if zone.keep == "out" and zone.path[0] == "world")

    @property
    def wind_taken(self) -> float:
        """The speed, m/s, that a wind from any side takes off what drones fly; 0 where it is known whence."""
        return self.wind if self.wind_toward is None else 0.0

    def ground(self, x: float, y: float) -> float:
        """Return z of the ground at a place, metres; beyond terrain it is taken for the plane z = 0."""
        return flat(x, y) if self.terrain is None else self.terrain.z(x, y)

    def lowest(self, place: Vec3, radius: float) -> float:
        """Return the least z of the centre of a body over a place, metres; radius : of the body."""
        return self.ground(place[0], place[1]) + self.rules.over_ground(radius)

    def base(self, above: Above, place: Vec2, target: Target, t: float) -> float:
        """Return z of what heights at a place count from where a target is at a mission time, metres."""
        return counted_from(above, self.ground, place, target.foot_at(t)[2])

    def drone(self, name: str) -> Drone:
        """Return the drone of that name; KeyError if there is none."""
        return next_named(self.drones, name)

    def target(self, name: str) -> Target:
        """Return the target of that name, be it one body or a group; KeyError if there is none."""
        return next_named(self.every_target, name)

    @property
    def every_target(self) -> tuple[Target, ...]:
        """The targets that are bodies, and the groups of them."""
        return (*self.targets, *self.groups)

    def one_with(self, name: str) -> frozenset[str]:
        """Return the names of the bodies that make one picture with a target, its own among them."""
        own = self.parts_of(name)
        return frozenset(own).union(*(g.parts for g in self.groups if not set(own).isdisjoint(g.parts)))

    def parts_of(self, name: str) -> tuple[str, ...]:
        """Return the names of the bodies of a target: its own, or those of a group."""
        return self.target(name).parts or (name,)

    def shot(self, name: str | None) -> "Shot":
        """Return the shot of that id; KeyError if there is none."""
        for shot in self.shots:
            if shot.id == name:
                return shot
        raise KeyError(name)

    def fleet(self, name: str) -> "Fleet":
        """Return the fleet of that name; KeyError if there is none."""
        return next_named(self.fleets, name)

    def display(self, name: str) -> "Display":
        """Return the display of that id; KeyError if there is none."""
        for display in self.displays:
            if display.id == name:
                return display
        raise KeyError(name)


def frozen(mission: MissionIR, time: float) -> MissionIR:
    """Return the mission with every target standing where it is at a time, for pictures of that moment."""
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
    """Return the first item called ``name``; KeyError if there is none."""
    for item in items:
        if item.name == name:
            return item
    raise KeyError(name)
