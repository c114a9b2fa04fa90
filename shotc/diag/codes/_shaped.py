"""G040 and up: targets whose shape or parts are probably written wrong."""

from __future__ import annotations

from shotc.diag.code_info import CodeInfo
from shotc.diag.codes._slips import slip
from shotc.diag.model import Severity

_CAR = """\
shotc: 1
mission: drive
targets:
  car: {track: {start: [0, 0, 0.75], velocity: [4, 0, 0]}, size: [4.5, 1.8, 1.5]}
drones:
  cam1: {model: x500, home: [0, -30, 0]}
shots:
  - {id: side, kind: lateral, drone: cam1, target: car, side: right, distance: 12, altitude: 4,
     timing: {start: 12, duration: 8}}
"""

_CHURCH = """\
shotc: 1
mission: village
targets:
  tower: {at: [0, 0, 15], size: [6, 6, 30]}
  nave: {at: [13, 0, 5], size: [10, 20, 10]}
  church: {parts: [tower, nave]}
drones:
  cam1: {model: x500, home: [0, -60, 0]}
shots:
  - {id: round, kind: orbit, drone: cam1, target: church, radius: 60, altitude: 20, sweep: 60 deg}
"""

SHAPED: tuple[CodeInfo, ...] = (
    slip(
        "G040",
        "goes-sideways",
        "a box that moves is wider than it is long",
        "The `size` of a target is [length, width, height], and the target moves along its length. The "
        "`size` of a zone's box begins with its width, so a size copied from there lies across. If the "
        "target does move sideways, like a ferry at its pier, ignore this warning.",
        _CAR,
        ("size: [4.5, 1.8, 1.5]", "size: [1.8, 4.5, 1.5]"),
    )._replace(severity=Severity.WARNING),
    slip(
        "G041",
        "no-part",
        "a target cannot be a part of another",
        "`parts` names targets that stand, each with a body of its own, and makes one picture of them: the group is "
        "framed by the union of their outlines. A part cannot be a group, cannot move and counts once.",
        _CHURCH,
        ("parts: [tower, nave]", "parts: [tower, nave, tower]"),
    ),
)
