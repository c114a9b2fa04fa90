"""The interface of shot kinds: a model of the parameters, and a function from them to keyframes.

The function reads a ``Scene`` and returns an ``Expansion``. Other packages add kinds by an entry point in the
group ``shotc.kinds`` that names a ``Kind``; our kinds use the same way.
"""

from collections.abc import Callable, Collection, Iterable, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple, Self

from shotc.diag.model import Diagnostic
from shotc.geom.camera import yaw_of
from shotc.geom.geodetic import above_ground
from shotc.ir.drone import Drone
from shotc.ir.ground import Above, GroundHeight, counted_from, flat
from shotc.ir.limits import Vec2, Vec3
from shotc.ir.mission import (
    Beside,
    Composition,
    Deferred,
    GeoOrigin,
    Ideal,
    Keyframe,
    Subject,
)
from shotc.ir.music import Music
from shotc.ir.origin import KeyPath, OriginMap
from shotc.ir.rules import Rules
from shotc.ir.target import Target
from shotc.spec.fields import Geodetic, Relative
from shotc.spec.heights import AboveGround
from shotc.spec.places import Spot
from shotc.spec.shot import ShotBase
from shotc.spec.words import nearest

if TYPE_CHECKING:  # missions of cameras do not load these
    from typing import Protocol

    from shotc.ir.show import Display
    from shotc.kinds.files import FileFault

    class Aimed(Protocol):
        """A model that aims a camera by `look_at`, or by `heading` and `pitch`."""

        @property
        def look_at(self) -> "str | Place | None":
            """The name of a target, or a position."""

        @property
        def heading(self) -> float | None:
            """Compass heading, rad."""

        @property
        def pitch(self) -> float | None:
            """Elevation, rad."""


API_VERSION = 1
OURS = "shotc"
OWN = "target"  # reference of a place that is relative to the target of its shot
STILL_S = 5.0  # default duration of a still camera's shot, seconds

Place = Spot | Geodetic


class Stand(NamedTuple):
    """The position of a camera in W, and the moving target that it is relative to, if there is one."""

    at: Vec3
    beside: Beside | None = None


Part = Keyframe | Diagnostic | Deferred
Aim = tuple[Vec2 | Vec3 | None, str | None]


class Expansion(NamedTuple):
    """The expansion of a shot: keyframes in the order of flight, or the diagnostics that prevent it.

    ideal, subjects : instead of keyframes, for a moving target
    duration : default duration of such a shot, seconds
    display : instead of all these, for a fleet
    """

    keyframes: tuple[Keyframe, ...] = ()
    diagnostics: tuple[Diagnostic, ...] = ()
    deferred: tuple[Deferred, ...] = ()
    ideal: Ideal | None = None
    subjects: tuple[Subject, ...] = ()
    duration: float | None = None
    display: "Display | None" = None

    @classmethod
    def of(cls, parts: Iterable[Part]) -> Self:
        """Return the expansion of parts.

        It has keyframes only if there are no diagnostics and deferred parts.
        """
        items = tuple(parts)
        diagnostics = tuple(p for p in items if isinstance(p, Diagnostic))
        deferred = tuple(p for p in items if isinstance(p, Deferred))
        keyframes = tuple(p for p in items if isinstance(p, Keyframe))
        return cls(() if diagnostics or deferred else keyframes, diagnostics, deferred)


class Scene(NamedTuple):
    """The inputs for the expansion of one shot.

    drone : of the shot; rules : of the mission
    composition : admissible places of the shot's target
    targets : by name; None for a target with an unusable track
    path : of the shot in the mission; origins : spans of the mission file
    origin : geographic origin of W, if the mission has one; geodetic positions need it
    read : returns the bytes of a file that the mission names at a key path, or a diagnostic
    match : returns the names of the files that match a pattern at a key path, 2 before 10, or a diagnostic
    pace : of the mission's rules; fleets : the names of their groups, by name
    ground : z of the ground at x and y, metres
    music : of the mission, or None
    """

    drone: Drone
    rules: Rules
    composition: Composition
    targets: Mapping[str, Target | None]
    path: KeyPath
    origins: OriginMap
    origin: GeoOrigin | None
    read: Callable[[str, KeyPath], bytes | Diagnostic]
    match: Callable[[str, KeyPath], tuple[str, ...] | Diagnostic]
    pace: float
    fleets: Mapping[str, Collection[str]] = {}
    ground: GroundHeight = flat
    music: Music | None = None

    def subject(self, name: str, *path: str | int) -> Target | Diagnostic | Deferred:
        """Return the target of that name; path : of the name in the text, below the shot."""
        where = (*self.path, *path)
        if name not in self.targets:
            return unknown_target(self.origins, where, name, self.targets)
        return self.targets[name] or Deferred(
            "a target that cannot be used", where, "correct what is wrong with it"
        )

    def stand(
        self, shot: ShotBase, at: "Place | Relative", *path: str | int
    ) -> Stand | Diagnostic | Deferred:
        """Return the position of a camera that is written at ``path`` below the shot.

        A place relative to a standing target becomes a place of W.
        """
        if not isinstance(at, Relative):
            return Stand(self.place(at))
        name = shot.target if at.from_ == OWN and OWN not in self.targets else at.from_
        if name is None:
            message = "the place counts from the target of a shot that has none"
            return self.fault(
                "K016", message, "name it, as `from: NAME`, or give the shot a `target`", *path, "from"
            )
        target = self.subject(name, *path, "from")
        if not isinstance(target, Target):
            return target
        if target.track is None and at.turn is not None:
            message = f"the place turns with the way that `{name}` goes, but `{name}` stands"
            return self.fault(
                "K017", message, "leave `turn` out: the offset is [east, north, up] then", *path, "turn"
            )
        (x, y, z), (east, north, up) = target.foot, at.offset
        place = (x + east, y + north, z + up)
        if target.track is None:
            return Stand(place)
        return Stand(place, Beside(name, at.offset, turns=at.turn is not None))

    def aim(
        self, shot: ShotBase, aimed: "Aimed", *path: str | int, own: str | None = None
    ) -> Aim | Diagnostic | Deferred:
        """Return (aim, target) of a camera by ``aimed``, which is written at ``path`` below the shot.

        own : the target that is written there; it replaces the shot's target

        If `look_at` names a target, that target is framed. Otherwise the camera looks at a point, or has a
        heading and a pitch, and the shot's target, if there is one, is framed.
        """
        if isinstance(aimed.look_at, str):
            aimed_at = self.subject(aimed.look_at, *path, "look_at")
            return (None, aimed.look_at) if isinstance(aimed_at, Target) else aimed_at
        framed, where = (shot.target, ()) if own is None else (own, path)
        if framed is not None:
            subject = self.subject(framed, *where, "target")
            if not isinstance(subject, Target):
                return subject
        if aimed.look_at is not None:
            return (self.place(aimed.look_at), framed)
        if aimed.heading is None or aimed.pitch is None:
            return (None, framed)
        return ((yaw_of(aimed.heading), aimed.pitch), framed)

    def framed(self, shot: ShotBase, name: str) -> Subject:
        """Return a target as the subject of a shot on its own clock."""
        key = "target" if shot.target == name else "look_at"
        return Subject(name, self.composition, shot.size, None, (*self.path, key))

    def place(self, position: Place) -> Vec3:
        """Return a position as a point of W; a mission with geodetic positions has an origin."""
        return placed(self.origin, self.ground, position)

    def raised(self, p: Vec3, target: Target, above: Above | None) -> Vec3:
        """Return the point of W for a point whose height is relative to ``above``, by default the target's
        foot.
        """
        return (p[0], p[1], p[2] + self._base(target, above, p))

    def height_of(self, target: Target, above: Above | None) -> float:
        """Return the height of a target's centre over the reference of a shot's heights, metres."""
        return target.centre[2] - self._base(target, above, target.centre)

    def _base(self, target: Target, above: Above | None, p: Vec3) -> float:
        """Return z of the reference of heights at a point, metres."""
        return counted_from(above or "target", self.ground, (p[0], p[1]), target.foot[2])

    def keyframe(self, at: Vec3, target: str | None, **changes: Any) -> Keyframe:
        """Return a keyframe of a camera at ``at`` that looks at ``target``, without a hold.

        It is a generated keyframe, from which refinement may deviate, unless ``changes`` has ``placed=True``.
        changes : other values of fields
        """
        values: dict[str, Any] = {
            "aim": None,
            "composition": self.composition,
            "hfov": self.drone.hfov,
            "hold": 0.0,
            "time": None,
            "placed": False,
            "path": (*self.path, "kind"),
        }
        return Keyframe(at=at, target=target, **{**values, **changes})

    def written(self) -> tuple[str, ...]:
        """Return the keys of the shot in the mission's text, in order."""
        return tuple(str(path[-1]) for path in self.origins.keys if path[:-1] == self.path)

    def fault(
        self, code: str, message: str, help: str, *path: str | int, notes: tuple[str, ...] = ()
    ) -> Diagnostic:
        """Return a diagnostic on the value at ``path`` below the shot."""
        return Diagnostic(code, message, (self.origins.value((*self.path, *path)),), notes, help)

    def lasting(self, code: str, message: str, *path: str | int) -> Diagnostic:
        """Return the diagnostic of a shot without a required duration, at its timing if there is one."""
        timing = (*self.path, "timing")
        if timing not in self.origins.values:
            return self.fault(code, message, "add `timing: {duration: ...}`", *path)
        others = any((*timing, key) in self.origins.values for key in ("start", "after"))
        help_ = "add `duration: ...` to `timing`" if others else "write `timing: {duration: ...}`"
        return self.fault(code, message, help_, "timing")

    def bad_file(self, name: str, wrong: "FileFault", *path: str | int) -> Diagnostic:
        """Return the diagnostic of an unusable file, which is named at ``path`` below the shot."""
        return bad_file(self.origins, (*self.path, *path), name, wrong)


class Kind(NamedTuple):
    """A shot kind.

    name : value of `kind:`; summary : one line for listings
    model : of its parameters, with ``kind: Literal[name]``
    expand : takes a shot of that model and its scene
    api : version of this interface that the kind is written for
    package : the distribution that registers it; set when the kind is loaded
    """

    name: str
    summary: str
    model: type[ShotBase]
    expand: Callable[[Any, Scene], Expansion]
    api: int = API_VERSION
    package: str = OURS

    @property
    def foreign(self) -> bool:
        """Whether it belongs to another package, which is then responsible for its faults."""
        return self.package != OURS


def placed(origin: GeoOrigin | None, ground: GroundHeight, position: Place) -> Vec3:
    """Return a position as a point of W; its height is z, or above the ground there."""
    if isinstance(position, Geodetic):
        assert origin is not None
        base, height = (origin.lat_deg, origin.lon_deg, origin.alt), position.height
        over = height.height if isinstance(height, AboveGround) else height
        x, y, z = above_ground((position.lat, position.lon, over), base)
    else:
        x, y, height = position
        z = height.height if isinstance(height, AboveGround) else height
    return (x, y, z + ground(x, y)) if isinstance(height, AboveGround) else (x, y, z)


def counts_from_ground(position: Place) -> bool:
    """Return whether the height of a position, written or not, is above the ground there."""
    height = position.height if isinstance(position, Geodetic) else position[2]
    return isinstance(height, AboveGround)


def stands(position: Place) -> bool:
    """Return whether a position has no height, so that a body there stands on the ground."""
    height = position.height if isinstance(position, Geodetic) else position[2]
    return isinstance(height, AboveGround) and height.stands


def unknown_target(origins: OriginMap, path: KeyPath, name: str, known: Mapping[str, object]) -> Diagnostic:
    """Return the diagnostic of a target name that the mission does not define."""
    help_ = nearest(name, known) if known else "define it under `targets`"
    return Diagnostic("N001", f"unknown target `{name}`", (origins.value(path),), help=help_)


def bad_file(origins: OriginMap, path: KeyPath, name: str, wrong: "FileFault") -> Diagnostic:
    """Return the diagnostic of an unusable file, at the line that names it."""
    where = f"{name}, line {wrong.line}" if wrong.line is not None else name
    return Diagnostic(
        "N009", f"cannot use `{name}`: {wrong.message}", (origins.value(path),), (where,), wrong.help
    )
