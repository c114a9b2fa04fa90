"""framing.csv against a projection of the target's cylinder, point by point, from trajectory.csv."""

from __future__ import annotations

from math import pi
from pathlib import Path

import numpy as np
import pytest

from shotc.geom.bernstein import Array
from shotc.geom.solids import Cylinder, Solid
from shotc.ir.mission import Composition
from shotc.ir.target import Target
from tests.e2e.conftest import Plan, Planned, each_mission
from tests.support.csv_tables import Table
from tests.support.solid_distances import least_on_the_way, signed_distance

pytestmark = pytest.mark.parametrize("path", each_mission())

POINTS = 720
EVERY = 7
"""Rows between two that are projected anew."""


def rim_points(target: Target) -> Array:
    """Points of both rims, whose hull is the cylinder, about its centre; shape (2 POINTS, 3)."""
    angle = np.linspace(0, 2 * pi, POINTS, endpoint=False)
    ring = np.stack([target.radius * np.cos(angle), target.radius * np.sin(angle)], axis=1)
    levels = (-target.height / 2, target.height / 2)
    return np.concatenate([np.column_stack([ring, np.full(POINTS, level)]) for level in levels])


def on_screen(poses: Table, aspect: float, points: Array) -> tuple[Array, Array, Array]:
    """Project points (M, K, 3), K of them at every pose: u, v and depth, each (M, K)."""
    yaw, pitch = poses["cam_yaw_rad"], poses["cam_pitch_rad"]
    zero = np.zeros_like(yaw)
    forward = np.stack([np.cos(pitch) * np.cos(yaw), np.cos(pitch) * np.sin(yaw), np.sin(pitch)], axis=1)
    right = np.stack([np.sin(yaw), -np.cos(yaw), zero], axis=1)
    up = np.cross(right, forward)
    offset = points - poses.numbers("x_m", "y_m", "z_m")[:, None]
    depth, across, above = (np.einsum("mkd,md->mk", offset, axis) for axis in (forward, right, up))
    half = np.tan(poses["hfov_rad"] / 2)[:, None]
    with np.errstate(divide="ignore", invalid="ignore"):
        return across / (depth * half), above / (depth * half / aspect), depth


def rows_of(planned: Planned, shot: str, target: str) -> tuple[Table, Table]:
    """Rows of framing.csv and the rows of trajectory.csv at their times."""
    return planned.framing.where(shot=shot, target=target), planned.motion.where(shot=shot)


def pairs(planned: Planned) -> list[tuple[str, str]]:
    return sorted(set(zip(planned.framing["shot"], planned.framing["target"], strict=True)))


def test_there_is_a_row_for_every_sample_of_every_subject(plan: Plan, path: Path) -> None:
    planned = plan(path)
    columns = "t_s,drone,shot,target,u,v,u_ref,v_ref,size,in_frame,occluded,covered"
    exposed = ",focus_m,near_m,far_m,motion_blur_px,background_blur_px"
    optics = any(drone.optics is not None for drone in planned.mission.drones)
    assert ",".join(planned.framing.header) == columns + (exposed if optics else "")
    assert set(pairs(planned)) == {
        (shot.id, name)
        for shot in planned.mission.shots
        for name in {shot.subject, *(keyframe.target for keyframe in shot.keyframes)} - {None}
    }
    for pair in pairs(planned):
        framing, motion = rows_of(planned, *pair)
        assert framing["t_s"].tolist() == motion["t_s"].tolist()
        assert set(framing["drone"]) == {planned.filmed_by[pair[0]]}
    assert planned.framing["drone"].tolist() == sorted(planned.framing["drone"])
    for drone in planned.flights:
        assert (np.diff(planned.framing.where(drone=drone)["t_s"]) >= 0).all()


def test_the_centre_and_the_size_are_where_the_camera_sees_them(plan: Plan, path: Path) -> None:
    planned = plan(path)
    for shot, name in pairs(planned):
        framing, poses = (table.every(EVERY) for table in rows_of(planned, shot, name))
        target, aspect = planned.mission.target(name), planned.mission.drone(planned.filmed_by[shot]).aspect
        centres = planned.courses[name].at(poses["t_s"])[:, None]
        u, v, depth = on_screen(poses, aspect, centres)
        before = depth[:, 0] > 0
        assert framing["u"][before] == pytest.approx(u[before, 0], abs=1e-6)
        assert framing["v"][before] == pytest.approx(v[before, 0], abs=1e-6)
        assert np.isnan(framing["u"][~before]).all()
        _, v, depth = on_screen(poses, aspect, centres + rim_points(target))
        whole = (depth > 0).all(axis=1)
        size = (v.max(axis=1) - v.min(axis=1)) / 2
        assert framing["size"][whole] == pytest.approx(size[whole], rel=1e-4)


def test_in_frame_means_the_whole_silhouette(plan: Plan, path: Path) -> None:
    planned = plan(path)
    for shot, name in pairs(planned):
        framing, poses = (table.every(EVERY) for table in rows_of(planned, shot, name))
        points = planned.courses[name].at(poses["t_s"])[:, None] + rim_points(planned.mission.target(name))
        u, v, depth = on_screen(poses, planned.mission.drone(planned.filmed_by[shot]).aspect, points)
        reach = np.where(depth > 0, np.maximum(np.abs(u), np.abs(v)), np.inf).max(axis=1)
        # The points lie on the silhouette or inside it, at most a sagitta of 1e-5 of its size.
        assert set(framing["in_frame"]) <= {0.0, 1.0}
        assert (framing["in_frame"][reach > 1 + 1e-6] == 0).all()
        assert (framing["in_frame"][reach < 1 - 1e-3] == 1).all()


def test_occluded_means_something_stands_on_the_line_of_sight(plan: Plan, path: Path) -> None:
    planned = plan(path)
    for shot, name in pairs(planned):
        framing, poses = (table.every(4 * EVERY) for table in rows_of(planned, shot, name))
        least = np.minimum(clearest_sight(planned, name, poses), past_drones(planned, shot, name, poses))
        assert (framing["occluded"][least < -0.2] == 1).all()
        assert (framing["occluded"][least > 0.01] == 0).all()


def clearest_sight(planned: Planned, name: str, poses: Table) -> Array:
    """How near the lines of sight to a target come to what may hide it, negative where they pass through."""
    t, eyes = poses["t_s"], poses.numbers("x_m", "y_m", "z_m")
    centres = planned.courses[name].at(t)
    least = np.full(len(eyes), np.inf)
    # A target that moves stands still where everything is seen from its centre.
    in_the_way: list[tuple[Solid, Array]] = [
        (
            Cylinder((0.0, 0.0), other.radius, -other.height / 2, other.height / 2),
            planned.courses[other.name].at(t),
        )
        for other in planned.mission.targets
        if other.name != name
    ]
    in_the_way += [(z.solid, np.zeros_like(eyes)) for z in planned.mission.zones if z.keep == "out"]
    for solid, at in in_the_way:
        on_the_way = least_on_the_way(solid, eyes - at, centres - at)
        around = signed_distance(solid, centres - at) <= 0
        least = np.minimum(least, np.where(around, np.inf, on_the_way))
    return least


def past_drones(planned: Planned, shot: str, name: str, poses: Table) -> Array:
    """How near the lines of sight come to the bodies of other drones, negative where they pass through."""
    t, eyes = poses["t_s"], poses.numbers("x_m", "y_m", "z_m")
    along = planned.courses[name].at(t) - eyes
    least = np.full(len(eyes), np.inf)
    for drone, motion in planned.flights.items():
        if drone == planned.filmed_by[shot]:
            continue
        body = np.column_stack([np.interp(t, motion["t_s"], motion[axis]) for axis in ("x_m", "y_m", "z_m")])
        share = np.einsum("md,md->m", body - eyes, along) / np.einsum("md,md->m", along, along)
        off = body - eyes - np.clip(share, 0.0, 1.0)[:, None] * along
        least = np.minimum(least, np.linalg.norm(off, axis=1) - planned.mission.drone(drone).radius)
    return least


def test_references_are_on_the_composition_and_met_at_the_keyframes(plan: Plan, path: Path) -> None:
    planned = plan(path)
    cropped = {d.labels[0].span.line for d in planned.diagnostics if d.code == "G011"}
    reached = {(k.shot, k.index): k.time for t in planned.tracks.values() for k in t.keyframes}
    for shot in planned.mission.shots:
        if cropped & lines_of(planned, shot.path):
            continue  # the warning says that the set is left there
        for index, keyframe in enumerate(shot.keyframes):
            time = reached.get((shot.id, index))
            if keyframe.target is None or time is None:
                continue
            framing = planned.framing.where(shot=shot.id, target=keyframe.target)
            row = int(np.argmin(np.abs(framing["t_s"] - time)))
            u, v, u_ref, v_ref = framing.numbers("u", "v", "u_ref", "v_ref")[row]
            off = to_composition(keyframe.composition, u_ref, v_ref)
            if off is None:
                assert np.isnan([u_ref, v_ref]).all(), (shot.id, index)
            else:
                assert max(off, np.hypot(u - u_ref, v - v_ref)) < 0.01, (shot.id, index)


def test_references_of_moving_targets_are_on_the_composition_all_the_time(plan: Plan, path: Path) -> None:
    planned = plan(path)
    for shot in planned.mission.shots:
        for subject in shot.subjects:
            rows = planned.framing.where(shot=shot.id, target=subject.target)
            for u, v in np.unique(rows.numbers("u_ref", "v_ref"), axis=0):
                off = to_composition(subject.composition, u, v)
                assert off is not None
                assert off < 1e-6, (shot.id, u, v)


def lines_of(planned: Planned, path: tuple[str | int, ...]) -> set[int]:
    """The lines of the mission that a shot takes."""
    origins = planned.mission.origins
    spans = [
        s for table in (origins.keys, origins.values) for p, s in table.items() if p[: len(path)] == path
    ]
    return {span.line for span in spans}


def to_composition(composition: Composition, u: float, v: float) -> float | None:
    """The distance on screen to the nearest place of a composition set, None where it has no place at all."""
    if composition.keep:
        return 0.0
    points = [float(np.hypot(u - a, v - b)) for a, b in composition.points]
    lines = [*(abs(u - a) for a in composition.u_lines), *(abs(v - b) for b in composition.v_lines)]
    return min([*points, *lines], default=None)


def test_promises_are_kept(plan: Plan, path: Path) -> None:
    planned = plan(path)
    for shot in planned.mission.shots:
        framing = planned.framing.where(shot=shot.id)
        promise = shot.promise
        if promise.in_frame is not None:
            assert framing["in_frame"].mean() >= promise.in_frame - 1e-9
        if promise.screen_error is not None:
            error = np.hypot(framing["u"] - framing["u_ref"], framing["v"] - framing["v_ref"])
            assert error.max() <= promise.screen_error
        if promise.size is not None:
            assert promise.size[0] <= framing["size"].min() <= framing["size"].max() <= promise.size[1]
