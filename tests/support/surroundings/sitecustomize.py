"""Surroundings for a command under test: Python loads this at its start where the folder is on PYTHONPATH.

TEST_HIDE : libraries that are not installed, separated by commas
TEST_INTERRUPT : press Ctrl-C, which reaches all processes of the command, when this module is first looked
    for, or at this call of fsync
"""

import os
import signal
import sys
from importlib.machinery import PathFinder

HIDDEN = set(filter(None, os.environ.get("TEST_HIDE", "").split(",")))
INTERRUPT = os.environ.get("TEST_INTERRUPT", "")


class Finder(PathFinder):
    """Finds what Python finds, but for what is hidden."""

    @classmethod
    def find_spec(cls, fullname, path=None, target=None):
        if fullname == INTERRUPT:
            os.killpg(0, signal.SIGINT)
        return None if fullname.partition(".")[0] in HIDDEN else super().find_spec(fullname, path, target)


def interrupting(call, count):
    """Return ``call`` with Ctrl-C pressed when it is entered for the count-th time."""

    def counted(*arguments):
        nonlocal count
        count -= 1
        if count == 0:
            os.killpg(0, signal.SIGINT)
        return call(*arguments)

    return counted


sys.meta_path[sys.meta_path.index(PathFinder)] = Finder
if INTERRUPT.isdecimal():
    os.fsync = interrupting(os.fsync, int(INTERRUPT))
