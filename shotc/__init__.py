"""shotc compiles YAML missions into verified, flyable camera motion."""

from __future__ import annotations

__version__ = "0.1.0"
