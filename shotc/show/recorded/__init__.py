"""Converts flights of whole fleets made by other tools to splines that drones can fly.

``tracks.py`` reads the file. ``grid.py`` takes control points from its tracks and bounds the distance between
tracks and spline. ``clock.py`` slows down the common clock where drones would exceed a limit. ``stage.py``
finds the take-off and the landing.

All drones have one clock. If p_i(s) is the position of drone i in the file at the file's time s, the drone
flies q_i(t) within a proved distance of p_i(s(t)), with one non-decreasing s(t) for all. So the formations
are those of the file, in its order, whatever the clock: drones with distance D in all of these keep D minus
twice that distance. No proof depends on this: ``keep-apart`` and verification prove the splines that are
flown.
"""
