"""glTF and USD, read back by others' readers: cameras as planned at every frame, bodies in their places."""

from __future__ import annotations

import io
import json
import shutil
import struct
import subprocess
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from shotc.emit.previs import gltf, usd
from shotc.geom.bernstein import Array
from shotc.ir.path import CAM_PITCH, CAM_YAW, HFOV
from shotc.ir.sampling import clock
from tests.support.film_plans import orbit_plan
from tests.support.film_sets import HOUSE, LEAVES, film_set
from tests.support.show_plans import plan as show_plan

PLAN = film_set()
DRONE = PLAN.trajectory.drones[0]
TICKS = clock(10.0, DRONE.curve.end)
STATE = DRONE.curve(TICKS)
Y_UP = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])
VALIDATOR = Path(__file__).parents[2] / "support" / "gltf_validator.mjs"
ASPECT = 16 / 9


@pytest.fixture(scope="module")
def glb() -> bytes:
    (artifact,) = gltf.EMITTER.emit(PLAN).artifacts
    assert artifact.name == "mission.glb"
    return artifact.data


@pytest.fixture(scope="module")
def stage(tmp_path_factory):
    read = pytest.importorskip("pxr.Usd", reason="usd-core reads USD")
    (artifact,) = usd.EMITTER.emit(PLAN).artifacts
    path = tmp_path_factory.mktemp("usd") / artifact.name
    path.write_bytes(artifact.data)
    return read.Stage.Open(str(path))


def sorted_rows(rows: Array) -> Array:
    return rows[np.lexsort(rows.T)]


def looks(state: Array) -> Array:
    """Where cameras look, W, (M, 3)."""
    yaw, pitch = state[:, CAM_YAW], state[:, CAM_PITCH]
    return np.column_stack([np.cos(yaw) * np.cos(pitch), np.sin(yaw) * np.cos(pitch), np.sin(pitch)])


def off(a: Array, b: Array) -> float:
    """The largest angle between unit vectors, deg; exact where it is small."""
    return float(np.degrees(2.0 * np.arcsin(np.linalg.norm(a - b, axis=1) / 2.0)).max())


def held(places: Array, turns: Rotation, hfov: Array) -> None:
    """Hold cameras along W that look along -Z, Y up, to the plan: 1 mm, 0.01 deg, level."""
    assert np.linalg.norm(places - STATE[:, :3], axis=1).max() < 1e-3
    assert off(turns.apply([0.0, 0.0, -1.0]), looks(STATE)) < 0.01
    assert np.abs(turns.apply([1.0, 0.0, 0.0])[:, 2]).max() < 1e-6
    assert (turns.apply([0.0, 1.0, 0.0])[:, 2] > -1e-6).all()
    assert np.degrees(np.abs(hfov - STATE[:, HFOV])).max() < 0.01


class Glb:
    """A GLB file by pygltflib: the values behind its accessors."""

    def __init__(self, data: bytes) -> None:
        read = pytest.importorskip("pygltflib", reason="pygltflib reads glTF")
        self.file = read.GLTF2.load_from_bytes(data)
        self.blob = self.file.binary_blob()

    def values(self, index: int) -> Array:
        accessor = self.file.accessors[index]
        view = self.file.bufferViews[accessor.bufferView]
        wide = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[accessor.type]
        kind = {5126: "<f4", 5125: "<u4"}[accessor.componentType]
        found = np.frombuffer(self.blob, kind, accessor.count * wide, view.byteOffset or 0)
        return found.reshape(-1, wide).astype(float)

    def channel(self, path: str, node: int | None = None) -> tuple[Array, Array]:
        (animation,) = self.file.animations
        (found,) = [c for c in animation.channels if c.target.path == path and c.target.node == node]
        sampler = animation.samplers[found.sampler]
        assert sampler.interpolation == "LINEAR"
        return self.values(sampler.input).ravel(), self.values(sampler.output)

    def node(self, name: str) -> int:
        return next(i for i, node in enumerate(self.file.nodes) if node.name == name)


def test_glb_has_the_camera_at_every_frame(glb: bytes) -> None:
    file = Glb(glb)
    node = file.node("cam1")
    times, places = file.channel("translation", node)
    _, turns = file.channel("rotation", node)
    _, yfov = file.channel("pointer")
    assert times == pytest.approx(TICKS, abs=1e-5)
    hfov = 2.0 * np.arctan(np.tan(yfov.ravel() / 2.0) * ASPECT)
    held(places @ Y_UP, Rotation.from_matrix(Y_UP.T) * Rotation.from_quat(turns), hfov)
    assert np.einsum("mi,mi->m", turns[1:], turns[:-1]).min() > 0.0
    lens = file.file.cameras[file.file.nodes[node].camera].perspective
    assert lens.aspectRatio == pytest.approx(ASPECT)
    film = float(DRONE.curve(22.0)[HFOV])
    assert 2.0 * np.arctan(np.tan(lens.yfov / 2.0) * ASPECT) == pytest.approx(film, abs=1e-6)
    assert file.file.extensionsUsed == ["KHR_animation_pointer"]


def test_glb_has_the_car_where_it_is_and_as_it_faces(glb: bytes) -> None:
    file = Glb(glb)
    times, places = file.channel("translation", file.node("2nd-car"))
    _, turns = file.channel("rotation", file.node("2nd-car"))
    at = int(np.searchsorted(times, 20.0))
    assert places[at] == pytest.approx([30.0, 0.75, -30.0], abs=1e-4)
    after = int(np.searchsorted(times, 60.0))
    assert Rotation.from_quat(turns[after]).apply([1, 0, 0]) == pytest.approx([0.0, 0.0, -1.0], abs=1e-6)
    assert Rotation.from_quat(turns[at]).apply([1, 0, 0]) == pytest.approx([1.0, 0.0, 0.0], abs=1e-6)


@pytest.mark.slow
def test_trimesh_finds_the_world(glb: bytes) -> None:
    trimesh = pytest.importorskip("trimesh", reason="trimesh reads glTF")
    scene = trimesh.load(io.BytesIO(glb), file_type="glb")
    meshes = {name: scene.geometry[name] for name in ("tower", "2nd-car", "terrain", "scene", "tree")}
    tower = PLAN.trajectory.keyframes.mission.target("tower")
    top = tower.centre[2] + tower.height / 2
    assert meshes["tower"].bounds[:, 1] == pytest.approx([tower.foot[2], top], abs=1e-4)
    assert meshes["2nd-car"].extents == pytest.approx([2.0, 1.5, 4.0], abs=1e-4)
    house = HOUSE.reshape(-1, 3) @ Y_UP.T
    assert meshes["scene"].bounds == pytest.approx(np.array([house.min(0), house.max(0)]), abs=1e-4)
    meshes["scene"].merge_vertices()
    assert meshes["scene"].is_watertight
    assert meshes["terrain"].bounds[1] == pytest.approx([145.0, -2.0, 145.0], abs=0.01)
    leaves = scene.geometry["scene-points"].vertices
    assert np.asarray(leaves) == pytest.approx(LEAVES @ Y_UP.T, abs=1e-5)


@pytest.mark.slow
def test_the_validator_of_khronos_finds_nothing(glb: bytes, tmp_path: Path) -> None:
    if shutil.which("node") is None:
        pytest.skip("node is not installed, which glTF's validator runs in")
    (tmp_path / "mission.glb").write_bytes(glb)
    done = subprocess.run(
        ["node", str(VALIDATOR), str(tmp_path / "mission.glb")], capture_output=True, text=True, check=False
    )
    if done.returncode == 3:
        pytest.skip(f"npm install gltf-validator, where node finds it: {done.stderr.strip()}")
    assert done.returncode == 0, done.stderr
    issues = json.loads(done.stdout)
    assert (issues["numErrors"], issues["numWarnings"]) == (0, 0), issues["messages"]


def test_glb_is_as_long_as_it_says_and_the_same_every_time(glb: bytes) -> None:
    magic, version, length = struct.unpack("<4sII", glb[:12])
    assert (magic, version, length) == (b"glTF", 2, len(glb))
    assert gltf.EMITTER.emit(PLAN).artifacts[0].data == glb


@pytest.mark.slow
def test_usd_has_the_camera_at_every_frame(stage) -> None:
    from pxr import UsdGeom

    assert (stage.GetTimeCodesPerSecond(), stage.GetEndTimeCode()) == (10.0, len(TICKS) - 1)
    assert (UsdGeom.GetStageUpAxis(stage), UsdGeom.GetStageMetersPerUnit(stage)) == ("Z", 1.0)
    camera = UsdGeom.Camera(stage.GetPrimAtPath("/World/cam1"))
    seen = [camera.GetCamera(float(k)) for k in range(len(TICKS))]
    poses = np.array([np.array(one.transform).T for one in seen])
    hfov = np.radians([one.GetFieldOfView(one.FOVHorizontal) for one in seen])
    held(poses[:, :3, 3], Rotation.from_matrix(poses[:, :3, :3]), hfov)
    assert seen[0].aspectRatio == pytest.approx(ASPECT)
    assert seen[0].horizontalAperture == pytest.approx(0.36)


@pytest.mark.slow
def test_usd_has_the_world_as_pixar_s_validators_want_it(stage) -> None:
    from pxr import Gf, UsdGeom, UsdValidation

    car = stage.GetPrimAtPath("/World/_2nd_car")
    assert car.GetDisplayName() == "2nd-car"
    at = UsdGeom.Xformable(car).ComputeLocalToWorldTransform(600.0)
    assert at.Transform(Gf.Vec3d(0, 0, 0)) == Gf.Vec3d(0, 60, 0.75)
    assert np.array(at.TransformDir(Gf.Vec3d(1, 0, 0))) == pytest.approx([0.0, 1.0, 0.0], abs=1e-8)
    house = np.array(UsdGeom.Mesh(stage.GetPrimAtPath("/World/scene")).GetPointsAttr().Get())
    assert sorted_rows(house) == pytest.approx(sorted_rows(HOUSE.reshape(-1, 3)), abs=1e-4)
    leaves = UsdGeom.Points(stage.GetPrimAtPath("/World/scene_points"))
    assert np.array(leaves.GetPointsAttr().Get()) == pytest.approx(LEAVES, abs=1e-4)
    assert leaves.GetWidthsAttr().Get()[0] == pytest.approx(0.4)
    registry = UsdValidation.ValidationRegistry()
    faults = UsdValidation.ValidationContext(registry.GetOrLoadAllValidators()).Validate(stage)
    assert [fault.GetMessage() for fault in faults] == []


def test_the_notes_tell_the_clock_and_the_zoom() -> None:
    clocked, zoom = gltf.EMITTER.emit(PLAN).notes
    assert clocked.startswith(f"mission.glb: 10 frames a second, frames 0 to {len(TICKS) - 1}")
    assert zoom == "mission.glb: cam1 zooms by KHR_animation_pointer; what does not know that shows 72.2 deg"
    assert len(usd.EMITTER.emit(PLAN).notes) == 1


def test_a_lens_that_stays_is_not_animated_and_plain_ground_is_a_plane() -> None:
    pytest.importorskip("pygltflib", reason="pygltflib reads glTF")
    file = Glb(gltf.EMITTER.emit(orbit_plan()).artifacts[0].data).file
    assert {channel.target.path for channel in file.animations[0].channels} == {"translation", "rotation"}
    assert file.extensionsUsed == []
    assert [node.name for node in file.nodes] == ["ground", "tree", "field", "tower", "cam1"]
    text = usd.EMITTER.emit(orbit_plan()).artifacts[0].data.decode()
    assert "focalLength.timeSamples" not in text
    focal = float(text.partition("float focalLength = ")[2].split()[0])
    assert focal == pytest.approx(0.18 / np.tan(np.radians(35.0)), abs=1e-9)


@pytest.mark.parametrize("emitter", [gltf.EMITTER, usd.EMITTER])
def test_a_show_has_no_camera_and_a_note_says_so(emitter) -> None:
    emission = emitter.emit(show_plan())
    assert emission.artifacts == ()
    assert "fleets" in emission.notes[0]
