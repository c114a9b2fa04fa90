"""Files of flights that any tool may have written, held against a mission.

``course.py`` rebuilds a flight by waypoints in all the ways that its machine may fly it, as polynomials;
``judge.py`` has verification prove of it what it claims of plans; ``match.py`` finds whose flight a file is,
and ``tell.py`` reports.
"""
