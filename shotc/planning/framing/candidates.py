"""Candidates for a target's place on screen, and the one nearest to the place that the author framed.

By equations 1 and 2 of *framing*, screen places are compared as unit view directions, not as points of the
picture. A place is no candidate if the target would be cropped there, or if the gimbal cannot point to it.
"""

from collections.abc import Iterable
from math import hypot, inf, sqrt, tan
from typing import NamedTuple

from shotc.geom.camera import ROUNDING_M, aim_at, frustum_margins, view
from shotc.geom.shapes import TargetShape
from shotc.geom.vec import Vec2, Vec3
from shotc.ir.limits import Range
from shotc.ir.mission import Composition

# Metres out of the frame, or past the gimbal's stop at the target: half of verification's tolerance.
TOUCH_M = 0.5 * ROUNDING_M
TIE_M = 1e-9  # a later candidate must be nearer by more than this, so ties go to the first
LINE_SAMPLES = 32  # samples of a line whose nearest point is no candidate
MOST_HALVINGS = 40
GOLDEN_RATIO = (sqrt(5) - 1) / 2


class FixedCamera(NamedTuple):
    """A camera at a fixed position with free angles, and the target that it frames.

    offset : target's centre minus camera, W, metres
    shape : of the target
    hfov : rad
    aspect : width / height
    pitch : gimbal's range, rad
    yaw_if_vertical : yaw where the target is vertically above or below, rad
    """

    offset: Vec3
    shape: TargetShape
    hfov: float
    aspect: float
    pitch: Range
    yaw_if_vertical: float = 0.0

    def aim(self, uv: Vec2) -> Vec2 | None:
        """Return (yaw, pitch) that shows the target's centre at ``uv``; None where no angles do."""
        return aim_at(self.offset, uv, self.hfov, self.aspect, self.yaw_if_vertical)

    def margin(self, aim: Vec2) -> float:
        """Return the margin of the whole target inside the frame, metres; negative is cropped."""
        camera = view(aim[0], aim[1], self.hfov, self.aspect)
        return float(min(frustum_margins(camera, self.offset, self.shape)))

    def slack(self, uv: Vec2) -> float:
        """Return how far ``uv`` is inside the set of candidates, metres at the target; negative is
        outside.
        """
        aim = self.aim(uv)
        if aim is None:
            return -inf
        swing = min(aim[1] - self.pitch[0], self.pitch[1] - aim[1])
        return min(self.margin(aim), swing * hypot(*self.offset))

    def screen(self, aim: Vec2) -> Vec2 | None:
        """Return (u, v) of the target's centre for these angles; None behind the camera."""
        u, v, forward = view(aim[0], aim[1], self.hfov, self.aspect).project(self.offset)
        return (u, v) if forward > 0 else None

    def shows(self, aim: Vec2) -> bool:
        """Return whether any of the target's outline box is in the frame."""
        camera = view(aim[0], aim[1], self.hfov, self.aspect)
        if self.shape.nearest_depth(camera, self.offset) <= 0:
            # It reaches past the image plane and has no outline. Mirrored at the camera, a target wholly
            # outside one side of the frame lies wholly inside of that side.
            x, y, z = self.offset
            return bool(max(frustum_margins(camera, (-x, -y, -z), self.shape)) <= 0)
        left, right, low, high = self.shape.bounds(camera, self.offset)
        return bool(left < 1 and right > -1 and low < 1 and high > -1)

    def direction(self, uv: Vec2) -> Vec3:
        """Return the unit view direction of a screen place: right, up, forward."""
        half = tan(self.hfov / 2)
        x, y = uv[0] * half, uv[1] * half / self.aspect
        norm = sqrt(x * x + y * y + 1.0)
        return (x / norm, y / norm, 1.0 / norm)

    def apart(self, a: Vec2, b: Vec2) -> float:
        """Return the distance between two screen places as unit view directions (framing Eq. 2)."""
        return hypot(*(p - q for p, q in zip(self.direction(a), self.direction(b), strict=True)))


class ScreenLine(NamedTuple):
    """A line of the screen, u = c (upright) or v = c, with parameter t in [-1, 1]."""

    c: float
    upright: bool

    def point(self, t: float) -> Vec2:
        """Return (u, v) at ``t``."""
        return (self.c, t) if self.upright else (t, self.c)

    def foot(self, setting: FixedCamera, requested: Vec2) -> float:
        """Return the t whose view direction is nearest to that of ``requested``.

        With m the asked direction, the product of the line's unit direction with m is (a + b t) / sqrt(k +
        g^2 t^2). It has one extreme, at t = b k / (a g^2), and decreases on both sides of it; so the value
        clamped to the frame is still the nearest.
        """
        half_w = tan(setting.hfov / 2)
        fixed, free = (half_w, half_w / setting.aspect)
        m_fixed, m_free, m_forward = setting.direction(requested)
        if not self.upright:
            fixed, free, m_fixed, m_free = free, fixed, m_free, m_fixed
        a, b = m_fixed * self.c * fixed + m_forward, m_free * free
        if a <= 0:
            return 1.0 if b > 0 else -1.0
        return max(-1.0, min(1.0, b * (1.0 + (self.c * fixed) ** 2) / (a * free * free)))


def nearest_candidate(setting: FixedCamera, composition: Composition, requested: Vec2) -> Vec2 | None:
    """Return the candidate of the composition nearest to ``requested``, or None."""
    points = [p for p in composition.points if setting.slack(p) >= -TOUCH_M]
    lines = (
        *(ScreenLine(c, True) for c in composition.u_lines),
        *(ScreenLine(c, False) for c in composition.v_lines),
    )
    place = _nearest(setting, requested, (*points, *(_along(setting, line, requested) for line in lines)))
    return place or _nearest(
        setting, requested, (p for p in composition.last if setting.slack(p) >= -TOUCH_M)
    )


def nearest_on_verticals(setting: FixedCamera, composition: Composition, requested: Vec2) -> Vec2 | None:
    """Return the nearest candidate on the vertical lines through the set's points, or None.

    It is used where the target is cropped at every place of the set itself.
    """
    verticals = dict.fromkeys((*(u for u, _ in composition.points), *composition.u_lines))
    return _nearest(setting, requested, (_along(setting, ScreenLine(u, True), requested) for u in verticals))


def roomiest(setting: FixedCamera, composition: Composition) -> float:
    """Return the largest slack on the set's points and lines, and on the verticals through its points."""
    points = (*composition.points, *composition.last)
    verticals = dict.fromkeys((*(u for u, _ in points), *composition.u_lines))
    lines = (*(ScreenLine(u, True) for u in verticals), *(ScreenLine(c, False) for c in composition.v_lines))
    return max(setting.slack(line.point(_best(setting, line))) for line in lines)


def has_candidate(setting: FixedCamera, composition: Composition) -> bool:
    """Return whether the set itself has a candidate."""
    lines = (
        *(ScreenLine(c, True) for c in composition.u_lines),
        *(ScreenLine(c, False) for c in composition.v_lines),
    )
    return any(setting.slack(p) >= -TOUCH_M for p in (*composition.points, *composition.last)) or any(
        setting.slack(line.point(_best(setting, line))) >= -TOUCH_M for line in lines
    )


def _nearest(setting: FixedCamera, requested: Vec2, places: Iterable[Vec2 | None]) -> Vec2 | None:
    best: Vec2 | None = None
    for place in places:
        if place is None:
            continue
        if best is None or setting.apart(requested, place) < setting.apart(requested, best) - TIE_M:
            best = place
    return best


def _along(setting: FixedCamera, line: ScreenLine, requested: Vec2) -> Vec2 | None:
    """Return the candidate of the line nearest to ``requested``, or None.

    The distance increases away from the foot, so the first candidate on either side of it is the nearest of
    that side.
    """
    foot = line.foot(setting, requested)
    if setting.slack(line.point(foot)) >= -TOUCH_M:
        return line.point(foot)
    peaks = _peaks(setting, line)
    if all(setting.slack(line.point(t)) < -TOUCH_M for t in peaks):
        return None
    ends = [_first(setting, line, (foot, end), peaks) for end in (-1.0, 1.0)]
    return _nearest(setting, requested, (line.point(t) for t in ends if t is not None))


def _best(setting: FixedCamera, line: ScreenLine) -> float:
    """Return the t of the largest slack."""
    return max(_peaks(setting, line), key=lambda t: setting.slack(line.point(t)))


def _peaks(setting: FixedCamera, line: ScreenLine) -> list[float]:
    """Return the t of every local maximum of the slack in an even sample.

    The slack may have several, of equal height on a level line; each belongs to an interval where the target
    may fit.
    """
    steps = [-1.0 + 2.0 * i / LINE_SAMPLES for i in range(LINE_SAMPLES + 1)]
    slacks = [-inf, *(setting.slack(line.point(t)) for t in steps), -inf]
    tops = [
        t
        for t, left, here, right in zip(steps, slacks, slacks[1:], slacks[2:], strict=False)
        if left <= here >= right and here > -inf
    ]
    return [_summit(setting, line, t) for t in tops] or [0.0]


def _summit(setting: FixedCamera, line: ScreenLine, middle: float) -> float:
    """Return the t of the largest slack within a step of ``middle``, by golden section."""

    def slack(t: float) -> float:
        return setting.slack(line.point(t))

    low, high = max(-1.0, middle - 2.0 / LINE_SAMPLES), min(1.0, middle + 2.0 / LINE_SAMPLES)
    left, right = high - GOLDEN_RATIO * (high - low), low + GOLDEN_RATIO * (high - low)
    at_left, at_right = slack(left), slack(right)
    for _ in range(MOST_HALVINGS):
        if at_left >= at_right:
            high, right, at_right = right, left, at_left
            left = high - GOLDEN_RATIO * (high - low)
            at_left = slack(left)
        else:
            low, left, at_left = left, right, at_right
            right = low + GOLDEN_RATIO * (high - low)
            at_right = slack(right)
    return max(middle, (low + high) / 2, key=slack)


def _first(setting: FixedCamera, line: ScreenLine, side: Vec2, peaks: list[float]) -> float | None:
    """Return the first candidate from the foot to an end of the line, its border bisected; None if none."""
    foot, end = side
    steps = [foot + (end - foot) * i / LINE_SAMPLES for i in range(1, LINE_SAMPLES + 1)]
    # An interval of candidates too short for the sample is found at its peak.
    steps += [t for t in peaks if (t - foot) * (end - foot) > 0]
    steps.sort(key=lambda t: abs(t - foot))
    outside = foot
    for step in steps:
        if setting.slack(line.point(step)) >= -TOUCH_M:
            return _border(setting, line, outside, step)
        outside = step
    return None


def _border(setting: FixedCamera, line: ScreenLine, outside: float, inside: float) -> float:
    """Return where candidates begin, by bisection; there the whole target is inside the frame if possible."""
    least = min(TOUCH_M, setting.slack(line.point(inside)))
    for _ in range(MOST_HALVINGS):
        middle = (outside + inside) / 2
        if setting.slack(line.point(middle)) >= least:
            inside = middle
        else:
            outside = middle
    return inside
