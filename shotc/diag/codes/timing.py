"""T: times that the planned path cannot meet. See shotc.diag.registry.

Times that no path can meet have K codes: shotc finds them earlier, without a solver.
"""

from __future__ import annotations

from shotc.diag.code_info import CodeInfo
from shotc.diag.codes._slips import slip
from shotc.diag.model import Severity

_MISSION = """\
shotc: 1
mission: mast
targets: {mast: {at: [0, 0, 6], radius: 1, height: 12}}
drones: {cam: {model: x500, home: [0, -30, 0], endurance: 2 min}}
shots:
  - id: pass
    kind: keyframes
    drone: cam
    target: mast
    timing: {start: 20 s, duration: 16 s}
    keyframes:
      - {at: [-20, -20, 8], look_at: mast}
      - {at: [0, -24, 9], look_at: mast, time: 8 s}
      - {at: [20, -20, 10], look_at: mast, hold: 1 s}
"""

_STILL = """\
shotc: 1
mission: mast
targets: {mast: {at: [0, 0, 6], radius: 1, height: 12}}
drones: {cam: {model: x500, home: [0, -30, 0]}}
shots:
  - id: look
    kind: keyframes
    drone: cam
    target: mast
    timing: {duration: 5 s}
    keyframes:
      - {at: [-20, -20, 8], look_at: mast}
      - {at: [-20, -20, 8], look_at: mast}
"""


def _code(
    number: int, slug: str, summary: str, explanation: str, *changes: tuple[str, str], base: str = _MISSION
) -> CodeInfo:
    return slip(f"T{number:03}", slug, summary, explanation, base, *changes)._replace(phase="plan")


CODES: tuple[CodeInfo, ...] = (
    _code(
        1,
        "duration-too-short",
        "a shot cannot be flown in the duration it is given",
        "The path is flown as fast as the limits allow: speed, climb and descent, acceleration and jerk as "
        "norms in space, the turning of the body and of each gimbal axis, from rest to rest, with its "
        "holds. If that takes longer than `duration`, the message gives the shortest possible duration, "
        "and the notes give the limits that hold the drone back and where. If a refiner has changed the "
        "path, the duration is that of the refined path, and a note gives that of the convex path. Give "
        "the shot that duration, raise the limit, or bring its keyframes nearer together.",
        ("duration: 16 s", "duration: 9 s"),
        (", time: 8 s", ""),
    ),
    _code(
        2,
        "keyframe-too-early",
        "a keyframe cannot be reached at its time",
        "Between two keyframes with a fixed `time` the drone has to cover the path within its limits, with "
        "the holds on the way. The earliest possible time is named. Fix a later time, free one of the "
        "keyframes, or raise the limit that binds.",
        ("time: 8 s", "time: 3.5 s"),
    ),
    _code(
        3,
        "start-too-early",
        "a shot starts before its drone can be there",
        "`start` is when the first frame is filmed. Take-off, the earlier shots and the ways between them "
        "take longer than that; the notes list them. Start later, or shorten what comes before. A moving "
        "target moves on while the start is delayed. The start in the message takes that into account. If "
        "a recorded track ends too soon for it, the message gives the possible duration as well. A "
        "recording that begins later (`track: {file: ..., begins: 10 s}`) gives the drone that much more "
        "time.",
        ("start: 20 s", "start: 7 s"),
    ),
    _code(
        4,
        "flight-too-long",
        "the whole flight is longer than the drone's endurance",
        "From take-off to touch-down the drone flies its shots, the ways between them and home, its holds and "
        "its waits for a `start`. The phases are listed, the longest first. Shorten shots, start them sooner, "
        "or split the mission.",
        ("start: 20 s", "start: 105 s"),
    ),
    _code(
        5,
        "shot-without-length",
        "a shot takes no time",
        "All its keyframes are the same view, none has a hold, and the shot has no duration, so there is "
        "nothing to film. Give it a `duration` or a `hold`, or a keyframe elsewhere.",
        ("    timing: {duration: 5 s}\n", ""),
        base=_STILL,
    ),
    CodeInfo(
        "T006",
        "timed-roughly",
        Severity.WARNING,
        "the solver gave no fastest timing, so a slower one is flown",
        "A shot's timing is the fastest that keeps every limit, found by a convex solver. If the solver "
        "gives up, which should not happen with sensible missions, a rough timing is slowed down until it "
        "keeps every limit; it takes about a third longer. Leave more room between keyframes that lie very "
        "near together, or report it together with the mission file.",
        _MISSION,
        _MISSION,
        "other",
    ),
)
