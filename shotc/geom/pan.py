"""How fast a camera may turn for an audience to see its picture. Plain Python.

A camera that turns at w rad/s moves what is far away by w / (2 tan(hfov / 2)) frame widths a second, near the
middle of the frame. At 24 frames a second that judders where a width takes less than 7 s (RED, Panning Speed
Best Practices). Where a subject is followed it stands still on screen and holds the eye, and the surroundings
may go through in 3 s.
"""

FREE_S = 7.0  # seconds a frame width takes at least where nobody is followed
FOLLOWING_S = 3.0  # and where the camera follows a subject
WINDOW_S = 1.0  # seconds over which a turn is judged whose course is known


def slowest(followed: str | None) -> float:
    """Return the seconds that a frame width takes at least; followed : whom the eye holds on to."""
    return FREE_S if followed is None else FOLLOWING_S


def whose(followed: str | None) -> str:
    """Return for whom that holds, in words."""
    return "where nobody is followed" if followed is None else f"behind `{followed}`"
