"""The reader of meshes and point clouds, chosen by the file ending."""

from __future__ import annotations

from shotc.kinds.models import cloud_file, mesh_file
from shotc.kinds.models.parts import ModelFault, NodePart


def read_model(kind: str, data: bytes) -> list[NodePart] | ModelFault:
    """Return the parts of a file, or its fault. The bytes may be anything.

    kind : the ending of its name, one of ``endings.ENDINGS``
    """
    return cloud_file.read_cloud(kind, data) if kind in cloud_file.KINDS else mesh_file.read_mesh(kind, data)
