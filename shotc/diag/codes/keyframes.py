"""K: faults in keyframes, kinds and their timing, found without a solver. See shotc.diag.registry."""

from __future__ import annotations

from shotc.diag.code_info import CodeInfo
from shotc.diag.codes._slips import slip
from shotc.diag.model import Severity

_PASSING = """\
shotc: 1
mission: tower-walk
world: {wind: 1 m/s}
targets:
  tower: {at: [0, 0, 12], radius: 4, height: 24}
drones:
  cam1: {model: x500, home: [0, -60, 0], limits: {speed: 9 m/s}, endurance: 10 min,
    camera: {zoom: [24 mm, 70 mm], hfov: 70 deg}}
shots:
  - id: walk
    kind: keyframes
    drone: cam1
    target: tower
    timing: {start: 20, duration: 40}
    keyframes:
      - {at: [-40, -30, 10], look_at: tower, time: 0}
      - {at: [0, -45, 18], look_at: tower, hold: 2, time: 15}
      - {at: [45, -20, 15], look_at: tower}
  - {id: above, kind: top-down, drone: cam1, target: tower, altitude: 60, drift: [1, 0, 0],
     timing: {start: 100, duration: 10}}
  - {id: rise, kind: elevator, drone: cam1, target: tower, azimuth: 180 deg, distance: 50, altitude: [5, 30],
     timing: {after: above}}
"""


def _code(
    number: int, slug: str, summary: str, explanation: str, change: tuple[str, str], *exact: str
) -> CodeInfo:
    """Return one code. ``exact`` are codes of the time pass that report the same fault with exact numbers."""
    return slip(f"K{number:03}", slug, summary, explanation, _PASSING, change)._replace(exact=exact)


_BESIDE = """\
shotc: 1
mission: beside
targets:
  runner: {track: {start: [0, 0, 0.9], velocity: [1.5, 0, 0]}, radius: 0.4, height: 1.8}
  tower: {at: [20, 40, 12], radius: 4, height: 24}
drones:
  cam1: {model: x500, home: [0, -30, 0]}
shots:
  - id: round
    kind: keyframes
    drone: cam1
    target: runner
    timing: {start: 12, duration: 15}
    keyframes:
      - {at: {from: target, offset: [-8, 0, 3], turn: course}, look_at: runner}
      - {at: {from: target, offset: [0, -8, 3]}, look_at: runner}
"""


def _beside(number: int, slug: str, summary: str, explanation: str, *changes: tuple[str, str]) -> CodeInfo:
    """Return the code of a keyframe whose position is relative to a target."""
    return slip(f"K{number:03}", slug, summary, explanation, _BESIDE, *changes)


CODES: tuple[CodeInfo, ...] = (
    _code(
        1,
        "times-not-rising",
        "the times of keyframes do not rise",
        "A keyframe's `time` counts from the shot's start, and keyframes are flown in the order in which "
        "they are written. Give each a later time than the one before it, or no time at all.",
        ("look_at: tower, time: 0}", "look_at: tower, time: 15}"),
    ),
    _code(
        2,
        "time-past-end",
        "a keyframe comes, or is held, after its shot has ended",
        "A given duration includes all holds. A keyframe's `time` and its `hold` together stay within it. "
        "Lengthen the shot, or move the keyframe forward.",
        ("hold: 2, time: 15", "hold: 2, time: 39"),
    ),
    _code(
        3,
        "holds-too-long",
        "the holds of a shot are longer than the shot",
        "A given duration includes all holds, and flying takes time too. Lengthen the shot, shorten the "
        "holds, or write `timing: auto`.",
        ("hold: 2, time: 15", "hold: 45"),
        "T001",
    ),
    _code(
        4,
        "impossible-duration",
        "no drone within its limits flies that distance in that time",
        "Even straight from keyframe to keyframe, from rest to rest at full speed and acceleration, the "
        "time does not suffice. The numbers are a lower bound: curves, jerk and turns of the camera take "
        "more. Lengthen the shot, bring the keyframes closer, or raise the limits.",
        ("{start: 20, duration: 40}", "{start: 20, duration: 18}"),
        "T001",
        "T002",
    ),
    _code(
        5,
        "beyond-endurance",
        "a flight is longer than the drone can stay in the air",
        "Shots, holds and waits, and the straight ways between them and home, add up to more than "
        "`endurance`. Shorten or drop shots, or cut the mission in two.",
        ("endurance: 10 min", "endurance: 1 min"),
        "T004",
    ),
    _code(
        6,
        "shots-overlap",
        "two shots of one drone overlap in time",
        "A drone films one shot at a time. With the starts and durations given, one shot begins before the "
        "other can have ended. Start it later, or give it to another drone.",
        ("{start: 100, duration: 10}", "{start: 50, duration: 10}"),
        "T003",
    ),
    _code(
        7,
        "starts-while-waiting",
        "a shot starts before the shot for which it waits has ended",
        "`start` and `after` of the same timing contradict each other. Start it later, or drop one of them.",
        ("{after: above}", "{after: above, start: 105}"),
        "T003",
    ),
    _code(
        8,
        "unreachable-start",
        "a shot starts before the drone can be there",
        "`start` is the time of the first filmed frame, counted from the start of the mission; take-off and "
        "the way there, or the way from the shot before, come first. Start the shot later.",
        ("{start: 20, duration: 40}", "{start: 2, duration: 40}"),
        "T003",
    ),
    _code(
        9,
        "drift-without-duration",
        "a drifting view from above has no duration",
        "A drift is a velocity, so its length depends on its duration. Add `duration` to the shot's timing.",
        ("{start: 100, duration: 10}", "{start: 100}"),
    ),
    _code(
        10,
        "nothing-moves",
        "a moving shot does not move",
        "Both ends of the motion are the same place. Give the moving parameter as [from, to], or use "
        "`kind: static` for a camera that stands still.",
        ("altitude: [5, 30]", "altitude: 30"),
    ),
    _code(
        11,
        "no-speed-left",
        "the wind leaves a drone no speed",
        "A drone's `speed` counts through the air. In a wind that is as fast it cannot even hold its place, wherever "
        "the wind comes from. Wait for less wind, or take a faster drone.",
        ("wind: 1 m/s", "wind: 10 m/s"),
    ),
    _code(
        12,
        "drift-too-fast",
        "a view from above drifts faster than its drone flies",
        "A drift is the mean velocity over the shot, which begins and ends at rest; so it stays somewhat below "
        "the drone's speed, the more so the shorter the shot is. More time does not help where the drift is as "
        "fast as the drone, because the way grows with it. Let it drift more slowly, or take a faster drone.",
        ("drift: [1, 0, 0]", "drift: [12, 0, 0]"),
    ),
    _code(
        13,
        "turns-while-following",
        "a heading asks for a turn that would lose the target on the way",
        "A heading of 360 deg or more says how far the camera turns to get there. Between two keyframes that "
        "frame a target the camera follows the target, and cannot go round once more. Write the heading within "
        "a whole turn, or let the camera turn between keyframes that frame nothing.",
        ("{at: [45, -20, 15], look_at: tower}", "{at: [45, -20, 15], heading: 654 deg, pitch: -4 deg}"),
    ),
    _code(
        14,
        "no-drone-to-choose",
        "no choice of drones films every shot that says `drone: auto` in time",
        "`drone: auto` leaves it to the compiler who films a shot. A drone films one shot at a time, has to get "
        "from one to the next, and has to be home before its endurance ends. Here the drones of the mission are "
        "too few, too slow or too far away. Add a drone, move a shot in time, or bring a home nearer.",
        (
            "{id: above, kind: top-down, drone: cam1, target: tower, altitude: 60, drift: [1, 0, 0],\n"
            "     timing: {start: 100, duration: 10}}",
            "{id: above, kind: top-down, drone: auto, target: tower, altitude: 60, drift: [1, 0, 0],\n"
            "     timing: {start: 50, duration: 10}}",
        ),
    )._replace(phase="plan"),
    _code(
        15,
        "limit-above-model",
        "a limit is far above that of the drone's model",
        "`limits` override the values of the `model`. The figures of a model stay at half of what its "
        "maker publishes, or more; a speed or an acceleration of more than twice as much is most likely a "
        "slip: a number in km/h without its unit, or a digit too many. Correct it, or ignore the warning "
        "if the drone is really so fast. A drone without `model` is your own, so it gets no warning.",
        ("speed: 9 m/s", "speed: 50 m/s"),
    )._replace(severity=Severity.WARNING),
    _code(
        18,
        "beyond-the-lens",
        "a keyframe asks for a field of view that the drone's lens does not have",
        "`camera` says what lens a drone carries: `zoom: [24 mm, 70 mm]`, or the fixed one of a model whose camera is "
        "built in. The `hfov` of a keyframe has to be one of its fields of view: what is framed with another would not "
        "be in the film.",
        ("{at: [45, -20, 15], look_at: tower}", "{at: [45, -20, 15], look_at: tower, hfov: 80 deg}"),
    ),
    _beside(
        16,
        "no-target-to-count-from",
        "a place counts from the target of a shot without a target",
        "`from: target` is the shot's own target. Name another one, as `from: runner`, or give the shot a `target`.",
        ("    target: runner\n", ""),
    ),
    _beside(
        17,
        "no-course",
        "a place turns with the course of a target that stands",
        "With `turn: course` an offset is ahead of a target, to its left and up, by the way that it goes. A target "
        "that stands goes nowhere: leave `turn` out, and the offset is east, north and up.",
        ("from: target, offset", "from: tower, offset"),
    ),
    _code(
        22,
        "lens-not-of-the-model",
        "a drone has a lens that its model's built-in camera does not have",
        "`camera` overrides the values of the `model`. A model with a built-in camera has one field of "
        "view. It most likely carries no lens that zooms or is wider, so the film does not show what is "
        "framed with one. A narrower lens gets no warning, because most of these cameras can crop.",
        (
            "{model: x500, home: [0, -60, 0], limits: {speed: 9 m/s}, endurance: 10 min,\n    camera: {zoom",
            "{model: pro, home: [0, -60, 0], limits: {speed: 9 m/s}, endurance: 10 min,\n    camera: {zoom",
        ),
    )._replace(severity=Severity.WARNING),
    _code(
        21,
        "focus-without-aperture",
        "a shot focuses on a target with a camera whose aperture is not known",
        "`focus` says which target the lens is focused on; what is sharp before it and behind it follows from the aperture, and "
        "the drone's `camera` says none. Write `camera: {aperture: f/2.8}`, or take `focus` out.",
        (
            "    timing: {start: 20, duration: 40}\n",
            "    timing: {start: 20, duration: 40}\n    focus: tower\n",
        ),
    ),
    _beside(
        20,
        "zoom-out-of-time",
        "the lens is too slow for a zoom from one keyframe to the next, in a shot that follows the mission clock",
        "The keyframes of a shot of what moves are reached at their times, so a zoom between them has no longer than that. A "
        "lens takes a zoom no faster than `zoom_rate`, and speeds up and slows down. Zoom less, give it more time, or film with "
        "a faster lens. In a shot of what stands the drone flies as slowly as the lens needs.",
        (
            "{model: x500, home: [0, -30, 0]}",
            "{model: x500, home: [0, -30, 0], camera: {zoom: [24 mm, 70 mm], zoom_rate: 2 deg/s}}",
        ),
        ("offset: [0, -8, 3]}, look_at: runner}\n", "offset: [0, -8, 3]}, look_at: runner, hfov: 34 deg}\n"),
    ),
    _beside(
        19,
        "zoom-of-what-moves",
        "a dolly zoom films a target that moves",
        "A dolly zoom holds the size of a target that stands, while the camera goes to it or away from it. What moves is "
        "held in its size by `kind: framing`, which keeps the distance instead.",
        (
            "offset: [0, -8, 3]}, look_at: runner}\n",
            "offset: [0, -8, 3]}, look_at: runner}\n"
            "  - {id: vertigo, kind: dolly-zoom, drone: cam1, target: runner, azimuth: 180 deg, distance: [40, 20],\n"
            "     altitude: 12, timing: {after: round, duration: 20}}\n",
        ),
    ),
    slip(
        "K023",
        "chosen-for-its-camera",
        "a drone is passed over for a shot that it cannot film as it is asked",
        "`drone: auto` takes the choice of drones with the least work. Here that choice has a drone whose lens, gimbal or "
        "speed cannot film a shot as it is asked, and another drone of the mission can. So the other one films it, and may "
        "come from farther away. Name the drone to confirm the choice.",
        _PASSING,
        ("shots:\n", "  cam2: {model: x500, home: [0, -70, 0], camera: {hfov: 20 deg}}\nshots:\n"),
        ("{id: rise, kind: elevator, drone: cam1", "{id: rise, kind: elevator, drone: auto"),
    )._replace(severity=Severity.WARNING, phase="plan"),
)
