"""Cuts from each shot to the next one of the film.

The film has the order in which its shots are flown, those of all drones together: as written, unless `start`
or `after` changes it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import pairwise
from math import acos, atan2, ceil, cos, degrees, dist, hypot, radians, sin, sqrt

from shotc.diag.model import Diagnostic
from shotc.geom.vec import wrapped
from shotc.ir.flown_order import flown_order
from shotc.ir.limits import Vec3
from shotc.ir.mission import MissionIR, Shot
from shotc.passes.resolve.checks.grammar.end_frames import ShotFrame, sight
from shotc.passes.resolve.checks.grammar.labels import placing
from shotc.passes.resolve.checks.grammar.line import check_line
from shotc.rounding import at_least, at_most

VIEWS_APART_RAD = radians(30.0)  # least angle between two views of one subject: the 30-degree rule
ALIKE_SIZE_RATIO = 1.5  # ratio of sizes on screen, below which they are about the same
SAME_PLACE_SHARE = 0.02  # share of the distance that a camera may move between shots that continue
SAME_LENS_RATIO = 1.05
SAME_TIME_S = 1.0  # seconds between two shots of a moving subject that continue
_KEYS = ("azimuth", "start_azimuth")


def check_cuts(mission: MissionIR, judged: Callable[[str, Shot], bool]) -> Iterator[Diagnostic]:
    """Yield the faults of cuts; each is reported for the shot after the cut."""
    for before, after in pairwise(film_order(mission.shots)):
        line, jump = (judged(slug, after) for slug in ("crossing-the-line", "jump-cut"))
        left = sight(mission, before, 1.0) if line or jump else None
        right = None if left is None else sight(mission, after, 0.0)
        if left is None or right is None:
            continue
        crossed = check_line(mission, before, after, left, right) if line else None
        jumped = check_jump(mission, before, after, left, right) if jump else None
        yield from (diagnostic for diagnostic in (crossed, jumped) if diagnostic is not None)


def film_order(shots: Sequence[Shot]) -> tuple[Shot, ...]:
    """Return the shots of all drones in the order of the film: as flown, those with a `start` by it."""
    flown = flown_order(shots)
    risen = iter(
        sorted((s for s in flown if s.timing.start is not None), key=lambda s: s.timing.start or 0.0)
    )
    return tuple(shot if shot.timing.start is None else next(risen) for shot in flown)


def check_jump(
    mission: MissionIR, before: Shot, after: Shot, left: ShotFrame, right: ShotFrame
) -> Diagnostic | None:
    """Return the warning about a cut between two pictures of one subject that are too similar, or None."""
    if left.names[0] != right.names[0] or carries_on(left, right):
        return None
    angle, ratio = between(left, right), right.scale / left.scale
    if angle >= VIEWS_APART_RAD or not 1 / ALIKE_SIZE_RATIO < ratio < ALIKE_SIZE_RATIO:
        return None
    # Rounded down: "1.5 times smaller" would read as if it met the factor of 1.5.
    change = f"{at_most(ratio)} times as large" if ratio >= 1 else f"{at_most(1 / ratio)} times smaller"
    remedy = to_the_side(mission, after, left, right, VIEWS_APART_RAD)
    remedies = [remedy] if remedy else []
    remedies += _as_far(mission, after, right, ratio) or [
        f"begin {'it' if remedy else f'`{after.id}`'} much nearer or much farther away"
    ]
    return Diagnostic(
        "F002",
        f"the cut from `{before.id}` to `{after.id}` makes `{left.names[0]}` jump",
        (placing(mission, after, last=False), placing(mission, before, last=True, text="filmed from here")),
        (
            f"the camera moves {int(degrees(angle))} deg round it, which is then {change}; a cut needs "
            f"30 deg or more, or a size that changes by a factor of {ALIKE_SIZE_RATIO:.1f}",
        ),
        f"{', or '.join(remedies)}, or write `allow: [jump-cut]` in it",
    )


def _as_far(mission: MissionIR, after: Shot, right: ShotFrame, ratio: float) -> list[str]:
    """Return the distances at which the subject's size changes enough, for a shot with a distance.

    ratio : size after the cut over that before
    """
    path = (*after.path, "distance")
    if path not in mission.origins.values or (*path, 0) in mission.origins.values:
        return []
    x, y, z = right.offset
    distance = hypot(x, y, z)
    target = mission.target(right.names[0])
    near, far = distance * ratio / ALIKE_SIZE_RATIO, distance * ratio * ALIKE_SIZE_RATIO
    clear = target.radius + mission.rules.beside_target(mission.drone(after.drone).radius)
    remedies = [f"write `distance: {at_least(sqrt(far * far - z * z), 1)}` or more"]
    if near > hypot(clear, z):
        remedies.insert(0, f"write `distance: {at_most(sqrt(near * near - z * z), 1)}` or less")
    return remedies


def between(left: ShotFrame, right: ShotFrame) -> float:
    """Return the angle between two views of a subject, rad."""
    a, b = left.offset, right.offset
    product = sum(p * q for p, q in zip(a, b, strict=True))
    return acos(max(-1.0, min(1.0, product / (hypot(*a) * hypot(*b)))))


def carries_on(left: ShotFrame, right: ShotFrame) -> bool:
    """Return whether a shot begins with the picture with which the last one ends, so that no cut is
    visible.
    """
    if dist(left.eye, right.eye) > SAME_PLACE_SHARE * hypot(*left.offset):
        return False
    if not 1 / SAME_LENS_RATIO < left.half / right.half < SAME_LENS_RATIO:
        return False
    if not left.moving:
        return True
    return left.t is not None and right.t is not None and abs(right.t - left.t) < SAME_TIME_S


def to_the_side(mission: MissionIR, after: Shot, left: ShotFrame, right: ShotFrame, apart: float) -> str:
    """Return a remedy with a start at least ``apart`` rad from the view before the cut.

    The camera keeps its height and distance. Empty where these heights allow no such place, because from high
    above all sides look alike, and where the shot's kind has no key for an azimuth.
    """
    azimuth_deg = _azimuth(left.offset, right.offset, apart)
    if azimuth_deg is None:
        return ""
    azimuth = f"{azimuth_deg % 360} deg"
    if after.keyframes and after.keyframes[0].placed:
        return f"begin `{after.id}` at {_place(right, azimuth_deg)}"
    key = next((key for key in _KEYS if (*after.path, key) in mission.origins.values), None)
    if after.ideal is not None and after.kind == "framing":
        return f"begin `{after.id}` at an azimuth of {azimuth} from `{right.names[0]}`"
    return "" if key is None or after.ideal is not None else f"write `{key}: {azimuth}`"


def _azimuth(left: Vec3, right: Vec3, apart: float) -> int | None:
    """Return the azimuth of the nearer of the two sides, in whole degrees slightly beyond ``apart``.

    Two views at elevations e and f, with azimuths d apart, are acos(cos e cos f cos d + sin e sin f) apart.
    """
    across = hypot(*left[:2]) * hypot(*right[:2])
    if across < 1e-6:
        return None
    turn = (cos(apart) * hypot(*left) * hypot(*right) - left[2] * right[2]) / across
    if not -1.0 <= turn <= 1.0:
        return None
    middle, now = (degrees(atan2(x, y)) for x, y, _ in (left, right))
    turn_deg = degrees(acos(turn)) + 0.5  # so that a place rounded to centimetres is still beyond it
    azimuths = (ceil(middle + turn_deg), -ceil(turn_deg - middle))
    return min(azimuths, key=lambda candidate: abs(wrapped(radians(candidate - now))))


def _place(right: ShotFrame, azimuth: int) -> str:
    (x, y, _), (cx, cy, _) = right.offset, right.centres[0]
    far, angle = hypot(x, y), radians(azimuth)
    return f"[{cx + far * sin(angle):.2f}, {cy + far * cos(angle):.2f}, {right.eye[2]:.2f}]"
