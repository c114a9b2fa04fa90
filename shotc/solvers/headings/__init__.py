"""Headings without wrap-around: one continuous curve through wrapped yaws at keyframes.

The methods are those of the yaw paper's comparison (Wu et al., trajectory optimization with global yaw
parameterization) and ``winding``, which has the best measurements. This module names them and loads nothing;
``solve.solve_headings`` solves.
"""

METHODS: dict[str, str] = {
    "winding": "choose the turns together: least effort, a little for the rate, within the limits",
    "nearest": "turn the shorter way from each keyframe to the next",
    "bounded": "keep the yaw of every keyframe between -180 and 180 deg",
    "virtual": "plan a point whose direction is the heading, kept off the origin, and fly its curve",
}
FLOWN = frozenset({"virtual"})
"""The methods whose curves are flown. The others only choose the turns, and another curve passes them."""
DEFAULT = "winding"
