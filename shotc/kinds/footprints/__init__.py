"""Footprints of buildings: GeoJSON bytes to rings and heights. Plain Python."""
