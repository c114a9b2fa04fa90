"""All weights of the cost of a shot on its own clock, and nothing else.

Each term is an integral of a square over the film: of the distance to the ideal place as a share of the usual
distance to the target, of the drone's jerk as such a share, and of the rates, accelerations and jerks of the
ray to the target (the camera's yaw and pitch; Eq. 12 of Alcantara et al. has the rates). The smoothing of a
shot over the normal one multiplies the weights of its motion, to the power of their order.
"""

from __future__ import annotations

PLACE_WEIGHT = 1.0
LEASH_SHARE = 0.2  # of the usual distance: this far off, the weight of the place has doubled
PLACED_WEIGHT = 1e5  # instead, if the author gave the places or how the target appears
YIELDING_WEIGHT = 10.0  # instead, if these places give way to see past an occluder
JERK_WEIGHT = 0.5**6  # s^6: wiggles of the position shorter than half a second vanish, as in the convex guide
TURN_WEIGHTS = (0.0, 0.0, 0.5, 0.5, 0.25, 0.25)  # s^2, s^4, s^6: yaw and pitch rate, acceleration, jerk
JERK_ORDER, TURN_ORDERS = 6, (2, 2, 4, 4, 6, 6)  # powers of seconds in these
PITCH_WEIGHT = 10.0  # of a metre outside the gimbal's pitch range, as such a share, for a second
UNFILMED_WEIGHT = 1e-3  # of the place's weight: on run-up and run-out
UNSEEN_WEIGHT = 0.1  # of the jerk's weight there
UNFILMED_RAY_WEIGHT = 0.001  # of the ray's weights there, unless the author gave the places
HIDDEN_WEIGHT = (
    5.0  # of a second in which an occluder hides the target's centre, in units of the place's weight
)
SUBJECTS_WEIGHT = (
    20.0  # of the appearance of several subjects: squared half frames, logarithms of sizes, angles
)
LOOSE_WEIGHT = (
    0.1  # of the place with several subjects: what is free follows the ideal, not a far picture as good
)
FIELD_WEIGHT = 1.0  # of the potential field, which is 1 in the centre of an obstacle
RANGE_M = 0.5  # metres beyond the clearance at which it ends
TOUCH_WEIGHT = 100.0  # of a second in an obstacle, in units of the place's weight
UNIT_COST = 150.0  # unit of the solver's cost over the squared usual distance: see ``problem``
