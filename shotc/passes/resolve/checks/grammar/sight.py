"""What a shot shows at its first and its last frame: whom, from where, and which way they go."""

from math import hypot, tan
from typing import NamedTuple

from shotc.geom.vec import minus
from shotc.ir.drone import Drone
from shotc.ir.ideal import ideal_place
from shotc.ir.keyed import arrivals, carriers, is_keyed
from shotc.ir.limits import Vec2, Vec3
from shotc.ir.mission import MissionIR, Shot


class Sight(NamedTuple):
    """One frame of a shot.

    eye : place of the camera, W, m; names, centres : of those in the picture, the first one foremost
    course : unit direction in which the first one moves over ground, or None where it stands
    half : tangent of half the vertical field of view; height : of the first one, m
    moving : whether the first one has a track
    t : mission time, s, or None where it is not known and does not matter
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
        """Return the camera's place as seen from the first one."""
        return minus(self.eye, self.centres[0])

    @property
    def scale(self) -> float:
        """Return the height of the first one over that of the frame, were it seen upright."""
        return self.height / (2 * hypot(*self.offset) * self.half)


def sight(mission: MissionIR, shot: Shot, share: float) -> Sight | None:
    """Return what a shot shows at its start (0), its end (1) or between; None without a target or a time.

    Of a shot of keyframes only start and end are told.
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
        Sight(keyframe.at, (target.name,), (target.centre,), None, half, target.height, False, None)
    )


def start_of(mission: MissionIR, shot: Shot) -> float | None:
    """Return the mission time of a shot's first frame, or None where its picture depends on it unknown.

    Without a `start` it is not known. That does not matter where the camera goes along with a target whose
    way is straight; any time on that way will do then.
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


def _on_clock(mission: MissionIR, shot: Shot, drone: Drone, share: float) -> Sight | None:
    start, duration = start_of(mission, shot), shot.timing.duration
    if start is None or duration is None or not shot.subjects:
        return None
    t = start + share * duration
    names = [subject.target for subject in shot.subjects]
    if is_keyed(shot):
        # Of several targets that keyframes hand over, one is in the picture.
        after = [
            k.target
            for k, reached in zip(shot.keyframes, arrivals(shot), strict=True)
            if start + reached >= t
        ]
        names = [next((name for name in (*after, shot.keyframes[-1].target)), None) or names[0]]
    targets = [mission.target(name) for name in names]
    first = targets[0]
    return _sound(
        Sight(
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


def _sound(seen: Sight) -> Sight | None:
    """Return what is seen, unless the camera is where the target is."""
    return seen if hypot(*seen.offset) > 1e-6 else None
