"""Whether a drone keeps up with the ideal of a shot, and remedies in the shot.

A shot without a written `start` is checked if the end of the shot before it is known, or if its start does
not matter; otherwise planning checks it. A remedy is tried before it is proposed: the ideal is evaluated
again with the new number.

A place that swings round as its target turns a corner is too fast for a moment only. That is no fault if the
drone can stay near it: it leads its place before the corner, and follows it after.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import pairwise
from math import dist, hypot, inf

from shotc.diag.model import Diagnostic
from shotc.geom.track import Track
from shotc.geom.vec import Vec2, Vec3
from shotc.ir.begins import first_start, known_start
from shotc.ir.drone import Drone
from shotc.ir.framed import course_of
from shotc.ir.ideal import CATCH_UP_RATIO, ideal_place
from shotc.ir.keyed import carriers, is_keyed, settled
from shotc.ir.mission import MissionIR, Shot
from shotc.ir.preference import MOST_MOVED_SHARE
from shotc.rounding import at_most, down, up

WINDOW_S = 2.0  # seconds over which the mean speed is measured
IDEAL_SAMPLES = 200  # samples of an ideal
SPAN_HALVINGS = 7  # bisection steps between the nearest distance and the written one
LATER_S = (0.0, 6.0, 12.0, 18.0, 24.0, 30.0)  # seconds of candidate starts after the earliest one
LONGER_RATIOS = (
    1.0,
    1.05,
    1.2,
    1.5,
    2.0,
)  # factors of the duration that is sufficient beside a standing target
SPEED_ROUNDING_SHARE = 1e-6  # relative tolerance of a speed

LEVEL = ("distance", "radius", "offset")
"""Keys of a shot for its horizontal distance from the target; the last is the sideways distance alone."""


def check_speed(mission: MissionIR, shot: Shot) -> Iterator[Diagnostic]:
    """Yield the fault of an ideal that is too fast for the drone, for every possible start."""
    drone, starts = mission.drone(shot.drone), _starts(mission, shot)
    limit = drone.limits.speed
    if not starts or any(_follows(mission, shot, t, limit * (1 + SPEED_ROUNDING_SHARE)) for t in starts):
        return
    worst, when = _fastest(mission, shot, starts[0])
    through = " through the air" if any(drone.limits.wind) else ""
    open_ = len(starts) > 1
    early = f"; the shot begins at {starts[0]:.1f} s at the earliest" if open_ else ""
    taken = mission.wind_taken
    wind = f" ({limit + taken:.1f} less {taken:.1f} of wind)" if taken else ""
    window = min(WINDOW_S, shot.timing.duration or 0.0)
    remedies = [
        *_nearer(mission, shot, drone),
        *_other_side(mission, shot, limit),
        *_longer(mission, shot, worst / limit),
        *_less_at_once(mission, shot, worst / limit),
        *_straight(mission, shot, limit),
        f"raise `{_faster(mission, shot, worst, starts[0])}` of `{drone.name}` if it flies that",
        *_slower(mission, shot, worst / limit),
    ]
    yield Diagnostic(
        "M005",
        f"drone `{drone.name}` cannot keep up in shot `{shot.id}`",
        (
            mission.origins.value((*shot.path, "kind")),
            mission.origins.value((*drone.path, "limits", "speed"), "the drone's speed"),
            *((mission.origins.value(("world", "wind"), "the wind"),) if through else ()),
        ),
        (
            f"its place moves at {worst:.1f} m/s{through} over {window:.1f} s from t = {when:.1f} s; "
            f"the drone flies {limit:.1f} m/s{wind}{early}",
        ),
        ", or ".join(remedies),
    )


def _faster(mission: MissionIR, shot: Shot, speed: float, start: float) -> str:
    """Return limits with which the drone keeps up, as they are written.

    They include an acceleration where the ideal changes its velocity faster than the drone can. If the target
    never stops, a drone of equal speed never reaches its place, so the speed is higher.
    """
    if _goes_on(mission, shot):
        speed *= CATCH_UP_RATIO
    limits = f"speed: {up(speed + mission.wind_taken, 1):.1f} m/s"
    needed = _hardest(mission, shot, start)
    if needed > mission.drone(shot.drone).limits.acceleration * (1 + SPEED_ROUNDING_SHARE):
        limits += f", acceleration: {up(needed, 1):.1f} m/s^2"
    return f"limits: {{{limits}}}"


def _goes_on(mission: MissionIR, shot: Shot) -> bool:
    """Return whether the ideal moves with a target that never stops."""
    own = shot.ideal.target if shot.ideal is not None else None
    names = carriers(shot) if is_keyed(shot) else (own,) if own is not None else ()
    tracks = [mission.target(name).track for name in names]
    return any(track is not None and any(track.after) for track in tracks)


def _hardest(mission: MissionIR, shot: Shot, start: float) -> float:
    """Return the largest change of the mean velocity from one window to the next, m/s^2.

    A drone that is at its place at the ends of both windows has to change its velocity as much.
    """
    if is_keyed(shot):
        shot = settled(mission, shot, start)
    duration = shot.timing.duration or 0.0
    window = min(WINDOW_S, duration / 2)
    delays = [0.0]
    for i in range(IDEAL_SAMPLES + 1):
        t = start + (duration - 2 * window) * i / IDEAL_SAMPLES
        a, b, c = (ideal_place(mission, shot, start, t + k * window) for k in range(3))
        delays.append(dist([2 * m for m in b], [p + n for p, n in zip(a, c, strict=True)]) / window**2)
    return max(delays)


def _starts(mission: MissionIR, shot: Shot) -> tuple[float, ...]:
    """Return possible starts of a shot, seconds, the earliest first; empty where they are unknown."""
    known, ideal = known_start(mission, shot), shot.ideal
    first = first_start(mission, shot)
    if shot.timing.start is not None or (known is not None and ideal is not None and ideal.framed):
        return (first,)  # the ideal of a framing is that of its earliest start
    if known is not None:
        return tuple(first + late for late in LATER_S)
    return (first,) if _is_even(mission, shot) else ()


def _is_even(mission: MissionIR, shot: Shot) -> bool:
    """Return whether the ideal's motion is independent of the start: fixed in W, or with a uniform target."""
    if shot.ideal is None or shot.ideal.framed:
        return shot.ideal is not None and not _tracks(mission, shot)
    if is_keyed(shot):
        tracks = {mission.target(name).track for name in carriers(shot)} - {None}
        along = all(k.beside is not None for k in shot.keyframes)
        return along and len(tracks) == 1 and all(len(t.times) == 1 for t in tracks if t is not None)
    track = None if shot.ideal.target is None else mission.target(shot.ideal.target).track
    return track is None or (len(track.times) == 1 and track.times[0] <= track.since)


def _fastest(mission: MissionIR, shot: Shot, start: float) -> tuple[float, float]:
    """Return the largest mean speed over a window, m/s, and its time, for a shot that begins at ``start``.

    It is the airspeed where the wind is known.
    """
    wind = mission.drone(shot.drone).limits.wind
    if is_keyed(shot):
        shot = settled(mission, shot, start)
    duration = shot.timing.duration or 0.0
    window = min(WINDOW_S, duration)
    speeds = []
    for i in range(IDEAL_SAMPLES + 1):
        t = start + (duration - window) * i / IDEAL_SAMPLES
        a, b = (ideal_place(mission, shot, start, u) for u in (t, t + window))
        speeds.append((hypot(b[0] - a[0] - wind[0] * window, b[1] - a[1] - wind[1] * window) / window, -t))
    worst, late = max(speeds)
    return worst, -late


def _follows(mission: MissionIR, shot: Shot, start: float, limit: float) -> bool:
    """Return whether a drone keeps up with the ideal over every window, or stays near it where it does not.

    It stays near if the target itself is slow enough, and half of the distance that the drone loses where its
    place swings round is at most the share of the distance to the target by which a preference may move a
    camera. It can lose the one half before its place and the other behind.
    """
    if _fastest(mission, shot, start)[0] <= limit:
        return True
    ideal, duration = shot.ideal, shot.timing.duration or 0.0
    if ideal is None or ideal.target is None or ideal.frame != "heading" or ideal.framed:
        return False
    target, step = mission.target(ideal.target), duration / IDEAL_SAMPLES
    times = [start + step * i for i in range(IDEAL_SAMPLES + 1)]
    wind = mission.drone(shot.drone).limits.wind
    centres, places = [target.at(t) for t in times], [ideal_place(mission, shot, start, t) for t in times]
    if max(_through_air(centres, wind, step)) > limit * step:
        return False
    lost = most = 0.0
    for flown in _through_air(places, wind, step):
        lost = max(0.0, lost + flown - limit * step)
        most = max(most, lost)
    return most / 2 <= MOST_MOVED_SHARE * min(dist(p, c) for p, c in zip(places, centres, strict=True))


def _through_air(course: list[Vec3], wind: Vec2, step: float) -> list[float]:
    """Return the horizontal way through the air between the places of a course, a step apart, metres."""
    return [hypot(b[0] - a[0] - wind[0] * step, b[1] - a[1] - wind[1] * step) for a, b in pairwise(course)]


def _keeps_up(mission: MissionIR, shot: Shot, limit: float) -> bool:
    return all(_follows(mission, shot, t, limit) for t in _starts(mission, shot))


def _nearer(mission: MissionIR, shot: Shot, drone: Drone) -> Iterator[str]:
    """Yield the largest distance at which the drone keeps up, if that is clear of the target."""
    ideal, limit = shot.ideal, drone.limits.speed
    key = next((key for key in LEVEL if (*shot.path, key) in mission.origins.values), None)
    if key is None or ideal is None or ideal.target is None:
        return
    first, last = ideal.points[0][1], ideal.points[-1][1]
    given = abs(first[1]) if key == "offset" else hypot(first[0], first[1])
    end = hypot(last[0], last[1]) / given if (*shot.path, key, 0) in mission.origins.values else 1.0
    least = mission.target(ideal.target).radius + mission.rules.beside_target(drone.radius)
    least /= min(1.0, end)

    def at(metres: float) -> Shot:
        share = metres / given
        return _moved(shot, lambda p: (p[0] * (1.0 if key == "offset" else share), p[1] * share, p[2]))

    low, high = up(least, 1), given
    if low >= high or not _keeps_up(mission, at(low), limit):
        return
    for _ in range(SPAN_HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if _keeps_up(mission, at(middle), limit) else (low, middle)
    nearer = max(up(least, 1), down(low, 1))
    if _keeps_up(mission, at(nearer), limit):
        if end != 1.0:  # from one value to another
            yield f"give it `{key}: [{nearer:.1f} m, {up(nearer * end, 1):.1f} m]` or nearer"
            return
        # An offset to the right has a negative sign.
        yield f"give it `{key}: {-nearer if key == 'offset' and first[1] < 0 else nearer:.1f} m` or nearer"


def _other_side(mission: MissionIR, shot: Shot, limit: float) -> Iterator[str]:
    """Yield the other side, if the drone is on the inside of a bend there."""
    if (*shot.path, "side") not in mission.origins.values or shot.ideal is None:
        return
    other = "right" if shot.ideal.points[0][1][1] > 0 else "left"
    if _keeps_up(mission, _moved(shot, lambda p: (p[0], -p[1], p[2])), limit):
        yield f"film from the other `side: {other}`"


def _longer(mission: MissionIR, shot: Shot, share: float) -> Iterator[str]:
    """Yield a longer duration, where the shot moves around its target or along its own path."""
    if shot.ideal is None or len({p for _, p in shot.ideal.points}) < 2:
        return
    if any(k.time is not None for k in shot.keyframes[1:]) or any(s.setpoints for s in shot.subjects):
        return
    duration, start = shot.timing.duration or 0.0, first_start(mission, shot)
    track_end = min((track.until for track in _tracks(mission, shot)), default=inf)
    for more in LONGER_RATIOS:
        seconds = up(duration * share * more, 1)
        longer = shot._replace(timing=shot.timing._replace(duration=seconds))
        if start + seconds <= track_end and _keeps_up(
            mission, longer, mission.drone(shot.drone).limits.speed
        ):
            yield f"give it `duration: {seconds:.1f} s`"
            return


def _less_at_once(mission: MissionIR, shot: Shot, share: float) -> Iterator[str]:
    """Yield times for the setpoints of a framing that are farther apart, in a longer shot."""
    if not any(s.setpoints for s in shot.subjects):
        return
    start, limit = first_start(mission, shot), mission.drone(shot.drone).limits.speed
    for more in LONGER_RATIOS:
        longer = _stretched(shot, share * more)
        ends = start + (longer.timing.duration or 0.0)
        known = all(ends <= t.until for t in _tracks(mission, shot))
        if known and _fastest(mission, course_of(mission, longer, start).shot, start)[0] <= limit:
            times = [s.time for subject in longer.subjects for s in subject.setpoints]
            apart = ", ".join(f"{time:g} s" for time in dict.fromkeys(times))
            seconds = f"{longer.timing.duration:g} s"
            more_time = f"{share * more:.1f} times the time"
            yield f"give it `duration: {seconds}` and its setpoints {more_time} ({apart})"
            return


def _tracks(mission: MissionIR, shot: Shot) -> list[Track]:
    tracks = (mission.target(name).track for name in carriers(shot))
    return [track for track in tracks if track is not None]


def _stretched(shot: Shot, times: float) -> Shot:
    """Return a framing with its duration and its setpoints' times multiplied by ``times``."""
    subjects = tuple(
        s._replace(setpoints=tuple(p._replace(time=up(p.time * times, 1)) for p in s.setpoints))
        for s in shot.subjects
    )
    timing = shot.timing._replace(duration=up((shot.timing.duration or 0.0) * times, 1))
    return shot._replace(subjects=subjects, timing=timing)


def _straight(mission: MissionIR, shot: Shot, limit: float) -> Iterator[str]:
    """Yield the remedy that keyframes do not turn with their target, if the turns make the ideal too fast."""
    if not any(k.beside is not None and k.beside.turns for k in shot.keyframes):
        return
    along = tuple(
        k if k.beside is None else k._replace(beside=k.beside._replace(turns=False)) for k in shot.keyframes
    )
    if _keeps_up(mission, shot._replace(keyframes=along), limit):
        yield "leave `turn: course` out, which swings the camera round where the target bends"


def _slower(mission: MissionIR, shot: Shot, share: float) -> Iterator[str]:
    """Yield the remedy to slow the target down, where the mission gives its speed.

    share : how many times as fast as the drone the camera would have to be
    """
    ideal = shot.ideal
    if ideal is None or ideal.target is None:
        return
    path = (*mission.target(ideal.target).path, "track")
    if any((*path, key) in mission.origins.values for key in ("speed", "velocity", "times")):
        known_wind = mission.drone(shot.drone).limits.wind != (0.0, 0.0)
        far = "" if known_wind else f" to {at_most(1.0 / share)} times its speed"
        yield f"slow down `{ideal.target}`{far}"


def _moved(shot: Shot, move: Callable[[Vec3], Vec3]) -> Shot:
    """Return a shot with its places beside the target moved."""
    assert shot.ideal is not None
    points = tuple((share, move(p)) for share, p in shot.ideal.points)
    return shot._replace(ideal=shot.ideal._replace(points=points))
