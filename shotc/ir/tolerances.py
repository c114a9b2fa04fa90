"""What is judged as kept although numbers are rounded: for a refined path, and for the flight."""

from __future__ import annotations

AT_REST = 1e-6
"""m/s and rad/s (m/s^2, rad/s^2) of any channel that still count as rest."""

OFF_LINE = 0.01
"""Screen units that a reference may leave the line between two keyframes' references."""

ON_PLACE = 1e-3
"""Metres (radians, for the camera) within which a keyframe is met and a hold stands still."""

ON_TIME_S = 1e-3
"""Seconds within which a duration, a start or a keyframe's time is met."""

BOW_SHARE = 0.25
"""Share of the way between two generated keyframes that a path may bow out between them."""
