"""V019 to V033: faults that verification finds in the picture: promises, cropped targets, visible drones."""

from __future__ import annotations

from shotc.diag.code_info import CodeInfo
from shotc.diag.codes._verified import verified
from shotc.diag.model import Severity

_MISSION = """\
shotc: 1
mission: mast
targets: {mast: {at: [0, 0, 6], radius: 1, height: 12}}
drones: {cam: {model: x500, home: [0, -30, 0]}}
shots:
  - id: look
    kind: keyframes
    drone: cam
    target: mast
    require: {PROMISE}
    keyframes:
      - {at: [-24, -20, 6], look_at: mast}
      - {at: [24, -20, 6], look_at: mast}
"""


_WATCH = """\
shotc: 1
mission: watch
targets:
  runner: {track: {points: [[0, 0, 0.9], [60, 0, 0.9]], times: [0, 40]}, radius: 0.4, height: 1.8}
drones: {cam: {model: x500, home: [0, -30, 0]}}
shots:
  - {id: pass, kind: static, drone: cam, target: runner, at: [30, -12, 4], AIM,
     timing: {start: 15, duration: 15}, require: {in_frame: 100 %}, allow: [walks-out-of-frame]}
"""


def _promise(promise: str) -> str:
    return _MISSION.replace("PROMISE", promise)


_PAIR = """\
shotc: 1
mission: pair
drones:
  one: {model: x500, home: [0, -40, 0]}
  two: {model: x500, home: [8, -40, 0]}
rules: {mutual_visibility: {strength: STRENGTH}}
shots:
  - {id: look, kind: static, drone: one, at: [0, -30, 9], heading: 0 deg, pitch: 0 deg,
     timing: {start: 40, duration: 5}}
  - {id: see, kind: static, drone: two, at: [PLACE, 9], heading: HEADING deg, pitch: 0 deg,
     timing: {start: 40, duration: 5}}
"""
_FACING, _ABREAST = ("0, 30", "180"), ("12, -30", "0")


def _pair(strength: str, where: tuple[str, str]) -> str:
    return _PAIR.replace("STRENGTH", strength).replace("PLACE", where[0]).replace("HEADING", where[1])


FRAMED: tuple[CodeInfo, ...] = (
    verified(
        19,
        "in-frame-promise-broken",
        (
            "a shot shows its whole target less often than it promises",
            "`require: {in_frame: ...}` promises the share of frames in which the whole silhouette of the target's "
            "cylinder is inside the frame. The worst frame is named. Move back or widen the field of view there, "
            "slow the shot down, or promise less.",
        ),
        (
            _WATCH.replace("AIM", "heading: 0 deg, pitch: -10 deg"),
            _WATCH.replace("AIM", "look_at: runner"),
        ),
    ),
    verified(
        20,
        "screen-error-promise-broken",
        (
            "a target strays farther from its place on screen than the shot promises",
            "`require: {screen_error: ...}` promises the largest distance between the projected centre of the "
            "target and its reference, in screen units of half a frame. Add a keyframe where the error is largest, "
            "slow the shot down, or promise less.",
        ),
        (_promise("screen_error: 0.00001"), _promise("screen_error: 0.05")),
    ),
    verified(
        21,
        "size-promise-broken",
        (
            "a target is smaller or larger on screen than the shot promises",
            "`require: {size: [low, high]}` promises the projected height of the target over the height of the "
            "frame. Change the distance or the field of view where the worst frame is, or the promise.",
        ),
        (_promise("size: [0.9, 1.0]"), _promise("size: [0.1, 0.9]")),
    ),
    verified(
        24,
        "framing-not-as-asked",
        (
            "the plan does not frame a target as its shot's keyframes say",
            "A picture is judged where the plan frames the target, against the reference in the plan. Between two "
            "keyframes of one target it has to be framed all the time. If the shot promises something, the "
            "reference also has to lead from the one keyframe's place on screen to the other's. A plan where it "
            "does not was edited or damaged.",
        ),
    ),
    verified(
        25,
        "drone-in-required-picture",
        (
            "a drone is in another one's picture, and the mission requires that none is",
            "With `rules: {mutual_visibility: {strength: require}}` the body sphere of every other drone stays "
            "outside of the frame of a drone that films, beyond one of its edges or behind the camera, or outside "
            "of the cone about the optical axis where `half_angle` is given. That counts in all phases of the other "
            "drone, also on its pad, and also where a target or a zone would hide it. It is proved between frames, "
            "too. Film at another time or from another side, or prefer it only.",
        ),
        (_pair("require", _FACING), _pair("require", _ABREAST)),
    ),
    verified(
        30,
        "target-cropped",
        (
            "a target is not whole in the frame for a part of its shot",
            "The shot promises nothing, so this is a warning. The worst frame is named: move back or widen "
            "the field of view there. `require: {in_frame: 100 %}` makes it an error.",
        ),
        severity=Severity.WARNING,
    ),
    verified(
        32,
        "target-off-its-place",
        (
            "a target strays far from its place on screen, and the shot promises nothing of it",
            "Where the composition and a limit conflict, the limit wins: the drone keeps its clearances "
            "and the gimbal its range and rates, and the target leaves its place. The warning appears from "
            "an error of a twentieth of half a frame, once a shot, with the worst frame, its time, and the "
            "limits of the gimbal and of the space that are reached there. Loosen those limits or move the "
            "keyframes beside it. `require: {screen_error: ...}` makes it an error. A shot without a "
            "composition is not judged.",
        ),
        severity=Severity.WARNING,
    ),
    verified(
        33,
        "drone-in-picture",
        (
            "a drone is in another one's picture",
            "The plan keeps drones out of each other's pictures where it can, unless the mission says "
            "otherwise; here it could not. The notes give the first frame that shows the drone, the worst "
            "one and the share of the shot. Film at another time or from another side. `rules: "
            "{mutual_visibility: {strength: require}}` makes it an error, `strength: off` removes the "
            "warning. See V025 for what counts as in the picture.",
        ),
        (_pair("prefer", _FACING), _pair("prefer", _ABREAST)),
        severity=Severity.WARNING,
    ),
)
