"""Verifies flight files, which any tool may have written, against a mission.

``course.py`` rebuilds a waypoint flight in all ways that its machine may fly it, as polynomials. ``judge.py``
makes the claims of verification on it. ``match.py`` finds the drone of each file, and ``tell.py`` reports.
"""
