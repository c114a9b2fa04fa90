"""M: moving targets, their tracks and the shots that follow them. See shotc.diag.registry."""

from __future__ import annotations

from shotc.diag.code_info import CodeInfo
from shotc.diag.codes._slips import slip
from shotc.diag.model import Severity

_PASSING = """\
shotc: 1
mission: run
targets:
  runner: {track: {points: [[0, 0, 0.9], [60, 0, 0.9]], times: [0, 40]}, radius: 0.4, height: 1.8}
  tower: {at: [0, 60, 12], radius: 4, height: 24}
drones:
  cam1: {model: x500, home: [0, -30, 0], limits: {speed: 8 m/s}}
shots:
  - {id: side, kind: lateral, drone: cam1, target: runner, side: left, distance: 8, altitude: 4,
     timing: {start: 15, duration: 10}}
"""
_BY_FILE = _PASSING.replace("points: [[0, 0, 0.9], [60, 0, 0.9]], times: [0, 40]", "file: runner.csv")


_WARNINGS = (7, 8, 34, 35)
_PLANNED = (8, 9, 11, 13)


def _code(number: int, slug: str, summary: str, explanation: str, *changes: tuple[str, str]) -> CodeInfo:
    info = slip(f"M{number:03}", slug, summary, explanation, _PASSING, *changes)
    severity = Severity.WARNING if number in _WARNINGS else Severity.ERROR
    return info._replace(severity=severity, phase="plan" if number in _PLANNED else "check")


def _needs_a_file(number: int, slug: str, summary: str, explanation: str) -> CodeInfo:
    """Return the code of a fault that a mission shows only together with a file."""
    return CodeInfo(f"M{number:03}", slug, Severity.ERROR, summary, explanation, "", "", "other")


_IN_TURN = """\
shotc: 1
mission: in-turn
targets:
  runner: {track: {start: [0, 0, 0.9], velocity: [3, 0, 0]}, radius: 0.4, height: 1.8}
drones:
  cam1: {model: x500, home: [30, -30, 0], priority: 1}
  cam2: {model: x500, home: [45, 30, 0], priority: 2}
rules: {mutual_visibility: {strength: off}, allow: [jump-cut]}
shots:
  - {id: side, kind: lateral, drone: cam1, target: runner, side: left, distance: 8, altitude: 4,
     timing: {start: 18, duration: 8}}
  - id: beside
    kind: keyframes
    drone: cam2
    target: runner
    keyframes:
      - {at: {from: runner, offset: [1.6, 10, 3.1]}, look_at: runner, time: 0}
      - {at: {from: runner, offset: [2.6, 10, 3.1]}, look_at: runner, time: 5}
    timing: {start: 20, duration: 5}
"""
_SECOND = ",\n                {target: rider, frame: [0.27, 0.0]}"
_PAIR = f"""\
shotc: 1
mission: pair
targets:
  runner: {{track: {{points: [[0, 0, 0.9], [60, 0, 0.9]], times: [0, 40]}}, radius: 0.4, height: 1.8}}
  rider: {{track: {{points: [[0, 3, 1], [60, 3, 1]], times: [0, 40]}}, radius: 0.6, height: 2}}
drones:
  cam1: {{model: x500, home: [0, -30, 0], limits: {{speed: 8 m/s}}}}
shots:
  - {{id: both, kind: framing, drone: cam1, timing: {{start: 15, duration: 10}},
     subjects: [{{target: runner, frame: [-0.27, 0.0], size: 0.3}}{_SECOND}]}}
"""


def _framing(number: int, slug: str, summary: str, explanation: str, *changes: tuple[str, str]) -> CodeInfo:
    info = slip(f"M{number:03}", slug, summary, explanation, _PAIR, *changes)
    return info._replace(severity=Severity.WARNING if number in _WARNINGS else Severity.ERROR)


_KEYED = """\
shotc: 1
mission: beside
targets:
  runner: {track: {start: [0, 0, 0.9], velocity: [1.5, 0, 0]}, radius: 0.4, height: 1.8}
drones:
  cam1: {model: x500, home: [0, -30, 0]}
shots:
  - id: round
    kind: keyframes
    drone: cam1
    target: runner
    timing: {start: 15, duration: 15}
    keyframes:
      - {at: {from: target, offset: [-9, 0, 3], turn: course}, look_at: runner}
      - {at: {from: target, offset: [-9, -9, 3]}, look_at: runner}
      - {at: {from: target, offset: [-9, 0, 5]}, look_at: runner}
"""


def _keyed(number: int, slug: str, summary: str, explanation: str, *changes: tuple[str, str]) -> CodeInfo:
    """Return the code of a fault in keyframes of a moving target that only planning finds."""
    info = slip(f"M{number:03}", slug, summary, explanation, _KEYED, *changes)
    return info._replace(phase="plan")


CODES: tuple[CodeInfo, ...] = (
    _code(
        1,
        "unusable-track",
        "the points and times of a track make no motion",
        "A track written as points needs two different ones. With `times` it has one time for each point, "
        "counted from the start of the mission, and each is later than the one before it.",
        ("times: [0, 40]", "times: [40, 0]"),
    ),
    _code(
        2,
        "target-stands",
        "a shot that follows a motion has a target that stands",
        "Chase, lead, lateral and flyby place the camera relative to the direction in which the target "
        "moves. Give the target a `track`, or use a kind that needs no motion.",
        ("target: runner", "target: tower"),
    ),
    _code(
        3,
        "no-duration",
        "a shot of a moving target does not say how long it lasts",
        "A shot of targets that stand takes the time its path needs. If a target moves, the shot moves "
        "with it, and only its author knows for how long: add `duration` to its timing.",
        ("{start: 15, duration: 10}", "{start: 15}"),
    ),
    _code(
        4,
        "outside-track",
        "a shot films its target before or after its track",
        "A track from a file says where its target is from its first row to its last, one with `times` from its "
        "first. A shot of it begins and ends within that. Start the shot at another time, shorten it, or give "
        "more rows.",
        (
            "points: [[0, 0, 0.9], [60, 0, 0.9]], times: [0, 40]",
            "points: [[0, 0, 0.9], [60, 0, 0.9]], times: [17, 40]",
        ),
    ),
    _code(
        5,
        "cannot-keep-up",
        "a shot has to be flown faster than its drone flies",
        "To keep its place beside a target the camera has to go as fast as that place does, in the wind. Where that is more than "
        "the drone's speed over seconds, no plan can keep it. Only a place that swings round as its target turns a corner may "
        "be faster, by at most 40 % of its distance from the target: the camera then leads it by a half of that and follows "
        "it by the other. The help names what of the shot would let it: a place nearer to the target or on the inside of its bends, a longer `duration` where the shot moves "
        "by itself; or a higher `limits: {speed: ...}` of a drone that flies so fast. A shot without a `start` is judged "
        "by when what it comes after ends; where that is not known `plan` reports it.",
        ("times: [0, 40]", "times: [11, 17]"),
        ("{start: 15, duration: 10}", "{start: 11, duration: 6}"),
    ),
    _code(
        6,
        "shot-too-low",
        "a shot of a moving target is flown too near to the ground",
        "`altitude` is the camera's z in the world, and the ground is z = 0. The drone's body keeps "
        "`rules.ground_clearance` from it. Raise the shot.",
        ("altitude: 4", "altitude: 1"),
    ),
    _code(
        7,
        "subject-cropped",
        "a moving target is cropped at its place on screen",
        "The camera keeps its place beside the target, and from there the target does not fit the frame at any "
        "place of the composition. It is filmed at the nearest place on the set's vertical lines that shows it "
        "whole, or cropped where there is none. Film it from farther away, or with a wider field of view.",
        ("distance: 8, altitude: 4", "distance: 1.9, altitude: 2.7"),
    ),
    _code(
        8,
        "leaves-its-place",
        "a shot cannot keep its place beside a moving target",
        "The place that a chase, a lateral or another kind asks for is an ideal. If the drone's limits, a "
        "zone, the ground or another target prevent it, the plan leaves the ideal by as little as it can, "
        "and says by how much and when. Give the shot more room, or the drone higher limits.",
        (
            "targets:",
            "world: {zones: {tree: {keep: out, cylinder: {center: [30, 8], radius: 1.5, height: [0, 12]}}}}\ntargets:",
        ),
        ("shots:", "rules: {transit_clearance: {filmed: 1 m}}\nshots:"),
    ),
    _code(
        9,
        "no-way-beside",
        "no motion keeps a shot of a moving target clear of everything",
        "A shot on its own clock is flown from rest to rest, inside the keep-in zones, out of the keep-out zones, "
        "clear of targets and over the ground, at every instant. Here no such motion was found. The notes say what "
        "would have to give way, and by how much.",
        (
            "drones:",
            "world: {zones: {lane: {keep: in, box: {center: [50, 0, 1.95], size: [140, 3.2, 3.9]}}}}\ndrones:",
        ),
        ("home: [0, -30, 0]", "home: [-12, 0, 0]"),
        ("kind: lateral", "kind: flyby"),
        ("side: left, distance: 8, altitude: 4", "behind: 10, ahead: 10, altitude: 3, allow: [fast-pan]"),
    ),
    _needs_a_file(
        10,
        "track-too-short",
        "the track of a target ends before its shot does",
        "A track from a file ends with its last row. A shot without a `start` begins when its drone is in place, "
        "and then its target has to be known until it ends. Shorten the shot, give the track more rows, let "
        "it begin later by `begins`, or have the drone start nearer to it.",
    ),
    _code(
        11,
        "target-in-the-way",
        "every way to a shot, or home, meets a target",
        "Ways to shots and home are the plan's own. It goes straight, round targets and over them, and "
        "sets out at other times, and takes the first on which the body keeps `rules.target_clearance` "
        "from all of them at every instant. Here there is none, mostly because zones leave no room beside "
        "a target. Start the shot at another time, put `home` elsewhere, or widen the zone.",
        (
            "points: [[0, 0, 0.9], [60, 0, 0.9]], times: [0, 40]",
            "points: [[0, 0, 0.9], [0.5, 0, 0.9], [30, 0, 0.9]], times: [0, 14, 26]",
        ),
        (
            "drones:",
            "world: {zones: {lane: {keep: in, box: {center: [50, 0, 1.95], size: [140, 3.2, 3.9]}}}}\ndrones:",
        ),
        ("home: [0, -30, 0]", "home: [-12, 0, 0]"),
        ("kind: lateral", "kind: lead"),
        (" side: left,", ""),
        ("altitude: 4", "altitude: 3"),
    ),
    _keyed(
        15,
        "keyframes-out-of-reach",
        "a drone cannot pass the keyframes of a moving target at their times",
        "Keyframes that the author places bind: the camera is at each of them at its time, in motion, and the drone "
        "keeps its limits on the way. Here it cannot, though it is fast enough on average. Give the shot more time, "
        "move the keyframes, or raise the drone's limits.",
        ("offset: [-9, -9, 3]}, look_at: runner", "offset: [-18, 0, 3]}, look_at: runner, time: 1.5 s"),
        ("offset: [-9, 0, 5]}, look_at: runner", "offset: [-9, 0, 5]}, look_at: runner, time: 3 s"),
    ),
    _keyed(
        16,
        "target-elsewhere",
        "a target is not in the picture of a keyframe when the camera is there",
        "A keyframe of your own `heading` and `pitch` shows its target where that is when the camera comes there. A "
        "shot without a `start` begins when its drone is there, and its target has moved on by then. Look at the "
        "target, or say when the shot starts and frame it for that time.",
        ("timing: {start: 15, duration: 15}", "timing: {duration: 15}"),
        (
            "{at: {from: target, offset: [-9, -9, 3]}, look_at: runner}",
            "{at: [10, -9, 3], heading: 270 deg, pitch: 0 deg}",
        ),
    ),
    _code(
        12,
        "target-over-pad",
        "a target comes over a pad while the drone is on it",
        "A drone on its pad is a body there. It may leave as soon as the mission begins, and wait in the air for "
        "its shot or for room to land, so a target that passes later finds the pad empty. Here it comes sooner than "
        "any take-off is over, or it stays on the pad while the drone still films, or the drone films nothing and "
        "never leaves. Put `home` beside the track, or have the target pass at another time.",
        ("home: [0, -30, 0]", "home: [1.5, 0.2, 0]"),
    ),
    _code(
        13,
        "pad-not-free",
        "a drone cannot take off, or land, clear of a target",
        "The plan takes off before a target comes over the pad, or after it, and waits with the landing until the "
        "pad is free. Here the target is there at all of the times that were tried, and the drone's body would touch "
        "it. Move `home` aside from its track, or start the shot at another time.",
        (
            "points: [[0, 0, 0.9], [60, 0, 0.9]], times: [0, 40]",
            "points: [[0, 0, 0.9], [45, 0, 0.9]], times: [0, 30]",
        ),
        ("home: [0, -30, 0]", "home: [45, 0, 0]"),
        ("{start: 15, duration: 10}", "{duration: 10}"),
    ),
    _code(
        21,
        "target-too-fast",
        "a target would have to move faster than it can",
        "Two rows of a track lie so far apart, or its speed is such, that the target would be faster than its "
        "`top_speed`; 70 m/s where the mission gives none. In a recording this is a row with a wrong number, or "
        "a receiver that lost its place. The note names both rows and their lines. Correct the row, or give the "
        "target the `top_speed` that it has.",
        ("times: [0, 40]", "times: [0, 0.5]"),
    ),
    CodeInfo(
        "M022",
        "track-gap",
        Severity.WARNING,
        "a recorded track has a gap",
        "Two rows of a file are more than 3 s and ten times the usual time apart. A target is taken to go "
        "straight and evenly from row to row, so across the gap it may be elsewhere, and the picture without it. "
        "Where it is at one place at both ends of the gap it is taken to have stood, and nothing is said. Give the rows that are missing, or film before or after the gap.",
        _BY_FILE,
        _PASSING,
        phase="other",
    ),
    _framing(
        30,
        "subject-twice",
        "a framing names a target twice",
        "A target is in one place on screen, in one size. Name every subject of a framing once.",
        ("target: rider, frame", "target: runner, frame"),
    ),
    _framing(
        31,
        "size-out-of-reach",
        "a subject cannot be as large in the picture as asked",
        "How large a target appears is a matter of distance and lens. The camera keeps `rules.target_clearance` "
        "from it, and from there it is as large as it can be. Ask for a smaller size, lessen the clearance, or "
        "take a longer lens. Where no place on screen is asked that its view allows, the note says so.",
        ("size: 0.3", "size: close-up"),
    ),
    _framing(
        32,
        "view-blocked",
        "the camera cannot stand where it would see its subject as asked",
        "Size, place on screen and view say where the camera stands. Here that place is below the ground "
        "clearance, or in a zone or a target throughout the shot. If you leave the view out, it is chosen "
        "where there is room.",
        (_SECOND, ""),
        ("size: 0.3}", "size: 0.3, view: {elevation: -15 deg}}"),
    ),
    _framing(
        33,
        "subjects-apart",
        "subjects cannot be in one picture as asked",
        "Several subjects are in one picture if the camera is far enough away, and then all are small. "
        "Here one of them is out of the frame, or less than half as large as asked. Film them in two "
        "shots, ask for smaller sizes, or take a wider lens.",
        ("[[0, 3, 1], [60, 3, 1]]", "[[0, 53, 1], [60, 53, 1]]"),
        ("[0.27, 0.0]", "[0.27, 0.0], size: 0.3"),
    ),
    _framing(
        34,
        "framing-compromise",
        "several subjects cannot all appear as asked at once",
        "A camera has a place and two angles: that is enough for two places on screen and one more wish. "
        "Beyond that the plan is a compromise: it minimises the squared errors of place on screen, size "
        "and view. The notes give the errors of each subject. Write `require` for what matters most.",
        ("size: 0.3}", "size: 0.3, view: {azimuth: 270 deg}}"),
    ),
    _framing(
        36,
        "setpoint-without-start",
        "a setpoint of a framing changes nothing, or a value without a start",
        "A setpoint says how a subject appears from a time of the shot on: its place on screen, its size, its view. "
        "What it changes is written beside the target, too, as it is when the shot begins: the change goes from "
        "there to the setpoint.",
        ("size: 0.3}", "size: 0.3, setpoints: [{time: 5, view: {azimuth: 90 deg}}]}"),
    ),
    _framing(
        37,
        "setpoint-out-of-time",
        "setpoints of a framing are not in the order of their times, or come after its end",
        "The `time` of a setpoint counts from the shot's start. Setpoints are written in the order of their times, "
        "each later than the one before it, and none later than the duration.",
        ("size: 0.3}", "size: 0.3, setpoints: [{time: 15, size: 0.4}]}"),
    ),
    CodeInfo(
        "M038",
        "out-of-turn",
        Severity.WARNING,
        "a drone gives way to one of a later priority",
        "Drones are planned in order of `priority`, each clear of those before it. Where one finds no way "
        "beside them, it is planned before them, and they go clear of it, if all have a way then. The note "
        "says what could not be flown in order of priority. There is no warning for drones of the same "
        "priority.",
        _IN_TURN,
        _IN_TURN.replace("priority: 2", "priority: 1"),
        phase="plan",
    ),
    slip(
        "M035",
        "size-not-met",
        "a target does not have the asked size, because other numbers of its shot decide it",
        "The distance, radius or places that a shot is given say how large its target appears; `size` does not move "
        "the camera of any kind but `framing`. The note gives the size that the target has, and from how far away, or "
        "through which lens, it would have the one asked.",
        _PASSING,
        ("distance: 8, altitude: 4,", "distance: 8, altitude: 4, size: 0.6,"),
    )._replace(severity=Severity.WARNING),
)
