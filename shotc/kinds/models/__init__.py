"""Meshes and point clouds that a mission names: bytes of GLB, PLY, OBJ, STL, XYZ, LAS and LAZ to parts."""
