"""Number formats of the tables."""

from __future__ import annotations

NUMBER = "%.9g"
DEGREES = "%.9f"
"""Latitude and longitude; nine significant digits would be decimetre steps east of 100 degrees."""
