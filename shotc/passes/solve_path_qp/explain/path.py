"""Diagnostics of infeasible paths, in the mission's own terms."""

from __future__ import annotations

from itertools import product
from math import cos, degrees, inf, pi, sin
from typing import assert_never

import numpy as np

from shotc.diag.model import Diagnostic, Label
from shotc.geom.bernstein import Array
from shotc.geom.pieces import Pieces
from shotc.geom.surface.ground import leaves
from shotc.ir.drone import Drone
from shotc.ir.keyframes import PlacedShot
from shotc.ir.mission import MissionIR
from shotc.ir.owners import GROUND, Owner, owner_of
from shotc.ir.path import SHARP, PathDeviation
from shotc.ir.terrain import Terrain
from shotc.planning.free_space import FreeSpace
from shotc.planning.obstacles import flight_space, pad_space
from shotc.planning.path.angles import NOTICE_RAD, UnreachableAngles
from shotc.planning.path.gap import lower_clearance, narrow_gap, opening
from shotc.planning.path.lines import NoWay, TooNear
from shotc.planning.path.pad import PadBlocked, transit_point
from shotc.planning.path.remedy import conflict, needed, remedy
from shotc.planning.path.shots import AngleFailure, Failure, Stuck
from shotc.planning.path.swings import Swing
from shotc.rounding import at_least
from shotc.solvers.conic import Status

PAD_DIRECTIONS = 24
"""Directions in which a free pad is searched."""
FARTHER_RATIOS = (1.0, 1.25, 1.5, 2.0, 3.0, 5.0)
"""Distances of the search, in units of what the pad lacks."""
NUDGE_M = 0.02
"""Metres added to these, because the place is printed to centimetres."""
FAR_M = (2.0, 5.0, 10.0, 20.0, 40.0, 80.0)
"""Further distances of the search, metres, where none of those is free."""

_WAY = {"over": "down", "under": "up"}


def failure(
    mission: MissionIR, drone: Drone, space: FreeSpace, shot: PlacedShot | None, what: Failure
) -> Diagnostic:
    """Return the error for one failure; ``shot`` is the shot it belongs to, None for the way home."""
    match what:
        case NoWay():
            return _no_way(mission, drone, space, shot, what)
        case TooNear():
            return _too_near(mission, drone, shot, what)
        case Stuck():
            return _stuck(mission, drone, space, shot, what)
        case AngleFailure():
            return _solver_failed(mission, drone, shot, f"{what.what} angles ({what.status})")
        case _:
            assert_never(what)


def pad_blocked(mission: MissionIR, drone: Drone, what: PadBlocked) -> Diagnostic:
    """Return the error for a pad without a vertical take-off."""
    lack, owner = what.needs - what.has, what.owner.words
    match what.why:
        case "outside":
            message = f"the pad of `{drone.name}` is not inside {owner}"
            note = f"the drone's body is {lack:.2f} m beyond its rim"
            help_ = f"{_free_pad(mission, drone, lack)}, or widen {owner} by {at_least(lack)} m"
        case "ceiling":
            message = f"{owner} leaves `{drone.name}` no height to fly at above its pad"
            note = f"the drone's centre must keep above {what.needs:.2f} m and below {what.has:.2f} m"
            help_ = f"raise the top of {owner} by {lack:.2f} m, or lower rules.ground_clearance"
        case _:
            over = "in the way above" if what.why == "above" else "too near to fly off from"
            message = f"{owner} is {over} the pad of `{drone.name}`"
            note = f"the drone's centre has {max(what.has, 0.0):.2f} m and needs {what.needs:.2f} m"
            help_ = _free_pad(mission, drone, lack)
    return Diagnostic(
        "Q002",
        message,
        (
            mission.origins.value((*drone.path, "home"), "take-off and landing are vertical here"),
            _owner_label(mission, what.owner, "stops it"),
        ),
        (note,),
        help_,
    )


def _free_pad(mission: MissionIR, drone: Drone, lack: float) -> str:
    """Return a remedy with the nearest free pad found around the drone's own; lack : metres that this
    lacks.
    """
    x, y, z = drone.home
    distances = (*(share * lack + NUDGE_M for share in FARTHER_RATIOS), *FAR_M)
    for metres, k in product(distances, range(PAD_DIRECTIONS)):
        angle = 2.0 * pi * k / PAD_DIRECTIONS
        there = drone._replace(home=(round(x + metres * sin(angle), 2), round(y + metres * cos(angle), 2), z))
        free = transit_point(flight_space(mission, there), pad_space(mission, there), there)
        if not isinstance(free, PadBlocked):
            return f"move home to {_point(np.array(there.home))}, {metres:.2f} m away"
    return f"move home by more than {FAR_M[-1]:.0f} m"


def follow_camera_impossible(mission: MissionIR, drone: Drone) -> Diagnostic:
    """Return the error for a body that follows the camera with a gimbal that cannot look ahead."""
    low, high = (degrees(a) for a in drone.gimbal.yaw)
    return Diagnostic(
        "Q005",
        f"the gimbal of `{drone.name}` cannot look straight ahead, which body: follow-camera needs",
        (
            mission.origins.value((*drone.path, "gimbal", "yaw"), "does not hold 0 deg"),
            mission.origins.value((*drone.path, "body"), "needs a gimbal yaw of 0 deg"),
        ),
        (f"its yaw reaches from {low:.1f} deg to {high:.1f} deg",),
        "write `body: free` or `body: forward`, or "
        f"`gimbal: {{yaw: [{min(low, 0.0):g} deg, {max(high, 0.0):g} deg]}}`",
    )


def moved(mission: MissionIR, shot: PlacedShot, deviation: PathDeviation) -> Diagnostic:
    """Return the warning for a generated path, or the legs of a drawn one, that leave their ideal."""
    where = f"{deviation.s:.1f} m along the shot"
    labels = [mission.origins.key(shot.shot.path, "the path leaves its ideal here")]
    if deviation.cause == SHARP:
        return Diagnostic(
            "Q006",
            f"shot `{shot.shot.id}` leaves the lines between its points by up to "
            f"{at_least(deviation.distance)} m",
            tuple(labels),
            (f"the largest distance is {where}, where {deviation.cause} bow the path out",),
            "move that corner away from what is near it, or round it by more points",
        )
    owner = owner_of(mission, deviation.cause)
    if owner is not None:
        labels.append(_owner_label(mission, owner, "is in the way"))
    return Diagnostic(
        "Q006",
        f"shot `{shot.shot.id}` leaves its ideal path by up to {at_least(deviation.distance)} m, "
        f"round {deviation.cause if owner is None else owner.words}",
        tuple(labels),
        (f"the largest distance is {where}",),
        f"move the path or {deviation.cause if owner is None else owner.words} by "
        f"{at_least(deviation.distance)} m if the ideal matters",
    )


def cut_framing(
    mission: MissionIR, drone: Drone, shot: PlacedShot, cuts: tuple[UnreachableAngles, ...]
) -> Diagnostic:
    """Return the warning for a composition that the gimbal cannot keep between keyframes."""
    low, high = (degrees(a) for a in drone.gimbal.pitch)
    worst = max(cuts, key=lambda cut: inf if cut.excess is None else cut.excess)
    if worst.excess is None:
        note = "the target is too steeply above or below for its place on screen"
    else:
        note = f"it would take {degrees(worst.excess):.1f} deg more pitch"
    notes = [f"{worst.s:.1f} m along the shot {note}"]
    if len(cuts) > 1:
        notes.append(f"{len(cuts)} stretches between keyframes have this fault; this one is the worst")
    keyframe = shot.keyframes[worst.index]
    return Diagnostic(
        "Q007",
        f"between keyframes {worst.index + 1} and {worst.index + 2} of shot `{shot.shot.id}` "
        "the gimbal cannot keep the target in its place",
        (
            mission.origins.key(keyframe.path, "from this keyframe on"),
            mission.origins.value((*drone.path, "gimbal", "pitch"), f"{low:.0f} to {high:.0f} deg"),
        ),
        tuple(notes),
        "add a keyframe farther from the target, or widen gimbal.pitch",
    )


def swings(mission: MissionIR, shot: PlacedShot, swing: Swing) -> Diagnostic:
    """Return the warning for a camera that swings round, or that misses its reference."""
    first, second = (shot.keyframes[k] for k in (swing.index, swing.index + 1))
    where = f"{swing.s:.1f} m along the shot, between keyframes {swing.index + 1} and {swing.index + 2}"
    off = f"the target is up to {at_least(degrees(swing.miss), 1)} deg off its place"
    if swing.turn > 0:
        over = "over" if swing.pitch < 0 else "under"
        message = (
            f"shot `{shot.shot.id}` passes straight {over} target `{swing.target}`, "
            f"and the picture turns by {degrees(swing.turn):.0f} deg there"
        )
        notes = [f"{where}, the camera looks {degrees(abs(swing.pitch)):.0f} deg {_WAY[over]}"]
        notes += [f"meanwhile {off}"] if swing.miss > NOTICE_RAD else []
        help_ = f"pass at least {swing.offset:.1f} m to one side of it, or give `heading` and `pitch`"
    else:
        message = f"the camera of shot `{shot.shot.id}` cannot keep target `{swing.target}` in its place"
        notes = [f"{where}, {off}"]
        help_ = "move these keyframes apart, or ask for places on screen that are more alike"
    labels = (mission.origins.key(first.path, "from here"), mission.origins.key(second.path, "to here"))
    return Diagnostic("Q009", message, labels[: 1 + (first.path != second.path)], tuple(notes), help_)


def _no_way(
    mission: MissionIR, drone: Drone, space: FreeSpace, shot: PlacedShot | None, what: NoWay
) -> Diagnostic:
    ends = None if mission.terrain is None else _ground_ends(mission.terrain, what)
    if ends is not None:
        labels = _ends(mission, drone, shot, what.keyframes)[:1]
        message = f"the way of `{drone.name}` {_leading(shot, what.keyframes)} leaves the terrain"
        help_ = "take an elevation model that covers it, fill the holes of this one, or lead the way round"
        return Diagnostic("G025", message, tuple(labels), (ends,), help_)
    openers = opening(space, what.start, what.end)
    gap = narrow_gap(space, what.start, what.end, openers)
    lower = lower_clearance(mission, drone, what.start, what.end)
    labels = _ends(mission, drone, shot, what.keyframes)
    labels += [_owner_label(mission, name, "without it there is a way") for name in openers]
    notes = [f"from {_point(what.start)} to {_point(what.end)}"]
    if not openers:
        notes.append("no single zone opens a way; several close it together")
    if gap is not None:
        notes.append(gap.note)
        help_ = gap.help
    elif openers:
        help_ = f"move or shrink {_either(tuple(owner.words for owner in openers))}, or move the end points"
    else:
        help_ = "move the end points to one side, or remove zones between them"
    if lower is not None:
        labels.append(_owner_label(mission, GROUND, f"{lower:.2f} m would leave a way"))
        help_ += f", or lower rules.ground_clearance to {lower:.2f} m"
    return Diagnostic(
        "Q001",
        f"there is no way for `{drone.name}` {_leading(shot, what.keyframes)}",
        tuple(labels),
        tuple(notes),
        help_,
    )


def _ground_ends(terrain: Terrain, what: NoWay) -> str | None:
    """Return where there is no ground below the straight line between two places, or None."""
    segment = Pieces(np.zeros(1), np.ones(1), np.stack([what.start, what.end])[None])
    out = leaves(terrain.ground, segment)
    return None if out is None else terrain.beyond_at(out.place, out.by)


def _too_near(mission: MissionIR, drone: Drone, shot: PlacedShot | None, what: TooNear) -> Diagnostic:
    breach = what.breach
    has = breach.clearance - breach.lack
    labels = _ends(mission, drone, shot, (what.keyframe, what.keyframe))[:1]
    labels.append(_owner_label(mission, breach.owner, "too near"))
    note = (
        f"the drone's centre keeps {breach.clearance:.2f} m from it and has {max(has, 0.0):.2f} m"
        if breach.clearance > 0
        else f"the drone's centre is {breach.lack:.2f} m beyond where its rim must stay"
    )
    return Diagnostic(
        "Q004",
        f"{_point(what.point)} is too near to {breach.owner.words} for `{drone.name}`",
        tuple(labels),
        (note,),
        f"move the point or {breach.owner.words} by {breach.lack + 0.01:.2f} m",
    )


def _stuck(
    mission: MissionIR, drone: Drone, space: FreeSpace, shot: PlacedShot | None, what: Stuck
) -> Diagnostic:
    ends = (what.keyframes[0], what.keyframes[-1]) if what.keyframes else (-1, -1)
    if what.solved.status is not Status.INFEASIBLE:
        return _solver_failed(mission, drone, shot, f"path ({what.solved.status})")
    owners = conflict(what)
    if not owners.owners and not owners.points:
        # No constraint is in conflict, so there is nothing that the user could relax.
        return _solver_failed(mission, drone, shot, "path (no curve kept clear of everything)")
    labels = _ends(mission, drone, shot, ends)
    labels += [_owner_label(mission, name, f"would have to give {x:.2f} m") for name, x in owners.owners]
    notes = [needed(mission, name, x) for name, x in owners.owners]
    notes += [f"keyframe {_bound_name(what, k)} would have to move by {x:.2f} m" for k, x in owners.points]
    return Diagnostic(
        "Q003",
        f"the corridor {_leading(shot, ends)} is too tight for a smooth path of `{drone.name}`",
        tuple(labels),
        tuple(notes),
        remedy(mission, drone, space, shot, what)
        or "lead the way through wider places: move the end points, or what stands between them",
    )


def _solver_failed(mission: MissionIR, drone: Drone, shot: PlacedShot | None, what: str) -> Diagnostic:
    path = drone.path if shot is None else shot.shot.path
    return Diagnostic(
        "Q008",
        f"the convex solver gave up on the {what} of `{drone.name}`",
        (mission.origins.key(path, "while planning this"),),
        (),
        "scale the mission down, or report it with the mission file",
    )


def _ends(
    mission: MissionIR, drone: Drone, shot: PlacedShot | None, keyframes: tuple[int, int]
) -> list[Label]:
    if shot is None:
        return [mission.origins.value((*drone.path, "home"), "on the way back here")]
    if keyframes[0] < 0:
        return [mission.origins.key(shot.shot.path, "on the way to this shot")]
    first, last = (shot.keyframes[k] for k in keyframes)
    if first.path == last.path:
        return [mission.origins.value(first.path, "here")]
    return [mission.origins.value(first.path, "from here"), mission.origins.value(last.path, "to here")]


def _leading(shot: PlacedShot | None, keyframes: tuple[int, int]) -> str:
    if shot is None:
        return "back home"
    if keyframes[0] < 0:
        return f"to shot `{shot.shot.id}`"
    return f"from keyframe {keyframes[0] + 1} to {keyframes[1] + 1} of shot `{shot.shot.id}`"


def _bound_name(what: Stuck, k: int) -> str:
    return str(what.keyframes[k] + 1) if k < len(what.keyframes) else "at the end"


def _owner_label(mission: MissionIR, owner: Owner, text: str) -> Label:
    return mission.origins.key(owner.path, text)


def _point(p: Array) -> str:
    return "[" + ", ".join(f"{x:.2f}" for x in np.round(p, 2) + 0.0) + "]"


def _either(names: tuple[str, ...]) -> str:
    if len(names) < 3:
        return " or ".join(names)
    return f"any one of {', '.join(names[:-1])} and {names[-1]}"
