"""The inputs for the course of a framing: times, lens, place bounds, and occlusion. Plain Python."""

from collections.abc import Sequence
from math import atan2, ceil, hypot

from shotc.geom.vec import Vec3, plus
from shotc.geom.viewpoint import Lens, PlaceBounds, PreferredPose, RequiredView
from shotc.ir.allow import hidden_on_purpose
from shotc.ir.begins import first_start
from shotc.ir.drone import Drone
from shotc.ir.hidden import (
    HALF_SHARE,
    hidden_by_surfaces,
    kept_solids,
    occluders_of,
    standing_before,
    without_room,
)
from shotc.ir.ideal import ideal_place, offset_at
from shotc.ir.keyed import near_at
from shotc.ir.mission import MissionIR, OffsetPoints, Shot, Subject
from shotc.ir.target import Target

KNOT_S = 0.5  # seconds between the knots of a course
CHANGING_KNOT_S = 0.25  # the same where setpoints change the requirements
FEWEST_PIECES, MOST_PIECES = 8, 240  # pieces of a course
BEARING_SAMPLES = 24  # pieces at whose ends a bearing is judged, if anything moves
LIFT_M = 0.1  # metres above the ground clearance, for a free elevation


def required_view_at(mission: MissionIR, subject: Subject, start: float, t: float) -> RequiredView:
    """Return a subject with its required appearance at mission time t; start : time of the first frame."""
    target, appearance = mission.target(subject.target), subject.asked(t - start)
    azimuth, elevation = appearance.view or (None, None)
    return RequiredView(
        target.at(t), target.shape_at(t), appearance.place, appearance.size, azimuth, elevation
    )


def lens_of(drone: Drone) -> Lens:
    """Return the lens of a drone's camera."""
    return Lens(drone.hfov, drone.aspect, drone.gimbal.pitch)


def room_of(mission: MissionIR, drone: Drone, ground: float = 0.0) -> PlaceBounds:
    """Return the bounds on a drone's camera; ground : z of the ground there, metres."""
    rules = mission.rules
    return PlaceBounds(ground + rules.over_ground(drone.radius) + LIFT_M, rules.beside_target(drone.radius))


class FramedScene:
    """The inputs for the course of one framing."""

    def __init__(self, mission: MissionIR, shot: Shot, start: float, *, looks_past: bool = False) -> None:
        """Looks_past : whether viewpoints keep clear of solids, and look past what may hide a subject."""
        duration = shot.timing.duration or 0.0
        knot = CHANGING_KNOT_S if any(s.setpoints for s in shot.subjects) else KNOT_S
        pieces = int(min(MOST_PIECES, max(FEWEST_PIECES, ceil(duration / knot))))
        self.mission, self.shot, self.start, self.looks_past = mission, shot, start, looks_past
        self.drone = mission.drone(shot.drone)
        self.times = tuple(start + duration * i / pieces for i in range(pieces + 1))
        moves = any(s.setpoints for s in shot.subjects) or any(t.track is not None for t in mission.targets)
        looks = BEARING_SAMPLES if moves else 0
        self.looks = tuple(start + duration * i / max(1, looks) for i in range(looks + 1))
        self.lens, self.room = lens_of(self.drone), room_of(mission, self.drone, self._ground())
        self.near = None if shot.ideal is None else shot.ideal.near

    def _ground(self) -> float:
        """Return the largest z of the ground below the subjects, metres."""
        if self.mission.terrain is None:
            return 0.0
        places = (self.mission.target(s.target).at(t) for s in self.shot.subjects for t in self.looks)
        return max(self.mission.ground(x, y) for x, y, _ in places)

    def room_at(self, t: float) -> PlaceBounds:
        """Return the bounds on the camera at a mission time, with its preferred pose."""
        bounds = self.room
        if self.looks_past:
            bounds = bounds._replace(solids=kept_solids(self.mission, self.drone, t))
        if self.near is None:
            return bounds
        drawn = PreferredPose(near_at(self.mission, self.near, t), self.near.yaw, self.near.pitch)
        return bounds._replace(drawn=drawn)

    def room_beside(self, target: Target, lowest: Vec3, offset: Vec3) -> PlaceBounds:
        """Return the bounds on a camera that keeps an offset from a target, for the target's lowest position.

        With them the camera keeps the ground clearance everywhere along the target's course.
        """
        need = []
        for t in self.looks:
            x, y, z = plus(target.at(t), offset)
            need.append(self.mission.ground(x, y) - z + offset[2])
        return room_of(self.mission, self.drone, max(need) + lowest[2])

    def along(self, points: OffsetPoints, t: float) -> Vec3:
        """Return the offset at a mission time, interpolated in the offsets over the shot."""
        return offset_at(points, (t - self.start) / max(self.times[-1] - self.start, 1e-9))

    def required_views(self, subjects: Sequence[Subject], t: float) -> tuple[RequiredView, ...]:
        """Return all subjects with their required appearance at a mission time."""
        views = [required_view_at(self.mission, s, self.start, t) for s in subjects]
        if self.looks_past:
            views = [
                view._replace(occluders=occluders_of(self.mission, s.target, t))
                for s, view in zip(subjects, views, strict=True)
            ]
        return tuple(views)

    def comes_from(self, subject: Vec3) -> float:
        """Return the bearing from a subject to the drone's position before the shot, rad."""
        x, y, _ = _before(self.mission, self.shot)
        return atan2(x - subject[0], y - subject[1]) if hypot(x - subject[0], y - subject[1]) > 1e-3 else 0.0

    def shares(self, eyes: Sequence[tuple[float, Vec3]]) -> tuple[float, float]:
        """Return the share of places without the clearances, and the hidden share of subjects, 0 to 1.

        A solid before a subject's middle or one of its sides hides it entirely; a surface counts by its
        share.
        eyes : mission times and positions
        """
        hidden = [float(self._stands_before(eye)) for eye in eyes]
        return self.blocked(eyes), sum(map(max, hidden, self._by_surfaces(eyes))) / len(eyes)

    def blocked(self, eyes: Sequence[tuple[float, Vec3]]) -> float:
        """Return the share of places at which the drone lacks a clearance."""
        return sum(without_room(self.mission, self.drone, eyes)) / len(eyes)

    def covered(self, eyes: Sequence[tuple[float, Vec3]]) -> float:
        """Return the hidden share of the subjects, 0 to 1: middles weigh one half, each side one quarter."""
        hidden = sum(sum(self._covered(s, eyes)) for s in self.shot.subjects)
        return hidden / (len(eyes) * len(self.shot.subjects))

    def lost(self, eyes: Sequence[tuple[float, Vec3]]) -> float:
        """Return the largest share of places, over the subjects, from which half of one is hidden.

        It is 0 if the shot allows its subjects to be hidden.
        """
        if hidden_on_purpose(self.shot):
            return 0.0
        covered = (self._covered(s, eyes) for s in self.shot.subjects)
        return max(sum(share >= HALF_SHARE for share in shares) / len(eyes) for shares in covered)

    def _covered(self, subject: Subject, eyes: Sequence[tuple[float, Vec3]]) -> list[float]:
        """Return the hidden share of a subject from each place, 0 to 1."""
        weights = (0.5, 0.25, 0.25)
        shares = hidden_by_surfaces(self.mission, subject.target, eyes)
        for i, (t, eye) in enumerate(eyes):
            before = standing_before(self.mission, subject.target, eye, t)
            solids = sum(w for w, obstacle in zip(weights, before, strict=True) if obstacle is not None)
            shares[i] = max(solids, shares[i])
        return shares

    def _stands_before(self, eye: tuple[float, Vec3]) -> bool:
        """Return whether a solid is before the middle or a side of a subject."""
        return any(
            occluder is not None
            for s in self.shot.subjects
            for occluder in standing_before(self.mission, s.target, eye[1], eye[0])
        )

    def _by_surfaces(self, eyes: Sequence[tuple[float, Vec3]]) -> list[float]:
        """Return the largest share of a subject that surfaces hide from each place."""
        occluders = (hidden_by_surfaces(self.mission, s.target, eyes) for s in self.shot.subjects)
        return [max(shares) for shares in zip(*occluders, strict=True)]


def _before(mission: MissionIR, shot: Shot) -> Vec3:
    """Return the drone's position before a shot: the end of its previous shot, as written, or its home."""
    last: Shot | None = None
    for other in mission.shots:
        if other.id == shot.id:
            break
        if other.drone == shot.drone:
            last = other
    if last is None:
        return mission.drone(shot.drone).home
    if last.ideal is None:
        return last.keyframes[-1].at
    start = first_start(mission, last)
    return ideal_place(mission, last, start, start + (last.timing.duration or 0.0))
