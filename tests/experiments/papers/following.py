"""Section V of the *display* paper: fleets led along squares, corners and a walking human, in simulation."""

from __future__ import annotations

from itertools import pairwise
from math import inf

import numpy as np
from matplotlib.figure import Figure

from shotc.geom.apart import stretch
from shotc.geom.bernstein import Array
from shotc.geom.fleet_spline import places
from shotc.geom.separation import closest
from shotc.ir.show import Apart
from shotc.show.geom.centroids import centroids, viewpoint_centroids
from shotc.show.solvers.match import matched
from shotc.simulation.fleets.follow import Gains
from shotc.simulation.fleets.rehearse import FleetConditions
from shotc.simulation.fleets.vehicle import Gusts
from tests.experiments.papers import bodies
from tests.experiments.papers.limited import ACCELERATION, SPEED, Limited, control_points
from tests.experiments.papers.plots import png
from tests.experiments.papers.report import Table
from tests.support.fleet_flights import FlownFleet, fly, nearest

PAPER_APART = Apart("ellipsoid", 0.7, 0.8, 0.0)
"""Two of the paper's drones, of radius 0.35 m and height 0.8 m."""
GUSTS = Gusts(0.3, 1.0)
SIDES = (5.0, 10.0, 15.0)
SWARM = 15
PRINTED = Gains(reach=inf)
LEADING = Gains(forward=0.0), Gains()


def square(side: float, seconds: int = 5) -> Array:
    """Return points a second apart round a square, shape (4 seconds + 1, 3)."""
    corners = side * np.array([[0.0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1], [0, 0, 1]])
    steps = np.arange(seconds)[:, None] / seconds
    return np.concatenate([*(a + steps * (b - a) for a, b in pairwise(corners)), corners[-1:]])


def limited_square(side: float) -> tuple[Array, Array]:
    """Return breaks and control points (P + 3, 3) of a square within the limits."""
    breaks, asked = control_points(square(side))
    return breaks, Limited(breaks).solver()(asked)


def squares_table() -> Table:
    """Return how far one drone is from where it should be, with and without feed-forward, and in gusts."""
    rows = []
    for side in SIDES:
        breaks, coef = limited_square(side)
        flights = [fly(breaks, coef[None], FleetConditions(gains=gains)) for gains in LEADING]
        many = np.repeat(coef[None], 30, axis=0)
        flights.append(fly(breaks, many, FleetConditions(gusts=GUSTS, seed=1)))
        rows.append((f"{side:g} m, {side / 5:g} m/s", *map(_errors, flights)))
    return Table(
        "Following a square: RMSE / largest error, m",
        ("side, speed", "no feed-forward", f"K_ff = {Gains().forward:g} s", "K_ff, gusts"),
        tuple(rows),
        (
            "20 s from rest to rest, drawn within the paper's limits (at 15 m this cuts the corners); "
            "against the place at the same time. The vehicle's velocity lags by 0.3 s and its acceleration "
            f"by 0.15 s, 4 m/s^2 and {SPEED:g} m/s at most; a command every 0.05 s.",
            f"K_at and K_ct are {Gains().along[0]:g} 1/s and {Gains().along[1]:g}, without look-ahead. "
            f"Gusts: 30 drones, a velocity of {GUSTS.deviation:g} m/s (standard deviation of each axis), "
            f"correlated over {GUSTS.memory:g} s.",
            "The paper states none of these; it shows Fig. 6.",
        ),
    )


def _errors(flown: FlownFleet) -> str:
    return f"{flown.rmse:.3f} / {flown.error.max():.2f}"


def moving_sphere(side: float) -> tuple[Array, Array]:
    """Return breaks and control points of the swarm that shows a ball going round a square (Fig. 5)."""
    points = 3.0 * bodies.sphere(6000, 3)
    first = centroids(points, SWARM).goals
    goals = viewpoint_centroids(points, first, np.array([5.0, -100.0, 0.0]), 0.5).goals
    breaks, coef = limited_square(side)
    # All drones have one path, so the limits draw it alike, and the picture is kept.
    return breaks, goals[:, None] + coef[None]


def corners_table() -> Table:
    """Return Fig. 5 and 6: when the velocities dip at the square's corners."""
    rows, drawn = [], None
    for side in (10.0, 15.0):
        breaks, coef = moving_sphere(side)
        gap = closest(breaks, coef, PAPER_APART).proven
        for name, gains in (
            ("K_ff = 0", LEADING[0]),
            ("K_ff", LEADING[1]),
            ("K_ff, look-ahead 0.1 s", Gains(ahead=0.1)),
        ):
            flown = fly(breaks, coef, FleetConditions(gains=gains))
            dips = [
                dip(flown, of) for of in (_speeds(breaks, coef, flown), flown.preferred[0], flown.velocity[0])
            ]
            least = [f"{d[1]:.2f}" for d in dips]
            shift = [f"{d[0] - dips[0][0]:+.2f}" for d in dips[1:]]
            near = nearest(flown.times, flown.position, PAPER_APART, 0.7)
            rows.append((f"{side:g} m, {name}", *least, *shift, f"{gap:.2f}", f"{near.distance:.2f}"))
            if side == 10.0 and gains is LEADING[1]:
                drawn = (breaks, coef, flown)
    assert drawn is not None
    return Table(
        f"{SWARM} drones show a ball that goes round a square (Fig. 5 and 6): how speed dips at a corner",
        ("side", "path's speed, m/s", "preferred", "flown", "preferred dips after path's, s",
         "flown dips after path's, s", "nearest proved, m", "nearest flown, m"),
        tuple(rows),
        (
            "20 s, c = 0.5; means over the three corners, of the first drone. As in Fig. 6, what the "
            "controller prefers dips before the path does.",
            "Nearest in the metric of the paper's drones, 0.7 m across and 0.8 m upright.",
        ),
        _square_drawn(*drawn),
    )  # fmt: skip


def _speeds(breaks: Array, coef: Array, flown: FlownFleet) -> Array:
    return places(breaks, coef[:1], flown.times, 1)[0]


def dip(flown: FlownFleet, velocity: Array) -> tuple[float, float]:
    """Return when the speed is least about a corner, s after the corner's own time, and how little; means."""
    found = []
    for corner in (5.0, 10.0, 15.0):
        # The first of the points repeated at the start stands for -1 s, the point itself for 1 s.
        near = np.abs(flown.times - corner - 1.0) <= 1.5
        speed = np.linalg.norm(velocity[near], axis=1)
        found.append((flown.times[near][np.argmin(speed)] - corner, speed.min()))
    when, least = np.mean(found, axis=0)
    return float(when), float(least)


def _square_drawn(breaks: Array, coef: Array, flown: FlownFleet) -> bytes:
    figure = Figure(figsize=(11, 4.5), layout="tight")
    above, speeds = figure.subplots(1, 2)
    above.plot(*flown.position.mean(axis=0)[:, :2].T, "k-", linewidth=1)
    for at in (1.0, 6.0, 11.0, 16.0):
        k = int(np.argmin(np.abs(flown.times - at)))
        above.plot(*flown.position[:, k, :2].T, "o", label=f"{at:g} s")
    above.set(xlabel="x, m", ylabel="y, m", aspect="equal")
    each = {"path": _speeds(breaks, coef, flown), "preferred": flown.preferred[0], "flown": flown.velocity[0]}
    for name, velocity in each.items():
        speeds.plot(flown.times, np.linalg.norm(velocity, axis=1), label=name)
    speeds.set(xlabel="t, s", ylabel="speed, m/s", ylim=(0, None))
    for axes in (above, speeds):
        axes.legend()
        axes.grid(alpha=0.3)
    return png(figure)


def stranding_table() -> Table:
    """Return the defect of Eq. 12 as printed, and its cure."""
    rows = []
    for degrees in (90, 150, 180):
        for hold in (0, 2):
            breaks, coef = control_points(_turn(degrees, hold))
            cells = []
            for gusts, many in ((Gusts(), 1), (GUSTS, 30)):
                fleet = np.repeat(coef[None], many, axis=0)
                for gains in (PRINTED, Gains()):
                    flown = fly(breaks, fleet, FleetConditions(gains=gains, gusts=gusts, seed=2))
                    cells.append(f"{flown.error.max():.2f}")
            rows.append((f"{degrees} deg, hold {hold} s", *cells))
    return Table(
        "Nearest point on the whole path (Eq. 12 as printed) or near the common time: largest error, m",
        ("turn", "as printed", "cured", "as printed, gusts", "cured, gusts"),
        tuple(rows),
        (
            "12 m out at 2 m/s, a hold, and 12 m away at an angle to the way that was flown; 30 drones in "
            "the gusts.",
            "A drone that waits where the path turns has the incoming way's end for its nearest point: the "
            "common point leaves across that tangent, neither error sees it go, and the drone stands for "
            "good. Where the path comes back, the nearest point of the whole of it may be on the way out.",
            "The cure looks for the nearest point within 0.5 s of the common time only; where the path "
            "stands its tangent is the direction to the common point.",
        ),
    )


def _turn(degrees: float, hold: int) -> Array:
    turn = np.radians(degrees)
    out = np.array([[2.0 * k, 0.0, 5.0] for k in range(7)])
    off = out[-1] + np.array([[2.0 * k * np.cos(turn), 2.0 * k * np.sin(turn), 0.0] for k in range(1, 7)])
    return np.concatenate([out, np.repeat(out[-1:], hold, axis=0), off])


def human_table() -> Table:
    """Return Fig. 7: a human that walks past, in the paper's own way, frame by frame."""
    frames, scale = 25, 6.0
    height = np.array([1.0, 1.0, stretch(PAPER_APART)])
    goals: list[Array] = []
    for k in range(frames):
        points = scale * bodies.human(3000, 7, phase=k / 8) + [0.6 * k, 0.0, 5.0]
        first = centroids(points, SWARM, goals[-1] + [0.6, 0.0, 0.0] if goals else None).goals
        found = viewpoint_centroids(points, first, np.array([0.3 * frames, -100.0, 10.0]), 0.5).goals
        goals.append(found[matched(goals[-1] * height, found * height)] if goals else found)
    asked = np.stack([control_points(each)[1] for each in np.stack(goals, axis=1)])
    breaks = control_points(np.stack(goals)[:, 0])[0]
    solve = Limited(breaks).solver()
    coef = np.stack([solve(each) for each in asked])
    flown = fly(breaks, coef, FleetConditions())
    shift = np.linalg.norm(coef - asked, axis=2).max(axis=1)
    gaps = [closest(breaks, each, PAPER_APART).proven for each in (asked, coef)]
    near = nearest(flown.times, flown.position, PAPER_APART, 0.7)
    return Table(
        f"{SWARM} drones show a walking human (Fig. 7)",
        ("frames", "drones over the limits", "farthest moved, m", "nearest proved, goals", "within limits",
         "nearest flown, m", "RMSE / largest error, m"),
        ((f"{frames}, a second apart", f"{int(np.sum(shift > 0.01))}", f"{shift.max():.2f}",
          *(f"{gap:.2f}" for gap in gaps), f"{near.distance:.2f}", _errors(flown)),),
        (
            f"a human of capsules, {1.8 * scale:.1f} m tall, that goes 0.6 m/s; k-means of every frame "
            "from the goals of the frame before, c = 0.5, least squares from frame to frame, the paper's "
            "programme for each drone by itself.",
            "Neither k-means nor limits of each drone know of the others, who need 0.7 m: the paper "
            "leaves the rest to avoidance while flying. `plan` spaces the goals, and moves paths apart "
            f"until it is proved. Limits: {SPEED:g} m/s, {ACCELERATION:g} m/s^2 along each axis.",
        ),
        _human_drawn(flown),
    )  # fmt: skip


def _human_drawn(flown: FlownFleet) -> bytes:
    figure = Figure(figsize=(11, 5), layout="tight")
    axes = figure.add_subplot()
    for drone in flown.position:
        axes.plot(drone[:, 0], drone[:, 2], "-", color="0.8", linewidth=0.8)
    for at in (0.0, 6.0, 12.0, 18.0, 24.0):
        k = int(np.argmin(np.abs(flown.times - 1.0 - at)))
        axes.plot(flown.position[:, k, 0], flown.position[:, k, 2], "o", label=f"{at:g} s")
    axes.set(xlabel="x, m", ylabel="height, m", aspect="equal")
    axes.legend()
    return png(figure)
