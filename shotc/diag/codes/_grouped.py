"""N020, D134 and up: groups of a fleet, which draw separately from the rest of the fleet."""

from __future__ import annotations

from shotc.diag.code_info import CodeInfo
from shotc.diag.codes._slips import slip
from shotc.diag.model import Severity

_GROUPED = """\
shotc: 1
mission: grouped
fleets:
  swarm:
    count: 40
    layout: {grid: {spacing: 4, origin: [0, 0, 0]}}
    groups: {fireworks: 1-8, ring: [9-24, 40]}
shots:
  - {id: ball, kind: display, fleet: swarm, frames: [{sphere: {center: [0, 60, 40], radius: 9}, hold: 9}]}
  - {id: halo, kind: display, fleet: swarm, group: ring, frames: [{cube: {center: [60, 0, 40], size: 18}, hold: 9}]}
  - id: rain
    kind: display
    fleet: swarm
    group: fireworks
    frames: [{cube: {center: [0, -60, 30], size: 12}, hold: 9}]
"""

_OWN = """\
shotc: 1
mission: own
rules: {max_height: 60}
fleets:
  swarm: {count: 16, layout: {grid: {spacing: 2}}, separation: {horizontal: 2, vertical: 4}, rise: 24, return: own}
shots:
  - id: two
    kind: display
    fleet: swarm
    frames:
      - {cube: {center: [3, 3, 16], size: 12}}
      - {sphere: {center: [3, 3, 16], radius: 7}}
"""

UNKNOWN: tuple[CodeInfo, ...] = (
    slip(
        "N020",
        "unknown-group",
        "a display is of a group that its fleet does not have",
        "`group` of a display refers to a key under `groups` of its fleet. Its pictures, its effects and its pyro cues are all of "
        "that group, so nothing is judged of them. The nearest known name is proposed. Correct the name, or give the fleet the group.",
        _GROUPED,
        ("group: fireworks", "group: firework"),
    ),
)

OWN_PADS: tuple[CodeInfo, ...] = (
    CodeInfo(
        "D138",
        "high-levels",
        Severity.ERROR,
        "drones that return to their own pads would need more heights than there are",
        "With `return: own` drones change places over the pads on levels, each a vertical separation above the next, so that "
        "those whose ways cross never meet. How many that takes depends on the pictures, and is known when the show is planned. "
        "The highest may not be above `rules.max_height`, and more than 64 are refused. Have them return to any pad, or allow more.",
        _OWN.replace("max_height: 60", "max_height: 30"),
        _OWN,
        phase="plan",
    ),
)

GROUPED: tuple[CodeInfo, ...] = (
    slip(
        "D134",
        "drone-in-two-groups",
        "a drone of a fleet is in two groups",
        "Each group has a flight of its own, from its pads to its pads, so a drone is in one group at most. Those that are in none "
        "draw together in displays without a `group`.",
        _GROUPED,
        ("ring: [9-24, 40]", "ring: [8-24, 40]"),
    ),
    slip(
        "D135",
        "group-beyond-count",
        "a group names a drone that its fleet does not have",
        "`groups` are numbers of the fleet's drones, counted from 1 in the order of their pads: row by row in a grid, clockwise from "
        "the north on a circle, row by row in a file.",
        _GROUPED,
        ("ring: [9-24, 40]", "ring: [9-24, 41]"),
    ),
    slip(
        "D136",
        "nobody-left",
        "a display is drawn by the drones in no group, but every drone is in one",
        "Without a `group`, a display is drawn by those drones of its fleet that are in no group. Where each is in one, nobody is "
        "left to draw it. Name a group. A picture by several groups is several displays, each with its part of the picture, that "
        "start at the same time.",
        _GROUPED,
        ("ring: [9-24, 40]", "ring: 9-40"),
    ),
    slip(
        "D137",
        "mixed-pads",
        "pads of two groups of a fleet are nearer to each other than its separation",
        "A fleet whose pads are nearer to each other than its separation takes off in layers. Groups take off for their own "
        "pictures, one while another stands or flies, so drones of two groups keep the whole separation, on their pads, too. "
        "Within a group pads may be nearer. Space the layout wider, or leave room between the pads of the groups.",
        _GROUPED.replace("origin: [0, 0, 0]}}", "origin: [0, 0, 0]}}\n    separation: 2"),
        ("spacing: 4", "spacing: 1.5"),
    ),
)
