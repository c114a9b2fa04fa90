"""Meshes and point clouds: bytes of GLB, PLY, OBJ, STL, XYZ, LAS and LAZ files to parts."""
