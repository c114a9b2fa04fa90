"""Numbers of the tables."""

from __future__ import annotations

NUMBER = "%.9g"
DEGREES = "%.9f"
"""Latitude and longitude: nine significant digits would be steps of decimetres East of 100 degrees."""
