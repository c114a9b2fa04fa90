"""Pictures of a mission's world from its keyframes: shaded scene, ground and sky."""

from __future__ import annotations

import numpy as np

from shotc.emit.palette import GROUND, GROUND_FAR, SKY, SKY_LOW
from shotc.geom.bernstein import Array
from shotc.identify.views import FRAME, TILE_RAYS, CameraPose, look
from shotc.identify.views import GROUND as ON_GROUND
from shotc.ir.mission import MissionIR

PICTURE_WIDTH_PX = 320
"""Width, pixels."""
LIT, DARK = (0.86, 0.84, 0.80), (0.36, 0.37, 0.40)
"""Colours of faces towards the camera, and of faces seen edge-on."""
FAR_M = 400.0
"""Distance over which the ground fades."""


def picture(mission: MissionIR, camera: CameraPose) -> Array:
    """Return a camera's picture of the mission's world, shape (rows, columns, 3), the upper left pixel first.

    Red, green and blue range from 0 to 1.
    """
    across = PICTURE_WIDTH_PX // TILE_RAYS
    up = max(1, round(across / camera.aspect))
    seen = look(mission, camera, FRAME, (across, up))
    rows = np.linspace(0.0, 1.0, len(seen.mesh))[:, None, None]
    out = np.broadcast_to(np.array(SKY_LOW) * (1 - rows) + np.array(SKY) * rows, (*seen.mesh.shape, 3)).copy()
    on = seen.mesh == ON_GROUND
    with np.errstate(invalid="ignore"):
        distances = np.linalg.norm(seen.point - np.array(camera.eye), axis=-1)[..., None]
    faded = np.clip(distances / FAR_M, 0.0, 1.0)
    ground = np.array(GROUND) * (1 - faded) + np.array(GROUND_FAR) * faded
    out[on] = ground[on]
    lit = seen.shade[..., None]
    solid = np.array(DARK) * (1 - lit) + np.array(LIT) * lit
    out[seen.solid] = solid[seen.solid]
    return np.asarray(out[::-1])
