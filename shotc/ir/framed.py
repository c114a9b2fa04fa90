"""The ideal of a framing shot: the camera course from which the subjects appear as required. Plain Python.

For one subject there is a closed form: the camera keeps one offset from it, or one offset a knot if setpoints
change the requirements. For several subjects the course is a least-squares solution knot by knot, each
started from the one before. Rules determine what the mission does not state:

- bearing: the one from which the drone comes. If an occluder or an obstacle is in the way during the shot, it
  is the nearest bearing that is clear;
- elevation: level with the subject, or as little above it as the ground clearance needs. If the subject is
  hidden in most frames from every bearing, it is the lowest one that is tried from which it is visible;
- size: ``viewpoint.WHOLE_SIZE``, where no subject has one; for one subject the largest size up to that at
  which it is whole, where it is wider than the frame. If the camera lacks a clearance there, or the subject
  is hidden in most frames, it is the nearest size at which the camera has room and sees;
- place on screen: for one subject, the place of its composition nearest to the middle at which it is whole;
  for several, each place of the composition once.

Several subjects appear less exactly as required where one of them would else be hidden in most frames.
"""

from functools import lru_cache

from shotc.ir.framed_alone import alone
from shotc.ir.framed_course import StartedFraming
from shotc.ir.framed_scene import FramedScene
from shotc.ir.framed_together import together
from shotc.ir.keyed import is_keyed, settled
from shotc.ir.mission import MissionIR, Shot

SAME_TIME_S = 1e-6  # seconds


def at_start(mission: MissionIR, shot: Shot, start: float) -> Shot:
    """Return a shot resolved for its first frame at ``start``, s: framings and keyframes depend on it."""
    if shot.timing.start is not None and abs(shot.timing.start - start) <= SAME_TIME_S:
        return shot
    if is_keyed(shot):
        return settled(mission, shot, start)
    if shot.ideal is None or not shot.ideal.framed or not shot.subjects:
        return shot
    return course_of(mission, shot, start).shot


def course_of(mission: MissionIR, shot: Shot, start: float) -> StartedFraming:
    """Return the course of a framing whose first frame is at ``start``, seconds."""
    return _course_of(_OneMission(mission), shot, start)


class _OneMission:
    """A mission as a key: it equals only itself, since its spans cannot be hashed."""

    def __init__(self, mission: MissionIR) -> None:
        self.mission = mission

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _OneMission) and self.mission is other.mission

    def __hash__(self) -> int:
        return id(self.mission)


@lru_cache(maxsize=8)  # planning, refinement and verification ask for the same course, up to 0.1 s each time
def _course_of(key: _OneMission, shot: Shot, start: float) -> StartedFraming:
    scene = FramedScene(key.mission, shot, start)
    return alone(scene) if len(shot.subjects) == 1 and scene.near is None else together(scene)
