"""Short flights made by hand: up, a filmed move, and back down, for one drone or several on one clock."""

from __future__ import annotations

from math import pi, radians

import numpy as np

from shotc.geom.bernstein import Piecewise, concatenate, quintic_hermite
from shotc.ir.keyframes import KeyframeIR
from shotc.ir.path import HFOV
from shotc.ir.phases import Phase, Reference
from shotc.ir.trajectory import DroneTrajectory, TrajectoryIR, VerifiedIR
from tests.support.film_plans import SPEED, orbit_mission
from tests.support.records import replace


def hop_plan(*names, autopilot="px4", waits=0.0, pans=False):
    """Drones side by side; each sets out ``waits`` seconds after the one before, and may pan."""
    names = names or ("cam1",)
    mission = orbit_mission()
    (drone,), (shot,) = mission.drones, mission.shots
    drones, shots, tracks = [], [], []
    for index, name in enumerate(names):
        home = (12.0 * index, -60.0, 0.0)
        drones.append(drone._replace(name=name, home=home, autopilot=autopilot))
        shots.append(shot._replace(id=f"by-{name}", drone=name))
        tracks.append(_track(name, home, index * waits, pans=pans))
    mission = mission._replace(drones=tuple(drones), shots=tuple(shots))
    return VerifiedIR(TrajectoryIR(KeyframeIR(mission, ()), tuple(tracks), (), ()), (SPEED,))


def _track(name, home, wait, *, pans):
    pad = np.array([*home, pi / 2, 0.0, pi / 2, radians(70)])
    above = pad + np.array([0, 0, 6.0, 0, -0.2, 0, 0])
    far = above + np.array([3.0, 10.0, 2.0, 0.5, -0.1, 0.0 if pans else 0.5, 0])
    legs = [(0.0, 6.0, pad, above), (6.0, 16.0, above, far), (16.0, 18.0, far, far)]
    legs += [(18.0, 22.0, far, _above(pad, far)), (22.0, 30.0, _above(pad, far), _on(pad, far))]
    curves = [_move(a + wait, b + wait, p, q) for a, b, p, q in legs]
    if wait:
        curves.insert(0, _move(0.0, wait, pad, pad))
    cuts = [0.0, 6.0 + wait, 16.0 + wait, 22.0 + wait, 30.0 + wait]
    kinds = [("takeoff", None), ("shot", f"by-{name}"), ("return", None), ("land", None)]
    phases = tuple(Phase(k, s, a, b) for (k, s), a, b in zip(kinds, cuts[:-1], cuts[1:], strict=True))
    framed = (Reference(f"by-{name}", "tower", 6.0 + wait, 16.0 + wait, None),)
    return DroneTrajectory(name, concatenate(curves), phases, (), framed)


def brief_plan():
    """One drone that rises 3 m in 2 s, films for 1 s, and comes down in 3 s: for flights in real time."""
    plan = hop_plan()
    pad = np.array([0.0, -60.0, 0.0, pi / 2, 0.0, pi / 2, radians(70)])
    above = pad + np.array([0, 0, 3.0, 0, -0.2, 0, 0])
    curve = concatenate(
        [_move(0.0, 2.0, pad, above), _move(2.0, 3.0, above, above), _move(3.0, 6.0, above, pad)]
    )
    cuts = [("takeoff", None, 0.0, 2.0), ("shot", "by-cam1", 2.0, 3.0), ("land", None, 3.0, 6.0)]
    track = DroneTrajectory("cam1", curve, tuple(Phase(*cut) for cut in cuts), (), ())
    return VerifiedIR(replace(plan.trajectory, drones=(track,)), plan.certificate)


def _above(pad, far):
    return np.array([*pad[:2], 5.0, far[3], far[4], far[5], far[6]])


def _on(pad, far):
    return np.array([*pad[:3], far[3], far[4], far[5], far[6]])


def _move(start, end, a, b):
    zero = np.zeros((2, 7))
    return quintic_hermite(np.array([start, end]), np.stack([a, b]), zero, zero)


def without_origin(plan):
    """The same plan without a place on the globe."""
    return _of_mission(plan, plan.trajectory.keyframes.mission._replace(origin=None))


def with_target(plan, name):
    """The same plan with another target, which no shot films."""
    mission = plan.trajectory.keyframes.mission
    more = mission.targets[0]._replace(name=name)
    return _of_mission(plan, mission._replace(targets=(*mission.targets, more)))


def with_zoom(plan):
    """The same plan of one drone, whose first move in a shot zooms."""
    (track,) = plan.trajectory.drones
    ctrl = track.curve.ctrl.copy()
    ctrl[1, :, HFOV] = np.radians(np.linspace(70.0, 40.0, ctrl.shape[1]))
    zooms = replace(track, curve=Piecewise(track.curve.breaks, ctrl))
    return VerifiedIR(replace(plan.trajectory, drones=(zooms,)), plan.certificate)


def _of_mission(plan, mission):
    keyframes = plan.trajectory.keyframes._replace(mission=mission)
    return VerifiedIR(replace(plan.trajectory, keyframes=keyframes), plan.certificate)
