"""Flights of whole fleets that other tools made, as splines of ours that drones can fly.

``tracks.py`` reads the file, ``grid.py`` takes control points from its tracks and bounds how far their spline
is from them, ``clock.py`` stretches the time of all drones alike where they would break a limit, and
``stage.py`` finds which part of it take-off and landing are.

All drones keep one clock: if p_i(s) is where the file has drone i at its time s, it flies q_i(t) within a
proved distance of p_i(s(t)), with one s(t) for all that never goes back. So the formations are those of the
file, in their order, whatever the clock: drones that are D apart in all of these stay D apart less twice that
distance. Nothing is built on that: ``keep-apart`` and verification prove the splines as they are flown.
"""
