"""Missions with displays, made by hand as the language would make them."""

from __future__ import annotations

from math import inf

from shotc.ir.keyframes import KeyframeIR
from shotc.ir.limits import Limits, Timing, Vec3
from shotc.ir.mission import MissionIR, Zone
from shotc.ir.origin import OriginMap
from shotc.ir.rules import Rules
from shotc.ir.show import Apart, Display, Fleet, Picture, Source

LIMITS = Limits(6.0, 3.0, 2.0, 2.5, 8.0, 1.0, 2.0)
APART = Apart("ellipsoid", 1.0, 2.0, 0.15)


def fleet(count: int, apart: Apart = APART, name: str = "swarm") -> Fleet:
    pads = tuple((4.0 * (k % 20), 4.0 * (k // 20), 0.0) for k in range(count))
    return Fleet(name, "show-drone", pads, 10.0, LIMITS, 0.3, 900.0, apart, ("fleets", name))


def picture(source: Source, fill: str = "volume", index: int = 0, color=None) -> Picture:
    return Picture(source, fill, color, None, 4.0, ("shots", 0, "frames", index))  # type: ignore[arg-type]


def display(*pictures: Picture, viewpoint: Vec3 | None = None, weight: float = inf) -> Display:
    return Display("show", "swarm", pictures, viewpoint, weight, Timing(), 0.75, ("shots", 0))


def show(
    drawn: Display, swarm: Fleet, zones: tuple[Zone, ...] = (), files: dict[str, bytes] | None = None
) -> KeyframeIR:
    mission = MissionIR(
        name="show",
        origin=None,
        wind=0.0,
        zones=zones,
        targets=(),
        drones=(),
        rules=Rules(1.0, 2.0, 1.0),
        shots=(),
        rate=5.0,
        emit=(),
        source_sha256="",
        deferred=(),
        origins=OriginMap("show.yaml", {}, {}),
        fleets=(swarm,),
        displays=(drawn,),
        files=tuple((files or {}).items()),
    )
    return KeyframeIR(mission, ())
