"""Import camera paths of other tools as missions of keyframes: tours, animations and waypoint files.

``kml.py``, ``blender.py``, ``qgc.py`` and ``litchi.py`` each read one format as takes (``takes.py``): lists
of cameras in order. ``places.py`` converts geodetic places to W, ``thin.py`` removes cameras that
interpolation between the others replaces, and ``write.py`` makes the text. Every assumption is a note with
its line.
"""
