"""Who sets a limit on where a drone may be, and where the mission writes it down. Plain Python."""

from typing import TYPE_CHECKING, Literal, NamedTuple

from shotc.ir.mission import Drone, MissionIR, Zone
from shotc.ir.origin import KeyPath
from shotc.ir.target import Target

if TYPE_CHECKING:  # a mission without any loads no arrays
    from shotc.ir.obstacle_mesh import ObstacleMesh

OwnerKind = Literal["zone", "target", "drone", "ground", "ceiling", "scene", "buildings"]


class Owner(NamedTuple):
    """What an obstacle, a half-space or a moving body belongs to: a zone, a target, a drone, the ground, or
    the greatest height above it.

    path : of its key in the mission; of the ground and the ceiling it is that of the rule for it
    As text it is how plans name it: `zone tree`, `ground`.
    """

    kind: OwnerKind
    name: str
    path: KeyPath

    def __str__(self) -> str:
        return f"{self.kind} {self.name}" if self.name else self.kind

    @property
    def words(self) -> str:
        """How diagnostics name it."""
        return f"{self.kind} `{self.name}`" if self.name else f"the {self.kind}"


GROUND = Owner("ground", "", ("rules", "ground_clearance"))
CEILING = Owner("ceiling", "", ("rules", "max_height"))


def zone_owner(zone: Zone) -> Owner:
    """Return the owner of what a zone forbids."""
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


def owner_of(mission: MissionIR, text: str) -> Owner | None:
    """Return the owner that a plan names by a text; None for a text that names none."""
    known = (
        GROUND,
        CEILING,
        *map(zone_owner, mission.zones),
        *map(target_owner, mission.targets),
        *map(drone_owner, mission.drones),
        *map(mesh_owner, mission.meshes),
    )
    return next((owner for owner in known if str(owner) == text), None)
