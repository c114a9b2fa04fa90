"""A sound plan, and ways to tamper with it or with the mission it is held to."""

from collections.abc import Callable

import numpy as np

from shotc.geom.bernstein import Piecewise
from shotc.ir.mission import MissionIR, Zone
from shotc.ir.trajectory import TrajectoryIR
from tests.support.film_plans import orbit_plan
from tests.support.records import replace

PLAN = orbit_plan().trajectory
MISSION = PLAN.keyframes.mission


def with_track(ir: TrajectoryIR = PLAN, **changes: object) -> TrajectoryIR:
    return replace(ir, drones=(replace(ir.drones[0], **changes),))


def with_ctrl(edit: Callable[[np.ndarray], None]) -> TrajectoryIR:
    curve = PLAN.drones[0].curve
    ctrl = curve.ctrl.copy()
    edit(ctrl)
    return with_track(curve=Piecewise(curve.breaks, ctrl))


def with_mission(ir: TrajectoryIR = PLAN, **changes: object) -> TrajectoryIR:
    mission: MissionIR = replace(ir.keyframes.mission, **changes)
    shots = tuple(
        replace(p, shot=next(s for s in mission.shots if s.id == p.shot.id)) for p in ir.keyframes.shots
    )
    return replace(ir, keyframes=replace(ir.keyframes, mission=mission, shots=shots))


def with_drone(**changes: object) -> TrajectoryIR:
    return with_mission(drones=(replace(MISSION.drones[0], **changes),))


def with_limits(**changes: float) -> TrajectoryIR:
    return with_drone(limits=replace(MISSION.drones[0].limits, **changes))


def with_gimbal(**changes: object) -> TrajectoryIR:
    return with_drone(gimbal=replace(MISSION.drones[0].gimbal, **changes))


def with_shot(**changes: object) -> TrajectoryIR:
    return with_mission(shots=(replace(MISSION.shots[0], **changes),))


def with_keyframe(index: int, **changes: object) -> TrajectoryIR:
    placed = PLAN.keyframes.shots[0]
    keyframes = list(placed.keyframes)
    keyframes[index] = replace(keyframes[index], **changes)
    return replace(
        PLAN, keyframes=replace(PLAN.keyframes, shots=(replace(placed, keyframes=tuple(keyframes)),))
    )


def with_phase(index: int, **changes: object) -> TrajectoryIR:
    phases = list(PLAN.drones[0].phases)
    phases[index] = replace(phases[index], **changes)
    return with_track(phases=tuple(phases))


def zone(keep: str, solid: object) -> tuple[Zone, ...]:
    return (*MISSION.zones, Zone("extra", keep, solid, ("world", "zones", "extra")))  # type: ignore[arg-type]


def shifted(channel: int, by: float) -> TrajectoryIR:
    return with_ctrl(lambda c: c.__setitem__((..., channel), c[..., channel] + by))
