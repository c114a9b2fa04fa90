"""F: film grammar, shots and cuts that can be flown but disturb an audience. See shotc.diag.registry."""

from __future__ import annotations

from shotc.diag.code_info import CodeInfo
from shotc.diag.codes._slips import slip
from shotc.diag.model import Severity

_PASSING = """\
shotc: 1
mission: run
targets:
  runner: {track: {points: [[0, 0, 0.9], [60, 0, 0.9]], times: [0, 40]}, radius: 0.4, height: 1.8}
drones:
  cam1: {model: x500, home: [0, 30, 0]}
shots:
  - {id: side, kind: lateral, drone: cam1, target: runner, side: left, distance: 8, altitude: 4,
     timing: {start: 10, duration: 5}}
  - {id: closer, kind: lateral, drone: cam1, target: runner, side: left, distance: 4, altitude: 3,
     timing: {start: 20, duration: 5}}
"""

_STILL = """\
shotc: 1
mission: watch
targets:
  runner: {track: {points: [[0, 0, 0.9], [60, 0, 0.9]], times: [0, 40]}, radius: 0.4, height: 1.8}
drones:
  cam1: {model: x500, home: [0, 30, 0], camera: {hfov: 70 deg, aspect: "16:9"}}
shots:
  - {id: watch, kind: static, drone: cam1, target: runner, at: [30, 20, 4], heading: 180 deg, pitch: -5 deg,
     timing: {start: 15, duration: 10}}
"""

_PAN = """\
shotc: 1
mission: pan
drones:
  cam1: {model: x500, home: [0, -60, 0], camera: {hfov: 70 deg, aspect: "16:9"}}
shots:
  - id: sweep
    kind: keyframes
    drone: cam1
    timing: {duration: 8}
    keyframes:
      - {at: [0, -50, 15], heading: 320 deg, pitch: 0 deg}
      - {at: [4, -50, 15], heading: 20 deg, pitch: 0 deg}
"""


def _code(
    number: int, slug: str, summary: str, explanation: str, passing: str, *changes: tuple[str, str]
) -> CodeInfo:
    info = slip(f"F{number:03}", slug, summary, explanation, passing, *changes)
    return info._replace(severity=Severity.WARNING)


_ALLOW = " If it is intended, write `allow: [{}]` in the shot, or under `rules` for the whole mission."

CODES: tuple[CodeInfo, ...] = (
    _code(
        1,
        "crossing-the-line",
        "a cut crosses the line of action",
        "The line of action is the way that a subject moves or, of two subjects filmed together, the line "
        "between them. As long as the camera stays on one side of it, what goes to the left goes to the "
        "left in every shot (the 180-degree rule). A cut to the other side turns it round. The last frame "
        "of a shot is compared with the first frame of the next one, in the order of the film over all "
        "drones. A camera less than 15 deg off the line, ahead, behind or overhead, is on neither side. A "
        "shot may cross the line while it films; then the side on which it ends counts. Film both shots "
        "from one side, or put another shot between them." + _ALLOW.format("crossing-the-line"),
        _PASSING,
        ("side: left, distance: 4", "side: right, distance: 4"),
    ),
    _code(
        2,
        "jump-cut",
        "a cut makes its subject jump",
        "Two pictures of one subject that are nearly alike do not look like a cut but like a piece of film that is "
        "missing. The 30-degree rule asks for a camera that stands 30 deg or more to the side of where it stood, as "
        "seen from the subject; else the subject's size on screen has to change by half or more (1.5 times, either "
        "way). A shot that begins with the very picture that the last one ends with carries it on and is no cut. "
        "Move the second shot round the subject, or much nearer or farther." + _ALLOW.format("jump-cut"),
        _PASSING,
        ("side: left, distance: 4, altitude: 3", "side: left, distance: 7, altitude: 4"),
    ),
    _code(
        3,
        "short-shot",
        "a shot is over before it is seen",
        "The eye fixes three or four points a second, and in a picture from the air it has to find the subject, the "
        "ground and the motion before it reads any of them. Below 2 s that is a glimpse: our number, between the "
        "fastest cutting of feature films and the 3 to 5 s that are usual. A drone cannot be cut in faster than it "
        "films. Give the shot 2 s or more." + _ALLOW.format("short-shot"),
        _PASSING,
        ("{start: 20, duration: 5}", "{start: 20, duration: 1.5}"),
    ),
    _code(
        4,
        "walks-out-of-frame",
        "a subject is not in the picture of a camera that does not turn",
        "A static shot with `heading` and `pitch`, or with a point to look at, keeps its camera still "
        "while its target moves through the picture. The warning appears if no part of the target is in "
        "the frame for half a second or more of the shot. An empty frame may be intended. If not, let the "
        "camera follow (`look_at` and the target's name), stand farther away, take a wider lens, or film "
        "while the target passes." + _ALLOW.format("walks-out-of-frame"),
        _STILL,
        ("{start: 15, duration: 10}", "{start: 15, duration: 20}"),
    ),
    _code(
        5,
        "fast-pan",
        "the camera turns faster than a film can show",
        "A film shows 24 pictures a second, and where what is in them moves too far from one to the next "
        "it judders. The usual rule (RED, Panning Speed Best Practices; the tables of camera manuals) is "
        "that nothing goes through the frame in less than 7 s. A camera that turns at w moves the "
        "surroundings by w / (2 tan(hfov / 2)) frame widths a second. Where it follows a subject, that "
        "stands still on screen and holds the eye, and the surroundings may go by in 3 s, where RED shows "
        "its example of plain judder. The rate is the mean one between keyframes whose time is known, for "
        "a drone may turn evenly at best; of a shot on its own clock it is that over the fastest second. "
        "Without a duration there is no warning. Turn less, take more time, a wider lens, or a place "
        "farther away. What is flown is judged by the same rule (V051)." + _ALLOW.format("fast-pan"),
        _PAN,
        ("duration: 8", "duration: 4"),
    )._replace(exact=("V051",)),
)
