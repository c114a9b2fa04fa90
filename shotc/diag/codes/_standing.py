"""D160 on: shows over terrain, beside buildings, zones and targets: ways that lead into something."""

from __future__ import annotations

from shotc.diag.code_info import CodeInfo
from shotc.diag.codes._slips import slip

_PASSING = """\
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

_WAVE = _PASSING.replace("[0, 0, 30]", "[0, 0, 80]").replace(
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
        _PASSING,
        ("max_height: 120", "max_height: 50"),
    )._replace(phase="plan"),
    slip(
        "D161",
        "wave-in-the-way",
        "drones that set out one after another come too near to something that stands",
        "Drones of a wave fly straight from place to place, each at its own time. A fleet that sets out together rises over "
        "what is in its way; a wave would lift those that do not yet fly. So the straight ways of a wave are proved clear of "
        "ground, buildings, zones and targets, or the wave is refused.",
        _WAVE,
        ("[80, 0, 70]", "[80, 0, 20]"),
    )._replace(phase="plan"),
)
