"""What a re-flight of a file is: samples of where the drone and its camera would be."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

STAY_PACE = 0.1  # m/s at which stays count as progress, as does all slower motion


@dataclass(frozen=True, slots=True, eq=False)
class ReflownSamples:
    """Samples of the re-flight, between take-off and landing.

    part : (n,), counts starts and stops of recording: odd while the shots are filmed, in order
    progress : (n,), way flown in m, stays at STAY_PACE
    elapsed : (n,), s; hfov : (n,), rad, NaN where no field of view is commanded
    """

    position: Array
    body_yaw: Array
    cam_yaw: Array
    cam_pitch: Array
    part: NDArray[np.int64]
    progress: Array
    elapsed: Array
    hfov: Array
