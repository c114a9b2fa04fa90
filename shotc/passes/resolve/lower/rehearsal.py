"""Wind and rehearsals of a mission."""

from math import pi

from shotc.geom.camera import yaw_of
from shotc.ir.rehearsal import Rehearsal, RehearsalPromise, Wind
from shotc.spec.rehearse import RehearseSpec, WindSpec


def toward(wind: WindSpec) -> float | None:
    """Return the yaw towards which the wind blows, rad, opposite to where it comes from."""
    return None if wind.from_ is None else yaw_of(wind.from_ + pi)


def rehearsal(written: RehearseSpec | None) -> Rehearsal | None:
    """Return the rehearsal that a mission asks for, or None."""
    if written is None:
        return None
    requirements = written.require
    return Rehearsal(
        promise=RehearsalPromise(
            requirements.in_frame,
            requirements.in_sight,
            requirements.mean_error,
            requirements.clearance,
            requirements.stray,
            requirements.of,
        ),
        path=("rehearse",),
        runs=written.runs,
        loop=written.loop,
        wind=None if written.wind is None else Wind(written.wind.speed, toward(written.wind)),
        gusts=written.gusts,
        gps=written.gps,
        wander=written.wander,
    )
