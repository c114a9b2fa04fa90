"""Shots on their own clock, refined: the position by a nonlinear programme, the camera by a convex one.

The convex guide stays near the ideal and does not know what the camera has to do there. Here the place
is weighed against the motion of the ray to the target, so that the camera turns calmly (Alcantara et al.,
Eq. 12).
"""
