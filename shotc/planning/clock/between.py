"""Clearances of transfers, kept by a shot on its own clock before and after its filmed part."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.pieces import Mask
from shotc.geom.solid_arrays.points import distances
from shotc.geom.taper import TAPER_SLOPE, Taper
from shotc.planning.clock.moving import LinearMotion, Moving, linearised, relative_to, sides
from shotc.planning.free_space import STEEPER_RATIO, HalfSpaces

STEP_S = 0.05  # seconds between samples
STAND_S = 1.0  # seconds that a drone stands at least at each end of the motion
AT_REST_M_S = 1e-4  # m/s

Span = tuple[float, float]
"""Mission times of the first and the last filmed frame, seconds."""


class StandingDrone(NamedTuple):
    """The obstacles' motions while the drone stands, and its position as control points, shape (1, 6, 3)."""

    motions: tuple[LinearMotion, ...]
    stands: Array


class ClearanceShortfall(NamedTuple):
    """Missing clearance, metres: over all stated clearances of transfers, and over all of them."""

    required: float
    any: float


def lacking(motions: Sequence[LinearMotion], course: Piecewise, span: Span) -> ClearanceShortfall:
    """Return how much the parts before and after the film lack of the clearances of transfers."""
    into, out = lacking_each(motions, course, span)
    return ClearanceShortfall(max(into.required, out.required), max(into.any, out.any))


def lacking_each(
    motions: Sequence[LinearMotion], course: Piecewise, span: Span
) -> tuple[ClearanceShortfall, ClearanceShortfall]:
    """Return the lack before the film and the lack after it."""
    into, out = (
        _lack(motions, course, film, times) for film, times in zip(span, _times(course, span), strict=True)
    )
    return into, out


def _lack(
    motions: Sequence[LinearMotion], course: Piecewise, film: float, times: Array
) -> ClearanceShortfall:
    places, worst = course(np.clip(times, course.start, course.end))[:, :3], ClearanceShortfall(0.0, 0.0)
    for motion in motions:
        taper = _taper(motion.what, course, film, TAPER_SLOPE)
        if taper is None:
            continue
        beside = places - motion.what.at(times)
        lack = float((taper.needs(beside) - distances(motion.what.part, beside)).max(initial=0.0))
        worst = ClearanceShortfall(
            max(worst.required, lack if motion.what.required else 0.0), max(worst.any, lack)
        )
    return worst


def sides_apart(motions: Sequence[LinearMotion], course: Piecewise, span: Span) -> HalfSpaces:
    """Return half-spaces for the unfilmed pieces, with the clearances of transfers."""
    half_spaces = sides(widened(motions, course, span), course.ctrl[:, :, :3])
    unfilmed = ~_filmed(course, span)[half_spaces.piece]
    return HalfSpaces(
        half_spaces.piece[unfilmed],
        half_spaces.normal[unfilmed],
        half_spaces.offset[unfilmed],
        half_spaces.owner[unfilmed],
    )


def widened(motions: Sequence[LinearMotion], course: Piecewise, span: Span) -> tuple[LinearMotion, ...]:
    """Return the motions with the clearances of transfers on the unfilmed pieces of a course."""
    filmed = _filmed(course, span)
    before = course.breaks[:-1] < span[0]
    return tuple(_widened(motion, course, span, filmed, before) for motion in motions)


def standing_apart(
    motions: Sequence[LinearMotion], course: Piecewise, span: Span
) -> tuple[StandingDrone, StandingDrone]:
    """Return the obstacles and their clearances while the drone stands at the start and at the end of a
    motion.
    """
    begin, end, (first, last) = float(course.start), float(course.end), stands_at_ends(course)
    pairs = []
    for film, window, place in (
        (span[0], (begin - STAND_S * first, begin), course.ctrl[0, 0, :3]),
        (span[1], (end, end + STAND_S * last), course.ctrl[-1, -1, :3]),
    ):
        stands = np.tile(place, (1, 6, 1))
        linear_motions = (linearised(motion.what, np.array(window)) for motion in motions)
        pairs.append(
            StandingDrone(tuple(_standing(linear, course, film, stands) for linear in linear_motions), stands)
        )
    return pairs[0], pairs[1]


def _standing(motion: LinearMotion, course: Piecewise, film: float, stands: Array) -> LinearMotion:
    taper = _taper(motion.what, course, film, STEEPER_RATIO * TAPER_SLOPE)
    if taper is None:
        return motion
    return replace(motion, wide=np.maximum(taper.needs(relative_to(motion, stands)), motion.what.clearance))


def _widened(motion: LinearMotion, course: Piecewise, span: Span, filmed: Mask, before: Mask) -> LinearMotion:
    """Return a motion with the clearances of transfers.

    filmed, before : which pieces of the course are filmed, and which begin before the film, (P,)
    """
    what, points = motion.what, course.ctrl[:, :, :3]
    relative, wide = relative_to(motion, points), np.full(points.shape[:2], what.clearance)
    for film, which in ((span[0], ~filmed & before), (span[1], ~filmed & ~before)):
        taper = _taper(what, course, film, STEEPER_RATIO * TAPER_SLOPE)
        if taper is not None and which.any():
            wide[which] = np.maximum(taper.needs(relative[which]), what.clearance)
    return replace(motion, wide=wide)


def _taper(what: Moving, course: Piecewise, film: float, slope: float) -> Taper | None:
    """Return the clearance near an end of the film at time ``film``; None where it is not larger than in the
    film.
    """
    if what.apart <= what.clearance:
        return None
    at = np.append(film, course.breaks[[0, -1]][~np.array(stands_at_ends(course))])
    end = course(at)[:, :3] - what.at(at)
    return Taper(what.apart, slope, end, distances(what.part, end))


def stands_at_ends(course: Piecewise) -> tuple[bool, bool]:
    """Return whether the drone is at rest at the start of a course, and at its end.

    Where it is not, it comes from another film, or goes on to one.
    """
    first, last = np.abs(course.derivative()(course.breaks[[0, -1]])[:, :3]).max(axis=1) <= AT_REST_M_S
    return bool(first), bool(last)


def _times(course: Piecewise, span: Span) -> tuple[Array, Array]:
    stands = stands_at_ends(course)
    begin, end = float(course.start) - STAND_S * stands[0], float(course.end) + STAND_S * stands[1]
    return np.append(np.arange(begin, span[0], STEP_S), span[0]), np.append(
        np.arange(span[1], end, STEP_S), end
    )


def _filmed(course: Piecewise, span: Span) -> Mask:
    middle = 0.5 * (course.breaks[:-1] + course.breaks[1:])
    return np.asarray((middle > span[0]) & (middle < span[1]))
