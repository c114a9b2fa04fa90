"""Follow-path: the camera flies along points of the mission, or of a CSV or GPX file."""

from dataclasses import dataclass
from itertools import accumulate, pairwise
from math import atan2, dist, hypot
from typing import Annotated, ClassVar, Literal

from pydantic import Field

from shotc.diag.model import Diagnostic
from shotc.geom.camera import yaw_of
from shotc.ir.limits import Vec2, Vec3
from shotc.ir.mission import Deferred, Ideal
from shotc.kinds.base import Aim, Expansion, Kind, Part, Place, Scene
from shotc.kinds.files import FileFault, read_table
from shotc.kinds.gpx import read_gpx
from shotc.kinds.located import in_world
from shotc.kinds.moving import timed
from shotc.spec.fields import LookAt, Pitch, Position, RelativePath
from shotc.spec.fieldtypes import NamedOr
from shotc.spec.model import OneOf
from shotc.spec.quantities import Quantity
from shotc.spec.shot import ShotBase

LAYOUTS = (("x", "y", "z"), ("lat", "lon", "height"))
THINNED_M = 0.5  # metres, tolerance to which a recorded track is reproduced
CHUNK_POINTS = 128  # points that are thinned together
MOST_KEYFRAMES = 400  # most keyframes; a path with more is noise
ALONG = "along"
Course = Annotated[float | str, NamedOr("Course", {ALONG: ALONG}, "heading", Quantity("Angle", "angle"))]


class FollowPathShot(ShotBase):
    """The parameters of a path; without `look_at` and `heading` the camera looks at the target, or else along
    the path.
    """

    exclusive: ClassVar[tuple[OneOf, ...]] = (
        OneOf((("points",), ("file",))),
        OneOf((("look_at",), ("heading",)), required=False),
    )

    kind: Literal["follow-path"] = Field(description="what sort of shot it is")
    points: tuple[Position, ...] | None = Field(
        default=None, min_length=2, description="positions in order, two or more"
    )
    file: RelativePath | None = Field(
        default=None, description="a CSV file with x,y,z or lat,lon,height, or a GPX file"
    )
    look_at: LookAt | None = Field(default=None, description="target or position to look at")
    heading: Course | None = Field(
        default=None, description="compass heading of the camera, or `along`: look the way the path goes"
    )
    pitch: Pitch = Field(default=0.0, description="elevation of the camera that has a heading")


def expand(shot: FollowPathShot, scene: Scene) -> Expansion:
    """Return one keyframe for each point; the points of a file are first thinned to half a metre."""
    points = _listed(shot, scene) if shot.points is not None else _from_file(shot, scene)
    if isinstance(points, Diagnostic):
        return Expansion.of([points])
    if shot.heading is None and (followed := _moving(shot, scene)) is not None:
        return timed(shot, scene, _paced([at for at, _ in points]), (scene.framed(shot, followed),))
    aims = _aims(shot, scene, [at for at, _ in points])
    if not isinstance(aims, list):
        return Expansion.of([aims])
    fixed = shot.heading if isinstance(shot.heading, float) else None
    parts: list[Part] = [
        scene.keyframe(at, target, aim=aim, heading=fixed, placed=True, path=(*scene.path, *path))
        for (at, path), (aim, target) in zip(points, aims, strict=True)
    ]
    return Expansion.of(parts)


def _moving(shot: FollowPathShot, scene: Scene) -> str | None:
    """Return the name of the target that the camera looks at, if it moves."""
    name = shot.target if shot.look_at is None else shot.look_at
    target = scene.targets.get(name) if isinstance(name, str) else None
    return target.name if target is not None and target.track is not None else None


def _paced(points: list[Vec3]) -> Ideal:
    """Return the ideal along points at constant speed."""
    lengths = list(accumulate((dist(a, b) for a, b in pairwise(points)), initial=0.0))
    shares = ((s / lengths[-1], p) for s, p in zip(lengths, points, strict=True))
    return Ideal("world", None, tuple(shares), placed=True)


_Points = list[tuple[Vec3, tuple[str | int, ...]]]


def _listed(shot: FollowPathShot, scene: Scene) -> _Points | Diagnostic:
    points: _Points = [(scene.place(p), ("points", i)) for i, p in enumerate(shot.points or ())]
    if max(dist(points[0][0], p) for p, _ in points) < 1e-3:
        return scene.fault("K010", "the path goes nowhere", "give points apart from each other", "points")
    return points


def _from_file(shot: FollowPathShot, scene: Scene) -> _Points | Diagnostic:
    name = shot.file or ""
    data = scene.read(name, (*scene.path, "file"))
    if isinstance(data, Diagnostic):
        return data
    table = read_gpx(data) if name.lower().endswith(".gpx") else read_table(data, LAYOUTS)
    if isinstance(table, FileFault):
        return scene.bad_file(name, table, "file")
    places = in_world(table, name, scene.origin, scene.origins, (*scene.path, "file"))
    if isinstance(places, Diagnostic):
        return places
    points = thin(_distinct(places))
    if len(points) < 2:
        fault = FileFault("the file has fewer than two different points", None, "give two or more")
        return scene.bad_file(name, fault, "file")
    if len(points) > MOST_KEYFRAMES:
        fault = FileFault(f"thinned to {THINNED_M} m, the path has {len(points)} corners", None, "smooth it")
        return scene.bad_file(name, fault, "file")
    return [(p, ("file",)) for p in points]


def _distinct(points: list[Vec3]) -> list[Vec3]:
    """Return the points without those at which the track stands still."""
    distinct = points[:1]
    for p in points[1:]:
        if dist(distinct[-1], p) > 1e-3:
            distinct.append(p)
    return distinct


def thin(points: list[Vec3], tolerance: float = THINNED_M) -> list[Vec3]:
    """Return few of the points, such that all points are within ``tolerance`` of the polyline through them.

    It is the Ramer-Douglas-Peucker algorithm on parts of bounded length, because it is quadratic.
    """
    chosen: set[int] = {0, len(points) - 1}
    for start in range(0, len(points), CHUNK_POINTS):
        chosen |= _corners(points, start, min(start + CHUNK_POINTS, len(points) - 1), tolerance)
    return [points[i] for i in sorted(chosen)]


def _corners(points: list[Vec3], start: int, end: int, tolerance: float) -> set[int]:
    chosen = {start, end}
    stack = [(start, end)]
    while stack:
        first, last = stack.pop()
        off = [(_off(points[i], points[first], points[last]), i) for i in range(first + 1, last)]
        farthest, corner = max(off, default=(0.0, first))
        if farthest > tolerance:
            chosen.add(corner)
            stack += [(first, corner), (corner, last)]
    return chosen


def _aims(shot: FollowPathShot, scene: Scene, points: list[Vec3]) -> list[Aim] | Diagnostic | Deferred:
    if shot.heading is None and (shot.look_at is not None or shot.target is not None):
        aim = scene.aim(shot, _Look(shot.look_at))
        return aim if isinstance(aim, Diagnostic | Deferred) else [aim] * len(points)
    yaws = [yaw_of(shot.heading)] * len(points) if isinstance(shot.heading, float) else _courses(points)
    return [((yaw, shot.pitch), None) for yaw in yaws]


def _courses(points: list[Vec3]) -> list[float]:
    """Return the yaw of the path at each point: halfway between the legs before and after it."""
    legs = [(b[0] - a[0], b[1] - a[1]) for a, b in pairwise(points)]
    level = [leg for leg in legs if hypot(*leg) > 1e-6] or [(0.0, 1.0)]
    units: list[Vec2] = []
    for leg in legs:
        reach = hypot(*leg)
        if reach > 1e-6:
            units.append((leg[0] / reach, leg[1] / reach))
        else:  # a vertical leg keeps the course
            first = level[0]
            units.append(units[-1] if units else (first[0] / hypot(*first), first[1] / hypot(*first)))
    sums = [(a[0] + b[0], a[1] + b[1]) for a, b in pairwise(units)]
    turns = [s if hypot(*s) > 1e-6 else b for s, b in zip(sums, units[1:], strict=True)]
    return [atan2(d[1], d[0]) for d in (units[0], *turns, units[-1])]


@dataclass(frozen=True, slots=True)
class _Look:
    """The aim of every point of a path whose camera looks at one point or at its target."""

    look_at: str | Place | None
    heading: None = None
    pitch: None = None


def _off(p: Vec3, a: Vec3, b: Vec3) -> float:
    """Return the distance of ``p`` from the line segment a-b."""
    along = [q - o for o, q in zip(a, b, strict=True)]
    length2 = sum(c * c for c in along)
    t = sum((x - o) * c for x, o, c in zip(p, a, along, strict=True)) / length2 if length2 > 0 else 0.0
    t = max(0.0, min(1.0, t))
    return dist(p, [o + t * c for o, c in zip(a, along, strict=True)])


KIND = Kind("follow-path", "fly along points, or along a CSV or GPX file", FollowPathShot, expand)
