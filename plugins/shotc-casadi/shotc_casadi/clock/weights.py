"""What a shot on its own clock weighs against what: every weight of its cost, and nothing else.

Each term is an integral over the film of a square: of the distance to the ideal place as a share of the
usual distance to the target, of the drone's jerk as such a share, and of the rates, accelerations and jerks
of the ray to the target (the camera's yaw and pitch; Eq. 12 of Alcantara et al. has the rates). What a shot's
smoothing is over the normal one multiplies the weights of its motion by its powers.
"""

from __future__ import annotations

PLACE = 1.0
LEASH = 0.2  # of the usual distance: as far off, the place weighs twice as much
PLACED = 1e5  # instead, where the author gave the places, or says how the target appears
YIELDS = 10.0  # instead, where they yield to what would hide it
JERK = 0.5**6  # s^6: wiggles of the place shorter than half a second vanish, as in the convex guide
TURN = (0.0, 0.0, 0.5, 0.5, 0.25, 0.25)  # s^2, s^4, s^6: yaw and pitch rate, acceleration, jerk
JERK_ORDER, TURN_ORDERS = 6, (2, 2, 4, 4, 6, 6)  # powers of seconds in these
STEEP = 10.0  # of a metre by which the gimbal's pitch range is left, as such a share, for a second
FAINT = 1e-3  # of the place's weight, on the ways into and out of the film, against that in the film
UNSEEN = 0.1  # of the jerk's weight there
UNWATCHED = 0.001  # of the ray's weights there, unless the author gave the places
HIDDEN = 5.0  # of a second in which something stands right before the target, in units of the place's weight
TOGETHER = 20.0  # of how several subjects appear: half frames, logarithms of sizes and angles, squared
LOOSE = (
    0.1  # of the place's weight there: what is free follows the ideal, not a far-off picture that is as good
)
FIELD = 1.0  # of the potential field, which is 1 in the middle of what is kept away from
RANGE = 0.5  # metres beyond the clearance at which it ends
TOUCH = 100.0  # of a second in what is kept away from, in units of the place's weight
UNIT = 150.0  # what the solver's cost is in, over usual distances squared: see ``problem``
