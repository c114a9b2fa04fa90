"""Flights of other tools as they stand in their files, to be judged: what is wrong or open is refused.

``read.py`` tells what a file is; ``wpml.py``, ``litchi.py`` and ``items.py`` read waypoints (``points.py``),
``rows.py`` tables of trajectories and ``skyc.py`` shows. How they are flown is no matter of these.
"""
