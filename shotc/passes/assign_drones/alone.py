"""One shot of a mission by itself, flown by one drone: where it is, and why the drone cannot film it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from shotc.diag.model import Diagnostic, Severity
from shotc.diag.registry import severity_of
from shotc.ir.mission import MissionIR
from shotc.ir.passes import PassContext
from shotc.kinds.base import Kind
from shotc.passes.place_keyframes import PlaceKeyframes
from shotc.passes.resolve import Resolve
from shotc.spec.load import LoadedMission


class ShotAlone(NamedTuple):
    """A shot by itself.

    mission : with this shot alone; None where it is invalid with this drone
    fault : the first error of the shot with this drone, None where the drone can film it as it is asked
    """

    mission: MissionIR | None
    fault: Diagnostic | None


def alone(ir: LoadedMission, kinds: Mapping[str, Kind], number: int, drone: str) -> ShotAlone:
    """Return one shot by itself, flown by a drone.

    The lens, the gimbal and the limits of the drone decide whether the shot resolves and whether its pictures
    can be placed. Obstacles that take long to read, scenes and buildings, are left out.
    """
    written = ir.spec.shots[number]
    timing = written.timing.model_copy(update={"after": None})
    shots = (written.model_copy(update={"drone": drone, "timing": timing}),)
    world = ir.spec.world.model_copy(update={"scene": None, "buildings": None})
    one = ir._replace(spec=ir.spec.model_copy(update={"shots": shots, "world": world}))
    resolved = Resolve(kinds).run(one, PassContext())
    mission = resolved.value
    if mission is None or not mission.shots:
        return ShotAlone(None, _error(resolved.diagnostics))
    return ShotAlone(mission, _error(PlaceKeyframes().run(mission, PassContext()).diagnostics))


def _error(diagnostics: tuple[Diagnostic, ...]) -> Diagnostic | None:
    return next((d for d in diagnostics if severity_of(d) is Severity.ERROR), None)
