"""G040 and up: shapes and places that are probably written wrong, and places outside of terrain and buildings."""

from __future__ import annotations

from shotc.diag.code_info import CodeInfo
from shotc.diag.codes._slips import slip
from shotc.diag.model import Severity

_ON_EARTH = """\
shotc: 1
mission: pasted
world: {origin: {lat: 46.6812, lon: 7.6791, alt: 558}}
targets:
  tower: {at: [0, 0, 12], radius: 4, height: 24}
drones:
  cam1: {model: x500, home: [0, -60, 0]}
shots:
  - {id: look, kind: static, drone: cam1, at: {lat: 46.6808, lon: 7.6791, height: 12}, look_at: tower}
"""

PLACED: tuple[CodeInfo, ...] = (
    slip(
        "G045",
        "degrees-as-metres",
        "a position in metres looks like latitude and longitude",
        "A list `[x, y, z]` is in metres from the world's origin. Here its first two numbers are a "
        "latitude and a longitude, in this order or in the other, of a place within 10 km of that origin, "
        "as maps and files give it: in metres it is next to the origin, wherever it was meant to be. The "
        "help has the same place in degrees. There is no warning near 0 N, 0 E, nor for numbers with a "
        "precision of a tenth of a degree.",
        _ON_EARTH,
        ("at: {lat: 46.6808, lon: 7.6791, height: 12}", "at: [46.6808, 7.6791, 12]"),
    )._replace(severity=Severity.WARNING),
    CodeInfo(
        "G046",
        "no-ground-to-count-from",
        Severity.ERROR,
        "a target, track or zone counts its height from the ground where the terrain has none",
        "A height that is left out, or `{above: ground, height: ...}`, counts from `world.terrain`, and nothing is "
        "known beyond its posts or in their holes. The note says where and by how much. Take an elevation model that "
        "covers the place, or write its height as z.",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "G047",
        "shaky-recording",
        Severity.WARNING,
        "the noise of a recorded track shakes the picture of a shot that follows it",
        "A camera keeps its subject at its place on screen, so a recording that jumps makes the rest of "
        "the picture jump. Receivers err by a metre or two, more in height. The number is the distance of "
        "the filmed rows from the track smoothed over 1 s, measured across the line of sight of the shot's "
        "ideal, as a share of half a frame's width (root mean square). 0.01 is invisible. `smooth` in the "
        "track removes the noise; the summary of the plan says how far it moves the track.",
        "",
        "",
        "other",
    ),
)


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
