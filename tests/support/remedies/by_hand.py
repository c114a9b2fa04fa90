"""Helps that leave a choice to the author, each done with one choice: what the example is rewritten to.

No general rule can choose for the author. So each such alternative of a help stands here as it is said, with
the places of the failing example that are rewritten. A help whose words or numbers change is no longer found,
and its test fails until the choice is made again.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import NamedTuple

from tests.support.meshes import ply
from tests.support.remedies.with_files import BARN, built, posts
from tests.support.scene_missions import house

Written = str | Callable[[float], str]
NUMBER = re.compile(r"(?<![\w`.])\d+(?:\.\d+)?(?= )")


class Hand(NamedTuple):
    """One alternative of a help, done by hand.

    said  : the alternative, as ``apply.alternatives`` gives it, with `#` for a number that plans decide
    edits : pairs of what stands in the example and what is written for it, in order; where the alternative
        has such numbers, a function of the first of them
    """

    code: str
    said: str
    edits: tuple[tuple[str, Written], ...]

    def tells(self, code: str, said: str) -> bool:
        """Tell whether it does this alternative of a help."""
        return code == self.code and self.said in (said, unnumbered(said))


def hand(code: str, said: str, *edits: tuple[str, Written]) -> Hand:
    return Hand(code, said, edits)


def unnumbered(said: str) -> str:
    """Return an alternative with `#` for each number."""
    return NUMBER.sub("#", said)


FILES = {
    "route.csv": b"x,y,z\n0,-50,8\n30,-50,8\n",
    "hills.csv": posts(),
    "star.svg": b'<svg viewBox="0 0 9 9"><path d="M0 0 L9 0 L9 9 Z" fill="none" stroke="red"/></svg>',
    "h.geojson": built((0, BARN | {"name": "St. Mary"})),
    "beats.txt": "".join(f"{20 + t / 2}\n" for t in range(80)).encode(),
    "pads.csv": ("x,y,z\n" + "".join(f"{4 * (i % 8)},{4 * (i // 8)},0\n" for i in range(40))).encode(),
    "house.ply": ply(house()),
}
"""Files that lie beside every mission: what the author has at hand."""

SIDE = "kind: lateral, drone: cam1, target: tower, side: left, distance: 8, altitude: 4,"
NEAR = "subjects: [{target: runner, frame: [-0.27, 0.0], size: 0.3, view: {azimuth: 270 deg}},"
HOME, LINE = "home: under the tree", "look_at: tower, heading: 10 deg"
TOWER = "targets:\n  tower: {at: [0, 0, 12], radius: 4, height: 24}\n"
BOTH = "subjects: [{target: runner, frame: [-0.27, 0.0], size: 0.3},\n                "
SPHERE = "      - {sphere: {center: [0, 0, 30], radius: 15}, hold: 4, color: orange}\n"
COUNTED = "drone: cam1\n    timing: {start: 12, duration: 15}"
WALK = """\
  - id: walk
    kind: keyframes
    drone: cam1
    target: tower
    timing: {start: 20, duration: 40}
    keyframes:
      - {at: [-40, -30, 10], look_at: tower, time: 0}
      - {at: [0, -45, 18], look_at: tower, hold: 2, time: 15}
      - {at: [45, -20, 15], look_at: tower}
"""
ABOVE = """\
  - {id: above, kind: top-down, drone: cam1, target: tower, altitude: 60, drift: [1, 0, 0],
     timing: {start: 100, duration: 10}}
"""
RISE = """\
  - {id: rise, kind: elevator, drone: cam1, target: tower, azimuth: 180 deg, distance: 50, altitude: [5, 30],
     timing: {after: above}}
"""

HANDS = [
    hand("S004", "`height` needs `radius` beside it", ("height: 24}", "height: 24, radius: 4}")),
    hand("S005", "give `look_at`", (", heading: 10 deg", "")),
    hand("S005", "`heading` with `pitch`", (LINE, "heading: 0 deg, pitch: -3 deg")),
    hand("S006", "write its value", ("wind: null", "wind: 2 m/s")),
    hand("S007", "write [x, y, z] in metres", (HOME, "home: [0, -60, 0]")),
    hand(
        "S007",
        "{lat: ..., lon: ..., height: ...}",
        (HOME, "home: {lat: 47, lon: 8, height: 0}"),
        ("  wind", "  origin: {lat: 47.0005, lon: 8, alt: 400}\n  wind"),
    ),
    hand("S008", "write [x, y, z] in metres", ("home: [0]", "home: [0, -60, 0]")),
    hand(
        "S008",
        "{lat: ..., lon: ..., height: ...}",
        ("home: [0]", "home: {lat: 47, lon: 8, height: 0}"),
        ("  wind", "  origin: {lat: 47.0005, lon: 8, alt: 400}\n  wind"),
    ),
    hand(
        "S011",
        "use letters of any script, digits, spaces and plain punctuation "
        '(no / \\ < > : " | ? *), at most 100',
        ("../../look", "Blick zum Türm (2)"),
    ),
    hand(
        "S012",
        "give a path inside the mission's folder, with `/` between folders and without `..`",
        ("../../hills.tif", "hills.csv"),
        ("  zones", "  origin: {lat: 47, lon: 8, alt: 0}\n  zones"),
    ),
    hand("S015", 'write width over height such as "16:9", from "1:5" to "5:1"', ("16:0", "3:2")),
    hand(
        "S016", "add a shot", ("[]", "[{id: a, kind: static, drone: cam1, at: [0, -50, 15], look_at: tower}]")
    ),
    hand("N008", "check the name of the file", ("no-such-route.csv", "route.csv")),
    hand("U002", "`3 s` is a duration; write a speed such as `8 m/s`", ("3 s", "3 m/s")),
    hand("U004", "`3 m/s`", ('"3"', "3 m/s")),
    hand("U005", "write a speed such as `8 m/s`", ("3 to 5 m/s", "5 m/s")),
    hand("U006", "a speed is a finite number of at most 1000 m/s", ("1e300", "5")),
    hand(
        "G007",
        "list the corners in the order in which one walks round the zone",
        ("[80, 80], [80, -80]", "[80, -80], [80, 80]"),
    ),
    hand("G014", "look at another point", ("look_at: [0, -45, 18]", "look_at: [0, 0, 12]")),
    hand(
        "G015",
        "add `world: {origin: {lat: ..., lon: ..., alt: ...}}`",
        ("world:\n", "world:\n  origin: {lat: 47.3769, lon: 8.5417, alt: 400}\n"),
    ),
    hand("G021", "raise it by 2.00 m", ("height: -2}", "height: 0}")),
    hand("G022", "lower it by 9.00 m", ("height: 12}", "height: 3}")),
    hand(
        "G023", "move the target or the zone by 7.01 m to the side", ("center: [1, 0]", "center: [8.01, 0]")
    ),
    hand("G024", "lower it by 22.00 m", ("height: 130}", "height: 108}")),
    hand(
        "G050",
        "give the file under `world` as `buildings: {file: ...}`",
        ("world:\n", "world:\n  buildings: {file: h.geojson}\n  origin: {lat: 46.68, lon: 7.68, alt: 500}\n"),
        ("center: [-30, 20]", "center: [-50, 20]"),
    ),
    hand(
        "G050",
        "say where it stands: `at` and `size`",
        ("{building: St. Mary}", "{at: [0, 0, 12], size: [8, 8, 24]}"),
    ),
    hand("K005", "cut the mission in two", (WALK, ""), (ABOVE, ""), (",\n     timing: {after: above}", "")),
    hand(
        "K005",
        "drop or shorten shots",
        ("start: 20, duration: 40", "start: 10, duration: 20"),
        ("time: 15", "time: 8"),
        (ABOVE, ""),
        (RISE, ""),
    ),
    hand("K009", "add `duration: ...` to `timing`", ("{start: 100}", "{start: 100, duration: 10}")),
    hand(
        "K010",
        "give what is to move as two different values, [from, to]",
        ("altitude: 30", "altitude: [5, 30]"),
    ),
    hand(
        "K013",
        "turn between keyframes without a target",
        ("    target: tower\n    timing: {start: 20", "    timing: {start: 20"),
        ("duration: 40", "duration: 60"),
        ("{start: 100", "{start: 120"),
    ),
    hand(
        "K015",
        "correct it if it is a slip (a bare number is in m/s); the plan uses it as it is written",
        ("50 m/s", "5 m/s"),
    ),
    hand(
        "K016",
        "name it, as `from: NAME`",
        ("from: target, offset: [-8", "from: runner, offset: [-8"),
        ("from: target, offset: [0", "from: runner, offset: [0"),
    ),
    hand("K016", "give the shot a `target`", (COUNTED, f"target: runner\n    {COUNTED}")),
    hand(
        "K022",
        "take the lens out of `camera`, unless the machine carries it: what is framed with it is not in the"
        " film of another one",
        (",\n    camera: {zoom: [24 mm, 70 mm], hfov: 70 deg}", ""),
    ),
    hand("K021", "take `focus` out", ("    focus: tower\n", "")),
    hand(
        "K019",
        "film it as a framing with a size, which is held by the distance",
        (
            "kind: dolly-zoom, drone: cam1, target: runner, azimuth: 180 deg, distance: [40, 20],\n"
            "     altitude: 12",
            "kind: framing, drone: cam1, subjects: [{target: runner, size: 0.3}]",
        ),
    ),
    hand(
        "M002",
        "give `tower` a `track` instead of `at`",
        ("tower: {at: [0, 60, 12]", "tower: {track: {start: [0, 60, 12], velocity: [1, 0, 0]}"),
    ),
    hand(
        "M002", "use `static`, `orbit`", (SIDE, "kind: static, drone: cam1, at: [0, 0, 8], look_at: tower,")
    ),
    hand(
        "M002",
        "`dolly`",
        (SIDE, "kind: dolly, drone: cam1, target: tower, azimuth: 180 deg, distance: [50, 45], altitude: 4,"),
    ),
    hand("M003", "add `duration: ...` to `timing`", ("{start: 15}", "{start: 15, duration: 10}")),
    hand("M004", "let the track begin earlier", ("times: [17", "times: [15")),
    hand("M005", "slow down `runner` to 0.80 times its speed", ("times: [11, 17]", "times: [11, 18.5]")),
    hand("M012", "have `runner` pass at another time", ("times: [0, 40]", "times: [12, 52]")),
    hand(
        "M021", "correct point 1 or 2", ("[60, 0, 0.9]], times: [0, 0.5]", "[20, 0, 0.9]], times: [0, 0.5]")
    ),
    hand("M021", "the time between them", ("times: [0, 0.5]", "times: [0, 40]")),
    hand("M030", "name another target", ("{target: runner, frame: [0.27", "{target: rider, frame: [0.27")),
    hand(
        "M030",
        "say all of it in one place",
        (
            f"{BOTH}{{target: runner, frame: [0.27, 0.0]}}]",
            "subjects: [{target: runner, frame: [-0.27, 0.0], size: 0.3}]",
        ),
    ),
    hand(
        "M033",
        "film them in two shots",
        (
            BOTH,
            BOTH.rstrip(", \n") + "]}\n  - {id: next, kind: framing,"
            " drone: cam1, timing: {start: 32, duration: 8}, subjects: [",
        ),
    ),
    hand(
        "M036",
        "write `view: {azimuth: ...}` beside `target`, too: what it is when the shot begins",
        ("size: 0.3, setpoints", "size: 0.3, view: {azimuth: 180 deg}, setpoints"),
    ),
    hand(
        "F001",
        "put a shot from ahead, from behind or of something else between them",
        (
            "  - {id: closer",
            "  - {id: after, kind: chase, drone: cam1, target: runner, distance: 8, altitude: 4,\n"
            "     timing: {start: 20, duration: 5}}\n  - {id: closer",
        ),
        ("altitude: 3,\n     timing: {start: 20", "altitude: 3,\n     timing: {start: 30"),
    ),
    hand("F001", "begin `closer` on the left", ("side: right", "side: left")),
    hand("D006", "the obstacle", ("center: [40, 40], radius: 3", "center: [60, 60], radius: 3")),
    hand("D011", "give a file that ends in .svg", ("star.png", "star.svg")),
    hand("D012", "give one picture or more", ("frames: []", f"frames:\n{SPHERE}")),
    hand("D013", "put it where the audience is, outside of the pictures", ("[0, -5, 30]", "[0, -100, 2]")),
    hand("D021", "shorten holds and transitions", ("hold: 900", "hold: 9")),
    hand("D021", "cut the show in two", (SPHERE.replace("hold: 4", "hold: 900"), "")),
    hand(
        "D023",
        "name it as the `fleet` of a display",
        (
            "kind: display, fleet: swarm, frames: [{sphere: {center: [0, 0",
            "kind: display, fleet: other, frames: [{sphere: {center: [-90, 0",
        ),
    ),
    hand(
        "D024",
        "write them in the order in which they are shown",
        ("    timing: {after: ball}\n", ""),
        ("fleet: other, frames: [{sphere", "fleet: other, timing: {after: ring}, frames: [{sphere"),
    ),
    hand("D097", "an earlier frame", ("frame: 3", "frame: 2")),
    hand("D098", "a later frame", ("until: {frame: 1}", "until: {frame: 2}")),
    hand("D120", "write a time after 31 s and before 52 s", ("31, 30, 52", "31, 31.5, 52")),
    hand("D120", "leave this beat out", ("31, 30, 52", "31, 52"), ("beat: 4", "beat: 3")),
    hand("D121", "`beats_file`", ("{start: 20 s}", "{beats_file: beats.txt}"), ("{bar: 17}", "{beat: 65}")),
    hand(
        "D121",
        "give the moment in seconds",
        ("{start: 20 s}", "{tempo: 120}"),
        ("{beat: 21}", "35 s"),
        ("{bar: 17}", "55 s"),
        ("music: {tempo: 120}\n", ""),
    ),
    hand("D122", "give the moment in seconds", ("{beat: 5}", "60 s")),
    hand("D125", "`at` of the picture", ("at: {beat: 21}, ", "")),
    hand(
        "D128",
        "add a `display`",
        (
            "rules:",
            "fleets: {swarm: {count: 4, layout: {grid: {spacing: 4, origin:"
            " [60, 60, 0]}}, separation: 2}}\nrules:",
        ),
        (
            "shots:\n",
            "shots:\n  - {id: ball, kind: display, fleet: swarm,"
            " frames: [{sphere: {center: [60, 60, 40], radius: 6}}]}\n",
        ),
    ),
    hand(
        "D130", "say its `size`, as [width, depth, height]", ("name: word", "name: word, size: [40, 1, 24]")
    ),
    hand("D133", "fire it from another drone", ("drones: [1, 2], product", "drones: [2, 3], product")),
    hand(
        "D137",
        "leave that much room between the pads of the groups, in a layout from a file",
        ("{grid: {spacing: 1.5, origin: [0, 0, 0]}}", "{file: pads.csv}"),
    ),
]


def edited(text: str, hand: Hand, said: str) -> str:
    """Return a mission with the edits of a choice for an alternative; each has to be found."""
    for old, new in hand.edits:
        assert old in text, f"{hand.code}: the example no longer has {old!r}"
        text = text.replace(old, new if isinstance(new, str) else new(float(NUMBER.findall(said)[0])), 1)
    return text
