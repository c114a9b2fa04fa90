"""The line of action: the camera stays on one side of it from shot to shot, or crosses it visibly.

The line is the course of a subject or, for two that are filmed together, the line between them. On its other
side left and right are exchanged on screen. A camera on the line (ahead, behind or overhead) is on neither
side, and a cut to or from it is not a crossing.
"""

from __future__ import annotations

from math import hypot, radians, sin

from shotc.diag.model import Diagnostic
from shotc.geom.vec import minus
from shotc.ir.mission import MissionIR, Shot
from shotc.passes.resolve.checks.grammar.end_frames import ShotFrame, sight
from shotc.passes.resolve.checks.grammar.labels import placing

NEUTRAL = sin(radians(15.0))  # sine of the angle from the line within which a camera is on no side
SHOT_SAMPLES = 24  # samples of a shot for a visible crossing


def check_line(
    mission: MissionIR, before: Shot, after: Shot, left: ShotFrame, right: ShotFrame
) -> Diagnostic | None:
    """Return the warning about a cut across the line, from a last frame to the next first one, or None."""
    pair = len(left.names) > 1 and set(left.names[:2]) == set(right.names[:2])
    if not pair and left.names[0] != right.names[0]:
        return None
    a, b = (side(seen, pair=pair) for seen in (left, right))
    if a is None or b is None or a * b > 0 or min(abs(a), abs(b)) < NEUTRAL:
        return None
    if goes_over(mission, after, pair=pair):
        return None
    who = " and ".join(f"`{name}`" for name in left.names[: 2 if pair else 1])
    what = "the line from the one to the other" if pair else "its direction of motion"
    sides = [
        f"`{shot.id}` {verb} {abs(sine) * hypot(*seen.offset):.1f} m to the {'left' if sine > 0 else 'right'}"
        for shot, verb, sine, seen in ((before, "ends", a, left), (after, "begins", b, right))
    ]
    side_kept = "left" if a > 0 else "right"
    return Diagnostic(
        "F001",
        f"the cut from `{before.id}` to `{after.id}` crosses the line of action of {who}",
        (placing(mission, after, last=False), placing(mission, before, last=True, text="filmed from here")),
        (f"relative to {what}, {sides[0]} and {sides[1]}, so directions reverse on screen",),
        f"begin `{after.id}` on the {side_kept}, or put a shot from ahead, from behind or of something else "
        "between them, or write `allow: [crossing-the-line]` in it",
    )


def side(seen: ShotFrame, *, pair: bool) -> float | None:
    """Return the side of the line on which a camera is: the sine of its angle from it, positive to the left.

    None where there is no line. A camera overhead is as near to the line as one on it.
    """
    if pair:
        (_, a), (_, b) = sorted(zip(seen.names[:2], seen.centres[:2], strict=True))
        direction, origin = minus(b, a), tuple(0.5 * (p + q) for p, q in zip(a, b, strict=True))
        length = hypot(direction[0], direction[1])
        if length < 1e-6:
            return None
        x, y = direction[0] / length, direction[1] / length
        offset = minus(seen.eye, (origin[0], origin[1], origin[2]))
    elif seen.course is None:
        return None
    else:
        (x, y), offset = seen.course, seen.offset
    return (x * offset[1] - y * offset[0]) / max(hypot(*offset), 1e-9)


def goes_over(mission: MissionIR, shot: Shot, *, pair: bool) -> bool:
    """Return whether the camera is on both sides of the line during a shot."""
    if shot.ideal is None:
        return False
    seen = (sight(mission, shot, i / SHOT_SAMPLES) for i in range(SHOT_SAMPLES + 1))
    sines = [s for s in (side(one, pair=pair) for one in seen if one is not None) if s is not None]
    return bool(sines) and min(sines) < -NEUTRAL and max(sines) > NEUTRAL
