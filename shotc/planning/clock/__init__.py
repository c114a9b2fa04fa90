"""Motions q(t): shots of what moves, and the way to and from them on the mission's clock.

A shot is a convex guide: the position that stays nearest to the ideal within the drone's limits and clear of
all that stands or moves, then the camera that follows its subjects. Both are splines over mission time from
rest to rest, so that the legs around them are planned like any other.
"""
