"""Q: faults in the convex solve, which finds ways and shapes paths. See shotc.diag.registry."""

from __future__ import annotations

from typing import Literal

from shotc.diag.code_info import CodeInfo
from shotc.diag.codes._slips import slip
from shotc.diag.model import Severity

_PASSING = """\
shotc: 1
mission: two-yards
world:
  zones:
    yard: {keep: in, box: {center: [0, 0, 10], size: [100, 100, 18]}}
    wall: {keep: out, box: {center: [0, 20, 10], size: [2, 60, 20]}}
    pole: {keep: out, cylinder: {center: [38, -20], radius: 1, height: [0, 15]}}
targets:
  lamp: {at: [20, 30, 14], radius: 0.3, height: 0.6}
  mast: {at: [-35, -35, 10], radius: 0.2, height: 20}
drones:
  cam1:
    model: x500
    home: [-20, -35, 0]
    body: follow-camera
    gimbal: {pitch: [-90 deg, 30 deg], yaw: [-135 deg, 135 deg]}
shots:
  - id: across
    kind: keyframes
    drone: cam1
    keyframes:
      - {at: [-20, 0, 8], heading: 90 deg, pitch: 0 deg}
      - {at: [20, 0, 8], heading: 90 deg, pitch: 0 deg}
  - id: round
    kind: orbit
    drone: cam1
    target: lamp
    composition: center
    radius: 15
    altitude: {above: origin, height: 8}
    sweep: 90 deg
    start_azimuth: 90 deg
  - id: past
    kind: keyframes
    drone: cam1
    target: lamp
    composition: center
    keyframes:
      - {at: [46, 10, 8], look_at: lamp}
      - {at: [5, 5, 8], look_at: lamp}
"""


# Allows what verification would otherwise report about the same shot.
_PROMISED = _PASSING.replace(
    "  - id: past\n", "  - id: past\n    require: {in_frame: 30 %, screen_error: 3}\n    allow: [fast-pan]\n"
)


def _code(
    number: int,
    slug: str,
    summary: str,
    explanation: str,
    *changes: tuple[str, str],
    severity: Severity = Severity.ERROR,
    base: str = _PASSING,
) -> CodeInfo:
    phase: Literal["plan", "other"] = "plan" if changes else "other"
    info = slip(f"Q{number:03}", slug, summary, explanation, base, *changes)
    return info._replace(severity=severity, phase=phase)


CODES: tuple[CodeInfo, ...] = (
    _code(
        1,
        "no-way",
        "no way leads from one place to the next",
        "Between two keyframes, or on the way to a shot or home, zones, targets, the ground and keep-in "
        "borders leave no gap that the drone with its clearances fits through. The labels name each zone "
        "that alone would open a way; the notes say how wide the gap is and how wide it must be. Move or "
        "shrink a zone, move the end points, or fly a smaller drone.",
        ("center: [0, 20, 10], size: [2, 60, 20]", "center: [0, 0, 10], size: [2, 100, 20]"),
    ),
    _code(
        2,
        "pad-blocked",
        "a drone cannot rise from its pad or land on it",
        "Take-off and landing are vertical at home, up to the height where the flight's rules begin to "
        "hold. Clearances and the floors of keep-in zones do not apply there, but a keep-out zone or a "
        "target over the pad does, and so do the borders and ceilings of keep-in zones; and straight "
        "above the pad there must be a free height to fly on from. Move home.",
        ("home: [-20, -35, 0]", "home: [-34, -35, 0]"),
    ),
    _code(
        3,
        "corridor-too-tight",
        "there is a way, but no smooth path that stays inside it",
        "The route round the zones is turned into a corridor, and the curve with the least jerk is sought "
        "inside it. None exists, even with more pieces. The notes give the smallest set of requirements "
        "in conflict, found by letting each give way at a price: how much each zone would have to shrink "
        "and each keyframe to move. A change with numbers in the help has been tried: with it there is a "
        "path.",
    ),
    _code(
        4,
        "point-too-near",
        "a place that the drone must pass is nearer to something than it may come",
        "The start or end of a way, or a keyframe, is inside a zone, a target or the ground, or nearer to "
        "it than the body sphere and the clearance allow, and no free place is near. Move it by the "
        "distance that the help gives.",
    ),
    _code(
        5,
        "body-cannot-follow",
        "the body is to face where the camera looks, but the gimbal cannot look straight ahead",
        "With `body: follow-camera` the gimbal's yaw is zero throughout, so `gimbal.yaw` must hold zero. "
        "Use `body: free` or `body: forward`, or widen the range.",
        ("yaw: [-135 deg, 135 deg]", "yaw: [20 deg, 135 deg]"),
    ),
    _code(
        6,
        "path-moved",
        "a path that a kind generates or draws leaves its ideal, because something is in the way",
        "What an orbit, a crane or another kind generates is an ideal: where it runs through a zone, a "
        "target or beyond a keep-in border, the path leads round, as near to the ideal as smoothness "
        "allows. So do the lines between the points of a `follow-path`, which also bow out beside corners too "
        "sharp for their legs. The warning says how far the path strays and where. Keyframes that you place "
        "yourself are never moved.",
        ("center: [38, -20], radius: 1", "center: [30.6, 40.6], radius: 1"),
        severity=Severity.WARNING,
    ),
    _code(
        7,
        "framing-not-kept",
        "between two keyframes the gimbal cannot keep the target in its place",
        "Between keyframes the camera keeps the composition by turning as the drone moves. Where that "
        "would take a pitch beyond the gimbal's range, or a roll, the camera stops at its limit and the "
        "target leaves its place. Pass at a greater distance, nearer to the target's height, or widen "
        "`gimbal.pitch`. A refiner such as `ours` leads the path aside as far as it can, and verification says "
        "what is left of it (V030, V032): this is reported of shots that stay on the convex path, and of the failing "
        "mission with `--refiner none`.",
        ("{at: [5, 5, 8], look_at: lamp}", "{at: [5, 36, 8], look_at: lamp}"),
        severity=Severity.WARNING,
        base=_PROMISED,
    ),
    _code(
        8,
        "solver-gave-up",
        "the convex solver found neither an answer nor a proof that there is none",
        "This should not happen with missions of sensible size. Distances of many kilometres between "
        "keyframes, or keyframes a few millimetres apart, make the numbers hard: scale the mission, or "
        "report it together with the mission file.",
    ),
    _code(
        9,
        "picture-turns",
        "following its target, the camera swings round between two keyframes",
        "A camera that passes straight over what it films has to turn by half a circle there, since it can "
        "only pitch down to the vertical: seen on screen, the picture turns. The warning says where, and by "
        "how much; it also says where the camera cannot follow exactly. Pass beside the target, or give the "
        "keyframes a `heading` and a `pitch` of their own.",
        ("lamp: {at: [20, 30, 14]", "lamp: {at: [25.5, 7.5, 1]"),
        severity=Severity.WARNING,
    ),
)
