"""Geometry that only shows need."""
