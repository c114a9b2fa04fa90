"""Triangles as obstacles, ground and occluders: proofs for every instant, searches, planes, sight."""
