"""The camera pose (position, yaw, pitch) from which subjects appear as required, by least squares.

The terms are those of Naegeli et al. (viewpoint Eq. 7 to 9): place on screen, size and viewing angle. Sizes
are those of the exact outline. They enter as logarithms, so that twice and half the size have the same error.
Hard requirements enter as a steep hinge (the whole target in the frame, its clearance, the drone's speed) or
as a bound (the floor, the pitch). ``pose_search`` minimises them. Plain Python.
"""

from collections.abc import Sequence
from functools import lru_cache
from math import asin, atan2, cos, hypot, inf, log, sin, sqrt, tan
from typing import NamedTuple

from shotc.geom.camera import View, aim_at, frustum_margins, view
from shotc.geom.line_of_sight import gap_beside
from shotc.geom.pose_search import Pose, PoseCost, Residuals, dot, least_cost_pose
from shotc.geom.shapes import TargetShape
from shotc.geom.solids import Solid, signed_distance
from shotc.geom.vec import Vec2, Vec3, minus

FAR_M = 1e5  # metres, the largest distance of a camera
MOST_HALVINGS = 60
HARD_WEIGHT = 10.0  # weight of hard requirements
NEAR_WEIGHT = 0.3  # weight of the preferred pose: an error of a tenth of the distance costs 0.03 half frames
FAINT_WEIGHT = 0.01  # weight of free values, which stay as they are, and of a level view
EDGE_SHARE = 0.97  # share of half a frame within which a whole target is kept
STEEPEST_RAD = 1.5  # rad, largest elevation of a free view
WHOLE_SIZE = 0.4  # size of a subject without a required size: whole, with its surroundings


class Lens(NamedTuple):
    """The field of view and the pitch range of a camera: hfov, rad; width / height; pitch range, rad."""

    hfov: float
    aspect: float
    pitch: Vec2


class PreferredPose(NamedTuple):
    """A pose that a camera stays near: its position, yaw and pitch, rad; each angle is None if it is free."""

    at: Vec3
    yaw: float | None = None
    pitch: float | None = None


class KeptSolid(NamedTuple):
    """A solid, the side on which the camera stays, and its distance from the solid's surface, metres."""

    solid: Solid
    inside: bool
    gap: float

    def lack(self, at: Vec3) -> float:
        """Return what a place lacks of the distance, metres; 0 where it has it."""
        beyond = signed_distance(self.solid, at)
        return max(0.0, self.gap + (beyond if self.inside else -beyond))


class PlaceBounds(NamedTuple):
    """Bounds on the camera's position: lowest z, and the clearance from subjects, metres.

    drawn : the preferred pose, kept as far as the picture allows (viewpoint Eq. 10), or None
    solids : what else the camera keeps clear of
    """

    floor: float
    near: float
    drawn: PreferredPose | None = None
    solids: tuple[KeptSolid, ...] = ()


class RequiredView(NamedTuple):
    """A subject at one time, and its required appearance; None is free.

    centre : W, m; shape : at that time
    uv : place on screen; size : of its outline, over the frame's height
    azimuth : compass bearing from it to the camera, rad; elevation : of the camera above it, rad
    occluders : convex solids that the line of sight passes beside
    """

    centre: Vec3
    shape: TargetShape
    uv: Vec2 | None = None
    size: float | None = None
    azimuth: float | None = None
    elevation: float | None = None
    occluders: tuple[Solid, ...] = ()

    @property
    def whole(self) -> bool:
        """Whether the whole subject must be in the frame: its required size is not larger than the frame."""
        return self.size is None or self.size <= 1.0


class PreviousView(NamedTuple):
    """The camera at the knot before: position, position if it moves with the subjects, largest step."""

    eye: Vec3
    kept: Vec3
    largest_step: float


class SubjectAppearance(NamedTuple):
    """The appearance of a subject compared with the required one.

    screen : distance from its required place, half frames; size : over the frame's height
    angle : from the required view, rad; out : distance that it extends out of the frame, half frames; 0
        inside
    """

    screen: float
    size: float
    angle: float
    out: float


def direction(azimuth: float, elevation: float) -> Vec3:
    """Return the unit vector from a subject to a camera at a compass bearing and an elevation."""
    level = cos(elevation)
    return (level * sin(azimuth), level * cos(azimuth), sin(elevation))


def size_from(subject: RequiredView, lens: Lens, offset: Vec3) -> float:
    """Return the size of a subject at its place on screen, seen from ``offset`` from its centre, metres.

    It is infinite if the subject extends behind the image plane, NaN if no camera shows it at that place.
    """
    back = (-offset[0], -offset[1], -offset[2])
    aim = aim_at(back, subject.uv or (0.0, 0.0), lens.hfov, lens.aspect)
    if aim is None:
        return float("nan")
    camera = view(*aim, lens.hfov, lens.aspect)
    if subject.shape.nearest_depth(camera, back) <= 0:
        return inf
    _, _, low, high = subject.shape.bounds(camera, back)
    return float(0.5 * (high - low))


def nearest(subject: RequiredView, toward: Vec3, near: float) -> float:
    """Return the least distance along a unit vector from a subject's centre with clearance ``near``."""
    low, high = 0.0, subject.shape.radius + subject.shape.height + near + 1.0
    for _ in range(MOST_HALVINGS):
        middle = 0.5 * (low + high)
        closer = subject.shape.gap(_times(toward, middle)) < near
        low, high = (middle, high) if closer else (low, middle)
    return high


def distance_for(subject: RequiredView, lens: Lens, toward: Vec3, size: float) -> float:
    """Return the distance along a unit vector from which a subject has a size; 0 if it is always smaller."""
    low, high = 1e-3, FAR_M
    for _ in range(MOST_HALVINGS + 20):
        middle = sqrt(low * high)
        if size_from(subject, lens, _times(toward, middle)) > size:
            low = middle
        else:
            high = middle
    return high if high > 1.01e-3 else 0.0


def lens_for(subject: RequiredView, lens: Lens, offset: Vec3, size: float) -> float | None:
    """Return the horizontal field of view, rad, that gives a subject its size from a place, or None."""
    low, high = 0.02, 2.8
    sized = [size_from(subject, lens._replace(hfov=h), offset) for h in (low, high)]
    if not sized[1] <= size <= sized[0]:
        return None
    for _ in range(MOST_HALVINGS):
        middle = 0.5 * (low + high)
        if size_from(subject, lens._replace(hfov=middle), offset) > size:
            low = middle
        else:
            high = middle
    return high


def stand(subject: RequiredView, lens: Lens, bounds: PlaceBounds, azimuth: float, size: float) -> Vec3:
    """Return the camera's offset from a subject for a bearing, rad, and a size.

    A free elevation is level, or as little above as the floor of ``bounds`` needs.
    """

    def at(elevation: float) -> Vec3:
        toward = direction(azimuth, elevation)
        return _times(toward, distance_for(subject, lens, toward, size))

    if subject.elevation is not None:
        return at(subject.elevation)
    lift = bounds.floor - subject.centre[2]
    offset = at(0.0)
    if offset[2] >= lift:
        return offset
    low, high = 0.0, STEEPEST_RAD
    for _ in range(30):
        middle = 0.5 * (low + high)
        if at(middle)[2] < lift:
            low = middle
        else:
            high = middle
    return at(high)


def judged(pose: Pose, lens: Lens, subject: RequiredView) -> SubjectAppearance | None:
    """Return the appearance of a subject from a pose; None if it extends behind the camera."""
    camera = view(pose[3], pose[4], lens.hfov, lens.aspect)
    offset = minus(subject.centre, (pose[0], pose[1], pose[2]))
    if subject.shape.nearest_depth(camera, offset) <= 0:
        return None
    left, right, low, high = subject.shape.bounds(camera, offset)
    u, v, _ = camera.project(offset)
    screen = 0.0 if subject.uv is None else hypot(u - subject.uv[0], v - subject.uv[1])
    chord = hypot(*_off_view(subject, offset))
    out = max(0.0, -left - 1.0, right - 1.0, -low - 1.0, high - 1.0) if subject.whole else 0.0
    return SubjectAppearance(screen, 0.5 * (high - low), 2 * asin(min(1.0, 0.5 * chord)), out)


def whole(pose: Pose, lens: Lens, subject: RequiredView) -> bool:
    """Return whether all of a subject is in the frame."""
    offset = minus(subject.centre, (pose[0], pose[1], pose[2]))
    camera = view(pose[3], pose[4], lens.hfov, lens.aspect)
    return bool(min(frustum_margins(camera, offset, subject.shape)) >= 0.0)


def middle_of(subjects: Sequence[RequiredView]) -> Vec3:
    """Return the mean of the subjects' centres."""
    x, y, z = (sum(s.centre[i] for s in subjects) / len(subjects) for i in range(3))
    return (x, y, z)


def first_pose(subjects: Sequence[RequiredView], lens: Lens, bounds: PlaceBounds, azimuth: float) -> Pose:
    """Return a pose with all subjects in front of the camera, at a bearing from their middle, rad."""
    middle = middle_of(subjects)
    spread = max(hypot(*minus(s.centre, middle)) + s.shape.radius + s.shape.height / 2 for s in subjects)
    half = min(tan(lens.hfov / 2), tan(lens.hfov / 2) / lens.aspect)
    back = spread * (1.0 + 1.0 / half) + bounds.near
    level = direction(azimuth, 0.0)
    eye = (middle[0] + back * level[0], middle[1] + back * level[1], max(middle[2], bounds.floor))
    x, y, z = minus(middle, eye)
    return (*eye, atan2(y, x), atan2(z, hypot(x, y)))


@lru_cache(maxsize=4096)  # several passes solve the same framing, and standing subjects repeat
def viewpoint(
    subjects: tuple[RequiredView, ...],
    lens: Lens,
    bounds: PlaceBounds,
    start: Pose,
    previous: PreviousView | None = None,
) -> tuple[Pose, float]:
    """Return the pose of least cost, from an initial guess, and its cost.

    previous : the camera at the knot before, or None. Free values stay as there; the step has a limit.
    """
    reach = max(hypot(*minus((start[0], start[1], start[2]), middle_of(subjects))), 1.0)

    def cost(pose: Pose) -> tuple[Residuals | None, float]:
        residuals = _residuals(pose, subjects, lens, bounds, (previous, reach))
        return residuals, inf if residuals is None else dot(residuals, residuals)

    low = (-inf, -inf, bounds.floor, -inf, lens.pitch[0])
    high = (inf, inf, inf, inf, lens.pitch[1])
    return least_cost_pose(PoseCost(cost, low, high, (reach, reach, reach, 1.0, 1.0)), start)


def _residuals(
    pose: Pose,
    subjects: Sequence[RequiredView],
    lens: Lens,
    bounds: PlaceBounds,
    faint: tuple[PreviousView | None, float],
) -> Residuals | None:
    """Return all residuals; None if a subject extends behind the camera."""
    camera = view(pose[3], pose[4], lens.hfov, lens.aspect)
    eye = (pose[0], pose[1], pose[2])
    previous, reach = faint
    residuals: Residuals = []
    sized = any(s.size is not None for s in subjects)
    for s in subjects:
        its = _of_subject(camera, eye, s, bounds.near, sized=sized)
        if its is None:
            return None
        residuals += its
    offsets = [minus(s.centre, eye) for s in subjects if s.uv is None]
    residuals += _off_middle([camera.project(offset)[:2] for offset in offsets])
    residuals += [HARD_WEIGHT * solid.lack(eye) for solid in bounds.solids]
    residuals += _off_pose(pose, bounds.drawn, subjects)
    if previous is not None:
        residuals += [FAINT_WEIGHT * (e - k) / reach for e, k in zip(eye, previous.kept, strict=True)]
        residuals.append(HARD_WEIGHT * max(0.0, hypot(*minus(eye, previous.eye)) - previous.largest_step))
    return residuals


def _of_subject(
    camera: View, eye: Vec3, subject: RequiredView, near: float, *, sized: bool
) -> Residuals | None:
    """Return the residuals of one subject; None if it extends behind the camera.

    near : its clearance, metres; sized : whether any subject has a required size
    """
    offset = minus(subject.centre, eye)
    if subject.shape.nearest_depth(camera, offset) <= 1e-3:
        return None
    left, right, low, high = subject.shape.bounds(camera, offset)
    if not high > low:
        return None
    residuals: Residuals = []
    if subject.uv is not None:
        u, v, _ = camera.project(offset)
        residuals += [u - subject.uv[0], v - subject.uv[1]]
    if subject.size is not None:
        residuals.append(log(0.5 * (high - low) / subject.size))
    elif not sized:
        residuals.append(FAINT_WEIGHT * log(0.5 * (high - low) / WHOLE_SIZE))
    if subject.whole:
        residuals += [HARD_WEIGHT * max(0.0, edge - EDGE_SHARE) for edge in (-left, right, -low, high)]
    residuals += _off_view(subject, offset)
    if subject.elevation is None:
        residuals.append(FAINT_WEIGHT * offset[2] / max(hypot(*offset), 1e-9))
    residuals.append(HARD_WEIGHT * max(0.0, near - subject.shape.gap(offset)))
    return residuals + [HARD_WEIGHT * _hidden(eye, subject, occluder) for occluder in subject.occluders]


def _off_middle(places: Sequence[Vec2]) -> Residuals:
    """Return the residuals that draw subjects without a place to the middle of the screen, as one group.

    Drawn one by one, two subjects would come together in the middle, one behind the other.
    """
    return [FAINT_WEIGHT * sum(p[i] for p in places) / len(places) for i in (0, 1)] if places else []


def _hidden(eye: Vec3, subject: RequiredView, occluder: Solid) -> float:
    """Return by how much a line of sight lacks the subject's radius beside an occluder, over that radius.

    The line ends where it meets the subject, so that what stands behind it does not count.
    """
    x, y, z = offset = minus(subject.centre, eye)
    radius = max(subject.shape.radius, 1e-3)
    share = max(0.0, 1.0 - radius / max(hypot(*offset), 1e-9))
    end = (eye[0] + share * x, eye[1] + share * y, eye[2] + share * z)
    return 1.0 - gap_beside(occluder, eye, end, radius) / radius


def _off_pose(pose: Pose, drawn: PreferredPose | None, subjects: Sequence[RequiredView]) -> Residuals:
    """Return the residuals from the preferred pose: position as shares of the distance, and angles, rad."""
    if drawn is None:
        return []
    distance = max(hypot(*minus(drawn.at, middle_of(subjects))), 1.0)
    residuals = [NEAR_WEIGHT * (e - d) / distance for e, d in zip(pose[:3], drawn.at, strict=True)]
    if drawn.yaw is not None:
        # As in the quaternion of the difference, independent of the pitch: looking down does not reduce it.
        residuals.append(NEAR_WEIGHT * 2.0 * sin(0.5 * (pose[3] - drawn.yaw)))
    if drawn.pitch is not None:
        residuals.append(NEAR_WEIGHT * (pose[4] - drawn.pitch))
    return residuals


def _off_view(subject: RequiredView, offset: Vec3) -> Residuals:
    """Return the residuals from the required view, as chords of the unit sphere (viewpoint Eq. 9).

    offset : subject minus camera
    """
    azimuth, elevation = subject.azimuth, subject.elevation
    length, level = max(hypot(*offset), 1e-9), max(hypot(offset[0], offset[1]), 1e-9)
    if azimuth is not None and elevation is not None:
        return [-c / length - a for c, a in zip(offset, direction(azimuth, elevation), strict=True)]
    if azimuth is not None:
        return [-offset[0] / level - sin(azimuth), -offset[1] / level - cos(azimuth)]
    if elevation is not None:
        return [atan2(-offset[2], level) - elevation]
    return []


def _times(a: Vec3, factor: float) -> Vec3:
    return (a[0] * factor, a[1] * factor, a[2] * factor)
