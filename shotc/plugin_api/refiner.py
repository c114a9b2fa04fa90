"""The interface for refiners besides ``plugin_api``: free space, curves, timing, and the return into a path.

Unlike ``plugin_api`` it loads all its names at once, with numpy.
"""

from __future__ import annotations

from shotc.geom import viewpoint
from shotc.geom.bernstein import Array, quintic_hermite, state_at
from shotc.geom.bspline import IntArray, restrict, spline, subdivide
from shotc.geom.camera import ROUNDING_M, UnitVector, View, aim_at, frustum_margins
from shotc.geom.ease import minimum_jerk
from shotc.geom.pieces import Mask
from shotc.geom.sampling import worst_of_runs
from shotc.geom.shapes import BodyShape, BoxShape, CylinderShape, TargetShape, bodies_of
from shotc.geom.solid_arrays.points import bounded, distances
from shotc.geom.solids import Cylinder, Solid, convex_parts
from shotc.geom.track_array import places
from shotc.geom.vec import wrapped
from shotc.ir.allow import hidden_on_purpose
from shotc.ir.bodies import flying, moved, parts_of_one, shapes
from shotc.ir.coverage import coverage
from shotc.ir.drone import Drone
from shotc.ir.hidden import HALF_SHARE
from shotc.ir.keyed import keeps_a_place, near_at
from shotc.ir.keyframes import PlacedKeyframe, PlacedShot, PlacedSubject
from shotc.ir.mission import Near
from shotc.ir.obstacle_mesh import body_prisms
from shotc.ir.occlusion import others_of
from shotc.ir.path import (
    BODY_YAW,
    CALM,
    CAM_PITCH,
    CAM_YAW,
    HFOV,
    SIGHT,
    ClockDeviation,
    ClockLeg,
    Deviation,
    HoldLeg,
    MovingLeg,
    PathDeviation,
    TimedPath,
    leg_of,
    with_need,
)
from shotc.ir.preference import MOST_MOVED_SHARE, PICTURE_SHARE, UNWATCHED_M, given_up, prefers_free_pictures
from shotc.ir.sampling import projected, seen
from shotc.ir.setpoints import Asked
from shotc.ir.trajectory import DroneTrajectory
from shotc.planning.clock.aims import CameraTask, aims_at, camera_task_of, through, wanted_places
from shotc.planning.clock.bounds import Bound, bounds_of
from shotc.planning.clock.camera import AngleTask, turn
from shotc.planning.clock.clock import Clock
from shotc.planning.clock.flights import FlownShot, flights, flown_shot
from shotc.planning.clock.ideals import ideal_places
from shotc.planning.clock.keyed import Keyed
from shotc.planning.clock.pictures import least_out
from shotc.planning.clock.surroundings import Surroundings, surroundings
from shotc.planning.framing.moments import placed_at
from shotc.planning.free_space import NO_HALF_SPACES, FreeSpace, HalfSpaces, beside, corridor, kept, shortfall
from shotc.planning.obstacles import flight_space
from shotc.planning.path.drawn import DrawnPath, drawn_path
from shotc.planning.path.filmed_ahead import ahead_in
from shotc.planning.path.monotone import steady
from shotc.planning.path.rejoin import rejoined
from shotc.planning.path.with_camera import NoTransit, with_camera
from shotc.planning.timing.deadlines import flying_times
from shotc.planning.timing.timed_leg import lateness, leg_time, rough_times
from shotc.solvers.conic import Status
from shotc.solvers.spline_fit import Fit, fit, within

__all__ = [
    "BODY_YAW",
    "CALM",
    "CAM_PITCH",
    "CAM_YAW",
    "HALF_SHARE",
    "HFOV",
    "MOST_MOVED_SHARE",
    "NO_HALF_SPACES",
    "PICTURE_SHARE",
    "ROUNDING_M",
    "SIGHT",
    "UNWATCHED_M",
    "AngleTask",
    "Array",
    "Asked",
    "BodyShape",
    "Bound",
    "BoxShape",
    "CameraTask",
    "Clock",
    "ClockDeviation",
    "ClockLeg",
    "Cylinder",
    "CylinderShape",
    "Deviation",
    "DrawnPath",
    "Drone",
    "DroneTrajectory",
    "Fit",
    "FlownShot",
    "FreeSpace",
    "HalfSpaces",
    "HoldLeg",
    "IntArray",
    "Keyed",
    "Mask",
    "MovingLeg",
    "Near",
    "NoTransit",
    "PathDeviation",
    "PlacedKeyframe",
    "PlacedShot",
    "PlacedSubject",
    "Solid",
    "Status",
    "Surroundings",
    "TargetShape",
    "TimedPath",
    "UnitVector",
    "View",
    "ahead_in",
    "aim_at",
    "aims_at",
    "beside",
    "bodies_of",
    "body_prisms",
    "bounded",
    "bounds_of",
    "camera_task_of",
    "convex_parts",
    "corridor",
    "coverage",
    "distances",
    "drawn_path",
    "fit",
    "flight_space",
    "flights",
    "flown_shot",
    "flying",
    "flying_times",
    "frustum_margins",
    "given_up",
    "hidden_on_purpose",
    "ideal_places",
    "keeps_a_place",
    "kept",
    "lateness",
    "least_out",
    "leg_of",
    "leg_time",
    "minimum_jerk",
    "moved",
    "near_at",
    "others_of",
    "parts_of_one",
    "placed_at",
    "places",
    "prefers_free_pictures",
    "projected",
    "quintic_hermite",
    "rejoined",
    "restrict",
    "rough_times",
    "seen",
    "shapes",
    "shortfall",
    "spline",
    "state_at",
    "steady",
    "subdivide",
    "surroundings",
    "through",
    "turn",
    "viewpoint",
    "wanted_places",
    "with_camera",
    "with_need",
    "within",
    "worst_of_runs",
    "wrapped",
]
