"""V: what the proof of a finished trajectory finds. See shotc.diag.registry.

A mission alone shows few of these: the passes before plan within the limits. They are what an edited or
damaged plan.json, or a faulty plugin, runs into.
"""

from __future__ import annotations

from typing import Literal

from shotc.diag.code_info import CodeInfo
from shotc.diag.codes._shown import SHOWN
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
      - {at: [-24, SOUTH, 6], look_at: mast}
      - {at: [24, SOUTH, 6], look_at: mast}
"""


def _promise(promise: str, south: int = -20) -> str:
    return _MISSION.replace("PROMISE", promise).replace("SOUTH", str(south))


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


def _code(
    number: int,
    slug: str,
    text: tuple[str, str],
    examples: tuple[str, str] = ("", ""),
    severity: Severity = Severity.ERROR,
) -> CodeInfo:
    phase: Literal["plan", "other"] = "plan" if examples[0] else "other"
    return CodeInfo(f"V{number:03}", slug, severity, *text, *examples, phase)


_LIMITS = (
    _code(
        1,
        "too-fast",
        (
            "a speed limit is broken",
            "`speed` binds the horizontal velocity less the wind, `climb` and `descent` the vertical one, at every "
            "instant and not only at samples. The diagnostic gives the proven maximum and when it occurs. Give the "
            "shot more time, bring its keyframes nearer, or raise the limit, and plan again.",
        ),
    ),
    _code(
        2,
        "too-hard-acceleration",
        (
            "the acceleration limit is broken",
            "`acceleration` binds the norm of the three-dimensional acceleration at every instant. A shot that is "
            "given k times its duration needs 1/k^2 of the acceleration: the help line computes the duration.",
        ),
    ),
    _code(
        3,
        "too-hard-jerk",
        (
            "the jerk limit is broken",
            "`jerk` binds the norm of the rate of acceleration: what shakes the picture and what the motors have to "
            "follow. A shot that is given k times its duration needs 1/k^3 of the jerk.",
        ),
    ),
    _code(
        4,
        "body-turns-too-fast",
        (
            "the body turns faster than its limits allow",
            "`yaw_rate` and `yaw_acceleration` bind the heading of the body, not of the camera. Give the turn more "
            "time, or let the gimbal turn instead with `body: free`.",
        ),
    ),
    _code(
        5,
        "gimbal-out-of-range",
        (
            "the camera points where the gimbal cannot",
            "The gimbal's pitch is measured against the horizon, its yaw against the body. Somewhere along the "
            "flight one of them leaves its range. Fly lower or farther away for a steep pitch, or let the body "
            "follow the camera for a wide yaw.",
        ),
    ),
    _code(
        6,
        "gimbal-too-fast",
        (
            "a gimbal axis turns faster than it can",
            "`gimbal.rate` and `gimbal.acceleration` bind each axis, yaw relative to the body. A pass close to the "
            "target asks for the fastest turns: keep more distance, or give the shot more time.",
        ),
    ),
    _code(
        18,
        "field-of-view-out-of-range",
        (
            "the field of view is none that a camera has",
            "The horizontal field of view must lie between 1 and 170 degrees at every instant of the plan: outside "
            "of that the projection means nothing.",
        ),
    ),
)

_SPACE = (
    _code(
        7,
        "zone-entered",
        (
            "the flight enters a keep-out zone",
            "The body sphere of the drone has to stay out of every `keep: out` zone in all phases; in take-off and "
            "landing it may stand as near as its home does. The distance is proved over continuous time, so a "
            "corner cut between two samples is found, too.",
        ),
    ),
    _code(
        8,
        "zone-left",
        (
            "the flight leaves a keep-in zone",
            "The body sphere has to stay inside every `keep: in` zone; only in take-off and landing does the floor "
            "of the zone not apply. The margin is that to the nearest face, counted from the body.",
        ),
    ),
    _code(
        9,
        "too-near-the-ground",
        (
            "the flight comes too near to the ground",
            "Outside of take-off and landing the body has to stay `rules.ground_clearance` above z = 0, counted from "
            "the lowest point of the body sphere.",
        ),
    ),
    _code(
        10,
        "too-near-a-target",
        (
            "the flight comes too near to a target",
            "Targets are solid cylinders. Outside of take-off and landing the body sphere keeps "
            "`rules.target_clearance` from all of them, filmed or not.",
        ),
    ),
    _code(
        22,
        "drones-too-near",
        (
            "two drones come too near to each other",
            "`rules.separation` is kept centre to centre at every instant, also by a drone that has landed and "
            "stands at its home. Give one of the shots another start, or move the homes apart. The drones of a "
            "fleet keep its own `separation`, with its margin: an ellipsoid or a cylinder whose height counts as "
            "much as its width, so that one horizontal distance tells how near two drones come. Two fleets keep "
            "the larger of both. Give pictures more room or transitions more time.",
        ),
    ),
)

_FORM = (
    _code(
        11,
        "motion-jumps",
        (
            "position, rate or acceleration jumps at a joint of the trajectory",
            "A plan is a chain of polynomials that agree at their joints in value, first and second derivative. What "
            "rounding leaves is added up over all joints of a flight, and is at most a micrometre, a micrometre a "
            "second and a tenth of a millimetre a second squared (so many microradians for angles) in each channel. A "
            "plan in which it is more was edited or damaged. Plan the mission again.",
        ),
    ),
    _code(
        12,
        "not-at-home",
        (
            "the flight does not begin and end at rest at home",
            "Every flight starts on its pad at time 0 and ends on it: position, rates and accelerations are "
            "checked at both ends. A plan that does not was edited or damaged. Plan the mission again.",
        ),
    ),
    _code(
        13,
        "endurance-exceeded",
        (
            "the whole flight is longer than the drone can stay up",
            "`endurance` counts from take-off to touch-down, with transits, holds and the way home. Shorten shots, "
            "bring home nearer, split the mission, or state a longer endurance if the battery has it.",
        ),
    ),
    _code(
        14,
        "flight-not-whole",
        (
            "the trajectory is not one flight",
            "The phases of a flight follow one another from time 0 to its end, exactly, without a gap and without an "
            "overlap, every shot phase names a shot of the mission, and every flight a drone. No piece of a curve is "
            "shorter than 10 us. A plan where it is not so was edited or damaged.",
        ),
    ),
    _code(
        15,
        "shot-not-as-asked",
        (
            "a shot is missing, or not flown when it was asked",
            "Every shot of the mission is flown exactly once; its duration and start are met to a millisecond, and "
            "it begins no earlier than the end of the shot it comes after. Every picture of a display is shown, in "
            "the order written, as long as it is to be held.",
        ),
    ),
    _code(
        16,
        "keyframe-missed",
        (
            "the flight misses a keyframe that the mission places",
            "A position that the user wrote down binds: the camera is there to a millimetre at the keyframe's time, "
            "at the time the mission fixes, and stands still through the keyframe's hold. The drones of a fleet stand "
            "still while a picture is held.",
        ),
    ),
    _code(
        17,
        "not-vertical-at-home",
        (
            "take-off or landing is not vertical above home",
            "Clearances and the floors of keep-in zones are lifted in take-off and landing, which is safe only "
            "because both are vertical at home. A plan that drifts there was edited or damaged.",
        ),
    ),
)

_FRAMING = (
    _code(
        19,
        "in-frame-promise-broken",
        (
            "a shot shows its whole target less often than it promises",
            "`require: {in_frame: ...}` promises the share of frames in which the whole silhouette of the target's "
            "cylinder is inside the frame. The worst frame is named. Move back or widen the field of view there, "
            "slow the shot down, or promise less.",
        ),
        (_promise("in_frame: 100 %", -8), _promise("in_frame: 100 %")),
    ),
    _code(
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
    _code(
        21,
        "size-promise-broken",
        (
            "a target is smaller or larger on screen than the shot promises",
            "`require: {size: [low, high]}` promises the projected height of the target over the height of the "
            "frame. Change the distance or the field of view where the worst frame is, or the promise.",
        ),
        (_promise("size: [0.9, 1.0]"), _promise("size: [0.1, 0.9]")),
    ),
    _code(
        24,
        "promise-without-framing",
        (
            "a shot promises something of a target that the plan does not frame as its keyframes say",
            "A promise is judged where the plan frames the target, against the reference in the plan. Between two "
            "keyframes of one target it has to be framed all the time, and the reference has to lead from the one "
            "keyframe's place on screen to the other's. A plan where it does not was edited or damaged.",
        ),
    ),
    _code(
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
    _code(
        30,
        "target-cropped",
        (
            "a target is not whole in the frame for a part of its shot",
            "The shot promises nothing, so this is a warning. The worst frame is named: move back or widen the "
            "field of view there. State `require: {in_frame: 100 %}` to have the shot held to it.",
        ),
        severity=Severity.WARNING,
    ),
    _code(
        32,
        "target-off-its-place",
        (
            "a target strays far from its place on screen, and the shot promises nothing of it",
            "Where the composition and a limit conflict, the limit wins: the drone keeps its clearances and the gimbal "
            "its range and rates, and the target leaves its place. This is told from a twentieth of half a frame on, "
            "once a shot, with the worst frame, its time, and what of the gimbal and of the space around is at its "
            "limit there. Loosen that or move the keyframes beside it. State `require: {screen_error: ...}` to have "
            "the shot held to it; then it is an error. A shot without a composition is not judged.",
        ),
        severity=Severity.WARNING,
    ),
    _code(
        33,
        "drone-in-picture",
        (
            "a drone is in another one's picture",
            "The plan keeps drones out of each other's pictures where it can, unless the mission says otherwise; "
            "here it could not. The first frame that shows the drone, the worst one and the share of the shot are "
            "told. Film at another time or from another side. `rules: {mutual_visibility: {strength: require}}` "
            "makes it an error, `strength: off` has it not judged. See V025 for what counts as in the picture.",
        ),
        (_pair("prefer", _FACING), _pair("prefer", _ABREAST)),
        severity=Severity.WARNING,
    ),
)

_FILE = (
    _code(
        40,
        "certificate-differs",
        (
            "the certificate in the plan is not what the plan proves",
            "`shotc verify` proves every claim again from the trajectory and the limits in the file. Where a value, "
            "a limit or a claim in its certificate differs, something in the file was edited: the certificate, the "
            "trajectory or a limit. A file that another version of shotc wrote may differ in many claims, which is told "
            "at once. The proof that counts is the new one; plan the mission again.",
        ),
    ),
    _code(
        41,
        "plan-of-another-mission",
        (
            "the plan says another thing of its mission than the mission itself",
            "A plan holds the text of its mission and the tables that it names. `shotc verify` lowers them again, as "
            "`check` does, and holds the plan to all that comes of it: shots, keyframes, holds, times, places on screen, "
            "targets, drones, limits, zones. Here what the plan says differs, so the file was edited, or another version "
            "of shotc wrote it. Plan the mission again.",
        ),
    ),
    _code(
        42,
        "plan-without-its-mission",
        (
            "the mission of a plan cannot be lowered again",
            "What a plan is to do follows from its mission alone, so a plan without one proves nothing: one that an "
            "earlier version of shotc wrote, one whose text or tables were cut out, one with a kind of shot that no "
            "installed package has. Plan the mission again, or install the package.",
        ),
    ),
    _code(
        43,
        "plan-of-another-file",
        (
            "the plan is not the plan of the mission that it is held to",
            "`shotc verify PLAN --against MISSION` holds a plan to a file besides the mission in it: the one that is "
            "reviewed, so that no plan of an earlier mission is flown. All that the file asks for is compared, its "
            "tracks and what its displays draw included; comments and the order of keys are free. Plan the file again.",
        ),
    ),
    _code(
        44,
        "path-left-untold",
        (
            "a shot is flown elsewhere than its kind asks, and the plan does not say so",
            "A path that a kind generates is an ideal: planning leaves it where something stands in the way, or for "
            "the picture's sake, and says by how much (`deviations`). No more than that is allowed, half a metre at "
            "its beginning and its end where nothing is near, and half the distance to the target elsewhere. So an "
            "orbit of another sweep, the other way round or backwards is none. Plan the mission again.",
        ),
    ),
    _code(
        45,
        "camera-off-its-keyframes",
        (
            "the camera looks elsewhere at a keyframe than the mission asks",
            "At a keyframe the lens is the one that is asked for, a camera that frames nothing looks where it is told "
            "to, and one that goes round goes round as often as it should. Where a target is on screen is told apart (V030, "
            "V032), and held where the shot says `require`. Plan the mission again.",
        ),
    ),
    _code(
        46,
        "promise-not-judged",
        (
            "a shot promises what nothing in the plan can be held to",
            "Every key of `require` has a claim in the certificate. Without a target that is framed, or for "
            "`screen_error` without a place on screen that is wanted, there is none, and the promise would mean nothing. "
            "Remove the key, or give the shot a target and a composition.",
        ),
    ),
)

CODES: tuple[CodeInfo, ...] = tuple(
    sorted((*_LIMITS, *_SPACE, *_FORM, *_FRAMING, *_FILE, *SHOWN), key=lambda info: info.code)
)
