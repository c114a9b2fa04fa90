"""The scene and the buildings of a mission, from files. Plain Python unless a mission names one."""

from __future__ import annotations

from collections.abc import Callable
from importlib.util import find_spec
from typing import TYPE_CHECKING, NamedTuple

from shotc.diag.model import Diagnostic
from shotc.diag.registry import has_errors
from shotc.ir.limits import Vec3
from shotc.kinds.base import Place, bad_file
from shotc.kinds.files import FileFault
from shotc.kinds.models.endings import ENDINGS, METRES, ending_of
from shotc.passes.resolve.lower.buildings import BUILDINGS, GroundedBuilding, read_buildings
from shotc.passes.resolve.lower.files import Files
from shotc.requirements import remedy
from shotc.spec.mission import MissionSpec
from shotc.spec.world import BuildingsSpec, SceneSpec

if TYPE_CHECKING:  # missions without these do not load numpy
    from shotc.ir.obstacle_mesh import ObstacleMesh
    from shotc.ir.terrain import Terrain

SCENE = ("world", "scene", "file")


class Obstacles(NamedTuple):
    """The scene and the buildings of a mission, and their faults.

    standing : the buildings, one by one
    unread : whether a file cannot be used, at all or by this installation
    """

    meshes: tuple[ObstacleMesh, ...] = ()
    faults: tuple[Diagnostic, ...] = ()
    standing: tuple[GroundedBuilding, ...] = ()
    unread: bool = False


def read_obstacles(
    spec: MissionSpec, put: Callable[[Place], Vec3], terrain: Terrain | None, files: Files
) -> Obstacles:
    """Return the scene and the buildings that a mission names.

    put : converts places into W
    files : reader of files, and the origin
    """
    world = spec.world
    scene = Obstacles() if world.scene is None else _scene(world.scene, put, terrain, files)
    buildings = Obstacles() if world.buildings is None else _buildings(world.buildings, terrain, files)
    faults = (*scene.faults, *buildings.faults)
    unread = has_errors(faults) or scene.unread
    return Obstacles((*scene.meshes, *buildings.meshes), faults, buildings.standing, unread)


def _scene(
    written: SceneSpec, put: Callable[[Place], Vec3], terrain: Terrain | None, files: Files
) -> Obstacles:
    kind, name = ending_of(written.file), written.file
    if kind not in ENDINGS:
        known = ", ".join(f".{ending}" for ending in ENDINGS)
        wrong = FileFault(f"`.{kind[:20]}` is no format of a scene that is read", None, f"one of {known}")
        return Obstacles(faults=(bad_file(files.origins, SCENE, name, wrong),))
    if written.units is None and not ENDINGS[kind].metres:
        return Obstacles(faults=(_without_units(written, files),))
    data = files.read.large(name, SCENE, linked=True)
    if isinstance(data, Diagnostic):
        return Obstacles(faults=(data,))
    if find_spec("numpy") is None:
        return Obstacles(faults=(not_judged("scene", name, SCENE, files),), unread=True)
    from shotc.passes.resolve.lower.scene import SceneReading, scene_mesh

    placed = SceneReading(
        kind, 1.0 if written.units is None else METRES[written.units], written.up or ENDINGS[kind].up
    )
    return scene_mesh(written, data, (placed, put(written.at)), terrain, files)


def _buildings(written: BuildingsSpec, terrain: Terrain | None, files: Files) -> Obstacles:
    data = files.read.large(written.file, BUILDINGS, linked=True)
    if isinstance(data, Diagnostic):
        return Obstacles(faults=(data,))
    houses, faults = read_buildings(written, data, files)
    if not houses:
        return Obstacles(faults=tuple(faults))
    if find_spec("numpy") is None:
        faults_of_file = not_judged("buildings", written.file, BUILDINGS, files)
        return Obstacles(
            (), (*faults, faults_of_file), tuple(GroundedBuilding(house, 0.0) for house in houses)
        )
    from shotc.passes.resolve.lower.prisms import buildings_mesh

    obstacles = buildings_mesh(houses, written.file, terrain, files)
    return obstacles._replace(faults=(*faults, *obstacles.faults))


def not_judged(what: str, name: str, path: tuple[str, ...], files: Files) -> Diagnostic:
    """Return the diagnostic of a file that this installation cannot read: what is not checked."""
    unknown = {
        "terrain": "homes, keyframes, altitudes and framing are not judged: all of them depend on the ground",
        "scene": "homes, keyframes and paths are not checked against it",
        "buildings": "homes, keyframes and paths are not checked against them",
    }
    message = f"the {what} `{name}` cannot be judged: numpy is not installed"
    return Diagnostic("N013", message, (files.origins.value(path),), (unknown[what],), remedy(["numpy"]))


def _without_units(written: SceneSpec, files: Files) -> Diagnostic:
    return Diagnostic(
        "G026",
        f"`{written.file}` does not say in which unit it is",
        (files.origins.value(SCENE),),
        ("of the formats that are read, .glb alone is always in metres",),
        f"write `units: m` beside it, or one of {', '.join(METRES)}",
    )
