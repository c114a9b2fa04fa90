"""M: moving targets, their tracks and the shots that follow them. See shotc.diag.registry."""

from __future__ import annotations

from shotc.diag.codes._slips import slip
from shotc.diag.model import Severity
from shotc.diag.registry import CodeInfo

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


def _code(number: int, slug: str, summary: str, explanation: str, *changes: tuple[str, str]) -> CodeInfo:
    return slip(f"M{number:03}", slug, summary, explanation, _PASSING, *changes)


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
        "Chase, lead, lateral and flyby are told ahead of, behind and beside the way a target goes. Give the "
        "target a `track`, or use a kind that needs no motion.",
        ("target: runner", "target: tower"),
    ),
    _code(
        3,
        "no-duration",
        "a shot of a moving target does not say how long it lasts",
        "A shot of targets that stand takes the time its path needs. Where a target moves, the shot goes with "
        "it, and only its author knows for how long: add `duration` to its timing.",
        ("{start: 15, duration: 10}", "{start: 15}"),
    ),
    _code(
        4,
        "outside-track",
        "a shot films its target before or after its track",
        "A track from a file, or with times, says where its target is from its first row to its last. A shot "
        "of it begins and ends within that. Start the shot at another time, shorten it, or give more rows.",
        (
            "points: [[0, 0, 0.9], [60, 0, 0.9]], times: [0, 40]",
            "points: [[0, 0, 0.9], [60, 0, 0.9]], times: [17, 40]",
        ),
    ),
    _code(
        5,
        "cannot-keep-up",
        "a shot has to be flown faster than its drone flies",
        "To keep its place beside a target the camera has to go as fast as that place does. Where that is more than "
        "the drone's speed, less the wind, over seconds, no plan can keep it. Take a faster drone, slow the target "
        "down, or give the shot a place that asks for less way.",
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
        "target-too-fast",
        "a target would have to move faster than it can",
        "Two rows of a track lie so far apart, or its speed is such, that the target would be faster than its "
        "`top_speed`; 70 m/s where the mission gives none. In a recording this is a row with a wrong number, or "
        "a receiver that lost its place. The note names both rows and their lines. Mend the row, or give the "
        "target the `top_speed` that it has.",
        ("times: [0, 40]", "times: [0, 0.5]"),
    ),
    CodeInfo(
        "M008",
        "track-gap",
        Severity.WARNING,
        "a recorded track has a gap",
        "Two rows of a file are more than 3 s and ten times the usual time apart. A target is taken to go "
        "straight and evenly from row to row, so across the gap it may be elsewhere, and the picture without it. "
        "Give the rows that are missing, or film before or after the gap.",
        _BY_FILE,
        _PASSING,
        phase="other",
    ),
)
