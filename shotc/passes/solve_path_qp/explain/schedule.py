"""Diagnostics of shots on the clock, and of transfers, that are infeasible in time."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from shotc.diag.model import Diagnostic, Severity
from shotc.diag.registry import severity_of
from shotc.ir.drone import Drone
from shotc.ir.framed import at_start
from shotc.ir.ideal import CATCH_UP_RATIO, ideal_place
from shotc.ir.mission import MissionIR, Shot
from shotc.passes.labels import phases_in_words, timing_value
from shotc.planning.clock.starts import Meets, OutsideTrack, TooLate
from shotc.rounding import at_least, down, plain, up

ALONE = "or have the drone start nearer"
WINDOW_S = 2.0  # seconds over which the speed of the ideal is measured


def outside_track(mission: MissionIR, shot: Shot, outside: OutsideTrack) -> Diagnostic:
    """Return M010: the drone arrives so late that the track ends before the shot does."""
    track = mission.target(outside.target).track
    track_end = 0.0 if track is None else track.until
    end = outside.start + (shot.timing.duration or 0.0)
    labels = (
        mission.origins.value((*shot.path, "id")),
        mission.origins.value((*mission.target(outside.target).path, "track"), "the track"),
    )
    short = _shortened(outside)
    remedy = f"give it {short}" if short else "give the track more rows"
    later = "let its recording begin later by `begins`, " if _recorded(mission, shot) else ""
    return Diagnostic(
        "M010",
        f"the track of `{outside.target}` ends before shot `{shot.id}` does",
        labels,
        (
            f"the drone is in place at {outside.start:.1f} s at the earliest, so the shot ends at "
            f"{end:.1f} s; the track ends at {track_end:.1f} s",
        ),
        f"{remedy}, {later}{ALONE}",
    )


def too_late(mission: MissionIR, shot: Shot, late: TooLate) -> Diagnostic:
    """Return T003: the drone arrives after the start of a shot on its own clock."""
    start, short = shot.timing.start, late.outside
    label = mission.origins.key(shot.path) if start is None else timing_value(mission, shot.path, "start")
    starts = "has no start" if start is None else f"starts at {plain(start)} s"
    labels, beginning = [label], f"shot `{shot.id}` {starts}"
    stop = "without a stop on the last transit"
    if late.run_up is not None:
        stop = f"with a stop before the run-up, which is the last {late.run_up:.1f} s"
    sum_up = f"{at_least(late.before[-1].end)} s, {stop}"
    notes = [f"before it come {phases_in_words(late.before)}: {sum_up}"]
    remedies = []
    if late.earliest is not None:
        # A drone that does not stop before its run-up would be there earlier; no such way is planned.
        message = f"{beginning}, but {at_least(late.earliest)} s is the earliest that is found"
        remedies.append(
            f"give it `start: {at_least(late.earliest)} s`" + (" or later" if short is None else "")
        )
    elif short is not None:
        message = f"{beginning}, and the track of `{short.target}` ends before its drone is there"
    else:
        message = f"{beginning}, and its drone does not catch up with what it films"
        remedies += _catching_up(mission, shot, late.before[-1].end)
    if short is not None:
        path = mission.target(short.target).path
        labels.append(mission.origins.value((*path, "track"), f"{short.left:.1f} s are left of it then"))
        remedies = [f"{remedy} and {_shortened(short)}" for remedy in remedies]
    if start is not None:
        remedies += _begun_later(mission, shot, start, up(late.late))
    remedies.append(f"shorten what comes before, {ALONE}")
    return Diagnostic("T003", message, tuple(labels), tuple(notes), ", or ".join(remedies))


def _catching_up(mission: MissionIR, shot: Shot, time: float) -> list[str]:
    """Return the speed limit with which the drone could catch up with the ideal, as a remedy; or nothing."""
    drone = mission.drone(shot.drone)
    begun = at_start(mission, shot, time)
    places = [ideal_place(mission, begun, time, time + t) for t in (0.0, WINDOW_S)]
    east, north = (CATCH_UP_RATIO * (b - a) / WINDOW_S for a, b in zip(*(p[:2] for p in places), strict=True))
    speed = drone.limits.airspeed(east, north)
    if speed <= drone.limits.speed:
        return []
    return [
        f"raise `limits: {{speed: {at_least(speed + mission.wind_taken, 1)} m/s}}` of `{drone.name}` "
        "if it flies that"
    ]


def way_met(mission: MissionIR, drone: Drone, shot: Shot | None, meets: Meets) -> Diagnostic:
    """Return M011: every transfer to a shot comes too near to a target; the way home where that is None."""
    met = meets.met
    if met.phase != "transit":
        return _pad_met(mission, drone, meets)
    lead = "on its way home" if shot is None else f"on every way to shot `{shot.id}`"
    where = (
        mission.origins.value((*drone.path, "home"), "on the way back here")
        if shot is None
        else mission.origins.key(shot.path, "on the way to this shot")
    )
    remedies = [f"start the shot at {at_least(meets.start)} s"] if meets.start is not None else []
    remedies.append(f"put `home` where {met.owner.words} is not between it and the shots")
    return Diagnostic(
        "M011",
        f"`{drone.name}` comes too near to {met.owner.words} {lead}",
        (where, mission.origins.key(met.owner.path, "is in the way")),
        (
            f"on the best of them its body is {at_least(met.lack)} m nearer than "
            f"`target_clearance` allows, at t = {met.time:.1f} s",
            "straight, round and over what is in the way were tried, and setting out at other times",
        ),
        ", or ".join(remedies),
    )


def out_of_turn(
    mission: MissionIR, order: Sequence[Drone], refused: Sequence[Diagnostic]
) -> Iterator[Diagnostic]:
    """Yield M038 for each drone that gives way to one of a later priority.

    order : of planning
    refused : diagnostics of planning in order of priority
    """
    errors = tuple(d.message for d in refused if severity_of(d) is Severity.ERROR)
    for k, ahead in enumerate(order):
        for drone in (d for d in order[k + 1 :] if d.priority < ahead.priority):
            yield Diagnostic(
                "M038",
                f"drone `{drone.name}` gives way to `{ahead.name}`, which has a later `priority`",
                (
                    mission.origins.value((*ahead.path, "priority")),
                    mission.origins.value((*drone.path, "priority"), "planned after it"),
                ),
                tuple(f"in order of priority {message}" for message in errors),
                f"write `priority: {drone.priority}` in `{ahead.name}`, too, or give the shots more room",
            )


def _pad_met(mission: MissionIR, drone: Drone, meets: Meets) -> Diagnostic:
    """Return M013: a target is above the pad whenever the drone could take off or land."""
    met = meets.met
    target = mission.target(met.owner.name)
    verb = "take off" if met.phase == "takeoff" else "land"
    labels = (
        mission.origins.value((*drone.path, "home")),
        mission.origins.value((*target.path, "track"), "comes over the pad"),
    )
    notes = (
        f"at t = {met.time:.1f} s the target reaches {at_least(met.lack)} m into the body, at the "
        f"best of the times to {verb} that were tried",
    )
    distance = at_least(target.radius + mission.rules.beside_target(drone.radius))
    remedies = [f"start the shot at {at_least(meets.start)} s"] if meets.start is not None else []
    remedies.append(f"put `home` where the axis of `{target.name}` comes no nearer than {distance} m")
    message = f"`{drone.name}` cannot {verb} clear of target `{target.name}`"
    return Diagnostic("M013", message, labels, notes, ", or ".join(remedies))


def _shortened(outside: OutsideTrack) -> str:
    left = down(outside.left, 1)
    return f"`duration: {left:.1f} s` or less" if left > 0 else ""


def _begun_later(mission: MissionIR, shot: Shot, start: float, later: float) -> list[str]:
    """Return a remedy that delays the recordings of a shot, and so all of its shots; empty without any."""
    recorded = _recorded(mission, shot)
    if not recorded:
        return []
    starts = " and ".join(f"`begins: {plain(first + later)} s` of `{name}`" for name, first in recorded)
    shots = f"every shot of it as much later, this one at `start: {plain(start + later)} s`"
    return [f"let its track begin {plain(later)} s later, or more ({starts}), and {shots}"]


def _recorded(mission: MissionIR, shot: Shot) -> list[tuple[str, float]]:
    """Return the moving targets of a shot and the start of their tracks; none unless all are recorded."""
    names = {s.target for s in shot.subjects} or ({shot.subject} if shot.subject else set())
    moving = [(mission.target(name), mission.target(name).track) for name in sorted(names)]
    tracks = [(target, track) for target, track in moving if track is not None]
    if any((*target.path, "track", "file") not in mission.origins.values for target, _ in tracks):
        return []
    return [(target.name, track.times[0]) for target, track in tracks]
