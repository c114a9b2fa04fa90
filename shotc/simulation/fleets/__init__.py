"""Fleets flown in simulation: drones that lag and are blown about, led along their trajectories.

*display* Section V. What is planned is proved for points on curves; here is what comes of it with vehicles,
and so how large the margin of a fleet's separation has to be. Nothing in planning or verification uses it.
"""
