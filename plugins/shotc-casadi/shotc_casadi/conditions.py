"""The conditions of the paper (what the camera has to do), and framing alone and with four points."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

Visibility = Literal["silhouette", "points", "none"]


@dataclass(frozen=True, slots=True)
class AimCondition:
    """One way to choose the camera between keyframes.

    aims : "framing" holds the target at its place on screen, "angles" interpolates the author's camera
        angles, "look-at" interpolates the points that the author's cameras look at
    visibility : how the whole target is kept in the frame: by its exact silhouette, by the four hull points
        of Gebhardt and Hilliges (Eq. 4-7), or not at all
    """

    name: str
    summary: str
    aims: Literal["framing", "angles", "look-at"]
    visibility: Visibility


OURS = AimCondition(
    "ours", "hold the composition, with the whole target in the frame", "framing", "silhouette"
)
OURS_4PT = AimCondition(
    "ours-4pt", "the same with the paper's four hull points for the target", "framing", "points"
)
FRAMING_ONLY = AimCondition(
    "framing-only", "hold the composition, whether or not the target is whole", "framing", "none"
)
LOOK_AT = AimCondition("look-at", "look at points interpolated between keyframes", "look-at", "none")
ANG = AimCondition("ang", "interpolate the author's camera angles between keyframes", "angles", "none")
