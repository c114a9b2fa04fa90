"""What of a scene or of buildings a flight comes nearest to, by its name, and where the mission has it."""

from __future__ import annotations

from collections.abc import Iterator

from shotc.diag.model import Label
from shotc.ir.mission import MissionIR
from shotc.ir.obstacle_mesh import ObstacleMesh
from shotc.ir.owners import part_owner
from shotc.ir.trajectory import Claim


def nearest_part(mission: MissionIR, claim: Claim) -> Iterator[str]:
    """Yield what is nearest to where a claim is broken, and where that is."""
    mesh = _mesh(mission, claim)
    if mesh is not None and claim.position is not None:
        place = "({:.2f}, {:.2f}, {:.2f})".format(*mesh.nearest_part(claim.position).place)
        yield f"nearest is {part_owner(mesh, claim.position).words}, at {place} m"


def file_labels(mission: MissionIR, claim: Claim) -> Iterator[Label]:
    """Yield the place in the mission that names the file of what is too near."""
    mesh = _mesh(mission, claim)
    if mesh is not None and claim.position is not None and claim.path != mesh.path:
        yield mission.origins.value(mesh.path, f"{part_owner(mesh, claim.position).words} stands there")


def _mesh(mission: MissionIR, claim: Claim) -> ObstacleMesh | None:
    name = claim.constraint.removesuffix(" at home")
    return next((mesh for mesh in mission.meshes if name == f"distance from {mesh.kind}"), None)
