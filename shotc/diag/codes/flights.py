"""D080 and up: flights of fleets that have too little time or too little separation."""

from __future__ import annotations

from shotc.diag.code_info import CodeInfo
from shotc.diag.codes._slips import slip
from shotc.diag.model import Severity

_PASSING = """\
shotc: 1
mission: ball
fleets:
  swarm: {count: 20, layout: {grid: {spacing: 4, origin: [0, 0, 0]}}, model: show-drone,
          separation: {horizontal: 1 m, vertical: 2 m}}
shots:
  - id: ball
    kind: display
    fleet: swarm
    timing: {start: 60}
    frames:
      - {sphere: {center: [0, 0, 40], radius: 8}, hold: 4}
      - {cube: {center: [0, 0, 40], size: 14}, transition: 20, hold: 4}
"""
_ONE = """\
shotc: 1
mission: still
fleets:
  swarm: {count: 20, layout: {grid: {spacing: 4, origin: [0, 0, 0]}}, model: show-drone}
shots:
  - {id: ball, kind: display, fleet: swarm, frames: [{sphere: {center: [0, 0, 40], radius: 10}, hold: 4}]}
"""
_SWELLING = """\
shotc: 1
mission: swell
rules: {max_height: 80}
world:
  zones:
    wall: {keep: out, box: {center: [90, 0, 75], size: [1, 600, 150]}}
fleets:
  swarm: {count: 40, layout: {grid: {spacing: 2, origin: [0, 0, 0]}}, model: show-drone, separation: 1.5}
shots:
  - id: ball
    kind: display
    fleet: swarm
    frames:
      - {sphere: {center: [0, 0, 40], radius: 3}, hold: 4}
      - {sphere: {center: [40, 0, 40], radius: 3}, hold: 4}
"""
_TWO = """\
shotc: 1
mission: two
fleets:
  left: {count: 8, layout: {grid: {spacing: 4, origin: [-40, 0, 0]}}, model: show-drone}
  right: {count: 8, layout: {grid: {spacing: 4, origin: [40, 0, 0]}}, model: show-drone}
shots:
  - {id: one, kind: display, fleet: left, timing: {start: 60},
     frames: [{sphere: {center: [-40, 0, 40], radius: 6}, hold: 10}]}
  - {id: two, kind: display, fleet: right, timing: {start: 60},
     frames: [{sphere: {center: [40, 0, 40], radius: 6}, hold: 10}]}
"""


def _planned(
    code: str, slug: str, summary: str, explanation: str, passing: str, change: tuple[str, str]
) -> CodeInfo:
    return slip(code, slug, summary, explanation, passing, change)._replace(phase="plan")


def _by_files(code: str, slug: str, summary: str, explanation: str) -> CodeInfo:
    """Return the code of a fault that needs files to show, or places that `check` refuses earlier."""
    return CodeInfo(code, slug, Severity.ERROR, summary, explanation, "", "", "other")


CODES: tuple[CodeInfo, ...] = (
    _planned(
        "D080",
        "transition-too-short",
        "a transition between two pictures is shorter than the limits allow",
        "All drones of a fleet go straight from picture to picture on one common clock, so the one with the "
        "longest way, or the steepest, says how short the transition can be: at the full limits of its speed, "
        "climb, descent, acceleration and jerk. The message names it, and the limit.",
        _PASSING,
        ("transition: 20", "transition: 0.5"),
    ),
    _planned(
        "D081",
        "display-too-early",
        "a display starts before its fleet can stand in the first picture",
        "`timing.start` is when the first picture stands. Before that come take-off, straight up, and the way "
        "to the picture, or the display before it.",
        _PASSING,
        ("start: 60", "start: 20"),
    ),
    _planned(
        "D082",
        "show-outlasts-endurance",
        "the flight of a fleet is longer than its drones can fly",
        "The time from lift-off to touch-down counts, with all displays, the ways between them, and the way "
        "home. Waiting on the pads does not.",
        _PASSING,
        ("model: show-drone,", "model: show-drone, endurance: 60 s,"),
    ),
    _planned(
        "D083",
        "display-takes-no-time",
        "a display shows one picture and does not hold it",
        "A picture is held for its `hold`. A display of one picture without it would be over when it begins.",
        _ONE,
        (", hold: 4", ", hold: 0"),
    ),
    _by_files(
        "D084",
        "animation-too-quick",
        "an animation ends too far from where it begins for the time that it takes",
        "An animation begins and ends at rest, at its first and its last frame. Between them its drones come as "
        "near to the goals as their limits allow, so no frame is too quick by itself. But where somebody could "
        "not even go straight from the first goal to the last, nothing helps but a longer `period`, more frames "
        "or a smaller figure.",
    ),
    _by_files(
        "D085",
        "stands-too-near",
        "two drones of a fleet stand too near to each other",
        "Where a fleet stands, in a picture or on its pads, nothing can be corrected by flying otherwise: the places "
        "themselves are nearer than the separation with its margin. The message says how much larger they have to "
        "be.",
    ),
    _by_files(
        "D086",
        "passes-too-near",
        "two drones of a fleet pass too near to each other, and no way round was found",
        "Drones that would come too near are pushed apart, all at once and as little as does, until the separation "
        "is proved for every instant. That can fail where there is no time to go round each other. The stretch is "
        "then planned anew with more time, and the least `period` or `transition` found to be enough is what the "
        "message asks for: written into the mission it gives that very flight. Moves on arcs never need it, nor "
        "do straight moves between places that are sqrt(2) times the separation apart, so wider pads help, too. The "
        "message also says what separation the best flight keeps that was found in the time asked for.",
    ),
    _planned(
        "D087",
        "fleets-meet",
        "drones of two fleets come too near to each other",
        "Each fleet, and each group of one, is planned by itself. Where two would meet, one flies home later, sets out "
        "earlier, or flies round the other, if that is found to do; all pictures stay when and where they are. What is left is "
        "this error: that two stay apart, with the separation of the stricter one, is proved in any case.",
        _TWO,
        ("center: [40, 0, 40]", "center: [-38, 0, 40]"),
    ),
    CodeInfo(
        "D088",
        "picture-bent",
        Severity.WARNING,
        "a drone is far from its goal when a frame of an animation is shown",
        "The goals of an animation are the control points of smooth ways, which are bent further where drones "
        "would be too fast or too near to each other. Farther from a goal than half of what goals are apart at "
        "least, the picture is not the one that was asked for. A longer `period` gives the limits room; where "
        "smoothness itself is what takes the drone off, more frames help.",
        "",
        "",
        "other",
    ),
    _planned(
        "D089",
        "swell-has-no-room",
        "a fleet has no room to swell on its way from one picture to the next",
        "Where drones stand nearer than root two times the separation, before or after a move, they fly on arcs about a "
        "common point, on which any two keep the separation. Half-way the fleet is up to root two times as wide as "
        "its pictures. That is held to the ground, to `rules.max_height`, to zones and to targets that stand; where "
        "it is short of room the fleet is led higher, lower or aside. Where nothing helps, give it room, or write "
        "`transition: {path: straight}` where the drones stand far enough apart.",
        _SWELLING,
        ("center: [90, 0, 75]", "center: [21, 0, 75]"),
    ),
)
