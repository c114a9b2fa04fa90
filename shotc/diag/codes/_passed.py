"""V034 and V035: ways between shots that pass too near to something."""

from __future__ import annotations

from shotc.diag.code_info import CodeInfo
from shotc.diag.model import Severity

_GAP = """\
shotc: 1
mission: gap
world:
  zones:
    west: {keep: out, box: {center: [-24, 0, 30], size: [WIDE, 10, 60]}}
    east: {keep: out, box: {center: [24, 0, 30], size: [WIDE, 10, 60]}}
targets: {statue: {at: [0, 40, 1.5], radius: 1, height: 3}}
drones: {cam: {model: x500, home: [0, -30, 0]}}
shots:
  - {id: see, kind: static, drone: cam, at: [0, 28, 3], look_at: statue}
"""

_LANE = """\
shotc: 1
mission: lane
world: {zones: {lane: {keep: in, box: {center: [0, 0, 6], size: [90, 12, 12]}}}}
targets:
  statue: {at: [25, 0, 1.5], radius: 1, height: 3}
  post: {at: [-15, 3, 3], radius: 0.3, height: 6}
drones: {cam: {model: x500, home: [-35, 0, 0]}}
rules: {transit_clearance: {other: CLEARANCE}}
shots:
  - {id: see, kind: static, drone: cam, at: [13, 0, 3], look_at: statue}
"""

PASSED: tuple[CodeInfo, ...] = (
    CodeInfo(
        "V034",
        "passed-nearer",
        Severity.WARNING,
        "a way between shots leads nearer to something than it should",
        "On its ways between shots a drone keeps 5 m from what the mission films, and 3 m from other "
        "targets and from keep-out zones, wherever there is room for it: the defaults of "
        "`rules.transit_clearance`. If a shot begins or ends nearer to something, or the pad is nearer, "
        "the way may begin and end that near; it then keeps half a metre more with each metre from there. "
        "Here the way is nearer than that by more than a tenth, because of a narrow gap, a detour that "
        "would be too long, or no time to wait. A clearance that the mission writes is always kept; or "
        "give the way more room or time.",
        _GAP.replace("WIDE", "44"),
        _GAP.replace("WIDE", "36"),
        "plan",
    ),
    CodeInfo(
        "V035",
        "transit-clearance-broken",
        Severity.ERROR,
        "a way between shots leads nearer to something than the mission allows",
        "`rules.transit_clearance`, written down, is required of every way between shots, and of those "
        "from the pad and back: the body keeps `filmed` from every target that a shot films, and `other` "
        "from all other targets and keep-out zones. If a shot begins or ends nearer, or the pad is nearer, "
        "the way may begin and end that near; it then keeps half a metre more with each metre from there. "
        "Lower the clearance, start the shot at another time, or give the way more room.",
        _LANE.replace("CLEARANCE", "8 m"),
        _LANE.replace("CLEARANCE", "3 m"),
        "plan",
    ),
)
