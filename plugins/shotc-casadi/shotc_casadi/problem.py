"""The optimal-control problem of one shot: Gebhardt and Hilliges Eq. 12 on the nodes of its path."""

from __future__ import annotations

from dataclasses import replace
from math import inf

import numpy as np
from scipy.interpolate import make_interp_spline

from shotc.plugin_api.refiner import CAM_PITCH, CAM_YAW, Array
from shotc_casadi.conditions import AimCondition
from shotc_casadi.lens import is_free, lens_guess, lens_parameters, lens_state_bounds
from shotc_casadi.margins import Margins
from shotc_casadi.place_times import place_times
from shotc_casadi.program import Problem
from shotc_casadi.references import References, ShotContext, fields_of_view
from shotc_casadi.stages import Stages
from shotc_casadi.symbols import (
    ACCELERATION,
    FIELDS,
    INPUTS,
    JERK,
    LENGTH,
    PITCH,
    PITCH_ACCELERATION,
    PITCH_JERK,
    PITCH_RATE,
    POSITION,
    STATES,
    TIME,
    VELOCITY,
    YAW,
    YAW_ACCELERATION,
    YAW_JERK,
    YAW_RATE,
    size,
)

# Weights of the cost. Every term is a mean over nodes or time and dimensionless: half frames for the picture,
# lengths as shares of the distance to the target, rates as shares of their limits, times as shares of the
# shot's duration. So the weights fit a person from 5 m and a ship from 500 m, every lens, 5 s and 5 min. The
# unit is time: a share of the shot's duration costs that share. The terms with higher priority weigh orders
# of magnitude more: the shape of the flight, the target's place on screen, the whole target in the frame. To
# back off by a share of the distance shrinks the picture by that share. So POSITION_ERROR_WEIGHT over
# VISIBILITY_WEIGHT is the share of a crop that remains until the nodes ask for more.
POSITION_ERROR_WEIGHT = 3e3  # per squared share of the distance to the target
FRAMING_WEIGHT = 3e4  # per squared half frame
VISIBILITY_WEIGHT = 1e6  # per squared half frame
AIMING_WEIGHT = 10.0  # per rad^2: without a framed target, the author's angles are the reference
JERK_SHARE = 1.0  # per squared share of the jerk limit
ANGULAR_JERK_SHARE = 1.0  # per squared share of the jerk that reaches the gimbal's acceleration in a second
PACE_WEIGHT = 0.3  # per squared relative change of a stage's length
LAG_WEIGHT = 1e3  # per squared share of the way to the neighbouring nodes: keeps a node at its progress
PIN_WEIGHT = 1e6  # per squared share of the distance, or half frame: given places and angles
REST_WEIGHT = 1e4  # per squared share of the drone's limits: where the drone rests
TIME_WEIGHT = 1e7  # per squared share of the shot's duration: times that are asked for
GUESS_KNOTS = 50  # of the motion of the initial guess, in addition to the places that bind
SLOWEST_RATIO, FASTEST_RATIO = 5.0, 0.2  # bounds of a stage's length over that of the initial guess


def problem(
    subject: ShotContext,
    condition: AimCondition,
    stages: Stages,
    references: References,
    walls: Array,
    margins: Margins,
) -> Problem:
    """Return the programme of one shot; walls : half-spaces, shape (N + 1, M, 4)."""
    states, inputs = _guess(subject, stages, references, condition)
    parameters = _parameters(subject, stages, references, walls, margins, states)
    wind = _wind(subject, stages, margins)
    bare = Problem(
        visibility=condition.visibility,
        parameters=np.column_stack([parameters, wind]),
        states=states,
        inputs=inputs,
        state_bounds=_state_bounds(subject, len(stages.s), margins),
        input_bounds=_input_bounds(inputs),
        held=_held(subject, walls, margins),
        driven=(np.array([-inf]), np.array([(_pace(subject, margins) * subject.drone.limits.jerk) ** 2])),
        extents=references.extents.shape[1],
        windy=any(subject.drone.limits.wind),
    )
    if not is_free(subject, condition, stages, references):
        return bare
    lens = lens_parameters(subject, stages, POSITION_ERROR_WEIGHT, PIN_WEIGHT, REST_WEIGHT)
    more, moves = lens_guess(subject, stages)
    low, high = lens_state_bounds(subject, stages, _pace(subject, margins))
    free = np.full_like(moves, inf)
    return replace(
        bare,
        parameters=np.column_stack([parameters, lens, wind]),
        states=np.column_stack([states, more]),
        inputs=np.column_stack([inputs, moves]),
        state_bounds=_beside(bare.state_bounds, (low, high)),
        input_bounds=_beside(bare.input_bounds, (-free, free)),
        zooms=True,
    )


def _beside(first: tuple[Array, Array], second: tuple[Array, Array]) -> tuple[Array, Array]:
    """Return bounds with the columns of ``second`` appended."""
    return np.column_stack([first[0], second[0]]), np.column_stack([first[1], second[1]])


def _pace(subject: ShotContext, margins: Margins) -> float:
    return margins.limits * (subject.leg.most if place_times(subject.leg) else subject.leg.pace)


def _guess(
    subject: ShotContext, stages: Stages, references: References, condition: AimCondition
) -> tuple[Array, Array]:
    curve = subject.leg.curve
    assert curve is not None
    q = curve(stages.s)
    angles = q[:, [CAM_YAW, CAM_PITCH]] if condition.aims == "framing" else references.aim
    values = np.column_stack([q[:, :3], angles])
    rest = ([(1, np.zeros(5)), (2, np.zeros(5))],) * 2
    # The number of knots is fixed: a finer guess has sharper jerks, which the solver has to remove.
    few = np.union1d(np.linspace(0, len(stages.s) - 1, GUESS_KNOTS).astype(int), stages.pins)
    motion = make_interp_spline(stages.t[few], values[few], k=5, bc_type=rest)
    x = np.zeros((len(stages.s), STATES))
    rows = [motion(stages.t, order) for order in range(3)]
    for order, (place, yaw, pitch) in enumerate(
        [
            (POSITION, YAW, PITCH),
            (VELOCITY, YAW_RATE, PITCH_RATE),
            (ACCELERATION, YAW_ACCELERATION, PITCH_ACCELERATION),
        ]
    ):
        x[:, place], x[:, yaw], x[:, pitch] = rows[order][:, :3], rows[order][:, 3], rows[order][:, 4]
    x[:, TIME] = stages.t
    u = np.zeros((len(stages.s) - 1, INPUTS))
    u[:, LENGTH] = np.diff(stages.t)
    steps = np.diff(rows[2], axis=0) / u[:, [LENGTH]]
    u[:, JERK], u[:, YAW_JERK], u[:, PITCH_JERK] = steps[:, :3], steps[:, 3], steps[:, 4]
    return x, u


def _parameters(
    subject: ShotContext, stages: Stages, references: References, walls: Array, margins: Margins, guess: Array
) -> Array:
    n, total, drone = len(stages.s) - 1, float(stages.t[-1]), subject.drone
    wide, tall = fields_of_view(subject, stages.s)
    rate = subject.leg.curve.derivative()(stages.s)[:, :3]
    spacing = np.maximum(np.gradient(stages.s), 1e-6)
    pinned, weight = _pinned(subject, stages, references, margins, guess)
    swing = max(drone.gimbal.acceleration, drone.limits.yaw_acceleration)
    each = 1.0 / n
    values = {
        "centre": references.centre,
        "radius": references.radius,
        "height": references.height,
        "place": references.place,
        "half_width": wide,
        "half_height": tall,
        "inside": references.inside,
        "aim": references.aim,
        "state": pinned,
        "state_weight": each * weight,
        "tangent": rate / np.maximum(np.linalg.norm(rate, axis=1), 1e-9)[:, None],
        "lag": each * LAG_WEIGHT / spacing**2,
        "framing": each * FRAMING_WEIGHT * references.framed,
        "visibility": each * VISIBILITY_WEIGHT * references.whole,
        "aiming": each * AIMING_WEIGHT * (1.0 - references.framed),
        "jerk": np.full(n + 1, JERK_SHARE / total / drone.limits.jerk**2),
        "angular_jerk": np.full(n + 1, ANGULAR_JERK_SHARE / total / swing**2),
        "time": np.full(n + 1, 1.0 / total),
        "pace": np.full(n + 1, each * PACE_WEIGHT),
        "nominal": 1.0 / np.append(np.diff(stages.t), 1.0),
    }
    table = [np.asarray(values[name]).reshape(n + 1, width) for name, width in FIELDS.items()]
    extents = references.extents
    whole = np.column_stack([*table, extents.reshape(n + 1, -1), _planes(walls, margins)])
    assert whole.shape[1] == size(walls.shape[1], extents.shape[1])
    return whole


def _wind(subject: ShotContext, stages: Stages, margins: Margins) -> Array:
    """Return the wind parameters, shape (N + 1, 2), or (N + 1, 0) without wind."""
    nodes, wind = len(stages.s), np.array(subject.drone.limits.wind)
    return np.tile(_pace(subject, margins) * wind, (nodes, 1)) if wind.any() else np.zeros((nodes, 0))


def _distance(references: References, reference: Array, stages: Stages) -> Array:
    """Return the distance to the target that lengths are measured by, metres, shape (N + 1,).

    It is the distance at the places that bind, interpolated between them. How near the reference passes
    between them does not matter: that is no reason to hold the camera there. Without a framed target it is a
    fifth of the path.
    """
    pins = stages.pins[references.framed[stages.pins] > 0]
    if not len(pins):
        return np.full(len(stages.s), 0.2 * float(stages.s[-1] - stages.s[0]))
    distances = np.linalg.norm(references.centre[pins] - reference[pins], axis=1)
    return np.asarray(np.interp(stages.s, stages.s[pins], distances))


def _planes(walls: Array, margins: Margins) -> Array:
    """Return half-spaces as parameters, with the added clearance."""
    planes = walls.copy()
    planes[:, :, 3] += margins.clearance * np.linalg.norm(walls[:, :, :3], axis=2)
    return planes.reshape(len(walls), -1)


def _pinned(
    subject: ShotContext, stages: Stages, references: References, margins: Margins, guess: Array
) -> tuple[Array, Array]:
    """Return reference states and their weights: convex path, keyframes, rests, ends, times."""
    value = guess.copy()
    value[:, POSITION] = subject.leg.curve(stages.s)[:, :3]
    distance = _distance(references, value[:, POSITION], stages)
    weight = np.zeros_like(value)
    weight[:, POSITION] = (POSITION_ERROR_WEIGHT / distance**2)[:, None]
    leg, s = subject.leg, stages.s
    half = fields_of_view(subject, s)[1]
    pins = [int(k) for k in stages.pins]
    rests = [stop.s for stop in leg.stops]
    times = dict(zip(*place_times(leg), strict=True))
    shares = _shares(subject)
    for k in pins:
        weight[k, POSITION] = PIN_WEIGHT / distance[k] ** 2
        if k in (pins[0], pins[-1]) or references.framed[k]:
            weight[k, [YAW, PITCH]] = PIN_WEIGHT / half[k] ** 2
        if _among(s[k], rests):
            value[k, shares > 0] = 0.0
            weight[k] += REST_WEIGHT * shares**2
        if s[k] in times:
            value[k, TIME], weight[k, TIME] = times[s[k]], TIME_WEIGHT / float(stages.t[-1]) ** 2
    weight[:, POSITION] *= margins.hold
    return value, weight


def _shares(subject: ShotContext) -> Array:
    """Return one over the limit of every rate and acceleration of the state, 0 for the other entries."""
    limits, shares = subject.drone.limits, np.zeros(STATES)
    shares[VELOCITY], shares[ACCELERATION] = 1.0 / limits.speed, 1.0 / limits.usable_acceleration
    for index, bound in _turning(subject).items():
        shares[index] = 1.0 / bound
    return shares


def _among(s: float, places: list[float]) -> bool:
    return any(abs(s - p) < 1e-9 * max(1.0, abs(s)) for p in places)


def _state_bounds(subject: ShotContext, nodes: int, margins: Margins) -> tuple[Array, Array]:
    limits, gimbal = subject.drone.limits, subject.drone.gimbal
    pace = _pace(subject, margins)
    low, high = np.full((nodes, STATES), -inf), np.full((nodes, STATES), inf)
    low[:, 5], high[:, 5] = -pace * limits.descent, pace * limits.climb
    for index, bound in _turning(subject).items():
        low[:, index], high[:, index] = -pace * bound, pace * bound
    low[:, PITCH], high[:, PITCH] = gimbal.pitch
    return low, high


def _turning(subject: ShotContext) -> dict[int, float]:
    """Return the limits of the camera's rates and accelerations by state index."""
    limits, gimbal = subject.drone.limits, subject.drone.gimbal
    # The camera turns with the body and on its gimbal; with "follow-camera" only the body turns.
    own = 0.0 if subject.drone.body == "follow-camera" else 1.0
    return {
        YAW_RATE: limits.yaw_rate + own * gimbal.rate,
        YAW_ACCELERATION: limits.yaw_acceleration + own * gimbal.acceleration,
        PITCH_RATE: gimbal.rate,
        PITCH_ACCELERATION: gimbal.acceleration,
    }


def _input_bounds(inputs: Array) -> tuple[Array, Array]:
    low, high = np.full_like(inputs, -inf), np.full_like(inputs, inf)
    low[:, LENGTH] = FASTEST_RATIO * inputs[:, LENGTH]
    high[:, LENGTH] = SLOWEST_RATIO * inputs[:, LENGTH]
    return low, high


def _held(subject: ShotContext, walls: Array, margins: Margins) -> tuple[Array, Array]:
    limits = subject.drone.limits
    pace = _pace(subject, margins)
    planes = walls.shape[1]
    low = np.concatenate([[-inf, -inf], np.zeros(planes)])
    high = np.concatenate(
        [[(pace * limits.speed) ** 2, (pace * limits.usable_acceleration) ** 2], np.full(planes, inf)]
    )
    return low, high
