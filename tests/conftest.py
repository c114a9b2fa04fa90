"""What all tests share: hypothesis without a clock, and the switch that rewrites golden files."""

from __future__ import annotations

import gc
import os
import pkgutil
import signal
from importlib import import_module

import pytest
from hypothesis import settings

# A loaded machine is no bug. Every run tries the same examples; `make fuzz` tries new ones.
CI, FUZZ = (bool(os.environ.get(name)) for name in ("CI", "FUZZ"))
settings.register_profile("shotc", deadline=None, derandomize=not FUZZ, print_blob=True)
settings.load_profile("shotc")
# A job that a shell keeps in the background ignores interrupts, and so would all that tests start.
signal.signal(signal.SIGINT, signal.default_int_handler)
OURS = ("shotc", "shotc_casadi", "shotc_chan", "tests")
if CI:
    # Hypothesis also tries the constants of whatever modules of ours are loaded: so all of them are.
    for package in map(import_module, OURS):
        for module in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            if module.name.rpartition(".")[2] not in ("__main__", "conftest") and ".test_" not in module.name:
                import_module(module.name)


def pytest_addoption(parser):
    parser.addoption("--bless", action="store_true", help="rewrite golden files instead of comparing")


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items):
    """Keep the tests of a file in one process, where what they share is made once; slow ones go first."""
    for item in items:
        if item.get_closest_marker("xdist_group") is None:
            item.add_marker(pytest.mark.xdist_group(item.path.stem))
    items.sort(key=lambda item: not any(item.iter_markers("long")) and not any(item.iter_markers("slow")))


def pytest_collection_finish(session):
    """Refuse a run whose groups are not kept together; spare the collector modules and tests, which stay."""
    if session.config.getoption("loadgroup", False):
        names = (item.nodeid for item in session.items)
        if loose := [name for name in names if name.rfind("@") <= name.rfind("]")]:
            raise pytest.UsageError(f"pytest-xdist does not see the group of {loose[0]}")
    gc.collect()
    gc.freeze()


def pytest_configure(config):
    if config.getoption("--bless") and CI:
        raise pytest.UsageError("golden files are blessed by people, not by CI")
