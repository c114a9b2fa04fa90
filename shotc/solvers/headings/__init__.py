"""Headings without wrap-around: wrapped yaws at keyframes to one continuous curve.

The methods are those that the yaw paper compares (Wu et al., trajectory optimization with global yaw
parameterization) and one more, ``winding``, which measures best. This module names them and loads
nothing; ``solve.solve_headings`` solves.
"""

METHODS: dict[str, str] = {
    "winding": "choose the turns together: least effort, a little for the rate, within the limits",
    "nearest": "turn the shorter way from each keyframe to the next",
    "bounded": "keep the yaw of every keyframe between -180 and 180 deg",
    "virtual": "plan a point whose direction is the heading, kept off the origin, and fly its curve",
}
FLOWN = frozenset({"virtual"})
"""Those whose curves are flown. Of the others the turns are taken, and a steady curve through them."""
DEFAULT = "winding"
