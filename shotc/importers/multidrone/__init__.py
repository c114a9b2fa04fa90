"""Import missions of the MultiDrone project's director's dashboard, as XML.

``read.py`` reads the elements and repairs their values. ``frames.py`` and ``targets.py`` find positions and
courses, ``films.py`` and ``timing.py`` the times of the actions. ``shots.py`` and ``cameras.py`` make shots,
``framing.py`` their framing, and ``scene.py`` and ``write.py`` the text. Every assumption is a note with its
line.
"""
