"""A plan made by hand whose shot films two targets at once."""

from __future__ import annotations

import numpy as np

from shotc.geom.bernstein import Piecewise
from shotc.geom.shapes import CylinderShape
from shotc.ir.keyframes import PlacedShot, PlacedSubject
from shotc.ir.limits import Vec2
from shotc.ir.mission import Ideal, Subject
from shotc.ir.phases import Reference
from shotc.ir.trajectory import Claim, VerifiedIR
from shotc.spec.compositions import FRAMES
from tests.support.film_plans import SPEED, TOWER, orbit_plan
from tests.support.records import replace

MAST = replace(TOWER, name="mast", centre=(0.0, 0.0, 25.0), shape=CylinderShape(1.0, 2.0))
PLACES: dict[str, Vec2] = {"tower": (0.0, -1 / 3), "mast": (0.0, 1 / 3)}
FRAME = {"tower": FRAMES["lower-third"], "mast": FRAMES["upper-third"]}


def held(place: Vec2, start: float = 22.0, end: float = 52.0) -> Piecewise:
    return Piecewise(np.array([start, end]), np.tile(np.array(place), (1, 6, 1)))


def claims(target: str, share: float, error: float, size: Vec2) -> tuple[Claim, ...]:
    """What a certificate says of a target in the sample's shot."""
    said = {"in frame": share, "screen error": error, "size smallest": size[0], "size largest": size[1]}
    told = replace(SPEED, shot="half", hard=False, limit=1.0, unit="of samples")
    return tuple(replace(told, constraint=f"{target} {what}", worst=worst) for what, worst in said.items())


def pair_plan() -> VerifiedIR:
    """The sample orbit, filming the tower and a mast on it all along."""
    plan = orbit_plan()
    trajectory = plan.trajectory
    mission, (placed,), (flight,) = (
        replace(trajectory.keyframes.mission, targets=(TOWER, MAST)),
        trajectory.keyframes.shots,
        trajectory.drones,
    )
    written = tuple(Subject(name, FRAME[name], None, None, ()) for name in PLACES)
    subjects = tuple(PlacedSubject(name, place, None, None, ()) for name, place in PLACES.items())
    shot = replace(placed.shot, ideal=Ideal("world", None, ()), subjects=written, keyframes=())
    framing = tuple(Reference("half", name, 22.0, 52.0, held(place)) for name, place in PLACES.items())
    keyframes = replace(
        trajectory.keyframes,
        mission=replace(mission, shots=(shot,)),
        shots=(PlacedShot(shot, (), subjects),),
    )
    drones = (replace(flight, keyframes=(), framing=framing),)
    changed = replace(trajectory, keyframes=keyframes, drones=drones)
    told = (*claims("tower", 1.0, 0.031, (0.6, 0.7)), *claims("mast", 0.75, 0.024, (0.05, 0.06)))
    return VerifiedIR(changed, (*plan.certificate, *told))
