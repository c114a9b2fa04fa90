"""The largest turn rate of a camera without judder. Plain Python.

A camera that turns at w rad/s moves the far background by w / (2 tan(hfov / 2)) frame widths a second, near
the middle of the frame. At 24 frames a second the picture judders if a frame width takes less than 7 s (RED,
Panning Speed Best Practices). A followed subject stands still on screen and holds the eye; then the
background may pass in 3 s.
"""

FREE_S = 7.0  # least seconds for a frame width without a followed subject
FOLLOWING_S = 3.0  # the same with a followed subject
WINDOW_S = 1.0  # seconds over which a turn of known course is averaged


def slowest(followed: str | None) -> float:
    """Return the least seconds for a frame width; followed : name of the followed subject, or None."""
    return FREE_S if followed is None else FOLLOWING_S


def whose(followed: str | None) -> str:
    """Return the condition of that limit in words."""
    return "where nobody is followed" if followed is None else f"behind `{followed}`"
