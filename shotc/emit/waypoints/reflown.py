"""The samples of a file's re-flight: poses of the drone and its camera."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

STAY_PACE_M_S = 0.1  # m/s; the least pace of progress, which stays and slow motion count with


@dataclass(frozen=True, slots=True, eq=False)
class ReflownSamples:
    """Samples of the re-flight, between take-off and landing.

    position : (n, 3), W, metres
    body_yaw, cam_yaw, cam_pitch : (n,), rad
    part : (n,), number of starts and stops of recording so far; it is odd while a shot is filmed
    progress : (n,), metres flown; stays count with STAY_PACE_M_S
    elapsed : (n,), seconds
    hfov : (n,), rad; NaN where no field of view is commanded
    """

    position: Array
    body_yaw: Array
    cam_yaw: Array
    cam_pitch: Array
    part: NDArray[np.int64]
    progress: Array
    elapsed: Array
    hfov: Array
