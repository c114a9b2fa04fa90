"""Deadlines that are infeasible for any drone, from lower bounds on flight time without a solver.

Straight lines at full limits show what is infeasible, not what is feasible; ``plan`` finds that.
"""

from collections.abc import Iterable, Iterator
from itertools import pairwise
from typing import NamedTuple

from shotc.diag.model import Diagnostic, Label
from shotc.ir.drone import Drone
from shotc.ir.flown_order import flown_order
from shotc.ir.keyed import is_keyed
from shotc.ir.limits import Vec3
from shotc.ir.mission import MissionIR, Shot
from shotc.passes.resolve.checks.motion import least_shot, least_travel, length, less_wind
from shotc.rounding import at_least

_LESS = ("shorten the shot", "cut it in two for two flights")
ROUNDING_S = 1e-6  # seconds of rounding
SHORTEST = "`shotc plan` finds the shortest possible"
EARLIEST = "`shotc plan` finds the earliest possible"


def check_timing(mission: MissionIR, shots: Iterable[Shot], *, schedule: bool) -> list[Diagnostic]:
    """Return all faults of the own timings of ``shots``; if there is none, those of the order of all shots.

    schedule : whether to check the order at all; it needs shots with valid names, dependencies and places
    """
    faults: list[Diagnostic] = []
    for shot in shots:
        if is_keyed(shot):
            faults += _keyed_times(mission, shot)
        else:
            faults += _own_times(mission, shot) or _own_duration(mission, shot)
    return _schedule(mission) if schedule and not faults else faults


def _keyed_times(mission: MissionIR, shot: Shot) -> Iterator[Diagnostic]:
    """Yield the faults of the times of keyframes, or of the shot's duration."""
    duration, drone = shot.timing.duration or 0.0, mission.drone(shot.drone)
    if duration > drone.endurance:
        yield too_long(mission, shot, drone, duration)
        return
    holds = sum(k.hold for k in shot.keyframes)
    if holds >= duration > 0.0:
        held = [k for k in shot.keyframes if k.hold > 0]
        yield Diagnostic(
            "K003",
            f"shot `{shot.id}` holds longer than it lasts",
            tuple(mission.origins.value((*k.path, "hold")) for k in held),
            (f"its holds alone last {holds:.1f} s; the shot is given {duration:.1f} s",),
            f"give it more than {at_least(holds, 1)} s",
        )
        return
    yield from _keyed_order(mission, shot, duration)


def _keyed_order(mission: MissionIR, shot: Shot, duration: float) -> Iterator[Diagnostic]:
    """Yield keyframes whose time is not after the one before with its holds, or is after the end."""
    known = [(0, 0.0), *((i, k.time) for i, k in enumerate(shot.keyframes) if k.time is not None)]
    for (i, start), (j, end) in pairwise(known):
        a, b = shot.keyframes[i], shot.keyframes[j]
        holds = sum(k.hold for k in shot.keyframes[i:j])
        if j == 0 or end - start > holds + ROUNDING_S:
            continue
        labels = (
            mission.origins.value((*b.path, "time")),
            mission.origins.value((*a.path, "time"), "the earlier keyframe"),
        )
        held = f", and {holds:.1f} s of holds lie between" if holds else ""
        note = f"keyframe {j + 1} is at {end:.1f} s, keyframe {i + 1} before it at {start:.1f} s{held}"
        help_ = f"set it later than {at_least(start + holds, 1)} s"
        yield Diagnostic("K001", "keyframe times do not rise", labels, (note,), help_)
        return
    i, start = known[-1]
    last = len(shot.keyframes) - 1
    least = start + sum(k.hold for k in shot.keyframes[i:])
    if least < duration - ROUNDING_S or (i == last and least <= duration + ROUNDING_S):
        return
    yield Diagnostic(
        "K002",
        "a keyframe ends after its shot",
        (mission.origins.value((*shot.keyframes[i].path, "time")),),
        (f"with what follows it ends at {least:.1f} s; the shot lasts {duration:.1f} s",),
        f"give the shot a duration of {'' if i == last else 'more than '}{at_least(least, 1)} s",
    )


def _own_times(mission: MissionIR, shot: Shot) -> list[Diagnostic]:
    """Return the faults of keyframe times: order, duration of the shot, and flight time between them."""
    timed = [i for i, k in enumerate(shot.keyframes) if k.time is not None or i == 0]
    pairs = (_pair(mission, shot, i, j) for i, j in pairwise(timed))
    return [*(fault for fault in pairs if fault is not None), *_past_end(mission, shot)]


def _pair(mission: MissionIR, shot: Shot, i: int, j: int) -> Diagnostic | None:
    """Return the fault of two consecutive keyframes with a time, or None; the first one's default is 0."""
    a, b = shot.keyframes[i], shot.keyframes[j]
    start, end = a.time or 0.0, b.time or 0.0
    label = mission.origins.value((*b.path, "time"))
    stretch = shot.keyframes[i : j + 1]
    holds = sum(k.hold for k in stretch[:-1])
    least = holds + least_travel([k.at for k in stretch], mission.drone(shot.drone).limits, rests=False)
    help_ = f"set it later than {at_least(start + least, 1)} s; {EARLIEST}"
    if end <= start:
        labels = (label, mission.origins.value((*a.path, "time"), "the earlier keyframe"))
        note = f"keyframe {j + 1} is at {end:.1f} s, keyframe {i + 1} before it at {start:.1f} s"
        return Diagnostic("K001", "keyframe times do not rise", labels, (note,), help_)
    if end - start >= least - ROUNDING_S:
        return None
    note = f"the {length(stretch):.1f} m between them need at least {at_least(least, 1)} s"
    message = f"no drone gets there in the {end - start:.1f} s between keyframes {i + 1} and {j + 1}"
    return Diagnostic("K004", message, (label,), (note,), help_)


def _past_end(mission: MissionIR, shot: Shot) -> Iterator[Diagnostic]:
    """Yield keyframes that are reached, or held, after the end of a shot with a duration."""
    duration = shot.timing.duration
    limits = mission.drone(shot.drone).limits
    for i, keyframe in enumerate(shot.keyframes):
        if (
            duration is None
            or keyframe.time is None
            or keyframe.time + keyframe.hold <= duration + ROUNDING_S
        ):
            continue
        following = shot.keyframes[i:]
        end = keyframe.time + sum(k.hold for k in following)
        rest = least_travel([k.at for k in following], limits, rests=False)
        least = at_least(end + rest, 1)
        more = f"more than {least} s; {SHORTEST}" if rest > 0 else f"{least} s or more"
        held = f" and is held for {keyframe.hold:.1f} s" if keyframe.hold else ""
        yield Diagnostic(
            "K002",
            "a keyframe ends after its shot",
            (mission.origins.value((*keyframe.path, "time")),),
            (f"it is at {keyframe.time:.1f} s{held}; the shot lasts {duration:.1f} s",),
            f"give the shot a duration of {more}",
        )


def _own_duration(mission: MissionIR, shot: Shot) -> list[Diagnostic]:
    """Return the fault of a given duration against holds, straight-line flight and endurance.

    A duration that is too short is reported before the endurance, because the endurance is rarely the mistake
    then.
    """
    drone = mission.drone(shot.drone)
    least = least_shot(shot.keyframes, drone.limits)
    duration = shot.timing.duration
    if (least if duration is None else duration) > drone.endurance:
        return [too_long(mission, shot, drone, least)]
    if duration is None or duration >= least - ROUNDING_S:
        return []
    label = _duration_label(mission, shot)
    holds = sum(k.hold for k in shot.keyframes)
    if holds > duration + ROUNDING_S:
        held = [k for k in shot.keyframes if k.hold > 0]
        labels = (label, *(mission.origins.value((*k.path, "hold"), "a hold") for k in held))
        note = f"its holds alone last {holds:.1f} s; the shot is given {duration:.1f} s"
        message = f"shot `{shot.id}` holds longer than it lasts"
        return [Diagnostic("K003", message, labels, (note,), f"{_either(*_more(least))}; {SHORTEST}")]
    notes = [f"{_path_length_text(shot)} need {_pace(mission, shot, drone, least)}"]
    if least > drone.endurance:
        notes.append(f"that is longer than the endurance of {drone.endurance:.1f} s, too")
    message = f"shot `{shot.id}` cannot be flown in {duration:.1f} s"
    return [Diagnostic("K004", message, (label,), tuple(notes), _in_time(mission, shot, drone, least))]


def _in_time(mission: MissionIR, shot: Shot, drone: Drone, least: float) -> str:
    """Return what makes a shot feasible in its duration: less wind, or more time."""
    calmer = less_wind(mission, shot, drone, shot.timing.duration or 0.0)
    if least <= drone.endurance:
        return _either(*calmer, *_more(least)) + ("" if calmer else f"; {SHORTEST}")
    return _either(*(calmer or _LESS))


def _more(least: float) -> tuple[str, str]:
    return f"give it more than {at_least(least, 1)} s", "write `timing: auto`"


def _either(*choices: str) -> str:
    return ", or ".join(filter(None, (", ".join(choices[:-1]), choices[-1])))


def _path_length_text(shot: Shot) -> str:
    return f"the {length(shot.keyframes):.1f} m of its way"


def _pace(mission: MissionIR, shot: Shot, drone: Drone, least: float) -> str:
    holds = sum(k.hold for k in shot.keyframes)
    limits = drone.limits
    held = f", {holds:.1f} s of holds included" if holds else ""
    taken = mission.wind_taken
    wind = f" ({limits.speed + taken:.1f} less {taken:.1f} of wind)" if taken else ""
    if any(limits.wind):
        wind = f" through air that moves at {mission.wind:.1f} m/s"
    return (
        f"at least {at_least(least, 1)} s at {limits.speed:.1f} m/s across{wind}, {limits.climb:.1f} m/s up, "
        f"{limits.descent:.1f} m/s down and {limits.acceleration:.1f} m/s^2{held}"
    )


def too_long(mission: MissionIR, shot: Shot, drone: Drone, least: float) -> Diagnostic:
    """Return the fault of a shot that lasts longer than the endurance, as written or at least."""
    duration, calmer = shot.timing.duration, list[str]()
    seconds = f"lasts {duration:.1f} s" if duration is not None else f"takes at least {at_least(least, 1)} s"
    notes = [f"the shot {seconds}, the endurance is {drone.endurance_text}"]
    if duration is None:
        calmer = less_wind(mission, shot, drone, drone.endurance)
        if calmer:
            notes.append(f"{_path_length_text(shot)} need {_pace(mission, shot, drone, least)}")
    return Diagnostic(
        "K005",
        f"shot `{shot.id}` is longer than drone `{drone.name}` can stay in the air",
        (timing_label(mission, shot), mission.origins.value((*drone.path, "endurance"), "the endurance")),
        tuple(notes),
        _either(*(calmer or _LESS)),
    )


class _Moment(NamedTuple):
    """Where and when a drone is free: after ``shot``, or on its pad; take_off : latest possible one."""

    time: float
    at: Vec3 | None
    shot: Shot | None
    take_off: float


def _schedule(mission: MissionIR) -> list[Diagnostic]:
    """Return the faults of the order of shots, from the earliest start and end of each."""
    faults: list[Diagnostic] = []
    free = {d.name: _Moment(0.0, d.home, None, 0.0) for d in mission.drones}
    ends: dict[str, float] = {}
    for shot in flown_order(mission.shots):
        drone, before = mission.drone(shot.drone), free[shot.drone]
        # A shot of a moving target may leave its ideal, so its transfers have no bound.
        first, last = (
            (k.at for k in (shot.keyframes[0], shot.keyframes[-1])) if shot.ideal is None else (None, None)
        )
        there = before.time
        if first is not None and before.at is not None:
            there += least_travel([before.at, first], drone.limits)
        waits = ends.get(shot.timing.after or "", 0.0)
        start = shot.timing.start
        faults += _late(mission, shot, before, there, waits)
        begin = start if start is not None else max(there, waits)
        duration = shot.timing.duration
        seconds = duration if duration is not None else least_shot(shot.keyframes, drone.limits)
        take_off = begin - there if before.shot is None else before.take_off
        ends[shot.id] = begin + seconds
        free[drone.name] = _Moment(begin + seconds, last, shot, take_off)
    return faults or [f for d in mission.drones for f in _endurance(mission, d, free[d.name])]


def _late(mission: MissionIR, shot: Shot, before: _Moment, there: float, waits: float) -> list[Diagnostic]:
    """Return why a shot cannot begin at its ``start``, or nothing."""
    start = shot.timing.start
    if start is None or start >= max(there, waits) - ROUNDING_S:
        return []
    label = timing_label(mission, shot)
    remedy = f"start it later than {at_least(max(there, waits), 1)} s; {EARLIEST}"
    if start < waits - ROUNDING_S:
        return [waits_longer(mission, shot, waits, there)]
    if before.shot is not None and start < before.time - ROUNDING_S:
        note = f"`{before.shot.id}` ends at {before.time:.1f} s at the earliest; this starts at {start:.1f} s"
        message = f"shots `{before.shot.id}` and `{shot.id}` of drone `{shot.drone}` overlap"
        labels = (label, timing_label(mission, before.shot, "the other shot"))
        return [Diagnostic("K006", message, labels, (note,), remedy)]
    origin = "its home" if before.shot is None else f"the end of `{before.shot.id}`"
    note = f"from {origin} it takes at least {at_least(there - before.time, 1)} s to its first keyframe"
    message = f"drone `{shot.drone}` cannot be in place for shot `{shot.id}` at {start:.1f} s"
    return [Diagnostic("K008", message, (label,), (note,), remedy)]


def waits_longer(mission: MissionIR, shot: Shot, waits: float, there: float = 0.0) -> Diagnostic:
    """Return the fault of a shot that starts before the shot that it waits for has ended.

    waits : earliest end of that shot, seconds
    there : earliest arrival of its drone
    """
    note = f"`{shot.timing.after}` ends at {waits:.1f} s at the earliest"
    message = (
        f"shot `{shot.id}` starts at {shot.timing.start or 0.0:.1f} s, before the shot it waits for has ended"
    )
    remedy = f"start it later than {at_least(max(there, waits), 1)} s; {EARLIEST}"
    return Diagnostic("K007", message, (timing_label(mission, shot),), (note,), remedy)


def _endurance(mission: MissionIR, drone: Drone, last: _Moment) -> list[Diagnostic]:
    home = 0.0 if last.at is None else least_travel([last.at, drone.home], drone.limits)
    flight = last.time + home - last.take_off
    if last.shot is None or flight <= drone.endurance:
        return []
    message = f"the shots of drone `{drone.name}` take longer than it can stay in the air"
    note = f"all its shots with the ways between take at least {at_least(flight, 1)} s"
    speed = drone.limits.speed + mission.wind_taken
    taken = (f"the wind takes {mission.wind:.1f} of its {speed:.1f} m/s",) if mission.wind > speed / 2 else ()
    return [
        Diagnostic(
            "K005",
            message,
            (
                mission.origins.value((*drone.path, "endurance")),
                timing_label(mission, last.shot, "its last shot"),
            ),
            (f"{note}, its endurance is {drone.endurance_text}", *taken),
            "drop or shorten shots, or cut the mission in two",
        )
    ]


def _duration_label(mission: MissionIR, shot: Shot) -> Label:
    """Return a label on a shot's duration, or as ``timing_label`` where it has none."""
    path = (*shot.path, "timing", "duration")
    return mission.origins.value(path) if path in mission.origins.values else timing_label(mission, shot)


def timing_label(mission: MissionIR, shot: Shot, text: str = "") -> Label:
    """Return a label on a shot's `timing` key, or on the shot where it has none."""
    path = (*shot.path, "timing")
    if path in mission.origins.keys:
        return mission.origins.key(path, text)
    return mission.origins.value((*shot.path, "id"), text)
