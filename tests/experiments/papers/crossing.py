"""Who keeps a fleet apart: avoidance while flying (the *display* paper) or the plan (ours).

A ball becomes a cube. At random, or by least squares in the metric of the fleet, which needs goals sqrt(2)
times as far apart as drones have to be (``geom.apart``); all go straight by one common share of their way.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from importlib.util import find_spec

import numpy as np

from shotc.geom.apart import straight_spacing, stretch
from shotc.geom.bernstein import Array
from shotc.geom.separation import closest
from shotc.ir.show import Apart
from shotc.show.geom.centroids import centroids
from shotc.show.geom.push_apart import nearest_pair
from shotc.show.solvers.match import matched
from shotc.simulation.fleets.rehearse import PERIOD_S, FleetConditions
from shotc.simulation.fleets.vehicle import FleetVehicle, Gusts
from tests.experiments.papers import bodies
from tests.experiments.papers.limited import ACCELERATION, SPEED
from tests.experiments.papers.report import Table
from tests.support.fleet_flights import FlownFleet, fly, nearest

NEEDED = Apart("ellipsoid", 0.7, 0.8, 0.0)
MARGINS = (0.0, 0.15, 0.45)
PIECES = 12
HOLD = 6
"""Equal control points while the cube stands."""
IDEAL = FleetVehicle(response=0.01, lag=1e-4, acceleration=1e6)
"""Takes up any velocity at once, for which reciprocal avoidance is made."""
ROOM = 0.1
"""By how much avoidance is told to keep apart more than it needs, m."""


@dataclass(frozen=True)
class Case:
    """How a fleet flies; margin : beyond what is needed, of the plan, m."""

    assignment: str
    margin: float
    vehicle: FleetVehicle
    avoids: bool
    gusts: float = 0.0


CASES = (
    Case("random", 0.0, IDEAL, True),
    Case("random", 0.0, FleetVehicle(), False),
    Case("random", 0.0, FleetVehicle(), True),
    Case("least squares", 0.0, FleetVehicle(), False),
    Case("least squares", 0.0, FleetVehicle(), True),
    *(
        Case("least squares", margin, FleetVehicle(), False, gusts)
        for gusts in (0.3, 0.6)
        for margin in MARGINS
    ),
)
FLOWN = {15: CASES[:5], 200: CASES, 1000: (CASES[3], CASES[6])}
"""What is flown with how many drones; avoidance among 1000 takes minutes."""


def table() -> Table:
    """Fly all cases; none with avoidance where its library is not installed."""
    able = find_spec("rvo23d") is not None
    rows = [row(n, case) for n, cases in FLOWN.items() for case in cases if able or not case.avoids]
    return Table(
        "A ball becomes a cube: avoidance while flying, or a plan that is proved",
        ("drones, assignment, margin", "vehicle", "avoidance", "gusts, m/s", "proved of the plan, m",
         "nearest flown, m", f"pairs below {NEEDED.horizontal:g} m", "RMSE / largest error, m", "seconds"),
        tuple(rows),
        (
            f"{NEEDED.horizontal:g} m across and {NEEDED.vertical:g} m upright are needed; all distances "
            f"in that metric. Goals as far apart as the plan needs, moved as fast as {SPEED:g} m/s and "
            f"{ACCELERATION:g} m/s^2 allow.",
            "Ideal: takes any velocity at once. Lagged: the vehicle of the tables above, with its "
            f"controller. Avoidance: ORCA (RVO2-3D) in the stretched metric, told {ROOM:g} m more than is "
            "needed, measured velocities, a command every 0.05 s. The paper's avoidance knows the "
            "vehicle's dynamics and was not available.",
            "Proved: of the planned splines at every instant. A margin of twice the largest error holds "
            "against any gusts; less is often enough, for two seldom stray towards each other at once.",
            "A lagged vehicle that avoids leaves its picture by metres and keeps no distance in a crowd. "
            "On a plan that is proved there is nothing left to avoid.",
        ),
    )  # fmt: skip


def row(n: int, case: Case) -> tuple[str, ...]:
    """Plan, prove, fly and measure one case."""
    breaks, coef = move(n, case)
    planned = closest(breaks, coef, NEEDED).proven
    flown = flight(breaks, coef, case)
    near = nearest(flown.times, flown.position, NEEDED, NEEDED.horizontal)
    return (
        f"{n}, {case.assignment}, {case.margin:g} m",
        "ideal" if case.vehicle is IDEAL else "lagged",
        "ORCA" if case.avoids else "none",
        f"{case.gusts:g}",
        f"{planned:.2f}",
        f"{near.distance:.2f}",
        f"{near.below}",
        f"{flown.rmse:.2f} / {flown.error.max():.2f}",
        f"{breaks[-1]:.0f}",
    )


def flight(breaks: Array, coef: Array, case: Case) -> FlownFleet:
    """Fly a plan as the case says."""
    avoid = None
    if case.avoids:
        # A margin keeps the metric's shape only if it is scaled like the rest.
        room = NEEDED._replace(horizontal=0.7 + ROOM, vertical=(0.7 + ROOM) / stretch(NEEDED))
        from tests.experiments.papers.avoid import Avoidance  # its library has few wheels

        avoid = Avoidance(room, SPEED, PERIOD_S)
    return fly(breaks, coef, FleetConditions(case.vehicle, gusts=Gusts(case.gusts), seed=6), avoid)


def move(n: int, case: Case) -> tuple[Array, Array]:
    """Return breaks and control points (n, P + 3, 3) from the ball to the cube and back."""
    height = np.array([1.0, 1.0, stretch(NEEDED)])
    wide = NEEDED.horizontal + case.margin
    least = straight_spacing(Apart("ellipsoid", wide, wide / stretch(NEEDED), 0.0))
    one, other = (least * _goals(name, n) for name in ("sphere", "cube"))
    order = matched(one, other) if case.assignment != "random" else np.random.default_rng(n).permutation(n)
    starts, ways = one / height, (other[order] - one) / height
    share = np.linspace(0.0, 1.0, PIECES - 3)
    there = share**3 * (10 - 15 * share + 6 * share**2)
    s = np.concatenate([np.zeros(2), there, np.ones(HOLD), there[::-1], np.zeros(2)])
    far = float(np.linalg.norm(ways, axis=1).max())
    piece = max(np.diff(s).max() * far / SPEED, np.sqrt(np.abs(np.diff(s, 2)).max() * far / ACCELERATION))
    return piece * np.arange(len(s) - 2.0), starts[:, None] + s[:, None] * ways[:, None]


@cache
def _goals(name: str, n: int) -> Array:
    """Return n centroids of a body about 0, scaled so that the nearest two are one metre apart."""
    points = (bodies.sphere if name == "sphere" else bodies.cube)(60 * n + 2000, 4)
    goals = centroids(points, n).goals
    return np.asarray(goals / nearest_pair(goals))
