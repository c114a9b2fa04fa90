"""Solids for whole arrays of points: distances, segments, planes between. Mirrors ``geom.solids``."""
