"""The space that is free for a drone: walls and obstacles, and the constraints that they are for a curve.

Shared by the passes that make curves; no pass itself.
"""
