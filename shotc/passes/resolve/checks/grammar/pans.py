"""Pans: speed of the surroundings through the picture while the camera turns, by the rule of ``geom.pan``."""

from collections.abc import Iterator, Sequence
from itertools import pairwise
from math import acos, ceil, cos, hypot, pi, tan
from typing import NamedTuple

from shotc.diag.model import Diagnostic, Label
from shotc.geom.pan import WINDOW_S, slowest, whose
from shotc.geom.vec import TURN_RAD, minus, wrapped
from shotc.ir.limits import Vec2, Vec3
from shotc.ir.mission import Keyframe, MissionIR, Shot
from shotc.passes.resolve.checks.grammar.end_frames import sight, start_of
from shotc.passes.resolve.checks.grammar.labels import lasting
from shotc.passes.resolve.checks.timing import ROUNDING_S
from shotc.planning.framing.placing import ROUNDING_RAD, explicit_aim
from shotc.rounding import at_least

MOST_PIECES = 120  # most pieces of such a shot


class PanStretch(NamedTuple):
    """An interval of a shot with its turn.

    widths : frame widths that pass through the picture
    seconds : its duration
    held : rest within it, seconds
    followed : the subject that the camera follows, or None
    when : mission time of its start, for a shot on its own clock
    start : seconds into the shot, for an interval between keyframes
    last : the last of these keyframes
    """

    widths: float
    seconds: float
    followed: str | None
    held: float = 0.0
    when: float | None = None
    start: float = 0.0
    last: int = -1

    @property
    def least(self) -> float:
        """The least time that the turn has to take, seconds."""
        return self.widths * slowest(self.followed)


def check_pans(mission: MissionIR, shot: Shot) -> Iterator[Diagnostic]:
    """Yield the worst of a shot's pans that are too fast; those with unknown times are skipped."""
    pans = list(_on_clock(mission, shot) if shot.ideal is not None else _between_keyframes(mission, shot))
    fast = [pan for pan in pans if pan.seconds > 0 and pan.seconds < pan.least - ROUNDING_S]
    if not fast:
        return
    worst = max(fast, key=lambda pan: pan.least / pan.seconds)
    when = "" if worst.when is None else f" at t = {worst.when:.1f} s"
    label, help_ = lasting(mission, shot), "film it from farther away, or with a wider field of view"
    if worst.when is None:
        label, help_ = _slower(mission, shot, worst)
    yield Diagnostic(
        "F005",
        f"shot `{shot.id}` pans too fast for the eye",
        (label,),
        (
            f"a frame width goes by in {worst.seconds / worst.widths:.1f} s{when}; {whose(worst.followed)} "
            f"{slowest(worst.followed):.0f} s or more are needed to avoid judder at 24 frames a second",
        ),
        f"{help_}, or write `allow: [fast-pan]` in it",
    )


def _slower(mission: MissionIR, shot: Shot, pan: PanStretch) -> tuple[Label, str]:
    """Return a label on the time or duration that ends a pan between keyframes, and the value to write."""
    last, end = shot.keyframes[pan.last], pan.start + pan.held + pan.least
    if last.time is None:
        return lasting(mission, shot), f"write `duration: {at_least(end + last.hold, 1)} s` or more"
    later = shot.timing.duration is not None or any(
        k.time is not None for k in shot.keyframes[pan.last + 1 :]
    )
    with_it = ", and move what follows by as much" if later else ""
    return mission.origins.value((*last.path, "time")), f"write `time: {at_least(end, 1)} s` or more{with_it}"


def _on_clock(mission: MissionIR, shot: Shot) -> Iterator[PanStretch]:
    """Yield the pans of a camera that follows a moving subject, over a second each."""
    start, duration = start_of(mission, shot), shot.timing.duration
    has_aim = shot.ideal is not None and shot.ideal.aim is not None
    if start is None or duration is None or has_aim or not shot.subjects:
        return
    if shot.keyframes and _followed(shot.keyframes) is None:
        return
    pieces = max(2, min(MOST_PIECES, ceil(4 * duration)))
    ahead = min(pieces, max(1, round(WINDOW_S * pieces / duration)))
    looks: list[Vec3 | None] = []
    for i in range(pieces + 1):
        seen = sight(mission, shot, i / pieces)
        looks.append(None if seen is None else seen.offset)
    hfov = min((k.hfov for k in shot.keyframes), default=mission.drone(shot.drone).hfov)
    width = 2 * tan(hfov / 2)
    who = shot.subjects[0].target
    seconds = duration * ahead / pieces
    for i, (a, b) in enumerate(zip(looks, looks[ahead:], strict=False)):
        if a is not None and b is not None:
            yield PanStretch(_angle(a, b) / width, seconds, who, when=start + duration * i / pieces)


def _between_keyframes(mission: MissionIR, shot: Shot) -> Iterator[PanStretch]:
    """Yield the intervals of a shot between keyframes with known times, each with its mean rate."""
    keyframes, duration = shot.keyframes, shot.timing.duration
    times: dict[int, float] = {0: 0.0}
    if duration is not None:
        times[len(keyframes) - 1] = duration - keyframes[-1].hold
    times |= {i: k.time for i, k in enumerate(keyframes) if k.time is not None}
    looks = _looks(mission, keyframes)
    for i, j in pairwise(sorted(times)):
        stretch = keyframes[i : j + 1]
        held = sum(k.hold for k in stretch[:-1])
        widths = sum(_turned(keyframes, looks, k) for k in range(i, j))
        yield PanStretch(widths, times[j] - times[i] - held, _followed(stretch), held, start=times[i], last=j)


def _looks(mission: MissionIR, keyframes: Sequence[Keyframe]) -> list[Vec2]:
    """Return yaw and pitch of the camera at every keyframe, before composition changes them slightly."""
    looks: list[Vec2] = []
    for keyframe in keyframes:
        aim: Vec2 | Vec3 | None = keyframe.aim
        if aim is None and keyframe.target is not None:
            aim = mission.target(keyframe.target).centre
        last = looks[-1] if looks else (pi / 2, 0.0)
        looks.append(last if aim is None else explicit_aim(keyframe.at, aim, last[0]))
    return looks


def _turned(keyframes: Sequence[Keyframe], looks: Sequence[Vec2], i: int) -> float:
    """Return the frame widths by which the camera turns from a keyframe to the next one."""
    a, b = looks[i], looks[i + 1]
    stated, before = keyframes[i + 1].heading, keyframes[i].heading
    if stated is not None and before is not None and abs(stated) >= TURN_RAD - ROUNDING_RAD:
        yaw = stated - before
    else:
        yaw = wrapped(b[0] - a[0])
    angle = hypot(yaw * cos(0.5 * (a[1] + b[1])), b[1] - a[1])
    return angle / (tan(keyframes[i].hfov / 2) + tan(keyframes[i + 1].hfov / 2))


def _followed(stretch: Sequence[Keyframe]) -> str | None:
    """Return the subject that the camera follows throughout an interval, or None."""
    first = stretch[0].target
    if any(k.target != first or k.composition.watches for k in stretch):
        return None
    return first


def _angle(a: Vec3, b: Vec3) -> float:
    chord = hypot(*minus((0.0, 0.0, 0.0), a))
    product = sum(p * q for p, q in zip(a, b, strict=True)) / (chord * hypot(*b))
    return acos(max(-1.0, min(1.0, product)))
