"""Diagnostics of a fleet's times: what was requested, what is possible, and which drone limits it."""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil
from typing import NamedTuple

from shotc.diag.model import Diagnostic, Label
from shotc.geom.apart import straight_spacing, stretch
from shotc.geom.separation import Nearest
from shotc.ir.effects import Effect, Way
from shotc.ir.mission import MissionIR
from shotc.ir.owners import CEILING
from shotc.ir.phases import Phase
from shotc.ir.show import Display, Fleet, Picture, Wave, drone_names
from shotc.kinds.files import FileFault
from shotc.planning.clearances import ROUNDING_M
from shotc.planning.take_off import MOST_LAYERS
from shotc.rounding import at_least, nearer_than, plain
from shotc.show.assignment.score import Motion
from shotc.show.goals.room import RoomLack
from shotc.show.labels import moments, transition_key, transition_label, wave_key


class TriedWave(NamedTuple):
    """The attempts to make a wave possible.

    nearest : the nearest pair, and the time after the start
    longest : longest wave that keeps the separation, seconds; 0 if there is none
    spacings : least distances before and after the move, metres, with scaled heights
    wider : factor on both that would suffice; None if no tried factor does
    """

    nearest: Nearest
    longest: float
    spacings: tuple[float, float]
    wider: float | None


UNITS = {"speed": "m/s", "climb": "m/s", "descent": "m/s", "acceleration": "m/s^2", "jerk": "m/s^3"}


def too_fast(
    mission: MissionIR, fleet: Fleet, picture: Picture, least: Motion, distance: float
) -> Diagnostic:
    """Return D080: a requested transition is shorter than the limits allow.

    distance : of the limiting drone, metres
    """
    origins, name = mission.origins, drone_names(fleet)[least.drone]
    eased = "" if picture.easing == "ease-in-out" else f" with `easing: {picture.easing}`"
    if picture.wave is not None:
        eased += f" after a wave of {plain(picture.wave.time)} s"
    limit = getattr(fleet.limits, least.limit)
    shortest = at_least(least.duration)
    return Diagnostic(
        "D080",
        f"the transition is given {plain(picture.transition or 0.0)} s, but {shortest} s is the shortest "
        f"possible{eased}",
        (
            transition_label(mission, picture),
            origins.value((*fleet.path, "limits", least.limit), "what binds"),
        ),
        (
            f"`{name}` has {distance:.1f} m to go, and its {least.limit} is at most {at_least(limit)} "
            f"{UNITS[least.limit]}",
        ),
        f"give it `{transition_key(mission, picture)}: {shortest}`, leave it out to have it as fast as the "
        "pace allows",
    )


def too_early(mission: MissionIR, display: Display, earliest: float) -> Diagnostic:
    """Return D081: the fleet cannot reach its first picture by the display's start."""
    written, possible = display.start or 0.0, at_least(earliest)
    if display.pictures[0].at is not None:
        help_ = moments(mission, earliest)
        if mission.music is not None:
            later = mission.music.start + earliest - written
            help_ += f", or have the music start at {at_least(later)} s"
    else:
        help_ = f"give it `start: {possible} s` or later"
    return Diagnostic(
        "D081",
        f"display `{display.id}` starts at {plain(written)} s, but {possible} s is the earliest possible",
        (mission.origins.value(display.start_path),),
        ("before it come take-off and the way to the first picture, or the display before it",),
        help_,
    )


def too_late(mission: MissionIR, picture: Picture, earliest: float, duration: float) -> Diagnostic:
    """Return D124: a picture cannot stand at its fixed time.

    duration : of the move to it, seconds
    """
    return Diagnostic(
        "D124",
        f"the picture is to stand at {plain(picture.at or 0.0)} s, but {at_least(earliest)} s is the "
        "earliest possible",
        (mission.origins.value((*picture.path, "at")),),
        (
            f"the picture before it stands until {plain(earliest - duration)} s, and the way takes "
            f"{at_least(duration)} s",
        ),
        moments(mission, earliest),
    )


def high_levels(mission: MissionIR, fleet: Fleet, heights: Sequence[float]) -> list[Diagnostic]:
    """Return D138 if drones returning to their own pads need more height than there is.

    heights : of their levels above the pads, descending, metres
    """
    high, most = max(pad[2] for pad in fleet.pads) + heights[0], mission.rules.max_height
    many = len(heights) > MOST_LAYERS
    if not many and (most is None or high <= most + ROUNDING_M):
        return []
    label = mission.origins.value((*fleet.path, "return"))
    note = (
        f"its drones change places at {len(heights)} heights, a vertical separation apart: the lowest "
        f"{heights[-1]:.2f} m above the pads, the highest at z = {high:.2f}"
    )
    limit = f"{MOST_LAYERS} heights are the most" if many else f"`max_height` is {plain(most or 0.0)} m"
    help_ = "write `return: any`" + ("" if many else f", or `rules: {{max_height: {ceil(high)}}}`")
    message = f"{fleet.words} has no room to return to its own pads"
    return [Diagnostic("D138", message, (label,), (note, limit), help_)]


def too_long(mission: MissionIR, fleet: Fleet, phases: Sequence[Phase], waited: float) -> Diagnostic:
    """Return D082: the flight exceeds the endurance.

    waited : seconds on the pads, which do not count
    """
    total = phases[-1].end - waited
    labels = [mission.origins.value((*fleet.path, "endurance"), "the endurance")]
    longest = sorted((p for p in phases if p.shot is not None), key=lambda p: p.start - p.end)
    duration = sum(p.end - p.start for p in longest)
    labels += [
        mission.origins.key(d.path, "the longest display")
        for d in mission.displays
        if longest and d.id == longest[0].shot
    ]
    return Diagnostic(
        "D082",
        f"the flight of `{fleet.name}` takes {at_least(total)} s, and its endurance is "
        f"{plain(fleet.endurance)} s",
        tuple(labels),
        (f"from lift-off to touch-down, of which {at_least(duration)} s are shown",),
        f"shorten the show by {at_least(total - fleet.endurance)} s, give its parts to several fleets, or, "
        f"if the battery has it, write `endurance: {at_least(total)} s`",
    )


def no_time(mission: MissionIR, display: Display) -> Diagnostic:
    """Return D083: the display's only picture has no hold."""
    return Diagnostic(
        "D083",
        f"display `{display.id}` takes no time",
        (
            mission.origins.key(display.path),
            mission.origins.value(display.pictures[-1].path, "its one picture"),
        ),
        ("it has one picture, which is not held",),
        "write `hold: 5` in the picture, or how long it is to stand",
    )


def no_room(
    mission: MissionIR, fleet: Fleet, picture: Picture | None, lack: RoomLack, height: int | None
) -> Diagnostic:
    """Return D089: on arcs the fleet expands into the ground, above its height limit, or into an obstacle.

    lack : the least violation of the arcs that were tried
    height : a `max_height` with which the fleet rises over all obstacles, metres, if there is one
    """
    origins, metres = mission.origins, at_least(lack.metres)
    if lack.of is None:
        what, beside = "the ground or its greatest height", origins.key(("rules",), "the rules")
    else:
        what, beside = lack.of.owner.words, origins.key(lack.of.owner.path, "the obstacle")
    where = origins.key(fleet.path if picture is None else picture.path)
    to = "on its way home" if picture is None else "on its way to this picture"
    far = straight_spacing(fleet.apart)
    help_ = (
        f"place its pictures farther away from there, or make pictures and pads so wide that drones stand "
        f"{at_least(far)} m apart"
    )
    if height is not None:
        help_ = f"write `rules: {{max_height: {height}}}`"
    return Diagnostic(
        "D089",
        f"{fleet.words} swells into {what} {to}: {metres} m are missing",
        (where, beside),
        (
            "on arcs a fleet is up to 1.42 times as wide half-way as its wider picture; it was led over "
            "and past what stands there, without success",
            f"straight ways need no such room: goals and pads {at_least(far)} m apart on a level, "
            f"{at_least(far / stretch(fleet.apart))} m upright, before and after, allow them",
        ),
        help_,
    )


def no_way_over(
    mission: MissionIR,
    fleet: Fleet,
    picture: Picture | None,
    lacks: tuple[RoomLack, RoomLack],
    height: int | None,
) -> Diagnostic:
    """Return D160: an obstacle is in the straight paths of a fleet, and the fleet cannot rise over it.

    lacks : the violation of the straight paths, and the least violation of paths that rise
    height : as in ``no_room``
    """
    straight, risen = lacks
    what, beside = _in_the_way(mission, straight)
    where = mission.origins.key(fleet.path if picture is None else picture.path)
    to = "home" if picture is None else "to this picture"
    note = f"its straight ways lack {at_least(straight.metres)} m there"
    help_ = "place the pictures or the pads where the way between them is free"
    labels = [where, beside]
    if risen is not straight:
        over, rule = _in_the_way(mission, risen)
        note += f"; where all rise over it by the same, {at_least(risen.metres)} m are missing of {over}"
        if height is not None:
            help_ = f"write `rules: {{max_height: {height}}}`, or {help_}"
        labels += [] if rule == beside else [rule]
    return Diagnostic(
        "D160", f"{fleet.words} has no way {to} that is clear of {what}", tuple(labels), (note,), help_
    )


def wave_in_the_way(mission: MissionIR, fleet: Fleet, picture: Picture, lack: RoomLack) -> Diagnostic:
    """Return D161: drones of a wave come too near to an obstacle on their straight paths."""
    what, beside = _in_the_way(mission, lack)
    return Diagnostic(
        "D161",
        f"in this wave {fleet.words} comes too near to {what}: {at_least(lack.metres)} m are missing",
        (mission.origins.key(wave_key(mission, picture)), beside),
        ("drones of a wave fly straight, each at its own time, so they cannot rise over something together",),
        "leave `wave` out, for the fleet to rise over it, or place the pictures where the ways are free",
    )


def _in_the_way(mission: MissionIR, lack: RoomLack) -> tuple[str, Label]:
    """Return the limit that a move violates, in words, and a label on it in the mission."""
    if lack.of is None:
        return CEILING.words, mission.origins.key(CEILING.path, "the rule")
    return lack.of.owner.words, mission.origins.key(lack.of.owner.path, "what stands there")


def wave_too_near(mission: MissionIR, fleet: Fleet, picture: Picture, tried: TriedWave) -> Diagnostic:
    """Return D141: two drones come too near in a wave."""
    names, near, key = drone_names(fleet), tried.nearest, wave_key(mission, picture)
    before, after = tried.spacings
    x, y, z = near.position
    apart = f"the nearest two are {before:.2f} m apart before it and {after:.2f} m after it"
    if stretch(fleet.apart) != 1.0:
        apart += f", heights counted {stretch(fleet.apart):.2f} times"
    if tried.wider is not None:
        apart += f"; {at_least(tried.wider)} times that would be enough"
    fewer = "larger pictures or fewer drones have them farther apart"
    if tried.longest > 0.0:
        help_ = f"write `{key[-1]}: {tried.longest:.2f} s`, the longest found that keeps them apart; {fewer}"
    else:
        help_ = f"leave `wave` out; {fewer}"
    return Diagnostic(
        "D141",
        f"in this wave two drones of `{fleet.name}` come within "
        f"{nearer_than(near.attained, fleet.apart.across)} m of each other; "
        f"the separation is {fleet.apart.across:.2f} m",
        (
            mission.origins.value(key),
            mission.origins.value((*fleet.path, "separation"), "the separation"),
        ),
        (
            f"they are `{names[near.first]}` and `{names[near.second]}`, {near.time:.1f} s after the fleet "
            f"sets out, at [{x:.1f}, {y:.1f}, {z:.1f}]",
            apart,
        ),
        help_,
    )


def wave_without_extent(mission: MissionIR, picture: Picture, wave: Wave, able: Sequence[Way]) -> Diagnostic:
    """Return D142: a wave has no extent, because all places are equal along its direction.

    able : directions with an extent
    """
    places = "of this picture" if wave.by == "goal" else "before this picture"
    path = (*picture.path, "transition", "wave")
    along = (*path, "along")
    return Diagnostic(
        "D142",
        f"the wave goes nowhere: along `{wave.along}` all places {places} are alike",
        (mission.origins.value(along if along in mission.origins.values else path),),
        (),
        f"write {', or '.join(f'`along: {axis}`' for axis in able)}" if able else "leave `wave` out",
    )


def never_seen(mission: MissionIR, effect: Effect, why: str) -> Diagnostic:
    """Return D099: an effect lasts no time."""
    label = mission.origins.value(effect.path)
    whole = effect.over == "display"
    help_ = "begin it earlier" if whole else "write `over: both`, or give the picture that time"
    return Diagnostic("D099", "this effect is never seen", (label,), (why,), help_)


def bad_image(mission: MissionIR, effect: Effect, name: str, fault: FileFault) -> Diagnostic:
    """Return D100: an image cannot be read."""
    label = mission.origins.value((*effect.path, "image", "file"))
    return Diagnostic("D100", f"image `{name}` cannot be read", (label,), (fault.message,), fault.help)
