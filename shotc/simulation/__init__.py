"""Plans as they are flown: drones that lag, wind, sensors, and subjects that leave their track.

A simulation proves nothing, and nothing that is proved depends on it: it helps to choose, and it judges what
a mission asks of rehearsals (``rehearse``).
"""
