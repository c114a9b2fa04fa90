"""Hypothesis without a clock, as in shotc's own tests, where these are run alone."""

from __future__ import annotations

import os

from hypothesis import settings

settings.register_profile(
    "shotc-casadi", deadline=None, derandomize=not os.environ.get("FUZZ"), print_blob=True
)
settings.load_profile("shotc-casadi")
