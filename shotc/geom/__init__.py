"""Geometry: frames, solids, the camera, piecewise polynomials."""
