"""Scenes and buildings in pictures: what is nearest is seen, and subjects are before or behind it."""

from __future__ import annotations

from io import BytesIO
from typing import Any

import numpy as np
import pytest
from PIL import Image

from shotc.emit.mesh_shades import Faces, faces_of
from shotc.emit.palette import STONE, SUBJECT
from shotc.emit.rerun_log.layout import camera_view
from shotc.emit.rerun_log.world import log_scene
from shotc.emit.storyboard.camera_picture import PictureRectangle, picture
from shotc.emit.storyboard.canvas import Canvas, PageRectangle, house_style
from shotc.emit.storyboard.content import shot_boards
from shotc.emit.storyboard.map import draw_map
from shotc.emit.storyboard.scene import draw_scene
from shotc.emit.storyboard.sheet import sheet_of
from shotc.emit.storyboard.splats import OnPage, raster_of
from shotc.geom.shapes import CylinderShape
from shotc.ir.mission import MissionIR
from shotc.ir.obstacle_mesh import ObstacleMesh, obstacle_mesh
from shotc.ir.target import Target
from tests.support.film_plans import orbit_plan
from tests.support.meshes import box_mesh
from tests.support.records import replace
from tests.support.scenes import fine

pytestmark = pytest.mark.slow

BOX = PageRectangle(0.0, 0.0, 3.2, 1.8)


def standing(*boxes: np.ndarray) -> ObstacleMesh:
    part = np.repeat(np.arange(len(boxes)), [len(b) for b in boxes])
    return obstacle_mesh(
        "buildings", "houses.geojson", np.concatenate(boxes), (part, tuple("abcdef"[: len(boxes)]))
    )


def mission(*boxes: np.ndarray, targets: tuple[Target, ...] = ()) -> MissionIR:
    flat = orbit_plan().trajectory.keyframes.mission
    return replace(flat, meshes=(standing(*boxes),), targets=targets, zones=())


def mast(y: float) -> Target:
    return Target("mast", (0.0, y, 5.0), CylinderShape(2.0, 10.0), ("targets", "mast"))


def shown() -> PictureRectangle:
    """A camera 5 m over the ground that looks North from 40 m south of the origin."""
    return picture(np.array([0.0, -40.0, 5.0, np.pi / 2, 0.0, 0.0, 1.2]), 16 / 9, BOX)


def drawn(world: MissionIR) -> np.ndarray:
    with house_style():
        canvas = Canvas(BOX.width, BOX.height, 100)
        draw_scene(canvas, shown(), world, [t.name for t in world.targets], 10.0)
        return np.asarray(Image.open(BytesIO(canvas.png())).convert("RGB")) / 255.0


def is_stone(color: np.ndarray) -> bool:
    return bool(np.ptp(color - np.array(STONE) * color.mean() / np.mean(STONE)) < 0.05)


def test_pixels_show_the_nearest_triangle():
    random = np.random.default_rng(2)
    triangles = random.uniform(-3, 3, (40, 1, 3)) + random.uniform(-2, 2, (40, 3, 3))
    colors = random.uniform(0.2, 0.9, (40, 3))
    size = (240, 320)

    def project(p: np.ndarray) -> OnPage:
        at = np.stack([160 + 40 * p[..., 0], 120 - 40 * p[..., 1]], axis=-1)
        beyond = [at[..., 0] < 0, at[..., 0] > 320, at[..., 1] < 0, at[..., 1] > 240]
        return OnPage(at, 10.0 - p[..., 2], np.stack(beyond, axis=-1))

    found = raster_of(Faces(triangles, colors), project, size)
    x, y = np.meshgrid((np.arange(320) + 0.5 - 160) / 40, (120 - np.arange(240) - 0.5) / 40)
    best = np.full(size, -np.inf)
    for t in triangles:
        m = np.linalg.inv(np.column_stack([t[:, :2], np.ones(3)]).T)
        share = np.einsum("ij,jrc->irc", m, np.stack([x, y, np.ones_like(x)]))
        z = np.einsum("irc,i->rc", share, t[:, 2])
        best = np.where((share >= 0).all(axis=0) & (z > best), z, best)
    both = found.shown & np.isfinite(best)
    assert (found.shown == np.isfinite(best)).mean() > 0.97
    assert (np.abs(found.points[..., 2] - best)[both] < 0.3).mean() > 0.93


def test_a_house_hides_what_is_behind_it_and_not_what_is_before():
    house = box_mesh((0.0, 0.0, 4.0), (20.0, 6.0, 8.0))
    middle = (90, 160)
    assert is_stone(drawn(mission(house))[middle])
    assert is_stone(drawn(mission(house, targets=(mast(12.0),)))[middle])
    before = drawn(mission(house, targets=(mast(-12.0),)))[middle]
    assert not is_stone(before)
    assert before[2] > before[0]
    assert SUBJECT[2] > SUBJECT[0]


@pytest.mark.long
def test_what_is_behind_the_eye_in_part_is_drawn_as_far_as_it_is_before_it():
    street = box_mesh((12.0, -40.0, 4.0), (8.0, 300.0, 8.0))
    pixels = drawn(mission(street))
    assert is_stone(pixels[90, 300])
    assert not is_stone(pixels[60, 60])


def test_points_of_a_cloud_are_as_large_as_what_they_stand_for():
    points = np.repeat(np.array([[[0.0, 0.0, 5.0]]]), 3, axis=1)
    cloud = obstacle_mesh("scene", "a.ply", points, (np.zeros(1, dtype=int), ("a",)), 2.0)
    faces = faces_of([cloud], np.array([0.0, -40.0, 5.0]))
    assert len(faces.triangles) == 2
    assert np.ptp(faces.triangles.reshape(-1, 3), axis=0) == pytest.approx([4.0, 0.0, 4.0])


def test_maps_show_houses_from_above():
    plan = orbit_plan()
    world = replace(plan.trajectory.keyframes.mission, meshes=(standing(box_mesh((20, 8, 4), (10, 10, 8))),))
    board = shot_boards(plan)[0]
    box = PageRectangle(0.0, 0.0, 4.0, 4.0)

    def pixels(told: MissionIR) -> np.ndarray:
        with house_style():
            canvas = Canvas(4.0, 4.0, 100)
            draw_map(canvas, box, board, told, 10.0)
            return np.asarray(Image.open(BytesIO(canvas.png())).convert("RGB")) / 255.0

    changed = np.abs(pixels(world) - pixels(replace(world, meshes=()))).max(axis=2) > 0.02
    sheet = sheet_of(box, board, world)
    (left, low), (right, high) = (sheet.at(np.array(c)) * 100 for c in ((15.0, 3.0), (25.0, 13.0)))
    rows, columns = np.nonzero(changed)
    assert (columns.min(), columns.max()) == pytest.approx((left, right), abs=2)
    assert (400 - rows.max(), 400 - rows.min()) == pytest.approx((low, high), abs=2)


def test_recordings_have_the_triangles_of_houses_in_the_world_and_through_the_lens():
    plan = orbit_plan()
    meshes = (standing(fine(box_mesh((20, 8, 4), (10, 10, 8)), 1)),)
    world = replace(plan.trajectory.keyframes.mission, meshes=meshes)
    keyframes = replace(plan.trajectory.keyframes, mission=world)
    plan = replace(plan, trajectory=replace(plan.trajectory, keyframes=keyframes))
    logged: dict[str, Any] = {}

    class Stream:
        def log(self, entity: str, what: Any, *, static: bool) -> None:
            logged[entity] = what

        def send_columns(self, *rest: Any, **more: Any) -> None:
            pass

    log_scene(Stream(), plan)
    told = logged["world/standing/buildings"]
    assert len(told.triangle_indices.as_arrow_array()) == 48
    view = camera_view(world, world.drones[0], "world/cam", "cam")
    assert "/world/standing/**" in view.contents
