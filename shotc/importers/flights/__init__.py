"""Read flights of other tools for verification. A file with faults or open questions is refused.

``read.py`` finds the format of a file. ``wpml.py``, ``litchi.py`` and ``items.py`` read waypoints
(``points.py``), ``rows.py`` and ``zipped.py`` tables of trajectories, and ``skyc.py`` shows. These modules do
not model how a machine flies them.
"""
