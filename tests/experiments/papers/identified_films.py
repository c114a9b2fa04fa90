"""Films of what was identified: is the building that was meant whole in their frames?

Two keyframes of one building become a shot of the target that was found for them; the frames of its plan are
looked at with the true cylinder of the building, which planning does not know.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from shotc.api import PlanOptions, compile_source
from shotc.geom.bernstein import Array
from shotc.geom.framing import frames
from shotc.geom.shapes import CylinderShape
from shotc.identify.cylinders import Upright
from shotc.ir.sampling import cameras, clock
from shotc.ir.trajectory import VerifiedIR
from tests.support.cities import ASPECT, HFOV_RAD, Building, Drawn

MISSION = """\
shotc: 1
mission: identified
targets: {{{targets}}}
drones:
  cam:
    {{model: x500, home: [{home}], endurance: 60 min, camera: {{hfov: {hfov:.6f} rad, aspect: {aspect:.6f}}}}}
rules: {{max_height: off}}
shots:
  - {{id: s, kind: keyframes, drone: cam, keyframes: [{keyframes}]}}
"""


class Filmed(NamedTuple):
    """A building, the keyframes that mean it, and what was found for each of them."""

    building: Building
    keyframes: tuple[Drawn, ...]
    found: tuple[Upright, ...]


def text(of: Filmed) -> str:
    """Return the mission of a shot through the keyframes, at what was found for them."""
    names = [f"t{of.found.index(found)}" for found in of.found]
    targets = dict(zip(names, of.found, strict=True)).items()
    eyes = [k.camera.eye for k in of.keyframes]
    return MISSION.format(
        targets=", ".join(
            f"{name}: {{at: {_list(t.middle)}, radius: {t.radius:.4f}, height: {t.height:.4f}}}"
            for name, t in targets
        ),
        home=", ".join(f"{c:.3f}" for c in eyes[0][:2]),
        hfov=HFOV_RAD,
        aspect=ASPECT,
        keyframes=", ".join(
            f"{{at: {_list(e)}, look_at: {name}}}" for e, name in zip(eyes, names, strict=True)
        ),
    )


def whole(of: Filmed, refiner: str) -> Array | None:
    """Tell in which frames of the film the true cylinder is whole, (M,); None without a plan."""
    done = compile_source(text(of).encode(), "identified.yaml", None, PlanOptions(refiner=refiner))
    return None if done.plan is None else _whole(done.plan, of.building)


def films(made: Sequence[Filmed], refiner: str = "ours") -> Iterator[Array | None]:
    """Yield that of each film."""
    return (whole(of, refiner) for of in made)


def _whole(plan: VerifiedIR, building: Building) -> Array:
    mission, (track,) = plan.trajectory.keyframes.mission, plan.trajectory.drones
    (shot,) = [phase for phase in track.phases if phase.shot is not None]
    t = clock(mission.rate, track.curve.end)
    t = t[(t >= shot.start) & (t <= shot.end)]
    x, y = building.centre
    true = CylinderShape(building.radius, building.height)
    return np.asarray(frames(cameras(mission, track, t), (x, y, building.height / 2), true).in_frame)


def _list(place: Sequence[float]) -> str:
    return f"[{', '.join(f'{c:.3f}' for c in place)}]"
