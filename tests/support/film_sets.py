"""A plan with all that files for previsualization show: zoom, terrain, a scene with points, a moving car."""

from __future__ import annotations

import numpy as np

from shotc.geom.bernstein import Piecewise
from shotc.geom.shapes import BoxShape
from shotc.geom.solids import box
from shotc.geom.surface.ground import ground_of
from shotc.geom.surface.tree import surface_of
from shotc.geom.track import Track
from shotc.ir.mission import Zone
from shotc.ir.obstacle_mesh import ObstacleMesh
from shotc.ir.path import HFOV
from shotc.ir.target import Target
from shotc.ir.terrain import Terrain
from shotc.ir.trajectory import VerifiedIR
from tests.support.film_plans import orbit_plan
from tests.support.meshes import box_mesh
from tests.support.records import replace
from tests.support.surfaces import grid

CAR = Target(
    "2nd-car",
    (30.0, 0.0, 0.75),
    BoxShape(4.0, 2.0, 1.5),
    ("targets", "2nd-car"),
    Track((0.0, 40.0, 80.0), ((30.0, 0.0, 0.75), (30.0, 60.0, 0.75), (-30.0, 60.0, 0.75))),
)
HOUSE = box_mesh((-30.0, 20.0, 3.0), (10.0, 8.0, 6.0))
LEAVES = np.array([[-50.0, 0.0, 4.0], [-51.0, 0.5, 5.0]])
HALL = Zone("hall", "in", box((0.0, 0.0, 40.0), (300.0, 300.0, 100.0), 0.0), ("world", "zones", "hall"))


def film_set(rate: float = 10.0) -> VerifiedIR:
    """The orbit plan with a lens that opens by 0.1 deg/s, on hills, beside a house and leaves."""
    plan = orbit_plan()
    ir = plan.trajectory
    (drone,) = ir.drones
    ctrl = drone.curve.ctrl.copy()
    breaks = drone.curve.breaks
    share = np.linspace(0.0, 1.0, ctrl.shape[1])
    ctrl[:, :, HFOV] += np.radians(0.1) * (breaks[:-1, None] + np.diff(breaks)[:, None] * share)
    mission = ir.keyframes.mission
    shape = grid(np.cos(np.linspace(0.0, 6.0, 30))[:, None] * np.ones(30), 10.0)
    triangles = np.concatenate([HOUSE, np.repeat(LEAVES[:, None], 3, axis=1)])
    none = np.zeros(len(triangles), dtype=int)
    mission = replace(
        mission,
        rate=rate,
        targets=(*mission.targets, CAR),
        zones=(*mission.zones, HALL),
        terrain=Terrain(ground_of(shape.corners - [145.0, 145.0, 3.0], shape.faces), "hills.csv"),
        meshes=(
            ObstacleMesh("scene", "s.ply", surface_of(triangles), none, ("",), none, np.array([False]), 0.2),
        ),
    )
    keyframes = replace(ir.keyframes, mission=mission)
    moved = replace(drone, curve=Piecewise(breaks, ctrl))
    return VerifiedIR(replace(ir, keyframes=keyframes, drones=(moved,)), plan.certificate)
