"""A show made by hand: a few drones that rise, draw two pictures, and land, with values known by hand."""

from __future__ import annotations

import numpy as np

from shotc.ir.fleet import FleetTrajectory, FrameTimes, Lights
from shotc.ir.keyframes import KeyframeIR
from shotc.ir.limits import Limits, Timing
from shotc.ir.mission import GeoOrigin, MissionIR
from shotc.ir.origin import OriginMap
from shotc.ir.passes import PassContext
from shotc.ir.phases import Phase
from shotc.ir.rules import Rules
from shotc.ir.show import Apart, Display, Fleet, Picture, Sphere, Torus
from shotc.ir.trajectory import TrajectoryIR, VerifiedIR
from tests.support.verdicts import verdict_on

CONTEXT = PassContext()
STEP = 2.0
"""Seconds of every piece."""

RISE, HIGH = 10.0, 30.0
PADS = tuple((4.0 * i, 0.0, 0.0) for i in range(4))
PATH = ("fleets", "swarm")


def fleet(pads: tuple[tuple[float, float, float], ...] = PADS, name: str = "swarm") -> Fleet:
    return Fleet(
        name=name,
        model="show-drone",
        pads=pads,
        rise=RISE,
        limits=Limits(8.0, 6.0, 5.0, 4.0, 8.0, 1.0, 1.0),
        radius=0.3,
        endurance=900.0,
        apart=Apart("ellipsoid", 1.0, 2.0, 0.15),
        path=("fleets", name),
    )


def display(name: str = "globe", of: str = "swarm", index: int = 0) -> Display:
    path = ("shots", index)
    pictures = (
        Picture(Sphere((6.0, 20.0, HIGH), 8.0), "surface", None, None, 4.0, (*path, "frames", 0)),
        Picture(
            Torus((6.0, 20.0, HIGH + 2.0), 5.0, 1.0, 0.0, 0.5),
            "volume",
            (255, 128, 0),
            6.0,
            2.0,
            (*path, "frames", 1),
        ),
    )
    return Display(name, of, pictures, (0.0, -80.0, 2.0), float("inf"), Timing(), 0.75, path)


def mission(**changes: object) -> MissionIR:
    base = MissionIR(
        name="show",
        origin=GeoOrigin(47.0, 8.0, 400.0),
        wind=0.0,
        zones=(),
        targets=(),
        drones=(),
        rules=Rules(3.0, 2.0, 1.0, obstacle_clearance=2.0),
        shots=(),
        rate=5.0,
        emit=("csv",),
        source_sha256="0" * 64,
        deferred=(),
        origins=OriginMap("show.yaml", {}, {}),
        fleets=(fleet(),),
        displays=(display(),),
    )
    return base._replace(**changes)  # type: ignore[arg-type]


def flight(fleet: Fleet, shot: str = "globe") -> FleetTrajectory:
    """Rise, go north and up to the first picture, two metres up to the second, and back.

    23 pieces of two seconds. Where m control points are equal the drones stand for m - 3 pieces.
    """
    pads = np.array(fleet.pads)
    above, first = pads + np.array([0.0, 0.0, RISE]), pads + np.array([0.0, 20.0, HIGH])
    second = first + np.array([0.0, 0.0, 2.0])
    legs = [(pads, 3), (above, 4), ((above + first) / 2, 1), (first, 5), (second, 4)]
    legs += [((above + second) / 2, 2), (above, 4), (pads, 3)]
    coef = np.stack([point for point, count in legs for _ in range(count)], axis=1)
    breaks = STEP * np.arange(coef.shape[1] - 2)
    return FleetTrajectory(fleet.name, breaks, coef, _phases(shot), _shown(shot), _lights(len(pads)))


def _phases(shot: str) -> tuple[Phase, ...]:
    # Piece k has control points k to k + 3. Points 3 to 6 are above the pads, 8 to 12 and 13 to 16 pictures,
    # 19 to 22 above the pads again.
    return (
        Phase("takeoff", None, 0.0, 8.0),
        Phase("transit", None, 8.0, 16.0),
        Phase("shot", shot, 16.0, 28.0),
        Phase("return", None, 28.0, 38.0),
        Phase("land", None, 38.0, 46.0),
    )


def _shown(shot: str) -> tuple[FrameTimes, ...]:
    return (FrameTimes(shot, 0, 0, 16.0, 20.0), FrameTimes(shot, 1, 0, 26.0, 28.0))


def _lights(n: int) -> Lights:
    """Dark until the end of the take-off and from the landing on."""
    colors = np.zeros((n, 6, 3), dtype=np.uint8)
    colors[:, 1:3] = (255, 255, 255)
    colors[:, 3:5] = (255, 128, 0)
    return Lights(np.array([8.0, 16.0, 20.0, 26.0, 28.0, 38.0]), colors)


def show(asked: MissionIR | None = None) -> TrajectoryIR:
    asked = asked or mission()
    flights = tuple(
        flight(one, display.id) for one, display in zip(asked.fleets, asked.displays, strict=True)
    )
    return TrajectoryIR(KeyframeIR(asked, ()), (), (), (("seconds", 0.5),), flights)


def plan(asked: MissionIR | None = None) -> VerifiedIR:
    """Return the show with its own certificate; what it breaks is for the test to know."""
    ir = show(asked)
    return VerifiedIR(ir, verdict_on(ir).certificate)
