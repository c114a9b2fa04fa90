"""Keeps the target whole beside keyframes at which it touches an edge of the frame.

At such a keyframe the distance of the target from the edge has a minimum. So its slope along the path has to
be zero where the camera flies through, and must not be negative at the first keyframe. The nodes cannot
enforce this: the loss just after a keyframe is smaller than the error that they tolerate.
"""

from __future__ import annotations

import numpy as np

from shotc.plugin_api import Piecewise
from shotc.plugin_api.refiner import Array
from shotc_casadi.camera import Given
from shotc_casadi.conditions import OURS
from shotc_casadi.frames import LEAST_HALF_FRAMES, insides
from shotc_casadi.references import LENS_COLUMN, ShotContext, fields_of_view, references_at
from shotc_casadi.stages import Stages

STEP_SHARE = 1e-5  # of the distance to the target, and of half a frame: the step of a difference quotient
SLIGHT_HALF_FRAMES = 1e-7  # a loss that counts as none: half frames, over a way as long as the distance


def level_beside(subject: ShotContext, nodes: Stages, camera: Piecewise, given: Given) -> Given:
    """Return ``given`` with the slopes of the camera at keyframes where its target touches an edge.

    If the camera would crop the target beside such a keyframe, the slopes change as little as possible,
    measured in shares of the distance and in half frames.
    """
    s = nodes.s[nodes.pins]
    q, references = camera(s), references_at(subject, OURS, s)
    inside = insides(subject, references, s, q)
    distances = np.linalg.norm(references.centre - q[:, :3], axis=1)
    half = fields_of_view(subject, s)[1]
    rate, indices = camera.derivative()(s), []
    for k in np.flatnonzero((references.whole > 0) & (inside.min(axis=1) < LEAST_HALF_FRAMES)):
        touches = inside[k] < LEAST_HALF_FRAMES
        slope = _along(subject, camera, float(s[k]), STEP_SHARE * float(distances[k]))[touches]
        # Nobody sees a gain before the first keyframe or after the last one.
        lost = slope if 0 < k < len(s) - 1 else np.minimum(slope, 0.0) if k == 0 else np.maximum(slope, 0.0)
        if np.abs(lost).max() * distances[k] > SLIGHT_HALF_FRAMES:
            # A step of the field of view, if the camera has one, is a share of it.
            unit = np.array([*[distances[k]] * 3, half[k], half[k], *np.sin(q[k, LENS_COLUMN:])])
            by = _by_pose(subject, float(s[k]), q[k], STEP_SHARE * unit)[touches] / STEP_SHARE
            rate[k] -= unit * np.linalg.lstsq(by, lost, rcond=None)[0]
            indices.append(int(k))
    return given._replace(through=s[indices], slopes=rate[indices])


def _along(subject: ShotContext, camera: Piecewise, s: float, step: float) -> Array:
    """Return by how much per metre of path the target moves inwards from each edge, half frames, (4,)."""
    at = np.clip(np.array([s - step, s + step]), camera.start, camera.end)
    before, after = insides(subject, references_at(subject, OURS, at), at, camera(at))
    return np.asarray((after - before) / (at[1] - at[0]))


def _by_pose(subject: ShotContext, s: float, q: Array, steps: Array) -> Array:
    """Return by how much the target moves inwards from each edge for each step of the pose, (4, K)."""
    poses = np.concatenate([q + np.diag(steps), q - np.diag(steps)])
    at = np.full(len(poses), s)
    after, before = np.split(insides(subject, references_at(subject, OURS, at), at, poses), 2)
    return np.asarray(0.5 * (after - before).T)
