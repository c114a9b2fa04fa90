"""The pace: the share of the limits that a shot uses where the mission leaves its time free. Plain Python."""

from shotc.ir.keyframes import KeyframeIR, PlacedShot

BESIDE_RATIO = 1.25
"""Largest ratio of the used share to the pace, in a mission with a clock.

There a refined shot keeps the time of its convex path, because other legs are planned beside it. Its way is
often longer, so it needs more than the pace. A calm shot (0.5) stays below a normal one (0.75), and a normal
one below the full limits.
"""


def most_share(pace: float) -> float:
    """Return the largest share of the limits that a refined shot may use in the time of its convex path."""
    return min(1.0, BESIDE_RATIO * pace)


def on_clock(ir: KeyframeIR) -> bool:
    """Return whether legs depend on mission time: a target moves, or several drones fly."""
    moving = any(placed.shot.ideal is not None for placed in ir.shots)
    moving = moving or any(target.track is not None for target in ir.mission.targets)
    return moving or len({placed.shot.drone for placed in ir.shots}) > 1


def leaves_time(placed: PlacedShot) -> bool:
    """Return whether the mission states neither how long a shot lasts nor when it is at a keyframe."""
    shot, keyframes = placed.shot, placed.keyframes
    return shot.ideal is None and shot.timing.duration is None and all(k.time is None for k in keyframes)
