"""What all tests share: hypothesis without a clock, and the switch that rewrites golden files."""

from __future__ import annotations

import os

import pytest
from hypothesis import settings

# A loaded machine is no bug; and CI runs the same examples every time.
settings.register_profile("shotc", deadline=None, derandomize=bool(os.environ.get("CI")), print_blob=True)
settings.load_profile("shotc")


def pytest_addoption(parser):
    parser.addoption("--bless", action="store_true", help="rewrite golden files instead of comparing")


def pytest_configure(config):
    if config.getoption("--bless") and os.environ.get("CI"):
        raise pytest.UsageError("golden files are blessed by people, not by CI")
