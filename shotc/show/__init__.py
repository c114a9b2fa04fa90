"""Drone shows: from what displays draw to flights of a fleet that keep apart, and their files.

goals, assignment, splines, separation : the passes of the route, in its order
geom, solvers : what they alone need
emit : the files of shows
"""
