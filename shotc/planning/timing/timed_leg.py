"""One leg over its own time: from its duration, the times of its keyframes, its pace and its smoothing.

``rough_times`` approximates it where planning needs times before a leg is timed.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.ir.drone import Drone
from shotc.ir.path import HoldLeg, MovingLeg, PathLeg
from shotc.planning.timing.deadlines import LegDeadlines, TooFast, has_times
from shotc.planning.timing.grid import rough_profile, without_peaks
from shotc.planning.timing.leg import LegMotion, StopPlan, assemble, fastest_moves, plan_of
from shotc.planning.timing.limits import Ceiling, ceiling_of
from shotc.planning.timing.move import TimedMove, axes_of

LEAST_SPEED_M_S = 1e-3  # m/s along the path, at rest


class LegTiming(NamedTuple):
    """A leg over its own time.

    motion : from time 0; the fastest one where the deadlines are infeasible, so that later legs can be
        checked; None where the leg takes no time
    fast : the fastest moves, where the leg has deadlines
    too_fast : the infeasible deadline, if there is one
    """

    motion: LegMotion | None
    fast: tuple[TimedMove, ...]
    too_fast: TooFast | None


def time_leg(leg: PathLeg, ceiling: Ceiling) -> LegTiming:
    """Return the timing of one leg by its duration, keyframe times, pace and smoothing.

    ceiling : the limits of the drone; deadlines have priority over smoothing
    """
    plan = plan_of(leg)
    if isinstance(leg, HoldLeg):
        return LegTiming(assemble(leg, plan, (), leg.duration), (), None)
    if not has_times(leg):
        moves = fastest_moves(leg, plan, _paced(leg, ceiling) if leg.phase == "shot" else ceiling)
        return LegTiming(assemble(leg, plan, moves, leg.duration), moves, None)
    if leg.most < 1.0:
        return time_leg(replace(leg, most=1.0), ceiling.scaled(leg.most))
    smooth = ceiling.smoothed(leg.smoother)
    if smooth != ceiling and can_be_timed(leg, smooth):
        return time_leg(replace(leg, smoother=1.0), smooth)
    fast = fastest_moves(leg, plan, ceiling)
    timed = _leg_deadlines(leg, plan, fast, ceiling).meet()
    if isinstance(timed, TooFast):
        return LegTiming(assemble(leg, plan, fast, None), fast, timed)
    return LegTiming(assemble(leg, timed.plan, timed.moves, leg.duration), fast, None)


def can_be_timed(leg: MovingLeg, ceiling: Ceiling) -> bool:
    """Return whether a leg's deadlines are feasible below a ceiling."""
    plan = plan_of(leg)
    return _leg_deadlines(leg, plan, fastest_moves(leg, plan, ceiling), ceiling).possible()


def _leg_deadlines(
    leg: MovingLeg, plan: StopPlan, fast: tuple[TimedMove, ...], ceiling: Ceiling
) -> LegDeadlines:
    paced = fast if leg.duration is not None else fastest_moves(leg, plan, _paced(leg, ceiling))
    return LegDeadlines(leg, plan, fast, paced, ceiling)


def _paced(leg: MovingLeg, ceiling: Ceiling) -> Ceiling:
    return ceiling.scaled(leg.pace).smoothed(leg.smoother)


def leg_motion(drone: Drone, leg: PathLeg) -> LegMotion | None:
    """Return a leg with the timing of the time pass, from time 0; None where it takes no time.

    A leg with infeasible deadlines is as fast as possible.
    """
    return time_leg(leg, ceiling_of(drone)).motion


def leg_time(drone: Drone, leg: PathLeg) -> float:
    """Return the duration of ``leg_motion``, seconds."""
    motion = leg_motion(drone, leg)
    return 0.0 if motion is None else motion.duration


def lateness(drone: Drone, leg: PathLeg) -> float:
    """Return the relative lateness of a leg's fastest flight against its deadlines, at least 0.

    In a duration that planning gave, the leg is as smooth as the mission asks for.
    """
    ceiling, plan = ceiling_of(drone), plan_of(leg)
    if isinstance(leg, MovingLeg) and leg.most < 1.0:
        ceiling = ceiling.scaled(leg.most).smoothed(leg.smoother)
    fast = fastest_moves(leg, plan, ceiling)
    return LegDeadlines(leg, plan, fast, fast, ceiling).lateness()


def rough_times(drone: Drone, leg: MovingLeg, pace: float) -> tuple[Array, Array]:
    """Return parameters s and the estimated times t at which a leg without holds passes them; shapes (M,).

    Jerk is limited at the ends only, so the flown duration is slightly longer.

    pace : share of the limits used
    """
    ceiling = ceiling_of(drone).scaled(pace)
    places, times = [np.array([leg.curve.start])], [np.zeros(1)]
    for start, end in plan_of(leg).spans:
        s, b = rough_profile(leg.curve, start, end, axes_of(leg.curve, (start, end), ceiling))
        speed = np.sqrt(without_peaks(b))
        steps = 2 * np.diff(s) / np.maximum(speed[1:] + speed[:-1], LEAST_SPEED_M_S)
        places.append(s[1:])
        times.append(times[-1][-1] + np.cumsum(steps))
    return np.concatenate(places), np.concatenate(times)
