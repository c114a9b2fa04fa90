"""V: faults that verification finds in a finished trajectory. See shotc.diag.registry.

A mission alone shows few of these codes, because the earlier passes plan within the limits. An edited or
damaged plan.json, or a faulty plugin, shows them.
"""

from __future__ import annotations

from shotc.diag.code_info import CodeInfo
from shotc.diag.codes._filmed_shows import STANDING
from shotc.diag.codes._framed import FRAMED
from shotc.diag.codes._held import HELD
from shotc.diag.codes._passed import PASSED
from shotc.diag.codes._shown import SHOWN
from shotc.diag.codes._verified import verified

_MET = """\
shotc: 1
mission: pair
drones:
  one: {model: x500, home: [0, -40, 0]}
  two: {model: x500, home: [12, -40, 0]}
shots:
  - {id: look, kind: static, drone: one, at: [0, -30, 9], heading: 0 deg, pitch: 0 deg,
     timing: {start: 30, duration: 5}}
  - {id: see, kind: static, drone: two, at: [EAST, -30, 9], heading: 0 deg, pitch: 0 deg,
     timing: {start: 30, duration: 5}}
"""

_LIMITS = (
    verified(
        1,
        "too-fast",
        (
            "a speed limit is broken",
            "`speed` binds the horizontal velocity through the air, `climb` and `descent` the vertical one, at every "
            "instant and not only at samples. The diagnostic gives the proven maximum and when it occurs. Give the "
            "shot more time, bring its keyframes nearer, or raise the limit, and plan again.",
        ),
    ),
    verified(
        2,
        "too-hard-acceleration",
        (
            "the acceleration limit is broken",
            "`acceleration` binds the norm of the three-dimensional acceleration at every instant. A shot that is "
            "given k times its duration needs 1/k^2 of the acceleration: the help line computes the duration.",
        ),
    ),
    verified(
        3,
        "too-hard-jerk",
        (
            "the jerk limit is broken",
            "`jerk` binds the norm of the rate of acceleration: what shakes the picture and what the motors have to "
            "follow. A shot that is given k times its duration needs 1/k^3 of the jerk.",
        ),
    ),
    verified(
        53,
        "leans-too-far",
        (
            "the tilt limit is broken",
            "`tilt` binds the angle between the rotors' thrust and the vertical at every instant. The thrust makes "
            "the acceleration and carries the weight; the drag of the air is not counted. A shot that is given more "
            "time leans less.",
        ),
    ),
    verified(
        54,
        "too-much-thrust",
        (
            "the limit of thrust is broken",
            "`thrust_to_weight` binds the rotors' thrust as a multiple of the weight at every instant. The thrust "
            "makes the acceleration and carries the weight; the drag of the air is not counted. A shot that is given "
            "more time needs less.",
        ),
    ),
    verified(
        55,
        "battery-too-small",
        (
            "the flight takes more energy than its battery may give",
            "If the mission's `power`, or the model, gives mass, battery and rotors, the energy from "
            "lift-off to touch-down is proved from the polynomials, and `reserve` is left at landing. "
            "Shorten or drop shots, bring home nearer, or cut the mission in two. `power` tells what the "
            "drone really has.",
        ),
    ),
    verified(
        4,
        "body-turns-too-fast",
        (
            "the body turns faster than its limits allow",
            "`yaw_rate` and `yaw_acceleration` bind the heading of the body, not of the camera. Give the turn more "
            "time, or let the gimbal turn instead with `body: free`.",
        ),
    ),
    verified(
        5,
        "gimbal-out-of-range",
        (
            "the camera points where the gimbal cannot",
            "The gimbal's pitch is measured against the horizon, its yaw against the body. Somewhere along the "
            "flight one of them leaves its range. Fly lower or farther away for a steep pitch, or let the body "
            "follow the camera for a wide yaw.",
        ),
    ),
    verified(
        6,
        "gimbal-too-fast",
        (
            "a gimbal axis turns faster than it can",
            "`gimbal.rate` and `gimbal.acceleration` bind each axis, yaw relative to the body. A pass close to the "
            "target asks for the fastest turns: keep more distance, or give the shot more time.",
        ),
    ),
    verified(
        18,
        "field-of-view-out-of-range",
        (
            "no camera has this field of view",
            "The horizontal field of view must lie between 1 and 170 degrees at every instant of the plan: "
            "outside of that the projection has no meaning. If `camera` describes the lens, the lens must "
            "have the field of view.",
        ),
    ),
    verified(
        60,
        "zooms-too-fast",
        (
            "the lens is to zoom faster than it can",
            "`camera.zoom_rate` binds how fast the field of view changes at every instant. A shot that is given more "
            "time zooms more slowly; keyframes on the clock need more time between them.",
        ),
    ),
)

_SPACE = (
    verified(
        7,
        "zone-entered",
        (
            "the flight enters a keep-out zone",
            "The body sphere of the drone has to stay out of every `keep: out` zone in all phases; in take-off and "
            "landing it may stand as near as its home does. The distance is proved over continuous time, so a "
            "corner cut between two samples is found, too.",
        ),
    ),
    verified(
        8,
        "zone-left",
        (
            "the flight leaves a keep-in zone",
            "The body sphere has to stay inside every `keep: in` zone; only in take-off and landing does the floor "
            "of the zone not apply. The margin is that to the nearest face, counted from the body.",
        ),
    ),
    verified(
        9,
        "too-near-the-ground",
        (
            "the flight comes too near to the ground",
            "Outside of take-off and landing the body has to stay `rules.ground_clearance` above z = 0, counted from "
            "the lowest point of the body sphere.",
        ),
    ),
    verified(
        52,
        "too-near-an-obstacle",
        (
            "the flight comes too near to the scene or to a building",
            "Outside of take-off and landing the body has to stay `rules.obstacle_clearance` away from every triangle "
            "of `world.scene` and `world.buildings`, in all directions; in take-off and landing it may stand as near "
            "as its home does. The distance is proved over continuous time.",
        ),
    ),
    verified(
        47,
        "too-high",
        (
            "the flight is higher above the ground than the mission allows",
            "`rules.max_height` is the greatest height of a drone's centre above the ground, from take-off to landing.",
        ),
    ),
    verified(
        56,
        "looks-aside",
        (
            "a drone does not look where it flies",
            "`rules.look_ahead` is the largest angle between a drone's nose and its course over ground, wherever it is "
            "faster than 0.5 m/s: on ways between shots, in a `follow-path` shot that looks along its path, and in shots "
            "of what stands under whose camera the body can turn. It is proved at every instant. Not judged are other "
            "shots, where the camera says where a drone heads, and the seconds in which it comes into the motion of a "
            "film of what moves and out of it.",
        ),
    ),
    verified(
        10,
        "too-near-a-target",
        (
            "the flight comes too near to a target",
            "Targets are solid cylinders. Outside of take-off and landing the body sphere keeps "
            "`rules.target_clearance` from all of them, filmed or not.",
        ),
    ),
    *PASSED,
    verified(
        22,
        "drones-too-near",
        (
            "two drones come too near to each other",
            "`rules.separation` is kept centre to centre at every instant, also by a drone that has landed and "
            "stands at its home. Give one of the shots another start, or move the homes apart. The drones of a "
            "fleet keep its own `separation`, with its margin: an ellipsoid or a cylinder whose height counts as "
            "much as its width, so that one horizontal distance says how near two drones come. Two fleets keep "
            "the larger of both. Give pictures more room or transitions more time.",
        ),
        (_MET.replace("EAST", "1"), _MET.replace("EAST", "12")),
    ),
)

_FORM = (
    verified(
        11,
        "motion-jumps",
        (
            "position, rate or acceleration jumps at a joint of the trajectory",
            "A plan is a chain of polynomials that agree at their joints in value, first and second "
            "derivative. The rounding errors are added up over all joints of a flight. The sum is at most "
            "a micrometre, a micrometre a second and a tenth of a millimetre a second squared (so many "
            "microradians for angles) in each channel. A plan with a larger sum was edited or damaged. "
            "Plan the mission again.",
        ),
    ),
    verified(
        12,
        "not-at-home",
        (
            "the flight does not begin and end at rest at home",
            "Every flight starts on its pad at time 0 and ends on it: position, rates and accelerations are "
            "checked at both ends. A plan that does not was edited or damaged. Plan the mission again.",
        ),
    ),
    verified(
        13,
        "endurance-exceeded",
        (
            "the whole flight is longer than the drone can stay up",
            "`endurance` counts from take-off to touch-down, with transits, holds and the way home. Shorten shots, "
            "bring home nearer, split the mission, or state a longer endurance if the battery has it.",
        ),
    ),
    verified(
        14,
        "flight-not-whole",
        (
            "the trajectory is not one flight",
            "The phases of a flight follow one another from time 0 to its end, exactly, without a gap and without an "
            "overlap, every shot phase names a shot of the mission, and every flight a drone. No piece of a curve is "
            "shorter than 10 us. A plan where it is not so was edited or damaged.",
        ),
    ),
    verified(
        15,
        "shot-not-as-asked",
        (
            "a shot is missing, or not flown when it was asked",
            "Every shot of the mission is flown exactly once; its duration and start are met to a millisecond, and "
            "it begins no earlier than the end of the shot it comes after. Every picture of a display is shown, in "
            "the order written, as long as it is to be held, and longer only before a picture with `at`. In a wave drones set out within its time, to two pieces "
            "of their splines.",
        ),
    ),
    verified(
        16,
        "keyframe-missed",
        (
            "the flight misses a keyframe that the mission places",
            "A position that the user wrote down binds: the camera is there to a millimetre at the keyframe's time, "
            "at the time the mission fixes, and stands still through the keyframe's hold. The drones of a fleet stand "
            "still while a picture is held.",
        ),
    ),
    verified(
        17,
        "not-vertical-at-home",
        (
            "take-off or landing is not vertical above home",
            "Clearances and the floors of keep-in zones are lifted in take-off and landing, which is safe only "
            "because both are vertical at home. A plan that drifts there was edited or damaged.",
        ),
    ),
)

CODES: tuple[CodeInfo, ...] = tuple(
    sorted((*_LIMITS, *_SPACE, *_FORM, *FRAMED, *HELD, *SHOWN, *STANDING), key=lambda info: info.code)
)
