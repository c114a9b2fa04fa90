"""A leg over its own time: as the time pass flies it, or roughly in a moment for those who plan."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.ir.drone import Drone
from shotc.ir.path import HoldLeg, MovingLeg, PathLeg
from shotc.planning.timing.deadlines import DueLeg, TooFast, has_times
from shotc.planning.timing.grid import evened, rough_profile
from shotc.planning.timing.leg import LegMotion, Plan, assemble, fastest_moves, plan_of
from shotc.planning.timing.limits import Ceiling, ceiling_of
from shotc.planning.timing.move import Move, axes_of

LEAST_SPEED_M_S = 1e-3  # m/s along the path, at rest


def rough_times(drone: Drone, leg: MovingLeg, pace: float) -> tuple[Array, Array]:
    """Return parameters s and the seconds t at which a leg without its holds passes them; shapes (M,).

    pace : share of the limits used. No jerk limit but at the ends: the flown time is a little longer.
    """
    ceiling = ceiling_of(drone).scaled(pace)
    places, times = [np.array([leg.curve.start])], [np.zeros(1)]
    for start, end in plan_of(leg).spans:
        s, b = rough_profile(leg.curve, start, end, axes_of(leg.curve, (start, end), ceiling))
        speed = np.sqrt(evened(b))
        steps = 2 * np.diff(s) / np.maximum(speed[1:] + speed[:-1], LEAST_SPEED_M_S)
        places.append(s[1:])
        times.append(times[-1][-1] + np.cumsum(steps))
    return np.concatenate(places), np.concatenate(times)


class LegTiming(NamedTuple):
    """A leg over its own time.

    motion : from time 0; the fastest where the leg asks for less time, so that what follows can be judged;
        None where the leg takes no time
    too_fast : what it asks for and cannot have; fast : its moves as fast as they may be then
    """

    motion: LegMotion | None
    fast: tuple[Move, ...]
    too_fast: TooFast | None


def time_leg(leg: PathLeg, ceiling: Ceiling) -> LegTiming:
    """Time one leg by the length, the keyframe times, the pace and the smoothing that it asks for.

    Times that are asked for go before smoothing.
    """
    plan = plan_of(leg)
    if isinstance(leg, HoldLeg):
        return LegTiming(assemble(leg, plan, (), leg.duration), (), None)
    if not has_times(leg):
        moves = fastest_moves(leg, plan, _paced(leg, ceiling) if leg.phase == "shot" else ceiling)
        return LegTiming(assemble(leg, plan, moves, leg.duration), moves, None)
    smooth = ceiling.smoothed(leg.smoother)
    if smooth != ceiling and can_be_timed(leg, smooth):
        return time_leg(replace(leg, smoother=1.0), smooth)
    fast = fastest_moves(leg, plan, ceiling)
    timed = _due(leg, plan, fast, ceiling).meet()
    if isinstance(timed, TooFast):
        return LegTiming(assemble(leg, plan, fast, None), fast, timed)
    return LegTiming(assemble(leg, timed.plan, timed.moves, leg.duration), fast, None)


def can_be_timed(leg: MovingLeg, ceiling: Ceiling) -> bool:
    """Tell whether a leg can have the times that it asks for below a ceiling."""
    plan = plan_of(leg)
    return _due(leg, plan, fastest_moves(leg, plan, ceiling), ceiling).possible()


def _due(leg: MovingLeg, plan: Plan, fast: tuple[Move, ...], ceiling: Ceiling) -> DueLeg:
    paced = fast if leg.duration is not None else fastest_moves(leg, plan, _paced(leg, ceiling))
    return DueLeg(leg, plan, fast, paced, ceiling)


def _paced(leg: MovingLeg, ceiling: Ceiling) -> Ceiling:
    return ceiling.scaled(leg.pace).smoothed(leg.smoother)


def leg_motion(drone: Drone, leg: PathLeg) -> LegMotion | None:
    """Return a leg as the time pass will fly it, from time 0; what that refuses as fast as it may be.

    None where it takes no time.
    """
    return time_leg(leg, ceiling_of(drone)).motion


def leg_time(drone: Drone, leg: PathLeg) -> float:
    """Return the seconds of ``leg_motion``."""
    motion = leg_motion(drone, leg)
    return 0.0 if motion is None else motion.duration


def lateness(drone: Drone, leg: PathLeg) -> float:
    """Return by which share of a time asked for the fastest flight of a leg misses it, 0 if by none."""
    ceiling, plan = ceiling_of(drone), plan_of(leg)
    fast = fastest_moves(leg, plan, ceiling)
    return DueLeg(leg, plan, fast, fast, ceiling).lateness()
