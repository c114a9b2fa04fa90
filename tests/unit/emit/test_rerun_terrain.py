"""Terrain in the recording: one smooth mesh instead of the plane, and an opening that looks over hills."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import rerun as rr

from shotc.emit.hillshade import before
from shotc.emit.rerun_log.layout import camera_view
from shotc.emit.rerun_log.motion import camera_entity
from shotc.emit.rerun_log.opening import OVER_GROUND_M, first_stand
from shotc.emit.rerun_log.world import log_scene
from shotc.emit.triangles import mesh_of
from shotc.geom.surface.ground import Ground, ground_of, height_at
from shotc.ir.terrain import Terrain
from shotc.ir.trajectory import VerifiedIR
from tests.support.film_plans import orbit_plan
from tests.support.records import replace
from tests.support.surfaces import grid

SIDE, STEP = 61, 5.0


def ground(heights: np.ndarray) -> Ground:
    shape = grid(heights, STEP)
    middle = 0.5 * STEP * (SIDE - 1)
    return ground_of(shape.corners - [middle, middle, 0.0], shape.faces)


def over(shape: Ground) -> VerifiedIR:
    plan = orbit_plan()
    mission = replace(plan.trajectory.keyframes.mission, terrain=Terrain(shape, "relief.csv"))
    keyframes = replace(plan.trajectory.keyframes, mission=mission)
    return replace(plan, trajectory=replace(plan.trajectory, keyframes=keyframes))


def logged(plan: VerifiedIR) -> dict[str, Any]:
    class Stream:
        def log(self, entity: str, what: Any, *, static: bool) -> None:
            assert static
            found[entity] = what

        def send_columns(self, *rest: Any, **more: Any) -> None:
            pass

    found: dict[str, Any] = {}
    log_scene(Stream(), plan)
    return found


def test_the_mesh_of_ground_shares_its_corners_and_faces_up() -> None:
    x, y = np.meshgrid(np.arange(SIDE), np.arange(SIDE), indexing="ij")
    triangles = ground(np.sin(x / 4.0) * 10 + y).surface.triangles.copy()
    triangles[::3] = triangles[::3, ::-1]
    mesh = mesh_of(triangles)
    assert len(mesh.corners) == SIDE**2
    np.testing.assert_allclose(
        np.sort(mesh.corners[mesh.faces], axis=1), np.sort(triangles, axis=1), atol=1e-4
    )
    a, b, c = np.moveaxis(mesh.corners[mesh.faces], 1, 0)
    assert (np.cross(b - a, c - a)[:, 2] > 0).all()
    np.testing.assert_allclose(np.linalg.norm(mesh.normals, axis=1), 1.0)
    assert (mesh.normals[:, 2] > 0).all()


def test_normals_are_those_of_the_slope() -> None:
    x, _ = np.meshgrid(np.arange(SIDE), np.arange(SIDE), indexing="ij")
    mesh = mesh_of(ground(2.0 * x).surface.triangles)
    slope = np.array([-2.0 / STEP, 0.0, 1.0])
    np.testing.assert_allclose(mesh.normals, np.tile(slope / np.linalg.norm(slope), (SIDE**2, 1)), atol=1e-6)


def test_terrain_is_one_static_entity_and_takes_the_plane_s_place() -> None:
    found = logged(over(ground(np.zeros((SIDE, SIDE)))))
    assert isinstance(found["world/terrain"], rr.Mesh3D)
    assert not any(entity.startswith("world/ground") for entity in found)
    assert "world/terrain" not in logged(orbit_plan())


@pytest.mark.parametrize("is_flat", [True, False])
def test_the_camera_s_view_shows_the_ground_there_is(is_flat: bool) -> None:
    plan = orbit_plan() if is_flat else over(ground(np.zeros((SIDE, SIDE))))
    mission = plan.trajectory.keyframes.mission
    drone = mission.drones[0]
    told = camera_view(mission, drone, camera_entity(drone), "it").contents
    assert ("/world/ground/**" in told, "/world/terrain/**" in told) == (is_flat, not is_flat)


def test_a_recording_opens_above_hills_with_the_camera_and_its_subject_in_view() -> None:
    level = first_stand(orbit_plan())
    assert level is not None
    # A hill just where the eye would be.
    at = np.round((np.array(level.eye[:2]) + 150.0) / STEP).astype(int)
    x, y = np.meshgrid(np.arange(SIDE), np.arange(SIDE), indexing="ij")
    shape = ground(np.where(np.hypot(x - at[0], y - at[1]) < 5, level.eye[2] + 40.0, 0.0))
    plan = over(shape)
    stand = first_stand(plan)
    assert stand is not None
    eye = np.array(stand.eye)
    assert eye[2] >= height_at(shape, eye[None, :2])[0] + OVER_GROUND_M
    camera = plan.trajectory.drones[0].curve(22.0)[:3]
    assert not before(shape, eye, np.array([camera, [0.0, 0.0, 12.0]])).any()
    assert first_stand(over(ground(np.zeros((SIDE, SIDE))))) == level
