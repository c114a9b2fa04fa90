"""Drone shows: from the pictures of displays to a fleet's trajectories with separation, and their files.

goals, assignment, splines, separation : the passes of the route, in its order
geom, solvers : what only these passes need
emit : the files of shows
"""
