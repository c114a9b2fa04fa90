"""Footprints of buildings that a mission names: bytes of GeoJSON to rings and heights. Plain Python."""
