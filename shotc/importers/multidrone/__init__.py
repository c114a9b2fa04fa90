"""Missions of the MultiDrone project's director's dashboard, as XML.

``read.py`` takes the elements as they are and mends what has to be mended, ``shots.py`` makes shots of ours
of them, ``write.py`` writes the mission. Every assumption on the way is a note with its line.
"""
