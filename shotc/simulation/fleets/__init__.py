"""Simulates fleets: drones with lag and gusts that follow their trajectories.

*display* Section V. The plan is verified for points on curves. The simulation shows how vehicles deviate from
them, and so how large the margin of a fleet's separation must be. Planning and verification do not use it.
"""
