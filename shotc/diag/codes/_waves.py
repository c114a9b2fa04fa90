"""D140 and up: waves, in which drones depart one after another."""

from __future__ import annotations

from shotc.diag.code_info import CodeInfo
from shotc.diag.codes._slips import slip

_PASSING = """\
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
        _PASSING,
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
        _PASSING,
        ("time: 1 s", "time: 6 s"),
    )._replace(phase="plan"),
    slip(
        "D142",
        "wave-goes-nowhere",
        "all places that a wave goes through are alike along it",
        "A wave goes `along` an axis, from a middle, or by the drones' numbers, and each drone sets out when it comes to its "
        "place. Where all places are alike along it, as of a flat picture along the way one looks at it, all would set out "
        "at once. The places are those of the picture that is come to, or of what is before it with `by: start`.",
        _PASSING,
        ("size: 14}, hold: 4}", "size: 14}, hold: 4, transition: {wave: {time: 1 s, along: up, by: start}}}"),
    )._replace(phase="plan"),
)
