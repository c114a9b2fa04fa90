"""Tolerances of the checks on refined paths and on the flight, for rounding."""

from __future__ import annotations

REST_TOLERANCE = 1e-6
"""Rate and acceleration of any channel that still count as rest, m/s and rad/s (m/s^2 and rad/s^2)."""

OFF_LINE_HALF_FRAMES = 0.01
"""Largest distance of a reference from the line between two keyframes' references, screen units."""

PLACE_TOLERANCE = 1e-3
"""Tolerance of keyframes and holds, metres (radians for the camera)."""

ON_TIME_S = 1e-3
"""Tolerance of a duration, a start or a keyframe's time, seconds."""

BOW_SHARE = 0.25
"""Largest bow of a path between two generated keyframes, as a share of their distance."""
