"""What all tests share: hypothesis without a clock, and the switch that rewrites golden files."""

from __future__ import annotations

import gc
import os
import pkgutil
import signal
from importlib import import_module
from pathlib import Path
from shutil import rmtree
from tempfile import mkdtemp

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


UNMARKED = "unmarked"
BEGIN = pytest.StashKey[float]()
LIMITS = (("long", 1.0), ("slow", 0.15))
"""Marks, and the seconds of CPU from which on a test has one of them or one further up."""


def cpu_seconds():
    """Return the CPU that this process and its ended children have taken."""
    return sum(os.times()[:4])


def pytest_addoption(parser):
    parser.addoption("--bless", action="store_true", help="rewrite golden files instead of comparing")


@pytest.fixture
def tmp_path(request, tmp_path_factory):
    """A folder of a test, removed where the test passed.

    That of pytest looks through the folders of all earlier tests for a number, sets a link, and leaves the
    folders to the end of the run: 2 ms each, and ten times that on a slow disk.
    """
    failed = request.session.testsfailed
    folder = Path(mkdtemp(dir=tmp_path_factory.getbasetemp()))
    yield folder
    if request.session.testsfailed == failed:
        rmtree(folder, ignore_errors=True)


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items):
    """Keep the tests of a file in one process, where what they share is made once; slow ones go first."""
    for item in items:
        if item.get_closest_marker("xdist_group") is None:
            item.add_marker(pytest.mark.xdist_group(item.path.stem))
    items.sort(key=lambda item: not any(item.iter_markers("long")) and not any(item.iter_markers("slow")))


def pytest_collection(session):
    """Make no garbage collector look at what is imported and collected: all of it stays."""
    gc.disable()


def pytest_collection_finish(session):
    """Refuse a run whose groups are not kept together; spare the collector modules and tests, which stay."""
    if session.config.getoption("loadgroup", False):
        names = (item.nodeid for item in session.items)
        if loose := [name for name in names if name.rfind("@") <= name.rfind("]")]:
            raise pytest.UsageError(f"pytest-xdist does not see the group of {loose[0]}")
    gc.collect()
    gc.freeze()
    gc.enable()


@pytest.hookimpl(wrapper=True, tryfirst=True)
def pytest_runtest_setup(item):
    item.stash[BEGIN] = cpu_seconds()
    return (yield)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item, call):
    """Note a test that lacks the mark of what it takes, in CPU, which a loaded machine hardly changes."""
    report = yield
    if call.when == "teardown":
        spent = cpu_seconds() - item.stash[BEGIN]
        for k, (mark, least) in enumerate(LIMITS):
            if spent >= least and not any(item.get_closest_marker(name) for name, _ in LIMITS[: k + 1]):
                report.user_properties.append((UNMARKED, f"{spent:.1f} s of CPU, not marked {mark}"))
                break
    return report


def pytest_terminal_summary(terminalreporter):
    """List the tests that lack a mark; the first one to import a library is listed with the time of that."""
    reports = terminalreporter.stats.get("", ())
    told = [(text, r.nodeid) for r in reports for name, text in r.user_properties if name == UNMARKED]
    if told:
        terminalreporter.section("tests without a mark of what they take")
        for text, name in sorted(told, key=lambda each: -float(each[0].split()[0])):
            terminalreporter.line(f"{text}: {name}")


def pytest_configure(config):
    if config.getoption("--bless") and CI:
        raise pytest.UsageError("golden files are blessed by people, not by CI")
