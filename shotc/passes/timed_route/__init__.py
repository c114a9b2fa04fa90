"""The timed route: shots of moving targets, optimised on their own clock.

A convex guide: the position that stays nearest to the ideal within the drone's limits and clear of all
that stands or moves, then the camera that follows its subjects. Both are splines over mission time from
rest to rest, so that the legs around them are planned like any other.
"""
