"""Pyrotechnics of a fleet's drones in the language."""

from math import pi
from typing import Annotated, NamedTuple

from pydantic import Field

from shotc.diag.model import Diagnostic
from shotc.ir.show import PyroCue
from shotc.kinds.base import Scene
from shotc.kinds.moments import moment
from shotc.spec.fields import Angle, Duration, NonNegativeDuration, Pitch, PositiveLength
from shotc.spec.fieldtypes import Integer, one_line
from shotc.spec.model import Model
from shotc.spec.music import MomentSpec

MOST_CUES = 500

DroneNumber = Annotated[int, Integer("DroneNumber", 1, 20_000)]
Product = Annotated[str, one_line("Product", 80, "silver fountain 30 s")]


class PyroSpec(Model):
    """One product that one or several drones fire at the same time."""

    at: MomentSpec = Field(description="when it is seen: seconds, `{beat: 32}` or `{bar: 9}`")
    drones: tuple[DroneNumber, ...] = Field(
        min_length=1, max_length=1000, description="numbers of the fleet's drones that carry it, from 1"
    )
    product: Product = Field(description="what it is called on the list of products")
    duration: Duration = Field(description="how long it burns")
    clear: PositiveLength = Field(
        description="how far all else is while it burns: drones, cameras, audience, ground, scene, buildings"
    )
    prefire: NonNegativeDuration = Field(default=0.0, description="from its ignition to when it is seen")
    pan: Angle = Field(default=0.0, description="where it points, clockwise from the nose of the drone")
    tilt: Pitch = Field(default=-pi / 2, description="where it points, up positive; straight down by default")


class Cues(NamedTuple):
    """The cues of a display, and the faults of invalid ones."""

    cues: tuple[PyroCue, ...]
    faults: tuple[Diagnostic, ...]


def cues_of(specs: tuple[PyroSpec, ...], scene: Scene) -> Cues:
    """Return the pyro cues of a display without those of unknown time."""
    cues: list[PyroCue] = []
    faults: list[Diagnostic] = []
    for i, spec in enumerate(specs):
        path = (*scene.path, "pyro", i)
        at = moment(spec.at, scene, (*path, "at"))
        if isinstance(at, Diagnostic):
            faults.append(at)
        elif at is not None:
            cue = PyroCue(
                time=at,
                drones=spec.drones,
                product=spec.product,
                duration=spec.duration,
                clear=spec.clear,
                prefire=spec.prefire,
                pan=spec.pan,
                tilt=spec.tilt,
                path=path,
            )
            cues.append(cue)
    return Cues(tuple(cues), tuple(faults))
