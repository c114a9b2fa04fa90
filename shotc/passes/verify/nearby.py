"""The part of a scene or of buildings that a flight comes nearest to: its name and its key in the mission."""

from __future__ import annotations

from collections.abc import Iterator

from shotc.diag.model import Label
from shotc.ir.mission import MissionIR
from shotc.ir.obstacle_mesh import ObstacleMesh
from shotc.ir.owners import part_owner
from shotc.ir.trajectory import Claim
from shotc.passes.verify.fleets.burning import PYRO, from_mesh


def nearest_part(mission: MissionIR, claim: Claim) -> Iterator[str]:
    """Yield the part nearest to the place where a claim is broken, and its position, as a note."""
    mesh = _mesh(mission, claim)
    if mesh is not None and claim.position is not None:
        place = "({:.2f}, {:.2f}, {:.2f})".format(*mesh.nearest_part(claim.position).place)
        yield f"nearest is {part_owner(mesh, claim.position).words}, at {place} m"


def file_labels(mission: MissionIR, claim: Claim) -> Iterator[Label]:
    """Yield a label on the file of the mesh that is too near."""
    mesh = _mesh(mission, claim)
    if mesh is not None and claim.position is not None and claim.path != mesh.path:
        yield mission.origins.value(mesh.path, f"{part_owner(mesh, claim.position).words} stands there")


def _mesh(mission: MissionIR, claim: Claim) -> ObstacleMesh | None:
    return next((mesh for mesh in mission.meshes if _is_from(claim.constraint, mesh)), None)


def _is_from(constraint: str, mesh: ObstacleMesh) -> bool:
    """Tell whether a constraint is on the distance of a body, or of a product that burns, from a mesh."""
    if constraint.startswith(PYRO):
        return constraint.endswith(f" from {from_mesh(mesh)}")
    return constraint.removesuffix(" at home") == f"distance from {mesh.kind}"
