"""A lens that zooms, as a part of the problem: its reference between keyframes, and its bounds.

Keyframes bind the lens as they bind the position. Between two keyframes with the same lens, the lens stays
unless the picture needs another one. Between two with different lenses, the target's size moves from the
first to the second in the same way as its place on screen, and the lens follows from the size.
"""

from __future__ import annotations

from itertools import pairwise
from math import log

import numpy as np

from shotc.plugin_api.refiner import CAM_PITCH, CAM_YAW, HFOV, Array, Drone
from shotc_casadi.conditions import AimCondition
from shotc_casadi.frames import insides
from shotc_casadi.references import References, ShotContext, keys_of, progress_at
from shotc_casadi.stages import Stages
from shotc_casadi.symbols import LENS_FIELDS, LENS_STATES

# Weights of the cost: dimensionless, as in ``problem``.
ACCELERATION_WEIGHT = 1e-2  # per squared share of the field of view, over the squared time between two pins
SAME_SHARE = 1e-9  # of a field of view: lenses that differ by less are the same
LEAST_SHARE = 2e-3  # of a field of view: a lens that leaves its given one by less keeps that


def is_free(subject: ShotContext, condition: AimCondition, stages: Stages, references: References) -> bool:
    """Return whether the lens of a shot is part of its problem.

    It is, if the lens zooms, the condition frames targets, no keyframe that the compiler added asks for a
    lens, and zooming can help. It can help if keyframes ask for different lenses. It can also help if the
    drone's files zoom, the lens has a wider end, and the convex path shows less than the nodes ask for.
    """
    if condition.aims != "framing" or not subject.drone.zooms:
        return False
    if any(not k.placed and k.asks_for_lens(subject.drone.hfov) for k in subject.placed.keyframes):
        return False
    pose = subject.leg.curve(stages.s)
    if _spread(subject, stages.s)[1].any():
        return True
    assert subject.drone.lens is not None
    widest = pose[:, HFOV].max() >= (1.0 - LEAST_SHARE) * subject.drone.lens.widest
    if widest or condition.visibility == "none" or not subject.drone.zooms_unasked:
        return False
    lacks = insides(subject, references, stages.s, pose[:, [0, 1, 2, CAM_YAW, CAM_PITCH]]) < references.inside
    return bool(lacks[references.whole > 0].any())


def lens_bounds(drone: Drone, given: Array) -> tuple[float, float]:
    """Return the smallest and largest field of view, rad: of the lens and of ``given`` (M,)."""
    assert drone.lens is not None
    return min(drone.lens.longest, float(given.min())), max(drone.lens.widest, float(given.max()))


def lens_guess(subject: ShotContext, stages: Stages) -> tuple[Array, Array]:
    """Return states and inputs of the lens along the convex path, shapes (N + 1, 2) and (N, 1)."""
    given = subject.leg.curve(stages.s)[:, HFOV]
    rate = np.gradient(given, stages.t)
    return np.column_stack([given, rate]), (np.diff(rate) / np.diff(stages.t))[:, None]


def lens_state_bounds(subject: ShotContext, stages: Stages, pace: float) -> tuple[Array, Array]:
    """Return the bounds of the lens states, two of shape (N + 1, 2); pace : share of its rate to use."""
    assert subject.drone.lens is not None
    low, high = lens_bounds(subject.drone, subject.leg.curve(stages.s)[:, HFOV])
    rate = pace * subject.drone.lens.rate
    rows = np.ones((len(stages.s), LENS_STATES))
    return rows * [low, -rate], rows * [high, rate]


def lens_parameters(subject: ShotContext, stages: Stages, off: float, pin: float, still: float) -> Array:
    """Return the LENS_FIELDS of all nodes, shape (N + 1, sum of their sizes).

    off : weight of a squared share of the field of view
    pin : the same where the lens binds
    still : weight of the squared share of the largest rate, where the drone rests
    """
    assert subject.drone.lens is not None
    n, total = len(stages.s) - 1, float(stages.t[-1])
    given = subject.leg.curve(stages.s)[:, HFOV]
    lens, each = np.log(np.tan(given / 2)), 1.0 / n
    spread, sized = _spread(subject, stages.s)
    lens_off, spread_off = each * off * (1.0 - sized), each * off * sized
    lens_off[stages.pins] = each * pin
    rests = np.array([stop.s for stop in subject.leg.stops])
    at_rest = np.isclose(stages.s[:, None], rests, rtol=1e-9, atol=0.0).any(axis=1)
    span = total / max(len(stages.pins) - 1, 1)
    values = {
        "lens": lens,
        "spread": spread,
        "lens_off": lens_off,
        "spread_off": spread_off,
        "lens_still": each * still * at_rest / subject.drone.lens.rate**2,
        "lens_acceleration": ACCELERATION_WEIGHT / total * span**4 / np.sin(given) ** 2,
    }
    return np.column_stack([values[name] for name in LENS_FIELDS])


def _spread(subject: ShotContext, s: Array) -> tuple[Array, Array]:
    """Return log of half the picture's width at the target (metres) and a mask of where it is asked for.

    s : path parameters, shape (N + 1,); both results have this shape
    """
    keys = keys_of(subject)
    at = np.array([key_s for key_s, _ in keys])
    x, i = progress_at(at, s)
    spread, sized = np.zeros(len(s)), np.zeros(len(s))
    poses = subject.leg.curve(at)
    for k, ((_, a), (_, b)) in enumerate(pairwise(keys)):
        apart = abs(a.hfov - b.hfov) > SAME_SHARE * max(a.hfov, b.hfov)
        if not apart or a.target is None or a.target != b.target or None in (a.reference, b.reference):
            continue
        centre = np.array(subject.mission.target(a.target).centre)
        first, second = (
            log(np.linalg.norm(centre - poses[j, :3]) * np.tan(poses[j, HFOV] / 2)) for j in (k, k + 1)
        )
        here = i == k
        spread[here] = first + (second - first) * x[here, 0]
        sized[here] = 1.0
    return spread, sized
