"""Missions of the MultiDrone project's director's dashboard, as XML.

``read.py`` takes the elements as they are and mends what has to be mended, ``frames.py`` and ``targets.py``
say where and when things are, ``films.py`` and ``timing.py`` what is filmed when, ``shots.py`` and
``cameras.py`` make shots of ours of it, ``framing.py`` their pictures, and ``scene.py`` and ``write.py`` the
text. Every assumption on the way is a note with its line.
"""
