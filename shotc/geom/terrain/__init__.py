"""Elevation models as ground: posts in a system of coordinates, put into W exactly, and triangles between."""
