"""What it may cost a shot that drones are only preferred to keep out of each other's pictures.

A preference moves a camera by at most half its distance to whom it films, and crops nobody whom the
shot would show whole. Where it takes more, the shot stays as it is, and V033 tells who is in its picture.
"""

from __future__ import annotations

import numpy as np

from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.framing import Cameras, frames
from shotc.geom.pieces import Mask
from shotc.geom.track_array import places as track_places
from shotc.ir.bodies import cylinder
from shotc.ir.mission import Target
from shotc.passes.timed_route.aims import Looker, aims_at

MOST = 0.5  # of the distance to the nearest of whom a shot films, that a preference moves its camera
ALONE = 1.0  # metres, where a shot films nobody
STEP = 0.1  # seconds between the moments that are looked at


def costs_little(looker: Looker, span: tuple[float, float], plain: Piecewise, freer: Piecewise) -> bool:
    """Tell whether a course that keeps pictures free stays near the plain one, and shows as much.

    span : of the film, seconds
    """
    times = np.linspace(*span, max(2, round((span[1] - span[0]) / STEP)) + 1)
    before, after = plain(times)[:, :3], freer(times)[:, :3]
    targets = [looker.mission.target(s.target) for s in looker.subjects]
    far = [np.linalg.norm(_places(target, times) - before, axis=1) for target in targets]
    most = MOST * np.min(far, axis=0) if far else np.full(len(times), ALONE)
    if (np.linalg.norm(after - before, axis=1) > most).any():
        return False
    return not any(
        (_whole(looker, t, times, before) & ~_whole(looker, t, times, after)).any() for t in targets
    )


def _whole(looker: Looker, target: Target, times: Array, places: Array) -> Mask:
    """Tell when a target is whole in the frame of a camera that looks where it has to, (M,)."""
    aims = aims_at(looker, times, places)
    still = places - _places(target, times) + np.array(target.centre)
    cameras = Cameras(still, aims[:, 0], aims[:, 1], looker.hfov(times), looker.drone.aspect)
    return np.asarray(frames(cameras, cylinder(target)).in_frame)


def _places(target: Target, times: Array) -> Array:
    if target.track is None:
        return np.tile(np.array(target.centre), (len(times), 1))
    return np.asarray(track_places(target.track, times))
