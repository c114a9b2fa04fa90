"""What a refiner may use of shotc besides ``plugin_api``: the room, curves, timing, and the way back.

Import it where numpy is wanted anyway; unlike ``plugin_api`` it loads all of it at once.
"""

from __future__ import annotations

from shotc.geom.bernstein import Array
from shotc.geom.bspline import restrict, spline, subdivide
from shotc.geom.camera import View, aim_at, frustum_margins
from shotc.geom.convex import distances
from shotc.geom.corridor import Room, corridor, kept, shortfall
from shotc.ir.keyframes import PlacedKeyframe, PlacedShot
from shotc.ir.mission import Drone
from shotc.ir.path import CAM_PITCH, CAM_YAW, HFOV, Deviation
from shotc.passes.parameterize_time.estimate import rough_times, shortest_time
from shotc.passes.refine_path.faults import leg_of
from shotc.passes.solve_path_qp.angles import smoother
from shotc.passes.solve_path_qp.rejoin import NoTransit, rejoined, with_camera
from shotc.passes.solve_path_qp.room import flight_room
from shotc.passes.solve_path_qp.turns import steady
from shotc.solvers.conic import Status
from shotc.solvers.spline_fit import Fit, fit, within

__all__ = [
    "CAM_PITCH",
    "CAM_YAW",
    "HFOV",
    "Array",
    "Deviation",
    "Drone",
    "Fit",
    "NoTransit",
    "PlacedKeyframe",
    "PlacedShot",
    "Room",
    "Status",
    "View",
    "aim_at",
    "corridor",
    "distances",
    "fit",
    "flight_room",
    "frustum_margins",
    "kept",
    "leg_of",
    "rejoined",
    "restrict",
    "rough_times",
    "shortest_time",
    "shortfall",
    "smoother",
    "spline",
    "steady",
    "subdivide",
    "with_camera",
    "within",
]
