"""D140 and up: waves, in which drones depart one after another. D160 and up: obstacles in the ways of fleets."""

from __future__ import annotations

from shotc.diag.code_info import CodeInfo
from shotc.diag.codes._slips import slip

_TWO_BALLS = """\
shotc: 1
mission: wave
fleets:
  swarm: {count: 20, layout: {grid: {spacing: 6, origin: [0, 0, 0]}}, model: show-drone, separation: 1.5}
shots:
  - id: balls
    kind: display
    fleet: swarm
    frames:
      - {cube: {center: [0, 0, 40], size: 14}, hold: 4}
      - {sphere: {center: [0, 0, 44], radius: 8}, hold: 4, transition: {wave: {time: 1 s, along: up}}}
"""

WAVES: tuple[CodeInfo, ...] = (
    slip(
        "D140",
        "wave-on-arcs",
        "a wave is asked for on arcs",
        "On arcs drones stand as near as the separation allows, and keep it because all are as far along them at any time. "
        "In a wave they are not. So a wave goes on straight lines, between pictures that are as roomy as these need.",
        _TWO_BALLS,
        ("{wave: {time: 1 s, along: up}}", "{path: arc, wave: {time: 1 s, along: up}}"),
    ),
    slip(
        "D141",
        "wave-too-near",
        "drones that set out one after another come too near to each other",
        "Who sets out later is behind on its way, and may be where somebody passes who set out before. How near any two come "
        "is proved of every wave as it is flown, at every instant, and nobody is pushed aside for it. The notes name the two "
        "who come nearest, and by how much farther apart the places before and after would have to be for this wave: "
        "where drones stand 1.41 separations apart hardly any wave is possible, at twice the separation one of some seconds. "
        "The help names the longest wave found that passes. A wave by `goal` mostly passes sooner than one by `start`.",
        _TWO_BALLS,
        ("time: 1 s", "time: 6 s"),
    )._replace(phase="plan"),
    slip(
        "D142",
        "wave-goes-nowhere",
        "all places that a wave goes through are alike along it",
        "A wave goes `along` an axis, from a middle, or by the drones' numbers, and each drone sets out when it comes to its "
        "place. Where all places are alike along it, as of a flat picture along the way one looks at it, all would set out "
        "at once. The places are those of the picture that is come to, or of what is before it with `by: start`.",
        _TWO_BALLS,
        ("size: 14}, hold: 4}", "size: 14}, hold: 4, transition: {wave: {time: 1 s, along: up, by: start}}}"),
    )._replace(phase="plan"),
)


_WALLED = """\
shotc: 1
mission: wall
world:
  zones:
    wall: {keep: out, box: {center: [40, 0, 20], size: [4, 3000, 40]}}
rules: {max_height: 120}
fleets:
  swarm: {count: 20, layout: {grid: {spacing: 6, origin: [-10, 0]}}, model: show-drone, separation: 1.5}
shots:
  - id: balls
    kind: display
    fleet: swarm
    frames:
      - {sphere: {center: [0, 0, 30], radius: 8}, hold: 4}
      - {sphere: {center: [80, 0, 30], radius: 8}, hold: 4}
"""

_WALLED_WAVE = _WALLED.replace("[0, 0, 30]", "[0, 0, 80]").replace(
    "[80, 0, 30], radius: 8}", "[80, 0, 70], radius: 12}, transition: {wave: {time: 1 s, along: up}}"
)

STANDING: tuple[CodeInfo, ...] = (
    slip(
        "D160",
        "no-way-over",
        "something is in the straight ways of a fleet, and it cannot rise over it",
        "Where the straight ways between two pictures lead too near to ground that rises, a building, a zone or a target, "
        "the whole fleet rises over it: all by the same, so that nobody comes nearer to anybody. Where that is above "
        "`rules.max_height`, out of a keep-in zone or under something else, ways on arcs past it are tried, unless `path: "
        "straight` is written. The message says how much room the best of these lacks.",
        _WALLED,
        ("max_height: 120", "max_height: 50"),
    )._replace(phase="plan"),
    slip(
        "D161",
        "wave-in-the-way",
        "drones that set out one after another come too near to something that stands",
        "Drones of a wave fly straight from place to place, each at its own time. A fleet that sets out together rises over "
        "what is in its way; a wave would lift those that do not yet fly. So the straight ways of a wave are proved clear of "
        "ground, buildings, zones and targets, or the wave is refused.",
        _WALLED_WAVE,
        ("[80, 0, 70]", "[80, 0, 20]"),
    )._replace(phase="plan"),
)
