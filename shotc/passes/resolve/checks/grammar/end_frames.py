"""What a shot shows in its first and last frame: the subjects, the camera's place, and their course."""

from math import hypot, tan
from typing import NamedTuple

from shotc.geom.vec import minus
from shotc.ir.drone import Drone
from shotc.ir.ideal import ideal_place
from shotc.ir.keyed import arrivals, carriers, is_keyed
from shotc.ir.limits import Vec2, Vec3
from shotc.ir.mission import MissionIR, Shot


class ShotFrame(NamedTuple):
    """One frame of a shot.

    eye : place of the camera, W, metres
    names, centres : of the subjects in the picture, the most important first
    course : unit direction of the first one's horizontal motion, or None where it stands
    half : tangent of half the vertical field of view
    height : of the first one, metres
    moving : whether the first one has a track
    t : mission time, seconds; None where it is not known and does not matter
    """

    eye: Vec3
    names: tuple[str, ...]
    centres: tuple[Vec3, ...]
    course: Vec2 | None
    half: float
    height: float
    moving: bool
    t: float | None

    @property
    def offset(self) -> Vec3:
        """The camera's place relative to the first subject."""
        return minus(self.eye, self.centres[0])

    @property
    def scale(self) -> float:
        """The height of the first subject over that of the frame, as seen horizontally."""
        return self.height / (2 * hypot(*self.offset) * self.half)


def sight(mission: MissionIR, shot: Shot, share: float) -> ShotFrame | None:
    """Return what a shot shows at its start (0), its end (1) or between; None without a target or a time.

    For a shot with standing keyframes only start and end are known.
    """
    drone = mission.drone(shot.drone)
    if shot.ideal is not None:
        return _on_clock(mission, shot, drone, share)
    keyframe = shot.keyframes[0 if share < 0.5 else -1]
    if keyframe.target is None:
        return None
    target = mission.target(keyframe.target)
    half = tan(keyframe.hfov / 2) / drone.aspect
    return _sound(
        ShotFrame(keyframe.at, (target.name,), (target.centre,), None, half, target.height, False, None)
    )


def start_of(mission: MissionIR, shot: Shot) -> float | None:
    """Return the mission time of a shot's first frame; None where its picture depends on an unknown time.

    Without a `start` the time is not known. That does not matter if the camera moves along with a target on a
    straight track; then any time on it is used.
    """
    ideal = shot.ideal
    if shot.timing.start is not None or ideal is None or (ideal.target is None and not is_keyed(shot)):
        return shot.timing.start
    if any(k.beside is None for k in shot.keyframes):
        return None
    tracks = [mission.target(name).track for name in carriers(shot)]
    if len(tracks) == 1 and tracks[0] is not None and tracks[0].straight:
        return tracks[0].underway
    return None


def _on_clock(mission: MissionIR, shot: Shot, drone: Drone, share: float) -> ShotFrame | None:
    start, duration = start_of(mission, shot), shot.timing.duration
    if start is None or duration is None or not shot.subjects:
        return None
    t = start + share * duration
    names = [subject.target for subject in shot.subjects]
    if is_keyed(shot):
        # Where keyframes have several targets, one of them is in the picture.
        after = [
            k.target
            for k, reached in zip(shot.keyframes, arrivals(shot), strict=True)
            if start + reached >= t
        ]
        names = [next((name for name in (*after, shot.keyframes[-1].target)), None) or names[0]]
    targets = [mission.target(name) for name in names]
    first = targets[0]
    return _sound(
        ShotFrame(
            ideal_place(mission, shot, start, t),
            tuple(target.name for target in targets),
            tuple(target.at(t) for target in targets),
            None if first.track is None else first.track.course(t),
            tan(drone.hfov / 2) / drone.aspect,
            first.height,
            first.track is not None,
            None if shot.timing.start is None else t,
        )
    )


def _sound(seen: ShotFrame) -> ShotFrame | None:
    """Return the frame, or None if the camera is at the target's place."""
    return seen if hypot(*seen.offset) > 1e-6 else None
