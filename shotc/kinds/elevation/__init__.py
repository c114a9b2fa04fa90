"""Elevation models: bytes of ASCII grids, SRTM, CSV and GeoTIFF files to posts."""
