"""simulate.rrd of a run: converts the flown run to a plan, which the recording can draw."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from shotc.emit.rerun_log.flown import Ellipses, record_flown
from shotc.geom.bernstein import Array, quintic_hermite
from shotc.ir.path import BODY_YAW, HFOV
from shotc.ir.trajectory import DroneTrajectory, TrajectoryIR, VerifiedIR
from shotc.simulation.flight import DroneRuns
from shotc.simulation.rehearsal import Rehearsed
from shotc.simulation.world import World, at_times

KNOT_S = 0.2
"""Seconds between the knots of a flight's curve."""


def recording(rehearsed: Rehearsed, world: World, flown: tuple[DroneRuns, ...]) -> bytes:
    """Return the recording of the first run of a world."""
    drones = tuple(_drawn(track, each) for track, each in zip(rehearsed.ir.drones, flown, strict=True))
    known = tuple(
        Ellipses(each.drone, of.target, each.times, of.place[:, 0], of.covariance[:, 0])
        for each in flown
        for of in each.estimated
    )
    plan = VerifiedIR(rehearsed.ir, ())
    return record_flown(plan, VerifiedIR(_as_plan(rehearsed.ir, world, drones), ()), known)


def _as_plan(ir: TrajectoryIR, world: World, drones: tuple[DroneTrajectory, ...]) -> TrajectoryIR:
    mission = ir.keyframes.mission
    rows = np.arange(0.0, float(world.times[-1]) + KNOT_S, KNOT_S)
    targets = tuple(world.target(target.name, 0, rows) for target in mission.targets)
    keyframes = ir.keyframes._replace(mission=mission._replace(targets=targets))
    return replace(ir, keyframes=keyframes, drones=drones)


def _drawn(track: DroneTrajectory, flown: DroneRuns) -> DroneTrajectory:
    """Return a drone's plan with its flown curve, through positions and velocities at knots."""
    knots = np.linspace(track.curve.start, track.curve.end, max(2, round(track.curve.end / KNOT_S) + 1))
    pose = track.curve(knots)
    angles = np.column_stack([np.unwrap(flown.yaw[:, 0]), flown.pitch[:, 0]])
    value = np.column_stack(
        [
            at_times(flown.position[:, 0], flown.times, knots),
            at_times(angles, flown.times, knots),
            pose[:, [BODY_YAW, HFOV]],
        ]
    )
    rate: Array = np.gradient(value, knots, axis=0)
    rate[:, :3] = at_times(flown.velocity[:, 0], flown.times, knots)
    curve = quintic_hermite(knots, value, rate, np.gradient(rate, knots, axis=0))
    return replace(track, curve=curve)
