"""Cameras that others have drawn, as missions of keyframes: tours, animations and waypoint files.

``kml.py``, ``blender.py``, ``qgc.py`` and ``litchi.py`` read a file each as takes (``takes.py``): cameras in
order. ``places.py`` puts what counts on the globe into W, ``thin.py`` leaves out cameras that the others
imply, and ``write.py`` makes the text. Every assumption on the way is a note with its line.
"""
