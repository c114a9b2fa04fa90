"""Owners of obstacles and limits: the part of the mission that they come from. Plain Python."""

from typing import TYPE_CHECKING, Literal, NamedTuple

from shotc.geom.vec import Vec3
from shotc.ir.drone import Drone
from shotc.ir.mission import MissionIR, Zone
from shotc.ir.origin import KeyPath
from shotc.ir.target import Target

if TYPE_CHECKING:  # a mission without meshes loads no arrays
    from shotc.ir.obstacle_mesh import ObstacleMesh

OwnerKind = Literal["zone", "target", "drone", "ground", "ceiling", "scene", "buildings", "fleet"]


class Owner(NamedTuple):
    """The part of the mission that an obstacle, a half-space or a moving body belongs to.

    name : for a scene or buildings that of the part, empty for all parts
    path : its key path in the mission; for the ground and the ceiling that of their rule
    Its text is its name in plans: `zone tree`, `ground`, `building Town hall`.
    """

    kind: OwnerKind
    name: str
    path: KeyPath

    def __str__(self) -> str:
        return f"{self._one} {self.name}" if self.name else self.kind

    @property
    def words(self) -> str:
        """Its name in diagnostics."""
        if not self.name:
            return f"the {self.kind}"
        if self.kind == "scene":
            return f"`{self.name}` of the scene"
        return f"{self._one} `{self.name}`"

    @property
    def _one(self) -> str:
        return self.kind.removesuffix("s")


GROUND = Owner("ground", "", ("rules", "ground_clearance"))
CEILING = Owner("ceiling", "", ("rules", "max_height"))


def zone_owner(zone: Zone) -> Owner:
    """Return the owner of a zone."""
    return Owner("zone", zone.name, zone.path)


def target_owner(target: Target) -> Owner:
    """Return the owner of a target's body."""
    return Owner("target", target.name, target.path)


def drone_owner(drone: Drone) -> Owner:
    """Return the owner of a drone's body."""
    return Owner("drone", drone.name, drone.path)


def mesh_owner(mesh: "ObstacleMesh") -> Owner:
    """Return the owner of the triangles of a scene or of buildings."""
    return Owner(mesh.kind, "", mesh.path)


def part_owner(mesh: "ObstacleMesh", place: Vec3) -> Owner:
    """Return the owner of the part of a mesh that is nearest to a place of W."""
    return mesh_owner(mesh)._replace(name=mesh.nearest_part(place).name)


def owner_of(mission: MissionIR, text: str) -> Owner | None:
    """Return the owner with that text; None if there is none."""
    known = (
        GROUND,
        CEILING,
        *map(zone_owner, mission.zones),
        *map(target_owner, mission.targets),
        *map(drone_owner, mission.drones),
        *map(mesh_owner, mission.meshes),
    )
    return next((owner for owner in known if str(owner) == text), None) or _part_named(mission, text)


def _part_named(mission: MissionIR, text: str) -> Owner | None:
    """Return the owner of the part of a scene or of buildings with that text; None if there is none."""
    for mesh in mission.meshes:
        parts = (mesh_owner(mesh)._replace(name=name) for name in mesh.names)
        match = next((part for part in parts if str(part) == text), None)
        if match is not None:
            return match
    return None
