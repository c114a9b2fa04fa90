"""Motions q(t) over mission time: shots of moving targets, and the transfers to and from them.

A shot is planned in two convex steps. The first finds the position: the curve nearest to the ideal that keeps
the drone's limits and stays clear of all obstacles, standing and moving. The second finds the camera angles
that follow the subjects. Both curves are splines over mission time from rest to rest, so that the legs around
them are planned like any other.
"""
