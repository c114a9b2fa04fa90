"""Simulates plans: drones with lag, wind, sensors, and subjects that leave their track.

A simulation proves nothing, and no proof depends on it. It helps to choose conditions and margins, and it
judges what a mission asks of rehearsals (``rehearse``).
"""
