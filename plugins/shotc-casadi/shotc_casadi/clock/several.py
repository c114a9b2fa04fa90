"""Several subjects in one picture, in numbers: the references of each, and the camera's states."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from shotc.plugin_api import MissionIR, Piecewise, Target
from shotc.plugin_api.refiner import (
    CAM_PITCH,
    CAM_YAW,
    Array,
    Asked,
    Drone,
    PlacedSubject,
    TargetShape,
    View,
    quintic_hermite,
    shapes,
    viewpoint,
)
from shotc_casadi.clock.picture import FIELDS, SUBJECT, width
from shotc_casadi.clock.symbols import PITCH, PLACE_STATES, YAW
from shotc_casadi.extents import count_of, extents_of

WHOLE = sum(FIELDS[name] for name in tuple(FIELDS)[: tuple(FIELDS).index("whole")])
FARTHEST_M = 1e6  # stands for an unlimited distance, metres


def pictured(
    mission: MissionIR, subjects: Sequence[PlacedSubject], centres: Array, t: Array, start: float
) -> Array:
    """Return the parameters of subjects in a picture at times (M,), shape (M, J, picture.width).

    What is free has a faint weight, as in ``viewpoint`` for the ideal.

    centres : of the subjects, W, metres, (M, J, 3)
    t : mission time, seconds
    start : mission time of the first frame
    """
    sized = any(s.size is not None for s in subjects)
    targets = [mission.target(s.target) for s in subjects]
    extents = count_of([target.shape for target in targets])
    rows = np.zeros((len(centres), len(subjects), width(extents)))
    rows[:, :, :3] = centres
    for j, (subject, target) in enumerate(zip(subjects, targets, strict=True)):
        if subject.setpoints:
            rows[:, j, 3:SUBJECT] = [_parameters(target, subject.asked(float(u) - start), sized) for u in t]
        else:
            rows[:, j, 3:SUBJECT] = _parameters(target, subject.asked(0.0), sized)
        rows[:, j, SUBJECT:] = extents_of(shapes(target, t), extents, len(t)).reshape(len(t), -1)
    return rows


def _parameters(target: Target, subject: Asked, sized: bool) -> list[float]:
    """Return all parameters of a subject except its centre, in the order of picture.FIELDS."""
    azimuth, elevation = subject.view or (None, None)
    both = azimuth is not None and elevation is not None
    toward = viewpoint.direction(azimuth or 0.0, (elevation or 0.0) if both else 0.0)
    silent = 0.0 if sized else viewpoint.FAINT_WEIGHT
    return [
        target.radius,
        target.height,
        *(subject.place or (0.0, 0.0)),
        viewpoint.WHOLE_SIZE if subject.size is None else subject.size,
        *toward,
        elevation or 0.0,
        viewpoint.FAINT_WEIGHT if subject.place is None else 1.0,
        silent if subject.size is None else 1.0,
        viewpoint.HARD_WEIGHT if subject.size is None or subject.size <= 1.0 else 0.0,
        float(both),
        float(azimuth is not None and not both),
        float(elevation is not None and not both),
        viewpoint.FAINT_WEIGHT if elevation is None else 0.0,
    ]


def where_it_fits(rows: Array, shape: TargetShape, drone: Drone, goes: tuple[Array, Array]) -> Array:
    """Return the parameters of one subject; it has to be whole only where that is possible.

    It is possible if the subject fits into the picture when the camera backs off as far as it may.

    rows : as from ``pictured``, (M, 1, picture.width)
    shape : at these times
    goes : camera positions, W, metres, (M, 3), and how far the camera may back off, metres, (M,)
    """
    ideal, reach = goes
    offset = rows[:, 0, :3] - ideal
    offset *= 1.0 + (np.minimum(reach, FARTHEST_M) / np.linalg.norm(offset, axis=1))[:, None]
    yaw, pitch = np.arctan2(offset[:, 1], offset[:, 0]), np.arctan2(offset[:, 2], np.hypot(*offset.T[:2]))
    half = np.tan(drone.hfov / 2)
    camera = View(np.cos(yaw), np.sin(yaw), np.cos(pitch), np.sin(pitch), half, half / drone.aspect)
    there = (offset[:, 0], offset[:, 1], offset[:, 2])
    left, right, low, high = shape.bounds(camera, there)
    fits = np.maximum(right - left, high - low) <= 2.0 * viewpoint.EDGE_SHARE
    fitting = rows.copy()
    fitting[:, 0, WHOLE] *= fits & (np.linalg.norm(offset, axis=1) > np.hypot(shape.radius, shape.height / 2))
    return fitting


def angles(curve: Piecewise, breaks: Array) -> Array:
    """Return a leg's camera yaw and pitch, each with rate and acceleration, shape (N + 1, 6)."""
    orders = [curve, curve.derivative(1), curve.derivative(2)]
    return np.column_stack([order(breaks)[:, c] for c in (CAM_YAW, CAM_PITCH) for order in orders])


def turned(breaks: Array, states: Array) -> Piecewise:
    """Return camera yaw and pitch of a solution as a curve.

    breaks : shape (N + 1,); states : as in ``ClockProblem``, shape (N + 1, sizes.states)
    """
    value, rate, acceleration = (states[:, [YAW + k, PITCH + k]] for k in range(3))
    return quintic_hermite(breaks, value, rate, acceleration)


def turning_room(drone: Drone, share: float) -> tuple[Array, Array]:
    """Return lower and upper bounds of the camera's angles, rates and accelerations, shape (6,) each.

    A free body adds its turning to that of the gimbal.

    share : of the rates and accelerations that is used
    """
    gimbal, limits = drone.gimbal, drone.limits
    fixed = drone.body == "follow-camera"
    rate = limits.yaw_rate + (0.0 if fixed else gimbal.rate)
    acceleration = limits.yaw_acceleration + (0.0 if fixed else gimbal.acceleration)
    high = share * np.array([np.inf, rate, acceleration, 0.0, gimbal.rate, gimbal.acceleration])
    low = -high
    low[PITCH - PLACE_STATES], high[PITCH - PLACE_STATES] = gimbal.pitch
    return low, high
