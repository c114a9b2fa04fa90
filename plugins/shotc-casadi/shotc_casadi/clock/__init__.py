"""Refines shots on their own clock: the position by a nonlinear programme, the camera by a convex one.

The convex guide stays near the ideal and ignores how the camera has to turn there. Here the cost weighs the
position against the motion of the ray to the target, so that the camera turns calmly (Alcantara et al., Eq.
12).
"""
