"""Elevation models that a mission names: bytes of ASCII grids, SRTM, CSV and GeoTIFF to posts."""
