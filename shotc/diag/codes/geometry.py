"""G: positions of objects, and how the camera sees them. See shotc.diag.registry."""

from __future__ import annotations

from shotc.diag.code_info import CodeInfo
from shotc.diag.codes._obstacles import OBSTACLES
from shotc.diag.codes._placed import PLACED, SHAPED
from shotc.diag.codes._slips import slip
from shotc.diag.model import Severity

_PASSING = """\
shotc: 1
mission: tower-reveal
world:
  zones:
    tree: {keep: out, cylinder: {center: [-30, 20], radius: 3, height: [0, 12]}}
    field: {keep: in, polygon: {points: [[-80, -80], [80, -80], [80, 80], [-80, 80]], height: [2, 60]}}
targets:
  tower: {at: [0, 0, 12], radius: 4, height: 24}
drones:
  cam1: {model: x500, home: [0, -60, 0]}
shots:
  - id: reveal
    kind: keyframes
    drone: cam1
    target: tower
    keyframes:
      - {at: [-40, -30, 10], heading: 45 deg, pitch: -4 deg}
      - {at: [0, -45, 18], look_at: tower}
      - {at: [45, 20, 15], look_at: tower, hfov: 60 deg}
  - {id: round, kind: orbit, drone: cam1, target: tower, radius: 50, altitude: 20}
"""


_ON_EARTH = _PASSING.replace("world:\n", "world:\n  origin: {lat: 47.3769, lon: 8.5417, alt: 408}\n").replace(
    "at: [0, -45, 18]", "at: {lat: 47.3765, lon: 8.5417, height: 18}"
)


_ROOF = """\
shotc: 1
mission: roof
targets:
  roof: {at: [0, 0, 14], radius: 4, height: 4}
drones:
  cam1: {model: x500, home: [0, -60, 0]}
rules: {max_height: 60}
shots:
  - {id: round, kind: orbit, drone: cam1, target: roof, radius: 40, altitude: {above: target, height: 12}}
"""


_TWO = _PASSING.replace(
    "home: [0, -60, 0]}\n", "home: [0, -60, 0]}\n  cam2: {model: x500, home: [8, -60, 0]}\n"
).replace("kind: orbit, drone: cam1", "kind: orbit, drone: cam2")


_WARNINGS = {11, 12, 16, 18, 20, 21, 23, 24, 53}


def _code(
    number: int, slug: str, summary: str, explanation: str, change: tuple[str, str], base: str = _PASSING
) -> CodeInfo:
    severity = Severity.WARNING if number in _WARNINGS else Severity.ERROR
    return slip(f"G{number:03}", slug, summary, explanation, base, change)._replace(severity=severity)


CODES: tuple[CodeInfo, ...] = (
    _code(
        1,
        "too-low",
        "a camera stands too close to the ground, or under it",
        "The ground is z = 0. The body sphere of the drone keeps `rules.ground_clearance` from it, so the "
        "camera's z is at least that clearance and the body's radius. The note gives both. Raise the "
        "keyframe or the altitude, or lower the clearance.",
        ("at: [0, -45, 18]", "at: [0, -45, 1]"),
    ),
    _code(
        2,
        "in-zone",
        "a camera stands in a keep-out zone, or touches it",
        "A position that the user writes is binding, so a keyframe in a keep-out zone can never be flown. "
        "The distance counts from the body sphere. The help gives the shortest move to a place that is "
        "free of all zones, targets and the ground.",
        ("at: [0, -45, 18]", "at: [-31, 21, 10]"),
    ),
    _code(
        3,
        "outside-zone",
        "a camera stands outside a keep-in zone",
        "Keep-in zones bind every phase but take-off and landing, and where there are several, all of them "
        "bind. The whole body sphere stays inside. Move the keyframe inward, or enlarge the zone.",
        ("at: [45, 20, 15]", "at: [85, 20, 15]"),
    ),
    _code(
        4,
        "in-target",
        "a camera stands in a target or too close to it",
        "Targets are solid: the body sphere keeps `rules.target_clearance` from their cylinders. Move the "
        "keyframe away, or make the cylinder as small as the target really is.",
        ("at: [0, -45, 18]", "at: [0, -4, 18]"),
    ),
    _code(
        5,
        "home-blocked",
        "a drone cannot take off from its home",
        "Take-off and landing are vertical at home. A zone or target in that way, or a keep-in zone whose "
        "walls do not enclose it, blocks the flight before it begins. Clearances and the floors of keep-in "
        "zones do not apply there. Move the home, or the zone.",
        ("home: [0, -60, 0]", "home: [0, -90, 0]"),
    ),
    _code(
        6,
        "home-underground",
        "a drone's home lies under the ground",
        "The ground is z = 0, and altitudes count upwards from it. A home may stand on a roof, but not "
        "under the ground. Raise it.",
        ("home: [0, -60, 0]", "home: [0, -60, -3]"),
    ),
    _code(
        7,
        "bad-polygon",
        "the polygon of a zone crosses itself or encloses nothing",
        "A polygon is given by its corners in the order in which one walks round it, either way. Its edges "
        "may not cross or touch, and it has three different corners or more. Sort the corners.",
        ("[[-80, -80], [80, -80], [80, 80], [-80, 80]]", "[[-80, -80], [80, 80], [80, -80], [-80, 80]]"),
    ),
    _code(
        8,
        "behind-camera",
        "a target is behind the camera in the user's own framing",
        "A heading and a pitch are a framing of the target, which composition then corrects. A camera that "
        "looks the other way frames nothing that could be corrected. Headings are compass bearings: 0 is "
        "North, 90 deg East. The help gives the heading and pitch that look straight at the target.",
        ("heading: 45 deg", "heading: 225 deg"),
    ),
    _code(
        9,
        "out-of-frame",
        "no part of a target is in the user's own framing",
        "The target lies before the camera, but outside its frame: the heading, the pitch or the field of "
        "view is not what was meant. The help gives the heading and pitch that look straight at it.",
        ("heading: 45 deg", "heading: 115 deg"),
    ),
    _code(
        10,
        "target-too-large",
        "a target does not fit into the frame anywhere on its composition set",
        "A place on screen where the target would be cropped is no candidate, and none is left, not even on "
        "the vertical lines through the set's points. The help gives the least distance and the least field "
        "of view that would do.",
        ("at: [0, -45, 18]", "at: [0, -14, 18]"),
    ),
    _code(
        11,
        "off-composition",
        "a target stands beside its composition set, where it would be cropped or the gimbal does not reach",
        "At every place of the set the target would be cropped, or the gimbal does not pitch far enough; so "
        "the nearest place on the set's vertical lines that shows it whole is taken. The notes say which, "
        "and why. Move away, widen the field of view or the gimbal's range to compose it as asked.",
        (
            "at: [0, -45, 18], look_at: tower",
            "at: [0, -40, 18], look_at: tower, frame: upper-left",
        ),
    ),
    _code(
        12,
        "cropped",
        "a target is cropped, and its composition keeps it there",
        "With `keep` the user's framing stands as it is, even where it cuts the target. The note says by "
        "how much. Turn the camera, move away, or widen the field of view if the whole target is wanted.",
        ("heading: 45 deg, pitch: -4 deg", "heading: 75 deg, pitch: -4 deg, frame: keep"),
    ),
    _code(
        13,
        "beyond-gimbal",
        "the gimbal does not reach the pitch that a keyframe needs",
        "The camera's pitch counts from the horizon, up is positive, and stays within `gimbal.pitch`. A "
        "keyframe far below or above its target may need more. The note gives the pitch and the range.",
        ("pitch: -4 deg", "pitch: 40 deg"),
    ),
    _code(
        14,
        "looks-at-itself",
        "a camera looks at the place where it stands",
        "`look_at` is the point in the middle of the picture; if it is the camera's own place there is no "
        "direction. Give another point, or a heading and pitch.",
        ("at: [0, -45, 18], look_at: tower", "at: [0, -45, 18], look_at: [0, -45, 18]"),
    ),
    _code(
        15,
        "no-origin",
        "a position is given in latitude and longitude, but the mission has no origin",
        "`world.origin` ties the world's metres to the earth. Without it a geodetic position has no place "
        "in the world. Without its `alt` the elevations of a GPX file have none, because they count from "
        "sea level. Add `origin: {lat: ..., lon: ..., alt: ...}` under `world`, or give positions as [x, "
        "y, z].",
        ("  origin: {lat: 47.3769, lon: 8.5417, alt: 408}\n", ""),
        base=_ON_EARTH,
    ),
    _code(
        16,
        "ideal-blocked",
        "a generated path leads through an obstacle and will leave its ideal",
        "The path that a kind generates is an ideal. Where a zone or a target stands in it the plan goes "
        "round, and says how far and when. Choose another altitude or distance to keep the ideal.",
        ("radius: 50, altitude: 20", "radius: 36, altitude: 11"),
    )._replace(exact=("Q006",)),
    _code(
        17,
        "far-from-origin",
        "a position in latitude and longitude is not near the world's origin",
        "Missions are flown round `world.origin`, at most 10 km from it. A place farther away is a slip: "
        "latitude and longitude swapped, a minus forgotten (west and south are negative), or an origin of "
        "another mission. The help says which of them it looks like.",
        ("lat: 47.3765, lon: 8.5417", "lat: 8.5417, lon: 47.3765"),
        base=_ON_EARTH,
    ),
    _code(
        18,
        "target-underground",
        "a target reaches into the ground",
        "`at` is the middle of a target, not its foot: a tower 24 m high that stands on the ground has its "
        "middle at z = 12. A target far under the ground is framed where no camera sees it. Give its "
        "middle. A moving target goes straight from row to row of its track, perhaps through a rise "
        "between them; the message gives the deepest place of its way. `lift` puts its middle above the "
        "recorded places; rows that are nearer to each other follow the ground.",
        ("tower: {at: [0, 0, 12]", "tower: {at: [0, 0, 0]"),
    ),
    _code(
        19,
        "homes-too-near",
        "the homes of two drones are nearer to each other than the separation",
        "`rules.separation` holds from the first second to the last, on the ground too, centre to centre: two "
        "drones that lift off side by side start apart, and one that films nothing is in the way on its pad. Move "
        "one of the homes.",
        ("home: [8, -60, 0]", "home: [1, -60, 0]"),
        base=_TWO,
    ),
    _code(
        20,
        "altitude-from-foot",
        "the altitude of a shot counts from the foot of its target, not from z = 0",
        "The `altitude` of a shot with a target counts from the target's foot at that moment: a roof is "
        "filmed from above the roof, a cyclist on a climb from above the road. Up to version 0.1 it "
        "counted from the plane z = 0. If the two differ, this warning gives both. A mission with terrain, "
        "which version 0.1 did not have, gets no warning. Write `altitude: "
        "{above: target, height: ...}` to say that the foot is meant, or `{above: origin, height: ...}` "
        "for z, or `{above: ground, height: ...}` for the height over the ground below the camera.",
        ("altitude: {above: target, height: 12}", "altitude: 12"),
        base=_ROOF,
    ),
    _code(
        21,
        "below-foot",
        "a camera is below the foot of its target, though its height counts from target or ground",
        "A height over the target's foot is negative, or the ground below the camera lies lower than the "
        "target stands, so that the picture looks up at it from below. Raise the altitude. If the camera "
        "is meant to be so low, for example on the sea before a cliff, write `above: origin`.",
        ("height: 12", "height: -2"),
        base=_ROOF,
    ),
    _code(
        22,
        "above-max-height",
        "a camera is higher above the ground than the mission allows",
        "`rules.max_height` is the greatest height of a drone's centre above the ground, in every phase. A place "
        "of the mission that is higher can never be flown. Lower it, or raise the rule.",
        ("max_height: 60", "max_height: 15"),
        base=_ROOF,
    ),
    _code(
        23,
        "target-in-zone",
        "a target stands in a keep-out zone, or comes into it",
        "Keep-out zones are solid: a camera outside of a zone does not see what is inside, which therefore "
        "counts as hidden. The message says where the centre of a target (the end of the line of sight) "
        "stands in a zone, or when and where it enters one before the last shot ends (before the longest "
        "endurance, if that end is not known). Move the target or the zone, or give the zone a shape that "
        "leaves the target out. Where a zone is there for other reasons and can be looked through, write "
        "`allow: [hidden-subject]` in the shots that film the target, or under `rules`. See V050.",
        ("center: [-30, 20], radius: 3, height: [0, 12]", "center: [1, 0], radius: 8, height: [0, 26]"),
    ),
    _code(
        24,
        "above-legal-height",
        "a camera is higher above the ground than most countries allow",
        "Without a permit, drones are flown at most 120 m (400 ft) above the ground in most countries. "
        "Lower the shot; or write `max_height` under `rules`: a number becomes a limit that is proved, "
        "`off` removes the limit.",
        (
            "radius: 40, altitude: {above: target, height: 12}",
            "radius: 150, altitude: {above: target, height: 130}",
        ),
        base=_ROOF.replace("rules: {max_height: 60}\n", ""),
    ),
    _code(
        53,
        "return-too-low",
        "the return height of a drone is lower than an obstacle",
        "`safety: {return_height: 40 m}` is the height above home at which a drone returns when its link is lost. It flies straight home then, "
        "a way that no plan proves, so it is to pass over every keep-out zone and target, with the body and `rules.obstacle_clearance`. "
        "Scenes, buildings and terrain are not looked at. Raise it.",
        ("return_height: 40", "return_height: 20"),
        base=_PASSING.replace("home: [0, -60, 0]}", "home: [0, -60, 0], safety: {return_height: 40}}"),
    ),
    _code(
        54,
        "rally-in-zone",
        "a rally point lies in a keep-out zone, or outside a keep-in zone",
        "`safety: {rally: [[x, y]]}` of a drone are places where it may land instead of at home. Such a "
        "place may not lie in a keep-out zone, or outside of a keep-in zone. Move it.",
        ("rally: [[40, -60]]", "rally: [[-30, 20]]"),
        base=_PASSING.replace("home: [0, -60, 0]}", "home: [0, -60, 0], safety: {rally: [[40, -60]]}}"),
    ),
    CodeInfo(
        "G025",
        "beyond-terrain",
        Severity.ERROR,
        "a home or a shot lies where the terrain of the mission has no ground",
        "`world.terrain` is the ground, and nothing is known beyond its posts or in their holes: no height above "
        "ground can be planned there, and none proved. The note says where and by how much. Take an elevation model "
        "that covers the flight, with a few hundred metres to spare, or fill its holes.",
        "",
        "",
        "other",
    ),
    *SHAPED,
    *PLACED,
    *OBSTACLES,
)
