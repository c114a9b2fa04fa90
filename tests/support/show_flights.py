"""Shows in the sky, made by hand: fleets that rise from a grid, draw shapes by straight moves, and land."""

from __future__ import annotations

import numpy as np
from scipy.optimize import linear_sum_assignment

from shotc.geom.fleet_spline import centres
from shotc.geom.solids import Cylinder, Prism
from shotc.ir.fleet import FleetTrajectory, FrameTimes, Lights
from shotc.ir.keyframes import KeyframeIR
from shotc.ir.limits import Limits, Timing, Vec3
from shotc.ir.mission import GeoOrigin, MissionIR, Zone
from shotc.ir.origin import OriginMap
from shotc.ir.phases import Phase
from shotc.ir.rules import Rules
from shotc.ir.show import Apart, Box, Display, Fleet, Picture, Sphere
from shotc.ir.trajectory import TrajectoryIR, VerifiedIR

CENTRE = (0.0, 60.0, 40.0)
ORANGE, BLUE = (255, 150, 20), (60, 110, 255)
RISE = 10.0
FIELD = Zone(
    "field",
    "in",
    Prism(((-60.0, -30.0), (60.0, -30.0), (60.0, 120.0), (-60.0, 120.0)), 0.0, 90.0),
    ("world", "zones", "field"),
)
MAST = Zone("mast", "out", Cylinder((-40.0, 80.0), 3.0, 0.0, 30.0), ("world", "zones", "mast"))
LEGS = (("pads", 6.0), ("above", 14.0), ("sphere", 10.0), ("cube", 14.0), ("above", 8.0), ("pads", 0.0))
"""Where the fleet stands, and the seconds from there to the next place."""

HOLD = 3.0


def sphere_points(n: int, radius: float) -> np.ndarray:
    """Points all over a sphere, evenly (the Fibonacci lattice)."""
    z = 1.0 - (2.0 * np.arange(n) + 1.0) / n
    turn = np.pi * (3.0 - np.sqrt(5.0)) * np.arange(n)
    ring = np.sqrt(1.0 - z**2)
    return np.array(CENTRE) + radius * np.stack([ring * np.cos(turn), ring * np.sin(turn), z], axis=-1)


def cube_points(n: int, size: float) -> np.ndarray:
    """The sphere's lattice, drawn out to the faces of a cube."""
    out = sphere_points(n, 1.0) - np.array(CENTRE)
    return np.array(CENTRE) + size / 2 * out / np.abs(out).max(axis=1, keepdims=True)


def fleet(n: int, name: str = "swarm", origin: Vec3 = (0.0, 0.0, 0.0)) -> Fleet:
    side = int(np.ceil(np.sqrt(n)))
    pads = tuple(
        (origin[0] + 3.0 * (i % side - side / 2), origin[1] + 3.0 * (i // side), origin[2]) for i in range(n)
    )
    limits = Limits(8.0, 4.0, 3.0, 4.0, 8.0, 1.0, 1.0)
    apart = Apart("ellipsoid", 1.0, 2.0, 0.15)
    return Fleet(name, "show-drone", pads, RISE, limits, 0.3, 900.0, apart, ("fleets", name))


def display(fleet_name: str = "swarm", viewpoint: Vec3 | None = (0.0, -50.0, 2.0)) -> Display:
    path = ("shots", 0)
    pictures = (
        Picture(Sphere(CENTRE, 15.0), "surface", ORANGE, None, HOLD, (*path, "frames", 0)),
        Picture(Box(CENTRE, (24.0, 24.0, 24.0), 0.0), "surface", BLUE, 10.0, HOLD, (*path, "frames", 1)),
    )
    return Display("shapes", fleet_name, pictures, viewpoint, 0.5, Timing(), 0.75, path)


def mission(n: int = 60, **changes: object) -> MissionIR:
    base = MissionIR(
        name="shapes-in-the-sky",
        origin=GeoOrigin(47.3769, 8.5417, 408.0),
        wind=0.0,
        zones=(FIELD, MAST),
        targets=(),
        drones=(),
        rules=Rules(3.0, 2.0, 1.0, obstacle_clearance=2.0),
        shots=(),
        rate=5.0,
        emit=("skyc",),
        source_sha256="5" * 64,
        deferred=(),
        origins=OriginMap("sky.yaml", {}, {}),
        fleets=(fleet(n),),
        displays=(display(),),
    )
    return base._replace(**changes)  # type: ignore[arg-type]


def flight(swarm: Fleet, step: float = 0.5, shot: str = "shapes") -> FleetTrajectory:
    """Straight moves from place to place by one clock; every place is held for HOLD seconds."""
    pads = np.array(swarm.pads)
    n = len(pads)
    where = {"pads": pads, "above": pads + np.array([0.0, 0.0, swarm.rise])}
    for name, points in (("sphere", sphere_points(n, 15.0)), ("cube", cube_points(n, 24.0))):
        before = where["above" if name == "sphere" else "sphere"]
        cost = ((before[:, None] - points[None]) ** 2).sum(axis=-1)
        where[name] = points[linear_sum_assignment(cost)[1]]
    marks, at, t = [0.0], [where["pads"]], 0.0
    arrivals = []
    for i, (name, seconds) in enumerate(LEGS):
        arrivals.append(t)
        t += HOLD
        marks.append(t)
        at.append(where[name])
        if i + 1 < len(LEGS):
            t += seconds
            marks.append(t)
            at.append(where[LEGS[i + 1][0]])
    breaks = np.arange(0.0, t + step / 2, step)
    # Each control point is where the fleet is wanted at its own time, by a smooth common clock.
    times = centres(breaks)
    k = np.clip(np.searchsorted(marks, times, side="right") - 1, 0, len(marks) - 2)
    share = np.clip((times - np.array(marks)[k]) / (np.array(marks)[k + 1] - np.array(marks)[k]), 0.0, 1.0)
    smooth = share**2 * (3.0 - 2.0 * share)
    stack = np.stack(at, axis=1)
    coef = stack[:, k] + smooth[None, :, None] * (stack[:, k + 1] - stack[:, k])
    return FleetTrajectory(
        swarm.name, breaks, coef, _phases(arrivals, shot, t), _shown(arrivals, shot), _lights(n, arrivals)
    )


def _phases(at: list[float], shot: str, end: float) -> tuple[Phase, ...]:
    return (
        Phase("takeoff", None, 0.0, at[1]),
        Phase("transit", None, at[1], at[2]),
        Phase("shot", shot, at[2], at[3] + HOLD),
        Phase("return", None, at[3] + HOLD, at[4]),
        Phase("land", None, at[4], end),
    )


def _shown(at: list[float], shot: str) -> tuple[FrameTimes, ...]:
    return (FrameTimes(shot, 0, 0, at[2], at[2] + HOLD), FrameTimes(shot, 1, 0, at[3], at[3] + HOLD))


def _lights(n: int, at: list[float]) -> Lights:
    times = np.array([at[2] - 2.0, at[2], at[2] + HOLD, at[3], at[3] + HOLD, at[3] + HOLD + 2.0])
    row = np.array([(0, 0, 0), ORANGE, ORANGE, BLUE, BLUE, (0, 0, 0)], dtype=np.uint8)
    return Lights(times, np.repeat(row[None], n, axis=0))


def plan(asked: MissionIR | None = None, step: float = 0.5) -> VerifiedIR:
    """Return a show with an empty certificate."""
    asked = asked or mission()
    flights = tuple(flight(swarm, step) for swarm in asked.fleets)
    return VerifiedIR(TrajectoryIR(KeyframeIR(asked, ()), (), (), (), flights), ())
