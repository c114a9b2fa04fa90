"""From a solution to a leg: the position between the given ends, and the camera for it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from shotc.plugin_api import Piecewise
from shotc.plugin_api.refiner import (
    BODY_YAW,
    CAM_PITCH,
    CAM_YAW,
    HFOV,
    AngleTask,
    Array,
    Clock,
    ClockLeg,
    quintic_hermite,
    restrict,
    state_at,
    turn,
)
from shotc_casadi.clock.problem import guess
from shotc_casadi.clock.references import ClockSubject
from shotc_casadi.clock.symbols import PLACE_STATES
from shotc_casadi.solving import Solution


def curve_of(subject: ClockSubject, breaks: Array, solution: Solution) -> Piecewise:
    """Return the position of a solution, C2, with exactly the guide's ends.

    The run-up and the run-out absorb the deviation of the solution at both ends.

    breaks : the times of the nodes, shape (N + 1,)
    """
    states = solution.states[:, :PLACE_STATES].copy()
    leg = subject.leg
    rest = guess(leg.curve.channels(0, 1, 2), breaks[[0, -1]])[0]
    for k, edge in ((0, leg.start), (-1, leg.end)):
        off = (rest[k] - states[k]).reshape(3, 1, 3)
        zero = np.zeros((1, 3))
        ends = [np.concatenate([o, zero] if k == 0 else [zero, o]) for o in off]
        over = np.sort(np.array([breaks[k], edge]))
        blend = quintic_hermite(over, ends[0], ends[1], ends[2])
        mine = (breaks >= over[0]) & (breaks <= over[1])
        for order in range(3):
            states[mine, 3 * order : 3 * order + 3] += blend.derivative(order)(breaks[mine])
        states[k] = rest[k]
    return quintic_hermite(breaks, states[:, :3], states[:, 3:6], states[:, 6:])


def filmed(subject: ClockSubject, position: Piecewise, camera: Piecewise | None = None) -> ClockLeg | None:
    """Return the leg with a new position and the camera for it, or None if there is no camera.

    camera : yaw and pitch over mission time, if they are known already; the body yaw follows
    """
    leg, angles = subject.leg, [CAM_YAW, CAM_PITCH, BODY_YAW]
    begin, end = (state_at(leg.curve, t)[:, angles] for t in (leg.curve.start, leg.curve.end))
    clock = Clock(leg.curve.breaks, leg.start, leg.end)
    turned = turn(AngleTask(subject.camera_task, subject.aim, begin, end, camera), clock, position)
    if turned.curve is None:
        return None
    breaks = position.breaks
    lens = leg.curve.channels(HFOV) if subject.lens is None else subject.lens
    parts = [position, restrict(turned.curve, breaks), restrict(lens, breaks)]
    ctrl = np.concatenate([part.ctrl for part in parts], axis=2)
    ctrl[0, 0], ctrl[-1, -1] = leg.curve.ctrl[0, 0], leg.curve.ctrl[-1, -1]
    return replace(leg, curve=Piecewise(breaks, ctrl))
